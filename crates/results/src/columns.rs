//! Histories of a run as named columns.

use sim::History;

use formats::scene::Scene;
use formats::scene::quantity::{Quantity, quantities};
use formats::text::number::push_number;
use formats::units::Dimension;

/// Number of bytes of most numbers of a table with their comma.
const LENGTH: usize = 14;

/// One column of a history file.
#[derive(Clone, Debug, PartialEq)]
pub struct HistoryColumn {
    /// Its name.
    pub name: String,
    /// Dimension of its values; angles are dimensionless.
    pub dimension: Dimension,
    /// One value per sample.
    pub values: Vec<f64>,
}

/// A history as named columns of equal length, `time` first.
///
/// ```
/// use formats::units::Dimension;
/// use results::columns::{NamedColumns, peak};
///
/// let mut record = NamedColumns::default();
/// record.push("time", Dimension::NUMBER, vec![0.0, 0.5, 1.0]);
/// record.push("wheel.vertical", Dimension::FORCE, vec![10.0, 12.5, -0.0]);
///
/// assert_eq!(record.part("wheel", "vertical"), [10.0, 12.5, 0.0]);
/// assert_eq!(peak(record.values("wheel.vertical")), Some((1, 12.5)));
/// assert!(record.values("no such column").is_empty());
/// let csv = record.csv().expect("memory");
/// assert_eq!(csv, b"time,wheel.vertical\n0.0,10.0\n0.5,12.5\n1.0,0.0\n");
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedColumns {
    /// The columns.
    pub columns: Vec<HistoryColumn>,
}

impl NamedColumns {
    /// The columns of a run of `scene`, in the order of [`quantities`]; each is a sum of channels with factors.
    #[must_use]
    pub fn new(scene: &Scene, history: &History) -> NamedColumns {
        let columns = quantities(scene).into_iter().map(
            |Quantity {
                 name,
                 dimension,
                 terms,
             }| {
                let parts: Vec<(Vec<f64>, f64)> = terms
                    .into_iter()
                    .map(|(channel, factor)| (history.column(channel), factor))
                    .collect();
                let sum = |i: usize| {
                    parts
                        .iter()
                        .fold(0.0, |sum, (values, factor)| sum + factor * values[i])
                };
                HistoryColumn {
                    name,
                    dimension,
                    values: (0..history.len()).map(sum).collect(),
                }
            },
        );
        NamedColumns {
            columns: columns.collect(),
        }
    }

    /// Appends a column.
    pub fn push(&mut self, name: impl Into<String>, dimension: Dimension, values: Vec<f64>) {
        self.columns.push(HistoryColumn {
            name: name.into(),
            dimension,
            values,
        });
    }

    /// Values of the column `name`; empty where there is none.
    #[must_use]
    pub fn values(&self, name: &str) -> &[f64] {
        self.columns
            .iter()
            .find(|column| column.name == name)
            .map_or(&[], |column| &column.values)
    }

    /// Values of the column `<owner>.<part>`, such as a body's deflection; empty where there is none.
    #[must_use]
    pub fn part(&self, owner: &str, part: &str) -> &[f64] {
        self.values(&format!("{owner}.{part}"))
    }

    /// Value of the column `<owner>.<part>` at a time, by a straight line between the rows beside it; `None`
    /// where there is no such column.
    #[must_use]
    pub fn at_time(&self, owner: &str, part: &str, time: f64) -> Option<f64> {
        let (times, values) = (self.values("time"), self.part(owner, part));
        let next = times
            .partition_point(|t| *t < time)
            .min(values.len().saturating_sub(1));
        let before = next.saturating_sub(1);
        let [from, to] = [*values.get(before)?, *values.get(next)?];
        let length = times[next] - times[before];
        let share = if length > 0.0 {
            (time - times[before]) / length
        } else {
            1.0
        };
        Some(from + share.clamp(0.0, 1.0) * (to - from))
    }

    /// The points (x, y) of two columns.
    #[must_use]
    pub fn points(&self, x: &str, y: &str) -> Vec<[f64; 2]> {
        self.values(x)
            .iter()
            .zip(self.values(y))
            .map(|(&x, &y)| [x, y])
            .collect()
    }

    /// Name of the first column with a value that is not a finite number, and the time of that value.
    #[must_use]
    pub fn first_not_finite(&self) -> Option<(&str, f64)> {
        self.columns.iter().find_map(|column| {
            let row = column.values.iter().position(|value| !value.is_finite())?;
            Some((
                column.name.as_str(),
                self.values("time").get(row).copied().unwrap_or_default(),
            ))
        })
    }

    /// The columns as comma-separated values with a header; every number reads back to the last bit.
    ///
    /// # Errors
    /// None in practice: writing to memory does not fail.
    pub fn csv(&self) -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(self.columns.iter().map(|column| &column.name))?;
        let mut out = bytes(writer)?;
        let rows = self.columns.first().map_or(0, |column| column.values.len());
        out.reserve(rows * self.columns.len() * LENGTH);
        for i in 0..rows {
            for (k, column) in self.columns.iter().enumerate() {
                if k > 0 {
                    out.push(b',');
                }
                push_number(&mut out, column.values[i]);
            }
            out.push(b'\n');
        }
        Ok(out)
    }
}

/// The bytes written by `writer`.
///
/// # Errors
/// None in practice: writing to memory does not fail.
pub fn bytes(writer: csv::Writer<Vec<u8>>) -> Result<Vec<u8>, csv::Error> {
    writer
        .into_inner()
        .map_err(|error| csv::Error::from(error.into_error()))
}

/// Largest value of a column, with its index (the last one of equal values); `None` for an empty column.
#[must_use]
pub fn peak(values: &[f64]) -> Option<(usize, f64)> {
    values
        .iter()
        .copied()
        .enumerate()
        .max_by(|a, b| a.1.total_cmp(&b.1))
}
