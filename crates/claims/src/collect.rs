//! Figures from what tests left.

use std::collections::BTreeSet;
use std::path::Path;

use crate::error::Error;
use crate::file::{self, folder, name};
use crate::record::Record;

/// Tests that hold figures: package and name of the test program.
///
/// # Errors
/// Folders that cannot be read.
pub fn programs(root: &Path) -> Result<BTreeSet<(String, String)>, Error> {
    let mut out = BTreeSet::new();
    let holds = |path: &Path| -> Result<bool, Error> { Ok(file::text(path)?.contains("claims::figure")) };
    for krate in folder(&root.join("crates"))? {
        if krate.ends_with("claims") {
            continue;
        }
        for path in folder(&krate.join("tests"))? {
            if path.extension().is_some_and(|own| own == "rs") && holds(&path)? {
                out.insert((name(&krate), name(&path.with_extension(""))));
            }
        }
    }
    for group in folder(&root.join("tests"))? {
        if !group.join("main.rs").is_file() {
            continue;
        }
        for path in folder(&group)? {
            if path.extension().is_some_and(|own| own == "rs") && holds(&path)? {
                out.insert(("girderway".to_owned(), name(&group)));
            }
        }
    }
    Ok(out)
}

/// The lines that tests left in `from`, as text of `docs/claims.json`: a record a line, by section, file and test.
///
/// # Errors
/// Files that cannot be read or hold something else.
pub fn collect(from: &Path) -> Result<String, Error> {
    let mut records: Vec<Record> = Vec::new();
    for path in folder(from)? {
        for line in file::text(&path)?.lines() {
            let mut own: Record = serde_json::from_str(line).map_err(|error| Error::file(&path, &error))?;
            // the last digits are of the machine
            own.ours = format!("{:.7e}", own.ours).parse().unwrap_or(own.ours);
            records.push(own);
        }
    }
    // within a test in the order found
    let key = |own: &Record| (own.section.clone(), own.file.clone(), own.test.clone());
    records.sort_by_key(key);
    let lines = records.iter().map(serde_json::to_string).collect::<Result<Vec<String>, _>>();
    let lines = lines.map_err(|error| Error::file(from, &error))?;
    Ok(file::list(&lines))
}
