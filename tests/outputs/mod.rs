//! Reactions, internal forces, envelopes and sag of whole runs against statics, equilibrium and closed forms.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use formats::scene::Document;
use foundations::{BuiltFoundation, ModeCache, MotionBasis, solve};
use foundations::{SolvedStructure, distinct_specs, solution_of};
use results::case_result::CaseResult;
use results::cases::simulate;
use results::response::RunComparison;
use serde_json::{Value, json};
use sim::Channel;
use splines::{Axis, Probe};

mod motion;
mod reactions;
mod statics;

/// Units, and a girder of the given spans with every stiffness and mass.
fn girder(spans: &[f64]) -> Value {
    let whole: f64 = spans.iter().sum();
    json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "N", "time": "s"},
        "theory": "euler-bernoulli",
        "girder": {"spans": spans, "E": 2.1e11, "G": 8.1e10, "A": 0.05, "I_vertical": 2e-3, "I_lateral": 3e-4,
                   "J": 1e-4, "mass_per_length": 400.0},
        "stations": [0.0, 0.25 * whole, 0.5 * whole, whole],
    })
}

/// One body of mass 8000 on `wheels` over the girder, prescribed at `speed`.
fn scene(wheels: &Value, speed: f64, end: f64, dt: f64) -> Value {
    json!({
        "format": "girderway-scene/1", "name": "outputs", "units": {"length": "m", "force": "N", "time": "s"},
        "gravity": 9.81,
        "structures": {"girder": {"spec": "spec.json", "foundation": "influence"}},
        "bodies": {"car": {"mass": 8000.0, "inertia": [0, 0, 9000], "dof": ["y", "pitch"], "x0": 1.5}},
        "wheels": {"steel": {"radius": 0.4, "vertical": {"law": "linear", "k": 2e7, "c": 2e4}}},
        "trucks": [{"name": "truck", "body": "car", "tree": wheels, "wheel": "steel"}],
        "motions": [{"body": "car", "dof": "x", "kind": "prescribed", "speed": [[0, speed]]}],
        "end": {"time": end}, "output": {"dt": dt}, "accuracy": 1e-5,
    })
}

/// A scene and its spec, run.
struct Ran {
    document: Document,
    known: Vec<SolvedStructure>,
    outcomes: Vec<CaseResult>,
}

fn run(scene: &Value, spec: &Value) -> Ran {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, value) in [("scene.json", scene), ("spec.json", spec)] {
        std::fs::write(folder.path().join(name), value.to_string()).expect("a file in it");
    }
    let document = Document::open(&folder.path().join("scene.json"))
        .unwrap_or_else(|wrong| panic!("{wrong:?}"));
    ran(document)
}

fn ran(document: Document) -> Ran {
    let known: Vec<SolvedStructure> = distinct_specs(&document)
        .into_iter()
        .map(|(_, _, spec)| SolvedStructure {
            spec: spec.clone(),
            solution: solve(spec).expect("it stands").into(),
        })
        .collect();
    let outcomes = simulate(&document, &known, Some(1), &|_| ()).expect("it runs");
    Ran {
        document,
        known,
        outcomes,
    }
}

impl Ran {
    fn column(&self, case: usize, name: &str) -> &[f64] {
        let values = self.outcomes[case].columns.values(name);
        assert!(!values.is_empty(), "no column {name}");
        values
    }

    /// Sum of the columns whose names end so.
    fn sum(&self, case: usize, ending: &str) -> Vec<f64> {
        let record = &self.outcomes[case].columns;
        let own: Vec<&Vec<f64>> = record
            .columns
            .iter()
            .filter(|column| column.name.starts_with("girder.") && column.name.ends_with(ending))
            .map(|column| &column.values)
            .collect();
        assert!(!own.is_empty(), "no column ends with {ending}");
        (0..own[0].len())
            .map(|i| own.iter().map(|values| values[i]).sum())
            .collect()
    }

    /// The foundation of the one structure of a case, laid again.
    fn laid(&self, case: usize) -> BuiltFoundation {
        let structure = &self.document.cases[case].scene.structures[0];
        foundations::build(
            &mut ModeCache::default(),
            structure,
            solution_of(&self.known, &structure.origin),
            false,
        )
        .expect("a foundation")
    }
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values
        .into_iter()
        .fold(0.0, |most, value| most.max(value.abs()))
}
