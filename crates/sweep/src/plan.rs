//! The values of the axes in each run.

use formats::sweep::{AxisValue, AxisValues, Sampling, Sweep};
use statrs::function::erf::erfc_inv;

use crate::points::UnitPoints;

/// The plan of a sweep: its runs by number, from 1. It depends on the sweep alone.
#[derive(Clone, Debug)]
pub struct RunPlan {
    axes: Vec<AxisValues>,
    runs: usize,
    /// `None` for a grid.
    points: Option<UnitPoints>,
}

impl RunPlan {
    /// The plan of a sweep.
    #[must_use]
    pub fn new(sweep: &Sweep) -> RunPlan {
        let axes: Vec<AxisValues> = sweep.axes.iter().map(|axis| axis.values.clone()).collect();
        let points = match sweep.sampling {
            Sampling::Grid => None,
            Sampling::Latin => Some(UnitPoints::latin(axes.len(), sweep.count, sweep.seed)),
            Sampling::Sobol => Some(UnitPoints::sobol(axes.len(), sweep.seed)),
        };
        RunPlan {
            axes,
            runs: sweep.count,
            points,
        }
    }

    /// Number of runs.
    #[must_use]
    pub const fn runs(&self) -> usize {
        self.runs
    }

    /// The values of the axes in a run, counted from 1. In a grid the last axis changes first.
    #[must_use]
    pub fn values(&self, run: usize) -> Vec<AxisValue> {
        let index = run - 1;
        let Some(points) = &self.points else {
            let mut left = index;
            let mut values: Vec<AxisValue> = Vec::with_capacity(self.axes.len());
            for axis in self.axes.iter().rev() {
                let levels = axis.levels().unwrap_or(1);
                values.push(level(axis, left % levels));
                left /= levels;
            }
            values.reverse();
            return values;
        };
        let at = |(k, axis): (usize, &AxisValues)| quantile(axis, points.coordinate(k, index));
        self.axes.iter().enumerate().map(at).collect()
    }
}

/// A value of a list or a range, counted from 0.
fn level(axis: &AxisValues, index: usize) -> AxisValue {
    match axis {
        AxisValues::List(values) => values[index].clone(),
        AxisValues::Range(from, _, 1) => AxisValue::Number(*from),
        AxisValues::Range(_, to, count) if index + 1 == *count => AxisValue::Number(*to),
        AxisValues::Range(from, to, count) => {
            AxisValue::Number(from + (to - from) * (index as f64 / (count - 1) as f64))
        }
        _ => quantile(axis, 0.5),
    }
}

/// The value of an axis at which its distribution function is `u`, which lies strictly between 0 and 1. Values of lists
/// and ranges have equal shares.
///
/// Normal: mu + sigma z with z = -sqrt(2) erfc^-1(2u). Lognormal of mean m and standard deviation s: exp(a + b z) with
/// b^2 = ln(1 + s^2/m^2) and a = ln m - b^2/2.
fn quantile(axis: &AxisValues, u: f64) -> AxisValue {
    let standard_normal = || -std::f64::consts::SQRT_2 * erfc_inv(2.0 * u);
    AxisValue::Number(match axis {
        AxisValues::List(_) | AxisValues::Range(..) => {
            let levels = axis.levels().unwrap_or(1);
            return level(axis, ((u * levels as f64) as usize).min(levels - 1));
        }
        AxisValues::Uniform(low, high) => low + (high - low) * u,
        AxisValues::Normal(mean, deviation) => mean + deviation * standard_normal(),
        AxisValues::Lognormal(mean, deviation) => {
            let variance = (deviation / mean).powi(2).ln_1p();
            (mean.ln() - variance / 2.0 + variance.sqrt() * standard_normal()).exp()
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(axes: Vec<AxisValues>, runs: usize, points: Option<UnitPoints>) -> RunPlan {
        RunPlan { axes, runs, points }
    }

    #[test]
    fn a_grid_has_every_combination_once_and_its_last_axis_changes_first() {
        let list = AxisValues::List([5.0, 50.0, 100.0].map(AxisValue::Number).to_vec());
        let plan = plan(vec![list, AxisValues::Range(0.0, 1.0, 3)], 9, None);
        let rows: Vec<Vec<f64>> = (1..=9)
            .map(|run| {
                plan.values(run)
                    .iter()
                    .filter_map(AxisValue::number)
                    .collect()
            })
            .collect();
        assert_eq!(
            rows[..4],
            [
                vec![5.0, 0.0],
                vec![5.0, 0.5],
                vec![5.0, 1.0],
                vec![50.0, 0.0]
            ]
        );
        assert_eq!(rows[8], [100.0, 1.0]);
    }

    #[test]
    fn quantiles_are_those_of_the_distributions() {
        // source: tables of the standard normal distribution
        let z95 = 1.644_853_626_951_472_7;
        let at = |axis: AxisValues, u: f64| quantile(&axis, u).number().expect("a number");
        assert!((at(AxisValues::Normal(2.0, 3.0), 0.95) - (2.0 + 3.0 * z95)).abs() < 1e-13);
        assert!((at(AxisValues::Normal(2.0, 3.0), 0.05) - (2.0 - 3.0 * z95)).abs() < 1e-13);
        assert!((at(AxisValues::Uniform(2.0, 4.0), 0.25) - 2.5).abs() < 1e-15);
        // the median of a lognormal distribution is m / sqrt(1 + s^2/m^2)
        assert!((at(AxisValues::Lognormal(5.0, 1.0), 0.5) - 5.0 / 1.04_f64.sqrt()).abs() < 1e-14);
    }

    #[test]
    fn latin_samples_have_the_mean_and_deviation_of_their_distribution() {
        let axes = vec![
            AxisValues::Lognormal(10.0, 2.0),
            AxisValues::Normal(-3.0, 0.5),
        ];
        let plan = plan(axes, 20_000, Some(UnitPoints::latin(2, 20_000, 11)));
        for (axis, (mean, deviation)) in [(10.0, 2.0), (-3.0, 0.5)].into_iter().enumerate() {
            let values: Vec<f64> = (1..=20_000)
                .filter_map(|run| plan.values(run)[axis].number())
                .collect();
            let found = values.iter().sum::<f64>() / 20_000.0;
            let spread =
                (values.iter().map(|x| (x - found).powi(2)).sum::<f64>() / 19_999.0).sqrt();
            assert!((found - mean).abs() < 1e-3 * deviation, "{found}");
            assert!((spread - deviation).abs() < 2e-3 * deviation, "{spread}");
        }
    }

    #[test]
    fn lists_have_equal_shares_in_a_latin_hypercube() {
        let words = AxisValues::List(
            ["a", "b", "c"]
                .map(|word| AxisValue::Text(word.to_owned()))
                .to_vec(),
        );
        let plan = plan(vec![words], 300, Some(UnitPoints::latin(1, 300, 5)));
        let count = |word: &str| {
            (1..=300)
                .filter(|run| plan.values(*run)[0] == AxisValue::Text(word.to_owned()))
                .count()
        };
        assert_eq!([count("a"), count("b"), count("c")], [100, 100, 100]);
    }
}
