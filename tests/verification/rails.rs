//! Uneven rails, rails that give along x and prescribed spins, from scene files against closed forms.

use std::fs;
use std::sync::Arc;

use formats::scene::Document;
use foundations::solve;
use foundations::{SolvedStructure, distinct_specs};
use results::case_result::CaseResult;
use results::cases::simulate;

const GIRDER: &str = r#"{"format": "girderway-beam/1", "units": {"length": "m", "force": "N", "time": "s"},
    "girder": {"spans": [40], "E": 2e11, "A": 0.01, "I_vertical": 1e-3}, "stations": [0, 20, 40]}"#;

/// Runs a scene on the girder, `survey.csv` beside it: members of its structure, its body's freedoms, other members of its
/// wheels, and members of the scene.
fn run(structure: &str, dof: &str, wheel: &str, scene: &str, survey: &str) -> CaseResult {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("scene.json");
    let text = format!(
        r#"{{"format": "girderway-scene/1", "units": {{"length": "m", "force": "N", "time": "s"}}, "gravity": 9.80665,
        "structures": {{"bridge": {{"spec": "girder.json", {structure}}}}},
        "bodies": {{"cart": {{"mass": 100, "dof": [{dof}], "x0": 10}}}},
        "wheels": {{"wheel": {{"radius": 0.4, "vertical": {{"k": 4e4}} {wheel}}}}},
        "trucks": [{{"body": "cart", "wheel": "wheel"}}], {scene}, "accuracy": 1e-9}}"#
    );
    fs::write(&path, text).expect("room for a scene");
    fs::write(folder.path().join("girder.json"), GIRDER).expect("room for a spec");
    fs::write(folder.path().join("survey.csv"), survey).expect("room for a survey");
    let document = Document::open(&path).expect("a sound scene");
    let known: Vec<SolvedStructure> = distinct_specs(&document)
        .into_iter()
        .map(|(_, _, spec)| SolvedStructure {
            spec: Arc::clone(spec),
            solution: Arc::new(solve(spec).expect("it stands")),
        })
        .collect();
    simulate(&document, &known, None, &|_| ())
        .expect("runs")
        .remove(0)
}

fn column(outcome: &CaseResult, name: &str) -> Vec<f64> {
    let values = outcome.columns.values(name);
    assert!(!values.is_empty(), "there is a column {name}");
    values.to_vec()
}

/// The cart carried at 3 m/s from 10 m over a rigid rail with these irregularities.
fn carried(irregularities: &str, survey: &str) -> CaseResult {
    let structure = format!(r#""foundation": "rigid", "irregularities": [{irregularities}]"#);
    let scene = r#""motions": [{"body": "cart", "dof": "x", "kind": "prescribed", "speed": [[0, 3]]}], "end": {"time": 6}"#;
    run(&structure, r#""y""#, "", scene, survey)
}

#[test]
fn sinusoid_and_its_survey_drive_a_cart_as_the_closed_form_says() {
    // Analytic: m y'' = k (a sin(w t) - y) from rest where the waves begin, at 13 m.
    let (a, length, omega) = (0.002, 2.5, 20.0_f64);
    let w = std::f64::consts::TAU * 3.0 / length;
    let wave = r#"{"kind": "sinusoid", "amplitude": 0.002, "length": 2.5, "range": [13, 40]}"#;
    let rows: String = (0..=2700)
        .map(|i| {
            let x = f64::from(i) / 100.0;
            format!(
                "{};{}\n",
                13.0 + x,
                2.0 * (std::f64::consts::TAU * x / length).sin()
            )
        })
        .collect();
    let survey = format!("# levels in mm\nplace;level\n{rows}");
    let file = r#"{"kind": "profile", "file": "survey.csv", "columns": ["place", "level"], "scale": 0.001}"#;
    for (given, tolerance) in [(wave, 1e-6), (file, 3e-4)] {
        let outcome = carried(given, &survey);
        let (t, y) = (
            column(&outcome, "time"),
            column(&outcome, "cart.deflection"),
        );
        let mut worst = 0.0_f64;
        for (t, y) in t.iter().zip(&y) {
            let since = (t - 1.0).max(0.0);
            let swing = a * omega * (omega * (w * since).sin() - w * (omega * since).sin());
            worst = worst.max((y - y_rest() + swing / (omega * omega - w * w)).abs());
        }
        println!("sinusoid: {:.1e} of its amplitude", worst / a);
        assert!(worst < tolerance * a, "{worst:e}");
    }
}

fn y_rest() -> f64 {
    100.0 * 9.80665 / 4e4
}

#[test]
fn kinds_of_irregularities_are_sums_of_profiles() {
    let kinds = r#"{"kind": "step", "x": 15, "height": 0.001}, {"kind": "joint", "x": 20, "depth": 0.002, "length": 1}"#;
    let rows = r#"{"kind": "profile", "rows": [[15, 0], [15, 0.001], [19.5, 0.001], [20, -0.001], [20.5, 0.001]]}"#;
    let [kinds, rows] = [kinds, rows].map(|given| column(&carried(given, ""), "cart.deflection"));
    let largest = kinds
        .iter()
        .zip(&rows)
        .fold(0.0_f64, |max, (a, b)| max.max((a - b).abs()));
    assert!(largest < 1e-12, "{largest:e}");
    // A dip leaves nothing behind but the swing that it gave.
    let dip = carried(
        r#"{"kind": "dip", "x": 20, "depth": 0.002, "length": 6}"#,
        "",
    );
    let deepest = column(&dip, "cart.deflection")
        .iter()
        .fold(0.0_f64, |max, y| max.max(*y));
    assert!((deepest - y_rest()) > 0.0019 && (deepest - y_rest()) < 0.0022);
}

#[test]
fn braked_cart_stretches_its_girder_from_the_support_that_holds_it() {
    let structure = r#""foundation": "influence", "longitudinal": true,
        "gauges": {"shift": {"x": 8, "direction": "longitudinal"}}"#;
    let wheel = r#", "friction": {"law": "coulomb", "mu": 0.2, "slip": 0.02}, "braked": true"#;
    let pulled = r#""motions": [{"body": "cart", "dof": "x", "kind": "free", "brake": 0}],
        "loads": [{"body": "cart", "dof": "x", "value": [[0, 0], [1, 150]]}], "end": {"time": 3}"#;
    let outcome = run(structure, r#""x", "y""#, wheel, pulled, "");
    // Analytic: the brake hands the load to the rail, which stretches by P x/EA up to the gauge; the slope of the
    // deflected girder adds N^2 a b (b - a)/(3 EI L) to the load.
    let slope = (100.0_f64 * 9.80665).powi(2) * 10.0 * 30.0 * 20.0 / (3.0 * 2e8 * 40.0);
    let found = column(&outcome, "bridge.shift");
    let expected = (150.0 + slope) * 8.0 / (2e11 * 0.01);
    let last = found.last().copied().expect("rows");
    println!("shift {last:e} of {expected:e}");
    assert!((last / expected - 1.0).abs() < 1e-5);
}

#[test]
fn spin_of_a_wheel_takes_the_cart_along() {
    let wheel = r#", "friction": {"mu": 0.3, "slip": 0.001}, "spin_inertia": 2"#;
    let scene = r#""motions": [{"dof": "spin", "kind": "prescribed", "speed": [[0, 0], [4, -20]]}], "end": {"time": 3}"#;
    let outcome = run(r#""foundation": "rigid""#, r#""x", "y""#, wheel, scene, "");
    // Analytic: v = -h omega - s, s = 2 slip sin(asin(m a / mu N) / 3); the moment -(I alpha + h m a).
    let arm = 0.4 - y_rest();
    let acceleration = 5.0 * arm;
    let slide = 0.002 * ((acceleration / (0.3 * 9.80665)).asin() / 3.0).sin();
    let last = |name: &str| column(&outcome, name).last().copied().expect("rows");
    assert!((last("cart.speed") - (15.0 * arm - slide)).abs() < 1e-8);
    assert!((last("cart.truck1.wheel1.spin_speed") + 15.0).abs() < 1e-12);
    let moment = -2.0 * 5.0 - arm * 100.0 * acceleration;
    assert!((last("cart.truck1.wheel1.moment") / moment - 1.0).abs() < 1e-6);
}
