//! Histories as named columns.

use sim::History;

use formats::quantity::{Quantity, quantities};
use formats::scene::Scene;
use formats::units::Dimension;

/// One column of a history file.
#[derive(Clone, Debug, PartialEq)]
pub struct HistoryColumn {
    /// Its name.
    pub name: String,
    /// Dimension of its values; angles have none.
    pub dimension: Dimension,
    /// One value a sample.
    pub values: Vec<f64>,
}

/// A history as named columns, `time` first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedColumns {
    /// The columns.
    pub columns: Vec<HistoryColumn>,
}

impl NamedColumns {
    /// The quantities of a run of `scene`, in their order.
    #[must_use]
    pub fn new(scene: &Scene, history: &History) -> NamedColumns {
        let columns = quantities(scene).into_iter().map(|Quantity { name, dimension, terms }| {
            let parts: Vec<(Vec<f64>, f64)> =
                terms.into_iter().map(|(channel, factor)| (history.column(channel), factor)).collect();
            let sum = |i: usize| parts.iter().fold(0.0, |sum, (values, factor)| sum + factor * values[i]);
            HistoryColumn { name, dimension, values: (0..history.len()).map(sum).collect() }
        });
        NamedColumns { columns: columns.collect() }
    }

    /// Adds a column.
    pub fn push(&mut self, name: impl Into<String>, dimension: Dimension, values: Vec<f64>) {
        self.columns.push(HistoryColumn { name: name.into(), dimension, values });
    }

    /// One column by name; empty where there is none.
    #[must_use]
    pub fn values(&self, name: &str) -> &[f64] {
        self.columns.iter().find(|column| column.name == name).map_or(&[], |column| &column.values)
    }

    /// The column `<owner>.<part>`, such as a body's deflection; empty where there is none.
    #[must_use]
    pub fn part(&self, owner: &str, part: &str) -> &[f64] {
        self.values(&format!("{owner}.{part}"))
    }

    /// Two columns as points.
    #[must_use]
    pub fn points(&self, x: &str, y: &str) -> Vec<[f64; 2]> {
        self.values(x).iter().zip(self.values(y)).map(|(&x, &y)| [x, y]).collect()
    }

    /// As comma-separated values with a header; every number reads back to the last bit.
    ///
    /// # Errors
    /// None in practice: memory takes every byte.
    pub fn csv(&self) -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(self.columns.iter().map(|column| &column.name))?;
        let rows = self.columns.first().map_or(0, |column| column.values.len());
        for i in 0..rows {
            // adding zero turns -0 into 0
            writer.write_record(self.columns.iter().map(|column| format!("{:?}", column.values[i] + 0.0)))?;
        }
        bytes(writer)
    }
}

/// What was written.
pub fn bytes(writer: csv::Writer<Vec<u8>>) -> Result<Vec<u8>, csv::Error> {
    writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))
}

/// Largest value of a column, with its index.
#[must_use]
pub fn peak(values: &[f64]) -> Option<(usize, f64)> {
    values.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1))
}
