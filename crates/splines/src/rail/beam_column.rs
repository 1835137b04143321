//! One bending plane of a uniform member that carries an axial force: the beam-column.
//!
//! A member with the axial force N, positive in tension, stores the energy
//!
//! 1/2 integral of theta'^2/c + (w' - theta)^2/g + N w'^2,    c = 1/EI, g = 1/kGA
//!
//! in small motions about its loaded state (Engesser's theory; with g = 0 that of Euler and Bernoulli). With
//! mu = 1 + g N it follows that H = V + N w' is constant between loads, and
//!
//! theta'' = lambda^2 theta - c H/mu,    w' = (theta + g H)/mu,    lambda^2 = c N/mu.
//!
//! So theta and w are combinations of 1, x, x^2 C2 and x^3 C3, where C2 = (cosh lambda x - 1)/(lambda x)^2 and C3 =
//! (sinh lambda x - lambda x)/(lambda x)^3: the powers of the cubic with both bent by the axial force. The coefficients of
//! these four, in place of those of the powers, are all that changes against the member without axial force.
//!
//! Everything that belongs to the member as a whole follows from one function of z = (lambda l/2)^2, which is negative in
//! compression:
//!
//! F(z) = (h coth h - 1)/h^2 = 1/(3 + z/(5 + z/(7 + ...))),    h^2 = z
//!
//! Rotations of both ends that are opposite meet the stiffness 2 EI/l (1 + z F), equal ones 2 l/(c l^2 F + 4 g). The
//! continued fraction has one form for tension, compression and none, in which nothing cancels where z is small.
//!
//! # Source
//! Timoshenko and Gere, Theory of Elastic Stability (1961), chapters 1 and 2; Engesser's shear: section 2.17. Continued
//! fraction of Lambert: NIST Handbook of Mathematical Functions, 4.39.1. C2 and C3 with their recurrence: Battin, An
//! Introduction to the Mathematics and Methods of Astrodynamics (1999), section 4.5.

use super::load::size;
use crate::vector::RealNumber;

/// Terms of the continued fraction at z = 0; each four of |z| more need four further ones.
const LEAST_TERMS: usize = 32;
/// Argument up to which the series of C2 and C3 are summed.
const SMALL: f64 = 0.25;
/// Most terms of these series: they end long before.
const MOST_TERMS: f64 = 40.0;
/// Pairs of powers of the series of a shape.
const SERIES: usize = 10;
/// Most doublings of the argument of C2 and C3: those of the largest double.
const MOST_DOUBLINGS: usize = 520;

/// One bending plane of a uniform member under an axial force.
///
/// ```
/// use splines::BeamColumn;
///
/// // EI = 1, l = 1, rigid in shear, under half of its Euler load: its ends still resist being turned.
/// let compressed = BeamColumn::new(1.0, 0.0, -0.5 * std::f64::consts::PI.powi(2), 1.0_f64);
/// let [opposite, equal] = compressed.rotational_stiffness();
/// assert!(opposite < 2.0 && equal < 6.0);
/// // Without axial force they are 2 EI/l and 6 EI/l.
/// let [opposite, equal] = BeamColumn::new(1.0, 0.0, 0.0, 1.0_f64).rotational_stiffness();
/// assert!((opposite - 2.0).abs() < 1e-15 && (equal - 6.0).abs() < 1e-14);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamColumn<T> {
    /// 1/EI and 1/kGA.
    flexibility: [T; 2],
    tension: T,
    length: T,
    /// 1 + N/kGA.
    mu: T,
    /// (lambda l/2)^2.
    z: T,
    /// F.
    ratio: T,
    /// 1 + z F.
    symmetric: T,
    /// F c l^2/(c l^2 F + 4 g) and 4 g/(c l^2 F + 4 g): the shares of bending and shear where both ends turn alike.
    shares: [T; 2],
    /// c l^2/(c l^2 F + 4 g).
    kappa: T,
}

impl<T: RealNumber> BeamColumn<T> {
    /// The plane with the flexibilities 1/EI = `bending` and 1/kGA = `shear`, the axial force `tension` and the length
    /// `length` of the member.
    ///
    /// Flexibilities are finite; 1 + `shear` `tension` is positive, or the results have no meaning.
    #[must_use]
    pub fn new(bending: f64, shear: f64, tension: f64, length: T) -> BeamColumn<T> {
        let [c, g, n, one, four] = [bending, shear, tension, 1.0, 4.0].map(T::from);
        let mu = one + g * n;
        let bent = c * length * length;
        let z = bent * n / (four * mu);
        let ratio = rotation_ratio(z);
        let (own, sheared) = (bent * ratio, four * g);
        let total = own + sheared;
        // A plane that is rigid in bending and in shear has the shapes of one that is rigid in shear alone.
        let (shares, kappa) = if total == T::from(0.0) {
            ([one, total], one / ratio)
        } else {
            ([own / total, sheared / total], bent / total)
        };
        BeamColumn {
            flexibility: [c, g],
            tension: n,
            length,
            mu,
            z,
            ratio,
            symmetric: one + z * ratio,
            shares,
            kappa,
        }
    }

    /// Moments at the ends per unit of rotation: where both ends turn by opposite angles, and where they turn by equal
    /// ones; the ends do not deflect. Force length/radian.
    #[must_use]
    pub fn rotational_stiffness(&self) -> [T; 2] {
        let [c, _] = self.flexibility;
        let two = T::from(2.0);
        let ends = two / (c * self.length);
        [ends * self.symmetric, ends * self.kappa]
    }

    /// Axial force divided by the length: what resists a transverse displacement of one end against the other, beside the
    /// moments at the ends.
    #[must_use]
    pub fn chord_stiffness(&self) -> T {
        self.tension / self.length
    }

    /// (lambda l)^2: N l^2/EI without shear; negative in compression.
    #[must_use]
    pub fn square(&self) -> T {
        T::from(4.0) * self.z
    }

    /// Absolute values of all numbers, for bounds of what is computed from them.
    fn absolute(&self) -> BeamColumn<T> {
        BeamColumn {
            tension: size(self.tension),
            z: size(self.z),
            symmetric: size(self.symmetric),
            shares: self.shares.map(size),
            kappa: size(self.kappa),
            ..*self
        }
    }

    /// force v + moment theta as combinations of the four functions ([`BeamColumn::powers`]) of the fraction of the length,
    /// by (v, theta) at the first end, then at the last.
    pub(crate) fn shapes(&self, load: [T; 2]) -> [[T; 4]; 4] {
        self.combinations(load, T::from(-1.0))
    }

    /// Coefficients of powers of the fraction of the length, up to one half, that bound the terms of
    /// [`BeamColumn::shapes`] for the sizes of a force and a moment.
    pub(crate) fn shape_sizes(&self, load: [T; 2]) -> [[T; 4]; 4] {
        let [growth, one] = [bent_powers(self.z)[0], T::from(1.0)];
        let growth = if growth > one { growth } else { one };
        self.absolute()
            .combinations(load, one)
            .map(|[a, b, c, d]| [a, b, growth * c, growth * d])
    }

    /// `minus` is -1, or 1 for the sum of the sizes of all terms.
    fn combinations(&self, [force, moment]: [T; 2], minus: T) -> [[T; 4]; 4] {
        let [zero, half, one, two, third] = [0.0, 0.5, 1.0, 2.0, 1.0].map(T::from);
        let third = third / T::from(3.0);
        let BeamColumn {
            length: l,
            mu,
            z,
            symmetric,
            shares: [bent, sheared],
            kappa,
            ..
        } = *self;
        let [_, g] = self.flexibility;
        let (over, curved) = (one / mu, kappa / mu);
        let chord = (sheared + g * self.tension) * over;
        let cubic = two * third * (z + curved) * over;
        let turned = symmetric + kappa;
        let kept = symmetric + minus * kappa;
        let v = [
            [one, minus * chord, minus * curved, cubic],
            [
                zero,
                l * over * (bent + half * sheared),
                minus * half * l * over * turned,
                l * third * over * (two * z + curved),
            ],
            [zero, chord, curved, minus * cubic],
            [
                zero,
                minus * half * l * over * sheared,
                half * l * over * kept,
                l * third * over * curved,
            ],
        ];
        let [rise, bow, twist] = [
            two * kappa / l,
            two * (z + curved) / l,
            two * two * third * z * kappa / l,
        ];
        let theta = [
            [zero, minus * rise, bow, minus * twist],
            [
                one,
                minus * turned,
                two * z + curved,
                minus * two * third * z * turned,
            ],
            [zero, rise, minus * bow, twist],
            [zero, kept, curved, two * third * z * kept],
        ];
        let mix = |k: usize| std::array::from_fn(|p| force * v[k][p] + moment * theta[k][p]);
        [mix(0), mix(1), mix(2), mix(3)]
    }

    /// The four functions 1, r, 2 r^2 C2 and 6 r^3 C3 of the fraction r of the length, which are the powers of r without
    /// axial force, with their first and second derivatives.
    #[inline]
    pub(crate) fn powers_with_derivatives(&self, r: T) -> [[T; 4]; 3] {
        let [first, second] = power_derivatives(self.square(), r);
        [powers(self.square(), r), first, second]
    }

    /// Green's function of the clamped member between forces as far(s) . near(t) for s >= t, two entries each:
    /// `[end][k]` are coefficients of [`BeamColumn::powers_with_derivatives`] by the distance from either end, k = 0, 1 of
    /// far, k = 2, 3 of near. Far is the reaction (H, m0) to a unit force at s, near what each part of it causes at t.
    pub(crate) fn separated(&self) -> [[[T; 4]; 4]; 2] {
        let [zero, half, one, two, three] = [0.0, 0.5, 1.0, 2.0, 3.0].map(T::from);
        let [c, g] = self.flexibility;
        let (l, over) = (self.length, one / self.mu);
        let [v0, t0, v1, t1] = self.shapes([one, zero]);
        let by_force = [
            zero,
            g * l * over,
            zero,
            zero - c * l * l * l * over * over / (two * three),
        ];
        let by_moment = [zero, zero, half * c * l * l * over, zero];
        // A combination of the four functions, seen from the other end by its value and derivatives there.
        let seen = |of: [T; 4]| {
            let [c0, c1, c2, c3] = bent_powers(self.square());
            let square = self.square();
            let (bow, twist) = (two * of[2], two * three * of[3]);
            let third = bow * square * c1 + twist * c0;
            [
                of[0] + of[1] + bow * c2 + twist * c3,
                zero - (of[1] + bow * c1 + twist * c2),
                half * (bow * c0 + twist * c1),
                zero - third / (two * three),
            ]
        };
        [
            [v0, t0, by_force, by_moment],
            [v1, t1.map(|x| zero - x), seen(by_force), seen(by_moment)],
        ]
    }

    /// Moment at the clamped ends under a uniform load, by that without axial force, q l^2/12: 3 F/mu.
    #[must_use]
    pub fn uniform_end_moment(&self) -> T {
        T::from(3.0) * self.ratio / self.mu
    }

    /// Axial force times the deflection of the clamped member under a uniform load of intensity one, at the fraction `at` of the
    /// length; and times its slope there.
    ///
    /// With s = 2 at - 1 the moment is l^2/(4 mu) (s^2 C2(z s^2) - C3(z))/C1(z); less its value at the end, and less the moment
    /// of the loads alone, it is that of the axial force.
    #[must_use]
    pub fn under_uniform_load(&self, at: T) -> [T; 2] {
        let [quarter, half, one] = [0.25, 0.5, 1.0].map(T::from);
        let s = at + at - one;
        let [_, c1, c2, _] = bent_powers(self.z * s * s);
        let [_, all, _, c3] = bent_powers(self.z);
        let l = self.length;
        let moment = ((s * s * c2 - c3) / all - self.ratio) / self.mu;
        [
            quarter * l * l * (moment - half * (s * s - one)),
            half * l * s * (c1 / (self.mu * all) - one),
        ]
    }

    /// Deflection, slope, rotation and its derivative at the distance `a` from the nearer end of the clamped member under a
    /// uniform load of intensity one:
    ///
    /// theta = c a (m0 C1 - H a C2/mu + a^2 C3/mu),    w = (c a^2 (m0 C2 - H a C3/mu + a^2 C4/mu) + g (H a - a^2/2))/mu
    ///
    /// with H = l/2 and m0 = l^2 F/(4 mu) at the end.
    pub(crate) fn clamped_under_load(&self, a: T) -> [T; 4] {
        let [quarter, half] = [0.25, 0.5].map(T::from);
        let [c, g] = self.flexibility;
        let (l, mu) = (self.length, self.mu);
        let r = a / l;
        let square = self.square() * r * r;
        let [c0, c1, c2, c3] = bent_powers(square);
        let moment = quarter * l * l * self.ratio / mu;
        let force = half * l;
        let theta = c * a * (moment * c1 - a * (force * c2 - a * c3) / mu);
        let bent = c * a * a * (moment * c2 - a * (force * c3 - a * fourth_power(square)) / mu);
        let w = (bent + g * a * (force - half * a)) / mu;
        let slope = (theta + g * (force - a)) / mu;
        let bend = c * (moment * c0 - a * (force * c1 - a * c2) / mu);
        [w, slope, theta, bend]
    }

    /// Deflection of the section at the fraction `at` of the length and its derivative by the place, by deflection and
    /// rotation of the first end, then of the last: `[0]` and `[1]`.
    #[must_use]
    pub fn section(&self, at: T) -> [[T; 4]; 2] {
        let [zero, one] = [0.0, 1.0].map(T::from);
        let far = one - at;
        let is_near = at < far;
        let mut shapes = self.shapes([one, zero]);
        if !is_near {
            let [v0, t0, v1, t1] = shapes;
            shapes = [v1, t1.map(|x| zero - x), v0, t0.map(|x| zero - x)];
        }
        let [of, by_r, _] = self.powers_with_derivatives(if is_near { at } else { far });
        let rate = if is_near {
            one / self.length
        } else {
            zero - one / self.length
        };
        let sum =
            |c: [T; 4], of: &[T; 4]| c[0] * of[0] + c[1] * of[1] + c[2] * of[2] + c[3] * of[3];
        [
            shapes.map(|c| sum(c, &of)),
            shapes.map(|c| rate * sum(c, &by_r)),
        ]
    }

    /// Deflection at the distance a from a clamp with the transverse force H and the moment m0:
    ///
    /// w = (c m0 a^2 C2 + H (g a - c a^3 C3/mu))/mu.
    #[inline]
    pub(crate) fn clamped_deflection(&self, a: T, force: T, moment: T) -> T {
        let [c, g] = self.flexibility;
        let [_, _, c2, c3] = self.bent(a);
        a * (force * g + c * a * (moment * c2 - force * a * c3 / self.mu)) / self.mu
    }

    /// Rotation there, theta = c m0 a C1 - c H a^2 C2/mu.
    #[inline]
    pub(crate) fn clamped_rotation(&self, a: T, force: T, moment: T) -> T {
        let [c, _] = self.flexibility;
        let [_, c1, c2, _] = self.bent(a);
        c * a * (moment * c1 - force * a * c2 / self.mu)
    }

    /// C0 to C3 at the distance a from an end.
    fn bent(&self, a: T) -> [T; 4] {
        let r = a / self.length;
        bent_powers(self.square() * r * r)
    }

    /// Sizes of the terms of deflection and rotation at the distance a from a clamp with force and moment of these sizes.
    pub(crate) fn clamped_sizes(&self, a: T, force: T, moment: T) -> [T; 2] {
        let [c, g] = self.flexibility;
        let [c0, c1, c2, c3] = self.bent(a).map(size);
        let one = T::from(1.0);
        let c1 = if c1 > one { c1 } else { one };
        let c1 = if c0 > c1 { c0 } else { c1 };
        [
            a * (force * g + c * a * (moment * c2 + force * a * c3 / self.mu)) / self.mu,
            c * a * (moment * c1 + force * a * c2 / self.mu),
        ]
    }
}

impl BeamColumn<f64> {
    /// Deflection and rotation by powers of the fraction of the length, by deflection and rotation of the first end, then of
    /// the last: cubic and quadratic without axial force; with it the polynomials of degree eight through nine places, which
    /// err by about 1e-10 (lambda l)^8. For |lambda l| of a few.
    ///
    /// ```
    /// use splines::BeamColumn;
    ///
    /// let [[deflection, rotation], ..] = BeamColumn::new(1.0, 0.0, -1.0, 1.0).polynomials();
    /// assert!(deflection.iter().sum::<f64>().abs() < 1e-14 && rotation[0] == 0.0);
    /// ```
    #[must_use]
    pub fn polynomials(&self) -> [[[f64; 9]; 2]; 4] {
        let square = self.square();
        let series = |of: [f64; 4]| {
            let mut out = [0.0; 2 * SERIES];
            (out[0], out[1]) = (of[0], of[1]);
            let (mut second, mut third) = (of[2], of[3]);
            for k in 1..SERIES {
                (out[2 * k], out[2 * k + 1]) = (second, third);
                let p = (2 * k) as f64;
                second *= square / ((p + 1.0) * (p + 2.0));
                third *= square / ((p + 2.0) * (p + 3.0));
            }
            lowered(&out)
        };
        let [deflections, rotations] = [[1.0, 0.0], [0.0, 1.0]].map(|load| self.shapes(load));
        std::array::from_fn(|k| [series(deflections[k]), series(rotations[k])])
    }

    /// First derivatives of [`BeamColumn::clamped_rotation`] and of the deflection by a, then the second ones: theta', w',
    /// theta'', w''.
    #[inline]
    pub(crate) fn clamped_derivatives(&self, a: f64, force: f64, moment: f64) -> [f64; 4] {
        let [c, g] = self.flexibility;
        let [c0, c1, _, _] = self.bent(a);
        let theta = self.clamped_rotation(a, force, moment);
        let bend = c * (moment * c0 - force * a * c1 / self.mu);
        let lambda = self.square() / (self.length * self.length);
        [
            bend,
            (theta + g * force) / self.mu,
            lambda * theta - c * force / self.mu,
            bend / self.mu,
        ]
    }
}

/// The functions of [`BeamColumn::powers`] where (lambda l)^2 = `square`.
#[inline]
pub(crate) fn powers<T: RealNumber>(square: T, r: T) -> [T; 4] {
    let [_, _, c2, c3] = bent_powers(square * r * r);
    [
        T::from(1.0),
        r,
        T::from(2.0) * r * r * c2,
        T::from(6.0) * r * r * r * c3,
    ]
}

/// First and second derivatives of [`powers`] by r.
#[inline]
pub(crate) fn power_derivatives<T: RealNumber>(square: T, r: T) -> [[T; 4]; 2] {
    let [c0, c1, c2, _] = bent_powers(square * r * r);
    let [zero, one, two, six] = [0.0, 1.0, 2.0, 6.0].map(T::from);
    [
        [zero, one, two * r * c1, six * r * r * c2],
        [zero, zero, two * c0, six * r * c1],
    ]
}

/// C0 = cosh x, C1 = sinh x/x, C2 = (cosh x - 1)/x^2 and C3 = (sinh x - x)/x^3 for x^2 = z; the circular functions where
/// z is negative.
///
/// The series of C2 and C3 are summed for z/4^m; each doubling of x then takes C2 = C1^2/2 and C3 = (C2 + C0 C3)/4.
fn bent_powers<T: RealNumber>(z: T) -> [T; 4] {
    let [one, half, quarter, small] = [1.0, 0.5, 0.25, SMALL].map(T::from);
    let mut reduced = z;
    let mut doublings = 0;
    while size(reduced) > small && doublings < MOST_DOUBLINGS {
        reduced = reduced * quarter;
        doublings += 1;
    }
    let (mut term, mut c2, mut c3) = (half, half, half / T::from(3.0));
    let mut other = c3;
    let mut k = 4.0;
    while k < 2.0 * MOST_TERMS {
        term = term * reduced / T::from((k - 1.0) * k);
        other = other * reduced / T::from(k * (k + 1.0));
        let next = c2 + term;
        c3 = c3 + other;
        if next == c2 {
            break;
        }
        c2 = next;
        k += 2.0;
    }
    for _ in 0..doublings {
        let (c0, c1) = (one + reduced * c2, one + reduced * c3);
        (c2, c3) = (half * c1 * c1, quarter * (c2 + c0 * c3));
        reduced = reduced * T::from(4.0);
    }
    [one + z * c2, one + z * c3, c2, c3]
}

/// The polynomial of degree eight that has the values of another, given by its coefficients, at nine places of the interval from
/// 0 to 1, the extrema of the polynomial of Chebyshev of degree eight, both ends among them.
#[must_use]
pub fn lowered(coefficients: &[f64]) -> [f64; 9] {
    // Monic, zero at the places.
    let mut zero = [0.0; 10];
    zero[0] = 1.0;
    for k in 0..9 {
        let place = 0.5 * (1.0 - (std::f64::consts::PI * f64::from(k) / 8.0).cos());
        for p in (0..10).rev() {
            zero[p] = if p > 0 { zero[p - 1] } else { 0.0 } - place * zero[p];
        }
    }
    let mut out: [f64; 9] = std::array::from_fn(|p| coefficients.get(p).copied().unwrap_or(0.0));
    // The remainder of each higher power.
    let mut power = [0.0; 9];
    power[8] = 1.0;
    for c in coefficients.iter().skip(9) {
        let top = power[8];
        for p in (0..9).rev() {
            power[p] = if p > 0 { power[p - 1] } else { 0.0 } - top * zero[p];
        }
        out.iter_mut()
            .zip(power)
            .for_each(|(out, power)| *out += c * power);
    }
    out
}

/// C4 = (cosh x - 1 - x^2/2)/x^4 with x^2 = z.
fn fourth_power<T: RealNumber>(z: T) -> T {
    if size(z) > T::from(1.0) {
        let [_, _, c2, _] = bent_powers(z);
        return (c2 - T::from(0.5)) / z;
    }
    let (mut term, mut sum) = (T::from(1.0 / 24.0), T::from(0.0));
    let mut k = 5.0;
    while k < 2.0 * MOST_TERMS {
        sum = sum + term;
        term = term * z / T::from(k * (k + 1.0));
        k += 2.0;
    }
    sum
}

/// F(z) = (h coth h - 1)/h^2 with h^2 = z, by Lambert's continued fraction from its end.
fn rotation_ratio<T: RealNumber>(z: T) -> T {
    let mut terms = LEAST_TERMS;
    let most = size(z);
    while T::from((terms * terms) as f64) < T::from(4.0) * most && terms < 1 << 16 {
        terms += 4;
    }
    let mut tail = T::from((2 * terms + 3) as f64);
    for k in (1..=terms).rev() {
        tail = T::from((2 * k + 1) as f64) + z / tail;
    }
    T::from(1.0) / tail
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Analytic: the closed forms, where they do not cancel, and the series of both signs.
    #[test]
    fn bent_powers_are_the_closed_forms() {
        for x in [0.3_f64, 1.0, 2.5, 6.0, 11.0] {
            let [c0, c1, c2, c3] = bent_powers(x * x);
            let known = [
                x.cosh(),
                x.sinh() / x,
                (x.cosh() - 1.0) / (x * x),
                (x.sinh() - x) / x.powi(3),
            ];
            for (found, known) in [c0, c1, c2, c3].into_iter().zip(known) {
                assert!(
                    (found / known - 1.0).abs() < 1e-14 * (1.0 + 40.0 * f64::exp(-3.0 * x)),
                    "{x}"
                );
            }
            let [c0, c1, c2, c3] = bent_powers(-x * x);
            let known = [
                x.cos(),
                x.sin() / x,
                (1.0 - x.cos()) / (x * x),
                (x - x.sin()) / x.powi(3),
            ];
            for (found, known) in [c0, c1, c2, c3].into_iter().zip(known) {
                assert!((found - known).abs() < 4e-14, "{x}: {found}, not {known}");
            }
        }
        assert_eq!(bent_powers(0.0), [1.0, 1.0, 0.5, 1.0 / 6.0]);
    }

    /// Identity: values at the places stay, and a polynomial of degree eight is itself.
    #[test]
    fn lowered_polynomials_have_the_same_values() {
        let own = [
            0.3, -1.0, 2.0, 0.7, -0.2, 1.1, 0.4, -2.0, 0.9, 1.3, -0.8, 0.25,
        ];
        let value = |c: &[f64], s: f64| c.iter().rev().fold(0.0, |sum, c| sum * s + c);
        let found = lowered(&own);
        for k in 0..9 {
            let place = 0.5 * (1.0 - (std::f64::consts::PI * f64::from(k) / 8.0).cos());
            assert!(
                (value(&found, place) - value(&own, place)).abs() < 1e-13,
                "{place}"
            );
        }
        assert!((value(&found, 0.43) - value(&own, 0.43)).abs() < 1e-4);
        assert_eq!(lowered(&own[..9])[..], own[..9]);
    }

    /// Analytic: (h coth h - 1)/h^2, (1 - h cot h)/h^2, and the limits 1/3 and 1/h.
    #[test]
    fn rotation_ratio_is_one_function_of_both_signs() {
        for h in [0.7_f64, 2.0, 9.0, 80.0, 3000.0] {
            let known = (h / h.tanh() - 1.0) / (h * h);
            assert!(
                (rotation_ratio(h * h) / known - 1.0).abs() < 2e-15 * (1.0 + 4.0 / (h * h)),
                "{h}"
            );
        }
        for h in [0.7_f64, 2.0, 3.0, 4.0] {
            let known = (1.0 - h / h.tan()) / (h * h);
            assert!((rotation_ratio(-h * h) / known - 1.0).abs() < 3e-14, "{h}");
        }
        assert_eq!(rotation_ratio(0.0), 1.0 / 3.0);
    }
}
