//! Files and folders of the repository.

use std::fs;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

use crate::error::Error;

/// Text of a file.
///
/// # Errors
/// What cannot be read.
pub fn text(path: &Path) -> Result<String, Error> {
    fs::read_to_string(path).map_err(|error| Error::file(path, &error))
}

/// What a JSON file holds.
///
/// # Errors
/// What cannot be read or holds something else.
pub fn json<T: DeserializeOwned>(path: &Path) -> Result<T, Error> {
    serde_json::from_str(&text(path)?).map_err(|error| Error::file(path, &error))
}

/// Rows of a CSV file, by its headings.
///
/// # Errors
/// What cannot be read or holds something else.
pub fn rows<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>, Error> {
    let mut reader = csv::Reader::from_path(path).map_err(|error| Error::file(path, &error))?;
    let rows: Result<Vec<T>, csv::Error> = reader.deserialize().collect();
    rows.map_err(|error| Error::file(path, &error))
}

/// What is in a folder, in order; nothing where there is none.
///
/// # Errors
/// What cannot be read.
pub fn folder(path: &Path) -> Result<Vec<PathBuf>, Error> {
    if !path.is_dir() {
        return Ok(Vec::new());
    }
    let entries = fs::read_dir(path).map_err(|error| Error::file(path, &error))?;
    let mut out = Vec::new();
    for entry in entries {
        out.push(entry.map_err(|error| Error::file(path, &error))?.path());
    }
    out.sort();
    Ok(out)
}

/// All Rust files of a folder and its folders, in order.
///
/// # Errors
/// What cannot be read.
pub fn sources(path: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut out = Vec::new();
    for own in folder(path)? {
        if own.is_dir() {
            if !own.ends_with("target") {
                out.extend(sources(&own)?);
            }
        } else if own.extension().is_some_and(|ending| ending == "rs") {
            out.push(own);
        }
    }
    Ok(out)
}

/// Last part of a path.
#[must_use]
pub fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// A path from the root of the repository, with slashes.
#[must_use]
pub fn within(root: &Path, path: &Path) -> String {
    let own = path.strip_prefix(root).unwrap_or(path);
    own.components().map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/")
}

/// A JSON list with one entry a line.
#[must_use]
pub fn list(lines: &[String]) -> String {
    format!("[\n{}\n]\n", lines.join(",\n"))
}
