//! A page whose files and commands are run as they stand on it.
//!
//! A block marked `json FILE` holds members of that file; a block marked `sh` a command; a block marked `text` what the
//! last command says, line by line as far as the page has it. A row of a table whose first cell is nothing but a path of
//! names into the summary has the number that stands there in its second.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::{Map, Value};

/// A fenced block: what it is marked as, and its text.
struct Block<'t> {
    mark: &'t str,
    text: &'t str,
}

fn blocks(page: &str) -> Vec<Block<'_>> {
    let fenced = page.split("```").skip(1).step_by(2);
    fenced.filter_map(|fence| fence.split_once('\n')).map(|(mark, text)| Block { mark, text }).collect()
}

/// Puts the members of all blocks of a file together and writes the files.
fn write(page: &str, folder: &Path) -> usize {
    let mut files: BTreeMap<&str, Map<String, Value>> = BTreeMap::new();
    for block in blocks(page) {
        let Some(name) = block.mark.strip_prefix("json ") else { continue };
        let part: Map<String, Value> = serde_json::from_str(block.text)
            .unwrap_or_else(|error| panic!("a block of {name} is no object: {error}"));
        let file = files.entry(name).or_default();
        for (key, value) in part {
            assert!(file.insert(key.clone(), value).is_none(), "{name} has `{key}` in two blocks");
        }
    }
    for (name, members) in &files {
        let text = serde_json::to_string_pretty(members).expect("JSON");
        fs::write(folder.join(name), text).expect("a file");
    }
    files.len()
}

fn girderway(folder: &Path, arguments: &[&str]) -> String {
    let run = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program starts");
    let said = String::from_utf8(run.stderr).expect("UTF-8");
    assert!(run.status.success(), "{arguments:?}: {said}");
    said
}

/// Runs every command; what it says begins as the page says.
fn run(page: &str, folder: &Path) -> usize {
    let mut said = String::new();
    let mut count = 0;
    for block in blocks(page) {
        match block.mark {
            "sh" => {
                let words: Vec<&str> = block.text.split_whitespace().collect();
                assert_eq!(words.first(), Some(&"girderway"), "{}", block.text);
                said = girderway(folder, &words[1..]);
                assert!(!said.contains("warning"), "{}: {said}", block.text);
                count += 1;
            }
            "text" => {
                for line in block.text.lines() {
                    assert!(
                        said.lines().any(|own| own.starts_with(line)),
                        "the page has {line:?}, got\n{said}"
                    );
                }
            }
            _ => {}
        }
    }
    count
}

/// The code spans of a cell that has nothing else.
fn path(cell: &str) -> Option<Vec<&str>> {
    let parts: Vec<&str> = cell.trim().split('`').collect();
    let plain = parts.iter().step_by(2).all(|between| between.trim().is_empty());
    (parts.len() > 2 && plain).then(|| parts.into_iter().skip(1).step_by(2).collect())
}

/// Share of a number by which the page may differ: flanges that strike leave that much to chance.
const CHANCE: f64 = 0.05;

/// Compares every number that a table of the page takes from the summary.
fn compare(page: &str, summary: &Value) -> usize {
    let mut count = 0;
    for row in page.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = row.split('|').collect();
        let (Some(path), Ok(printed)) = (path(cells[1]), cells[2].trim().parse::<f64>()) else { continue };
        if path.len() < 2 {
            continue;
        }
        let found = path.iter().try_fold(summary, |at, step| match step.parse::<usize>() {
            Ok(index) => at.get(index),
            Err(_) => at.get(step),
        });
        let found = found.and_then(Value::as_f64).unwrap_or_else(|| panic!("the summary has no {path:?}"));
        let near = (found - printed).abs() <= CHANCE * printed.abs();
        assert!(near, "{path:?}: the page has {printed}, got {found}");
        count += 1;
    }
    count
}

#[test]
fn the_ten_steps_run_as_they_stand_on_the_page() {
    let page = fs::read_to_string(super::root().join("docs/crane.md")).expect("the page");
    let folder = tempfile::tempdir().expect("a temporary folder");
    assert_eq!(write(&page, folder.path()), 3);
    assert_eq!(run(&page, folder.path()), 2);
    let picture =
        fs::read_to_string(folder.path().join("crane/plots/reactions-vertical.svg")).expect("a picture");
    assert!(picture.contains("aisle.N2.uy") && !picture.contains("girders."), "girders stand on the bridge");
    let summary = fs::read_to_string(folder.path().join("crane/summary.json")).expect("a summary");
    assert_eq!(compare(&page, &serde_json::from_str(&summary).expect("JSON")), 9);
}

#[test]
fn the_files_of_the_tutorial_run() {
    let page = fs::read_to_string(super::root().join("docs/tutorial.md")).expect("the page");
    let folder = tempfile::tempdir().expect("a temporary folder");
    girderway(folder.path(), &["init", "bogie", "mine"]);
    assert_eq!(write(&page, folder.path()), 4);
    for scene in ["fast", "compared", "carriage"] {
        let output = format!("out/{scene}");
        girderway(folder.path(), &["run", &format!("mine/{scene}.json"), "-o", &output]);
    }
    girderway(folder.path(), &["sim", "mine/compared.json", "-o", "out/compared"]);
    girderway(folder.path(), &["fea", "mine/runway.json", "-o", "mine/grid.json"]);
    girderway(folder.path(), &["splines", "mine/grid.json", "-o", "mine/runway.adm"]);
    assert!(page.contains("girderway splines mine/grid.json -o mine/runway.adm"));
}
