//! Columns of a run at the nodes of its solution, and what follows between them.
//!
//! In each interval of the solution a column is nearly the polynomial through its values at the nodes: forces and motions are, and
//! ordinates of influence lines change little while wheels move by so much. Extremes and turning points are those of the
//! polynomials, whatever the output interval.

use formats::scene::Scene;
use piecewise::{Extreme, Lobatto, between};
use sim::{NodeInterval, SolutionNodes};

use crate::columns::NamedColumns;
use formats::units::Dimension;

/// Differences, relative to the value, that are rounding: columns that stay the same have no other.
const ROUNDING: f64 = 1e-13;

/// Negative values of a column that has none at the nodes, relative to its largest, which are those of a polynomial alone.
const ONE_SIDED: f64 = 1e-3;

/// The columns of a run at the nodes of its solution.
#[derive(Clone, Debug, Default)]
pub struct SteppedColumns {
    /// Their values; where values jump there are two rows of one time.
    pub record: NamedColumns,
    intervals: Vec<NodeInterval>,
}

/// A value of a column and its time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ColumnInstant {
    /// The value.
    pub value: f64,
    /// The time.
    pub time: f64,
}

/// The largest and the smallest value of a column over a run.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnPeak {
    /// Name of the column.
    pub column: String,
    /// Dimension of its values; angles are dimensionless.
    pub dimension: Dimension,
    /// The largest value.
    pub max: ColumnInstant,
    /// The smallest.
    pub min: ColumnInstant,
}

impl ColumnPeak {
    /// The peak of larger magnitude.
    #[must_use]
    pub fn largest(&self) -> ColumnInstant {
        if self.min.value.abs() > self.max.value.abs() {
            self.min
        } else {
            self.max
        }
    }
}

impl SteppedColumns {
    /// The columns of a run of `scene`.
    #[must_use]
    pub fn new(scene: &Scene, nodes: &SolutionNodes) -> SteppedColumns {
        SteppedColumns {
            record: NamedColumns::new(scene, &nodes.rows),
            intervals: nodes.intervals.clone(),
        }
    }

    /// The times of the nodes.
    #[must_use]
    pub fn times(&self) -> &[f64] {
        self.record.values("time")
    }

    /// The time at a place of an interval.
    fn time(times: &[f64], interval: NodeInterval, share: f64) -> f64 {
        let [from, to] = [0, interval.degree].map(|k| times[interval.first + k]);
        between([from, to], share)
    }

    /// The largest value of sign times a column, times the sign; `None` without rows.
    fn extreme(&self, values: &[f64], sign: f64) -> Option<ColumnInstant> {
        let times = self.times();
        let mut best = ColumnInstant {
            value: sign * *values.first()?,
            time: *times.first()?,
        };
        let mut signed = Vec::new();
        for &interval in &self.intervals {
            let own = &values[interval.first..=interval.first + interval.degree];
            let [low, high] = own
                .iter()
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| {
                    [a.min(sign * v), b.max(sign * v)]
                });
            let [_, bound] = Lobatto::bounds([low, high]);
            if bound <= best.value + ROUNDING * best.value.abs() {
                continue;
            }
            signed.clear();
            signed.extend(own.iter().map(|value| sign * value));
            let polynomial = Lobatto::of(interval.degree).polynomial(&signed);
            if let Some(Extreme { share, value }) = polynomial.largest_above(best.value) {
                best = ColumnInstant {
                    value,
                    time: Self::time(times, interval, share),
                };
            }
        }
        best.value *= sign;
        Some(best)
    }

    /// The largest and the smallest of the `values` of a column at the nodes and between them; `None` without rows.
    #[must_use]
    pub fn extremes(&self, values: &[f64]) -> Option<[ColumnInstant; 2]> {
        let max = self.extreme(values, 1.0)?;
        let mut min = self.extreme(values, -1.0)?;
        let is_never_negative = values.iter().all(|value| *value >= 0.0);
        if is_never_negative && min.value < 0.0 && -min.value < ONE_SIDED * max.value {
            min.value = 0.0;
        }
        Some([max, min])
    }

    /// The peaks of all columns but time, in their order.
    #[must_use]
    pub fn peaks(&self) -> Vec<ColumnPeak> {
        let columns = self.record.columns.iter().skip(1);
        let peak = columns.filter_map(|column| {
            let [max, min] = self.extremes(&column.values)?;
            Some(ColumnPeak {
                column: column.name.clone(),
                dimension: column.dimension,
                max,
                min,
            })
        });
        peak.collect()
    }

    /// Starts and ends of the times at which a column is zero.
    #[must_use]
    pub fn zeros(&self, values: &[f64]) -> Vec<[f64; 2]> {
        let times = self.times();
        let mut found: Vec<[f64; 2]> = Vec::new();
        if values.is_empty() {
            return found;
        }
        for &NodeInterval { first, degree } in &self.intervals {
            let own = first..=first + degree;
            if values[own].iter().any(|value| *value != 0.0) {
                continue;
            }
            let [from, to] = [times[first], times[first + degree]];
            match found.last_mut() {
                Some(last) if last[1] == from => last[1] = to,
                _ => found.push([from, to]),
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns with straight lines between the times 0, 1, 2 and so on.
    fn straight(values: &[f64]) -> SteppedColumns {
        let mut record = NamedColumns::default();
        let times = (0..values.len()).map(|k| k as f64).collect();
        record.push("time", Dimension::NUMBER, times);
        let intervals = (1..values.len()).map(|k| NodeInterval {
            first: k - 1,
            degree: 1,
        });
        SteppedColumns {
            intervals: intervals.collect(),
            record,
        }
    }

    #[test]
    fn intervals_of_zeros_are_found_at_the_start_between_and_at_the_end() {
        let force = [0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        let found = straight(&force).zeros(&force);
        assert_eq!(found, [[0.0, 1.0], [3.0, 5.0], [7.0, 8.0]]);
        // a zero at one time has no length
        let touched = [1.0, 0.0, 1.0];
        assert!(straight(&touched).zeros(&touched).is_empty());
    }

    /// Analytic: t (2 - t) in one interval of degree 2 has its largest value between the nodes of a coarser one.
    #[test]
    fn extremes_lie_between_the_nodes() {
        let mut own = straight(&[0.0, 0.0, 0.0]);
        own.record = NamedColumns::default();
        own.record
            .push("time", Dimension::NUMBER, vec![0.0, 0.75, 1.5]);
        own.intervals = vec![NodeInterval {
            first: 0,
            degree: 2,
        }];
        let values = [0.0, 0.9375, 0.75];
        let [max, min] = own.extremes(&values).expect("rows");
        assert!((max.value - 1.0).abs() < 1e-14 && (max.time - 1.0).abs() < 1e-12);
        assert_eq!((min.value, min.time), (0.0, 0.0));
    }
}
