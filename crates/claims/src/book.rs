//! Generated parts of the book.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::error::Error;
use crate::file::{self, json};
use crate::record::Record;
use crate::{figures, map, maps, origin, peers, roll, sheets, study, times};

/// How a generated part begins and ends.
const BEGIN: &str = "<!-- generated: ";
const END: &str = "<!-- end -->";

/// A page with its generated parts made anew.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Page {
    /// Where it is, from the root of the repository.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
}

/// All pages that have generated parts.
///
/// # Errors
/// Files that cannot be read; parts that nothing is known of.
pub fn pages(root: &Path) -> Result<Vec<Page>, Error> {
    let mut out = Vec::new();
    for full in file::folder(&root.join("docs"))? {
        if full.extension().is_some_and(|own| own == "md") {
            let text = file::text(&full)?;
            if text.contains(BEGIN) {
                let path = PathBuf::from(file::within(root, &full));
                out.push(Page { text: filled(root, &path, &text)?, path });
            }
        }
    }
    Ok(out)
}

/// `text` with its generated parts made anew.
fn filled(root: &Path, path: &Path, text: &str) -> Result<String, Error> {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(BEGIN) {
        let begin = at + BEGIN.len();
        let line = rest[begin..].find("-->").ok_or_else(|| Error::Open(path.to_owned(), BEGIN.to_owned()))?;
        let name = rest[begin..begin + line].trim();
        let body = begin + line + "-->".len();
        let open = || Error::Open(path.to_owned(), name.to_owned());
        let end = rest[body..].find(END).ok_or_else(open)?;
        out += &rest[..body];
        out += "\n\n";
        out += part(root, path, name)?.trim();
        out += "\n\n";
        out += END;
        rest = &rest[body + end + END.len()..];
    }
    Ok(out + rest)
}

/// A part by its name.
fn part(root: &Path, path: &Path, name: &str) -> Result<String, Error> {
    let mut words = name.split_whitespace();
    let kind = words.next().unwrap_or_default();
    let names: Vec<&str> = words.collect();
    let studies = || -> Result<Vec<Value>, Error> {
        names.iter().map(|name| json(&root.join(format!("docs/studies/{name}.json")))).collect()
    };
    let records = || json::<Vec<Record>>(&root.join("docs/claims.json"));
    let others = || json(&root.join("docs/peers.json"));
    let kept = || json(&root.join(map::FILE));
    let sitting = || json(&root.join("docs/benchmarks.json"));
    match kind {
        "commands" => origin::table(root),
        "figures" => Ok(figures::tables(&records()?)),
        "figures-summary" => Ok(figures::summary(&records()?)),
        "tests" => roll::list(root),
        "tests-summary" => roll::summary(root),
        "maps" => Ok(maps::table(&kept()?)),
        "maps-short" => Ok(maps::short(&kept()?)),
        "maps-total" => Ok(maps::total(&kept()?)),
        "maps-refusals" => maps::refusals(&kept()?),
        "maps-numbers" => maps::numbers(&kept()?),
        "peers-loads" => Ok(peers::loads(&others()?)),
        "peers-crossings" => Ok(peers::crossings(&others()?)),
        "studies-charts" => Ok(study::charts(root, &names)),
        "studies-dearer" => Ok(study::dearer(&studies()?)),
        "studies-fronts" => Ok(study::fronts(&studies()?)),
        "studies-commands" => Ok(study::commands(&studies()?)),
        "studies-memory" => Ok(study::memory(&studies()?)),
        "benches" => {
            let sitting = sitting()?;
            Ok(names.iter().map(|name| times::tables(&sitting, name)).collect())
        }
        "benches-sitting" => Ok(times::sitting(&sitting()?)),
        "frames" => Ok(sheets::frames(&file::rows(&root.join("docs/frames.csv"))?)),
        "wheels" => Ok(sheets::wheels(&file::rows(&root.join("docs/wheels.csv"))?)),
        _ => Err(Error::Part(path.to_owned(), name.to_owned())),
    }
}
