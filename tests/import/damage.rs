//! Decks and meshes with random damage: refused with a place, or taken; never a panic, never a number that is none.

use formats::spec::Spec;
use formats::text::source::Source;
use formats::units::Length;
use import::ImportOptions;

use super::{deck, from_memory, plain, text, told};

const PIECES: [&str; 30] = [
    "0",
    "-1",
    "1.+308",
    "1.-308",
    "1.+999",
    "7",
    "THRU",
    "1.",
    "-1.",
    "$",
    "*",
    "+",
    ",",
    "\t",
    "\n",
    "        ",
    "123456",
    "99999999999999999999",
    "GRID",
    "CBAR",
    "INCLUDE 'a'",
    "BEGIN BULK",
    "ENDDATA",
    "$Nodes",
    "$EndNodes",
    "4294967296",
    "nan",
    "inf",
    "\u{e4}",
    "BLANK",
];

/// One to four edits: characters replaced, cut out, doubled; lines exchanged.
fn damaged(text: &str, dice: &mut fastrand::Rng) -> String {
    let mut chars: Vec<char> = text.chars().collect();
    for _ in 0..=dice.usize(..4) {
        let from = dice.usize(..chars.len());
        let to = (from + dice.usize(..12)).min(chars.len());
        let piece: Vec<char> = PIECES[dice.usize(..PIECES.len())].chars().collect();
        match dice.usize(..6) {
            0 => drop(chars.drain(from..to)),
            1 => {
                let again = chars[from..to].to_vec();
                chars.splice(from..from, again);
            }
            2 => {
                let text: String = chars.iter().collect();
                let mut lines: Vec<&str> = text.lines().collect();
                let (a, b) = (dice.usize(..lines.len()), dice.usize(..lines.len()));
                lines.swap(a, b);
                chars = lines.join("\n").chars().collect();
            }
            3 => chars.truncate(from.max(chars.len() / 2)),
            _ => drop(chars.splice(from..(from + piece.len()).min(chars.len()), piece)),
        }
    }
    chars.into_iter().collect()
}

/// Takes a damaged text, and says whether it was taken; what is taken must be a sound spec.
fn taken(
    result: Result<import::Imported, Vec<formats::text::diagnostic::Diagnostic>>,
    damaged: &str,
) -> bool {
    match result {
        Ok(imported) => {
            let source = Source { name: "spec.json".to_owned(), text: imported.text };
            if let Err(wrong) = Spec::read(&source, None) {
                assert!(wrong.iter().all(|wrong| wrong.path == "rails"), "{}{damaged}", told(&wrong));
            }
            true
        }
        Err(wrong) => {
            assert!(!wrong.is_empty(), "{damaged}");
            // a fault that only the reader of specs found has no place in the model
            assert!(
                wrong.iter().all(|wrong| !wrong.file.contains("as a beam spec")),
                "{}{damaged}",
                told(&wrong)
            );
            false
        }
    }
}

#[test]
fn damaged_decks_are_refused_or_taken() {
    let mut dice = fastrand::Rng::with_seed(11);
    let rails =
        ImportOptions { up: Some([0.0, 1.0, 0.0]), rails: vec!["r=1-4".parse().expect("a rail")], ..plain() };
    let mut counts = [0; 2];
    for (name, options, rounds) in [
        ("decks/mill.bdf", plain(), 6000),
        ("decks/pinned.bdf", rails.clone(), 2000),
        ("decks/offset.bdf", rails, 2000),
    ] {
        let text = text(name);
        for _ in 0..rounds {
            let damaged = damaged(&text, &mut dice);
            counts[usize::from(taken(deck(&damaged, &options), &damaged))] += 1;
        }
    }
    assert!(counts[0] > 1000 && counts[1] > 300, "{counts:?}");
}

#[test]
fn damaged_meshes_are_refused_or_taken() {
    let mut dice = fastrand::Rng::with_seed(12);
    let [mesh, sections] = ["meshes/portal.msh", "meshes/portal.json"].map(text);
    let mut counts = [0; 2];
    for round in 0..4000 {
        let both = [&mesh, &sections].map(|text| damaged(text, &mut dice));
        let options = ImportOptions {
            length: Some(Length::Millimetre),
            up: Some([0.0, 0.0, 1.0]),
            sections: Some(Source {
                name: "sections.json".to_owned(),
                text: if round % 4 == 0 { both[1].clone() } else { sections.clone() },
            }),
            ..ImportOptions::default()
        };
        let mesh = if round % 4 == 0 { &mesh } else { &both[0] };
        let result = from_memory("mesh.msh", &[("mesh.msh", mesh)], &options);
        counts[usize::from(taken(result, mesh))] += 1;
    }
    assert!(counts[0] > 500 && counts[1] > 100, "{counts:?}");
}
