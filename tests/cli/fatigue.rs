//! Stress points of a girder under a wheel that comes and goes: histories, cycles and damage in closed form.

use std::fs;

use serde_json::{Value, json};

use super::{folder, girderway, text};

const WEIGHT: f64 = 80_000.0;
const SPAN: f64 = 10.0;
const INERTIA: f64 = 2e-3;
const LEVER: f64 = 1.0;

/// Stress at midspan with the wheel there, N/m2.
const FULL: f64 = WEIGHT * SPAN / 4.0 * LEVER / INERTIA;

/// One wheel to midspan, back by half of the way, to midspan again, and off over the far support; on a girder with one point
/// of a category of each code.
fn files(history: &str) -> [(&'static str, Value); 2] {
    let units = json!({"length": "m", "force": "N", "time": "s"});
    let spec = json!({
        "format": "girderway-beam/1", "units": units, "theory": "euler-bernoulli",
        "girder": {"spans": [SPAN], "E": 2.1e11, "I_vertical": INERTIA,
            "points": [{"name": "bottom", "y": -LEVER, "detail": 112}, {"name": "weld", "y": -LEVER, "detail": "D"},
                       {"name": "top", "y": LEVER}]},
        "effects": [{"name": "mid", "x": 5}], "stations": [0, 5, 10]});
    let scene = json!({
        "format": "girderway-scene/1", "name": "fatigue", "units": units, "gravity": 10.0, "analysis": "quasi-static",
        "structures": {"girder": {"spec": "spec.json", "foundation": "influence"}},
        "bodies": {"car": {"weight": WEIGHT, "dof": ["y"]}},
        "wheels": {"steel": {"radius": 0.4, "vertical": {"k": 2e7}}},
        "trucks": [{"name": "truck", "body": "car"}],
        "motions": [{"body": "car", "dof": "x", "kind": "prescribed",
                     "position": [[0, 0], [5, 5], [7.5, 2.5], [10, 5], [15, 10]]}],
        "end": {"time": 15}, "output": {"dt": 0.25, "fatigue": {"gamma_Mf": 1.25, "history": history, "crossings": 1e4}},
        "compare": [{"label": "rigid", "structures": {"girder": {"foundation": "rigid"}}}]});
    [("spec.json", spec), ("scene.json", scene)]
}

/// Summary and both cycle files of a run.
fn run(history: &str) -> (Value, [String; 2], String) {
    let folder = folder();
    for (name, value) in files(history) {
        fs::write(folder.path().join(name), value.to_string()).expect("written");
    }
    let run = girderway(&folder, &["run", "scene.json", "-o", "out"]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    let read = |name: &str| fs::read_to_string(folder.path().join("out").join(name)).expect(name);
    let summary = serde_json::from_str(&read("summary.json")).expect("JSON");
    (
        summary,
        ["cycles.csv", "cycles-rigid.csv"].map(read),
        read("report.html"),
    )
}

/// Range, count and damage of each cycle of a point.
fn cycles(file: &str, point: &str) -> Vec<[f64; 3]> {
    let rows = file.lines().filter(|line| line.starts_with(point));
    let mut all: Vec<[f64; 3]> = rows
        .map(|line| {
            let cells: Vec<f64> = line
                .split(',')
                .skip(1)
                .map(|cell| cell.parse().expect("a number"))
                .collect();
            [cells[0], cells[2], cells[5]]
        })
        .collect();
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    all
}

/// Analytic: 0, S, S/2, S, 0 has one cycle of S/2 and two halves of S (one cycle, where it repeats); N of the Eurocode is
/// 2e6 (112/1.25/S)^3 above 0.737 of the category and 5e6 (limit/S)^5 below, of AISC 2.2e9/S^3 in ksi.
#[test]
fn a_wheel_that_comes_back_does_the_damage_of_its_cycles() {
    let megapascals = FULL / 1e6;
    let reference = 112.0 / 1.25;
    let limit = reference * 0.4_f64.cbrt();
    let euro = (megapascals / reference).powi(3) / 2e6 + (0.5 * megapascals / limit).powi(5) / 5e6;
    let ksi = megapascals / 6.894_757_293_168_36 * 1.25;
    let aisc = (ksi.powi(3) + (0.5 * ksi).powi(3)) / 2.2e9;
    for history in ["once", "repeated"] {
        let (summary, files, report) = run(history);
        for (run, file) in [
            (&summary, &files[0]),
            (&summary["compare"]["rigid"], &files[1]),
        ] {
            for (point, damage) in [("girder.mid.bottom", euro), ("girder.mid.weld", aisc)] {
                let found = cycles(file, point);
                assert_eq!(found.len(), 3, "{found:?}");
                for ([range, count, _], [share, wanted]) in
                    found.iter().zip([[0.5, 1.0], [1.0, 0.5], [1.0, 0.5]])
                {
                    assert!(
                        (range / (share * FULL) - 1.0).abs() < 1e-9 && *count == wanted,
                        "{found:?}"
                    );
                }
                let own = &run["fatigue"][point];
                let of = |key: &str| own[key].as_f64().expect(key);
                let sum: f64 = found.iter().map(|cycle| cycle[2]).sum();
                assert!(
                    (sum / damage - 1.0).abs() < 1e-8,
                    "{point} {history}: {sum:e} {damage:e}"
                );
                assert!((of("damage") / damage - 1.0).abs() < 1e-8);
                assert!((of("crossings_to_failure") * damage - 1.0).abs() < 1e-8);
                assert!((of("life_damage") / (1e4 * damage) - 1.0).abs() < 1e-8);
                assert!((of("largest_range") / FULL - 1.0).abs() < 1e-9);
                assert_eq!((of("cycles"), &own["within_limit"]), (2.0, &json!(false)));
            }
            assert!(
                run["fatigue"]["girder.mid.top"].is_null(),
                "no category, no damage"
            );
        }
        let top = summary["envelopes"]["girder.mid.top"]["min"]["value"]
            .as_f64()
            .expect("a stress");
        assert!((top / FULL + 1.0).abs() < 1e-9, "{top}");
        assert_eq!(summary["units"]["girder.mid.top"], "N/m^2");
        assert!(report.contains("<h2>Fatigue</h2>"));
    }
}
