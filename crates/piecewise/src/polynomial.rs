//! A polynomial on the unit interval by its Bernstein coefficients.
//!
//! p(s) = sum over i of c_i binomial(n, i) s^i (1 - s)^(n - i). The values lie between the smallest and the largest coefficient;
//! the coefficients of both parts of the interval follow by de Casteljau's algorithm, and those of the derivative are n times
//! the differences.
//!
//! # Source
//! Farin, Curves and Surfaces for CAGD, 5th ed. (2002), chapters 4 to 6.

use smallvec::SmallVec;

/// Largest degree of a polynomial that nodes have.
pub const MAX_DEGREE: usize = 16;

/// Length of an interval, relative to the whole, below which it is a point.
const POINT: f64 = 1e-14;

/// Values, relative to the largest coefficient, that count as zero.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

type Coefficients = SmallVec<[f64; MAX_DEGREE + 1]>;

/// A polynomial on [0, 1].
#[derive(Clone, Debug, PartialEq)]
pub struct Polynomial {
    coefficients: Coefficients,
}

/// The largest or smallest value of a polynomial, and the place of it as a fraction of the interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The place, 0 to 1.
    pub share: f64,
    /// The value.
    pub value: f64,
}

impl Polynomial {
    /// The polynomial with these Bernstein coefficients, at least one.
    #[must_use]
    pub fn new(coefficients: impl IntoIterator<Item = f64>) -> Polynomial {
        let coefficients: Coefficients = coefficients.into_iter().collect();
        assert!(!coefficients.is_empty(), "a polynomial has a coefficient");
        Polynomial { coefficients }
    }

    /// Its Bernstein coefficients; the first and the last are the values at the ends.
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// The degree, of which the highest power may have the factor 0.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.coefficients.len() - 1
    }

    /// Value at `share`.
    #[must_use]
    pub fn value(&self, share: f64) -> f64 {
        let mut work = self.coefficients.clone();
        for level in (1..work.len()).rev() {
            for i in 0..level {
                work[i] += share * (work[i + 1] - work[i]);
            }
        }
        work[0]
    }

    /// The derivative by the share.
    #[must_use]
    pub fn derivative(&self) -> Polynomial {
        let n = self.degree();
        if n == 0 {
            return Polynomial::new([0.0]);
        }
        Polynomial::new(
            self.coefficients
                .windows(2)
                .map(|pair| n as f64 * (pair[1] - pair[0])),
        )
    }

    /// Bounds of all values: the smallest and the largest coefficient.
    #[must_use]
    pub fn bounds(&self) -> [f64; 2] {
        self.coefficients
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], c| {
                [low.min(*c), high.max(*c)]
            })
    }

    /// Both parts of the polynomial, before and behind `share`.
    #[must_use]
    pub fn split(&self, share: f64) -> [Polynomial; 2] {
        let mut work = self.coefficients.clone();
        let n = self.degree();
        let mut first = Coefficients::new();
        for level in (0..=n).rev() {
            first.push(work[0]);
            for i in 0..level {
                work[i] += share * (work[i + 1] - work[i]);
            }
        }
        Polynomial::split_of(first, work)
    }

    /// The first part has the first coefficients of all levels; the other is what is left in place.
    /// The coefficients c of its powers, sum of c_k s^k: binomial(n, k) times the k-th difference of the Bernstein coefficients.
    ///
    /// ```
    /// let cubic = piecewise::Polynomial::new([1.0, 1.0, 1.0, 2.0]); // 1 + s^3
    /// assert_eq!(cubic.powers().as_slice(), [1.0, 0.0, 0.0, 1.0]);
    /// ```
    #[must_use]
    pub fn powers(&self) -> SmallVec<[f64; MAX_DEGREE + 1]> {
        let n = self.degree();
        let mut differences = self.coefficients.clone();
        let mut binomial = 1.0;
        let mut out = SmallVec::new();
        for k in 0..=n {
            out.push(binomial * differences[0]);
            for i in 0..n - k {
                differences[i] = differences[i + 1] - differences[i];
            }
            binomial *= (n - k) as f64 / (k + 1) as f64;
        }
        out
    }

    /// The polynomial on a part of the interval, as a function of the share of the part.
    ///
    /// ```
    /// let square = piecewise::Polynomial::new([0.0, 0.0, 1.0]); // s^2
    /// assert_eq!(square.part([0.5, 1.0]).value(0.5), 0.75 * 0.75);
    /// ```
    #[must_use]
    pub fn part(&self, [from, to]: [f64; 2]) -> Polynomial {
        let [first, _] = self.split(to);
        let [_, own] = first.split(if to == 0.0 { 0.0 } else { from / to });
        own
    }

    fn split_of(first: Coefficients, second: Coefficients) -> [Polynomial; 2] {
        [
            Polynomial {
                coefficients: first,
            },
            Polynomial {
                coefficients: second,
            },
        ]
    }

    /// A factor times the polynomial.
    #[must_use]
    pub fn times(&self, factor: f64) -> Polynomial {
        Polynomial::new(self.coefficients.iter().map(|c| factor * c))
    }

    /// The polynomial plus a factor times another of the same degree.
    ///
    /// # Panics
    /// If the degrees differ.
    pub fn add(&mut self, other: &Polynomial, factor: f64) {
        assert_eq!(self.degree(), other.degree(), "degrees of a sum");
        for (own, other) in self.coefficients.iter_mut().zip(&other.coefficients) {
            *own += factor * other;
        }
    }

    /// Places in [0, 1] where the polynomial changes its sign or touches zero with rounding, increasing. A part of the interval in
    /// which it is zero throughout counts by its ends.
    ///
    /// The interval is halved where the coefficients change their sign more than once. Where they do so once there is one root,
    /// which is bracketed and found by steps of Newton's method, otherwise by bisection.
    #[must_use]
    pub fn roots(&self) -> SmallVec<[f64; 4]> {
        let mut found = SmallVec::new();
        let [low, high] = self.bounds();
        let zero = ROUNDING * low.abs().max(high.abs());
        self.add_roots([0.0, 1.0], zero, &mut found);
        found
    }

    fn add_roots(&self, [from, to]: [f64; 2], zero: f64, found: &mut SmallVec<[f64; 4]>) {
        let mut put = |share: f64| {
            if found.last().is_none_or(|last| share - last > POINT) {
                found.push(share);
            }
        };
        let first = self.coefficients[0];
        if first.abs() <= zero {
            put(from);
        }
        let mut changes = 0;
        let mut sign = 0.0;
        for c in self.coefficients.iter().filter(|c| c.abs() > zero) {
            if sign * c < 0.0 {
                changes += 1;
            }
            sign = c.signum();
        }
        let last = self.coefficients[self.degree()];
        if changes == 1 && first.abs() > zero && last.abs() > zero {
            put(from + (to - from) * self.bracketed());
        } else if changes > 0 {
            if to - from < POINT {
                put(from);
            } else {
                let middle = 0.5 * (from + to);
                let [before, behind] = self.split(0.5);
                before.add_roots([from, middle], zero, found);
                behind.add_roots([middle, to], zero, found);
                return;
            }
        }
        if last.abs() <= zero && found.last().is_none_or(|last| to - last > POINT) {
            found.push(to);
        }
    }

    /// Value and slope at `share`, by Horner's rule in s and 1 - s: sooner than by de Casteljau's algorithm, but a constant
    /// has rounding.
    fn value_and_slope(&self, share: f64) -> [f64; 2] {
        let (c, n) = (&self.coefficients, self.degree());
        let rest = 1.0 - share;
        let (mut value, mut slope) = (c[0], 0.0);
        // binomial(n, i) s^i, and binomial(n - 1, i - 1) s^(i - 1)
        let (mut power, mut lower) = (1.0, 1.0);
        for i in 1..=n {
            power *= share * (n + 1 - i) as f64 / i as f64;
            value = value * rest + power * c[i];
            slope = slope * rest + lower * (c[i] - c[i - 1]);
            lower *= share * (n - i) as f64 / i as f64;
        }
        [value, n as f64 * slope]
    }

    /// The root of a polynomial that has values of opposite signs at both ends, and one root.
    fn bracketed(&self) -> f64 {
        let sign = self.coefficients[0].signum();
        let [mut a, mut b] = [0.0, 1.0];
        let mut at = 0.5;
        for _ in 0..100 {
            let [value, slope] = self.value_and_slope(at);
            if value == 0.0 {
                return at;
            }
            if value * sign > 0.0 {
                a = at
            } else {
                b = at
            }
            let newton = at - value / slope;
            let next = if newton > a && newton < b {
                newton
            } else {
                0.5 * (a + b)
            };
            if (next - at).abs() <= f64::EPSILON {
                return next;
            }
            at = next;
        }
        at
    }

    /// The largest value on [0, 1], with the first place that has it.
    #[must_use]
    pub fn largest(&self) -> Extreme {
        let n = self.degree();
        let mut best = Extreme {
            share: 0.0,
            value: self.coefficients[0],
        };
        if self.coefficients[n] > best.value {
            best = Extreme {
                share: 1.0,
                value: self.coefficients[n],
            };
        }
        let [_, high] = self.bounds();
        // inside it is larger by more than rounding
        let rounding = ROUNDING * high.abs().max(best.value.abs());
        if high > best.value + rounding {
            for share in self.derivative().roots() {
                let value = self.value(share);
                if value > best.value + rounding {
                    best = Extreme { share, value };
                }
            }
        }
        best
    }

    /// The smallest value on [0, 1], with the first place that has it.
    #[must_use]
    pub fn smallest(&self) -> Extreme {
        let Extreme { share, value } = self.times(-1.0).largest();
        Extreme {
            share,
            value: 0.0 - value,
        }
    }

    /// The largest value, where it is above `floor`; `None` where the bound or the value shows that it is not.
    #[must_use]
    pub fn largest_above(&self, floor: f64) -> Option<Extreme> {
        let [_, high] = self.bounds();
        if high <= floor {
            return None;
        }
        Some(self.largest()).filter(|found| found.value > floor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficients of the product of (s - root) over the roots, by degree elevation of products.
    fn with_roots(roots: &[f64]) -> Polynomial {
        let mut powers = vec![1.0];
        for root in roots {
            let mut next = vec![0.0; powers.len() + 1];
            for (k, c) in powers.iter().enumerate() {
                next[k + 1] += c;
                next[k] -= root * c;
            }
            powers = next;
        }
        let n = roots.len();
        let binomial = |n: usize, k: usize| -> f64 {
            (0..k).map(|i| (n - i) as f64 / (i + 1) as f64).product()
        };
        let coefficient = |i: usize| {
            (0..=i)
                .map(|k| binomial(i, k) / binomial(n, k) * powers[k])
                .sum()
        };
        Polynomial::new((0..=n).map(coefficient))
    }

    /// Value and slope by Horner's rule are those by de Casteljau's algorithm.
    #[test]
    fn values_and_slopes_are_those_of_de_casteljau() {
        let polynomial = Polynomial::new([0.3, -1.0, 2.0, 0.5, 7.0, -2.0]);
        for share in [0.0, 0.1, 0.5, 0.77, 1.0] {
            let [value, slope] = polynomial.value_and_slope(share);
            let known = [
                polynomial.value(share),
                polynomial.derivative().value(share),
            ];
            assert!((value - known[0]).abs() < 1e-14, "{value}, not {known:?}");
            assert!((slope - known[1]).abs() < 1e-13, "{slope}, not {known:?}");
        }
    }

    /// Analytic: the roots of products of linear factors, some of them beyond the interval.
    #[test]
    fn roots_of_products() {
        let wanted = [0.1, 0.35, 0.62, 0.99];
        let all = [0.1, -0.4, 0.35, 0.62, 1.7, 0.99];
        let found = with_roots(&all).roots();
        assert_eq!(found.len(), wanted.len(), "{found:?}");
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found - wanted).abs() < 1e-12, "{found} for {wanted}");
        }
        // a double root is touched, within the square root of rounding
        let touched = with_roots(&[0.3, 0.3]).roots();
        assert!(touched.iter().all(|root| (root - 0.3).abs() < 1e-7));
        assert_eq!(with_roots(&[0.0, 1.0]).roots().as_slice(), [0.0, 1.0]);
    }

    /// The largest value is not below any of 2,001 values nor above the bound, for random polynomials, and both parts of a
    /// polynomial are the polynomial.
    #[test]
    fn largest_values_against_samples() {
        let mut random = fastrand::Rng::with_seed(5);
        for _ in 0..300 {
            let n = random.usize(0..=MAX_DEGREE);
            let own = Polynomial::new((0..=n).map(|_| 2.0 * random.f64() - 1.0));
            let (largest, smallest) = (own.largest(), own.smallest());
            let [low, high] = own.bounds();
            let values = (0..=2000).map(|k| own.value(f64::from(k) / 2e3));
            let [least, most] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| {
                [a.min(v), b.max(v)]
            });
            assert!(largest.value >= most - 1e-14 && largest.value <= high + 1e-14);
            assert!(smallest.value <= least + 1e-14 && smallest.value >= low - 1e-14);
            assert!((own.value(largest.share) - largest.value).abs() < 1e-13);
            let cut = random.f64();
            let [before, behind] = own.split(cut);
            for s in [0.0, 0.3, 1.0] {
                assert!((before.value(s) - own.value(cut * s)).abs() < 1e-13);
                let there = cut + (1.0 - cut) * s;
                assert!((behind.value(s) - own.value(there)).abs() < 1e-13);
            }
        }
    }
}
