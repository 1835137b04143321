//! Influence coefficients of wheels on the paper's girder by every reading: one pair with its derivatives,
//! and whole matrices.

#[path = "../tests/it/beam/mod.rs"]
mod beam;

use beam::printed::STATIONS;
use beam::{Beam, probe, read, tabulate};
use divan::{Bencher, black_box};
use splines::{
    Axis, Differentiable, FactoredTable, Influence, InfluenceBlock, Probe, Rank, ReadingMethod,
};

fn main() {
    divan::main();
}

/// A compliance that is measured.
#[derive(Clone, Copy, Debug)]
enum Of {
    Exact,
    /// A rail above the axis and beside it, where every shape row has twelve entries.
    Coupled,
    Natural,
    /// The factored table with all five products.
    Factored,
    Akispl,
    Symmetrised,
    Cubspl,
}

const ALL: [Of; 7] = [
    Of::Exact,
    Of::Coupled,
    Of::Natural,
    Of::Factored,
    Of::Akispl,
    Of::Symmetrised,
    Of::Cubspl,
];

impl Of {
    fn ready(self) -> Box<dyn Differentiable> {
        let table = tabulate(&Beam::paper(), &STATIONS);
        let way = (0, Axis::Vertical);
        match self {
            Of::Exact => Box::new(Beam::paper().surface(&STATIONS)),
            Of::Coupled => Box::new(beam::coupled()),
            Of::Natural => Box::new(read(ReadingMethod::Natural, table)),
            Of::Factored => {
                let sheet = InfluenceBlock {
                    deflection: way,
                    load: way,
                    table,
                };
                Box::new(FactoredTable::new(&[sheet], Rank::Full).expect("one table"))
            }
            Of::Akispl => Box::new(read(ReadingMethod::Akispl, table)),
            Of::Symmetrised => Box::new(read(ReadingMethod::Symmetrised, table)),
            Of::Cubspl => Box::new(read(ReadingMethod::Cubspl, table)),
        }
    }
}

/// Value, both slopes and the three second derivatives of one pair.
#[divan::bench(args = ALL, sample_size = 1000)]
fn jet(bencher: Bencher<'_, '_>, of: Of) {
    let ready = of.ready();
    let [p, q] = [11.0, 41.0].map(|x| probe(Axis::Vertical, x));
    bencher.bench_local(|| ready.partials(black_box(p), black_box(q)));
}

/// Values and slopes of n vertical probes, 32 in apart, or closer where the span requires it.
#[divan::bench(args = ALL, consts = [1, 2, 8, 32, 100], sample_size = 100)]
fn fill<const N: usize>(bencher: Bencher<'_, '_>, of: Of) {
    let ready = of.ready();
    let pitch = f64::min(8.0 / 3.0, 60.0 / N as f64);
    let at: Vec<Probe> = (0..N)
        .map(|k| probe(Axis::Vertical, 11.0 + pitch * k as f64))
        .collect();
    let mut out = Influence::zeros(N);
    bencher.bench_local(|| {
        let done = ready.fill(black_box(&at), &mut out);
        black_box(&out.value);
        done
    });
}
