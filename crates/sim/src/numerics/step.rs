//! The cubic STEP function of ADAMS, which smooths the contact, friction and hand-over laws, and its integral.

/// Value and slope of STEP(x, x0, h0, x1, h1): h0 below x0, h1 above x1, and
/// h0 + (h1 - h0) D^2 (3 - 2 D), D = (x - x0)/(x1 - x0), between; `x0 < x1`.
///
/// # Source
/// ADAMS/Solver function STEP. Its first derivative is continuous; its second derivative jumps at x0 and x1.
#[must_use]
pub fn step(x: f64, x0: f64, h0: f64, x1: f64, h1: f64) -> (f64, f64) {
    if x <= x0 {
        (h0, 0.0)
    } else if x >= x1 {
        (h1, 0.0)
    } else {
        let d = (x - x0) / (x1 - x0);
        (
            h0 + (h1 - h0) * d * d * (3.0 - 2.0 * d),
            (h1 - h0) * 6.0 * d * (1.0 - d) / (x1 - x0),
        )
    }
}

/// Q(p), the integral of STEP(p, 0, 0, depth, 1) from 0 to p; p itself where `depth` is zero.
pub(crate) fn step_integral(depth: f64, p: f64) -> f64 {
    if depth == 0.0 {
        p
    } else if p <= 0.0 {
        0.0
    } else if p >= depth {
        p - 0.5 * depth
    } else {
        let d = p / depth;
        depth * d * d * d * (1.0 - 0.5 * d)
    }
}

#[cfg(test)]
mod tests {
    use super::step;

    #[test]
    fn step_meets_its_ends_with_zero_slope_and_is_half_way_in_the_middle() {
        assert_eq!(step(-1.0, 0.0, 2.0, 1.0, 5.0), (2.0, 0.0));
        assert_eq!(step(1.0, 0.0, 2.0, 1.0, 5.0), (5.0, 0.0));
        assert_eq!(step(0.5, 0.0, 2.0, 1.0, 5.0), (3.5, 4.5));
    }

    #[test]
    fn slope_is_the_derivative() {
        let h = 1e-6;
        for x in [0.1, 0.35, 0.8] {
            let (_, slope) = step(x, 0.0, 1.0, 1.0, -1.0);
            let difference = (step(x + h, 0.0, 1.0, 1.0, -1.0).0
                - step(x - h, 0.0, 1.0, 1.0, -1.0).0)
                / (2.0 * h);
            assert!((slope - difference).abs() < 1e-9);
        }
    }
}
