//! Shards of a sweep: what a shard's folder holds beside its results, and all shards read back.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufReader};
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_json::{Value, json};
use sweep::{RecordReader, RunRecord, SweepInfo};

use crate::Error;
use crate::hashed::sha256_of;
use crate::manifest::{InputEntry, MANIFEST, listed_files};
use formats::text::diagnostic::Diagnostic;

/// Name of the file that describes a shard.
pub(crate) const SHARD: &str = "shard.json";

/// Name of the file with the runs of a shard.
pub(crate) const ROWS: &str = "rows.jsonl";

const FORMAT: &str = "girderway-shard/1";

/// The description of a shard.
pub(crate) struct Shard {
    /// Key of the whole sweep.
    pub key: String,
    /// Number of the shard, from 1.
    pub shard: usize,
    /// Number of shards.
    pub of: usize,
    /// The sweep.
    pub info: SweepInfo,
}

impl Shard {
    /// The description as JSON, with the files that the sweep read.
    pub fn json(&self, inputs: &[InputEntry]) -> Value {
        json!({
            "format": FORMAT,
            "sweep": self.key,
            "shard": self.shard,
            "of": self.of,
            "info": self.info,
            "inputs": inputs,
        })
    }
}

/// All shards of a sweep, joined.
pub(crate) struct JoinedShards {
    /// The sweep.
    pub info: SweepInfo,
    /// The files that it read.
    pub inputs: Vec<InputEntry>,
    /// The files of their runs.
    rows: Vec<PathBuf>,
}

impl JoinedShards {
    /// All runs, shard after shard.
    pub fn records(&self) -> impl Iterator<Item = io::Result<RunRecord>> {
        self.rows.iter().flat_map(|path| {
            let (records, error) = match records_of(path) {
                Ok(records) => (Some(records), None),
                Err(error) => (None, Some(Err(error))),
            };
            records.into_iter().flatten().chain(error)
        })
    }
}

/// The runs in the file of a shard.
fn records_of(path: &Path) -> io::Result<RecordReader<BufReader<File>>> {
    File::open(path).map(|file| RecordReader::new(BufReader::new(file)))
}

#[derive(Deserialize)]
struct ShardFile {
    format: String,
    sweep: String,
    shard: usize,
    of: usize,
    info: SweepInfo,
    inputs: Vec<InputEntry>,
}

/// Reads the folders of all shards of a sweep.
///
/// # Errors
/// A folder without a whole shard, shards of different sweeps, a shard that is there twice, shards or runs that are
/// missing; all faults of a kind at once.
pub(crate) fn read_shards(folders: &[PathBuf]) -> Result<JoinedShards, Error> {
    let mut wrong = Vec::new();
    let mut read: Vec<(&Path, ShardFile, Vec<usize>)> = Vec::new();
    for folder in folders {
        match read_shard(folder) {
            Ok((shard, runs)) => read.push((folder, shard, runs)),
            Err(diagnostic) => wrong.push(*diagnostic),
        }
    }
    let Some((first, known, _)) = read.first() else {
        return Err(Error::Files(wrong));
    };
    let (of, count) = (known.of, known.info.runs);
    let mut seen: BTreeMap<usize, &Path> = BTreeMap::new();
    for (folder, shard, runs) in &read {
        let fault = |expected: String| Diagnostic::of_file(folder.display().to_string(), expected);
        if shard.sweep != known.sweep || shard.of != of {
            let expected = format!(
                "belongs to a different sweep from {}, or to other files or another version",
                first.display()
            );
            wrong.push(fault(expected).hint("run the shard again"));
        } else if let Some(other) = seen.insert(shard.shard, folder) {
            wrong.push(fault(format!(
                "is shard {} of {of}, as {} is",
                shard.shard,
                other.display()
            )));
        }
        if !runs
            .iter()
            .copied()
            .eq((shard.shard..=count).step_by(of.max(1)))
        {
            wrong.push(fault("does not have all its runs".to_owned()).hint("run the shard again"));
        }
    }
    let missing: Vec<String> = (1..=of)
        .filter(|k| !seen.contains_key(k))
        .map(|k| k.to_string())
        .collect();
    if wrong.is_empty() && !missing.is_empty() {
        let expected = format!(
            "--merge needs all {of} shards, {} missing",
            missing.join(", ")
        );
        wrong.push(
            Diagnostic::of_file("command line", expected).hint("name the folder of each shard"),
        );
    }
    if !wrong.is_empty() {
        return Err(Error::Files(wrong));
    }
    let rows = read.iter().map(|(folder, ..)| folder.join(ROWS)).collect();
    let (_, first, _) = read.swap_remove(0);
    Ok(JoinedShards {
        info: first.info,
        inputs: first.inputs,
        rows,
    })
}

/// Reads one shard, whose files must be as its manifest lists them, and the numbers of its runs.
fn read_shard(folder: &Path) -> Result<(ShardFile, Vec<usize>), Box<Diagnostic>> {
    let fault = |expected: &str, hint: &str| {
        Box::new(Diagnostic::of_file(folder.display().to_string(), expected).hint(hint))
    };
    let none = || {
        fault(
            "is not the folder of a finished shard",
            "create one by girderway sweep SWEEP --shard K/N",
        )
    };
    let manifest = fs::read(folder.join(MANIFEST)).map_err(|_| none())?;
    let listed = listed_files(&manifest).ok_or_else(none)?;
    for name in [SHARD, ROWS] {
        let file = File::open(folder.join(name)).map_err(|_| none())?;
        let found = sha256_of(file).map_err(|_| none())?;
        let entry = listed
            .iter()
            .find(|entry| entry.name == name)
            .ok_or_else(none)?;
        if entry.sha256.as_deref() != Some(&found) {
            return Err(fault(
                &format!("has a modified {name}"),
                "run the shard again",
            ));
        }
    }
    let text = fs::read(folder.join(SHARD)).map_err(|_| none())?;
    let shard: ShardFile = serde_json::from_slice(&text).map_err(|_| none())?;
    if shard.format != FORMAT {
        return Err(none());
    }
    let records = records_of(&folder.join(ROWS)).map_err(|_| none())?;
    let runs = records
        .map(|record| record.map(|record| record.run))
        .collect::<io::Result<_>>();
    Ok((shard, runs.map_err(|_| none())?))
}
