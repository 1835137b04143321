//! All tests, from their source.

use std::path::Path;

use crate::error::Error;
use crate::file;

/// Folders with tests, and what they test.
const GROUPS: [(&str, &str); 8] = [
    ("crates/splines", "Functions along a rail: crate `splines`"),
    ("crates/fea", "Frames: crate `fea`"),
    ("crates/sim", "Motion: crate `sim`"),
    ("crates/adams", "ADAMS data sets: crate `adams`"),
    ("crates/practice", "What engineers set beside a simulation: crate `practice`"),
    ("pipeline", "The program, part by part: crate `girderway`"),
    ("tests", "The program as a whole"),
    ("crates/claims", "This book: crate `claims`"),
];

/// A file with tests.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    /// Path from the root of the repository.
    pub path: String,
    /// First paragraph of its documentation.
    pub about: String,
    /// Its tests, in order.
    pub tests: Vec<Test>,
}

/// A test.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Test {
    /// Its name, a claim.
    pub name: String,
    /// First sentence of its documentation.
    pub about: String,
    /// Whether only a slow run has it.
    pub is_slow: bool,
}

/// First paragraph of lines of documentation, `mark` taken off.
fn paragraph<'a>(lines: impl Iterator<Item = &'a str>, mark: &str) -> String {
    let own = lines.map_while(|line| line.strip_prefix(mark)).map(str::trim);
    own.take_while(|line| !line.is_empty()).collect::<Vec<_>>().join(" ")
}

fn sentence(text: &str) -> &str {
    text.split_once(". ").map_or_else(|| text.trim_end_matches('.'), |(first, _)| first)
}

/// Tests of a source file.
#[must_use]
pub fn tests(source: &str) -> Vec<Test> {
    let lines: Vec<&str> = source.lines().map(str::trim).collect();
    let mut out = Vec::new();
    for (at, _) in lines.iter().enumerate().filter(|(_, line)| **line == "#[test]") {
        let belongs = |line: &&&str| line.starts_with("#[") || line.starts_with("///");
        let above = lines[..at].iter().rev().take_while(belongs).count();
        let below = lines[at..].iter().take_while(belongs).count();
        let head = &lines[at - above..at + below];
        let name = lines.get(at + below).and_then(|line| line.split_once("fn ")?.1.split('(').next());
        let Some(name) = name else { continue };
        let doc = head.iter().filter(|line| line.starts_with("///"));
        out.push(Test {
            name: name.to_owned(),
            about: sentence(&paragraph(doc.copied(), "///")).to_owned(),
            is_slow: head.iter().any(|line| line.starts_with("#[ignore")),
        });
    }
    out
}

/// Files with tests below a folder.
fn programs(root: &Path, folder: &str) -> Result<Vec<Program>, Error> {
    let mut out = Vec::new();
    for path in file::sources(&root.join(folder))? {
        let source = file::text(&path)?;
        let tests = tests(&source);
        if !tests.is_empty() {
            let about = paragraph(source.lines(), "//!");
            out.push(Program { path: file::within(root, &path), about, tests });
        }
    }
    Ok(out)
}

/// A list of all tests, by what they test.
///
/// # Errors
/// Files that cannot be read.
pub fn list(root: &Path) -> Result<String, Error> {
    let mut out = String::new();
    for (folder, title) in GROUPS {
        out += &format!("\n## {title}\n");
        for own in programs(root, folder)? {
            out += &format!("\n`{}`: {}\n\n", own.path, own.about);
            for test in own.tests {
                let about = if test.about.is_empty() { String::new() } else { format!(": {}", test.about) };
                let slow = if test.is_slow { " (slow)" } else { "" };
                out += &format!("- `{}`{slow}{about}\n", test.name);
            }
        }
    }
    Ok(out)
}

/// How many there are of what.
///
/// # Errors
/// Files that cannot be read.
pub fn summary(root: &Path) -> Result<String, Error> {
    let mut out = "| of | files | tests | of them slow |\n|---|---|---|---|\n".to_owned();
    for (folder, title) in GROUPS {
        let programs = programs(root, folder)?;
        let tests = || programs.iter().flat_map(|own| &own.tests);
        let slow = tests().filter(|own| own.is_slow).count();
        out += &format!("| {title} | {} | {} | {slow} |\n", programs.len(), tests().count());
    }
    Ok(out)
}

#[cfg(test)]
mod own {
    use super::tests;

    #[test]
    fn a_test_has_its_name_its_first_sentence_and_its_tier() {
        let source = "//! About.\n\n/// It holds. Always.\n#[test]\nfn it_holds() {}\n\n#[test]\n#[ignore = \"slow: long\"]\n/// So\n/// it does.\nfn so(\n) {}\n\nfn helper() {}\n";
        let found = tests(source);
        let told: Vec<(&str, &str, bool)> =
            found.iter().map(|own| (own.name.as_str(), own.about.as_str(), own.is_slow)).collect();
        assert_eq!(told, [("it_holds", "It holds", false), ("so", "So it does", true)]);
    }
}
