//! A compliance without some of its couplings: which coefficients remain, and that they stay positive.

use nalgebra::DMatrix;
use splines::{Axis, Compliance, Couplings, Error, Influence, Probe, Uncoupled};

/// Number of terms of the compliance.
const TERMS: usize = 4;

/// G(p, q) = sum over k of s_k(p) s_k(q): symmetric and positive, every pair of rails and directions coupled.
struct Sums;

impl Sums {
    fn shape(p: &Probe, k: usize) -> [f64; 2] {
        let wave = 0.3 * (k + 1) as f64;
        let lag = p.rail as f64 + 0.7 * p.axis.component() as f64 + k as f64;
        [(wave * p.x + lag).sin(), wave * (wave * p.x + lag).cos()]
    }
}

impl Compliance for Sums {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        let product = |i: usize, j: usize, part: usize| -> f64 {
            (0..TERMS)
                .map(|k| Sums::shape(&at[i], k)[part] * Sums::shape(&at[j], k)[0])
                .sum()
        };
        out.value = DMatrix::from_fn(at.len(), at.len(), |i, j| product(i, j, 0));
        out.slope = DMatrix::from_fn(at.len(), at.len(), |i, j| product(i, j, 1));
        Ok(())
    }

    fn breaks(&self, rail: usize) -> Vec<f64> {
        vec![rail as f64]
    }

    fn range(&self, _rail: usize) -> Option<[f64; 2]> {
        Some([0.0, 9.0])
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

/// Two rails, three directions, two places each, in no order.
fn probes() -> Vec<Probe> {
    let all = [0, 1]
        .into_iter()
        .flat_map(|rail| Axis::ALL.map(|axis| (rail, axis)));
    let mut probes: Vec<Probe> = all
        .flat_map(|(rail, axis)| [1.5, 7.25].map(|x| Probe { rail, x, axis }))
        .collect();
    for k in 0..probes.len() {
        probes.swap(k, (5 * k + 3) % 12);
    }
    probes
}

fn filled(of: &dyn Compliance) -> Influence {
    let at = probes();
    let mut out = Influence::zeros(at.len());
    of.fill(&at, &mut out).expect("probes on the rails");
    out
}

/// Analytic: coefficients that are kept equal those of the whole to the last bit; all others are zero, slopes
/// too.
#[test]
fn coefficients_kept_equal_those_of_the_whole_to_the_last_bit() {
    let (whole, at) = (filled(&Sums), probes());
    for (couplings, kept) in [
        (Couplings::All, 144),
        (Couplings::WithinRails, 72),
        (Couplings::None, 24),
    ] {
        let left = filled(&Uncoupled::new(Sums, couplings));
        let mut count = 0;
        for (j, q) in at.iter().enumerate() {
            for (i, p) in at.iter().enumerate() {
                let is_kept = match couplings {
                    Couplings::All => true,
                    Couplings::WithinRails => p.rail == q.rail,
                    Couplings::None => (p.rail, p.axis) == (q.rail, q.axis),
                };
                count += usize::from(is_kept);
                let of = |from: &DMatrix<f64>| if is_kept { from[(i, j)] } else { 0.0 };
                assert_eq!(left.value[(i, j)].to_bits(), of(&whole.value).to_bits());
                assert_eq!(left.slope[(i, j)].to_bits(), of(&whole.slope).to_bits());
            }
        }
        assert_eq!(count, kept, "{couplings:?}");
    }
}

/// Analytic: diagonal blocks of a positive matrix are positive.
#[test]
fn coefficients_kept_are_symmetric_and_positive() {
    for couplings in [Couplings::WithinRails, Couplings::None] {
        let parted = Uncoupled::new(Sums, couplings);
        let left = filled(&parted).value;
        let size = left.norm();
        assert_eq!(left, left.transpose());
        let least = left.symmetric_eigenvalues().min();
        assert!(least > -1e-14 * size, "{couplings:?}: {least:e}");
        assert!(parted.is_symmetric());
        assert_eq!(
            (parted.breaks(1), parted.range(0)),
            (vec![1.0], Some([0.0, 9.0]))
        );
    }
}
