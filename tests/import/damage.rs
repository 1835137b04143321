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
            let source = Source {
                name: "spec.json".to_owned(),
                text: imported.text,
            };
            if let Err(wrong) = Spec::read(&source, None) {
                assert!(
                    wrong.iter().all(|wrong| wrong.path == "rails"),
                    "{}{damaged}",
                    told(&wrong)
                );
            }
            true
        }
        Err(wrong) => {
            assert!(!wrong.is_empty(), "{damaged}");
            // a fault that only the reader of specs found has no place in the model
            assert!(
                wrong
                    .iter()
                    .all(|wrong| !wrong.file.contains("as a beam spec")),
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
    let rails = ImportOptions {
        up: Some([0.0, 1.0, 0.0]),
        rails: vec!["r=1-4".parse().expect("a rail")],
        ..plain()
    };
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
fn damaged_input_files_are_refused_or_taken() {
    let mut dice = fastrand::Rng::with_seed(14);
    let model = "*NODE, NSET=all\n1,0,0,0\n2,2,0,0\n3,4,0,0\n4,4,1,0\n5,6,0,0\n*ELEMENT, TYPE=B31, ELSET=girder\n1,1,2\n\
        2,2,3\n*ELEMENT, TYPE=T3D2, ELSET=tie\n3,3,5\n*ELEMENT, TYPE=SPRING1, ELSET=bearing\n4,2\n\
        *ELEMENT, TYPE=MASS, ELSET=point\n5,3\n*SPRING, ELSET=bearing\n2\n5.e6\n*MASS, ELSET=point\n120.\n\
        *NSET, NSET=ends, GENERATE\n1, 5, 4\n*BEAM GENERAL SECTION, ELSET=girder, DENSITY=7850.\n\
        0.01, 4.e-4, 1.e-4, 2.e-4, 3.e-6\n0,1,.5\n2.1e11, 8.e10\n*SOLID SECTION, ELSET=tie, MATERIAL=steel\n0.002\n\
        *MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*MPC\nBEAM, 4, 3\n*RELEASE\n2, S2, ALLM\n\
        *BOUNDARY\nends, 1, 3\n1, 4\n*STEP\n*STATIC\n*CLOAD\n4, 2, -1.\n*END STEP\n";
    let mut counts = [0; 2];
    for _ in 0..6000 {
        let text = damaged(model, &mut dice);
        let result = from_memory("model.inp", &[("model.inp", &text)], &plain());
        counts[usize::from(taken(result, &text))] += 1;
    }
    assert!(counts[0] > 1000 && counts[1] > 100, "{counts:?}");
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
                text: if round % 4 == 0 {
                    both[1].clone()
                } else {
                    sections.clone()
                },
            }),
            ..ImportOptions::default()
        };
        let mesh = if round % 4 == 0 { &mesh } else { &both[0] };
        let result = from_memory("mesh.msh", &[("mesh.msh", mesh)], &options);
        counts[usize::from(taken(result, mesh))] += 1;
    }
    assert!(counts[0] > 500 && counts[1] > 100, "{counts:?}");
}
