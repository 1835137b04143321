//! How much each axis has to do with a result.

use formats::sweep::AxisValue;

use crate::axis_column::AxisColumn;
use crate::statistics::chance_of_correlation;
use crate::table::ResultTable;

/// Fewest runs for which sensitivities are stated.
const FEWEST: usize = 20;

/// Fewest runs in each class of an axis.
const IN_CLASS: usize = 5;

/// Most classes into which the values of an axis are divided.
const CLASSES: usize = 64;

/// The dependence of a result on an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensitivity {
    /// Spearman's rank correlation, -1 to 1; `None` where values of the axis are not numbers or all equal.
    pub rank_correlation: Option<f64>,
    /// Probability that ranks without any correlation have one as large as this.
    pub chance: Option<f64>,
    /// First-order Sobol index: the fraction of the variance of the result that this axis explains by itself; `None`
    /// with too few runs.
    pub first_order: Option<f64>,
}

/// The dependence of the results in a column on each axis; empty with fewer than 20 runs, or where all values are equal.
///
/// The axes of grids, Latin hypercubes and Sobol sequences are independent, so the first-order index of an axis is the
/// variance of the conditional mean of the result over its variance. The conditional mean is taken over classes of the
/// axis: its values where each has five runs or more, otherwise up to 64 classes of equal counts. With m classes and n
/// runs a fraction of (m - 1)/(n - 1) is explained by chance; it is subtracted as in the adjusted correlation ratio,
/// 1 - (1 - e^2)(n - 1)/(n - m).
///
/// # Source
/// Saltelli et al., Global Sensitivity Analysis (2008), chapter 4; Plischke, Borgonovo and Smith, Global sensitivity
/// measures from given data (2013); Ezekiel's adjustment of the correlation ratio.
#[must_use]
pub fn sensitivities(table: &ResultTable, column: usize) -> Vec<Sensitivity> {
    let (rows, results): (Vec<usize>, Vec<f64>) = (0..table.runs.len())
        .filter_map(|row| Some((row, table.result(column, row)?)))
        .unzip();
    let is_constant = results.windows(2).all(|pair| pair[0] == pair[1]);
    if results.len() < FEWEST || is_constant {
        return Vec::new();
    }
    let ranks_of_results = ranks(&results);
    let axis = |values: &AxisColumn| {
        let values = || rows.iter().map(|&row| values.value(row));
        let numbers: Option<Vec<f64>> = values().map(|value| value.number()).collect();
        let rank_correlation = numbers
            .as_deref()
            .and_then(|numbers| correlation(&ranks(numbers), &ranks_of_results));
        Sensitivity {
            rank_correlation,
            chance: rank_correlation.map(|r| chance_of_correlation(r, results.len())),
            first_order: first_order(&classes(values(), numbers.as_deref()), &results),
        }
    };
    table.axis_values.iter().map(axis).collect()
}

/// Ranks from 1; equal values have the mean of their ranks.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut ranks = vec![0.0; values.len()];
    let mut from = 0;
    while from < order.len() {
        let to = (from..order.len())
            .find(|&k| values[order[k]] != values[order[from]])
            .unwrap_or(order.len());
        let mean = (from + 1 + to) as f64 / 2.0;
        order[from..to]
            .iter()
            .for_each(|&index| ranks[index] = mean);
        from = to;
    }
    ranks
}

/// Correlation of Pearson; `None` where one side is constant.
fn correlation(a: &[f64], b: &[f64]) -> Option<f64> {
    let n = a.len() as f64;
    let (mean_a, mean_b) = (a.iter().sum::<f64>() / n, b.iter().sum::<f64>() / n);
    let product = |x: &[f64], y: &[f64], mx: f64, my: f64| -> f64 {
        x.iter().zip(y).map(|(x, y)| (x - mx) * (y - my)).sum()
    };
    let spread = (product(a, a, mean_a, mean_a) * product(b, b, mean_b, mean_b)).sqrt();
    (spread > 0.0).then(|| (product(a, b, mean_a, mean_b) / spread).clamp(-1.0, 1.0))
}

/// The class of each run by the value of an axis, from 0.
fn classes(
    values: impl ExactSizeIterator<Item = AxisValue>,
    numbers: Option<&[f64]>,
) -> Vec<usize> {
    let count = values.len();
    let mut distinct: Vec<AxisValue> = Vec::new();
    let mut own: Vec<usize> = Vec::with_capacity(count);
    for value in values {
        let found = distinct.iter().position(|known| *known == value);
        if found.is_none() && distinct.len() == CLASSES {
            break;
        }
        own.push(found.unwrap_or(distinct.len()));
        if found.is_none() {
            distinct.push(value);
        }
    }
    let is_complete = own.len() == count;
    if is_complete && count >= IN_CLASS * distinct.len() {
        return own;
    }
    let Some(numbers) = numbers else { return own };
    let groups = CLASSES.min(((count as f64).sqrt()) as usize).max(2);
    let mut order: Vec<usize> = (0..numbers.len()).collect();
    order.sort_by(|&a, &b| numbers[a].total_cmp(&numbers[b]).then(a.cmp(&b)));
    let mut class = vec![0; numbers.len()];
    for (place, &index) in order.iter().enumerate() {
        class[index] = place * groups / numbers.len();
    }
    class
}

/// The adjusted correlation ratio of the results over classes.
fn first_order(classes: &[usize], results: &[f64]) -> Option<f64> {
    let groups = classes.iter().max()? + 1;
    let n = results.len() as f64;
    if classes.len() != results.len() || groups < 2 || results.len() < 2 * groups {
        return None;
    }
    let mean = results.iter().sum::<f64>() / n;
    let mut sums = vec![(0.0, 0.0); groups];
    for (&class, value) in classes.iter().zip(results) {
        sums[class].0 += value - mean;
        sums[class].1 += 1.0;
    }
    let between: f64 = sums
        .iter()
        .filter(|(_, count)| *count > 0.0)
        .map(|(sum, count)| sum * sum / count)
        .sum();
    let all: f64 = results.iter().map(|value| (value - mean).powi(2)).sum();
    let explained = between / all;
    Some((1.0 - (1.0 - explained) * (n - 1.0) / (n - groups as f64)).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;
    use std::sync::Arc;

    use super::*;
    use crate::outcome::RunRow;
    use crate::points::UnitPoints;
    use crate::records::RunRecord;

    fn table(points: &UnitPoints, runs: usize, f: impl Fn([f64; 3]) -> f64) -> ResultTable {
        let names = Arc::new(vec!["f".to_owned()]);
        let record = |run: usize| {
            let x = [0, 1, 2].map(|axis| PI * (2.0 * points.coordinate(axis, run - 1) - 1.0));
            let row = RunRow {
                names: Arc::clone(&names),
                values: vec![f(x)],
                dimensions: Vec::new(),
            };
            RunRecord {
                run,
                axes: x.map(AxisValue::Number).to_vec(),
                outcome: Ok(row),
            }
        };
        ResultTable::new(
            ["/a", "/b", "/c"].map(str::to_owned).to_vec(),
            (1..=runs).map(record),
        )
    }

    #[test]
    fn first_order_indices_of_the_ishigami_function_are_found() {
        // analytic, a = 7, b = 0.1: V = 1/2 + a^2/8 + b pi^4/5 + b^2 pi^8/18
        let (a, b): (f64, f64) = (7.0, 0.1);
        let variance = 0.5 + a * a / 8.0 + b * PI.powi(4) / 5.0 + b * b * PI.powi(8) / 18.0;
        let exact = [
            0.5 * (1.0 + b * PI.powi(4) / 5.0).powi(2) / variance,
            a * a / 8.0 / variance,
            0.0,
        ];
        let ishigami =
            |[x, y, z]: [f64; 3]| x.sin() + a * y.sin().powi(2) + b * z.powi(4) * x.sin();
        for points in [UnitPoints::latin(3, 8192, 2), UnitPoints::sobol(3, 2)] {
            let found = sensitivities(&table(&points, 8192, ishigami), 0);
            for (axis, exact) in exact.iter().enumerate() {
                let index = found[axis].first_order.expect("enough runs");
                assert!(
                    (index - exact).abs() < 0.015,
                    "axis {axis}: {index} for {exact}"
                );
            }
        }
    }

    #[test]
    fn ranks_of_a_rising_function_agree_and_those_of_others_do_not() {
        let points = UnitPoints::latin(3, 500, 4);
        let found = sensitivities(&table(&points, 500, |[x, ..]| x.exp()), 0);
        assert!((found[0].rank_correlation.expect("numbers") - 1.0).abs() < 1e-12);
        assert_eq!(found[0].chance, Some(0.0));
        assert!(found[1].rank_correlation.expect("numbers").abs() < 0.15);
        assert!(found[1].chance.expect("numbers") > 1e-3);
        assert!(found[0].first_order.expect("runs") > 0.95);
    }

    #[test]
    fn equal_values_share_their_ranks() {
        assert_eq!(ranks(&[3.0, 1.0, 3.0, 2.0]), [3.5, 1.0, 3.5, 2.0]);
    }
}
