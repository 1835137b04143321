//! The distribution of a result over the runs.

use statrs::function::erf::erfc;

/// An interval that contains a value with a probability of about 95 %.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// The distribution of a result over the runs that have it.
#[derive(Clone, Debug, PartialEq)]
pub struct ResultDistribution {
    /// Number of runs.
    pub count: usize,
    /// Mean.
    pub mean: f64,
    /// Standard deviation of the sample, with n - 1; 0 for one run.
    pub deviation: f64,
    /// Interval of the mean: plus and minus 1.96 deviations over sqrt(n). For Latin hypercubes and Sobol sequences it is
    /// wider than the error of the mean.
    pub mean_interval: Interval,
    /// Smallest value and its run.
    pub least: (f64, usize),
    /// Largest value and its run.
    pub most: (f64, usize),
    /// Quantiles of 5, 50, 95 and 99 %.
    pub quantiles: [f64; 4],
    /// Interval of the quantile of 95 %, from the order of the values alone.
    pub upper_interval: Interval,
}

/// Probabilities of [`ResultDistribution::quantiles`].
pub const QUANTILES: [f64; 4] = [0.05, 0.5, 0.95, 0.99];

/// Standard normal quantile of 97.5 %.
const TWO_SIDED: f64 = 1.959_963_984_540_054;

impl ResultDistribution {
    /// The statistics of values with the numbers of their runs; `None` without values. Of equal extremes the first run
    /// counts.
    #[must_use]
    pub fn new(values: &[(usize, f64)]) -> Option<ResultDistribution> {
        let &(run, first) = values.first()?;
        let count = values.len();
        let n = count as f64;
        let mean = values.iter().map(|(_, value)| value).sum::<f64>() / n;
        let squares = values
            .iter()
            .map(|(_, value)| (value - mean).powi(2))
            .sum::<f64>();
        let deviation = if count > 1 {
            (squares / (n - 1.0)).sqrt()
        } else {
            0.0
        };
        let (mut least, mut most) = ((first, run), (first, run));
        for &(run, value) in values {
            if value < least.0 {
                least = (value, run);
            }
            if value > most.0 {
                most = (value, run);
            }
        }
        let mut sorted: Vec<f64> = values.iter().map(|(_, value)| *value).collect();
        sorted.sort_by(f64::total_cmp);
        let half = TWO_SIDED * deviation / n.sqrt();
        Some(ResultDistribution {
            count,
            mean,
            deviation,
            mean_interval: Interval {
                low: mean - half,
                high: mean + half,
            },
            least,
            most,
            quantiles: QUANTILES.map(|p| quantile(&sorted, p)),
            upper_interval: order_interval(&sorted, 0.95),
        })
    }
}

/// Quantile of sorted values: linear between the values, the k-th of n at (k - 1)/(n - 1) (Hyndman and Fan, type 7).
#[must_use]
pub(crate) fn quantile(sorted: &[f64], p: f64) -> f64 {
    let place = p * (sorted.len() - 1) as f64;
    let below = place.floor() as usize;
    let above = (below + 1).min(sorted.len() - 1);
    sorted[below] + (place - below as f64) * (sorted[above] - sorted[below])
}

/// Interval of a quantile by the order of independent values, without an assumption on their distribution: the number
/// of values below the quantile is binomial, here by its normal approximation. Ends beyond the sample are its extremes.
fn order_interval(sorted: &[f64], p: f64) -> Interval {
    let n = sorted.len() as f64;
    let half = TWO_SIDED * (n * p * (1.0 - p)).sqrt();
    let at = |rank: f64| sorted[(rank.round().max(1.0) as usize).min(sorted.len()) - 1];
    Interval {
        low: at(n * p - half),
        high: at(n * p + half + 1.0),
    }
}

/// Probability that the correlation of `count` independent pairs is at least as large as `r`, by Fisher's
/// transformation.
#[must_use]
pub(crate) fn chance_of_correlation(r: f64, count: usize) -> f64 {
    if count < 4 || r.abs() >= 1.0 {
        return if r.abs() >= 1.0 && count >= 4 {
            0.0
        } else {
            1.0
        };
    }
    erfc(r.atanh().abs() * ((count - 3) as f64).sqrt() / std::f64::consts::SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_of_one_to_hundred_are_those_of_a_hand_calculation() {
        let values: Vec<(usize, f64)> = (1..=101).map(|run| (run, (run - 1) as f64)).collect();
        let found = ResultDistribution::new(&values).expect("values");
        // analytic: sum of squares of deviations n(n^2 - 1)/12
        let deviation = (101.0 * (101.0_f64.powi(2) - 1.0) / 12.0 / 100.0).sqrt();
        assert!((found.mean - 50.0).abs() < 1e-12);
        assert!((found.deviation - deviation).abs() < 1e-12);
        assert_eq!(found.quantiles, [5.0, 50.0, 95.0, 99.0]);
        assert_eq!((found.least, found.most), ((0.0, 1), (100.0, 101)));
        assert!(found.upper_interval.low < 95.0 && found.upper_interval.high > 95.0);
        assert_eq!(ResultDistribution::new(&[]), None);
    }

    #[test]
    fn the_interval_of_a_quantile_contains_it_in_95_of_100_samples() {
        // uniform numbers of a linear congruential generator; the quantile of 95 % is 0.95
        let mut state = 1_u64;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let inside = (0..2000).filter(|_| {
            let mut sample: Vec<f64> = (0..400).map(|_| next()).collect();
            sample.sort_by(f64::total_cmp);
            let interval = order_interval(&sample, 0.95);
            interval.low <= 0.95 && interval.high >= 0.95
        });
        let share = inside.count() as f64 / 2000.0;
        assert!((0.935..0.985).contains(&share), "{share}");
    }
}
