//! Pages whose files and commands are run as they stand on them.
//!
//! A block marked `json FILE` holds members of that file; a block marked `sh` commands, one a line; a block marked `text`
//! what the last command prints, line by line as far as the page has it. A row of a table whose first cell is nothing but a
//! path of names into the summary has the number that stands there in its second.
//!
//! README and CONTRIBUTING also have commands of cargo. They are not run: they must be commands of `.ci/run` or
//! `.ci/nightly`.

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
    fenced
        .filter_map(|fence| fence.split_once('\n'))
        .map(|(mark, text)| Block { mark, text })
        .collect()
}

/// Puts the members of all blocks of a file together and writes the files.
fn write(page: &str, folder: &Path) -> usize {
    let mut files: BTreeMap<&str, Map<String, Value>> = BTreeMap::new();
    for block in blocks(page) {
        let Some(name) = block.mark.strip_prefix("json ") else {
            continue;
        };
        let part: Map<String, Value> = serde_json::from_str(block.text)
            .unwrap_or_else(|error| panic!("a block of {name} is no object: {error}"));
        let file = files.entry(name).or_default();
        for (key, value) in part {
            assert!(
                file.insert(key.clone(), value).is_none(),
                "{name} has `{key}` in two blocks"
            );
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

/// Words of each command of a block, without comments.
fn commands<'t>(block: &Block<'t>) -> Vec<Vec<&'t str>> {
    let lines = block
        .text
        .lines()
        .map(|line| line.split('#').next().unwrap_or_default());
    let commands = lines.map(|line| line.split_whitespace().collect::<Vec<_>>());
    commands.filter(|words| !words.is_empty()).collect()
}

/// Whether a line of the page is the whole printed line, or the printed line up to a comma or semicolon.
fn is_printed(line: &str, own: &str) -> bool {
    own.strip_prefix(line)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with([',', ';']))
}

/// Runs every command; it prints the lines that the page has.
fn run(page: &str, folder: &Path) -> usize {
    let mut said = String::new();
    let mut count = 0;
    for block in blocks(page) {
        match block.mark {
            "sh" => {
                for words in commands(&block) {
                    assert_eq!(words.first(), Some(&"girderway"), "{}", block.text);
                    said = girderway(folder, &words[1..]);
                    // a crane between its flanges does not determine all its largest values, and its girders twist
                    let told = [
                        "largest values are not determined: flanges strike",
                        "second-order effects and large rotations would change",
                    ];
                    let is_wrong = |line: &str| {
                        line.contains("warning") && !told.iter().any(|told| line.contains(told))
                    };
                    assert!(!said.lines().any(is_wrong), "{}: {said}", block.text);
                    count += 1;
                }
            }
            "text" => {
                for line in block.text.lines() {
                    assert!(
                        said.lines().any(|own| is_printed(line, own)),
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
    let plain = parts
        .iter()
        .step_by(2)
        .all(|between| between.trim().is_empty());
    (parts.len() > 2 && plain).then(|| parts.into_iter().skip(1).step_by(2).collect())
}

/// Relative difference permitted after flange impacts, which are sensitive to rounding.
const CHANCE: f64 = 0.05;

/// Relative difference permitted for a number that is rounded to four digits.
const FOUR_DIGITS: f64 = 5.1e-4;

/// Compares every number that a table of the page takes from the summary, within a relative difference.
fn compare(page: &str, summary: &Value, tolerance: f64) -> usize {
    let mut count = 0;
    for row in page.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = row.split('|').collect();
        let (Some(path), Ok(printed)) = (path(cells[1]), cells[2].trim().parse::<f64>()) else {
            continue;
        };
        if path.len() < 2 {
            continue;
        }
        let found = path
            .iter()
            .try_fold(summary, |at, step| match step.parse::<usize>() {
                Ok(index) => at.get(index),
                Err(_) => at.get(step),
            });
        let found = found
            .and_then(Value::as_f64)
            .unwrap_or_else(|| panic!("the summary has no {path:?}"));
        let near = (found - printed).abs() <= tolerance * printed.abs();
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
    let picture = fs::read_to_string(folder.path().join("crane/plots/reactions-vertical.svg"))
        .expect("a picture");
    assert!(
        picture.contains("aisle.N2.uy") && !picture.contains("girders."),
        "girders stand on the bridge"
    );
    let summary = summary_in(&folder.path().join("crane"));
    assert_eq!(compare(&page, &summary, CHANCE), 9);
}

fn summary_in(folder: &Path) -> Value {
    let text = fs::read_to_string(folder.join("summary.json")).expect("a summary");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn the_files_of_the_tutorial_run() {
    let page = fs::read_to_string(super::root().join("docs/tutorial.md")).expect("the page");
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::create_dir(folder.path().join("mine")).expect("a folder");
    assert_eq!(write(&page, folder.path()), 4);
    assert_eq!(run(&page, folder.path()), 8);
    let printed = blocks(&page)
        .into_iter()
        .filter(|block| block.mark == "text")
        .flat_map(|block| block.text.lines());
    assert_eq!(printed.count(), 6);

    let design = summary_in(&folder.path().join("out/design"));
    for (name, quantity, kind, factor) in GOVERNING {
        let single = governing(&design, 1, quantity, kind);
        let double = governing(&design, 2, quantity, kind);
        let exact = [
            factor * number(&single["value"]),
            number(&single["x"]),
            number(&single["position"]),
            factor * number(&double["value"]),
        ];
        assert_row(&page, name, 2, &exact);
    }
    assert_eq!(compare(&page, &design, FOUR_DIGITS), 5);

    let travel = summary_in(&folder.path().join("out/travel"));
    assert_eq!(travel["compare"].as_object().map(Map::len), Some(5));
    let largest = |run: &Value, column: &str| number(&run["peaks"][column]["max"]["value"]);
    for (name, run) in runs(&travel, "travel") {
        let exact = [
            1e3 * largest(run, "runway.midspan"),
            largest(run, "end.wheel1.vertical"),
            largest(run, "runway.rail.reaction"),
        ];
        assert_row(&page, name, 3, &exact);
    }

    let tables = summary_in(&folder.path().join("out/tables"));
    assert_eq!(tables["compare"].as_object().map(Map::len), Some(2));
    for (name, run) in runs(&tables, "tables") {
        assert_row(&page, name, 2, &[1e3 * largest(run, "crane.deflection")]);
    }

    // the command that the page names in a sentence
    assert!(page.contains("`girderway sim mine/travel.json -o out/travel`"));
    girderway(
        folder.path(),
        &["sim", "mine/travel.json", "-o", "out/travel"],
    );
    let repeated = summary_in(&folder.path().join("out/travel"));
    assert_eq!(repeated["peaks"], travel["peaks"]);
}

/// A scene by its name, and its comparisons by their labels.
fn runs<'s>(summary: &'s Value, name: &'s str) -> Vec<(&'s str, &'s Value)> {
    let compared = summary["compare"].as_object().expect("comparisons");
    std::iter::once((name, summary))
        .chain(compared.iter().map(|(label, run)| (label.as_str(), run)))
        .collect()
}

/// Rows of the tables of governing values: name, quantity and kind of the extreme, factor to the unit of the page.
const GOVERNING: [(&str, &str, &str, f64); 4] = [
    ("largest sagging moment", "moment", "max", 1.0),
    ("largest hogging moment", "moment", "min", 1.0),
    ("largest shear force", "shear", "max", 1.0),
    ("largest deflection", "deflection", "max", 1e3),
];

/// The vertical extreme of largest size over all spans, of one case of a design.
fn governing<'s>(summary: &'s Value, case: u64, quantity: &str, kind: &str) -> &'s Value {
    summary["extremes"]
        .as_array()
        .expect("a list")
        .iter()
        .filter(|one| {
            one["case"] == case
                && [&one["quantity"], &one["kind"], &one["plane"]] == [quantity, kind, "vertical"]
        })
        .max_by(|a, b| {
            number(&a["value"])
                .abs()
                .total_cmp(&number(&b["value"]).abs())
        })
        .expect("an extreme")
}

/// Compares the numbers of a row, from a column of the table on, with exact ones.
fn assert_row(page: &str, name: &str, column: usize, exact: &[f64]) {
    let line = page
        .lines()
        .find(|line| line.starts_with(&format!("| {name} |")))
        .unwrap_or_else(|| panic!("the page has no row {name:?}"));
    let cells: Vec<f64> = line
        .split('|')
        .skip(column)
        .take(exact.len())
        .map(|cell| number_of(cell.trim()))
        .collect();
    assert_eq!(cells.len(), exact.len(), "{line}");
    for (cell, exact) in cells.iter().zip(exact) {
        assert!(
            (cell - exact).abs() <= FOUR_DIGITS * exact.abs(),
            "{line}: {exact}"
        );
    }
}

/// A command of cargo without what does not change its meaning to a reader, up to the first variable of the shell.
fn plain(words: &[&str]) -> String {
    let words = words
        .iter()
        .take_while(|word| !word.starts_with(['"', '|', '>', ')']));
    let kept: Vec<&str> = words
        .copied()
        .filter(|word| !["--quiet", "--locked", "--root"].contains(word))
        .collect();
    kept.join(" ")
}

/// Commands of cargo in `.ci/run` and `.ci/nightly`, and whether an argument of the shell follows.
fn checked() -> Vec<(String, bool)> {
    let scripts = [".ci/run", ".ci/nightly"]
        .map(|name| fs::read_to_string(super::root().join(name)).expect("the script"));
    let script = scripts.join("\n");
    let lines = script
        .lines()
        .map(str::trim)
        .filter(|line| !line.starts_with('#'));
    let commands = lines.filter_map(|line| line.find("cargo ").map(|at| &line[at..]));
    commands
        .map(|line| {
            let words: Vec<&str> = line.split_whitespace().collect();
            (plain(&words), line.contains("\"$"))
        })
        .collect()
}

/// Whether a command of cargo is one that a script runs, its last arguments aside where the script has a variable.
fn is_checked(words: &[&str]) -> bool {
    let own = plain(words);
    let same = |(known, is_open): &(String, bool)| {
        own == *known || (*is_open && own.starts_with(known.as_str()))
    };
    checked().iter().any(same)
}

#[test]
fn commands_of_readme_and_contributing_are_those_that_are_checked() {
    let known = checked();
    assert!(
        known.iter().any(|(own, _)| own == "cargo test"),
        "{known:?}"
    );
    for name in ["README.md", "CONTRIBUTING.md"] {
        let page = fs::read_to_string(super::root().join(name)).expect("the page");
        let folder = tempfile::tempdir().expect("a temporary folder");
        write(&page, folder.path());
        let mut count = 0;
        for words in blocks(&page)
            .iter()
            .filter(|block| block.mark == "sh")
            .flat_map(commands)
        {
            match words[0] {
                "cargo" => assert!(is_checked(&words), "{name}: no script runs {words:?}"),
                "girderway" => {
                    girderway(folder.path(), &words[1..]);
                }
                "pip" => assert!(
                    super::root().join(words[words.len() - 1]).exists(),
                    "{name}: {words:?}"
                ),
                script => assert!(
                    super::root().join(script).exists(),
                    "{name}: {script} does not exist"
                ),
            }
            count += 1;
        }
        assert!(count > 2, "{name} has commands");
        // commands within sentences and tables
        let prose = page
            .split("```")
            .step_by(2)
            .flat_map(|text| text.split('`').skip(1).step_by(2));
        for span in prose {
            let words: Vec<&str> = span.split_whitespace().collect();
            match words[..] {
                ["cargo", _, ..] => {
                    assert!(is_checked(&words), "{name}: no script runs {span}")
                }
                ["girderway", command, ..] if command.chars().all(|c| c.is_ascii_lowercase()) => {
                    girderway(folder.path(), &[command, "--help"]);
                }
                _ => {}
            }
        }
    }
}

/// The table of the README has the numbers of the summary of the design that stands above it.
#[test]
fn numbers_of_the_readme_are_those_of_its_design() {
    let page = fs::read_to_string(super::root().join("README.md")).expect("the page");
    let folder = tempfile::tempdir().expect("a temporary folder");
    assert_eq!(write(&page, folder.path()), 2);
    girderway(folder.path(), &["design", "design.json", "-o", "out"]);
    let summary = summary_in(&folder.path().join("out"));
    for (name, quantity, kind, factor) in GOVERNING {
        let found = governing(&summary, 1, quantity, kind);
        let exact = [
            factor * number(&found["value"]),
            number(&found["x"]),
            number(&found["position"]),
        ];
        assert_row(&page, name, 2, &exact);
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// The number with which a cell begins.
fn number_of(cell: &str) -> f64 {
    cell.split(' ')
        .next()
        .unwrap_or_default()
        .parse()
        .unwrap_or_else(|_| panic!("no number: {cell}"))
}
