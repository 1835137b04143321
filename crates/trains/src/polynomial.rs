//! Polynomials of low degree on an interval from 0, and their largest value.

/// Largest degree: the moment at the vertex between two wheels under distributed dead load.
const MOST: usize = 6;
/// Bisections after which a root is as accurate as doubles allow.
const BISECTIONS: usize = 80;

/// Steps of Newton's method without a bracket.
const NEWTON: usize = 8;

/// c0 + c1 t + ... of degree at most 6.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Polynomial {
    coefficients: [f64; MOST + 1],
    degree: usize,
}

impl Polynomial {
    /// From coefficients in increasing order; at most seven.
    pub fn new(given: &[f64]) -> Polynomial {
        let mut coefficients = [0.0; MOST + 1];
        coefficients[..given.len()].copy_from_slice(given);
        let degree = given.iter().rposition(|c| *c != 0.0).unwrap_or(0);
        Polynomial {
            coefficients,
            degree,
        }
    }

    /// The coefficients up to the degree.
    fn used(&self) -> &[f64] {
        &self.coefficients[..=self.degree]
    }

    pub fn at(&self, t: f64) -> f64 {
        self.used().iter().rev().fold(0.0, |sum, c| sum * t + c)
    }

    /// self + factor * other.
    pub fn plus(&self, other: &Polynomial, factor: f64) -> Polynomial {
        let mut sum = self.coefficients;
        sum.iter_mut()
            .zip(other.coefficients)
            .for_each(|(a, b)| *a += factor * b);
        Polynomial::new(&sum)
    }

    /// The product; the degrees must add up to at most 6.
    pub fn times(&self, other: &Polynomial) -> Polynomial {
        let mut product = [0.0; MOST + 1];
        for (i, a) in self.used().iter().enumerate() {
            for (j, b) in other.used().iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        Polynomial::new(&product)
    }

    /// The polynomial p(t + by).
    pub fn shifted(&self, by: f64) -> Polynomial {
        let mut out = self.coefficients;
        for start in 0..self.degree {
            for k in (start..self.degree).rev() {
                out[k] += by * out[k + 1];
            }
        }
        Polynomial::new(&out)
    }

    /// The polynomial p(-t).
    pub fn reversed(&self) -> Polynomial {
        let mut out = *self;
        out.coefficients
            .iter_mut()
            .skip(1)
            .step_by(2)
            .for_each(|c| *c = -*c);
        out
    }

    fn derivative(&self) -> Polynomial {
        let mut out = [0.0; MOST + 1];
        for (k, c) in self.used().iter().enumerate().skip(1) {
            out[k - 1] = k as f64 * c;
        }
        Polynomial::new(&out)
    }

    /// A bound of the values on 0..=h: the largest Bernstein coefficient there.
    ///
    /// # Source
    /// Farouki, The Bernstein polynomial basis: a centennial retrospective, CAGD 29 (2012), section 3.
    pub fn bound(&self, h: f64) -> f64 {
        let n = self.degree;
        let mut power = 1.0;
        let mut scaled = [0.0; MOST + 1];
        for (k, c) in self.used().iter().enumerate() {
            scaled[k] = c * power / binomial(n, k);
            power *= h;
        }
        let at = |i: usize| (0..=i).map(|k| binomial(i, k) * scaled[k]).sum::<f64>();
        (0..=n).map(at).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Roots in 0..=h, increasing: between neighbouring roots of the derivative a polynomial is monotone, and has at
    /// most one root, which bisection finds.
    pub fn roots(&self, h: f64) -> Roots {
        match self.degree {
            0 => Roots::default(),
            1 => Roots::of([-self.coefficients[0] / self.coefficients[1]], h),
            2 => Roots::of(quadratic(&self.coefficients), h),
            _ => {
                let turns = self.derivative().roots(h);
                let mut out = Roots::default();
                let (mut from, mut value) = (0.0, self.at(0.0));
                for &to in turns.list().iter().chain(&[h]) {
                    let next = self.at(to);
                    if value == 0.0 {
                        out.add(from);
                    } else if value * next < 0.0 {
                        out.add(self.root_between(from, to, value));
                    }
                    (from, value) = (to, next);
                }
                if value == 0.0 {
                    out.add(h);
                }
                out
            }
        }
    }

    /// The root between `a`, where the value is `at_a`, and `b`, where it has the other sign: steps of Newton's method
    /// that stay within the bracket, otherwise bisection.
    fn root_between(&self, mut a: f64, mut b: f64, at_a: f64) -> f64 {
        let slope = self.derivative();
        let mut t = 0.5 * (a + b);
        for _ in 0..BISECTIONS {
            let value = self.at(t);
            if value == 0.0 {
                return t;
            }
            if (value < 0.0) == (at_a < 0.0) {
                a = t
            } else {
                b = t
            }
            let newton = t - value / slope.at(t);
            let next = if newton > a && newton < b {
                newton
            } else {
                0.5 * (a + b)
            };
            if (next - t).abs() <= f64::EPSILON * t.abs() {
                return next;
            }
            t = next;
        }
        t
    }

    /// Where some steps of Newton's method lead from a place: near a root, or anywhere.
    pub fn root_from(&self, start: f64) -> f64 {
        let slope = self.derivative();
        let mut t = start;
        for _ in 0..NEWTON {
            let next = t - self.at(t) / slope.at(t);
            if (next - t).abs() <= 1e-15 * t.abs() {
                return next;
            }
            t = next;
        }
        t
    }

    /// Places within 0..=h at which the polynomial may be largest: both ends and the roots of the derivative.
    pub fn candidates(&self, h: f64) -> Roots {
        let mut out = Roots::default();
        out.add(0.0);
        self.derivative()
            .roots(h)
            .list()
            .iter()
            .for_each(|&t| out.add(t));
        out.add(h);
        out
    }

    /// Largest value on 0..=h, with its place; `None` where the bound shows that it is below `floor`.
    pub fn largest_above(&self, h: f64, floor: f64) -> Option<(f64, f64)> {
        if self.bound(h) < floor {
            return None;
        }
        let values = self.candidates(h);
        let values = values.list().iter().map(|&t| (t, self.at(t)));
        values.reduce(|best, next| if next.1 > best.1 { next } else { best })
    }
}

/// A few increasing places.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Roots {
    places: [f64; MOST + 2],
    count: usize,
}

impl Roots {
    fn of(all: impl IntoIterator<Item = f64>, h: f64) -> Roots {
        let mut out = Roots::default();
        all.into_iter()
            .filter(|t| (0.0..=h).contains(t))
            .for_each(|t| out.add(t));
        out
    }

    fn add(&mut self, t: f64) {
        if self.count < self.places.len() {
            self.places[self.count] = t;
            self.count += 1;
        }
    }

    pub fn list(&self) -> &[f64] {
        &self.places[..self.count]
    }
}

/// Largest value of a cubic on 0..=h, with the first place that has it.
pub(crate) fn largest_of_cubic(c: &[f64; 4], h: f64) -> (f64, f64) {
    let at = |t: f64| c[0] + t * (c[1] + t * (c[2] + t * c[3]));
    let mut best = (0.0, c[0]);
    let slope = [c[1], 2.0 * c[2], 3.0 * c[3]];
    let turns = if slope[2] != 0.0 {
        quadratic(&slope)
    } else {
        [-slope[0] / slope[1], f64::NAN]
    };
    for t in turns
        .into_iter()
        .filter(|t| (0.0..=h).contains(t))
        .chain([h])
    {
        let value = at(t);
        if value > best.1 {
            best = (t, value);
        }
    }
    best
}

/// Both roots of a quadratic, increasing, without cancellation; NaN where there are none.
fn quadratic(c: &[f64]) -> [f64; 2] {
    let half = -0.5 * c[1];
    let root = (half * half - c[0] * c[2]).sqrt();
    let larger = if half >= 0.0 {
        half + root
    } else {
        half - root
    };
    let (first, second) = (
        larger / c[2],
        if larger == 0.0 { 0.0 } else { c[0] / larger },
    );
    if first <= second {
        [first, second]
    } else {
        [second, first]
    }
}

/// Binomial coefficients up to 6.
fn binomial(n: usize, k: usize) -> f64 {
    const ROWS: [[f64; MOST + 1]; MOST + 1] = [
        [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 2.0, 1.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 3.0, 3.0, 1.0, 0.0, 0.0, 0.0],
        [1.0, 4.0, 6.0, 4.0, 1.0, 0.0, 0.0],
        [1.0, 5.0, 10.0, 10.0, 5.0, 1.0, 0.0],
        [1.0, 6.0, 15.0, 20.0, 15.0, 6.0, 1.0],
    ];
    ROWS[n][k]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (t - 1)(t - 2)(t - 3)(t - 4), whose roots are found on 0..=3.5.
    #[test]
    fn roots_of_a_quartic() {
        let linear = |root: f64| Polynomial::new(&[-root, 1.0]);
        let quartic = linear(1.0)
            .times(&linear(2.0))
            .times(&linear(3.0))
            .times(&linear(4.0));
        let roots = quartic.roots(3.5);
        assert_eq!(roots.list().len(), 3);
        for (root, known) in roots.list().iter().zip([1.0, 2.0, 3.0]) {
            assert!((root - known).abs() < 1e-14, "{root}, not {known}");
        }
    }

    /// The largest value is not below one of 10,001 samples nor above the Bernstein bound, for random sextics.
    #[test]
    fn largest_value_against_samples() {
        let mut random = fastrand::Rng::with_seed(3);
        for _ in 0..200 {
            let c: [f64; 7] = std::array::from_fn(|_| 2.0 * random.f64() - 1.0);
            let sextic = Polynomial::new(&c);
            let h = 0.1 + 3.0 * random.f64();
            let (place, value) = sextic
                .largest_above(h, f64::NEG_INFINITY)
                .expect("there is no floor");
            assert!((0.0..=h).contains(&place) && value <= sextic.bound(h) + 1e-12);
            let sampled = (0..=10_000)
                .map(|k| sextic.at(h * f64::from(k) / 1e4))
                .fold(f64::NEG_INFINITY, f64::max);
            let scale = c.iter().rev().fold(0.0, |sum, c| sum * h + c.abs());
            assert!(
                value >= sampled - 1e-14 * scale && value - sampled < 1e-6 * scale,
                "{value} {sampled}"
            );
        }
    }
}
