//! Influence matrices of 2, 8 and 32 wheels: the exact surface.

#[path = "../tests/beam/mod.rs"]
mod beam;

use beam::{Beam, probe};
use divan::{Bencher, black_box};
use splines::{Axis, Compliance, Influence, Probe};

fn main() {
    divan::main();
}

/// Vertical probes 5 ft apart at most, on the paper's girder.
fn wheels(n: usize) -> Vec<Probe> {
    let pitch = f64::min(8.0 / 3.0, 60.0 / n as f64);
    (0..n).map(|k| probe(Axis::Vertical, 11.0 + pitch * k as f64)).collect()
}

#[divan::bench(args = [2, 8, 32])]
fn exact(bencher: Bencher<'_, '_>, n: usize) {
    let surface = Beam::paper().surface(&[-15.0, 0.0, 15.0, 30.0, 45.0, 60.0, 75.0]);
    fill(bencher, &surface, n);
}

fn fill(bencher: Bencher<'_, '_>, compliance: &dyn Compliance, n: usize) {
    let at = wheels(n);
    let mut out = Influence::zeros(n);
    bencher.bench_local(|| {
        let done = compliance.fill(black_box(&at), &mut out);
        black_box(&out.value);
        done
    });
}
