//! The results of all runs as one table, by columns.

use std::io::{self, Write};
use std::iter;
use std::sync::Arc;

use formats::sweep::AxisValue;

use crate::axis_column::AxisColumn;
use crate::outcome::RunRow;
use crate::records::RunRecord;

/// The results of the runs of a sweep, in the order of their numbers. It takes eight bytes for each number.
///
/// The columns are those that occur in any run, in the order in which they occur first, so that the table depends on
/// the runs alone and not on the order in which they were made.
#[derive(Clone, Debug, PartialEq)]
pub struct ResultTable {
    /// Pointers of the axes.
    pub axes: Vec<String>,
    /// Names of the results.
    pub columns: Vec<String>,
    /// Numbers of the runs that have results, from 1.
    pub runs: Vec<usize>,
    /// The values of each axis in these runs.
    pub axis_values: Vec<AxisColumn>,
    /// By column, the result of each of these runs; NaN where a run does not have it.
    results: Vec<Vec<f64>>,
    /// The columns of the results of runs, in the order in which the runs have them.
    layouts: Vec<Layout>,
    /// The layout of each of these runs.
    layout_of: Vec<u32>,
    /// Number, values of the axes and reason of each run without results.
    pub failures: Vec<(usize, Vec<AxisValue>, String)>,
}

/// The results of runs that have the same.
#[derive(Clone, Debug, PartialEq)]
struct Layout {
    names: Arc<Vec<String>>,
    /// Index of the column of each.
    columns: Vec<usize>,
    /// The first run that has them.
    first: usize,
}

impl ResultTable {
    /// The table of runs in any order; `axes` are the pointers of the axes.
    #[must_use]
    pub fn new(axes: Vec<String>, records: impl IntoIterator<Item = RunRecord>) -> ResultTable {
        let records = records.into_iter();
        let mut table = TableBuilder::new(axes, records.size_hint().0);
        records.for_each(|record| table.add(record));
        table.finish()
    }

    /// A result of a row, by the index of its column; `None` where the run does not have it.
    #[must_use]
    pub fn result(&self, column: usize, row: usize) -> Option<f64> {
        Some(self.results[column][row]).filter(|value| !value.is_nan())
    }

    /// Values of a column with the numbers of their runs.
    #[must_use]
    pub fn column(&self, index: usize) -> Vec<(usize, f64)> {
        let all = self
            .runs
            .iter()
            .copied()
            .zip(self.results[index].iter().copied());
        all.filter(|(_, value)| !value.is_nan()).collect()
    }

    /// All runs in the order of their numbers.
    pub fn records(&self) -> impl Iterator<Item = RunRecord> {
        let mut rows = (0..self.runs.len()).peekable();
        let mut failures = self.failures.iter().peekable();
        iter::from_fn(move || {
            let next = rows.peek().map(|&row| self.runs[row]);
            match failures.next_if(|(run, ..)| next.is_none_or(|next| *run < next)) {
                Some((run, axes, why)) => Some(RunRecord {
                    run: *run,
                    axes: axes.clone(),
                    outcome: Err(why.clone()),
                }),
                None => rows.next().map(|row| self.record(row)),
            }
        })
    }

    /// The run of a row.
    fn record(&self, row: usize) -> RunRecord {
        let layout = &self.layouts[self.layout_of[row] as usize];
        let values = layout
            .columns
            .iter()
            .map(|&column| self.results[column][row])
            .collect();
        RunRecord {
            run: self.runs[row],
            axes: self
                .axis_values
                .iter()
                .map(|axis| axis.value(row))
                .collect(),
            outcome: Ok(RunRow {
                names: Arc::clone(&layout.names),
                values,
                dimensions: Vec::new(),
            }),
        }
    }

    /// Writes the results as comma-separated values: `run`, the axes by their pointers, and the results.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_csv(&self, to: impl Write) -> io::Result<()> {
        let mut writer = csv::Writer::from_writer(to);
        let head = ["run"]
            .into_iter()
            .chain(self.axes.iter().chain(&self.columns).map(String::as_str));
        writer.write_record(head)?;
        for row in 0..self.runs.len() {
            writer.write_field(self.runs[row].to_string())?;
            for axis in &self.axis_values {
                writer.write_field(axis.value(row).to_string())?;
            }
            for column in 0..self.columns.len() {
                let value = self.result(column, row);
                writer.write_field(value.map_or_else(String::new, |value| format!("{value:?}")))?;
            }
            writer.write_record(None::<&[u8]>)?;
        }
        writer.flush()
    }

    /// Writes the runs without results as comma-separated values: `run`, the axes, and `reason`.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_failures_csv(&self, to: impl Write) -> io::Result<()> {
        let mut writer = csv::Writer::from_writer(to);
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
        writer.flush()
    }
}

/// A table of runs to which one after the other is added, in any order. Of each run only its numbers are kept.
#[derive(Clone, Debug)]
pub struct TableBuilder {
    table: ResultTable,
    /// Number of runs for which columns have room.
    room: usize,
    /// Layout of the run before.
    last: usize,
}

impl TableBuilder {
    /// A table without runs, with room for as many as there will be; `axes` are the pointers of the axes.
    #[must_use]
    pub fn new(axes: Vec<String>, room: usize) -> TableBuilder {
        let table = ResultTable {
            axis_values: axes.iter().map(|_| AxisColumn::with_room(room)).collect(),
            axes,
            columns: Vec::new(),
            runs: Vec::with_capacity(room),
            results: Vec::new(),
            layouts: Vec::new(),
            layout_of: Vec::with_capacity(room),
            failures: Vec::new(),
        };
        TableBuilder {
            table,
            room,
            last: 0,
        }
    }

    /// Adds a run.
    pub fn add(&mut self, record: RunRecord) {
        let RunRecord { run, axes, outcome } = record;
        match outcome {
            Ok(row) => {
                let layout = self.layout(run, row.names);
                let table = &mut self.table;
                table.runs.push(run);
                table.layout_of.push(layout as u32);
                table
                    .axis_values
                    .iter_mut()
                    .zip(axes)
                    .for_each(|(column, value)| column.push(value));
                table
                    .results
                    .iter_mut()
                    .for_each(|column| column.push(f64::NAN));
                let places = &table.layouts[layout].columns;
                for (&place, value) in places.iter().zip(row.values) {
                    if let Some(last) = table.results[place].last_mut() {
                        *last = value;
                    }
                }
            }
            Err(why) => self.table.failures.push((run, axes, why)),
        }
    }

    /// The layout of a run whose results have these names, which is added where it is new.
    fn layout(&mut self, run: usize, names: Arc<Vec<String>>) -> usize {
        let layouts = &self.table.layouts;
        let is_last = layouts
            .get(self.last)
            .is_some_and(|last| last.names == names);
        let known = if is_last {
            Some(self.last)
        } else {
            layouts.iter().position(|one| one.names == names)
        };
        self.last = known.unwrap_or(layouts.len());
        match known {
            Some(known) => {
                let first = &mut self.table.layouts[known].first;
                *first = run.min(*first);
            }
            None => {
                let columns = names.iter().map(|name| self.place(name)).collect();
                self.table.layouts.push(Layout {
                    names,
                    columns,
                    first: run,
                });
            }
        }
        self.last
    }

    /// The column of a result by its name, which is added where it is new.
    fn place(&mut self, name: &String) -> usize {
        let table = &mut self.table;
        table
            .columns
            .iter()
            .position(|known| known == name)
            .unwrap_or_else(|| {
                table.columns.push(name.clone());
                let mut column = Vec::with_capacity(self.room);
                column.resize(table.runs.len(), f64::NAN);
                table.results.push(column);
                table.columns.len() - 1
            })
    }

    /// The table, its rows in the order of the runs, and its columns in the order in which these have them.
    #[must_use]
    pub fn finish(self) -> ResultTable {
        let mut table = self.table;
        table.failures.sort_by_key(|(run, ..)| *run);
        if !table.runs.is_sorted() {
            let mut order: Vec<usize> = (0..table.runs.len()).collect();
            order.sort_by_key(|&row| table.runs[row]);
            table.runs = order.iter().map(|&row| table.runs[row]).collect();
            table.layout_of = order.iter().map(|&row| table.layout_of[row]).collect();
            table
                .axis_values
                .iter_mut()
                .for_each(|axis| axis.arrange(&order));
            for column in &mut table.results {
                *column = order.iter().map(|&row| column[row]).collect();
            }
        }
        let mut by_first: Vec<&Layout> = table.layouts.iter().collect();
        by_first.sort_by_key(|layout| layout.first);
        let mut order: Vec<usize> = Vec::with_capacity(table.columns.len());
        let mut new_place = vec![None; table.columns.len()];
        for &column in by_first.iter().flat_map(|layout| &layout.columns) {
            if new_place[column].is_none() {
                new_place[column] = Some(order.len());
                order.push(column);
            }
        }
        table.columns = order
            .iter()
            .map(|&column| std::mem::take(&mut table.columns[column]))
            .collect();
        table.results = order
            .iter()
            .map(|&column| std::mem::take(&mut table.results[column]))
            .collect();
        for column in table
            .layouts
            .iter_mut()
            .flat_map(|layout| &mut layout.columns)
        {
            *column = new_place[*column].expect("every column is that of a layout");
        }
        table
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(run: usize, results: &[(&str, f64)]) -> RunRecord {
        let names = Arc::new(results.iter().map(|(name, _)| (*name).to_owned()).collect());
        let values = results.iter().map(|(_, value)| *value).collect();
        let axes = vec![
            AxisValue::Number(run as f64 / 8.0),
            AxisValue::Text(format!("word {}", run % 2)),
        ];
        RunRecord {
            run,
            axes,
            outcome: Ok(RunRow {
                names,
                values,
                dimensions: Vec::new(),
            }),
        }
    }

    fn table(records: &[RunRecord]) -> ResultTable {
        ResultTable::new(
            ["/a", "/b"].map(str::to_owned).to_vec(),
            records.iter().cloned(),
        )
    }

    /// Runs with different results, and one without.
    fn records() -> Vec<RunRecord> {
        let failed = RunRecord {
            run: 3,
            axes: vec![AxisValue::Number(0.5), AxisValue::Text("word 1".to_owned())],
            outcome: Err("it falls, \"down\"".to_owned()),
        };
        vec![
            record(1, &[("c", 1.0), ("a", 2.5)]),
            record(2, &[("b", 3.0)]),
            failed,
            record(4, &[("a", -4.0), ("c", 5.0), ("d", 6.0)]),
            record(5, &[("c", 7.0), ("a", 8.0)]),
        ]
    }

    #[test]
    fn a_table_depends_on_the_runs_alone_and_has_all_of_them() {
        let all = records();
        let expected = table(&all);
        assert_eq!(expected.columns, ["c", "a", "b", "d"]);
        assert_eq!(expected.runs, [1, 2, 4, 5]);
        assert_eq!(expected.column(0), [(1, 1.0), (4, 5.0), (5, 7.0)]);
        assert_eq!(expected.result(2, 0), None);
        let mut csv = Vec::new();
        expected.write_csv(&mut csv).expect("memory");
        let lines = "run,/a,/b,c,a,b,d\n1,0.125,word 1,1.0,2.5,,\n2,0.25,word 0,,,3.0,\n\
                     4,0.5,word 0,5.0,-4.0,,6.0\n5,0.625,word 1,7.0,8.0,,\n";
        assert_eq!(String::from_utf8(csv).expect("text"), lines);
        let mut failures = Vec::new();
        expected.write_failures_csv(&mut failures).expect("memory");
        let lines = "run,/a,/b,reason\n3,0.5,word 1,\"it falls, \"\"down\"\"\"\n";
        assert_eq!(String::from_utf8(failures).expect("text"), lines);
        // every order in which five runs can be made, by Heap's method
        let mut order = all.clone();
        let mut count = [0; 5];
        let mut at = 0;
        while at < order.len() {
            if count[at] < at {
                order.swap(if at % 2 == 0 { 0 } else { count[at] }, at);
                count[at] += 1;
                at = 0;
                let found = table(&order);
                assert_eq!(
                    (&found.columns, &found.runs),
                    (&expected.columns, &expected.runs)
                );
                assert_eq!(found.records().collect::<Vec<_>>(), all);
                let mut csv = Vec::new();
                found.write_csv(&mut csv).expect("memory");
                assert!(csv.starts_with(b"run,/a,/b,c,a,b,d\n1,0.125,word 1,1.0,2.5,,\n"));
            } else {
                count[at] = 0;
                at += 1;
            }
        }
    }

    #[test]
    fn a_table_takes_eight_bytes_for_each_number_also_where_results_alternate() {
        const RUNS: usize = 1000;
        const RESULTS: usize = 88;
        let names: Vec<String> = (0..RESULTS)
            .map(|k| format!("girder.span {k}.bending.bottom"))
            .collect();
        let run = |run: usize| {
            let results = names.iter().map(|name| (name.as_str(), run as f64));
            // the span that governs is that of one run or another
            let last = if run.is_multiple_of(2) {
                "span 1.web"
            } else {
                "span 2.web"
            };
            record(run, &results.chain([(last, 0.5)]).collect::<Vec<_>>())
        };
        let made = ResultTable::new(
            ["/a", "/b"].map(str::to_owned).to_vec(),
            (1..=RUNS).map(run),
        );
        // names once, and for each run its results, its number, its axes and its layout
        assert_eq!(
            (made.layouts.len(), made.columns.len(), made.results.len()),
            (2, RESULTS + 2, RESULTS + 2)
        );
        let AxisColumn::Numbers(numbers) = &made.axis_values[0] else {
            panic!("not numbers")
        };
        let AxisColumn::Levels(levels, rows) = &made.axis_values[1] else {
            panic!("not words")
        };
        assert_eq!((numbers.len(), levels.len(), rows.len()), (RUNS, 2, RUNS));
        let room: usize = made.results.iter().map(Vec::capacity).sum();
        assert_eq!(room, RUNS * (RESULTS + 2));
        assert_eq!(made.runs.capacity() + made.layout_of.capacity(), 2 * RUNS);
    }
}
