//! Names on pages: tests of the page on verification, code names of the page on notation.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use super::root;

/// Cells of a row of a table, without those before the first and after the last bar.
fn cells(line: &str) -> Vec<&str> {
    let row = line.trim();
    let inner = row
        .strip_prefix('|')
        .and_then(|row| row.strip_suffix('|'))
        .unwrap_or_default();
    inner.split('|').map(str::trim).collect()
}

/// Code spans of a text.
fn spans(text: &str) -> Vec<&str> {
    text.split('`').skip(1).step_by(2).collect()
}

/// Whether `text` has `word` with no letter, digit or underscore beside it.
fn has_word(text: &str, word: &str) -> bool {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(word).any(|(at, _)| {
        !text[..at].ends_with(is_part) && !text[at + word.len()..].starts_with(is_part)
    })
}

#[test]
fn every_test_that_verification_names_exists() {
    let page = fs::read_to_string(root().join("docs/verification.md")).expect("the page");
    let mut checked = 0;
    for line in page
        .lines()
        .filter(|line| line.starts_with('|') && line.contains(".rs`"))
    {
        let last = *cells(line).last().expect("a row has cells");
        let mut file: Option<(&str, String)> = None;
        let mut functions = 0;
        for span in spans(last) {
            if span.ends_with(".rs") {
                let text = fs::read_to_string(root().join(span));
                file = Some((
                    span,
                    text.unwrap_or_else(|_| panic!("the page names {span}, which does not exist")),
                ));
            } else {
                let (path, text) = file
                    .as_ref()
                    .unwrap_or_else(|| panic!("a file stands before {span}"));
                assert!(
                    text.contains(&format!("fn {span}()")),
                    "{path} has no test {span}"
                );
                functions += 1;
            }
        }
        assert!(functions > 0, "a row names its test: {line}");
        checked += functions;
    }
    assert!(checked > 80, "{checked} tests");
}

/// Source files of the program and its libraries, by crate.
fn sources() -> BTreeMap<String, Vec<(PathBuf, String)>> {
    let mut crates = vec![("girderway".to_owned(), root().join("pipeline/src"))];
    for entry in fs::read_dir(root().join("crates")).expect("the folder of crates") {
        let path = entry.expect("an entry").path();
        let name = path
            .file_name()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        crates.push((name, path.join("src")));
    }
    let mut out = BTreeMap::new();
    for (name, folder) in crates {
        let mut files = Vec::new();
        read(&folder, &mut files);
        out.insert(name, files);
    }
    out
}

fn read(folder: &Path, out: &mut Vec<(PathBuf, String)>) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            read(&path, out);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let text = fs::read_to_string(&path).expect("text");
            let code: Vec<&str> = text
                .lines()
                .map(|line| line.split("//").next().unwrap_or_default())
                .collect();
            out.push((path, code.join("\n")));
        }
    }
}

/// The identifier at the end of `text`.
fn last_word(text: &str) -> &str {
    let text = text.trim_end();
    let start = text
        .rfind(|c: char| !c.is_alphanumeric() && c != '_')
        .map_or(0, |at| at + 1);
    &text[start..]
}

/// The identifier at the beginning of `text`.
fn first_word(text: &str) -> &str {
    let text = text.trim_start();
    &text[..text
        .find(|c: char| !c.is_alphanumeric() && c != '_')
        .unwrap_or(text.len())]
}

/// Length of the block that begins with the brace at the start of `text`.
fn block(text: &str) -> usize {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return at + 1;
        }
    }
    text.len()
}

/// Fields, variants, methods and constants of every struct, enum, union of `impl` blocks and trait, by its name.
fn members(
    sources: &BTreeMap<String, Vec<(PathBuf, String)>>,
) -> BTreeMap<String, BTreeSet<String>> {
    let mut out: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (_, text) in sources.values().flatten() {
        for keyword in ["struct ", "enum ", "trait ", "impl"] {
            for (at, _) in text.match_indices(keyword) {
                // a keyword begins its line, but for what says who may use it
                let before = text[..at].lines().last().unwrap_or_default();
                let is_item = text[..at].ends_with('\n')
                    || before.trim_start().starts_with("pub")
                    || before.trim().is_empty();
                let rest = &text[at + keyword.len()..];
                let Some(head) = rest.find(['{', ';']).filter(|_| is_item) else {
                    continue;
                };
                let name = if keyword == "impl" {
                    let head = rest[..head].split(" where").next().unwrap_or_default();
                    let of = head.rsplit(" for ").next().unwrap_or(head);
                    // what stands in angle brackets after the name is no part of it
                    let of = of.trim();
                    let of = if of.starts_with('<') {
                        of.split_once('>').map_or(of, |(_, own)| own)
                    } else {
                        of
                    };
                    last_word(of.trim().split('<').next().unwrap_or_default()).to_owned()
                } else {
                    first_word(rest).to_owned()
                };
                let known = out.entry(name).or_default();
                if rest[head..].starts_with(';') {
                    continue;
                }
                let body = &rest[head..head + block(&rest[head..])];
                for item in ["fn ", "const ", "type "] {
                    known.extend(
                        body.match_indices(item)
                            .map(|(at, _)| first_word(&body[at + item.len()..]).to_owned()),
                    );
                }
                if keyword != "impl" {
                    known.extend(
                        body.match_indices(':')
                            .map(|(at, _)| last_word(&body[..at]).to_owned()),
                    );
                    known.extend(body.lines().map(|line| first_word(line).to_owned()));
                }
            }
        }
    }
    out
}

#[test]
fn every_name_in_the_notation_exists() {
    let page = fs::read_to_string(root().join("docs/notation.md")).expect("the page");
    let sources = sources();
    let members = members(&sources);
    let mut missing = Vec::new();
    let mut checked = 0;
    for line in page.lines().filter(|line| line.starts_with('|')) {
        let cells = cells(line);
        let [_, code, _] = cells[..] else { continue };
        let parts: Vec<&str> = code.split('`').collect();
        let mut owner = "";
        for k in (1..parts.len()).step_by(2) {
            let (before, span) = (parts[k - 1], parts[k]);
            // `value[(i, j)]`, `1/Strength::damage`
            let name = span
                .split('[')
                .next()
                .unwrap_or_default()
                .rsplit('/')
                .next()
                .unwrap_or_default();
            let path: Vec<&str> = name.split("::").collect();
            let is_type = path[0].starts_with(|c: char| c.is_ascii_uppercase());
            let files = || sources.values().flatten();
            let in_file = parts
                .get(k + 1)
                .is_some_and(|after| after.trim() == "in")
                .then(|| parts[k + 2]);
            let exists = if let Some(file) = in_file {
                files().any(|(path, text)| path.ends_with(file) && has_word(text, name))
            } else if name.ends_with(".rs") {
                files().any(|(path, _)| path.ends_with(name))
            } else if before.contains("argument") || (before.trim() == "," && owner == "argument") {
                owner = "argument";
                files().any(|(_, text)| text.contains(&format!("{name}: ")))
            } else if is_type {
                owner = path[0];
                let known = members.get(path[0]);
                known.is_some_and(|known| path[1..].iter().all(|own| known.contains(*own)))
            } else if let [krate, .., item] = path[..] {
                let own = sources.get(krate).map(Vec::as_slice).unwrap_or_default();
                let kinds = ["fn", "struct", "enum", "trait", "const", "type", "mod"];
                let modules = &path[1..path.len() - 1];
                modules.iter().all(|module| {
                    own.iter()
                        .any(|(_, text)| has_word(text, &format!("mod {module}")))
                }) && own.iter().any(|(_, text)| {
                    kinds
                        .iter()
                        .any(|kind| has_word(text, &format!("{kind} {item}")))
                })
            } else {
                members.get(owner).is_some_and(|known| known.contains(name))
            };
            checked += 1;
            if !exists {
                missing.push(format!("{span} in: {line}"));
            }
        }
    }
    assert!(
        missing.is_empty(),
        "{} names do not exist:\n{}",
        missing.len(),
        missing.join("\n")
    );
    assert!(checked > 120, "{checked} names");
}
