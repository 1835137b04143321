//! A polynomial of degree five by its Bernstein coefficients: its values, and bounds of them.

/// Bernstein coefficients on [0, s] of a polynomial from those on [0, 1]; the last one is its value at `s`.
///
/// # Source
/// De Casteljau's algorithm: Farin, Curves and Surfaces for CAGD, 5th ed. (2002), ch. 4 and 5.
fn subdivided(mut coefficients: [f64; 6], s: f64) -> [f64; 6] {
    std::array::from_fn(|level| {
        let first = coefficients[0];
        for i in 0..5 - level {
            coefficients[i] += s * (coefficients[i + 1] - coefficients[i]);
        }
        first
    })
}

/// Value of f at `s` from the Bernstein coefficients of f on [0, 1].
pub(crate) fn value(coefficients: [f64; 6], s: f64) -> f64 {
    subdivided(coefficients, s)[5]
}

/// Bound on |f(s) - f(0)| for s from 0 to `end`, from the Bernstein coefficients of f on [0, 1].
///
/// A polynomial lies within the range of its Bernstein coefficients, here of those on [0, end]. The bound is attained where
/// they increase or decrease throughout.
pub(crate) fn largest_change(coefficients: [f64; 6], end: f64) -> f64 {
    let changes = subdivided(coefficients, end).map(|own| (own - coefficients[0]).abs());
    changes.into_iter().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::{largest_change, value};

    /// Values of the polynomial, from the definition of the Bernstein polynomials.
    fn defined(coefficients: [f64; 6], s: f64) -> f64 {
        let binomial = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
        let term = |k: i32| binomial[k as usize] * s.powi(k) * (1.0 - s).powi(5 - k);
        (0..6).map(|k| coefficients[k as usize] * term(k)).sum()
    }

    #[test]
    fn values_are_those_of_the_definition() {
        for s in [0.0, 0.2, 0.5, 0.9, 1.0] {
            let shape = [0.0, 3.0, -5.0, 4.0, -1.0, 0.5];
            assert!((value(shape, s) - defined(shape, s)).abs() < 1e-14, "{s}");
        }
    }

    #[test]
    fn bound_holds_and_is_attained_by_monotone_polynomials() {
        let shapes = [
            [2.0, 2.1, 2.5, 3.0, 4.0, 6.0],
            [1.0, 0.5, 0.0, -2.0, -2.0, -9.0],
            [0.0, 3.0, -5.0, 4.0, -1.0, 0.5],
        ];
        for (shape, is_monotone) in shapes.into_iter().zip([true, true, false]) {
            for end in [0.01, 0.3, 0.77, 1.0] {
                let bound = largest_change(shape, end);
                let places = (0..=1000).map(|i| end * f64::from(i) / 1000.0);
                let change = places
                    .map(|s| (defined(shape, s) - shape[0]).abs())
                    .fold(0.0, f64::max);
                assert!(bound >= change - 1e-14, "{bound} {change}");
                if is_monotone {
                    assert!(
                        (bound - change).abs() < 1e-14 * (1.0 + change),
                        "{bound} {change}"
                    );
                }
            }
        }
    }
}
