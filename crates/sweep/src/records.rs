//! Runs as lines of text, one JSON object each, which are only appended and can be read after any interruption.
//!
//! The first line of a file of runs is for its owner. A line `{"names": [...]}` has the names of the results of the runs
//! that follow; a line `{"run": 7, "axes": [...], "values": [...]}` is a run, and `{"run": 7, "axes": [...], "failure":
//! "..."}` one without results. Numbers have as many digits as their doubles need.

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

impl RunRecord {
    /// The run in little memory beside another one: equal names are shared, and dimensions, which are those of the input
    /// as written, are left out.
    #[must_use]
    pub fn beside(mut self, other: Option<&RunRecord>) -> RunRecord {
        if let Ok(row) = &mut self.outcome {
            row.dimensions = Vec::new();
            row.values.shrink_to_fit();
            if let Some(Ok(known)) = other.map(|other| &other.outcome)
                && known.names == row.names
            {
                row.names = Arc::clone(&known.names);
            }
        }
        self
    }
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
            Err(why) => format!("{}\n", json!({ "run": record.run, "axes": axes, "failure": why })),
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

/// The runs in a text of lines; each run once, the first of those with the same number. Reading ends at the first line
/// that is not whole, which an interrupted writer leaves.
#[must_use]
pub fn read_records(text: &str) -> Vec<RunRecord> {
    let mut names: Arc<Vec<String>> = Arc::default();
    let mut seen = std::collections::BTreeSet::new();
    let mut records = Vec::new();
    for line in text.split_inclusive('\n').filter(|line| line.ends_with('\n')) {
        let Ok(value) = serde_json::from_str::<Value>(line) else { break };
        if let Some(list) = value["names"].as_array() {
            names = Arc::new(list.iter().filter_map(|name| name.as_str().map(str::to_owned)).collect());
            continue;
        }
        let Some(record) = record(&value, &names) else { break };
        if seen.insert(record.run) {
            records.push(record);
        }
    }
    records
}

fn record(value: &Value, names: &Arc<Vec<String>>) -> Option<RunRecord> {
    let run = usize::try_from(value["run"].as_u64()?).ok()?;
    let axes = value["axes"].as_array()?.iter().map(scalar).collect::<Option<Vec<_>>>()?;
    let outcome = match value["failure"].as_str() {
        Some(why) => Err(why.to_owned()),
        None => {
            let values: Vec<f64> =
                value["values"].as_array()?.iter().map(Value::as_f64).collect::<Option<_>>()?;
            let is_whole = values.len() == names.len();
            is_whole.then(|| Ok(RunRow { names: Arc::clone(names), values, dimensions: Vec::new() }))?
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
        Ok(RunRow { names, values: values.to_vec(), dimensions: Vec::new() })
    }

    #[test]
    fn lines_are_read_back_to_the_last_bit_and_up_to_the_first_torn_one() {
        let axes =
            vec![AxisValue::Number(0.1 + 0.2), AxisValue::Text("rigid".to_owned()), AxisValue::Flag(true)];
        let records = [
            RunRecord { run: 2, axes: axes.clone(), outcome: row(&["a", "b"], &[1.0 / 3.0, -1e-300]) },
            RunRecord { run: 1, axes: axes.clone(), outcome: Err("it falls \"down\"".to_owned()) },
            RunRecord { run: 3, axes: axes.clone(), outcome: row(&["a", "b"], &[5e-324, 1.0]) },
            RunRecord { run: 4, axes, outcome: row(&["a"], &[2.0]) },
        ];
        let mut writer = RecordLines::default();
        let text: String = records.iter().map(|record| writer.lines(record)).collect();
        assert_eq!(text.matches("names").count(), 2);
        assert_eq!(read_records(&text), records);
        let twice = format!("{text}{text}");
        assert_eq!(read_records(&twice), records);
        for cut in 0..text.len() {
            let found = read_records(&text[..cut]);
            assert_eq!(found, records[..found.len()], "cut at {cut}");
        }
    }
}
