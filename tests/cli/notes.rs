//! Notes on what `accuracy` holds for: bounces beyond a hundred, and strikes of flanges and stops.

use std::fs;

use super::{example, folder, girderway, json, text};

/// Notes of a run of a scene on the rigid rail of the bogie example. `parts` are the further members of the scene.
fn notes(parts: &str) -> Vec<String> {
    let folder = folder();
    fs::copy(
        example("bogie").join("spec.json"),
        folder.path().join("spec.json"),
    )
    .expect("a copy");
    let scene = format!(
        r#"{{"format": "girderway-scene/1", "units": {{"length": "ft", "force": "lbf", "time": "s"}}, "gravity": 32.174,
        "structures": {{"girder": {{"spec": "spec.json", "foundation": "rigid"}}}}, "accuracy": 1e-4, {parts}}}"#
    );
    fs::write(folder.path().join("scene.json"), scene).expect("written");
    let run = girderway(&folder, &["run", "scene.json", "-o", "out"]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    let summary = json(&fs::read(folder.path().join("out/summary.json")).expect("a summary"));
    let list = summary["notes"].as_array().cloned().unwrap_or_default();
    let all: Vec<String> = list
        .iter()
        .filter_map(|note| note.as_str().map(str::to_owned))
        .collect();
    let report = fs::read_to_string(folder.path().join("out/report.html")).expect("a report");
    for note in &all {
        let is_own = |line: &str| line.starts_with("note: ") && line.ends_with(note);
        assert!(
            text(&run.stderr).lines().any(is_own),
            "{}",
            text(&run.stderr)
        );
        // keys stand between backticks in a note, in letters of their own on a page
        let parts = note.split('`').enumerate();
        let shown: String = parts
            .map(|(i, part)| {
                if i % 2 == 1 {
                    format!("<code>{part}</code>")
                } else {
                    part.to_owned()
                }
            })
            .collect();
        // a report writes powers of ten as its tables do
        let is_power = |word: &str| {
            word.contains("e-") && word.trim_end_matches([' ', ',']).parse::<f64>().is_ok()
        };
        let mut pieces = vec![String::new()];
        for word in shown.split_inclusive(' ') {
            match pieces.last_mut() {
                Some(piece) if !is_power(word) => piece.push_str(word),
                _ => pieces.push(String::new()),
            }
        }
        let is_there = |piece: &String| report.contains(piece.trim());
        assert!(
            pieces.iter().all(is_there),
            "the report has the note {note}"
        );
    }
    assert!(
        !all.is_empty() || !report.contains("Note, "),
        "the report has no note of its own"
    );
    all
}

/// A wheel that is dropped by `y`, below its place above the unloaded rail, until `end`.
fn bouncing(c: f64, end: f64, stepper: &str) -> Vec<String> {
    notes(&format!(
        r#""bodies": {{"car": {{"weight": 1e6, "dof": ["y"], "x0": 10, "start": {{"y": -0.012}}}}}},
        "wheels": {{"wheel": {{"radius": 1.25, "vertical": {{"k": 1e8, "c": {c}}}}}}},
        "trucks": [{{"name": "truck", "body": "car", "tree": [0], "wheel": "wheel"}}],
        "motions": [{{"body": "car", "dof": "x", "kind": "prescribed", "speed": [[0, 1]]}}],
        "stepper": "{stepper}", "end": {{"time": {end}}}, "output": {{"dt": 0.01}}"#
    ))
}

/// Analytic: the frequency is sqrt(k g / W) / 2 pi = sqrt(1e8 32.174 / 1e6) / 2 pi = 9.028 Hz, 126.4 bounces in 14 s and
/// 90.3 in 10 s. With zeta = c omega / 2 k = 0.028 a damper forgets all but the last six.
#[test]
fn runs_of_more_than_a_hundred_bounces_state_the_error_of_each() {
    for stepper in ["auto", "radau", "sdirk4"] {
        let all = bouncing(0.0, 14.0, stepper);
        let is_told = |count: usize| {
            all[0].starts_with(&format!("the wheels bounce for about {count} cycles"))
                && all[0].contains("an error of 1e-6 per cycle, 0.00013 in total")
        };
        assert!(
            all.len() == 1 && (125..=129).any(is_told),
            "{stepper}: {all:?}"
        );
        assert_eq!(
            bouncing(0.0, 10.0, stepper),
            Vec::<String>::new(),
            "{stepper}"
        );
    }
    assert_eq!(bouncing(1e5, 14.0, "auto"), Vec::<String>::new());
}

/// A free bogie until `end`, whose foremost wheel is 10 ft from a stop.
fn stopped(end: f64) -> Vec<String> {
    notes(&format!(
        r#""bodies": {{"bogie": {{"weight": 4.8e6, "dof": ["x", "y"], "x0": 30, "v0": 5}}}},
        "wheels": {{"crane": {{"radius": 1.25, "vertical": {{"k": 1e8}}}}}},
        "trucks": [{{"name": "truck", "body": "bogie", "tree": [-1, 1]}}],
        "stops": [{{"name": "buffer", "rail": "girder.rail", "x": 41, "k": 1e6}}],
        "end": {{"time": {end}}}, "output": {{"dt": 0.01}}"#
    ))
}

/// Analytic: at 5 ft/s the bogie meets the stop 10 ft away after 2 s.
#[test]
fn runs_say_from_which_strike_of_a_stop_on_only_extremes_are_promised() {
    assert_eq!(stopped(1.9), Vec::<String>::new());
    // Extremes of girders may change with the number of rows after a strike, which has a note of its own.
    let all: Vec<String> = stopped(2.5)
        .into_iter()
        .filter(|note| !note.starts_with("extremes of girders"))
        .collect();
    let wanted = "impact of the stop buffer at t = 2.000000 s: afterwards small differences grow";
    assert!(
        all.len() == 1 && all[0].starts_with(wanted) && all[0].contains("to the extremes"),
        "{all:?}"
    );
}

/// A car that a constant force moves to the side, from the middle of its clearance.
fn sideways(end: f64) -> Vec<String> {
    notes(&format!(
        r#""bodies": {{"car": {{"weight": 1e6, "dof": ["y", "z"], "x0": 10}}}},
        "wheels": {{"wheel": {{"radius": 1.25, "vertical": {{"k": 1e8, "c": 1e6}}, "lateral": {{"k": 1e7, "clearance": 0.05}}}}}},
        "trucks": [{{"name": "truck", "body": "car", "tree": [0], "wheel": "wheel"}}],
        "motions": [{{"body": "car", "dof": "x", "kind": "prescribed", "speed": [[0, 5]]}}],
        "loads": [{{"body": "car", "dof": "z", "value": [[0, 1e4]]}}],
        "end": {{"time": {end}}}, "output": {{"dt": 0.01}}"#
    ))
}

/// Analytic: with the acceleration F g / W the car crosses its clearance d in sqrt(2 d W / (F g)) = 0.558 s.
#[test]
fn runs_say_from_which_strike_of_a_flange_on_only_extremes_are_promised() {
    assert_eq!(sideways(0.5), Vec::<String>::new());
    let all = sideways(1.0);
    let time = (2.0 * 0.05 * 1e6 / (1e4 * 32.174_f64)).sqrt();
    let told = all
        .first()
        .and_then(|note| note.split("t = ").nth(1))
        .and_then(|rest| rest.split(' ').next());
    let told: f64 = told.and_then(|time| time.parse().ok()).expect("a time");
    assert!(
        all.len() == 1 && all[0].starts_with("impact of the flange of truck.wheel1 at"),
        "{all:?}"
    );
    // The step in which the flange touches need not end there.
    assert!((told - time).abs() < 0.05, "{told} {time}");
}
