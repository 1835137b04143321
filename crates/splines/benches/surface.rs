//! Influence matrices of 2, 8 and 32 wheels: the exact surface beside readings of a table.

#[path = "../tests/beam/mod.rs"]
mod beam;

use beam::printed::STATIONS;
use beam::{Beam, probe, read, tabulate};
use divan::{Bencher, black_box};
use splines::{Axis, Compliance, Influence, Kind, Probe};

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
    let surface = Beam::paper().surface(&STATIONS);
    fill(bencher, &surface, n);
}

/// A rail above the axis and beside it: every row has twelve entries.
#[divan::bench(args = [2, 8, 32])]
fn coupled(bencher: Bencher<'_, '_>, n: usize) {
    fill(bencher, &beam::coupled(), n);
}

#[divan::bench(args = [2, 8, 32])]
fn akispl(bencher: Bencher<'_, '_>, n: usize) {
    fill(bencher, &read(Kind::Akispl, tabulate(&Beam::paper(), &STATIONS)), n);
}

#[divan::bench(args = [2, 8, 32])]
fn natural(bencher: Bencher<'_, '_>, n: usize) {
    fill(bencher, &read(Kind::Natural, tabulate(&Beam::paper(), &STATIONS)), n);
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
