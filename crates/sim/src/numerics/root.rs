//! Root finding for a function of one variable that changes sign in a given interval.

/// Reduces the bracket [0, 1] of a sign change of `f` to `width` or to rounding. `ends` are the values of `f` at 0
/// and 1, which have different signs. Returns the last point with the sign of the value at 0 and the first point with
/// the sign of the value at 1. The search ends early where `f` returns `None`.
///
/// Each iteration of the ITP method takes the regula falsi estimate, shifts it towards the midpoint (truncation), and
/// limits its distance from the midpoint (projection) such that the method needs at most one evaluation more than
/// bisection. On smooth functions it needs a few evaluations in all. The sign of `f` at the new point determines
/// which end of the bracket moves.
///
/// # Source
/// The ITP method: Oliveira, Takahashi, ACM Trans. Math. Softw. 47 (2020) 5.
pub(crate) fn narrow(
    ends: [f64; 2],
    width: f64,
    mut f: impl FnMut(f64) -> Option<f64>,
) -> [f64; 2] {
    let sign = ends[1].signum();
    let ([mut low, mut high], [mut below, mut above]) =
        ([0.0_f64, 1.0_f64], ends.map(|end| sign * end));
    // Radius of the projection interval plus half the bracket. It is halved in each iteration, which gives the worst
    // case of bisection plus one evaluation.
    let mut reach = width * (-width.log2()).ceil().exp2();
    while high - low > width {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let secant = (above * low - below * high) / (above - below);
        let aside = (middle - secant).clamp(-half, half);
        // The truncation shifts the regula falsi estimate towards the midpoint, so that both ends of the bracket
        // converge.
        let beyond = (0.8 * half * half).min(aside.abs());
        let apart = (aside.abs() - beyond).min((reach - half).max(0.0));
        let near = 0.5 * width.min(high - low);
        let mut at = (middle - apart.copysign(aside)).clamp(low + near, high - near);
        if !(at > low && at < high) {
            at = middle;
        }
        if !(at > low && at < high) {
            break;
        }
        let Some(value) = f(at).map(|value| sign * value) else {
            break;
        };
        if value > 0.0 {
            (high, above) = (at, value);
        } else {
            (low, below) = (at, value);
        }
        reach *= 0.5;
    }
    [low, high]
}

/// Number of secants after which [`behind`] leaves the search to [`narrow`].
const SECANTS: usize = 8;

/// Part of the width to which the estimates of [`behind`] must agree.
const AGREEMENT: f64 = 0.1;

/// A place behind the sign change of a smooth `f` in [0, 1], by half of `width` but for the error of the estimate of
/// the root. `ends` are the values of `f` at 0 and 1, which have different signs.
///
/// Each secant leads through the last two places, or through both ends of the bracket where it would leave this. Its
/// root is accepted where it differs from the last place by a tenth of the width, as the next secant would differ by
/// far less. The bracket need not be narrow, which takes a third of the evaluations of [`narrow`]; that is used where
/// the secants do not agree, or `f` returns `None`.
pub(crate) fn behind(ends: [f64; 2], width: f64, mut f: impl FnMut(f64) -> Option<f64>) -> f64 {
    let sign = ends[1].signum();
    let [mut low, mut high] = [(0.0, sign * ends[0]), (1.0, sign * ends[1])];
    let secant = |a: (f64, f64), b: (f64, f64)| a.0 - a.1 * (b.0 - a.0) / (b.1 - a.1);
    let mut last = if low.1.abs() < high.1.abs() {
        low
    } else {
        high
    };
    let mut at = secant(low, high);
    for _ in 0..SECANTS {
        if !(at > low.0 && at < high.0) {
            break;
        }
        let Some(value) = f(at).map(|value| sign * value) else {
            break;
        };
        let now = (at, value);
        if value > 0.0 {
            high = now;
        } else {
            low = now;
        }
        let along = secant(now, last);
        let next = if along > low.0 && along < high.0 {
            along
        } else {
            secant(low, high)
        };
        if (next - at).abs() <= AGREEMENT * width {
            return (next + 0.5 * width).min(1.0);
        }
        (last, at) = (now, next);
    }
    narrow(ends, width, f)[1]
}

#[cfg(test)]
mod tests {
    use super::{behind, narrow};

    #[test]
    fn places_behind_roots_are_behind_them_by_less_than_the_width() {
        let functions: [fn(f64) -> f64; 6] = [
            |x| x - 0.3,
            |x| (x - 0.7) * (1.0 + x * x),
            |x| (1.5 * x).sin() - 0.5,
            |x| 0.2 - x.powi(5),
            |x| if x < 0.4 { x - 0.4 } else { 20.0 * (x - 0.4) },
            |x| (50.0 * (x - 0.9)).tanh(),
        ];
        let roots = [
            0.3,
            0.7,
            std::f64::consts::PI / 9.0,
            0.2_f64.powf(0.2),
            0.4,
            0.9,
        ];
        for (k, (f, root)) in functions.into_iter().zip(roots).enumerate() {
            let mut count = 0;
            let found = behind([f(0.0), f(1.0)], 1e-4, |x| {
                count += 1;
                Some(f(x))
            });
            assert!(
                found > root && found < root + 1.1e-4,
                "{k}: {found} of {root}"
            );
            assert!(k > 2 || count <= 5, "{k}: {count}");
        }
    }

    #[test]
    fn roots_of_smooth_functions_take_few_evaluations() {
        let functions: [fn(f64) -> f64; 4] = [
            |x| x - 0.3,
            |x| (x - 0.7) * (1.0 + x * x),
            |x| (1.5 * x).sin() - 0.5,
            |x| 0.2 - x.powi(5),
        ];
        let roots = [0.3, 0.7, std::f64::consts::PI / 9.0, 0.2_f64.powf(0.2)];
        for (f, root) in functions.into_iter().zip(roots) {
            let mut count = 0;
            let [low, high] = narrow([f(0.0), f(1.0)], 1e-12, |x| {
                count += 1;
                Some(f(x))
            });
            assert!(
                high - low <= 1e-12 && (low - root).abs() < 2e-12,
                "{low} for {root}"
            );
            assert!(count <= 12, "{count}");
        }
    }

    #[test]
    fn jumps_take_hardly_more_evaluations_than_bisection() {
        let mut count = 0;
        let [low, high] = narrow([-1.0, 1.0], 1e-12, |x| {
            count += 1;
            Some(if x < 1e-9 { -1.0 } else { 1e6 })
        });
        assert!(low < 1e-9 && high >= 1e-9 && high - low <= 1e-12);
        assert!(count <= 41, "{count}");
    }

    #[test]
    fn width_of_rounding_ends() {
        let [low, high] = narrow([-1.0, 2.0], 1e-17, |x| Some(3.0 * x - 1.0));
        assert!(high - low < 1e-15 && (low - 1.0 / 3.0).abs() < 1e-15);
    }
}
