//! What stands in a deck.

use std::collections::BTreeMap;

use adams::{AdamsModel, DataSet};
use deck::DeckForm;
use formats::units::{Force, Length};

use super::{FORMS, Loaded, example, scene};

fn all() -> Vec<Loaded> {
    let examples = ["wheel", "bogie", "mill_girderway"].map(example);
    let scenes = ["crane", "wagons", "printed"].map(scene);
    examples
        .iter()
        .chain(&scenes)
        .map(|path| Loaded::new(path))
        .collect()
}

/// Statements by a reader of these tests' own: keyword, identifier, arguments as text.
fn statements(text: &str) -> Vec<(String, Option<u32>, String)> {
    let mut out: Vec<(String, Option<u32>, String)> = Vec::new();
    for line in text
        .lines()
        .skip(1)
        .filter(|line| !line.starts_with('!') && *line != "END")
    {
        match line.strip_prefix(',') {
            Some(more) => {
                let last = out.last_mut().expect("a statement goes on");
                last.2.push_str(more);
                last.2.push(';');
            }
            None => {
                let (keyword, id) = line.split_once('/').expect("a statement");
                out.push((keyword.to_owned(), id.parse().ok(), String::new()));
            }
        }
    }
    out
}

#[test]
fn lines_are_short_plain_and_end_with_end() {
    for loaded in all() {
        for form in FORMS.into_iter().chain([DeckForm::Paper]) {
            let text = loaded.text(form);
            assert!(text.is_ascii() && text.ends_with("\nEND\n"));
            let longest = text.lines().map(str::len).max();
            assert!(longest.is_some_and(|length| length <= 79), "{longest:?}");
        }
    }
}

#[test]
fn identifiers_and_names_are_unique_and_references_resolve() {
    for loaded in all() {
        for form in FORMS.into_iter().chain([DeckForm::Paper]) {
            let text = loaded.text(form);
            let all = statements(&text);
            let mut seen = BTreeMap::new();
            for (keyword, id, _) in &all {
                let Some(id) = id else { continue };
                assert_eq!(
                    seen.insert((keyword.as_str(), *id), ()),
                    None,
                    "{keyword}/{id}"
                );
            }
            for (keyword, _, arguments) in &all {
                for part in arguments.split(';') {
                    let Some((name, value)) = part.split_once('=') else {
                        continue;
                    };
                    let what = match (name.trim(), keyword.as_str()) {
                        ("PART", "MARKER") => "PART",
                        ("I" | "J" | "RM" | "JFLOAT" | "CM", _) => "MARKER",
                        _ => continue,
                    };
                    let id: u32 = value.trim().parse().expect("an identifier");
                    assert!(
                        seen.contains_key(&(what, id)),
                        "{keyword} refers to {what}/{id}"
                    );
                }
            }
            // markers, variables, splines and states inside expressions
            AdamsModel::new(&DataSet::read(&text).expect("our own text"))
                .expect("every reference resolves");
            let mut names: Vec<&str> = text
                .lines()
                .filter(|line| line.starts_with("!  adams_view_name"))
                .collect();
            let count = names.len();
            names.sort_unstable();
            names.dedup();
            // a part, a force and a marker may share a name; nothing else does
            assert!(
                count - names.len() <= loaded.document.scene().bodies.len() + 40,
                "{count}"
            );
        }
    }
}

#[test]
fn a_deck_read_and_printed_is_read_again_as_itself() {
    for loaded in all() {
        for form in FORMS {
            let first = DataSet::read(&loaded.text(form)).expect("our own text");
            let second = DataSet::read(&first.write().expect("a text")).expect("its text again");
            assert_eq!(first, second);
        }
    }
}

#[test]
fn equal_scenes_give_equal_bytes() {
    let path = example("mill_girderway");
    assert_eq!(
        Loaded::new(&path).text(DeckForm::Factored),
        Loaded::new(&path).text(DeckForm::Factored)
    );
}

/// kg of a unit of mass, m of one of length: the definitions of the pound, the foot and the pound-force.
fn kilograms(word: &str) -> f64 {
    match word {
        "KILOGRAM" => 1.0,
        "POUND_MASS" => 0.453_592_37,
        "SLUG" => 0.453_592_37 * 9.806_65 / 0.3048,
        other => panic!("unknown mass {other}"),
    }
}

fn metres(length: Length) -> f64 {
    match length {
        Length::Foot => 0.3048,
        Length::Inch => 0.0254,
        Length::Metre => 1.0,
        Length::Millimetre => 1e-3,
    }
}

fn newtons(force: Force) -> f64 {
    let pound = 0.453_592_37 * 9.806_65;
    match force {
        Force::Pound => pound,
        Force::Kip => 1000.0 * pound,
        Force::Newton => 1.0,
        Force::Kilonewton => 1000.0,
    }
}

#[test]
fn masses_in_their_unit_times_gravity_are_the_weights_of_the_scene() {
    for loaded in all() {
        let scene = loaded.document.scene();
        let text = loaded.text(DeckForm::Akispl);
        let all = statements(&text);
        let find = |arguments: &str, name: &str| -> Option<String> {
            let mut parts = arguments.split(';').filter_map(|part| part.split_once('='));
            parts
                .find(|(key, _)| key.trim() == name)
                .map(|(_, value)| value.trim().to_owned())
        };
        let (_, _, units) = all
            .iter()
            .find(|(keyword, ..)| keyword == "UNITS")
            .expect("UNITS");
        let (_, _, gravity) = all
            .iter()
            .find(|(keyword, ..)| keyword == "ACCGRAV")
            .expect("ACCGRAV");
        let unit = kilograms(&find(units, "MASS").expect("MASS"));
        let g: f64 = find(gravity, "JGRAV")
            .and_then(|text| text.parse().ok())
            .expect("JGRAV");
        let of =
            |arguments: &str| find(arguments, "MASS").and_then(|text| text.parse::<f64>().ok());
        let mass: f64 = all
            .iter()
            .filter(|(keyword, ..)| keyword == "PART")
            .filter_map(|(.., text)| of(text))
            .sum();
        let found = mass * unit * -g * metres(scene.units.length);
        let weight: f64 = scene
            .bodies
            .iter()
            .map(|body| body.mass * scene.gravity)
            .sum();
        let wanted = weight * newtons(scene.units.force);
        assert!(
            (found / wanted - 1.0).abs() < 1e-14,
            "{}: {found} {wanted}",
            scene.name
        );
    }
}

#[test]
fn every_trap_has_its_remark_once() {
    let text = Loaded::new(&scene("wagons")).text(DeckForm::Akispl);
    for word in [
        "Frame of",
        "Cross terms:",
        "IC:",
        "Units:",
        "VX..VZ",
        "Exponent",
        "Reactions:",
        "Range:",
        "Slope:",
    ] {
        let count = text
            .lines()
            .filter(|line| line.starts_with('!') && line.contains(word))
            .count();
        assert!(count >= 1, "{word}");
    }
    let text = Loaded::new(&example("bogie")).text(DeckForm::Akispl);
    assert_eq!(text.matches("Gap rate:").count(), 1);
    assert_eq!(text.matches("Cross terms:").count(), 1);
}

#[test]
fn look_ups_grow_as_the_forms_say() {
    // four wheels on one rail: N^2, 2 N^2; r products of N places, read once for loads, once for places, once for slopes
    let loaded = Loaded::new(&example("mill_girderway"));
    let wheels = 4;
    let of = |form, name: &str| {
        let text = loaded.text(form).replace("\n,", "").replace(' ', "");
        text.split("REQUEST/")
            .next()
            .map_or(0, |head| head.matches(name).count())
    };
    assert_eq!(of(DeckForm::Akispl, "AKISPL(VARVAL"), wheels * wheels);
    assert_eq!(
        of(DeckForm::Symmetrised, "AKISPL(VARVAL"),
        2 * wheels * wheels
    );
    let factored = of(DeckForm::Factored, "CUBSPL(VARVAL");
    assert_eq!(factored % (3 * wheels), 0);
    assert!(
        factored / (3 * wheels) <= 41,
        "no more products than stations: {factored}"
    );
}
