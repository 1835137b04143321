//! Malformed inputs: every one is refused with located errors, and nothing is written.
//!
//! `cases/*.txt` hold blocks of lines, separated by blank lines:
//!
//! ```text
//! # what is wrong
//! command and arguments
//! file: old text => new text      an edit of a file of `base/`; the old text stands there once
//! file := text                    the whole file
//! = 3                             the exit status, where it is not 2
//! > line of standard error        exactly these, in this order
//! ```
//! In texts `\x0a` stands for the byte 0x0a, and `\3(a#)` for `a1a2a3`, where the part in parentheses has no other
//! parenthesis.

mod mutate;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

struct Case {
    claim: String,
    arguments: Vec<String>,
    files: BTreeMap<String, Vec<u8>>,
    status: i32,
    expected: String,
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/malformed")
}

fn base() -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder().join("base")).expect("the folder of base files");
    entries
        .map(|entry| {
            let entry = entry.expect("a readable folder");
            let name = entry.file_name().into_string().expect("plain names");
            (name, fs::read(entry.path()).expect("a readable file"))
        })
        .collect()
}

/// Text with `\xNN` for bytes and `\N(part)` for N copies of a part, in which # is the number of the copy from 1 on.
fn bytes(text: &str) -> Vec<u8> {
    let mut out = Vec::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('\\') {
        out.extend(before.as_bytes());
        rest = match after.strip_prefix('x') {
            Some(after) => {
                let (digits, after) = after.split_at(2);
                out.push(u8::from_str_radix(digits, 16).expect("two hexadecimal digits"));
                after
            }
            None => {
                let (count, after) = after
                    .split_once('(')
                    .expect("a count and a part in parentheses");
                let (part, after) = after.split_once(')').expect("the end of the part");
                let count: usize = count.parse().expect("a count");
                (1..=count).for_each(|k| out.extend(part.replace('#', &k.to_string()).as_bytes()));
                after
            }
        };
    }
    out.extend(rest.as_bytes());
    out
}

fn edit(file: &[u8], old: &[u8], new: &[u8], case: &str) -> Vec<u8> {
    let mut places = file
        .windows(old.len())
        .enumerate()
        .filter(|(_, window)| *window == old);
    let (place, _) = places
        .next()
        .unwrap_or_else(|| panic!("{case}: the old text is not in the file"));
    assert!(
        places.next().is_none(),
        "{case}: the old text stands there twice"
    );
    [&file[..place], new, &file[place + old.len()..]].concat()
}

fn parse(block: &str) -> Case {
    let mut case = Case {
        claim: String::new(),
        arguments: Vec::new(),
        files: base(),
        status: 2,
        expected: String::new(),
    };
    for line in block.lines() {
        if let Some(claim) = line.strip_prefix("# ") {
            case.claim = claim.to_owned();
        } else if let Some(expected) = line.strip_prefix("> ") {
            case.expected.push_str(expected);
            case.expected.push('\n');
        } else if let Some(status) = line.strip_prefix("= ") {
            case.status = status.parse().expect("a number");
        } else if let Some((file, text)) = line.split_once(" :=") {
            case.files.insert(file.to_owned(), bytes(text.trim_start()));
        } else if let Some((edited, new)) = line.split_once(" =>") {
            let (file, old) = edited.split_once(": ").expect("file: old text => new text");
            let text = edit(
                &case.files[file],
                &bytes(old),
                &bytes(new.trim_start()),
                &case.claim,
            );
            case.files.insert(file.to_owned(), text);
        } else {
            assert!(case.arguments.is_empty(), "{}: two commands", case.claim);
            case.arguments = line.split(' ').map(str::to_owned).collect();
        }
    }
    case
}

fn files_in(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).expect("the test's own folder");
    entries
        .map(|entry| {
            let entry = entry.expect("a readable folder");
            let name = entry.file_name().to_string_lossy().into_owned();
            (name, fs::read(entry.path()).unwrap_or_default())
        })
        .collect()
}

fn refused(case: &Case) -> Result<(), String> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, text) in &case.files {
        fs::write(folder.path().join(name), text).expect("a writable folder");
    }
    let run = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(&case.arguments)
        .current_dir(folder.path())
        .output()
        .expect("the program starts");
    let told = String::from_utf8_lossy(&run.stderr);
    if told != case.expected {
        return Err(format!("told\n{told}instead of\n{}", case.expected));
    }
    if run.status.code() != Some(case.status) {
        return Err(format!(
            "status {:?} instead of {}",
            run.status.code(),
            case.status
        ));
    }
    if !run.stdout.is_empty() {
        return Err(format!("standard output has {} bytes", run.stdout.len()));
    }
    if files_in(folder.path()) != case.files {
        return Err("files were written or changed".to_owned());
    }
    Ok(())
}

/// Every case of a file is refused as it says.
fn all_refused(topic: &str) {
    let text = fs::read_to_string(folder().join("cases").join(topic)).expect("the file of cases");
    let mut wrong = Vec::new();
    let mut count = 0;
    for block in text.split("\n\n").filter(|block| !block.trim().is_empty()) {
        let case = parse(block);
        assert!(!case.expected.is_empty(), "{}: expects nothing", case.claim);
        count += 1;
        if let Err(why) = refused(&case) {
            wrong.push(format!("{topic}: {}: {why}", case.claim));
        }
    }
    assert!(
        count > 0 && wrong.is_empty(),
        "{} of {count} cases\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

#[test]
fn unreadable_files_are_refused_at_line_and_column() {
    all_refused("file.txt");
}

#[test]
fn short_specs_are_refused_with_all_their_errors() {
    all_refused("spec.txt");
}

#[test]
fn general_specs_are_refused_with_all_their_errors() {
    all_refused("frame.txt");
}

#[test]
fn scenes_are_refused_with_all_their_errors() {
    all_refused("scene.txt");
}

#[test]
fn designs_are_refused_with_all_their_errors() {
    all_refused("design.txt");
}

#[test]
fn grids_and_tables_are_refused_with_all_their_errors() {
    all_refused("table.txt");
}

#[test]
fn decks_and_meshes_are_refused_with_all_their_errors() {
    all_refused("import.txt");
}

#[test]
fn the_base_files_themselves_are_taken() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, text) in base() {
        fs::write(folder.path().join(name), text).expect("a writable folder");
    }
    for arguments in [
        ["fea", "spec.json"],
        ["fea", "frame.json"],
        ["splines", "grid.json"],
    ] {
        let run = Command::new(env!("CARGO_BIN_EXE_girderway"))
            .args(arguments)
            .current_dir(folder.path())
            .output()
            .expect("the program starts");
        assert_eq!(
            (run.status.code(), run.stderr),
            (Some(0), Vec::new()),
            "{arguments:?}"
        );
    }
}
