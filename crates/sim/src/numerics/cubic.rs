//! The cubic polynomial with given values and slopes at both ends of the unit interval (Hermite).

/// Coefficients of s^0 to s^3 of the polynomial with the values `[a, b]` and the slopes `[start, end]` at s = 0 and 1.
pub(crate) fn cubic([a, b]: [f64; 2], [start, end]: [f64; 2]) -> [f64; 4] {
    let rise = b - a;
    [
        a,
        start,
        3.0 * rise - 2.0 * start - end,
        start + end - 2.0 * rise,
    ]
}

/// Value and slope at `s` of the polynomial with coefficients of s^0 to s^3.
pub(crate) fn value_and_slope([a, b, c, d]: [f64; 4], s: f64) -> [f64; 2] {
    [
        a + s * (b + s * (c + s * d)),
        b + s * (2.0 * c + 3.0 * s * d),
    ]
}

#[cfg(test)]
mod tests {
    use super::{cubic, value_and_slope};

    /// Identity: the polynomial has the values and slopes that it was made of, and one of third degree is met between them.
    #[test]
    fn a_cubic_has_its_values_and_slopes_at_both_ends_and_is_met_between() {
        let exact = |s: f64| {
            [
                2.0 - s + 3.0 * s * s - 5.0 * s * s * s,
                -1.0 + 6.0 * s - 15.0 * s * s,
            ]
        };
        let [from, to] = [0.0, 1.0].map(exact);
        let found = cubic([from[0], to[0]], [from[1], to[1]]);
        for s in [0.0, 0.3, 0.8, 1.0] {
            let [value, slope] = value_and_slope(found, s);
            let expected = exact(s);
            assert!(
                (value - expected[0]).abs() < 1e-14 && (slope - expected[1]).abs() < 1e-13,
                "{s}"
            );
        }
    }
}
