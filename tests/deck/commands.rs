//! The command line of decks.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

use super::{example, scene};

fn girderway(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(arguments)
        .output()
        .expect("the program starts")
}

fn path(path: &Path) -> &str {
    path.to_str().expect("a path in UTF-8")
}

#[test]
fn without_a_file_the_data_set_alone_goes_to_standard_output() {
    let run = girderway(&["deck", path(&example("bogie"))]);
    assert_eq!(run.status.code(), Some(0));
    let text = String::from_utf8(run.stdout).expect("text");
    assert!(
        text.starts_with("bogie: 2 wheels, form factored\n") && text.ends_with("END\n"),
        "{text}"
    );
}

#[test]
fn a_file_has_its_command_file_beside_it() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("crossing.adm");
    let run = girderway(&[
        "deck",
        path(&example("bogie")),
        "-o",
        path(&file),
        "--form",
        "akispl",
    ]);
    assert_eq!(
        run.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&run.stderr)
    );
    assert!(run.stdout.is_empty());
    let commands = fs::read_to_string(folder.path().join("crossing.acf")).expect("a command file");
    assert_eq!(
        commands,
        "file/model=crossing\nSIMULATE/DYNAMIC, END=12.0, DTOUT=0.02\nstop\n"
    );
    assert!(
        fs::read_to_string(&file)
            .expect("a data set")
            .contains("AKISPL(")
    );
}

#[test]
fn a_check_says_what_it_found_and_its_status_whether_that_is_enough() {
    let bogie = example("bogie");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("b.adm");
    let run = girderway(&[
        "deck",
        path(&bogie),
        "-o",
        path(&file),
        "--check",
        "--states",
        "50",
        "--json",
    ]);
    assert_eq!(
        run.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&run.stderr)
    );
    let report: Value = serde_json::from_slice(&run.stdout).expect("JSON");
    assert_eq!(report["holds"], true);
    // random states, and the 41 positions of the path at rest
    assert_eq!(report["forces"][0]["states"], 50 + 41);
    let paper = [
        "deck",
        path(&bogie),
        "-o",
        path(&file),
        "--form",
        "paper",
        "--check",
        "--states",
        "50",
    ];
    let run = girderway(&paper);
    assert_eq!(run.status.code(), Some(1));
    let told = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(told.contains("forces at random states"));
    // with the near-diagonal for cross terms the presses of its wheels are others, and are named
    for part in [
        "deck: VARIABLE/105 (truck_wheel1_press) gives down",
        "the equilibrium of the simulator is none of the deck",
    ] {
        assert!(told.contains(part), "{told}");
    }
}

#[test]
fn coulomb_friction_is_a_tanh_of_the_slip_in_every_form() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::copy(scene("floor"), folder.path().join("floor.json")).expect("a copy");
    let step = fs::read_to_string(scene("crane")).expect("a scene");
    let coulomb = step.replace(
        r#""friction": {"law": "step""#,
        r#""friction": {"law": "coulomb""#,
    );
    assert_ne!(coulomb, step);
    let [from, file] = ["scene.json", "crane.adm"].map(|name| folder.path().join(name));
    fs::write(&from, coulomb).expect("written");
    for form in ["akispl", "symmetrised", "factored"] {
        let run = girderway(&[
            "deck",
            path(&from),
            "-o",
            path(&file),
            "--form",
            form,
            "--check",
            "--states",
            "20",
            "--json",
        ]);
        assert_eq!(
            run.status.code(),
            Some(0),
            "{form}: {}",
            String::from_utf8_lossy(&run.stderr)
        );
        let report: Value = serde_json::from_slice(&run.stdout).expect("JSON");
        assert_eq!(report["holds"], true);
        // Three wheels of the crane have friction.
        let deck = fs::read_to_string(&file).expect("a data set");
        assert_eq!(deck.matches("TANH(").count(), 3, "{form}");
    }
}

#[test]
fn foundations_that_a_deck_cannot_have_are_refused_by_name() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let spec = fs::read_to_string(example("bogie").with_file_name("spec.json")).expect("a spec");
    let spec = spec.replacen("\"E\":", "\"mass_per_length\": 10, \"E\":", 1);
    fs::write(folder.path().join("spec.json"), spec).expect("written");
    let text = fs::read_to_string(example("bogie")).expect("a scene");
    for word in ["parts", "modal"] {
        let text = text.replacen(
            "\"foundation\": \"influence\"",
            &format!("\"foundation\": \"{word}\""),
            1,
        );
        let mut object: Value = serde_json::from_str(&text).expect("JSON");
        object.as_object_mut().expect("an object").remove("compare");
        let file = folder.path().join("scene.json");
        fs::write(&file, object.to_string()).expect("written");
        let run = girderway(&["deck", path(&file)]);
        let told = String::from_utf8_lossy(&run.stderr).into_owned();
        assert_eq!(run.status.code(), Some(2), "{told}");
        assert!(run.stdout.is_empty());
        assert!(
            told.contains("structure \"girder\"") && told.contains("hint: use \"influence\""),
            "{told}"
        );
    }
}

#[test]
fn a_scene_read_by_akispl_has_its_deck_so() {
    let run = girderway(&["deck", path(&scene("printed"))]);
    assert_eq!(
        run.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&run.stderr)
    );
    assert!(String::from_utf8_lossy(&run.stdout).starts_with("printed: 2 wheels, form akispl\n"));
}

#[test]
fn a_data_set_must_have_its_ending() {
    let run = girderway(&["deck", path(&example("bogie")), "-o", "bogie.acf"]);
    assert_eq!(run.status.code(), Some(2));
    assert!(
        String::from_utf8_lossy(&run.stderr).contains("output file must have the extension .adm")
    );
}
