//! Decks of scenes: what stands in them, and that executing them gives the simulator's forces.

mod commands;
mod form;
mod mutations;
mod random;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use adams::DataSet;
use deck::check::{CheckReport, check};
use deck::{DeckForm, deck, plan};
use formats::scene::Document;
use foundations::{SolvedStructure, distinct_specs};

/// Forms that are right; the paper's is not meant to be.
const FORMS: [DeckForm; 3] = [DeckForm::Akispl, DeckForm::Symmetrised, DeckForm::Factored];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn example(name: &str) -> PathBuf {
    root().join("examples").join(name).join("scene.json")
}

/// A scene of these tests: `crane` on two coupled rails with flanges and spins, `wagons` on two structures in inches and
/// kip, `printed` on tables of values, `stiff` with wheels that are stiff compared with their rail.
fn scene(name: &str) -> PathBuf {
    root()
        .join("tests/deck/scenes")
        .join(name)
        .with_extension("json")
}

/// A scene with its structures solved.
struct Loaded {
    document: Document,
    known: Vec<SolvedStructure>,
}

impl Loaded {
    fn new(path: &Path) -> Loaded {
        let document = Document::open(path).expect("a valid scene");
        let solve = |spec: &Arc<_>| SolvedStructure {
            spec: Arc::clone(spec),
            solution: Arc::new(foundations::solve(spec).expect("a structure that stands")),
        };
        let known = distinct_specs(&document)
            .into_iter()
            .map(|(_, _, spec)| solve(spec))
            .collect();
        Loaded { document, known }
    }

    fn text(&self, form: DeckForm) -> String {
        let plan = plan(self.document.scene(), &self.known, form, "scene.json").expect("a plan");
        deck(&plan, &self.known, "model")
            .expect("a deck")
            .set
            .write()
            .expect("a text")
    }

    /// The check of `text` as the deck in `form`.
    fn check(&self, form: DeckForm, text: &str, states: usize) -> CheckReport {
        let plan = plan(self.document.scene(), &self.known, form, "scene.json").expect("a plan");
        check(&plan, text, states).expect("a deck that can be executed")
    }
}

/// Checks every form; returns the tables.
fn holds(path: &Path, states: usize) -> String {
    let mut all = String::new();
    let loaded = Loaded::new(path);
    for form in FORMS {
        let report = loaded.check(form, &loaded.text(form), states);
        let lines = report.lines().join("\n");
        all.push_str(&format!("{} {form:?}\n{lines}\n", path.display()));
        assert!(report.holds(), "{} {form:?}\n{lines}", path.display());
        assert_eq!(report.states.all, states);
        assert!(
            report.states.loaded < states,
            "some wheels are off their rails"
        );
    }
    all
}

#[test]
fn decks_of_the_wheel_give_the_simulators_forces() {
    holds(&example("wheel"), 1000);
}

#[test]
fn decks_of_the_bogie_give_the_simulators_forces_and_path() {
    holds(&example("bogie"), 1000);
}

#[test]
fn decks_of_the_mill_give_the_simulators_forces_and_path() {
    holds(&example("mill_girderway"), 1000);
}

#[test]
fn decks_on_two_coupled_rails_give_the_simulators_forces() {
    holds(&scene("crane"), 200);
}

#[test]
fn decks_of_two_structures_give_the_simulators_forces_and_path() {
    holds(&scene("wagons"), 300);
}

#[test]
fn decks_on_printed_tables_give_the_simulators_forces_and_path() {
    holds(&scene("printed"), 300);
}

/// The scene of stiff wheels with another stiffness and damping, kN/m and kN s/m; no damper where `c` is zero.
fn stiff(folder: &Path, k: f64, c: f64) -> PathBuf {
    let text = std::fs::read_to_string(scene("stiff")).expect("the scene");
    let mut value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let law = &mut value["wheels"]["w400"]["vertical"];
    law["k"] = k.into();
    if c > 0.0 {
        law["c"] = c.into();
        law["damper"] = "rail".into();
    }
    let spec = root().join("tests/deck/scenes/stiff_runway.json");
    value["structures"]["runway"]["spec"] = spec.to_str().expect("a path in UTF-8").into();
    let path = folder.join("scene.json");
    std::fs::write(&path, value.to_string()).expect("a temporary file");
    path
}

/// The roll of a crane at rest depends on the height at which its flanges press: radius less penetration.
#[test]
fn decks_of_flanges_that_press_at_rest_have_the_simulators_equilibria() {
    let text = std::fs::read_to_string(scene("crane")).expect("the scene");
    let mut value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let spec = root().join("tests/deck/scenes/floor.json");
    value["structures"]["floor"]["spec"] = spec.to_str().expect("a path in UTF-8").into();
    value["wheels"]["flanged"]["lateral"]["clearance"] = 0.0.into();
    value["motions"] = serde_json::json!([
        {"body": "crane", "dof": "x", "kind": "prescribed", "speed": [[0, 0.5]]}
    ]);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("scene.json");
    std::fs::write(&path, value.to_string()).expect("a temporary file");
    let loaded = Loaded::new(&path);
    for form in FORMS {
        let report = loaded.check(form, &loaded.text(form), 100);
        let lines = report.lines().join("\n");
        assert!(report.path.is_some(), "{form:?}\n{lines}");
        assert!(report.holds(), "{form:?}\n{lines}");
    }
}

/// Stiffnesses and dampings of its wheels, kN/m and kN s/m.
const STIFFNESSES: [f64; 5] = [1e5, 2e5, 4e5, 7e5, 1e6];
const DAMPINGS: [f64; 3] = [0.0, 20.0, 200.0];

/// Wheels of 1e5 to 1e6 kN/m on a runway that deflects by up to a hundred of their penetrations.
#[test]
fn decks_of_stiff_wheels_give_the_simulators_forces_and_path() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for k in STIFFNESSES {
        for c in DAMPINGS {
            holds(&stiff(folder.path(), k, c), 100);
        }
    }
}

/// Among 4000 states one in a thousand has a wheel within some micrometres of a support.
#[test]
fn decks_of_stiff_wheels_with_dampers_give_the_simulators_forces_beside_supports() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    holds(&stiff(folder.path(), 1e5, 20.0), 4000);
}

#[test]
#[cfg_attr(
    not(feature = "nightly"),
    ignore = "slow: 10^4 states of every scene in every form"
)]
fn decks_give_the_simulators_forces_at_ten_thousand_states() {
    for path in [
        example("wheel"),
        example("bogie"),
        example("mill_girderway"),
    ] {
        println!("{}", holds(&path, 10_000));
    }
    for name in ["crane", "wagons", "printed"] {
        println!("{}", holds(&scene(name), 10_000));
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    for k in STIFFNESSES {
        for c in DAMPINGS {
            println!(
                "k = {k:e}, c = {c}\n{}",
                holds(&stiff(folder.path(), k, c), 10_000)
            );
        }
    }
}

#[test]
fn random_states_have_everything_that_can_act() {
    let loaded = Loaded::new(&scene("crane"));
    let count = loaded
        .check(DeckForm::Akispl, &loaded.text(DeckForm::Akispl), 100)
        .states;
    assert!(
        count.loaded > 5 && count.flange > 50 && count.slide > 50,
        "{count:?}"
    );
}

#[test]
fn decks_start_in_the_equilibrium_of_their_first_instant() {
    for path in [
        example("bogie"),
        example("mill_girderway"),
        scene("wagons"),
        scene("printed"),
    ] {
        let loaded = Loaded::new(&path);
        for form in FORMS {
            let set = DataSet::read(&loaded.text(form)).expect("our own text");
            let model = adams::AdamsModel::new(&set).expect("a model");
            let start = model.initial();
            let rest = model
                .equilibrium(0.0, &start)
                .expect("an equilibrium")
                .state;
            for (part, pose) in &start.parts {
                let moved = (rest.parts[part].origin - pose.origin).norm();
                // of a radius of 1 to 15: finite rotations against small ones
                assert!(
                    moved < 2e-5,
                    "{} {form:?} PART/{part}: {moved:e}",
                    path.display()
                );
            }
            for (id, gap) in &start.differentials {
                let moved = (rest.differentials[id] / gap - 1.0).abs();
                assert!(
                    moved < 1e-4,
                    "{} {form:?} DIFF/{id}: {moved:e}",
                    path.display()
                );
            }
        }
    }
}

#[test]
fn the_papers_form_is_told_from_the_simulator() {
    let loaded = Loaded::new(&example("bogie"));
    let report = loaded.check(DeckForm::Paper, &loaded.text(DeckForm::Paper), 100);
    assert!(!report.holds());
    // the cross terms alone put the forces off by more than a hundredth of the largest
    assert!(report.forces[0].largest_of_all() > 0.01);
}
