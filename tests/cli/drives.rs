//! Scenes with loads, drives and brakes.

use std::fs;

use super::{example, folder, girderway, json, text};

/// The bogie on a rigid rail: driven wheels of mu 0.2, brakes from 4 s, in the units given; `more` joins the scene.
fn scene(units: &str, length: f64, force: f64, more: &str) -> String {
    let of = |value: f64, factor: f64| value * factor;
    format!(
        r#"{{"format": "girderway-scene/1", "name": "driven", "units": {units}, "gravity": {gravity},
 "structures": {{"girder": {{"spec": "spec.json", "foundation": "rigid"}}}},
 "bodies": {{"bogie": {{"weight": {weight}, "dof": ["x", "y"]}}}},
 "wheels": {{"crane": {{"radius": {length}, "vertical": {{"k": {k}}}, "friction": {{"mu": 0.2, "slip": {slip}}},
   "driven": true, "braked": true}}}},
 "trucks": [{{"name": "truck", "tree": [{left}, {length}]}}],
 "motions": [{{"body": "bogie", "dof": "x", "kind": "drive", "speed": [[0, {speed}]], "gain": {gain}, "brake": 4}}],
 {more} "end": {{"time": 6}}, "output": {{"dt": 0.5}}, "accuracy": 1e-7}}"#,
        gravity = of(32.174, length),
        weight = of(4.8e6, force),
        k = of(1e8, force / length),
        slip = of(0.1, length),
        left = of(-1.0, length),
        speed = of(5.0, length),
        gain = of(1e7, force / length),
    )
}

const FEET: &str = r#"{"length": "ft", "force": "lbf", "time": "s"}"#;
const METRES: &str = r#"{"length": "m", "force": "N", "time": "s"}"#;

/// Columns x, drive and brake of a run.
fn run(scene: &str) -> Vec<[f64; 3]> {
    let folder = folder();
    fs::copy(
        example("bogie").join("spec.json"),
        folder.path().join("spec.json"),
    )
    .expect("a copy");
    fs::write(folder.path().join("scene.json"), scene).expect("written");
    let run = girderway(&folder, &["run", "scene.json", "-o", "out"]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    let summary = json(&fs::read(folder.path().join("out/summary.json")).expect("a summary"));
    assert!(
        summary["energy"]["put_in"]
            .as_f64()
            .is_some_and(|work| work > 0.0)
    );
    let history = fs::read_to_string(folder.path().join("out/history.csv")).expect("a history");
    let mut lines = history.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let columns = ["bogie.x", "bogie.drive", "bogie.brake"].map(|name| {
        header
            .iter()
            .position(|column| *column == name)
            .expect("a column")
    });
    let row = |line: &str| {
        let values: Vec<f64> = line
            .split(',')
            .map(|value| value.parse().expect("a number"))
            .collect();
        columns.map(|column| values[column])
    };
    lines.map(row).collect()
}

#[test]
fn driven_bogie_starts_at_its_traction_and_its_brake_stops_it() {
    let rows = run(&scene(FEET, 1.0, 1.0, ""));
    // Analytic: mu W until gain (v_ref - v) falls below it, v = mu g t.
    assert!((rows[1][1] / 9.6e5 - 1.0).abs() < 1e-6, "{:?}", rows[1]);
    assert!(
        (rows[1][0] - 0.5 * 0.2 * 32.174 * 0.25).abs() < 1e-6,
        "{:?}",
        rows[1]
    );
    // v0^2 / 2 mu g from 5 ft/s, and what tanh adds.
    let stop = rows[12][0] - rows[8][0];
    assert!((stop - 25.0 / (2.0 * 0.2 * 32.174)).abs() < 2e-4, "{stop}");
    assert_eq!(rows[9][1], 0.0);
    assert!((rows[9][2] / 9.6e5 + 1.0).abs() < 1e-6, "{:?}", rows[9]);
}

#[test]
fn units_of_a_scene_change_nothing_of_its_drive_and_brake() {
    let (feet, metres) = (
        run(&scene(FEET, 1.0, 1.0, "")),
        run(&scene(METRES, 0.3048, 4.448_221_615_260_5, "")),
    );
    for (feet, metres) in feet.iter().zip(&metres) {
        assert!(
            (feet[0] * 0.3048 - metres[0]).abs() < 1e-6,
            "{feet:?} {metres:?}"
        );
        assert!(
            (feet[2] * 4.448_221_615_260_5 - metres[2]).abs() < 50.0,
            "{feet:?} {metres:?}"
        );
    }
}

#[test]
fn load_along_the_rail_pushes_beside_the_drive() {
    let load = r#""loads": [{"body": "bogie", "dof": "x", "value": [[0, 1e5]]}],"#;
    let rows = run(&scene(FEET, 1.0, 1.0, load));
    // Analytic: (mu W + F) / m.
    let wanted = 0.5 * (0.2 + 1e5 / 4.8e6) * 32.174 * 0.25;
    assert!((rows[1][0] - wanted).abs() < 1e-6, "{:?}", rows[1]);
}

#[test]
fn decks_refuse_drives_brakes_and_loads_by_name() {
    let drive = r#""kind": "drive", "speed": [[0, 5]], "gain": 10000000, "brake": 4"#;
    let given = scene(FEET, 1.0, 1.0, "");
    let load = r#""loads": [{"body": "bogie", "dof": "y", "value": [[0, 1]]}], "end""#;
    for (given, what) in [
        (given.clone(), "drive"),
        (
            given.replace(drive, r#""kind": "free", "brake": 4"#),
            "brake",
        ),
        (
            given
                .replace(drive, r#""kind": "free""#)
                .replace("\"end\"", load),
            "load",
        ),
    ] {
        let folder = folder();
        fs::copy(
            example("bogie").join("spec.json"),
            folder.path().join("spec.json"),
        )
        .expect("a copy");
        fs::write(folder.path().join("scene.json"), given).expect("written");
        let run = girderway(&folder, &["deck", "scene.json"]);
        assert_eq!(run.status.code(), Some(2));
        let wanted = format!("body \"bogie\": decks do not support {what}s");
        assert!(text(&run.stderr).contains(&wanted), "{}", text(&run.stderr));
        assert!(run.stdout.is_empty());
    }
}
