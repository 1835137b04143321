//! Runs as lines of text, one JSON object each, which are only appended and can be read after any interruption.
//!
//! The first line of a file of runs is for its owner. A line `{"names": [...]}` has the names of the results of the runs
//! that follow; a line `{"run": 7, "axes": [...], "values": [...]}` is a run, and `{"run": 7, "axes": [...], "failure":
//! "..."}` one without results. Numbers have as many digits as their doubles need.

use std::collections::BTreeSet;
use std::io::{self, BufRead};
use std::sync::Arc;

use formats::sweep::AxisValue;
use serde_json::{Value, json};

use crate::outcome::{RunOutcome, RunRow};

/// One run of a sweep with its values and results.
#[derive(Clone, Debug, PartialEq)]
pub struct RunRecord {
    /// Number of the run, from 1.
    pub run: usize,
    /// Values of the axes.
    pub axes: Vec<AxisValue>,
    /// Its results.
    pub outcome: RunOutcome,
}

/// Writes runs as lines.
#[derive(Clone, Debug, Default)]
pub struct RecordLines {
    names: Option<Arc<Vec<String>>>,
}

impl RecordLines {
    /// Lines of a run, each with its newline: the names of its results, unless they are those of the run before, and
    /// the run.
    pub fn lines(&mut self, record: &RunRecord) -> String {
        let axes: Vec<Value> = record.axes.iter().map(AxisValue::json).collect();
        match &record.outcome {
            Err(why) => format!(
                "{}\n",
                json!({ "run": record.run, "axes": axes, "failure": why })
            ),
            Ok(row) => {
                let line = json!({ "run": record.run, "axes": axes, "values": row.values });
                if self.names.as_ref() == Some(&row.names) {
                    return format!("{line}\n");
                }
                self.names = Some(Arc::clone(&row.names));
                format!("{}\n{line}\n", json!({ "names": *row.names }))
            }
        }
    }
}

/// Reads the runs of a file of lines, one after the other; each run once, the first of those with the same number.
/// Reading ends at the first line that is not whole, which an interrupted writer leaves.
#[derive(Debug)]
pub struct RecordReader<R> {
    lines: R,
    line: Vec<u8>,
    names: Arc<Vec<String>>,
    seen: BTreeSet<usize>,
    whole: u64,
}

impl<R: BufRead> RecordReader<R> {
    /// A reader of lines that begin here.
    pub fn new(lines: R) -> RecordReader<R> {
        RecordReader {
            lines,
            line: Vec::new(),
            names: Arc::default(),
            seen: BTreeSet::new(),
            whole: 0,
        }
    }

    /// Bytes of the whole lines that were read.
    pub const fn whole(&self) -> u64 {
        self.whole
    }

    /// A writer that goes on after the lines that were read.
    #[must_use]
    pub fn writer(&self) -> RecordLines {
        RecordLines {
            names: Some(Arc::clone(&self.names)).filter(|_| self.whole > 0),
        }
    }

    /// The next run; `None` after the last whole line.
    fn read(&mut self) -> io::Result<Option<RunRecord>> {
        loop {
            self.line.clear();
            let read = self.lines.read_until(b'\n', &mut self.line)?;
            if self.line.last() != Some(&b'\n') {
                return Ok(None);
            }
            let Ok(value) = serde_json::from_slice::<Value>(&self.line) else {
                return Ok(None);
            };
            let found = match value["names"].as_array() {
                Some(list) => {
                    let names = list
                        .iter()
                        .filter_map(|name| name.as_str().map(str::to_owned))
                        .collect();
                    self.names = Arc::new(names);
                    None
                }
                None => match record(&value, &self.names) {
                    Some(record) => Some(record),
                    None => return Ok(None),
                },
            };
            self.whole += read as u64;
            if let Some(record) = found.filter(|record| self.seen.insert(record.run)) {
                return Ok(Some(record));
            }
        }
    }
}

impl<R: BufRead> Iterator for RecordReader<R> {
    type Item = io::Result<RunRecord>;

    fn next(&mut self) -> Option<io::Result<RunRecord>> {
        self.read().transpose()
    }
}

fn record(value: &Value, names: &Arc<Vec<String>>) -> Option<RunRecord> {
    let run = usize::try_from(value["run"].as_u64()?).ok()?;
    let axes = value["axes"]
        .as_array()?
        .iter()
        .map(scalar)
        .collect::<Option<Vec<_>>>()?;
    let outcome = match value["failure"].as_str() {
        Some(why) => Err(why.to_owned()),
        None => {
            let values: Vec<f64> = value["values"]
                .as_array()?
                .iter()
                .map(Value::as_f64)
                .collect::<Option<_>>()?;
            let is_whole = values.len() == names.len();
            is_whole.then(|| {
                Ok(RunRow {
                    names: Arc::clone(names),
                    values,
                    dimensions: Vec::new(),
                })
            })?
        }
    };
    Some(RunRecord { run, axes, outcome })
}

fn scalar(value: &Value) -> Option<AxisValue> {
    match value {
        Value::Number(number) => number.as_f64().map(AxisValue::Number),
        Value::String(text) => Some(AxisValue::Text(text.clone())),
        Value::Bool(flag) => Some(AxisValue::Flag(*flag)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(names: &[&str], values: &[f64]) -> RunOutcome {
        let names = Arc::new(names.iter().map(|name| (*name).to_owned()).collect());
        Ok(RunRow {
            names,
            values: values.to_vec(),
            dimensions: Vec::new(),
        })
    }

    #[test]
    fn lines_are_read_back_to_the_last_bit_and_up_to_the_first_torn_one() {
        let axes = vec![
            AxisValue::Number(0.1 + 0.2),
            AxisValue::Text("rigid".to_owned()),
            AxisValue::Flag(true),
        ];
        let records = [
            RunRecord {
                run: 2,
                axes: axes.clone(),
                outcome: row(&["a", "b"], &[1.0 / 3.0, -1e-300]),
            },
            RunRecord {
                run: 1,
                axes: axes.clone(),
                outcome: Err("it falls \"down\"".to_owned()),
            },
            RunRecord {
                run: 3,
                axes: axes.clone(),
                outcome: row(&["a", "b"], &[5e-324, 1.0]),
            },
            RunRecord {
                run: 4,
                axes,
                outcome: row(&["a"], &[2.0]),
            },
        ];
        let mut writer = RecordLines::default();
        let text: String = records.iter().map(|record| writer.lines(record)).collect();
        assert_eq!(text.matches("names").count(), 2);
        let read = |text: &str| -> Vec<RunRecord> {
            RecordReader::new(text.as_bytes())
                .map(|record| record.expect("memory"))
                .collect()
        };
        assert_eq!(read(&text), records);
        let twice = format!("{text}{text}");
        assert_eq!(read(&twice), records);
        for cut in 0..text.len() {
            let mut reader = RecordReader::new(&text.as_bytes()[..cut]);
            let found: Vec<RunRecord> = reader
                .by_ref()
                .map(|record| record.expect("memory"))
                .collect();
            assert_eq!(found, records[..found.len()], "cut at {cut}");
            // what was cut off is written again
            let mut whole = text[..reader.whole() as usize].to_owned();
            let mut writer = reader.writer();
            whole.extend(
                records[found.len()..]
                    .iter()
                    .map(|record| writer.lines(record)),
            );
            assert_eq!(whole, text, "cut at {cut}");
        }
    }
}
