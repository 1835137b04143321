//! A rail on lengths that are hinged to each other.

use splines::{Axis, Compliance, Error, Influence, Probe};

/// Rigid lengths of 10 ft, hinged over springs, below a rail 2 ft higher: with the hats h of the supports a place goes by
/// h down and by 2 h' along x, which jumps at the supports. Along x all springs give as well.
pub struct Hinged;

const HEIGHT: f64 = 2.0;

impl Hinged {
    /// Displacement of a place by support `n`, and its slope.
    fn share(p: &Probe, n: i32) -> [f64; 2] {
        let from = 0.1 * p.x - f64::from(n);
        let (hat, slope) = if from.abs() < 1.0 {
            (1.0 - from.abs(), -0.1 * from.signum())
        } else {
            (0.0, 0.0)
        };
        match p.axis {
            Axis::Vertical => [hat, slope],
            _ => [HEIGHT * slope, 0.0],
        }
    }
}

impl Compliance for Hinged {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        for (i, p) in at.iter().enumerate() {
            for (j, q) in at.iter().enumerate() {
                let both = p.axis == Axis::Longitudinal && q.axis == Axis::Longitudinal;
                let (mut value, mut slope) = (if both { 1.0 } else { 0.0 }, 0.0);
                for n in -1..8 {
                    let ([a, da], [b, _]) = (Hinged::share(p, n), Hinged::share(q, n));
                    (value, slope) = (value + a * b, slope + da * b);
                }
                (out.value[(i, j)], out.slope[(i, j)]) = (2e-8 * value, 2e-8 * slope);
            }
        }
        Ok(())
    }

    fn breaks(&self, _: usize) -> Vec<f64> {
        (-1..8).map(|n| 10.0 * f64::from(n)).collect()
    }

    fn range(&self, _: usize) -> Option<[f64; 2]> {
        Some([-10.0, 70.0])
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}
