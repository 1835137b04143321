//! Files with random damage: refused or taken, never a panic, never a number that is none.

use std::fs;

use fea::FactoredFrame;
use formats::grid::StationGrid;
use formats::grid::file as grid_file;
use formats::scene::Document;
use formats::spec::Spec;
use formats::text::source::Source;

use super::base;

const PIECES: [&str; 20] = [
    "0", "-1", "1e308", "1e-308", "1e999", "7", "null", "true", "\"x\"", "[]", "{}", "[[]]",
    "\"\"", ",", "}", "]", "1.5", "1000000", "\"uy\"", "-0.0",
];

/// One to three edits: a token replaced, a stretch cut out or doubled.
fn damaged(text: &str, dice: &mut fastrand::Rng) -> String {
    let mut text = text.to_owned();
    for _ in 0..=dice.usize(..3) {
        let tokens: Vec<(usize, usize)> = tokens(&text);
        if tokens.is_empty() {
            return text;
        }
        let (from, to) = tokens[dice.usize(..tokens.len())];
        let (_, end) = tokens[dice.usize(..tokens.len())];
        let piece = PIECES[dice.usize(..PIECES.len())];
        text = match dice.usize(..8) {
            0 if end > from => format!("{}{}", &text[..from], &text[end..]),
            1 if end > from && end - from < 200 => format!("{}{}", &text[..end], &text[from..]),
            _ => format!("{}{piece}{}", &text[..from], &text[to..]),
        };
    }
    text
}

/// Numbers, words and marks of a text, by byte range; all base files are ASCII.
fn tokens(text: &str) -> Vec<(usize, usize)> {
    let kind = |c: u8| match c {
        b'0'..=b'9' | b'a'..=b'z' | b'A'..=b'Z' | b'.' | b'-' | b'+' | b'"' | b'_' => 1,
        b' ' | b'\n' => 0,
        _ => 2,
    };
    let bytes = text.as_bytes();
    let mut tokens = Vec::new();
    let mut start = 0;
    while start < bytes.len() {
        let mut end = start + 1;
        while kind(bytes[start]) == 1 && end < bytes.len() && kind(bytes[end]) == 1 {
            end += 1;
        }
        if kind(bytes[start]) != 0 {
            tokens.push((start, end));
        }
        start = end;
    }
    tokens
}

fn source(name: &str, text: String) -> Source {
    Source {
        name: name.to_owned(),
        text,
    }
}

fn text_of(name: &str) -> String {
    String::from_utf8(base()[name].clone()).expect("base files are text")
}

#[test]
fn damaged_specs_are_refused_or_give_finite_grids() {
    let mut dice = fastrand::Rng::with_seed(1);
    let mut solved = 0;
    for name in ["spec.json", "frame.json"] {
        let text = text_of(name);
        for _ in 0..5000 {
            let damaged = source(name, damaged(&text, &mut dice));
            let Ok(spec) = Spec::read(&damaged, None) else {
                continue;
            };
            let grid = spec
                .model()
                .and_then(|(model, rails)| FactoredFrame::new(&model, &rails))
                .and_then(|frame| StationGrid::of(&spec, &frame));
            match grid {
                Ok(grid) => {
                    let finite = grid
                        .blocks
                        .iter()
                        .all(|(_, block)| block.iter().all(|value| value.is_finite()));
                    assert!(finite, "{}", damaged.text);
                    solved += 1;
                }
                Err(error) => {
                    let told = girderway::exit::Failure::from(spec.locate_error(&damaged, &error))
                        .report(false);
                    assert!(told.contains(name), "{told}");
                }
            }
        }
    }
    assert!(
        solved > 100,
        "only {solved} of the damaged specs could be solved"
    );
}

#[test]
fn damaged_grids_are_refused_or_taken() {
    let mut dice = fastrand::Rng::with_seed(2);
    let text = text_of("grid.json");
    for _ in 0..3000 {
        if let Err(wrong) = grid_file::read(&source("grid.json", damaged(&text, &mut dice))) {
            assert!(!wrong.is_empty());
        }
    }
}

#[test]
fn damaged_scenes_are_refused_or_taken() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, text) in base() {
        fs::write(folder.path().join(name), text).expect("a writable folder");
    }
    let mut dice = fastrand::Rng::with_seed(3);
    let text = text_of("scene.json");
    let path = folder.path().join("scene.json");
    for _ in 0..3000 {
        fs::write(&path, damaged(&text, &mut dice)).expect("a writable folder");
        if let Err(wrong) = Document::open(&path) {
            assert!(!wrong.is_empty());
        }
    }
}

#[test]
fn damaged_data_sets_are_refused_or_taken() {
    let mut dice = fastrand::Rng::with_seed(4);
    let text = text_of("tables.adm");
    for _ in 0..3000 {
        if let Err(error) = adams::tables::read(&damaged(&text, &mut dice)) {
            assert!(!error.to_string().is_empty());
        }
    }
}
