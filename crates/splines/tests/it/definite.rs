//! Readings of the printed table whose influence matrices are indefinite, which those of a structure are not.

use crate::beam;

use beam::printed::{VERTICAL, table};
use beam::{Random, probe, read};
use splines::{Axis, Compliance, Influence, Probe, ReadingMethod};

/// Fraction of random sets of n wheels, overhangs included, whose symmetric part is indefinite; smallest
/// eigenvalue.
fn indefinite(kind: ReadingMethod, n: usize, sets: usize) -> (f64, f64) {
    let reading = read(kind, table(&VERTICAL));
    let mut random = Random::new(61);
    let mut out = Influence::zeros(n);
    let (mut found, mut worst) = (0, 0.0_f64);
    for _ in 0..sets {
        let at: Vec<Probe> = (0..n)
            .map(|_| probe(Axis::Vertical, random.between(-15.0, 75.0)))
            .collect();
        reading.fill(&at, &mut out).expect("within the table");
        let mean = 0.5 * (&out.value + out.value.transpose());
        let eigenvalues = mean.symmetric_eigenvalues();
        worst = worst.min(eigenvalues.min());
        found += usize::from(eigenvalues.min() < -1e-13 * eigenvalues.amax());
    }
    (found as f64 / sets as f64, worst)
}

/// External: an independent prototype found 12 %, 72 %, all and all, and -1.2e-9 ft/lb at worst with 16
/// wheels. The symmetrised reading has the same symmetric part.
#[test]
fn akispl_of_the_printed_table_is_mostly_indefinite() {
    for (n, expected) in [(2, 0.12), (4, 0.72), (8, 1.0), (16, 1.0)] {
        let (plain, worst) = indefinite(ReadingMethod::Akispl, n, 4000);
        assert!((plain - expected).abs() < 0.02, "{n} wheels: {plain}");
        assert_eq!(plain, indefinite(ReadingMethod::Symmetrised, n, 4000).0);
        assert!(n < 16 || (worst / -1.2e-9 - 1.0).abs() < 0.15, "{worst:e}");
    }
}

/// Identity: the natural reading of the same table is never indefinite, although the table is rounded.
#[test]
fn natural_reading_of_the_printed_table_is_never_indefinite() {
    for n in [2, 4, 8, 16] {
        assert_eq!(indefinite(ReadingMethod::Natural, n, 1000).0, 0.0);
    }
}

/// External: at worst -4.5e-12 ft/lb for two wheels 32 in apart, nothing for wheels of 1e8 lb/ft. Regression:
/// on 43 % of the span (37 % were counted elsewhere, with a threshold that is not known).
#[test]
fn a_bogie_meets_indefinite_matrices_on_much_of_the_span() {
    let reading = read(ReadingMethod::Akispl, table(&VERTICAL));
    let pitch = 32.0 / 12.0;
    let mut out = Influence::zeros(2);
    let (mut found, mut worst) = (0, 0.0_f64);
    for k in 0..4000 {
        let x = (60.0 - pitch) * (f64::from(k) + 0.5) / 4000.0;
        let at = [x, x + pitch].map(|x| probe(Axis::Vertical, x));
        reading.fill(&at, &mut out).expect("on the span");
        let least = (0.5 * (&out.value + out.value.transpose()))
            .symmetric_eigenvalues()
            .min();
        worst = worst.min(least);
        found += usize::from(least < 0.0);
    }
    let share = found as f64 / 4000.0;
    assert!((share - 0.43).abs() < 0.01, "{share} {worst:e}");
    assert!((worst / -4.5e-12 - 1.0).abs() < 0.05, "{worst:e}");
}
