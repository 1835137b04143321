//! Scenes with events.

use std::fs;

use serde_json::Value;

use super::{example, folder, girderway, json, text};

/// A driven bogie that brakes at 5 ft/s, while it carries a ladle that hoists off its floor and is dropped.
const SCENE: &str = r#"{"format": "girderway-scene/1", "name": "events", "units": {"length": "ft", "force": "lbf", "time": "s"},
 "gravity": 32.174, "structures": {"girder": {"spec": "spec.json", "foundation": "rigid"}},
 "bodies": {"bogie": {"weight": 4.8e6, "dof": ["x", "y"], "x0": 10, "v0": 5},
  "ladle": {"weight": 1e5, "dof": ["X", "Y", "Z"], "x0": 100, "start": {"y": -1000.0001}}},
 "wheels": {"crane": {"radius": 1.25, "vertical": {"k": 1e8}, "friction": {"mu": 0.2, "slip": 0.01}, "driven": true, "braked": true}},
 "trucks": [{"name": "truck", "body": "bogie", "tree": [-1, 1]}],
 "motions": [{"body": "bogie", "dof": "x", "kind": "drive", "speed": [[0, 5]], "gain": 1e6}],
 "ropes": [{"name": "fall", "from": {"at": [100, 0, 0]}, "to": {"body": "ladle"}, "EA": 1e9, "length": 1000}],
 "stops": [{"name": "floor", "body": "ladle", "Y": -1000, "k": 1e9}],
 "events": [
  {"name": "emergency", "when": "bogie.x >= 25", "do": {"brake": "bogie"}},
  {"when": "time >= 0.5", "do": {"hoist": {"rope": "fall", "speed": 1}}},
  {"name": "aloft", "when": "floor.force <= 0", "do": {"drive": {"body": "bogie", "speed": 5}}},
  {"name": "loss", "when": "ladle.Y > -999", "do": {"drop": "ladle"}},
  {"name": "halt", "when": "bogie.speed < 1e-5", "do": {"end": true}}],
 "end": {"time": 30}, "output": {"dt": 0.01}, "accuracy": 1e-7}"#;

/// Summary of a run of `scene`.
fn run(scene: &str) -> Value {
    let folder = folder();
    fs::copy(
        example("bogie").join("spec.json"),
        folder.path().join("spec.json"),
    )
    .expect("a copy");
    fs::write(folder.path().join("scene.json"), scene).expect("written");
    let run = girderway(&folder, &["run", "scene.json", "-o", "out"]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    json(&fs::read(folder.path().join("out/summary.json")).expect("a summary"))
}

/// Analytic: the brake is put on after 3 s at 5 ft/s and takes v^2/(2 mu g) to stop; the rope pulls with
/// W + v sqrt(k m) after the ladle has left its floor; the ladle is let go 1 ft above it.
#[test]
fn events_brake_hoist_drop_and_end_as_the_scene_says() {
    let summary = run(SCENE);
    assert_eq!(summary["status"], "ended by event");
    let events = summary["events"].as_array().expect("a list");
    let names: Vec<&str> = events
        .iter()
        .filter_map(|event| event["name"].as_str())
        .collect();
    assert_eq!(
        names,
        ["event2", "aloft", "loss", "emergency", "halt"],
        "{summary}"
    );
    let time = |name: &str| {
        let event = events
            .iter()
            .find(|event| event["name"] == name)
            .expect("an event");
        event["time"].as_f64().expect("a time")
    };
    assert!(
        (time("emergency") - 3.0).abs() < 1e-8,
        "{}",
        time("emergency")
    );
    assert_eq!(events[3]["what"], "brake bogie");
    assert_eq!(events[3]["when"], "bogie.x >= 25");
    let peak = |column: &str| {
        summary["peaks"][column]["max"]["value"]
            .as_f64()
            .expect("a peak")
    };
    let stop = peak("bogie.x") - 25.0;
    // s^2 pi^2/(12 mu g) is what tanh adds, s = 0.02 ft/s
    let wanted = (12.5 + 0.02_f64.powi(2) * 0.822_467) / (0.2 * 32.174);
    assert!((stop / wanted - 1.0).abs() < 1e-5, "{stop} {wanted}");
    let (k, mass) = (1e6_f64, 1e5 / 32.174);
    let lift = 1e5 + (k * mass).sqrt();
    assert!(
        (peak("fall.tension") / lift - 1.0).abs() < 2e-3,
        "{} {lift}",
        peak("fall.tension")
    );
    let energy = &summary["energy"];
    assert!(
        energy["residual"].as_f64().is_some_and(|left| left < 1e-6),
        "{energy}"
    );
    // before the drop: the height of 1 ft, its speed and the stretch
    let hoists = energy["work"]["hoists"].as_f64().expect("a work");
    assert!((1e5..1.3e5).contains(&hoists), "{hoists}");
}
