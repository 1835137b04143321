//! Power series of the contact forces over one step.
//!
//! The forces F and the approaches w satisfy A(t) F = w + r w' and w'' = w_g - B F, where A = G + 1/k. The
//! coefficients are found by recurrence: coefficient k of F follows from the previous ones and from the coefficients
//! of w up to k + 1, and coefficient k + 2 of w follows from coefficient k of F.

/// Matrix of P x P entries, stored by columns.
pub(super) type Matrix<const P: usize> = [[f64; P]; P];

/// Number of coefficients of the compliance; that of a uniform beam is of degree 6 along the rail.
pub(super) const TERMS: usize = 7;

/// Largest number of force coefficients that move the degrees of freedom.
pub(super) const MOST: usize = 24;

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
    pub order: usize,
    force: [[f64; P]; MOST + MORE],
    approach: [[f64; P]; MOST + MORE + 1],
}

/// Values at one time, and their time derivatives.
pub(super) struct Values<const P: usize> {
    pub force: [f64; P],
    pub force_rate: [f64; P],
    pub approach: [f64; P],
    pub rate: [f64; P],
}

impl<const P: usize> Series<P> {
    pub fn new(order: usize) -> Self {
        Series { scale: 1.0, order, force: [[0.0; P]; MOST + MORE], approach: [[0.0; P]; MOST + MORE + 1] }
    }

    /// Computes the series of the step that starts with the approach `start` and its rate `rate`; `compliance` holds
    /// the coefficients of G over the scaled time. Returns `None` if A is not positive definite.
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
        for (k, second) in SECOND.iter().enumerate().take(self.order) {
            let force = self.answer(contacts, compliance, &inverse, k);
            self.force[k] = force;
            let mut free_fall = if k == 0 { contacts.free } else { [0.0; P] };
            subtract(&contacts.mobile, &force, &mut free_fall);
            let factor = scale * scale * second;
            self.approach[k + 2] = free_fall.map(|free_fall| factor * free_fall);
        }
        self.approach[self.order + 2..].fill([0.0; P]);
        for k in self.order..self.order + MORE {
            self.force[k] = self.answer(contacts, compliance, &inverse, k);
        }
        Some(())
    }

    /// Coefficient `k` of the forces, from the previous ones and from the approaches up to coefficient k + 1.
    fn answer(
        &self,
        contacts: &Contacts<P>,
        compliance: &[Matrix<P>; TERMS],
        inverse: &Matrix<P>,
        k: usize,
    ) -> [f64; P] {
        let by_rate = (k + 1) as f64 / self.scale;
        let (w, next) = (&self.approach[k], &self.approach[k + 1]);
        let mut right: [f64; P] = std::array::from_fn(|i| w[i] + contacts.ratio[i] * by_rate * next[i]);
        for (matrix, force) in compliance[1..].iter().zip(self.force[..k].iter().rev()) {
            subtract(matrix, force, &mut right);
        }
        let mut force = [0.0; P];
        subtract(inverse, &right, &mut force);
        force.map(|force| -force)
    }

    /// Length, relative to `scale`, of the longest step whose last two terms are at most `approach` and `force`.
    pub fn reach(&self, approach: f64, force: f64) -> f64 {
        let longest = |terms: &[[f64; P]], allowed: f64, k: usize| {
            let size = terms[k].iter().fold(f64::MIN_POSITIVE, |max, term| max.max(term.abs()));
            (allowed / size).ln() / k as f64
        };
        let by_force = [self.order - 2, self.order - 1].map(|k| longest(&self.force, force, k));
        let by_approach = [self.order, self.order + 1].map(|k| longest(&self.approach, approach, k));
        by_force.into_iter().chain(by_approach).fold(f64::INFINITY, f64::min).exp()
    }

    /// Values at each of the scaled times `places`.
    pub fn at<const N: usize>(&self, places: [f64; N]) -> [Values<P>; N] {
        let (force, force_rate) = look(&self.force[..self.order + MORE], &places);
        let (approach, rate) = look(&self.approach[..self.order + 2], &places);
        let per_time = 1.0 / self.scale;
        std::array::from_fn(|at| Values {
            force: force[at],
            force_rate: force_rate[at].map(|rate| rate * per_time),
            approach: approach[at],
            rate: rate[at].map(|rate| rate * per_time),
        })
    }

    /// Values at the start.
    pub fn first(&self) -> Values<P> {
        let per_time = 1.0 / self.scale;
        Values {
            force: self.force[0],
            force_rate: self.force[1].map(|rate| rate * per_time),
            approach: self.approach[0],
            rate: self.approach[1].map(|rate| rate * per_time),
        }
    }

    /// Integral of the forces from the start to the scaled time `s`, and the integral of that integral.
    pub fn impulse(&self, s: f64) -> [[f64; P]; 2] {
        let (mut once, mut twice) = ([0.0; P], [0.0; P]);
        for k in (0..self.order).rev() {
            for i in 0..P {
                once[i] = once[i] * s + self.force[k][i] * FIRST[k];
                twice[i] = twice[i] * s + self.force[k][i] * SECOND[k];
            }
        }
        let time = s * self.scale;
        [once.map(|once| once * time), twice.map(|twice| twice * time * time)]
    }
}

/// 1/(k + 1).
const FIRST: [f64; MOST] = inverses(0);

/// 1/((k + 1) (k + 2)).
const SECOND: [f64; MOST] = inverses(1);

const fn inverses(more: usize) -> [f64; MOST] {
    let mut out = [1.0; MOST];
    let mut k = 0;
    while k < MOST {
        out[k] = 1.0 / (k + 1) as f64;
        if more > 0 {
            out[k] /= (k + 2) as f64;
        }
        k += 1;
    }
    out
}

/// Values and derivatives of a series at each of `places`.
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
pub(super) fn subtract<const P: usize>(matrix: &Matrix<P>, x: &[f64; P], out: &mut [f64; P]) {
    for (column, x) in matrix.iter().zip(x) {
        for (out, entry) in out.iter_mut().zip(column) {
            *out -= entry * x;
        }
    }
}

/// Inverse of a positive definite matrix by elimination; `None` if a pivot is not positive.
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
