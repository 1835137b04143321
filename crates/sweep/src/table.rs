//! The results of all runs as one table.

use std::sync::Arc;

use formats::sweep::AxisValue;

use crate::records::RunRecord;

/// The results of the runs of a sweep, in the order of their numbers.
///
/// The columns are those that occur in any run, in the order in which they occur first, so that the table depends on
/// the runs alone and not on the order in which they were made.
#[derive(Clone, Debug, PartialEq)]
pub struct ResultTable {
    /// Pointers of the axes.
    pub axes: Vec<String>,
    /// Names of the results.
    pub columns: Vec<String>,
    /// One for each run that has results.
    pub rows: Vec<TableRow>,
    /// Number, values of the axes and reason of each run without results.
    pub failures: Vec<(usize, Vec<AxisValue>, String)>,
}

/// The results of one run.
#[derive(Clone, Debug, PartialEq)]
pub struct TableRow {
    /// Number of the run, from 1.
    pub run: usize,
    /// Values of the axes.
    pub axes: Vec<AxisValue>,
    /// Results, in the order of the columns; `None` where this run does not have one.
    pub values: Vec<Option<f64>>,
}

impl ResultTable {
    /// The table of runs in any order; `axes` are the pointers of the axes.
    #[must_use]
    pub fn new(axes: Vec<String>, mut records: Vec<RunRecord>) -> ResultTable {
        records.sort_by_key(|record| record.run);
        let mut table = ResultTable {
            axes,
            columns: Vec::new(),
            rows: Vec::with_capacity(records.len()),
            failures: Vec::new(),
        };
        let mut known: (Arc<Vec<String>>, Vec<usize>) = (Arc::default(), Vec::new());
        for RunRecord { run, axes, outcome } in records {
            match outcome {
                Ok(row) => {
                    if known.0 != row.names {
                        let places = table.places(&row.names);
                        known = (row.names, places);
                    }
                    let mut values = vec![None; table.columns.len()];
                    known.1.iter().zip(&row.values).for_each(|(&place, &value)| values[place] = Some(value));
                    table.rows.push(TableRow { run, axes, values });
                }
                Err(why) => table.failures.push((run, axes, why)),
            }
        }
        let columns = table.columns.len();
        table.rows.iter_mut().for_each(|row| row.values.resize(columns, None));
        table
    }

    /// The columns of results by their names, which are added where they are new.
    fn places(&mut self, names: &[String]) -> Vec<usize> {
        let place = |name: &String| {
            self.columns.iter().position(|known| known == name).unwrap_or_else(|| {
                self.columns.push(name.clone());
                self.columns.len() - 1
            })
        };
        names.iter().map(place).collect()
    }

    /// Values of a column with the numbers of their runs.
    #[must_use]
    pub fn column(&self, index: usize) -> Vec<(usize, f64)> {
        self.rows.iter().filter_map(|row| row.values[index].map(|value| (row.run, value))).collect()
    }

    /// The results as comma-separated values: `run`, the axes by their pointers, and the results.
    ///
    /// # Errors
    /// None in practice: writing to memory does not fail.
    pub fn csv(&self) -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let head = ["run"].into_iter().chain(self.axes.iter().chain(&self.columns).map(String::as_str));
        writer.write_record(head)?;
        for row in &self.rows {
            writer.write_field(row.run.to_string())?;
            for value in &row.axes {
                writer.write_field(value.to_string())?;
            }
            for value in &row.values {
                writer.write_field(value.map_or_else(String::new, |value| format!("{value:?}")))?;
            }
            writer.write_record(None::<&[u8]>)?;
        }
        writer.into_inner().map_err(|error| error.into_error().into())
    }

    /// The runs without results as comma-separated values: `run`, the axes, and `reason`.
    ///
    /// # Errors
    /// None in practice: writing to memory does not fail.
    pub fn failures_csv(&self) -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let axes = self.axes.iter().map(String::as_str);
        writer.write_record(["run"].into_iter().chain(axes).chain(["reason"]))?;
        for (run, axes, why) in &self.failures {
            writer.write_field(run.to_string())?;
            for value in axes {
                writer.write_field(value.to_string())?;
            }
            writer.write_field(why)?;
            writer.write_record(None::<&[u8]>)?;
        }
        writer.into_inner().map_err(|error| error.into_error().into())
    }
}
