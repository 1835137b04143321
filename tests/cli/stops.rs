//! Scenes with end stops and floors.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use super::{example, folder, girderway, json, text};

const SCENE: &str = r#"{"format": "girderway-scene/1", "name": "stops", "units": {"length": "ft", "force": "lbf", "time": "s"},
 "gravity": 32.174, "structures": {"girder": {"spec": "spec.json", "foundation": "rigid"}},
 "bodies": {"bogie": {"weight": 4.8e6, "dof": ["x", "y"], "x0": 30, "v0": 5}, "ladle": {"weight": 1e6, "dof": ["X", "Y", "Z"], "start": {"y": 10}}},
 "wheels": {"crane": {"radius": 1.25, "vertical": {"k": 1e8}}},
 "trucks": [{"name": "truck", "body": "bogie", "tree": [-1, 1]}],
 "stops": [{"rail": "girder.rail", "x": 41, "k": 1e6}, {"rail": "girder.rail", "x": 19, "k": 1e6},
  {"name": "floor", "body": "ladle", "Y": -1, "k": 1e7}],
 "end": {"time": 8}, "output": {"dt": 0.001}, "accuracy": 1e-7}"#;

/// Folder, summary and messages of a run of `scene` on the girder of the bogie.
fn ran(scene: &str) -> (TempDir, Value, String) {
    let folder = folder();
    fs::copy(
        example("bogie").join("spec.json"),
        folder.path().join("spec.json"),
    )
    .expect("a copy");
    fs::write(folder.path().join("scene.json"), scene).expect("written");
    let run = girderway(&folder, &["run", "scene.json", "-o", "out"]);
    let told = text(&run.stderr).to_owned();
    assert_eq!(run.status.code(), Some(0), "{told}");
    let summary = json(&fs::read(folder.path().join("out/summary.json")).expect("a summary"));
    (folder, summary, told)
}

/// Columns of a run of [`SCENE`].
fn columns(names: [&str; 5]) -> [Vec<f64>; 5] {
    let (folder, summary, _) = ran(SCENE);
    assert!(
        summary["energy"]["residual"]
            .as_f64()
            .is_some_and(|left| left < 2e-7),
        "{summary}"
    );
    let history = fs::read_to_string(folder.path().join("out/history.csv")).expect("a history");
    let mut lines = history.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let rows: Vec<Vec<f64>> = lines
        .map(|line| {
            line.split(',')
                .map(|value| value.parse().expect("a number"))
                .collect()
        })
        .collect();
    names.map(|name| {
        let at = header
            .iter()
            .position(|column| *column == name)
            .expect("a column");
        rows.iter().map(|row| row[at]).collect()
    })
}

/// Analytic: the foremost wheel is 1 ft ahead, so the bogie meets the stop at x = 40 after 2 s, stays for half a period
/// pi sqrt(m/k), presses with v sqrt(m k), and comes back to the other stop; the ladle falls 11 ft onto its floor.
#[test]
fn a_bogie_runs_between_its_stops_and_a_ladle_drops_on_its_floor() {
    let [time, x, ahead, behind, floor] = columns([
        "time",
        "bogie.x",
        "stop1.force",
        "stop2.force",
        "floor.force",
    ]);
    let (mass, k) = (4.8e6 / 32.174, 1e6_f64);
    let stay = std::f64::consts::PI * (mass / k).sqrt();
    for (force, met) in [(&ahead, 2.0), (&behind, 2.0 + stay + 4.0)] {
        let first = force
            .iter()
            .position(|force| *force > 0.0)
            .expect("a meeting");
        assert!((time[first] - met).abs() < 2e-3, "{} {met}", time[first]);
    }
    let most = ahead.iter().copied().fold(0.0, f64::max);
    assert!(
        (most / (5.0 * (mass * k).sqrt()) - 1.0).abs() < 1e-5,
        "{most}"
    );
    assert!(x.iter().all(|x| (18.0..42.0).contains(x)));
    let fall = (2.0 * 11.0 / 32.174_f64).sqrt();
    let first = floor
        .iter()
        .position(|force| *force > 0.0)
        .expect("a meeting");
    assert!((time[first] - fall).abs() < 2e-3, "{} {fall}", time[first]);
}

/// Analytic: a stop that a bogie presses by d where it starts meets the tread of the front wheel, a radius h below the hubs, and
/// turns the bogie by phi = T h/(2 a^2 k), where its force is T = K (d - h phi). Turned by more than a tenth, it is warned of.
#[test]
fn a_bogie_that_starts_behind_its_stop_is_turned_and_is_warned_of() {
    let (stiffness, contact, height) = (1e9, 1e7, 1.25);
    for phi in [0.05, 0.2] {
        let force = phi * 2.0 * contact / height;
        let stop = 31.0 - (height * phi + force / stiffness);
        let (_, summary, told) = ran(&format!(
            r#"{{"format": "girderway-scene/1", "units": {{"length": "ft", "force": "lbf", "time": "s"}}, "gravity": 32.174,
 "structures": {{"girder": {{"spec": "spec.json", "foundation": "rigid"}}}},
 "bodies": {{"bogie": {{"weight": 4.8e6, "inertia": [1e5, 1e5, 1e5], "dof": ["y", "pitch"], "x0": 30}}}},
 "wheels": {{"crane": {{"radius": {height}, "vertical": {{"k": {contact}}}}}}},
 "trucks": [{{"body": "bogie", "tree": [-1, 1]}}], "motions": [{{"body": "bogie", "dof": "x", "kind": "prescribed", "speed": [[0, 0]]}}],
 "stops": [{{"rail": "girder.rail", "x": {stop}, "k": {stiffness}, "side": "before"}}],
 "end": {{"time": 0.01}}, "output": {{"dt": 0.01}}}}"#
        ));
        let found = summary["peaks"]["stop1.force"]["max"]["value"]
            .as_f64()
            .expect("a force");
        assert!((found / force - 1.0).abs() < 1e-7, "{found} for {force}");
        let warning = "bogie.pitch reaches 0.2 rad, more than 0.1: the assumption of small rotations does not hold";
        assert_eq!(told.contains(warning), phi > 0.1, "{told}");
    }
}
