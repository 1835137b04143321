//! What an axial force does to moments and shear forces within a short part of a member.
//!
//! About a loaded state the moments M in both planes and the shear forces V = M' satisfy M'' = L M between loads, L being
//! symmetric with the eigenvalues lambda^2 = N c/(1 + g N) of the planes of the section ([`splines::BeamColumn`]). So with
//! C = cosh(sqrt(L) s) and S = sinh(sqrt(L) s)/sqrt(L)
//!
//! M(s) = C M(0) + S V(0),    V(s) = L S M(0) + C V(0),
//!
//! a load that has been passed adds the same functions of the distance from it, and a load along the member their
//! integrals. The force F of a load changes V = M' by F/(1 + g N), because the slope of the axis jumps by the shear. Over a part of length h these functions are taken as cubics through four nodes of Chebyshev, which err by at
//! most h^4/3072 times their fourth derivative: by (lambda h)^4/3072 of what they multiply.

use crate::line::{NODES, in_powers};

/// Number of quantities that an axial force bends: two shear forces and two moments.
pub(crate) const BENT: usize = 4;
/// Index of the first of them among the quantities of a section.
pub(crate) const FIRST: usize = 2;
/// (lambda s)^2 up to which the series of cosh and sinh are summed, and their terms.
const LARGE: f64 = 1.0;
const TERMS: i32 = 12;

/// Cubics in the place, by quantity and by what causes it.
type Cubics = [[[f64; 4]; BENT]; BENT];

/// Moments and shear forces within a part of a member under axial force.
#[derive(Clone, Debug)]
pub(crate) struct Bent {
    /// By the quantities at the first end of the part.
    ends: Cubics,
    /// By jumps per length of the quantities.
    spread: Cubics,
    planes: [BentPlane; 2],
    length: f64,
}

/// A plane of bending: its direction among the vertical and the lateral moment, and lambda^2.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BentPlane {
    pub direction: [f64; 2],
    pub square: f64,
    /// 1 + g N.
    pub stiffening: f64,
}

impl Bent {
    /// The functions on a part of some length.
    pub fn new(planes: [BentPlane; 2], length: f64) -> Bent {
        let zero = [[[0.0; 4]; BENT]; BENT];
        let mut out = Bent {
            ends: zero,
            spread: zero,
            planes,
            length,
        };
        for plane in planes {
            let nodes = NODES.map(|node| functions(plane.square, node * length));
            let cubic = |k: usize| {
                let mut scale = 1.0;
                in_powers(nodes.map(|of| of[k])).map(|c| {
                    let own = c * scale;
                    scale /= length;
                    own
                })
            };
            let [cosh, sinh, rate, integral, more] =
                [cubic(0), cubic(1), cubic(2), cubic(3), cubic(4)];
            let d = plane.direction;
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let (weight, [vi, vj, mi, mj]) = (d[i] * d[j], [i, j, 2 + i, 2 + j]);
                let add = |sum: &mut [f64; 4], of: &[f64; 4]| {
                    sum.iter_mut()
                        .zip(of)
                        .for_each(|(sum, c)| *sum += weight * c);
                };
                add(&mut out.ends[mi][mj], &cosh);
                add(&mut out.ends[mi][vj], &sinh);
                add(&mut out.ends[vi][mj], &rate);
                add(&mut out.ends[vi][vj], &cosh);
                add(&mut out.spread[mi][mj], &sinh);
                add(&mut out.spread[mi][vj], &integral);
                add(&mut out.spread[vi][mj], &more);
                add(&mut out.spread[vi][vj], &sinh);
            }
        }
        out
    }

    /// The planes of bending.
    pub fn planes(&self) -> &[BentPlane; 2] {
        &self.planes
    }

    /// The cubics of quantity `k` by the four at the first end; `None` for a quantity that is not bent.
    pub fn row(&self, k: usize) -> Option<&[[f64; 4]; BENT]> {
        self.ends.get(k.checked_sub(FIRST)?)
    }

    /// What a load changes the quantities by, from its force and couple as they are without axial force.
    pub fn jump<const N: usize>(&self, given: [f64; N]) -> [f64; N] {
        let mut out = given;
        out[FIRST..FIRST + 2].fill(0.0);
        for BentPlane {
            direction: d,
            stiffening,
            ..
        } in &self.planes
        {
            let own = (d[0] * given[FIRST] + d[1] * given[FIRST + 1]) / stiffening;
            (0..2).for_each(|i| out[FIRST + i] += d[i] * own);
        }
        out
    }

    /// Quantity `k`, one that is bent, behind a load with some jumps of all quantities: a cubic in the distance.
    pub fn passed<const N: usize>(&self, k: usize, jump: &[f64; N]) -> Option<[f64; 4]> {
        Some(sum(self.row(k)?, jump))
    }

    /// What loads along the part add to quantity `k`, by their jumps per length.
    pub fn under<const N: usize>(&self, k: usize, jump: &[f64; N]) -> Option<[f64; 4]> {
        Some(sum(self.spread.get(k.checked_sub(FIRST)?)?, jump))
    }

    /// Bounds over the part of the size of the second derivative of quantity `k` by those at the first end.
    pub fn second(&self, k: usize) -> Option<[f64; BENT]> {
        Some(self.row(k)?.each_ref().map(|cubic| self.bend(cubic)))
    }

    /// A bound over the part of the size of the second derivative of a cubic.
    pub fn bend(&self, [_, _, c, d]: &[f64; 4]) -> f64 {
        (2.0 * c).abs().max((2.0 * c + 6.0 * d * self.length).abs())
    }
}

/// Shear forces and moments at a distance from where they are `from`, without loads between.
pub(crate) fn moved(planes: &[BentPlane; 2], from: &[f64; BENT], s: f64) -> [f64; BENT] {
    let mut out = [0.0; BENT];
    for BentPlane {
        direction: d,
        square,
        ..
    } in planes
    {
        let [cosh, sinh, rate, ..] = functions(*square, s);
        let [shear, moment] = [0, 2].map(|k| d[0] * from[k] + d[1] * from[k + 1]);
        for i in 0..2 {
            out[i] += d[i] * (cosh * shear + rate * moment);
            out[2 + i] += d[i] * (cosh * moment + sinh * shear);
        }
    }
    out
}

/// The sum of cubics by the four bent ones among some quantities.
fn sum<const N: usize>(row: &[[f64; 4]; BENT], of: &[f64; N]) -> [f64; 4] {
    std::array::from_fn(|p| {
        row.iter()
            .zip(&of[FIRST..])
            .map(|(cubic, value)| cubic[p] * value)
            .sum()
    })
}

/// cosh, sinh/lambda, lambda sinh, (cosh - 1)/lambda^2 and cosh - 1 of lambda s; the circular functions where lambda^2 is
/// negative.
fn functions(square: f64, s: f64) -> [f64; 5] {
    let z = square * s * s;
    if z.abs() > LARGE {
        let lambda = square.abs().sqrt();
        let (x, half) = (lambda * s, 0.5 * lambda * s);
        let [cosh, sinh, more, sign] = if square > 0.0 {
            [x.cosh(), x.sinh(), 2.0 * half.sinh().powi(2), 1.0]
        } else {
            [x.cos(), x.sin(), -2.0 * half.sin().powi(2), -1.0]
        };
        return [
            cosh,
            sinh / lambda,
            sign * lambda * sinh,
            more / square,
            more,
        ];
    }
    // sums of z^k/(2 k + 1)! and z^k/(2 k + 2)!
    let (mut odd, mut even, mut term) = (0.0, 0.0, 1.0);
    for k in 0..TERMS {
        odd += term;
        even += term / f64::from(2 * k + 2);
        term *= z / f64::from((2 * k + 2) * (2 * k + 3));
    }
    [
        1.0 + z * even,
        s * odd,
        square * s * odd,
        s * s * even,
        z * even,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One plane upright: M = cos(k s) M0 + sin(k s)/k V0 under compression, and the other plane is straight.
    #[test]
    fn moments_turn_with_the_axial_force() {
        let (k, h) = (1.3_f64, 0.05);
        let plane = |direction, square| BentPlane {
            direction,
            square,
            stiffening: 1.0,
        };
        let bent = Bent::new([plane([1.0, 0.0], -k * k), plane([0.0, 1.0], 0.0)], h);
        let start = [0.0, 0.0, 2.0, 5.0, 3.0, 7.0];
        let at = |q: usize, s: f64| {
            let [a, b, c, d] = bent.passed(q, &start).expect("it is bent");
            a + s * (b + s * (c + s * d))
        };
        for s in [0.0, 0.02, h] {
            let moment = 3.0 * (k * s).cos() + 2.0 / k * (k * s).sin();
            let shear = -3.0 * k * (k * s).sin() + 2.0 * (k * s).cos();
            assert!((at(4, s) - moment).abs() < 3e-8, "{}", at(4, s) - moment);
            assert!((at(2, s) - shear).abs() < 3e-8);
            assert!((at(5, s) - (7.0 + 5.0 * s)).abs() < 1e-14 && (at(3, s) - 5.0).abs() < 1e-14);
        }
        // Half of a load along the part is passed at the middle: V = q sin(k s)/k.
        let q = bent
            .under(2, &[0.0, 0.0, 1.5, 0.0, 0.0, 0.0])
            .expect("it is bent");
        assert!(
            (q[0] + 0.02 * (q[1] + 0.02 * (q[2] + 0.02 * q[3])) - 1.5 * (k * 0.02).sin() / k).abs()
                < 1e-9
        );
    }
}
