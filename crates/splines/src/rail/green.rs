//! Green's function of an element clamped at both ends.
//!
//! This is what a rail element adds between its two node states: the displacement at one place under a unit
//! load at another, with both ends held. It exists in three forms. `Plane::ordered` is the statement of the
//! function itself; `Plane::magnitude` sums the absolute values of its terms, for bounds of rounding errors;
//! and `separated` expands it in powers of the place, for the fast evaluation of many pairs.

use super::element::RailElement;
use super::load::AxisLoad;
use crate::compliance::Partials;

/// One bending plane of a clamped Timoshenko beam; all zero where the plane is rigid.
#[derive(Clone, Copy, Debug, Default)]
struct Plane {
    /// 1/EI.
    c: f64,
    /// 1/kGA.
    g: f64,
    /// Length l.
    l: f64,
    /// 1/l.
    per_l: f64,
    /// 1/D, with D = c l^3 + 12 g l.
    inverse: f64,
}

/// Shear V and bending moment m0 that a load causes at the near clamp, x = 0; or their derivatives.
#[derive(Clone, Copy)]
struct Reaction {
    shear: f64,
    moment: f64,
}

impl Plane {
    fn new(c: f64, g: f64, l: f64) -> Self {
        let d = (c * l * l + 12.0 * g) * l;
        if d > 0.0 && d.is_finite() {
            Plane { c, g, l, per_l: 1.0 / l, inverse: 1.0 / d }
        } else {
            Plane::default()
        }
    }

    /// The reaction to a force F and a moment M at b, and its first and second derivatives by q = l - b.
    ///
    /// V  = (F (c q^2 (3 l - 2 q) + 12 g q) - 6 c M q b)/D,
    /// m0 = V l/2 + q (M - F q/2)/l.
    #[inline(always)]
    fn reactions(&self, b: f64, [force, moment]: [f64; 2]) -> [Reaction; 3] {
        let Plane { c, g, l, per_l, inverse } = *self;
        let q = l - b;
        let shear =
            (force * q * (c * q * (3.0 * l - 2.0 * q) + 12.0 * g) - 6.0 * c * moment * q * b) * inverse;
        let first = (force * (6.0 * c * q * b + 12.0 * g) + 6.0 * c * moment * (q - b)) * inverse;
        let second = (6.0 * c * force * (b - q) + 12.0 * c * moment) * inverse;
        [
            Reaction { shear, moment: 0.5 * shear * l + q * (moment - 0.5 * force * q) * per_l },
            Reaction { shear: first, moment: 0.5 * first * l + (moment - force * q) * per_l },
            Reaction { shear: second, moment: 0.5 * second * l - force * per_l },
        ]
    }

    /// Deflection v = g V a + c (m0 a^2/2 - V a^3/6) at a, between the near clamp and the load.
    #[inline(always)]
    fn deflection(&self, a: f64, Reaction { shear, moment }: Reaction) -> f64 {
        a * (self.g * shear + self.c * a * (0.5 * moment - shear * a * (1.0 / 6.0)))
    }

    /// Rotation theta = c (m0 a - V a^2/2) there.
    #[inline(always)]
    fn rotation(&self, a: f64, Reaction { shear, moment }: Reaction) -> f64 {
        self.c * a * (moment - 0.5 * shear * a)
    }

    /// Slope v' = theta + g V there.
    #[inline(always)]
    fn slope(&self, a: f64, reaction: Reaction) -> f64 {
        self.rotation(a, reaction) + self.g * reaction.shear
    }

    /// Curvature v'' = theta' = c (m0 - V a) there.
    #[inline(always)]
    fn curvature(&self, a: f64, Reaction { shear, moment }: Reaction) -> f64 {
        self.c * (moment - shear * a)
    }

    /// Green's function of a clamped Timoshenko beam, and its derivatives.
    ///
    /// The beam obeys theta' = c m, m' = -V and v' = theta + g V between its ends 0 and l, where v = theta =
    /// 0. A force F and a moment M act at b; the value is f v(a) + m theta(a), for a <= b. Between the near
    /// clamp and the load no load acts, so that V is constant and v and theta follow from the reaction (V,
    /// m0) alone.
    ///
    /// # Source
    /// Cowper, The shear coefficient in Timoshenko's beam theory, J. Appl. Mech. 33 (1966).
    #[inline(always)]
    fn green(&self, a: f64, [f, m]: [f64; 2], b: f64, load: [f64; 2]) -> Partials {
        let [reaction, first, second] = self.reactions(b, load);
        // A derivative by b is the negative of one by q.
        Partials {
            value: f * self.deflection(a, reaction) + m * self.rotation(a, reaction),
            p: f * self.slope(a, reaction) + m * self.c * (reaction.moment - reaction.shear * a),
            q: -(f * self.deflection(a, first) + m * self.rotation(a, first)),
            pp: f * self.curvature(a, reaction) - m * self.c * reaction.shear,
            pq: -(f * self.slope(a, first) + m * self.curvature(a, first)),
            qq: f * self.deflection(a, second) + m * self.rotation(a, second),
        }
    }

    /// Green's function between the loads `p` at s and `q` at t, each a force and a moment, in either order
    /// of the places. It is symmetric: b(s, p; t, q) = b(t, q; s, p) to the last bit. At s = t every
    /// derivative is the mean of both sides.
    #[inline(always)]
    fn ordered(&self, s: f64, p: [f64; 2], t: f64, q: [f64; 2]) -> Partials {
        if s < t {
            self.green(s, p, t, q)
        } else if s > t {
            self.green(t, q, s, p).swapped()
        } else {
            let one = self.green(s, p, t, q);
            one.mean(if p == q { one.swapped() } else { self.green(t, q, s, p).swapped() })
        }
    }

    /// Value and first derivatives of [`Plane::ordered`]. Forces without moments are taken out as one factor,
    /// so that equal places under different forces differ by that factor alone.
    #[inline(always)]
    fn pair(&self, s: f64, p: [f64; 2], t: f64, q: [f64; 2]) -> Partials {
        const FORCE: [f64; 2] = [1.0, 0.0];
        if self.inverse == 0.0 {
            Partials::default()
        } else if p[1] == 0.0 && q[1] == 0.0 {
            self.ordered(s, FORCE, t, FORCE).scaled(p[0] * q[0])
        } else {
            self.ordered(s, p, t, q)
        }
    }

    /// Sum of the absolute values of the terms from which [`Plane::green`] of a place with itself is
    /// computed.
    fn magnitude(&self, s: f64, [f, m]: [f64; 2]) -> f64 {
        let Plane { c, g, l, per_l, inverse } = *self;
        let (q, f, m) = (l - s, f.abs(), m.abs());
        let shear = (f * q * (c * q * 3.0 * l + 12.0 * g) + 6.0 * c * m * q * s) * inverse;
        let moment = 0.5 * shear * l + q * (m + 0.5 * f * q) * per_l;
        f * s * (g * shear + c * s * (0.5 * moment + shear * s * (1.0 / 6.0)))
            + m * c * s * (moment + 0.5 * shear * s)
    }
}

/// Value and first derivatives of Green's function of a clamped bar, axial or torsional:
/// b(s, t) = flexibility s (l - t)/l for s <= t.
fn bar(flexibility: f64, l: f64, s: f64, t: f64) -> Partials {
    let green = |a: f64, b: f64| Partials {
        value: flexibility * a * (l - b) / l,
        p: flexibility * (l - b) / l,
        q: -flexibility * a / l,
        ..Partials::default()
    };
    if s < t {
        green(s, t)
    } else if s > t {
        green(t, s).swapped()
    } else {
        green(s, t).mean(green(t, s).swapped())
    }
}

/// Green's function of an element clamped at both ends, between unit forces at the rail. Places are measured
/// along the member, 0..=length.
#[derive(Clone, Debug, Default)]
pub(crate) struct ClampedElement {
    length: f64,
    /// 1/EA and 1/GJ; zero where the section has no such stiffness.
    axial: f64,
    torsion: f64,
    xy: Plane,
    xz: Plane,
    /// Unit forces along the three rail directions, in the member's own axes.
    loads: [AxisLoad; 3],
    /// As [`RailElement::without_stiffness`].
    without_stiffness: [bool; 4],
}

impl ClampedElement {
    pub fn new(element: &RailElement) -> ClampedElement {
        let flexibility = &element.flexibility;
        let finite = |x: f64| if x.is_finite() { x } else { 0.0 };
        ClampedElement {
            length: element.length,
            axial: finite(flexibility.axial),
            torsion: finite(flexibility.torsion),
            xy: Plane::new(flexibility.bending_z, flexibility.shear_y, element.length),
            xz: Plane::new(flexibility.bending_y, flexibility.shear_z, element.length),
            loads: [0, 1, 2].map(|axis| AxisLoad::new(element, &element.member_axes(), axis)),
            without_stiffness: element.without_stiffness(),
        }
    }

    /// Displacement along rail direction `a` at s under a unit force along direction `b` at t, with its first
    /// derivatives by s and t. The force acts on `other`, an element of the same member (or this one).
    #[inline(always)]
    pub fn pair(&self, a: usize, s: f64, other: &ClampedElement, b: usize, t: f64) -> Partials {
        let (p, q) = (&self.loads[a], &other.loads[b]);
        let mut sum = Partials::default();
        if p.xy != [0.0; 2] && q.xy != [0.0; 2] {
            sum.add(self.xy.pair(s, p.xy, t, q.xy));
        }
        if p.xz != [0.0; 2] && q.xz != [0.0; 2] {
            sum.add(self.xz.pair(s, p.xz, t, q.xz));
        }
        let axial = self.axial * (p.axial * q.axial);
        if axial != 0.0 {
            sum.add(bar(axial, self.length, s, t));
        }
        let twist = self.torsion * (p.twist * q.twist);
        if twist != 0.0 {
            sum.add(bar(twist, self.length, s, t));
        }
        sum
    }

    /// Second derivatives of [`ClampedElement::pair`] by s and t: `pp`, `pq` and `qq` alone.
    pub fn second_derivatives(&self, a: usize, s: f64, other: &ClampedElement, b: usize, t: f64) -> Partials {
        let (p, q) = (&self.loads[a], &other.loads[b]);
        let bending = |plane: &Plane, p: [f64; 2], q: [f64; 2]| {
            if plane.inverse == 0.0 { Partials::default() } else { plane.ordered(s, p, t, q) }
        };
        let mut sum = bending(&self.xy, p.xy, q.xy);
        sum.add(bending(&self.xz, p.xz, q.xz));
        // Bars are straight on both sides of the load; only the mixed derivative is not zero.
        let bars = self.axial * (p.axial * q.axial) + self.torsion * (p.twist * q.twist);
        sum.pq -= bars / self.length;
        sum
    }

    /// Sum of the absolute values of the terms from which the displacement along direction `a` at s under a
    /// unit force there is computed.
    pub fn magnitude(&self, a: usize, s: f64) -> f64 {
        let p = &self.loads[a];
        let bar = s * (self.length - s) / self.length;
        self.xy.magnitude(s, p.xy)
            + self.xz.magnitude(s, p.xz)
            + (self.axial * p.axial * p.axial + self.torsion * p.twist * p.twist) * bar
    }

    /// Whether forces along directions `a` and `b` both act in a way in which the section has no stiffness.
    pub fn is_without_stiffness(&self, a: usize, b: usize) -> bool {
        let (p, q) = (self.loads[a].uses(), self.loads[b].uses());
        (0..4).any(|k| self.without_stiffness[k] && p[k] && q[k])
    }
}

/// Green's function along one rail direction as b(s, t) = far(s) . near(t) for s >= t, far and near having
/// two entries each, which are cubics in the place.
///
/// `[end][k][p]`: coefficients of r^p, r being the distance from the first (`end` = 0) or last end of the
/// member in lengths of the member; k = 0, 1 are the entries of far, k = 2, 3 those of near. For a plane they
/// are the reaction (V, m0) to a unit force at s and what it causes at t:
///
/// b = V (g t - c t^3/6) + m0 c t^2/2,
///
/// as in `Plane::green`, expanded in powers. `None` where the direction involves more than one plane or the
/// axial bar, or a moment.
pub(crate) fn separated(element: &RailElement, axis: usize) -> Option<[[[f64; 4]; 4]; 2]> {
    if element.is_rigid_arm() {
        return Some([[[0.0; 4]; 4]; 2]);
    }
    let f = &element.flexibility;
    let load = AxisLoad::new(element, &element.member_axes(), axis);
    let (force, plane) = match load.uses() {
        [true, false, false, false] if f.axial.is_finite() => {
            let scale = f.axial * load.axial * load.axial * element.length;
            let (rise, fall) = ([0.0, 1.0, 0.0, 0.0], [1.0, -1.0, 0.0, 0.0]);
            let zero = [0.0; 4];
            let ends = [[fall, rise], [rise, fall]];
            return Some(ends.map(|[far, near]| [far.map(|x| scale * x), zero, near, zero]));
        }
        [false, false, true, false] if load.xy[1] == 0.0 => {
            (load.xy[0], Plane::new(f.bending_z, f.shear_y, element.length))
        }
        [false, false, false, true] if load.xz[1] == 0.0 => {
            (load.xz[0], Plane::new(f.bending_y, f.shear_z, element.length))
        }
        _ => return None,
    };
    let Plane { c, g, l, inverse, .. } = plane;
    if inverse == 0.0 {
        return Some([[[0.0; 4]; 4]; 2]);
    }
    let first = [
        [1.0, -12.0 * g * inverse, -3.0 * c * l * inverse, 2.0 * c * inverse],
        [0.0, 1.0 - 6.0 * g * l * inverse, -1.5 * c * l * l * inverse - 0.5 / l, c * l * inverse],
        [0.0, g, 0.0, -c / 6.0],
        [0.0, 0.0, 0.5 * c, 0.0],
    ];
    let last = [
        [0.0, 12.0 * g * inverse, 3.0 * c * l * inverse, -2.0 * c * inverse],
        [0.0, 6.0 * g * l * inverse, 1.5 * c * l * l * inverse - 0.5 / l, -c * l * inverse],
        [g * l - c * l * l * l / 6.0, 0.5 * c * l * l - g, -0.5 * c * l, c / 6.0],
        [0.5 * c * l * l, -c * l, 0.5 * c, 0.0],
    ];
    let powers = [1.0, l, l * l, l * l * l];
    Some([first, last].map(|four| four.map(|cubic| std::array::from_fn(|p| force * cubic[p] * powers[p]))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rail::element::{Flexibility, IDENTITY};

    /// The two forms of Green's function agree to rounding, for every pair of places of a Timoshenko beam.
    #[test]
    fn separated_form_is_greens_function() {
        let (c, g, l) = (0.3, 0.7, 2.5);
        let element = RailElement {
            rail: 0,
            x: [0.0, l],
            ends: [0, 1],
            length: l,
            frame: IDENTITY,
            offset: [0.0; 3],
            flexibility: Flexibility { bending_z: c, shear_y: g, ..Flexibility::default() },
            member: None,
        };
        let whole = ClampedElement::new(&element);
        let cubics = separated(&element, 1).expect("one plane without a moment");
        let at = |end: usize, k: usize, x: f64| {
            let r = if end == 0 { x / l } else { 1.0 - x / l };
            cubics[end][k].iter().rev().fold(0.0, |sum, a| sum * r + a)
        };
        for i in 0..=20 {
            for j in 0..=i {
                let (s, t) = (l * f64::from(i) / 20.0, l * f64::from(j) / 20.0);
                let known = whole.pair(1, s, &whole, 1, t).value;
                for end in [0, 1] {
                    let found = at(end, 0, s) * at(end, 2, t) + at(end, 1, s) * at(end, 3, t);
                    assert!((found - known).abs() < 1e-14, "{s} {t}: {found}, not {known}");
                }
            }
        }
    }
}
