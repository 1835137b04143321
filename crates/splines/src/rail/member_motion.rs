//! Motions of a member between its ends, in one plane of bending, and the displacement of a rail by them.

use super::element::RailElement;
use super::load::AxisLoad;

/// Value at the last end, relative to the coefficients, that is only rounding.
const ROUNDING: f64 = 1e-13;

/// A polynomial of degree eight: the coefficient of each power.
pub(crate) type Polynomial = [f64; 9];

/// A motion of a member in one plane of bending beside that of its end states: deflection and rotation of its sections, by
/// powers of the fraction of its length.
///
/// The deflection is along the local y axis of the member, with the rotation about z; or along z, with the rotation
/// about -y. Both are zero at ends that are not released.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MemberMotion {
    /// 0 for the local x-y plane of the member, 1 for its x-z plane.
    pub plane: usize,
    /// Deflection.
    pub deflection: [f64; 9],
    /// Rotation in the sense of a slope of the deflection.
    pub rotation: [f64; 9],
}

impl MemberMotion {
    /// Displacement of the rail along rail direction `axis` as a polynomial in the fraction of the member's length.
    pub(crate) fn of_rail(&self, element: &RailElement, axis: usize) -> Polynomial {
        let load = AxisLoad::new(element, &element.member_axes(), axis);
        let [force, moment] = if self.plane == 0 { load.xy } else { load.xz };
        std::array::from_fn(|p| force * self.deflection[p] + moment * self.rotation[p])
    }
}

/// A polynomial q by its values and slopes at 0 and 1, and the quotient b of the rest:
///
/// q(s) = Hermite's cubic of these values and slopes + s^2 (1 - s)^2 b(s)
///
/// In this form values and slopes at the ends are exactly those of the neighbours.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EndForm {
    /// q(0), q(1).
    pub values: [f64; 2],
    /// q'(0), q'(1).
    pub slopes: [f64; 2],
    /// Coefficients of b.
    pub quotient: [f64; 5],
}

impl EndForm {
    pub fn of(q: &Polynomial) -> EndForm {
        let size: f64 = q.iter().map(|c| c.abs()).sum();
        let sum: f64 = q.iter().sum();
        let [start, end] = [
            q[0],
            if sum.abs() <= ROUNDING * size {
                0.0
            } else {
                sum
            },
        ];
        let first = q[1];
        let last: f64 = q.iter().enumerate().map(|(p, c)| p as f64 * c).sum();
        // The cubic is taken off; what is left begins with s^2.
        let mut rest: [f64; 7] = std::array::from_fn(|p| q[p + 2]);
        rest[0] += 3.0 * (start - end) + 2.0 * first + last;
        rest[1] -= 2.0 * (start - end) + first + last;
        // Division by 1 - 2 s + s^2.
        let mut all = [0.0; 7];
        for p in 0..5 {
            all[p + 2] = rest[p] + 2.0 * all[p + 1] - all[p];
        }
        let [_, _, quotient @ ..] = all;
        EndForm {
            values: [start, end],
            slopes: [first, last],
            quotient,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Analytic: Hermite's cubic of the end values and slopes.
    #[test]
    fn polynomial_is_that_of_its_ends_and_quotient() {
        let value = |c: &[f64], s: f64| c.iter().rev().fold(0.0, |sum, c| sum * s + c);
        let mut q: Polynomial = [0.9, 0.3, -1.2, 0.7, 2.5, -0.4, 1.1, -3.0, 0.6];
        for clamped in [false, true] {
            if clamped {
                q[0] = 0.0;
                q[8] -= q.iter().sum::<f64>();
            }
            let EndForm {
                values: [start, end],
                slopes: [first, last],
                quotient,
            } = EndForm::of(&q);
            assert!(
                start == q[0]
                    && (end - q.iter().sum::<f64>()).abs() < 1e-14
                    && (!clamped || end == 0.0)
            );
            for k in 0..=10 {
                let s = f64::from(k) / 10.0;
                let r = 1.0 - s;
                let cubic = start * r * r * (1.0 + 2.0 * s)
                    + end * s * s * (1.0 + 2.0 * r)
                    + first * s * r * r
                    - last * s * s * r;
                let found = cubic + s * s * r * r * value(&quotient, s);
                assert!((found - value(&q, s)).abs() < 1e-13, "{s}");
            }
        }
    }
}
