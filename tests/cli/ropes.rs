//! Scenes with bodies on ropes.

use std::collections::BTreeMap;
use std::fs;

use super::{example, folder, girderway, text};

const SCENE: &str = r#"{"format": "girderway-scene/1", "name": "crane", "units": {"length": "ft", "force": "lbf", "time": "s"},
 "gravity": 32.174, "structures": {"girder": {"spec": "spec.json", "foundation": "influence"}},
 "bodies": {"bogie": {"weight": 4.8e6, "dof": ["y"], "x0": 30}, "ladle": {"weight": 1e6, "dof": ["X", "Y", "Z"]}},
 "wheels": {"crane": {"radius": 1.25, "vertical": {"k": 1e8}}},
 "trucks": [{"name": "truck", "body": "bogie", "tree": [-1, 1]}],
 "ropes": [{"name": "hoist", "from": {"body": "bogie"}, "to": {"body": "ladle"}, "EA": 2.8e8, "length": 40}],
 "end": {"time": 0.5}, "output": {"dt": 0.1}, "accuracy": 1e-7}"#;

/// The columns of the history of a scene by their names.
fn history(scene: &str) -> BTreeMap<String, Vec<f64>> {
    let folder = folder();
    fs::copy(
        example("bogie").join("spec.json"),
        folder.path().join("spec.json"),
    )
    .expect("a copy");
    fs::write(folder.path().join("scene.json"), scene).expect("written");
    let run = girderway(&folder, &["run", "scene.json", "-o", "out"]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    let history = fs::read_to_string(folder.path().join("out/history.csv")).expect("a history");
    let mut rows = history.lines().map(|line| line.split(','));
    let mut columns: Vec<(String, Vec<f64>)> = rows
        .next()
        .expect("a header")
        .map(|name| (name.to_owned(), Vec::new()))
        .collect();
    for row in rows {
        for ((_, column), value) in columns.iter_mut().zip(row) {
            column.push(value.parse().expect("a number"));
        }
    }
    columns.into_iter().collect()
}

fn assert_close(found: f64, wanted: f64, tolerance: f64) {
    assert!((found / wanted - 1.0).abs() < tolerance, "{found} {wanted}");
}

/// Analytic: at rest the rope carries the ladle, the rail both, and nothing moves.
#[test]
fn a_hung_ladle_presses_the_wheels_of_its_bogie() {
    let history = history(SCENE);
    for (name, wanted) in [
        ("hoist.tension", 1e6),
        ("hoist.length", 40.0 * (1.0 + 1e6 / 2.8e8)),
        ("girder.rail.reaction", 5.8e6),
    ] {
        assert!(history[name].len() > 2, "it has rows");
        for value in &history[name] {
            assert_close(*value, wanted, 1e-8);
        }
    }
}

/// Analytic: a ladle on the floor below a rope that is still taut is held by both. Where the floor is stiff, a small motion of the
/// girder moves all of its weight from one to the other; where the rope is stiff as well, a twentieth of its deflection does.
#[test]
fn a_ladle_stands_and_hangs_at_the_same_time() {
    for (stiffness, level) in [(2.8e8, -39.41), (1e12, -39.409), (1e12, -39.405)] {
        let floor = format!(
            r#""stops": [{{"name": "floor", "body": "ladle", "Y": {level}, "k": 1e9}}], "end": {{"time": 1e-3}}"#
        );
        let scene = SCENE
            .replace(r#""end": {"time": 0.5}"#, &floor)
            .replace(r#""dt": 0.1"#, r#""dt": 1e-3"#)
            .replace("2.8e8", &stiffness.to_string());
        let history = history(&scene);
        let first = |name: &str| history[name][0];
        let [tension, floor] = ["hoist.tension", "floor.force"].map(first);
        assert!(tension > 1e4 && floor > 1e4, "{tension} {floor}");
        for (found, wanted) in [
            (tension + floor, 1e6),
            (first("hoist.length"), 40.0 * (1.0 + tension / stiffness)),
            (first("ladle.Y"), level - floor / 1e9),
            (first("girder.rail.reaction"), 4.8e6 + tension),
        ] {
            assert_close(found, wanted, 1e-9);
        }
    }
}
