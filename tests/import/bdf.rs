//! NASTRAN bulk data: published displacements, formats that mean the same, cards by hand.

use std::process::Command;

use fea::MemberKind;
use formats::units::{Force, Length};
use import::ImportOptions;
use import::structure::MassDistribution;
use serde_json::json as value;

use super::{deck, displacements, frame, from_memory, json, plain, text, told};

fn with_rail(rail: &str, up: [f64; 3]) -> ImportOptions {
    ImportOptions {
        up: Some(up),
        rails: vec![rail.parse().expect("a rail")],
        ..plain()
    }
}

/// Options in metres and newtons, with the mass along members.
fn distributed() -> ImportOptions {
    ImportOptions {
        mass: Some(MassDistribution::Distributed),
        ..plain()
    }
}

fn compare(found: &[f64], expected: &[f64]) {
    for (k, (a, b)) in found.iter().zip(expected).enumerate() {
        assert!((a - b).abs() < 1e-12, "freedom {k}: {a} {b}");
    }
}

/// Displacements published with MYSTRAN's deck BAR-OFFSET: grid 102 under the load on it.
const OFFSET: [f64; 6] = [0.04, 0.12, 0.26, -0.03, -0.03, 0.019];

/// The same of BAR-PINFLAG: grids 103 (under the load), 102 and 104.
const PINFLAG: [f64; 18] = [
    0.0002, 0.008, 0.008, 0.0, -0.006, 0.006, 0.0001, 0.0025, 0.0025, 0.0, -0.0045, 0.0045, 0.0001,
    0.0, 0.0, 0.0, 0.0, 0.0,
];

/// The load of both decks: 100 times (2, 3, 6).
const LOAD: [f64; 6] = [200.0, 300.0, 600.0, 0.0, 0.0, 0.0];

#[test]
fn offset_bars_move_as_published() {
    let imported = deck(
        &text("decks/offset.bdf"),
        &with_rail("r=1", [0.0, 1.0, 0.0]),
    )
    .expect("a deck");
    let found = displacements(&frame(&imported), &["GRID 20"], LOAD);
    compare(found.as_slice(), &OFFSET);
}

#[test]
fn pinned_bars_move_as_published() {
    let imported = deck(
        &text("decks/pinned.bdf"),
        &with_rail("r=1-4", [0.0, 1.0, 0.0]),
    )
    .expect("a deck");
    let found = displacements(&frame(&imported), &["GRID 3", "GRID 2", "GRID 4"], LOAD);
    compare(found.as_slice(), &PINFLAG);
}

/// MYSTRAN's own decks, in the folder that the variable GIRDERWAY_DECKS names: their terms keep them out of this
/// repository.
#[test]
#[cfg_attr(
    not(feature = "nightly"),
    ignore = "needs the decks of another program"
)]
fn decks_of_mystran_give_their_published_displacements() {
    let folder = std::env::var_os("GIRDERWAY_DECKS").expect("GIRDERWAY_DECKS names a folder");
    for (name, rail, points, expected) in [
        ("BAR-OFFSET.DAT", "r=12", &["GRID 102"][..], &OFFSET[..]),
        (
            "BAR-PINFLAG.DAT",
            "r=12-45",
            &["GRID 103", "GRID 102", "GRID 104"],
            &PINFLAG,
        ),
    ] {
        let path = std::path::Path::new(&folder).join(name);
        let text = std::fs::read_to_string(path)
            .unwrap_or_else(|error| panic!("GIRDERWAY_DECKS: {name}: {error}"));
        let imported = deck(&text, &with_rail(rail, [0.0, 1.0, 0.0])).expect("a deck");
        assert!(
            imported
                .warnings
                .iter()
                .any(|warning| warning.path == "PARAM"),
            "PARAM is named"
        );
        compare(
            displacements(&frame(&imported), points, LOAD).as_slice(),
            expected,
        );
    }
}

#[test]
fn every_card_becomes_what_it_says() {
    let imported = deck(&text("decks/mill.bdf"), &distributed())
        .unwrap_or_else(|wrong| panic!("{}", told(&wrong)));
    let spec = json(&imported);
    assert_eq!(spec["format"], "girderway-beam/1");
    assert_eq!(spec["name"], "deck");
    assert_eq!(
        spec["units"],
        value!({ "length": "m", "force": "N", "time": "s" })
    );
    // grid 5 is given in a system one up, and grid 90 only shows a direction
    let points = value!([
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 4.0],
        [6.0, 0.0, 0.0],
        [6.0, 0.0, 4.0],
        [3.0, 0.0, 5.0],
        [3.0, 2.0, 5.0],
        [6.0, 0.0, 4.5],
        [0.0, 0.0, 4.5]
    ]);
    assert_eq!(spec["points"], points);
    assert_eq!(
        spec["cells"][0]["data"],
        value!([[0, 1], [2, 3], [1, 4], [4, 3], [7, 6], [4, 5], [0, 5]])
    );
    let data = &spec["cell_data"];
    assert_eq!(
        data["kind"],
        value!([["beam", "beam", "beam", "beam", "beam", "truss", "truss"]])
    );
    assert_eq!(data["section"], value!([[0, 0, 1, 1, 2, 3, 4]]));
    let orientation = &data["orientation"][0];
    assert_eq!(orientation[0], value!([1.0, 0.0, 0.0]));
    assert_eq!(orientation[2], value!([0.0, 99.0, -4.0]));
    assert_eq!(orientation[4], value!([0.0, 0.0, 1.0]));
    assert_eq!(data["release_b"][0][3], value!(["ry", "rz"]));
    assert_eq!(data["offset_a"][0][3], value!([0.25, 0.0, 0.0]));
    assert_eq!(data["offset_b"][0][3], value!([-0.25, 0.0, 0.0]));
    assert_eq!(
        spec["sections"][0],
        value!({ "name": "PBAR 20", "material": "MAT1 30 and NSM of PBAR 20", "A": 0.015, "Iy": 8.5e-5, "Iz": 2.5e-4,
                 "J": 1.8e-6, "Asy": 0.4 * 0.015 })
    );
    let bar = &spec["sections"][1];
    assert!((bar["Iz"].as_f64().expect("a number") / (0.2 * 0.125 / 12.0) - 1.0).abs() < 1e-15);
    assert!((bar["Asz"].as_f64().expect("a number") / (5.0 / 6.0 * 0.1) - 1.0).abs() < 1e-15);
    assert_eq!(
        spec["sections"][2],
        value!({ "name": "PBEAM 22", "material": "MAT1 31", "A": 0.02, "Iy": 2e-5, "Iz": 4e-4, "J": 2e-6,
                 "Asz": 0.5 * 0.02 })
    );
    assert_eq!(
        spec["sections"][3],
        value!({ "name": "PROD 23", "material": "MAT1 31", "A": 0.002 })
    );
    assert_eq!(
        spec["materials"],
        value!([
            { "name": "MAT1 30 and NSM of PBAR 20", "E": 2.1e11, "G": 2.1e11 / 2.6, "density": 0.5 * 7850.0 + 5.0 / 0.015 },
            { "name": "MAT1 30 and NSM of PBARL 21", "E": 2.1e11, "G": 2.1e11 / 2.6, "density": 0.5 * 7850.0 + 1.5 / 0.1 },
            { "name": "MAT1 31", "E": 2e11, "G": 8e10 },
            { "name": "MAT1 30 and NSM of CONROD 107", "E": 2.1e11, "G": 2.1e11 / 2.6, "density": 0.5 * 7850.0 + 1.0 / 0.001 }
        ])
    );
    assert_eq!(
        spec["links"],
        value!([{ "from": 3, "to": 6 }, { "from": 1, "to": 7 }])
    );
    assert_eq!(
        spec["masses"],
        value!([{ "point": 4, "mass": 50.0, "inertia": [1.5, 2.0, 2.5], "offset": [0.0, 0.0, -0.5] }])
    );
    // the other end of the second spring is held, so it leads to ground
    assert_eq!(
        spec["springs"],
        value!([{ "point": 4, "dof": "uy", "k": 5e6 }, { "point": 4, "dof": "uz", "k": 1e6 }])
    );
    assert_eq!(
        spec["supports"],
        value!([
            { "point": 0, "fix": ["ux", "uy", "uz", "rx", "ry", "rz"] },
            { "point": 2, "fix": ["ux", "uy", "rx", "rz"] },
            { "point": 5, "fix": ["ux", "uy", "uz", "rx", "ry", "rz"] }
        ])
    );
    let warned: Vec<&str> = imported
        .warnings
        .iter()
        .map(|warning| warning.path.as_str())
        .collect();
    assert_eq!(warned, ["PARAM", "SPC set 8", "FORCE", ""]);
}

#[test]
fn local_axes_are_those_of_nastran() {
    let imported = deck(
        &text("decks/mill.bdf"),
        &with_rail("top=103,104", [0.0, 0.0, 1.0]),
    )
    .expect("a deck");
    let frame = frame(&imported);
    let column = frame.model.members[0];
    // plane 1 of the columns is x-z of the building: I1 = 2.5e-4 resists sway along the girder
    assert_eq!(
        (column.kind, column.orientation),
        (MemberKind::Beam, [1.0, 0.0, 0.0])
    );
    let section = frame.model.sections[column.section];
    assert_eq!((section.iz, section.iy), (2.5e-4, 8.5e-5));
}

/// Cards of `mill.bdf` as lists of fields, to be written in other formats.
fn fields() -> Vec<Vec<String>> {
    let deck = text("decks/mill.bdf");
    let (_, bulk) = deck.split_once("BEGIN BULK\n").expect("bulk data");
    let (bulk, _) = bulk.split_once("ENDDATA").expect("an end");
    let mut cards: Vec<Vec<String>> = Vec::new();
    for line in bulk.lines().filter(|line| !line.starts_with('$')) {
        let field = |k: usize| {
            line.get(8 * k..(8 * k + 8).min(line.len()))
                .unwrap_or_default()
                .trim()
                .to_owned()
        };
        let row: Vec<String> = (1..9).map(field).collect();
        match (field(0).as_str(), cards.last_mut()) {
            ("" | "+" | "+A" | "+P" | "+Q", Some(card)) => card.extend(row),
            (name, _) => cards.push([vec![name.to_owned()], row].concat()),
        }
    }
    cards
}

#[derive(Clone, Copy)]
enum Format {
    Small,
    Large,
    Free,
    FreeLarge,
}

/// A card in a format; `mark`: how continuations are marked.
fn written(card: &[String], format: Format, mark: usize, number: usize) -> String {
    let mut body = card[1..].to_vec();
    while body.last().is_some_and(|field| field.is_empty()) {
        body.pop();
    }
    let large = matches!(format, Format::Large | Format::FreeLarge);
    let rows: Vec<&[String]> = body.chunks(if large { 4 } else { 8 }).collect();
    let star = if large { "*" } else { "+" };
    let mut lines = Vec::new();
    for (k, row) in rows.iter().enumerate() {
        let label = |k: usize| match mark {
            0 => String::new(),
            1 => star.to_owned(),
            _ => format!("{star}{}", number * 10 + k),
        };
        let head = match (k, large) {
            (0, true) => format!("{}*", card[0]),
            (0, false) => card[0].clone(),
            (_, true) if mark == 0 => "*".to_owned(),
            _ => label(k),
        };
        let tail = if k + 1 < rows.len() {
            label(k + 1)
        } else {
            String::new()
        };
        let width = if large { 16 } else { 8 };
        let count = if large { 4 } else { 8 };
        let blank = String::new();
        let cells: Vec<&String> = (0..count).map(|k| row.get(k).unwrap_or(&blank)).collect();
        lines.push(match format {
            Format::Small | Format::Large => {
                let cells: String = cells.iter().map(|cell| format!("{cell:<width$}")).collect();
                format!("{head:<8}{cells}{tail}").trim_end().to_owned()
            }
            Format::Free | Format::FreeLarge => {
                let cells: Vec<String> = cells.iter().map(|cell| cell.to_string()).collect();
                let last = if tail.is_empty() {
                    String::new()
                } else {
                    format!(",{tail}")
                };
                format!("{head},{}{last}", cells.join(","))
            }
        });
    }
    // a blank continuation in fixed fields would be a blank line
    if rows.is_empty() {
        card[0].clone()
    } else {
        lines.join("\n")
    }
}

const CONTROL: &str = "CEND\nSPC = 7\nBEGIN BULK\n";

#[test]
fn every_format_gives_the_same_spec() {
    let wanted = deck(&text("decks/mill.bdf"), &plain())
        .expect("a deck")
        .text;
    let cards = fields();
    assert_eq!(cards.len(), 37);
    let formats = [
        Format::Small,
        Format::Large,
        Format::Free,
        Format::FreeLarge,
    ];
    // a row of blanks alone needs its marker
    for mark in 1..3 {
        for format in formats {
            let lines: Vec<String> = cards
                .iter()
                .enumerate()
                .map(|(k, card)| written(card, format, mark, k))
                .collect();
            let text = format!("{CONTROL}{}\n", lines.join("\n"));
            let same =
                deck(&text, &plain()).unwrap_or_else(|wrong| panic!("{}{text}", told(&wrong)));
            assert_eq!(same.text, wanted, "{text}");
            let lower = deck(&text.to_lowercase(), &plain())
                .unwrap_or_else(|wrong| panic!("{}", told(&wrong)));
            assert_eq!(lower.text, wanted);
        }
    }
    // all formats in one deck, the cards in another order, lines of Windows
    let mut lines: Vec<String> = cards
        .iter()
        .enumerate()
        .map(|(k, card)| written(card, formats[k % 4], 1 + k % 2, k))
        .collect();
    lines.reverse();
    let order = lines
        .iter()
        .position(|line| line.starts_with("RBAR"))
        .expect("a link");
    let other = lines
        .iter()
        .position(|line| line.starts_with("RBE2"))
        .expect("a link");
    lines.swap(order, other);
    let order = lines
        .iter()
        .position(|line| line.starts_with("CELAS1"))
        .expect("a spring");
    let other = lines
        .iter()
        .position(|line| line.starts_with("CELAS2"))
        .expect("a spring");
    lines.swap(order, other);
    let text = format!("{CONTROL}{}\n", lines.join("\n$ a comment \n")).replace('\n', "\r\n");
    assert_eq!(
        deck(&text, &plain())
            .unwrap_or_else(|wrong| panic!("{}", told(&wrong)))
            .text,
        wanted
    );
}

#[test]
fn decks_that_pynastran_writes_give_the_same_spec() {
    // decks/make.py: an independent reader took mill.bdf, and its writer wrote these
    let wanted = json(&deck(&text("decks/mill.bdf"), &plain()).expect("a deck"));
    for name in ["mill_small", "mill_large", "mill_double"] {
        let found = deck(&text(&format!("decks/{name}.bdf")), &plain());
        assert_eq!(
            json(&found.unwrap_or_else(|wrong| panic!("{name}: {}", told(&wrong)))),
            wanted,
            "{name}"
        );
    }
}

#[test]
fn exponents_may_be_written_in_many_ways() {
    let wanted = deck(&text("decks/offset.bdf"), &plain())
        .expect("a deck")
        .text;
    for number in [
        "1.+7",
        "1.E7",
        "1.0E+7",
        "1.D+7",
        "1.d7",
        "10.+6",
        "10000000.",
        ".1+8",
        "+1.+07",
        "1e7",
    ] {
        let text = text("decks/offset.bdf").replacen("1.+7", number, 1);
        assert_eq!(
            deck(&text, &plain()).expect("a deck").text,
            wanted,
            "{number}"
        );
    }
}

#[test]
fn included_files_stand_in_their_places() {
    let deck_text = text("decks/pinned.bdf");
    let wanted = from_memory("d/deck.bdf", &[("d/deck.bdf", &deck_text)], &plain())
        .expect("a deck")
        .text;
    let cut = deck_text.find("PBAR").expect("a property");
    let main = format!("{}include 'sub/rest.inc'\n", &deck_text[..cut]);
    let (rest, last) = deck_text[cut..].split_once("MAT1").expect("a material");
    let rest = format!("{rest}INCLUDE more.inc $ relative to this file\n");
    let last = format!("MAT1{last}");
    let files = [
        ("d/deck.bdf", main.as_str()),
        ("d/sub/rest.inc", &rest),
        ("d/sub/more.inc", &last),
    ];
    let found = from_memory("d/deck.bdf", &files, &plain())
        .unwrap_or_else(|wrong| panic!("{}", told(&wrong)));
    assert_eq!(found.text, wanted);
    // a fault in an included file is told there
    let broken = last.replacen("1.+7", "1.+x", 1);
    let files = [
        ("d/deck.bdf", main.as_str()),
        ("d/sub/rest.inc", &rest),
        ("d/sub/more.inc", &broken),
    ];
    let wrong = from_memory("d/deck.bdf", &files, &plain()).expect_err("a fault");
    assert_eq!(
        (wrong[0].file.as_str(), wrong[0].line),
        ("d/sub/more.inc", Some(1))
    );
    // loops are refused
    let files = [
        ("d/deck.bdf", main.as_str()),
        ("d/sub/rest.inc", "INCLUDE '../deck.bdf'\n"),
    ];
    let wrong = from_memory("d/deck.bdf", &files, &plain()).expect_err("a loop");
    assert!(
        wrong.iter().any(|wrong| wrong.path == "INCLUDE"),
        "{}",
        told(&wrong)
    );
    let wrong = from_memory("deck.bdf", &[("deck.bdf", "INCLUDE deck.bdf\n")], &plain())
        .expect_err("a loop");
    assert!(
        wrong[0]
            .expected
            .starts_with("must not include a file that is already being read"),
        "{}",
        told(&wrong)
    );
}

#[test]
fn numbers_keep_their_bits() {
    let mut deck_text =
        String::from("MAT1,1,.1234567890123456789+6,,.3\nPBAR,2,1,1.1,.3,.7,2.220446049250313-3\n");
    let mut wanted = Vec::new();
    for k in 0..200 {
        let x = f64::from(k) / 7.0 + 1e-9 / f64::from(k + 1);
        deck_text.push_str(&format!(
            "GRID,{},,{x:.20},0.,{}\n",
            k + 1,
            format_args!("{:e}", x * 1e-7)
                .to_string()
                .replace('e', ".E")
                .replacen(".E", "E", 1)
        ));
        wanted.push([x, 0.0, x * 1e-7]);
        if k > 0 {
            deck_text.push_str(&format!("CBAR,{k},2,{k},{},0.,1.,0.\n", k + 1));
        }
    }
    let imported = deck(&deck_text, &plain()).unwrap_or_else(|wrong| panic!("{}", told(&wrong)));
    let spec = json(&imported);
    for (point, wanted) in spec["points"]
        .as_array()
        .expect("points")
        .iter()
        .zip(&wanted)
    {
        for axis in 0..3 {
            assert_eq!(
                point[axis].as_f64().expect("a number").to_bits(),
                wanted[axis].to_bits()
            );
        }
    }
    assert_eq!(
        spec["materials"][0]["E"].as_f64(),
        ".1234567890123456789e6".parse().ok()
    );
    assert_eq!(
        spec["sections"][0]["J"].as_f64(),
        Some(2.220446049250313e-3)
    );
}

#[test]
fn what_has_no_stiffness_gets_none() {
    // a cantilever of PBAR without J beside one with; a rod with J in place of the bar
    let common = "MAT1,1,2.+11,,.25\nGRID,1,,0.,0.,0.,,123456\nGRID,2,,2.,0.,0.\nGRID,3,,4.,0.,0.\nGRID,4,,4.,1.,0.,,123456\n";
    let bars = "CBAR,1,5,1,2,0.,1.,0.\nCBAR,2,5,2,3,0.,1.,0.\nPROD,6,1,.01,.001\nCROD,3,6,3,4\n";
    let options = with_rail("r=1,2", [0.0, 1.0, 0.0]);
    let of = |j: &str| {
        let imported = deck(
            &format!("{common}{bars}PBAR,5,1,.02,1.-4,2.-4,{j}\n"),
            &options,
        )
        .expect("a deck");
        (
            displacements(
                &frame(&imported),
                &["GRID 3"],
                [0.0, 1e5, 2e5, 0.0, 0.0, 0.0],
            ),
            imported,
        )
    };
    let (stiff, _) = of("1.-3");
    let (soft, imported) = of("");
    // nothing here twists the bars: bending is the same, whatever J
    for freedom in [0, 1, 2, 5] {
        assert!(
            (stiff[freedom] - soft[freedom]).abs() <= 1e-12 * stiff.amax(),
            "{freedom}"
        );
    }
    let data = &json(&imported)["cell_data"];
    assert_eq!(data["kind"], value!([["beam", "beam", "rod"]]));
    assert_eq!(
        (&data["release_a"], &data["release_b"]),
        (&value!(null), &value!(null))
    );
    let sections = &json(&imported)["sections"];
    assert_eq!(
        sections[0],
        value!({ "name": "PBAR 5", "material": "MAT1 1", "A": 0.02, "Iy": 2e-4, "Iz": 1e-4, "J": 0.0 })
    );
    assert_eq!(
        sections[1],
        value!({ "name": "PROD 6", "material": "MAT1 1", "A": 0.01, "J": 0.001 })
    );
    let warned: Vec<&str> = imported
        .warnings
        .iter()
        .map(|warning| warning.path.as_str())
        .collect();
    assert_eq!(warned, ["PBAR 5"]);
    // the rod resists rotation about its axis with G J / L
    let turned = displacements(
        &frame(&of("1.-3").1),
        &["GRID 3"],
        [0.0, 0.0, 0.0, 0.0, 1e3, 0.0],
    );
    let (ei, gj, length) = (2e11 * 2e-4, 8e10 * 1e-3, 4.0f64);
    // about y at the tip of the cantilever: EI_2/L in series with nothing, beside the rod's own twist
    let spring = ei / length + gj / 1.0;
    let lateral_free = 1e3 / spring;
    assert!(
        (turned[4] / lateral_free - 1.0).abs() < 1e-9,
        "{} {lateral_free}",
        turned[4]
    );
}

#[test]
fn supports_are_those_chosen() {
    let common = "MAT1,1,2.+11,,.25\nPBAR,5,1,.02,1.-4,2.-4,1.-4\nGRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nCBAR,1,5,1,2,0.,1.,0.\n";
    let sets = "SPC1,1,123,1\nSPC,2,1,456,0.,2,3,0.\nSPCADD,3,1,2\n";
    let held = |text: &str, options: &ImportOptions| {
        json(&deck(text, options).expect("a deck"))["supports"].clone()
    };
    let one = value!([{ "point": 0, "fix": ["ux", "uy", "uz"] }]);
    assert_eq!(
        held(&format!("{common}SPC1,1,123,1\n"), &plain()),
        one,
        "the only one"
    );
    let bulk = format!("{common}{sets}");
    assert_eq!(
        held(&format!("CEND\n spc=1\nBEGIN BULK\n{bulk}"), &plain()),
        one,
        "case control"
    );
    assert_eq!(
        held(
            &bulk,
            &ImportOptions {
                spc: Some(1),
                ..plain()
            }
        ),
        one,
        "the user"
    );
    let all = value!([{ "point": 0, "fix": ["ux", "uy", "uz", "rx", "ry", "rz"] }, { "point": 1, "fix": ["uz"] }]);
    assert_eq!(held(&bulk, &plain()), all, "the only sum");
    let wrong =
        deck(&format!("{common}SPC1,1,123,1\nSPC1,2,456,1\n"), &plain()).expect_err("two sets");
    assert!(told(&wrong).contains("--spc N"), "{}", told(&wrong));
    let wrong = deck(
        &bulk,
        &ImportOptions {
            spc: Some(9),
            ..plain()
        },
    )
    .expect_err("no such set");
    assert!(
        told(&wrong).contains("known sets: 1, 2, 3"),
        "{}",
        told(&wrong)
    );
}

#[test]
fn units_are_never_guessed() {
    let text = text("decks/pinned.bdf");
    for options in [
        ImportOptions::default(),
        ImportOptions {
            length: Some(Length::Foot),
            ..ImportOptions::default()
        },
        ImportOptions {
            force: Some(Force::Kip),
            ..ImportOptions::default()
        },
    ] {
        let wrong = deck(&text, &options).expect_err("no units");
        assert!(
            told(&wrong).contains("--length and --force"),
            "{}",
            told(&wrong)
        );
    }
}

#[test]
fn uniform_beams_are_taken_and_other_stations_refused() {
    let common = "MAT1,1,2.+11,,.25\nGRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nCBEAM,1,5,1,2,0.,1.,0.\n";
    let of = |property: &str| deck(&format!("{common}{property}\n"), &plain());
    let plain_one = of("PBEAM,5,1,.02,1.-4,2.-4,,1.-4").expect("uniform").text;
    for property in [
        "PBEAM,5,1,.02,1.-4,2.-4,,1.-4\n+,,,,,,,,\n+,YES,1.0,.02,1.-4,2.-4,,1.-4\n+,,,,,,,,\n+,1.,1.",
        "PBEAM,5,1,.02,1.-4,2.-4,,1.-4\n+,1.,2.,3.,4.,5.,6.,7.,8.\n+,YESA,1.0\n+,1.",
        "PBEAM,5,1,.02,1.-4,2.-4,,1.-4\n+,NO,.5,,,,,\n+,NO,1.0,.02",
    ] {
        assert_eq!(
            of(property)
                .unwrap_or_else(|wrong| panic!("{property}: {}", told(&wrong)))
                .text,
            plain_one,
            "{property}"
        );
    }
    let shaped = of("PBEAML,5,1,,BAR\n+,.1,.2").expect("uniform").text;
    assert_eq!(
        of("PBEAML,5,1,,BAR\n+,.1,.2,,YES,1.,.1,.2")
            .expect("uniform")
            .text,
        shaped
    );
    for property in [
        "PBEAM,5,1,.02,1.-4,2.-4,,1.-4\n+\n+,YES,.5,.01",
        "PBEAM,5,1,.02,1.-4,2.-4,,1.-4,3.\n+\n+,YES,1.,.01",
        "PBEAM,5,1,.02,1.-4,2.-4,,1.-4\n+\n+,YES,1.,.01,,,,0.",
        "PBEAM,5,1,.02,1.-4,2.-4,,1.-4\n+\n+,NO,1.,.01\n+,,,.5",
        "PBEAML,5,1,,BAR\n+,.1,.2,,YES,.5,.1,.3",
    ] {
        assert!(of(property).is_err(), "{property}");
    }
}

#[test]
fn tapered_beams_bend_as_their_closed_form() {
    // second moments go linearly from I to r I: the tip of a cantilever sinks by
    // P L^3/(E I s^3) (r^2 ln r - 2 r s + (r^2 - 1)/2), s = r - 1
    let common =
        "MAT1,1,2.+11,,.25\nGRID,1,,0.,0.,0.,,123456\nGRID,2,,2.,0.,0.\nCBEAM,1,5,1,2,0.,1.,0.\n";
    let bulk = format!(
        "{common}PBEAM,5,1,.02,1.-4,2.-4,,1.-4\n+\n+,YES,1.,.01,5.-5,1.-4,,5.-5\n+\n+,0.,0.\n"
    );
    let imported = deck(&bulk, &with_rail("r=1", [0.0, 1.0, 0.0]))
        .unwrap_or_else(|wrong| panic!("{}", told(&wrong)));
    let spec = json(&imported);
    assert_eq!(
        (&spec["parts"], &spec["cell_data"]["section_b"]),
        (&value!(32), &value!([[1]]))
    );
    assert_eq!(spec["cell_sets"], value!({ "PBEAM 5": [[0]] }));
    let found = displacements(
        &frame(&imported),
        &["GRID 2"],
        [0.0, 1e4, 1e4, 0.0, 0.0, 0.0],
    );
    let (r, s) = (0.5f64, -0.5f64);
    let shape = (r * r * r.ln() - 2.0 * r * s + (r * r - 1.0) / 2.0) / s.powi(3);
    for (freedom, i) in [(1, 1e-4), (2, 2e-4)] {
        let exact = 1e4 * 8.0 / (2e11 * i) * shape;
        assert!(
            (found[freedom] / exact - 1.0).abs() < 2e-4,
            "{freedom}: {} {exact}",
            found[freedom]
        );
    }
    assert!(
        imported
            .warnings
            .iter()
            .any(|warning| warning.path == "PBEAM 5"),
        "{}",
        told(&imported.warnings)
    );
}

#[test]
fn rails_lie_on_the_elements_named() {
    let imported = deck(
        &text("decks/mill.bdf"),
        &with_rail("top=103,104/offset=0,0,0.5/axis=1,0,0", [0.0, 0.0, 1.0]),
    )
    .unwrap_or_else(|wrong| panic!("{}", told(&wrong)));
    let rail = &json(&imported)["rails"]["top"];
    assert_eq!(rail["axis"], value!([1.0, 0.0, 0.0]));
    assert_eq!(rail["origin"], value!([0.0, 0.0, 4.0]));
    assert_eq!(
        rail["segments"],
        value!([{ "cell": [0, 2], "offset": [0.0, 0.0, 0.5] }, { "cell": [0, 3], "offset": [0.0, 0.0, 0.5] }])
    );
    // the last point lies beyond the flexible end, and so does its station not
    assert_eq!(rail["stations"], value!([0.0, 3.0, 5.75]));
    for (rail, up, part) in [
        (
            "top=103,999",
            Some([0.0, 0.0, 1.0]),
            "refers to element 999",
        ),
        (
            "top=girder",
            Some([0.0, 0.0, 1.0]),
            "refers to the set girder",
        ),
        (
            "top=101",
            Some([0.0, 0.0, 1.0]),
            "not parallel to the upward direction",
        ),
        (
            "top=103,101",
            Some([0.0, 0.0, 1.0]),
            "is perpendicular to it",
        ),
        (
            "top=103,101/axis=1,0,0",
            Some([0.0, 0.0, 1.0]),
            "is perpendicular to it",
        ),
        ("top=103", None, "requires --up"),
    ] {
        let options = ImportOptions {
            up,
            rails: vec![rail.parse().expect("a rail")],
            ..plain()
        };
        let wrong = deck(&text("decks/mill.bdf"), &options).expect_err("no rail can lie there");
        assert!(told(&wrong).contains(part), "{rail}: {}", told(&wrong));
    }
}

/// Natural frequencies of an imported deck, Hz, as `fea --modes` computes them.
fn frequencies(deck_text: &str, rail: &str, count: usize) -> Vec<f64> {
    let imported = deck(deck_text, &with_rail(rail, [0.0, 0.0, 1.0])).expect("a deck");
    let frame = frame(&imported);
    let found = fea::refined_modes(&frame.model, &[], count, 1e-3)
        .expect("solvable")
        .modes
        .modes;
    found
        .iter()
        .map(|mode| mode.omega / std::f64::consts::TAU)
        .collect()
}

#[test]
fn rods_with_and_without_j_have_the_same_frequencies() {
    // a mass on three rods; a girder on a hanger
    let tripod = "GRID,1,,0.,0.,0.,,123456\nGRID,2,,0.,0.,3.,,456\nGRID,3,,4.,0.,0.,,123456\n\
        GRID,4,,0.,4.,0.,,123456\nCROD,1,1,1,2\nCROD,2,1,3,2\nCROD,3,1,4,2\nMAT1,1,2.1+11,,.3,7850.\n\
        CONM2,9,2,,1000.\n";
    let hung = "GRID,1,,0.,0.,0.,,123456\nGRID,2,,6.,0.,0.\nGRID,3,,12.,0.,0.,,23456\n\
        GRID,4,,6.,0.,6.,,123456\nCBAR,1,2,1,2,0.,0.,1.\nCBAR,2,2,2,3,0.,0.,1.\nCROD,3,1,2,4\n\
        PBAR,2,1,.02,4.-4,1.-4,1.-5\nMAT1,1,2.1+11,,.3,7850.\nPARAM,COUPMASS,1\n";
    for (cards, rail, lowest, tolerance) in [
        (tripod, "r=2/axis=-1,0,0", rod_tripod(), 1e-12),
        (hung, "r=1,2", 8.95, 1e-2),
    ] {
        let with = frequencies(&format!("{cards}PROD,1,1,.001,1.-7\n"), rail, 3);
        let without = frequencies(&format!("{cards}PROD,1,1,.001\n"), rail, 3);
        assert!((with[0] / lowest - 1.0).abs() < 1e-3, "{with:?}");
        for (a, b) in with.iter().zip(&without) {
            assert!((a / b - 1.0).abs() < tolerance, "{with:?} {without:?}");
        }
    }
}

/// A mass on three rods: 20.2695 Hz ([`rod_tripod`], analytic). Its rail lies on a
/// rod, which carries no load across its axis.
#[test]
fn modes_of_imported_rods_need_no_rail_that_carries_wheels() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name);
    for (name, j) in [("with", ",1.-7"), ("without", "")] {
        let cards = format!(
            "GRID,1,,0.,0.,0.,,123456\nGRID,2,,0.,0.,3.,,456\nGRID,3,,4.,0.,0.,,123456\n\
             GRID,4,,0.,4.,0.,,123456\nCROD,1,1,1,2\nCROD,2,1,3,2\nCROD,3,1,4,2\nPROD,1,1,.001{j}\n\
             MAT1,1,2.1+11,,.3,7850.\nCONM2,9,2,,1000.\n"
        );
        std::fs::write(path("rods.bdf"), cards).expect("a writable folder");
        let program = |arguments: &str| {
            let mut command = Command::new(env!("CARGO_BIN_EXE_girderway"));
            command
                .current_dir(folder.path())
                .args(arguments.split(' '))
                .output()
                .expect("the program starts")
        };
        let import = "import rods.bdf --length m --force N --up 0,0,1 -o rods.json --rail";
        let refused = program(&format!("{import} r=1,2"));
        assert_eq!(refused.status.code(), Some(2));
        assert!(
            String::from_utf8_lossy(&refused.stderr).contains("omit elements along which no wheel")
        );
        assert!(program(&format!("{import} r=2")).status.success());
        assert_eq!(
            program("fea rods.json").status.code(),
            Some(3),
            "no direction has a grid"
        );
        let found = program("fea rods.json --modes 3 -o grid.json");
        let words = String::from_utf8_lossy(&found.stderr);
        assert!(found.status.success(), "{words}");
        assert!(
            words.contains("modes: 20.") && words.contains("no vertical grids"),
            "{name} J: {words}"
        );
        let grid: serde_json::Value =
            serde_json::from_slice(&std::fs::read(path("grid.json")).expect("the file written"))
                .expect("JSON");
        let lowest = grid["modes"]["modes"][0]["hz"].as_f64().expect("a number");
        assert!((lowest - rod_tripod()).abs() < 1e-9 * lowest, "{lowest}");
        let read = program("splines grid.json -o tables.adm");
        assert_eq!(
            read.status.code(),
            Some(2),
            "{}",
            String::from_utf8_lossy(&read.stderr)
        );
    }
}

/// Lowest frequency of the mass on three rods: K = sum EA/L n n^T at the joint, M = 1000 kg and half of the mass of
/// each rod, which is lumped at its ends (analytic).
fn rod_tripod() -> f64 {
    let (ea, line) = (2.1e11 * 0.001, 7850.0 * 0.001);
    let mut stiffness = nalgebra::Matrix3::<f64>::zeros();
    let mut mass = 1000.0;
    for foot in [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]] {
        let way: nalgebra::Vector3<f64> =
            nalgebra::Vector3::new(0.0, 0.0, 3.0) - nalgebra::Vector3::from(foot);
        let length = way.norm();
        let axis: nalgebra::Vector3<f64> = way / length;
        stiffness += axis * axis.transpose() * (ea / length);
        mass += line * length / 2.0;
    }
    (stiffness.symmetric_eigen().eigenvalues.min() / mass).sqrt() / std::f64::consts::TAU
}

#[test]
fn bars_without_j_deflect_alike_along_an_axis_and_at_45_degrees() {
    let of = |points: [[f64; 2]; 3]| {
        let grids: String = (1..=3)
            .zip(points)
            .map(|(id, [x, y])| format!("GRID,{id},,{x:?},{y:?},0.\n"))
            .collect();
        let cards = "CBAR,1,1,1,2,0.,0.,1.\nCBAR,2,1,2,3,0.,0.,1.\nPBAR,1,1,.01,1.-4,2.-4\n\
            MAT1,1,2.1+11,,.3,7850.\nSPC1,1,123456,1,3\n";
        let imported = deck(
            &format!("{grids}{cards}"),
            &with_rail("r=1,2", [0.0, 0.0, 1.0]),
        )
        .expect("a deck");
        displacements(
            &frame(&imported),
            &["GRID 2"],
            [0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
        )[2]
    };
    let side = 50.0f64.sqrt();
    let along = of([[0.0, 0.0], [side, 0.0], [2.0 * side, 0.0]]);
    let skew = of([[0.0, 0.0], [5.0, 5.0], [10.0, 10.0]]);
    let exact = 200.0 * 2f64.sqrt() * 10.0 / (192.0 * 2.1e11 * 1e-4);
    assert!((along / exact - 1.0).abs() < 1e-12, "{along} {exact}");
    assert!((skew / along - 1.0).abs() < 1e-12, "{skew} {along}");
}
