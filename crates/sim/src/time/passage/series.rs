//! Power series of the contact forces over one step.
//!
//! The forces F and the approaches w satisfy A(t) F = w + r w' and w'' = w_g - B F, where A = G + 1/k. The
//! coefficients are found by recurrence: coefficient k of F follows from the previous ones and from the coefficients
//! of w up to k + 1, and coefficient k + 2 of w follows from coefficient k of F. From the fourth one on w is eliminated,
//! with s the scale of time and C_j the coefficients of G:
//!
//! A_0 F_k = - (C_1 + s r B/k) F_(k-1) - (C_2 + s^2 B/(k (k-1))) F_(k-2) - C_3 F_(k-3) - ... - C_6 F_(k-6).
//!
//! Each coefficient then waits for one product of the one before it alone, which is what its time depends on.

/// Matrix of P x P entries, stored by columns.
pub(super) type Matrix<const P: usize> = [[f64; P]; P];

/// Number of coefficients of the compliance; that of a uniform beam is of degree 6 along the rail.
pub(super) const TERMS: usize = 7;

/// Number of force coefficients that move the degrees of freedom: a multiple of 4 plus 2, since Taylor methods of other orders
/// need shorter steps along the imaginary axis, where the eigenvalues of oscillations lie. With 10 a slow crossing takes an
/// eighth more time at an accuracy of 1e-3 and half as long again at 1e-6, with 22 about as long.
pub(super) const ORDER: usize = 18;

/// Number of additional force coefficients. They are evaluated from the contact law for the motion already found, so
/// that forces and energy do not jump at the end of a step.
const MORE: usize = 2;

/// Constant data of m contacts, padded to P.
pub(super) struct Contacts<const P: usize> {
    /// B = R M^-1 R^T, the accelerations of the approaches by unit contact forces.
    pub mobile: Matrix<P>,
    /// w_g = R M^-1 f, the acceleration of the approach without contact forces.
    pub free: [f64; P],
    /// r = c/k, the ratio of damping to stiffness.
    pub ratio: [f64; P],
    /// Damping c summed over the wheels of a contact.
    pub damping: [f64; P],
    /// 1/k for the total stiffness of the wheels of a contact; 1 in the padding.
    pub softness: [f64; P],
}

/// Power series of the scaled time (t - start)/`scale`.
pub(super) struct Series<const P: usize> {
    pub scale: f64,
    force: [[f64; P]; ORDER + MORE],
    approach: [[f64; P]; ORDER + 2],
}

/// Number of earlier coefficients of the forces from which the next one follows.
const BEFORE: usize = TERMS - 1;

/// Forces at one time, their integral from the start of the step, and the integral of that integral.
pub(super) struct Impulse<const P: usize> {
    pub force: [f64; P],
    pub once: [f64; P],
    pub twice: [f64; P],
}

/// Values at one time, and their time derivatives.
#[derive(Clone, Copy)]
pub(super) struct Values<const P: usize> {
    pub force: [f64; P],
    pub force_rate: [f64; P],
    pub approach: [f64; P],
    pub rate: [f64; P],
}

impl<const P: usize> Series<P> {
    pub fn new() -> Self {
        Series {
            scale: 1.0,
            force: [[0.0; P]; ORDER + MORE],
            approach: [[0.0; P]; ORDER + 2],
        }
    }

    /// Computes the series of the step that starts with the approach `start` and its rate `rate`; `compliance` holds
    /// the coefficients of G over the scaled time. Returns `None` if A is not positive definite.
    #[inline(always)]
    pub fn expand(
        &mut self,
        contacts: &Contacts<P>,
        compliance: &[Matrix<P>; TERMS],
        scale: f64,
        [start, rate]: [&[f64; P]; 2],
    ) -> Option<()> {
        let mut law = compliance[0];
        for (i, softness) in contacts.softness.iter().enumerate() {
            law[i][i] += softness;
        }
        let inverse = inverse(law)?;
        self.scale = scale;
        self.approach[0] = *start;
        self.approach[1] = rate.map(|rate| rate * scale);
        // A^-1 C_j, s A^-1 r B and s^2 A^-1 B
        let memory: [Matrix<P>; BEFORE] =
            std::array::from_fn(|j| product(&inverse, &compliance[j + 1]));
        let mut by_rate = [[0.0; P]; P];
        for (column, mobile) in by_rate.iter_mut().zip(&contacts.mobile) {
            for i in 0..P {
                column[i] = scale * contacts.ratio[i] * mobile[i];
            }
        }
        let by_rate = product(&inverse, &by_rate);
        let by_approach = product(&inverse, &contacts.mobile);
        let last = ORDER + MORE - 1;
        // the last forces, the latest first
        let mut latest = [[0.0; P]; BEFORE];
        for k in 0..=last {
            // the approach that the forces are evaluated for ends with its coefficient `ORDER` + 1
            let rate_share = if k < last { 1.0 } else { 0.0 };
            let mut force = [0.0; P];
            for j in (2..BEFORE).rev() {
                subtract(&memory[j], &latest[j], &mut force);
            }
            if k < 3 {
                let (w, next, per_time) = (
                    &self.approach[k],
                    &self.approach[k + 1],
                    (k + 1) as f64 / scale,
                );
                let right = std::array::from_fn(|i| -w[i] - contacts.ratio[i] * per_time * next[i]);
                subtract(&inverse, &right, &mut force);
                subtract(&memory[1], &latest[1], &mut force);
                subtract(&memory[0], &latest[0], &mut force);
            } else {
                let (first, second) = (rate_share * FIRST[k - 1], scale * scale * SECOND[k - 2]);
                subtract(
                    &sum(&memory[1], second, &by_approach),
                    &latest[1],
                    &mut force,
                );
                subtract(&sum(&memory[0], first, &by_rate), &latest[0], &mut force);
            }
            self.force[k] = force;
            for j in (1..BEFORE).rev() {
                latest[j] = latest[j - 1];
            }
            latest[0] = force;
            if k < ORDER {
                let mut free_fall = if k == 0 { contacts.free } else { [0.0; P] };
                subtract(&contacts.mobile, &force, &mut free_fall);
                let factor = scale * scale * SECOND[k];
                self.approach[k + 2] = free_fall.map(|free_fall| factor * free_fall);
            }
        }
        Some(())
    }

    /// Length, relative to `scale`, of the longest step whose last two terms are at most `approach` and `force`.
    #[inline(always)]
    pub fn reach(&self, approach: f64, force: f64) -> f64 {
        let longest = |terms: &[[f64; P]], allowed: f64, k: usize| {
            let size = terms[k]
                .iter()
                .fold(f64::MIN_POSITIVE, |max, term| max.max(term.abs()));
            (allowed / size).ln() / k as f64
        };
        let by_force = [ORDER - 2, ORDER - 1].map(|k| longest(&self.force, force, k));
        let by_approach = [ORDER, ORDER + 1].map(|k| longest(&self.approach, approach, k));
        by_force
            .into_iter()
            .chain(by_approach)
            .fold(f64::INFINITY, f64::min)
            .exp()
    }

    /// Values at each of the scaled times `places`.
    #[inline(always)]
    pub fn at<const N: usize>(&self, places: &[f64; N]) -> [Values<P>; N] {
        let (force, force_rate) = look(&self.force, places);
        let (approach, rate) = look(&self.approach, places);
        let per_time = 1.0 / self.scale;
        std::array::from_fn(|at| Values {
            force: force[at],
            force_rate: force_rate[at].map(|rate| rate * per_time),
            approach: approach[at],
            rate: rate[at].map(|rate| rate * per_time),
        })
    }

    /// Values at the start.
    #[inline(always)]
    pub fn first(&self) -> Values<P> {
        let per_time = 1.0 / self.scale;
        Values {
            force: self.force[0],
            force_rate: self.force[1].map(|rate| rate * per_time),
            approach: self.approach[0],
            rate: self.approach[1].map(|rate| rate * per_time),
        }
    }

    /// Forces and their integrals from the start to each of the scaled times `places`.
    #[inline(always)]
    pub fn impulses<const N: usize>(&self, places: &[f64; N]) -> [Impulse<P>; N] {
        let [mut force, mut once, mut twice] = [[[0.0; P]; N]; 3];
        let (moving, more) = self.force.split_at(ORDER);
        for term in more.iter().rev() {
            for (s, force) in places.iter().zip(&mut force) {
                for i in 0..P {
                    force[i] = force[i] * s + term[i];
                }
            }
        }
        for (k, term) in moving.iter().enumerate().rev() {
            let (first, second) = (
                term.map(|term| term * FIRST[k]),
                term.map(|term| term * SECOND[k]),
            );
            for at in 0..N {
                let s = places[at];
                for i in 0..P {
                    force[at][i] = force[at][i] * s + term[i];
                    once[at][i] = once[at][i] * s + first[i];
                    twice[at][i] = twice[at][i] * s + second[i];
                }
            }
        }
        std::array::from_fn(|at| {
            let time = places[at] * self.scale;
            Impulse {
                force: force[at],
                once: once[at].map(|once| once * time),
                twice: twice[at].map(|twice| twice * time * time),
            }
        })
    }
}

/// 1/(k + 1).
const FIRST: [f64; ORDER + MORE] = inverses(0);

/// 1/((k + 1) (k + 2)).
const SECOND: [f64; ORDER + MORE] = inverses(1);

const fn inverses(more: usize) -> [f64; ORDER + MORE] {
    let mut out = [1.0; ORDER + MORE];
    let mut k = 0;
    while k < ORDER + MORE {
        out[k] = 1.0 / (k + 1) as f64;
        if more > 0 {
            out[k] /= (k + 2) as f64;
        }
        k += 1;
    }
    out
}

/// Values and derivatives of a series at each of `places`.
#[inline(always)]
fn look<const P: usize, const N: usize>(
    series: &[[f64; P]],
    places: &[f64; N],
) -> ([[f64; P]; N], [[f64; P]; N]) {
    let (mut value, mut rate) = ([[0.0; P]; N], [[0.0; P]; N]);
    for term in series.iter().rev() {
        for (s, (value, rate)) in places.iter().zip(value.iter_mut().zip(&mut rate)) {
            for i in 0..P {
                rate[i] = rate[i] * s + value[i];
                value[i] = value[i] * s + term[i];
            }
        }
    }
    (value, rate)
}

/// `out` -= `matrix` `x`.
#[inline(always)]
pub(super) fn subtract<const P: usize>(matrix: &Matrix<P>, x: &[f64; P], out: &mut [f64; P]) {
    for (column, x) in matrix.iter().zip(x) {
        for (out, entry) in out.iter_mut().zip(column) {
            *out -= entry * x;
        }
    }
}

/// Product of two matrices.
#[inline(always)]
fn product<const P: usize>(a: &Matrix<P>, b: &Matrix<P>) -> Matrix<P> {
    let mut out = [[0.0; P]; P];
    for (out, b) in out.iter_mut().zip(b) {
        for (column, x) in a.iter().zip(b) {
            for i in 0..P {
                out[i] += column[i] * x;
            }
        }
    }
    out
}

/// `a` + `factor` `b`.
#[inline(always)]
fn sum<const P: usize>(a: &Matrix<P>, factor: f64, b: &Matrix<P>) -> Matrix<P> {
    let mut out = *a;
    for (out, b) in out.iter_mut().zip(b) {
        for i in 0..P {
            out[i] += factor * b[i];
        }
    }
    out
}

/// Inverse of a positive definite matrix by elimination; `None` if a pivot is not positive.
#[inline(always)]
fn inverse<const P: usize>(mut a: Matrix<P>) -> Option<Matrix<P>> {
    for k in 0..P {
        let pivot = a[k][k];
        if !(pivot > 0.0 && pivot.is_finite()) {
            return None;
        }
        a[k][k] = 1.0;
        let row = a[k].map(|entry| entry / pivot);
        for (_, other) in a.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let factor = std::mem::take(&mut other[k]);
            for (entry, by) in other.iter_mut().zip(&row) {
                *entry -= factor * by;
            }
        }
        a[k] = row;
    }
    Some(a)
}
