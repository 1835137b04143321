//! Decks of random scenes with one number changed, beside what `random_checks.py` finds in them.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::{Loaded, root};
use deck::DeckForm;

/// States of each check.
const STATES: usize = 300;

fn form(word: &str) -> DeckForm {
    match word {
        "akispl" => DeckForm::Akispl,
        "symmetrised" => DeckForm::Symmetrised,
        _ => DeckForm::Factored,
    }
}

/// Writes decks of `scenes` random scenes with one number changed into `folder`.
fn write_changed(folder: &Path, scenes: usize, seed: usize) {
    let run = Command::new("python3")
        .arg(root().join("tests/deck/random_checks.py"))
        .arg(env!("CARGO_BIN_EXE_girderway"))
        .arg("--changed")
        .arg(folder)
        .args(["--scenes", &scenes.to_string(), "--seed", &seed.to_string()])
        .output()
        .expect("Python starts");
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success(), "{said}");
}

/// A deck whose forces, places or weights differ by the evaluation in Python does not pass, and the report names what is
/// wrong in it. The deck without the change passes.
#[test]
#[cfg_attr(
    not(feature = "nightly"),
    ignore = "slow: several decks of each of a hundred random scenes; needs Python"
)]
fn a_number_changed_in_a_deck_of_a_random_scene_is_caught() {
    let number = |name: &str, default| {
        std::env::var(name).map_or(default, |text| text.parse().expect("a number"))
    };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scenes = number("GIRDERWAY_DECK_SCENES", 100);
    write_changed(folder.path(), scenes, number("GIRDERWAY_DECK_SEED", 1));
    let (mut caught, mut unseen, mut wrong) = (0, 0, Vec::new());
    for entry in fs::read_dir(folder.path()).expect("the folder") {
        let own = entry.expect("an entry").path();
        let Ok(text) = fs::read_to_string(own.join("changed.json")) else {
            continue;
        };
        let listed: Value = serde_json::from_str(&text).expect("JSON");
        let form = form(listed["form"].as_str().expect("a word"));
        let loaded = Loaded::new(&own.join("scene.json"));
        let at = own.file_name().expect("a name").to_string_lossy();
        let right = loaded.check(form, &loaded.text(form), STATES);
        if !right.holds() {
            wrong.push(format!("{at}, unchanged: {}", right.lines().join("\n")));
            continue;
        }
        for one in listed["decks"].as_array().expect("a list") {
            let text = |key: &str| one[key].as_str().expect("a word");
            let changed = fs::read_to_string(own.join(text("deck"))).expect("a deck");
            let report = loaded.check(form, &changed, STATES);
            if one["differs"] == false {
                unseen += 1;
                continue;
            }
            caught += 1;
            let says = report.lines().iter().any(|line| line.contains("deck: "));
            let moves = report
                .path
                .as_ref()
                .is_some_and(|path| !path.causes.is_empty());
            if report.holds() || !(says || moves) {
                wrong.push(format!(
                    "{at}, {form:?}, {}, {}:\n{}",
                    text("kind"),
                    text("what"),
                    report.lines().join("\n")
                ));
            }
        }
    }
    println!("{caught} decks that differ, {unseen} that do not by the evaluation in Python");
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
    assert!(caught > scenes, "{caught} of {scenes} scenes");
}
