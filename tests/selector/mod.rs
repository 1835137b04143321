//! What "auto" chooses for crossings of girders, judged by runs of many modes at a fine accuracy.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use std::path::Path;

use formats::scene::Document;
use foundations::{distinct_specs, solve_specs};
use results::case_result::CaseResult;
use results::cases::simulate;
use results::columns::{HistoryColumn, NamedColumns};
use serde_json::{Value, json};
use sim::{Reason, Status};

/// Number of modes of a reference.
const MODES: usize = 144;
/// Accuracy of a reference.
const ACCURACY: f64 = 1e-7;

/// A crossing of a girder of one or more equal spans by a body on wheels.
#[derive(Clone, Copy)]
struct Crossing {
    spans: usize,
    theory: &'static str,
    /// Mass of the body by that of a span.
    mass: f64,
    /// Frequency of the body on its wheels by that of a span.
    frequency: f64,
    /// Speed by twice the length of a span times its frequency.
    speed: f64,
    wheels: usize,
    /// Distance of the outer wheels, of which there are two or more.
    base: f64,
    /// Damping of the wheels, and whether it acts against the rail.
    damper: (f64, bool),
    /// Damping of the girder.
    damping: f64,
    tolerance: f64,
}

const PLAIN: Crossing = Crossing {
    spans: 1,
    theory: "euler-bernoulli",
    mass: 0.5,
    frequency: 0.5,
    speed: 0.1,
    wheels: 2,
    base: 1.5,
    damper: (0.0, true),
    damping: 0.01,
    tolerance: 1e-2,
};

/// Crossings of every kind that take little time.
const QUICK: [Crossing; 11] = [
    Crossing {
        speed: 0.002,
        frequency: 0.2,
        damper: (0.1, false),
        ..PLAIN
    },
    Crossing {
        speed: 0.01,
        ..PLAIN
    },
    PLAIN,
    Crossing {
        speed: 0.4,
        mass: 5.0,
        ..PLAIN
    },
    Crossing {
        spans: 3,
        wheels: 4,
        damper: (0.05, true),
        ..PLAIN
    },
    Crossing {
        spans: 2,
        frequency: 3.0,
        tolerance: 1e-3,
        ..PLAIN
    },
    Crossing {
        mass: 0.03,
        frequency: 5.0,
        damper: (0.2, true),
        tolerance: 1e-3,
        ..PLAIN
    },
    Crossing {
        mass: 10.0,
        frequency: 2.0,
        damper: (0.1, true),
        ..PLAIN
    },
    Crossing {
        theory: "timoshenko",
        spans: 2,
        damper: (0.1, false),
        ..PLAIN
    },
    Crossing {
        theory: "timoshenko",
        wheels: 1,
        speed: 0.2,
        damping: 0.05,
        tolerance: 1e-3,
        ..PLAIN
    },
    // the waves of its start amplify each other: in four modes the wheels err by 1.2e-2 at equal times
    Crossing {
        mass: 13.7,
        frequency: 3.0,
        wheels: 8,
        base: 0.9,
        speed: 0.018,
        damping: 0.0235,
        ..PLAIN
    },
];

/// Modulus of elasticity, second moment of area, area, length of a span, gravity: SI units.
const E: f64 = 210e9;
const INERTIA: f64 = 6e-4;
const AREA: f64 = 0.02;
const SPAN: f64 = 8.0;
const GRAVITY: f64 = 9.81;

impl Crossing {
    fn spec(&self) -> Value {
        let ends = [0.0, self.spans as f64 * SPAN];
        let mut girder = json!({
            "spans": vec![SPAN; self.spans], "E": E, "G": 81e9, "A": AREA, "I_vertical": INERTIA,
            "I_lateral": 0.3 * INERTIA, "J": 0.1 * INERTIA, "mass_per_length": 7850.0 * AREA,
        });
        if self.theory == "timoshenko" {
            girder["kA_vertical"] = json!(0.4 * AREA);
        }
        json!({
            "format": "girderway-beam/1", "name": "g", "units": {"length": "m", "force": "N", "time": "s"},
            "theory": self.theory, "girder": girder, "stations": ends, "effects": [{"name": "mid", "x": 0.5 * SPAN}],
        })
    }

    fn scene(&self, accuracy: f64, structure: &Value) -> Value {
        let line = 7850.0 * AREA;
        let first = std::f64::consts::PI / (2.0 * SPAN * SPAN) * (E * INERTIA / line).sqrt();
        let (mass, speed) = (self.mass * line * SPAN, self.speed * 2.0 * SPAN * first);
        let stiffness = mass * (2.0 * std::f64::consts::PI * first * self.frequency).powi(2)
            / self.wheels as f64;
        let base = if self.wheels > 1 { self.base } else { 0.0 };
        let wheel = |k: usize| base * (k as f64 / (self.wheels - 1).max(1) as f64 - 0.5);
        let tree: Vec<f64> = (0..self.wheels).map(wheel).collect();
        let travel = self.spans as f64 * SPAN - base;
        let end = 0.999 * travel / speed;
        let mut own = json!({"spec": "spec.json", "damping": self.damping, "gauges": {"mid": {"x": 0.4 * SPAN}}});
        for (key, value) in structure.as_object().expect("an object") {
            own[key] = value.clone();
        }
        let (ratio, on_rail) = self.damper;
        let mut vertical = json!({"k": stiffness});
        if ratio > 0.0 {
            vertical["c"] = json!(2.0 * ratio * (stiffness * mass / self.wheels as f64).sqrt());
            vertical["damper"] = json!(if on_rail { "rail" } else { "ground" });
        }
        let mut body = json!({"mass": mass, "dof": ["y"], "x0": 0.5 * base});
        if self.wheels > 1 {
            body["dof"] = json!(["y", "pitch"]);
            body["inertia"] = json!([0.0, 0.0, 0.2 * mass * base * base]);
        }
        json!({
            "format": "girderway-scene/1", "name": "crossing", "units": {"length": "m", "force": "N", "time": "s"},
            "gravity": GRAVITY, "structures": {"g": own}, "bodies": {"A": body},
            "wheels": {"w": {"radius": 0.3, "vertical": vertical}},
            "trucks": [{"name": "t", "body": "A", "rail": "g.rail", "tree": tree, "wheel": "w"}],
            "motions": [{"body": "A", "dof": "x", "kind": "prescribed", "speed": [[0.0, speed]]}],
            "end": {"time": end}, "output": {"dt": end / 300.0}, "accuracy": accuracy,
        })
    }

    fn run(&self, folder: &Path, accuracy: f64, structure: &Value) -> CaseResult {
        let write = |name: &str, value: &Value| {
            std::fs::write(folder.join(name), value.to_string()).expect("a writable folder");
        };
        write("spec.json", &self.spec());
        write("scene.json", &self.scene(accuracy, structure));
        let document = Document::open(&folder.join("scene.json")).expect("a scene without faults");
        let known =
            solve_specs(&document, &distinct_specs(&document)).expect("a girder that stands");
        let result = simulate(&document, &known, Some(1), &|_| ())
            .expect("a scene that starts")
            .remove(0);
        assert_eq!(result.run.status, Status::Done);
        result
    }
}

/// Largest error of a column in a measure, by its range with zero included, or by 1e-3 of the largest range of its
/// dimension. An independent implementation: extremes over the run and over tenths of it, without windows that
/// overlap.
fn error(found: &NamedColumns, reference: &NamedColumns, measure: &str) -> (f64, String) {
    let range = |column: &HistoryColumn| {
        let start = if column.name.ends_with(".x") {
            column.values[0]
        } else {
            0.0
        };
        let [low, high] = extremes(&column.values, start);
        high - low
    };
    let of = |own: &HistoryColumn, other: &HistoryColumn| {
        let same = reference
            .columns
            .iter()
            .filter(|column| column.dimension == own.dimension);
        let largest = same
            .filter(|column| column.name != "time")
            .map(range)
            .fold(0.0, f64::max);
        let scale = range(other).max(1e-3 * largest);
        let pairs = || own.values.iter().zip(&other.values);
        let apart = match measure {
            "history" => pairs().fold(0.0, |most: f64, (a, b)| most.max((a - b).abs())),
            _ => {
                let [a, b] = [own, other].map(|column| extremes(&column.values, column.values[0]));
                (a[0] - b[0]).abs().max((a[1] - b[1]).abs())
            }
        };
        if scale > 0.0 { apart / scale } else { 0.0 }
    };
    let all = found
        .columns
        .iter()
        .zip(&reference.columns)
        .filter(|(own, _)| own.name != "time");
    let errors = all.map(|(own, other)| {
        assert_eq!(own.name, other.name);
        (of(own, other), own.name.clone())
    });
    errors.fold((0.0, String::new()), |worst, own| {
        if own.0 > worst.0 { own } else { worst }
    })
}

fn extremes(values: &[f64], start: f64) -> [f64; 2] {
    values.iter().fold([start; 2], |[low, high], value| {
        [low.min(*value), high.max(*value)]
    })
}

/// Each crossing is judged by the measure that it asked for.
#[test]
fn choices_keep_the_tolerance_for_every_recorded_quantity() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut doubted = Vec::new();
    for (index, crossing) in QUICK.iter().enumerate() {
        let reference = crossing.run(
            folder.path(),
            ACCURACY,
            &json!({"foundation": "modal", "modes": MODES}),
        );
        for measure in ["extremes", "history"] {
            let structure = json!({"tolerance": crossing.tolerance, "measure": measure});
            let result = crossing.run(folder.path(), 1e-4, &structure);
            let choice = &result.choices[0];
            let (error, column) = error(&result.columns, &reference.columns, measure);
            println!(
                "{index} {measure}: {:?}, {:?}, estimate {:?} of {}; error {error:.1e} of {column}",
                choice.fidelity, choice.reason, choice.estimate, choice.quantity
            );
            assert!(
                error <= crossing.tolerance,
                "{choice:?}: {error} of {column}"
            );
            if !matches!(choice.reason, Reason::Sufficient | Reason::Kept) {
                assert_eq!(choice.reason, Reason::NoBetter, "{choice:?}");
                doubted.push((index, measure));
            }
        }
    }
    // under a fast wheel the reactions of a shear-flexible beam converge like 1/n
    assert_eq!(doubted, [(9, "history")]);
}

/// Source: the runway of an engineer, HEB 400 over three spans under two undamped wheels of 180 kN. Modes and meshes show that
/// influence errs by 9e-3 in the extremes of the wheel forces: enough at 1e-2, not at 1e-3.
#[test]
fn influence_suffices_for_a_plain_runway() {
    let spec = json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
        "girder": {"spans": [6, 7.5, 6], "E": 2.1e8, "G": 8.1e7, "A": 0.01978, "I_vertical": 5.768e-4,
                   "I_lateral": 1.082e-4, "J": 3.557e-6, "kA_vertical": 0.007, "mass_per_length": 0.2115},
        "stations": [0, 3, 6, 9.75, 13.5, 16.5, 19.5],
    });
    let scene = json!({
        "format": "girderway-scene/1", "units": {"length": "m", "force": "kN", "time": "s"}, "gravity": 9.81,
        "structures": {"runway": {"spec": "spec.json"}},
        "bodies": {"carriage": {"weight": 360, "inertia": [0, 0, 120], "dof": ["x", "y", "pitch"], "x0": 1.8}},
        "wheels": {"w400": {"radius": 0.2, "vertical": {"k": 1e6}}},
        "trucks": [{"name": "carriage", "body": "carriage", "tree": [-1.8, 1.8], "wheel": "w400"}],
        "motions": [{"body": "carriage", "dof": "x", "kind": "prescribed",
                     "speed": [[0, 0], [3, 1.5], [10, 1.5], [13, 0]]}],
        "end": {"time": 14},
    });
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("spec.json"), spec.to_string()).expect("a writable folder");
    std::fs::write(folder.path().join("scene.json"), scene.to_string()).expect("a writable folder");
    let document = Document::open(&folder.path().join("scene.json")).expect("a valid scene");
    let known = solve_specs(&document, &distinct_specs(&document)).expect("a sound structure");
    let outcome = simulate(&document, &known, Some(1), &|_| ())
        .expect("a scene that starts")
        .remove(0);
    let choice = &outcome.choices[0];
    assert_eq!(choice.fidelity, sim::Fidelity::Influence, "{choice:?}");
    let estimate = choice.estimate.expect("an estimate");
    assert!((5e-3..1e-2).contains(&estimate), "{estimate:e}");
}
