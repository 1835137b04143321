//! Generated parts of the book.

use std::fmt::Display;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::number::{digits, number, percent};
use crate::record::{Record, Verdict};
use crate::{peers, study};

/// Pages with generated parts.
const PAGES: [&str; 4] = ["docs/verification.md", "docs/performance.md", "docs/study.md", "docs/figures.md"];
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

/// Why the book could not be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Error {
    /// A file that cannot be read, or holds something else.
    #[error("{0}: {1}")]
    File(PathBuf, String),
    /// A part that nothing is known of.
    #[error("{0}: no part is called \"{1}\"")]
    Part(PathBuf, String),
    /// A part without an end.
    #[error("{0}: \"{1}\" has no end")]
    Open(PathBuf, String),
    /// Cargo or a test failed.
    #[error("{0}")]
    Run(String),
}

impl Error {
    /// A file with what is wrong with it.
    pub fn file(path: &Path, error: &impl Display) -> Error {
        Error::File(path.to_owned(), error.to_string())
    }
}

/// All pages that have generated parts.
///
/// # Errors
/// Files that cannot be read; parts that nothing is known of.
pub fn pages(root: &Path) -> Result<Vec<Page>, Error> {
    let mut out = Vec::new();
    for path in PAGES.map(Path::new) {
        let full = root.join(path);
        if full.is_file() {
            let text = fs::read_to_string(&full).map_err(|error| Error::file(&full, &error))?;
            out.push(Page { path: path.to_owned(), text: filled(root, path, &text)? });
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
    let (kind, rest) = name.split_once(' ').unwrap_or((name, ""));
    let json = |file: &str| -> Result<Value, Error> {
        let full = root.join(file);
        let text = fs::read_to_string(&full).map_err(|error| Error::file(&full, &error))?;
        serde_json::from_str(&text).map_err(|error| Error::file(&full, &error))
    };
    let studies = || -> Result<Vec<Value>, Error> {
        rest.split_whitespace().map(|name| json(&format!("docs/studies/{name}.json"))).collect()
    };
    match kind {
        "figures" => {
            let full = root.join("docs/claims.json");
            let records: Vec<Record> = serde_json::from_value(json("docs/claims.json")?)
                .map_err(|error| Error::file(&full, &error))?;
            Ok(figures(&records))
        }
        "peers-loads" => Ok(peers::loads(&json("docs/peers.json")?)),
        "peers-crossings" => Ok(peers::crossings(&json("docs/peers.json")?)),
        "studies-dearer" => Ok(study::dearer(&studies()?)),
        "studies-fronts" => Ok(study::fronts(&studies()?)),
        "studies-commands" => Ok(study::commands(&studies()?)),
        "studies-memory" => Ok(study::memory(&studies()?)),
        _ => Err(Error::Part(path.to_owned(), name.to_owned())),
    }
}

/// A table a section, and how many figures there are of each kind.
fn figures(records: &[Record]) -> String {
    let count = |verdict: Verdict| records.iter().filter(|own| own.verdict == verdict).count();
    let (met, below, corrected) = (count(Verdict::Met), count(Verdict::Below), count(Verdict::Corrected));
    let mut out = format!(
        "{} figures: {met} met, {below} not exceeded, {corrected} not met (with why, below the tables).\n",
        records.len()
    );
    let mut sections: Vec<&str> = records.iter().map(|own| own.section.as_str()).collect();
    sections.dedup();
    for section in sections {
        let own: Vec<&Record> = records.iter().filter(|own| own.section == section).collect();
        out += &format!("\n### {section}\n");
        for own in own.chunk_by(|a, b| (&a.file, &a.test) == (&b.file, &b.test)) {
            out += &format!("\n`{}` in `{}`\n\n", own[0].test, own[0].file);
            out += "| figure | source | known | ours | deviation |\n|---|---|---|---|---|\n";
            own.iter().for_each(|record| out += &row(record));
            out += &notes(own);
        }
    }
    out
}

/// Why figures of a test are not met: a line a reason.
fn notes(own: &[&Record]) -> String {
    let mut seen: Vec<&str> = Vec::new();
    for record in own.iter().filter(|own| own.verdict == Verdict::Corrected) {
        if !seen.contains(&record.why.as_str()) {
            seen.push(&record.why);
        }
    }
    seen.iter().map(|why| format!("\nNot met: {why}.\n")).collect()
}

fn row(own: &Record) -> String {
    let known = digits(own.known);
    let value = match own.verdict {
        Verdict::Below => number(own.ours, 2),
        // one digit more than was known, as many as a small difference needs
        _ => number(own.ours, (known + 1).max(3)),
    };
    let deviation = match own.verdict {
        Verdict::Below => "not above".to_owned(),
        Verdict::Met => percent(own.ours / own.known - 1.0),
        Verdict::Corrected if own.known == 0.0 => "**not met**".to_owned(),
        Verdict::Corrected => format!("**{}**", percent(own.ours / own.known - 1.0)),
    };
    let known = if own.verdict == Verdict::Below {
        format!("at most {}", number(own.known, known))
    } else {
        number(own.known, known)
    };
    format!("| {} | {} | {known} | {value} | {deviation} |\n", own.what, own.source)
}
