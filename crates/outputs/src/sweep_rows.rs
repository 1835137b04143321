//! The runs of a sweep that are made: a file in the output folder to which each run is appended, from which an
//! interrupted sweep resumes.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufRead, BufReader, Write};
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use sweep::{RecordLines, RecordReader, RunRecord};

use crate::Error;
use crate::files::cannot_write;
use crate::journal::keeps_runs;
use formats::text::diagnostic::Diagnostic;

/// Name of the file in an output folder.
const ROWS: &str = ".girderway-sweep";

const FORMAT: &str = "girderway-sweep-rows/1";

/// The file of runs. The caller holds the lock of the output folder.
pub(crate) struct SweepRows {
    path: PathBuf,
    file: File,
    lines: RecordLines,
}

impl SweepRows {
    /// Opens the file in a folder for the sweep with a key, and returns the numbers of the runs that it has. A line that
    /// an interrupted process left unfinished is removed.
    ///
    /// # Errors
    /// The file belongs to a sweep with another key, unless it may be discarded; an operation of the file system fails.
    pub fn open(
        folder: &Path,
        key: &str,
        may_discard: bool,
    ) -> Result<(SweepRows, BTreeSet<usize>), Error> {
        let path = folder.join(ROWS);
        let fail = |error: io::Error| cannot_write(&path, &error);
        let opened = OpenOptions::new()
            .read(true)
            .append(true)
            .create(true)
            .open(&path);
        let mut file = opened.map_err(fail)?;
        let head = format!("{}\n", json!({ "format": FORMAT, "sweep": key }));
        let mut first = Vec::new();
        let mut reader = BufReader::new(&file);
        reader.read_until(b'\n', &mut first).map_err(fail)?;
        let mut made = BTreeSet::new();
        let mut lines = RecordLines::default();
        if first == head.as_bytes() {
            let mut records = RecordReader::new(reader);
            for record in records.by_ref() {
                made.insert(record.map_err(fail)?.run);
            }
            lines = records.writer();
            file.set_len(head.len() as u64 + records.whole())
                .map_err(fail)?;
        } else {
            // without a newline it is that of a process that was interrupted before it had written the first line
            if first.ends_with(b"\n") && !may_discard {
                return Err(other_sweep(folder, &String::from_utf8_lossy(&first)));
            }
            file.set_len(0)
                .and_then(|()| file.write_all(head.as_bytes()))
                .map_err(fail)?;
        }
        keeps_runs();
        Ok((SweepRows { path, file, lines }, made))
    }

    /// The runs that the file has, in the order in which they were made.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn records(&self) -> io::Result<RecordReader<BufReader<File>>> {
        let mut reader = BufReader::new(File::open(&self.path)?);
        reader.skip_until(b'\n')?;
        Ok(RecordReader::new(reader))
    }

    /// Appends a run.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(&mut self, record: &RunRecord) -> Result<(), Error> {
        let text = self.lines.lines(record);
        self.file
            .write_all(text.as_bytes())
            .map_err(|error| cannot_write(&self.path, &error))
    }

    /// Removes the file, after the results are written.
    pub fn remove(self) {
        // a file that cannot be removed remains and is known by its key
        let _ = fs::remove_file(&self.path);
    }
}

/// The error of a folder with the runs of another sweep.
fn other_sweep(folder: &Path, first: &str) -> Error {
    let is_ours = serde_json::from_str::<Value>(first).is_ok_and(|head| head["format"] == FORMAT);
    let file = folder.join(ROWS).display().to_string();
    let expected = if is_ours {
        "contains the runs of another interrupted sweep, or of this one with other files or another version"
    } else {
        "is not a file of runs"
    };
    let fault = Diagnostic::of_file(file, expected);
    fault
        .hint("name another folder with -o, or discard these runs with --force")
        .into()
}

#[cfg(test)]
mod tests {
    use formats::sweep::AxisValue;

    use super::*;

    #[test]
    fn runs_of_a_dead_process_are_kept_and_a_torn_line_is_removed() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let record = |run: usize| RunRecord {
            run,
            axes: vec![AxisValue::Number(0.5)],
            outcome: Err("no".to_owned()),
        };
        let (mut rows, known) = SweepRows::open(folder.path(), "key", false).expect("writable");
        assert!(known.is_empty());
        rows.add(&record(1)).expect("writable");
        rows.add(&record(2)).expect("writable");
        drop(rows);
        let path = folder.path().join(ROWS);
        let text = fs::read_to_string(&path).expect("readable");
        fs::write(&path, &text[..text.len() - 5]).expect("writable");
        let (mut rows, known) = SweepRows::open(folder.path(), "key", false).expect("writable");
        assert_eq!(known, BTreeSet::from([1]));
        rows.add(&record(2)).expect("writable");
        assert_eq!(fs::read_to_string(&path).expect("readable"), text);
        let made: Result<Vec<RunRecord>, io::Error> = rows.records().expect("readable").collect();
        assert_eq!(made.expect("readable"), [record(1), record(2)]);
        drop(rows);
        assert!(SweepRows::open(folder.path(), "other", false).is_err());
        let (rows, known) = SweepRows::open(folder.path(), "other", true).expect("writable");
        assert!(known.is_empty());
        rows.remove();
        assert!(!path.exists());
    }
}
