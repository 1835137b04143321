//! What page one of a run says is what the run had: peaks, limits, chords and extremes at every time and place, whatever the
//! output interval. True values were computed from histories at far shorter intervals, by runs at an accuracy of 1e-8 and by
//! statics.

mod hall;
mod same_page;

use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};

/// The summary of a case with changes by JSON merge patch at the first level.
fn summary(case: &str, changes: &Value) -> Value {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/extremes/cases");
    let folder = tempfile::tempdir().expect("a temporary folder");
    for entry in std::fs::read_dir(&source).expect("the cases") {
        let entry = entry.expect("a file");
        std::fs::copy(entry.path(), folder.path().join(entry.file_name())).expect("a copy");
    }
    let path = folder.path().join(format!("{case}.json"));
    let text = std::fs::read_to_string(&path).expect("a case");
    let mut scene: Value = serde_json::from_str(&text).expect("JSON");
    for (key, value) in changes.as_object().into_iter().flatten() {
        scene[key] = value.clone();
    }
    std::fs::write(&path, scene.to_string()).expect("a writable folder");
    run(folder.path(), &format!("{case}.json"), &[])
}

/// The summary of a scene that is written into a folder with its spec.
fn summary_of(spec: (&str, &Value), scene: &Value, flags: &[&str]) -> Value {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, value) in [spec, ("scene.json", scene)] {
        std::fs::write(folder.path().join(name), value.to_string()).expect("a writable folder");
    }
    run(folder.path(), "scene.json", flags)
}

/// The summary of a scene in a folder.
fn run(folder: &Path, scene: &str, flags: &[&str]) -> Value {
    let output = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(["run", scene, "-o", "out"])
        .args(flags)
        .current_dir(folder)
        .output()
        .expect("the program starts");
    let text = std::fs::read_to_string(folder.join("out/summary.json"))
        .unwrap_or_else(|error| panic!("{error}: {}", String::from_utf8_lossy(&output.stderr)));
    serde_json::from_str(&text).expect("JSON")
}

fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is no number"))
}

/// The entry of `extremes` with these members.
fn extreme(summary: &Value, members: &[(&str, &str)]) -> f64 {
    let all = summary["extremes"].as_array().expect("extremes");
    let has = |entry: &&Value| members.iter().all(|(key, word)| entry[*key] == *word);
    let mut own = all.iter().filter(has).map(|entry| number(&entry["value"]));
    let first = own.next().unwrap_or_else(|| panic!("no {members:?}"));
    own.fold(first, |a, b| if b.abs() > a.abs() { b } else { a })
}

fn reaction(summary: &Value, support: &str, direction: &str, kind: &str) -> f64 {
    extreme(
        summary,
        &[
            ("quantity", "reaction"),
            ("support", support),
            ("direction", direction),
            ("kind", kind),
        ],
    )
}

/// External, statics: a crane that passes a runway once or many times deflects it by the same 14.29 mm. Of 63 trips, 64 output
/// times saw 10.12 mm, and the limit was kept.
#[test]
fn limits_do_not_depend_on_the_number_of_trips() {
    for trips in [1, 21] {
        let mut position = Vec::new();
        for trip in 0..trips {
            let start = 10.0 * f64::from(trip);
            position.push(json!([start, 1.0]));
            position.push(json!([start + 5.0, 7.0]));
        }
        position.push(json!([10.0 * f64::from(trips), 1.0]));
        let motion =
            json!([{"body": "crane", "dof": "x", "kind": "prescribed", "position": position}]);
        let end = json!({"time": 10.0 * f64::from(trips)});
        let found = summary("trip", &json!({"motions": motion, "end": end}));
        let limit = &found["practice"]["limits"][0];
        assert_eq!(limit["name"], "runway_vertical");
        let deflection = number(&limit["static_deflection"]);
        assert!(
            (deflection / 0.014_29 - 1.0).abs() < 1e-3,
            "{trips}: {deflection}"
        );
    }
}

/// External: a pulse of a millisecond deflects the span by L/122, between the output times; 64 of them saw L/225. The supports do
/// not move, and the deflection from the chord is the extreme on the same page.
#[test]
fn chords_see_every_time() {
    let found = summary("pulse", &json!({}));
    let chord = &found["deflection_ratios"][0];
    let ratio = number(&chord["span_over_deflection"]);
    assert!((ratio / 122.3 - 1.0).abs() < 2e-3, "{ratio}");
    let own = extreme(&found, &[("quantity", "deflection"), ("kind", "max")]);
    assert!(
        (number(&chord["deflection"]) / own - 1.0).abs() < 1e-3,
        "{own}"
    );
}

/// External, the same run at an accuracy of 1e-8: a wheel between stiff flanges passes a support, whose reactions are at least
/// 29.63 up and 126.27 kN to the side. The compliance was interpolated past the support, and the reactions were -59 and -233 kN.
#[test]
fn stiff_flanges_pass_a_support() {
    for accuracy in [1e-3, 1e-4] {
        let found = summary("flange", &json!({"accuracy": accuracy}));
        let up = reaction(&found, "g.support2", "uy", "min");
        let aside = reaction(&found, "g.support2", "uz", "min");
        assert!((up / 29.63 - 1.0).abs() < accuracy, "{accuracy}: {up}");
        assert!(
            (aside + 126.27).abs() < 4.0 * accuracy * 126.27,
            "{accuracy}: {aside}"
        );
    }
}

/// External, the same run at 1e-8 and history at a fiftieth of the interval.
#[test]
fn extremes_beside_passages_are_those_of_their_side() {
    let found = summary("yaw", &json!({}));
    let moment = reaction(&found, "frame.F3", "rx", "min");
    let torsion = extreme(&found, &[("quantity", "torsion"), ("kind", "max")]);
    assert!((moment / -16.006 - 1.0).abs() < 2e-4, "{moment}");
    assert!((torsion / 6.877 - 1.0).abs() < 2e-4, "{torsion}");
    let found = summary("step", &json!({}));
    let moment = extreme(&found, &[("quantity", "moment"), ("kind", "max")]);
    assert!((moment / 277.567 - 1.0).abs() < 1e-4, "{moment}");
}

/// Identity: no number but those of the history depends on the output interval. External, history at a far shorter interval: the
/// wheel that lifts off 64 times deflects the rail by 11.80 mm; rows alone saw 6.9 mm and 41 times.
#[test]
fn page_one_does_not_depend_on_the_output_interval() {
    let members = [
        "peaks",
        "extremes",
        "envelopes",
        "deflection_ratios",
        "fatigue",
        "uplift",
        "practice",
        "stresses",
    ];
    for (case, intervals) in [("lift_off", [0.12, 0.017]), ("modal", [0.02, 0.013])] {
        let [coarse, fine] = intervals.map(|dt| {
            let sections = json!({"dt": dt, "reactions": true, "sections": true, "stresses": true});
            summary(case, &json!({"output": sections}))
        });
        for member in members {
            assert_eq!(coarse[member], fine[member], "{case}: {member}");
        }
        if case == "lift_off" {
            let ratios = coarse["deflection_ratios"].as_array().expect("ratios");
            let most = ratios.iter().map(|own| number(&own["deflection"]));
            let most = most.fold(0.0, f64::max);
            assert!((most / 0.011_803 - 1.0).abs() < 1e-3, "{most}");
            let count = coarse["uplift"].as_array().map_or(0, Vec::len);
            assert!((64..=65).contains(&count), "{count}");
        }
    }
}

/// Identity: the peaks of runs beside each other are the same at every output interval.
#[test]
fn peaks_of_comparisons_are_those_of_all_times() {
    let [coarse, fine] = [0.03, 0.013].map(|dt| {
        let compare = json!([{"label": "coarse", "accuracy": 1e-2}]);
        let output = json!({"dt": dt, "reactions": true});
        let all = summary("modal", &json!({"output": output, "compare": compare}));
        let comparison = all["comparison"].as_object().expect("a comparison").clone();
        let peaks = comparison.into_iter().flat_map(|(column, own)| {
            let own = own.as_object().expect("runs").clone();
            own.into_iter().map(move |(label, own)| {
                format!("{column} {label} {} {}", own["peak"], own["least"])
            })
        });
        peaks.collect::<Vec<String>>()
    });
    assert!(!coarse.is_empty());
    assert_eq!(coarse, fine);
}

/// External, the same run at an accuracy of 1e-8 and a far finer history: the reaction of a support while a wheel passes it was
/// 5.853 kN at 1e-3.
#[test]
fn a_lateral_reaction_has_its_peak() {
    let found = summary("lateral", &json!({}));
    let most = number(&found["peaks"]["g.support2.lateral"]["max"]["value"]);
    assert!((most / 6.1126 - 1.0).abs() < 1e-3, "{most}");
}

/// External, one trip at a fine history: the largest moment of a span is the same after any number of trips.
#[test]
fn trips_repeat_the_moments_of_one() {
    let found = summary("trips", &json!({}));
    let all = found["extremes"].as_array().expect("extremes");
    let is_own = |entry: &&Value| {
        entry["span"] == 3 && entry["quantity"] == "moment" && entry["kind"] == "max"
    };
    let moment = all.iter().find(is_own).map(|entry| number(&entry["value"]));
    let moment = moment.expect("a moment of span 3");
    assert!((moment / 128.0 - 1.0).abs() < 1e-3, "{moment}");
}

/// Identity: natural modes belong to stated positions, whatever the output interval.
#[test]
fn natural_modes_stand_at_their_positions() {
    let [coarse, fine] = [0.04, 0.01].map(|dt| summary("modes", &json!({"output": {"dt": dt}})));
    assert_eq!(coarse["natural_modes"], fine["natural_modes"]);
    let mode = &fine["natural_modes"][0];
    let x = number(&mode["positions"]["b"]);
    // 2 m, 1.25 m in the first second, and 2.5 m/s up to 5.25 s
    assert!(
        (x - 13.875).abs() < 1e-9 && (number(&mode["time"]) - 5.25).abs() < 1e-12,
        "{mode}"
    );
}

/// Where wheels bounce without damping, the last digits of the input decide on the largest forces: from run to run they differ by
/// a third, and the summary, the verdict and the first page say so. A bogie that lifts off, but is damped, is determined.
#[test]
fn what_bounces_do_not_determine_is_said() {
    let found = summary("bounces", &json!({}));
    let all = found["undetermined"].as_array().expect("undetermined");
    let reaction = all
        .iter()
        .find(|own| own["quantity"] == "g.support2.vertical");
    let reaction = reaction.unwrap_or_else(|| panic!("{all:?}"));
    assert!(
        number(&reaction["high"]) > 1.1 * number(&reaction["low"]),
        "{reaction}"
    );
    let omitted = found["verdict"]["not_checked"]
        .as_array()
        .expect("checks that were not done");
    let is_said = |own: &Value| {
        own["check"]
            .as_str()
            .is_some_and(|check| check.contains("not determined"))
    };
    assert!(omitted.iter().any(is_said), "{omitted:?}");
    let plain = summary("lift_off", &json!({}));
    assert!(plain["undetermined"].is_null(), "{}", plain["undetermined"]);
}

/// A gauge and the envelope differ while an end stop is hit: the note says which of them has its force.
#[test]
fn a_run_says_where_end_stops_act() {
    let found = summary("stop", &json!({}));
    let notes = found["notes"].as_array().expect("notes");
    let is_said = |note: &Value| {
        note.as_str()
            .is_some_and(|note| note.contains("forces of end stops (end) act"))
    };
    assert!(notes.iter().any(is_said), "{notes:?}");
}
