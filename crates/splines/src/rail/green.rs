//! Green's function of an element clamped at both ends.
//!
//! This is what a rail element adds between its two node states: the displacement at one place under a unit
//! load at another, with both ends held. It exists in four forms. `Plane::ordered` is the statement of the
//! function itself; `Plane::magnitude` sums the absolute values of its terms, for bounds of rounding errors;
//! `SeparatedLoad` holds the factors that belong to one of the places, and `separated` expands these in powers of the
//! place, for the fast evaluation of many pairs.

use super::beam_column::BeamColumn;
use super::element::{MemberPlace, RailElement};
use super::load::AxisLoad;
use crate::compliance::Partials;
use crate::vector::RealNumber;

/// Roundings of the functions of a member under an axial force, relative to those of cubics.
pub(crate) const BENT_ROUNDINGS: f64 = 8.0;

/// One bending plane of a clamped Timoshenko beam; all zero where the plane is rigid.
#[derive(Clone, Copy, Debug)]
struct Plane<T = f64> {
    /// 1/EI.
    c: T,
    /// 1/kGA.
    g: T,
    /// Length l.
    l: T,
    /// 1/D, with D = c l^3 + 12 g l.
    inverse: T,
    /// The plane under an axial force: its functions then replace those above.
    column: Option<BeamColumn<T>>,
}

/// Shear V and bending moment m0 that a load causes at the near clamp, x = 0; or their derivatives.
#[derive(Clone, Copy)]
struct Reaction<T> {
    shear: T,
    moment: T,
}

impl<T: RealNumber> Plane<T> {
    fn new(bending: f64, shear: f64, tension: f64, l: T) -> Self {
        let [c, g, zero] = [bending, shear, 0.0].map(T::from);
        let d = (c * l * l + T::from(12.0) * g) * l;
        if d > zero && d < T::from(f64::INFINITY) {
            let column = (tension != 0.0).then(|| BeamColumn::new(bending, shear, tension, l));
            Plane {
                c,
                g,
                l,
                inverse: T::from(1.0) / d,
                column,
            }
        } else {
            Plane {
                c: zero,
                g: zero,
                l: zero,
                inverse: zero,
                column: None,
            }
        }
    }

    /// The reaction to a force F and a moment M at b, q = l - b from the far clamp, and its first and second
    /// derivatives by q.
    ///
    /// V  = (F q (c q (l + 2 b) + 12 g) - 6 c M q b)/D,
    /// m0 = q (F b (c l q + 6 g) + M (c l (q - 2 b) + 12 g))/D.
    ///
    /// No term of a force cancels another, so that the reaction keeps its digits near both clamps.
    #[inline(always)]
    fn reactions(&self, at: MemberPlace<T>, load: [T; 2]) -> [Reaction<T>; 3] {
        if let Some(column) = &self.column {
            return column_reactions(column, at, load);
        }
        let (MemberPlace { s: b, q }, [force, moment]) = (at, load);
        let Plane {
            c, g, l, inverse, ..
        } = *self;
        let [two, three, six, twelve] = [2.0, 3.0, 6.0, 12.0].map(T::from);
        let (cl, by_force) = (c * l, c * l * q + six * g);
        let by_moment = cl * (q - two * b) + twelve * g;
        let shear = q * (force * (c * q * (l + two * b) + twelve * g) - six * c * moment * b);
        let first = force * (six * c * q * b + twelve * g) + six * c * moment * (q - b);
        let second = six * c * force * (b - q) + twelve * c * moment;
        let bent = q * (force * b * by_force + moment * by_moment);
        let bent_first =
            force * ((b - q) * by_force + q * b * cl) + moment * (by_moment + three * q * cl);
        let bent_second = force * (two * (b - q) * cl - two * by_force) + six * cl * moment;
        [
            Reaction {
                shear: shear * inverse,
                moment: bent * inverse,
            },
            Reaction {
                shear: first * inverse,
                moment: bent_first * inverse,
            },
            Reaction {
                shear: second * inverse,
                moment: bent_second * inverse,
            },
        ]
    }

    /// Deflection v = g V a + c (m0 a^2/2 - V a^3/6) at a, between the near clamp and the load.
    #[inline(always)]
    fn deflection(&self, a: T, Reaction { shear, moment }: Reaction<T>) -> T {
        if let Some(column) = &self.column {
            return column.clamped_deflection(a, shear, moment);
        }
        a * (self.g * shear
            + self.c * a * (T::from(0.5) * moment - shear * a * T::from(1.0) / T::from(6.0)))
    }

    /// Rotation theta = c (m0 a - V a^2/2) there.
    #[inline(always)]
    fn rotation(&self, a: T, Reaction { shear, moment }: Reaction<T>) -> T {
        if let Some(column) = &self.column {
            return column.clamped_rotation(a, shear, moment);
        }
        self.c * a * (moment - T::from(0.5) * shear * a)
    }

    /// Green's function between the loads `p` at s and `q` at t, each a force and a moment, in either order of
    /// the places.
    fn value(&self, s: MemberPlace<T>, p: [T; 2], t: MemberPlace<T>, q: [T; 2]) -> T {
        if t.is_before(s) {
            return self.value(t, q, s, p);
        }
        if s.s > s.q {
            return self.value(t.mirrored(), turned(q), s.mirrored(), turned(p));
        }
        let [reaction, ..] = self.reactions(t, q);
        p[0] * self.deflection(s.s, reaction) + p[1] * self.rotation(s.s, reaction)
    }
}

/// The reactions of a clamped member under an axial force, and their derivatives: by reciprocity the transverse force H is
/// its shape function by the deflection of the near end, and the moment that by the rotation there.
fn column_reactions<T: RealNumber>(
    column: &BeamColumn<T>,
    at: MemberPlace<T>,
    [force, moment]: [T; 2],
) -> [Reaction<T>; 3] {
    let length = at.s + at.q;
    let is_near = at.s < at.q;
    // Seen from the far end, rotations and moments change their sign.
    let (distance, [by_deflection, by_rotation]) = if is_near {
        let [v, theta, ..] = column.shapes([force, moment]);
        (at.s, [v, theta])
    } else {
        let [_, _, v, theta] = column.shapes([force, -moment]);
        (at.q, [v, theta.map(|x| -x)])
    };
    let [values, first, second] = column.powers_with_derivatives(distance / length);
    // The second derivative has no sign; the first is by q.
    let rate = if is_near {
        -T::from(1.0) / length
    } else {
        T::from(1.0) / length
    };
    [(values, T::from(1.0)), (first, rate), (second, rate * rate)].map(|(of, scale)| {
        let sum = |c: &[T; 4]| scale * (c[0] * of[0] + c[1] * of[1] + c[2] * of[2] + c[3] * of[3]);
        Reaction {
            shear: sum(&by_deflection),
            moment: sum(&by_rotation),
        }
    })
}

/// A force and a moment as seen from the other end of the member: moments change their sign.
#[inline(always)]
fn turned<T: RealNumber>([force, moment]: [T; 2]) -> [T; 2] {
    [force, -moment]
}

impl Plane {
    /// theta' = c (m0 - V a), v' = theta + g V, theta'' = -c V and v'' = theta' there; under an axial force those of the
    /// beam-column.
    #[inline(always)]
    fn derivatives(&self, a: f64, reaction: Reaction<f64>) -> [f64; 4] {
        let Reaction { shear, moment } = reaction;
        if let Some(column) = &self.column {
            return column.clamped_derivatives(a, shear, moment);
        }
        let bend = self.c * (moment - shear * a);
        [
            bend,
            self.rotation(a, reaction) + self.g * shear,
            -(self.c * shear),
            bend,
        ]
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
    fn green(&self, a: f64, [f, m]: [f64; 2], b: MemberPlace, load: [f64; 2]) -> Partials {
        let [reaction, first, second] = self.reactions(b, load);
        let [bend, slope, turn, curvature] = self.derivatives(a, reaction);
        let [first_bend, first_slope, ..] = self.derivatives(a, first);
        // A derivative by b is the negative of one by q.
        Partials {
            value: f * self.deflection(a, reaction) + m * self.rotation(a, reaction),
            p: f * slope + m * bend,
            q: -(f * self.deflection(a, first) + m * self.rotation(a, first)),
            pp: f * curvature + m * turn,
            pq: -(f * first_slope + m * first_bend),
            qq: f * self.deflection(a, second) + m * self.rotation(a, second),
        }
    }

    /// `Plane::green` for a <= b, formed from the end that is nearer to a: a beam seen from its other end is
    /// the same beam.
    #[inline(always)]
    fn nearer_end(&self, a: MemberPlace, p: [f64; 2], b: MemberPlace, q: [f64; 2]) -> Partials {
        if a.s <= a.q {
            return self.green(a.s, p, b, q);
        }
        let seen = self
            .green(b.q, turned(q), a.mirrored(), turned(p))
            .swapped();
        Partials {
            p: -seen.p,
            q: -seen.q,
            ..seen
        }
    }

    /// Green's function between the loads `p` at s and `q` at t, each a force and a moment, in either order
    /// of the places. It is symmetric: b(s, p; t, q) = b(t, q; s, p) to the last bit. At s = t every
    /// derivative is the mean of both sides.
    #[inline(always)]
    fn ordered(&self, s: MemberPlace, p: [f64; 2], t: MemberPlace, q: [f64; 2]) -> Partials {
        if s.is_before(t) {
            self.nearer_end(s, p, t, q)
        } else if t.is_before(s) {
            self.nearer_end(t, q, s, p).swapped()
        } else {
            let one = self.nearer_end(s, p, t, q);
            one.mean(if p == q {
                one.swapped()
            } else {
                self.nearer_end(t, q, s, p).swapped()
            })
        }
    }

    /// Value and first derivatives of [`Plane::ordered`]. Forces without moments are taken out as one factor,
    /// so that equal places under different forces differ by that factor alone.
    #[inline(always)]
    fn pair(&self, s: MemberPlace, p: [f64; 2], t: MemberPlace, q: [f64; 2]) -> Partials {
        const FORCE: [f64; 2] = [1.0, 0.0];
        if self.inverse == 0.0 {
            Partials::default()
        } else if p[1] == 0.0 && q[1] == 0.0 {
            self.ordered(s, FORCE, t, FORCE).scaled(p[0] * q[0])
        } else {
            self.ordered(s, p, t, q)
        }
    }

    /// The factors near and far of Green's function for the load at a place, seen from the first end: two of each, then their
    /// derivatives by s.
    #[inline]
    fn factors(&self, at: MemberPlace, load: [f64; 2]) -> [[[f64; 2]; 2]; 2] {
        let [far, first, _] = self.reactions(at, load);
        let near = [[1.0, 0.0], [0.0, 1.0]].map(|[shear, moment]| {
            let unit = Reaction { shear, moment };
            let [bend, slope, ..] = self.derivatives(at.s, unit);
            let value = load[0] * self.deflection(at.s, unit) + load[1] * self.rotation(at.s, unit);
            [value, load[0] * slope + load[1] * bend]
        });
        let [[v, v_slope], [m, m_slope]] = near;
        [
            [[v, m], [v_slope, m_slope]],
            [[far.shear, far.moment], [-first.shear, -first.moment]],
        ]
    }

    /// Sum of the absolute values of the terms from which `Plane::green` of a place with itself is computed.
    fn magnitude(&self, at: MemberPlace, [f, m]: [f64; 2]) -> f64 {
        let MemberPlace { s, q } = if at.s <= at.q { at } else { at.mirrored() };
        let Plane {
            c, g, l, inverse, ..
        } = *self;
        let (f, m) = (f.abs(), m.abs());
        if let Some(column) = &self.column {
            let r = s / l;
            let powers = [1.0, r, r * r, r * r * r];
            let sizes = column.shape_sizes([f, m]);
            let of = |k: usize| sizes[k].iter().zip(powers).map(|(a, b)| a * b).sum::<f64>();
            let [deflection, rotation] = column.clamped_sizes(s, of(0), of(1));
            return BENT_ROUNDINGS * (f * deflection + m * rotation);
        }
        let shear = q * (f * (c * q * (l + 2.0 * s) + 12.0 * g) + 6.0 * c * m * s) * inverse;
        let moment =
            q * (f * s * (c * l * q + 6.0 * g) + m * (c * l * (q + 2.0 * s) + 12.0 * g)) * inverse;
        f * s * (g * shear + c * s * (0.5 * moment + shear * s * (1.0 / 6.0)))
            + m * c * s * (moment + 0.5 * shear * s)
    }
}

/// Value and first derivatives of Green's function of a clamped bar, axial or torsional:
/// b(s, t) = flexibility s (l - t)/l for s <= t.
fn bar(flexibility: f64, l: f64, s: MemberPlace, t: MemberPlace) -> Partials {
    let green = |a: f64, q: f64| Partials {
        value: flexibility * a * q / l,
        p: flexibility * q / l,
        q: -flexibility * a / l,
        ..Partials::default()
    };
    if s.is_before(t) {
        green(s.s, t.q)
    } else if t.is_before(s) {
        green(t.s, s.q).swapped()
    } else {
        green(s.s, t.q).mean(green(t.s, s.q).swapped())
    }
}

/// Green's function of an element clamped at both ends, between unit forces at the rail. Places are measured
/// along the member, 0..=length.
#[derive(Clone, Debug)]
pub(crate) struct ClampedElement<T = f64> {
    length: T,
    /// 1/EA and 1/GJ; zero where the section has no such stiffness.
    axial: T,
    torsion: T,
    xy: Plane<T>,
    xz: Plane<T>,
    /// Unit forces along the three rail directions, in the member's own axes.
    loads: [AxisLoad<T>; 3],
    /// As [`RailElement::without_stiffness`].
    without_stiffness: [bool; 4],
}

impl<T: RealNumber> ClampedElement<T> {
    pub fn new(element: &RailElement<T>) -> ClampedElement<T> {
        let flexibility = &element.flexibility;
        let finite = |x: f64| T::from(if x.is_finite() { x } else { 0.0 });
        ClampedElement {
            length: element.length,
            axial: finite(flexibility.axial),
            torsion: finite(flexibility.torsion),
            xy: Plane::new(
                flexibility.bending_z,
                flexibility.shear_y,
                flexibility.tension,
                element.length,
            ),
            xz: Plane::new(
                flexibility.bending_y,
                flexibility.shear_z,
                flexibility.tension,
                element.length,
            ),
            loads: [0, 1, 2].map(|axis| AxisLoad::new(element, &element.member_axes(), axis)),
            without_stiffness: element.without_stiffness(),
        }
    }

    /// Displacement along rail direction `a` at s under a unit force along direction `b` at t. The force acts
    /// on `other`, an element of the same member (or this one).
    pub fn value(
        &self,
        a: usize,
        s: MemberPlace<T>,
        other: &ClampedElement<T>,
        b: usize,
        t: MemberPlace<T>,
    ) -> T {
        let (p, q) = (&self.loads[a], &other.loads[b]);
        let zero = T::from(0.0);
        let mut sum = zero;
        for (plane, p, q) in [(&self.xy, p.xy, q.xy), (&self.xz, p.xz, q.xz)] {
            if plane.inverse != zero && p != [zero; 2] && q != [zero; 2] {
                sum = sum + plane.value(s, p, t, q);
            }
        }
        let bars = self.axial * p.axial * q.axial + self.torsion * p.twist * q.twist;
        if bars != zero {
            let (first, last) = if t.is_before(s) {
                (t.s, s.q)
            } else {
                (s.s, t.q)
            };
            sum = sum + bars * first * last / self.length;
        }
        sum
    }
}

impl ClampedElement {
    /// A unit force along rail direction `axis` in the member's own axes.
    pub fn load(&self, axis: usize) -> &AxisLoad {
        &self.loads[axis]
    }

    /// [`ClampedElement::value`] with its first derivatives by s and t.
    #[inline(always)]
    pub fn pair(
        &self,
        a: usize,
        s: MemberPlace,
        other: &ClampedElement,
        b: usize,
        t: MemberPlace,
    ) -> Partials {
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

    /// The factors of Green's function for a load along rail direction `axis` at a place, times `weight`. `rate` is the
    /// derivative of s by the rail coordinate.
    #[inline]
    pub fn separated(
        &self,
        axis: usize,
        place: MemberPlace,
        rate: f64,
        weight: f64,
    ) -> SeparatedLoad {
        let load = &self.loads[axis];
        let (mut near, mut far) = ([Factors::default(); 2], [Factors::default(); 2]);
        for (end, at) in [place, place.mirrored()].into_iter().enumerate() {
            let along = if end == 0 {
                rate * weight
            } else {
                -rate * weight
            };
            for (first, plane, load) in [(0, &self.xy, load.xy), (2, &self.xz, load.xz)] {
                if plane.inverse == 0.0 || load == [0.0; 2] {
                    continue;
                }
                let seen = if end == 0 { load } else { turned(load) };
                let both = plane.factors(at, seen);
                for (to, [value, slope]) in [&mut near[end], &mut far[end]].into_iter().zip(both) {
                    for k in 0..2 {
                        (to.value[first + k], to.slope[first + k]) =
                            (weight * value[k], along * slope[k]);
                    }
                }
            }
            let bars = [(self.axial, load.axial), (self.torsion, load.twist)];
            for (k, (flexibility, load)) in bars.into_iter().enumerate() {
                let by = load * flexibility / self.length;
                (near[end].value[4 + k], near[end].slope[4 + k]) =
                    (weight * load * at.s, along * load);
                (far[end].value[4 + k], far[end].slope[4 + k]) = (weight * by * at.q, -along * by);
            }
        }
        SeparatedLoad {
            place,
            uses: load.uses(),
            near,
            far,
        }
    }

    /// Second derivatives of [`ClampedElement::pair`] by s and t: `pp`, `pq` and `qq` alone.
    pub fn second_derivatives(
        &self,
        a: usize,
        s: MemberPlace,
        other: &ClampedElement,
        b: usize,
        t: MemberPlace,
    ) -> Partials {
        let (p, q) = (&self.loads[a], &other.loads[b]);
        let bending = |plane: &Plane, p: [f64; 2], q: [f64; 2]| {
            if plane.inverse == 0.0 {
                Partials::default()
            } else {
                plane.ordered(s, p, t, q)
            }
        };
        let mut sum = bending(&self.xy, p.xy, q.xy);
        sum.add(bending(&self.xz, p.xz, q.xz));
        // Bars are straight on both sides of the load; only the mixed derivative is not zero.
        let bars = self.axial * (p.axial * q.axial) + self.torsion * (p.twist * q.twist);
        sum.pq -= bars / self.length;
        sum
    }

    /// Deflection of the section at s in the x-y plane (`plane` = 0) or the x-z plane, and its derivative by s, under a unit
    /// force along rail direction `axis` at t.
    pub fn section(&self, plane: usize, s: MemberPlace, axis: usize, t: MemberPlace) -> [f64; 2] {
        let load = &self.loads[axis];
        let (of, load) = [(&self.xy, load.xy), (&self.xz, load.xz)][plane];
        let Partials { value, p, .. } = of.pair(s, [1.0, 0.0], t, load);
        [value, p]
    }

    /// Sum of the absolute values of the terms from which the displacement under the load `p` at a place is
    /// computed.
    pub fn magnitude(&self, p: &AxisLoad, at: MemberPlace) -> f64 {
        let bar = at.s * at.q / self.length;
        self.xy.magnitude(at, p.xy)
            + self.xz.magnitude(at, p.xz)
            + (self.axial * p.axial * p.axial + self.torsion * p.twist * p.twist) * bar
    }

    /// Whether forces along directions `a` and `b` both act in a way in which the section has no stiffness.
    pub fn is_without_stiffness(&self, a: usize, b: usize) -> bool {
        let (p, q) = (self.loads[a].uses(), self.loads[b].uses());
        (0..4).any(|k| self.without_stiffness[k] && p[k] && q[k])
    }
}

/// A load on a clamped element with its factors of Green's function b.
///
/// For a place s before t, b(s, t) = near(s) . far(t): far is the reaction (V, m0) at the first end to the load at t, near
/// the displacement along the load at s by such a reaction, for both planes of bending; then follow the axial bar and
/// torsion, b = s (l - t) / (stiffness l). The same holds from the last end with the places exchanged. As in `Plane::ordered`
/// the end is used that is nearer to the place between it and the other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeparatedLoad {
    place: MemberPlace,
    /// Whether the load bends in each plane, stretches and twists.
    uses: [bool; 4],
    /// By end.
    near: [Factors; 2],
    far: [Factors; 2],
}

/// Factors of both planes, two each, of the axial bar and of torsion, and their derivatives along the rail.
#[derive(Clone, Copy, Debug, Default)]
struct Factors {
    value: [f64; 6],
    slope: [f64; 6],
}

impl SeparatedLoad {
    /// Value and derivatives, by this place and by the other one, of Green's function between two loads on one element. At
    /// one place the derivatives are the means of both sides.
    #[inline]
    pub fn with(&self, other: &SeparatedLoad) -> [f64; 3] {
        if self.place.is_before(other.place) {
            return self.before(other);
        }
        let [value, by_other, by_own] = other.before(self);
        if other.place.is_before(self.place) {
            return [value, by_own, by_other];
        }
        let seen = self.before(other);
        [
            0.5 * (value + seen[0]),
            0.5 * (by_own + seen[1]),
            0.5 * (by_other + seen[2]),
        ]
    }

    /// Whether Green's function between the two can differ from zero: both bend in a common plane, stretch or twist.
    #[inline]
    pub fn meets(&self, other: &SeparatedLoad) -> bool {
        self.uses
            .iter()
            .zip(other.uses)
            .any(|(own, other)| *own && other)
    }

    /// The value alone: [`ClampedElement::value`] of the two.
    #[inline]
    pub fn value_with(&self, other: &SeparatedLoad) -> f64 {
        let (first, second) = if other.place.is_before(self.place) {
            (other, self)
        } else {
            (self, other)
        };
        let (near, far) = if first.place.s <= first.place.q {
            (&first.near[0], &second.far[0])
        } else {
            (&second.near[1], &first.far[1])
        };
        sum_of_products(&near.value, &far.value)
    }

    /// [`SeparatedLoad::with`] for a place that is not behind the other.
    #[inline]
    fn before(&self, other: &SeparatedLoad) -> [f64; 3] {
        let dot = sum_of_products;
        if self.place.s <= self.place.q {
            let (near, far) = (&self.near[0], &other.far[0]);
            [
                dot(&near.value, &far.value),
                dot(&near.slope, &far.value),
                dot(&near.value, &far.slope),
            ]
        } else {
            let (near, far) = (&other.near[1], &self.far[1]);
            [
                dot(&near.value, &far.value),
                dot(&near.value, &far.slope),
                dot(&near.slope, &far.value),
            ]
        }
    }
}

#[inline(always)]
fn sum_of_products(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    let two: [f64; 2] =
        std::array::from_fn(|k| a[k] * b[k] + a[2 + k] * b[2 + k] + a[4 + k] * b[4 + k]);
    two[0] + two[1]
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
        [false, false, true, false] if load.xy[1] == 0.0 => (
            load.xy[0],
            Plane::new(f.bending_z, f.shear_y, f.tension, element.length),
        ),
        [false, false, false, true] if load.xz[1] == 0.0 => (
            load.xz[0],
            Plane::new(f.bending_y, f.shear_z, f.tension, element.length),
        ),
        _ => return None,
    };
    let Plane {
        c,
        g,
        l,
        inverse,
        column,
    } = plane;
    if inverse == 0.0 {
        return Some([[[0.0; 4]; 4]; 2]);
    }
    if let Some(column) = column {
        return Some(
            column
                .separated()
                .map(|four| four.map(|of| of.map(|x| force * x))),
        );
    }
    let first = [
        [
            1.0,
            -12.0 * g * inverse,
            -3.0 * c * l * inverse,
            2.0 * c * inverse,
        ],
        [
            0.0,
            1.0 - 6.0 * g * l * inverse,
            -1.5 * c * l * l * inverse - 0.5 / l,
            c * l * inverse,
        ],
        [0.0, g, 0.0, -c / 6.0],
        [0.0, 0.0, 0.5 * c, 0.0],
    ];
    let last = [
        [
            0.0,
            12.0 * g * inverse,
            3.0 * c * l * inverse,
            -2.0 * c * inverse,
        ],
        [
            0.0,
            6.0 * g * l * inverse,
            1.5 * c * l * l * inverse - 0.5 / l,
            -c * l * inverse,
        ],
        [
            g * l - c * l * l * l / 6.0,
            0.5 * c * l * l - g,
            -0.5 * c * l,
            c / 6.0,
        ],
        [0.5 * c * l * l, -c * l, 0.5 * c, 0.0],
    ];
    let powers = [1.0, l, l * l, l * l * l];
    Some(
        [first, last]
            .map(|four| four.map(|cubic| std::array::from_fn(|p| force * cubic[p] * powers[p]))),
    )
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
            flexibility: Flexibility {
                bending_z: c,
                shear_y: g,
                ..Flexibility::default()
            },
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
                let [p, q] = [s, t].map(|s| MemberPlace { s, q: l - s });
                let known = whole.pair(1, p, &whole, 1, q).value;
                for end in [0, 1] {
                    let found = at(end, 0, s) * at(end, 2, t) + at(end, 1, s) * at(end, 3, t);
                    assert!(
                        (found - known).abs() < 1e-14,
                        "{s} {t}: {found}, not {known}"
                    );
                }
            }
        }
    }
}
