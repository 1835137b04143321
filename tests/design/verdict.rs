//! What a design says of itself: spans by plane, loads that limits name, cases with factors, checks that were not done.

use std::process::Command;

use serde_json::{Value, json};

use super::{root, run, summary};

/// A girder of one span with a crane rail, HEB 500, in m and kN.
fn girder(span: f64, overhang: f64) -> Value {
    json!({"format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
        "theory": "euler-bernoulli",
        "girder": {"spans": [span], "overhangs": [0, overhang], "section": "HEB 500", "crane_rail": "A75",
            "rail_height": 0.25}})
}

/// Two wheels of 200 kN, 3 m apart, with a lateral force on each.
fn crane(lateral: f64, practice: Value) -> Value {
    json!({"format": "girderway-design/1", "units": {"length": "m", "force": "kN", "time": "s"}, "spec": "spec.json",
        "trains": [{"name": "c", "lateral": lateral,
            "wheels": [{"x": 0, "vertical": 200}, {"x": 3, "vertical": 200}]}],
        "practice": practice})
}

fn solved(spec: &Value, design: &Value) -> Value {
    let (folder, output) = run(spec, design, &[]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    summary(&folder)
}

/// The first check of a quantity: that of the highest utilisation.
fn check<'a>(summary: &'a Value, quantity: &str) -> &'a Value {
    let checks = summary["verdict"]["checks"].as_array().expect("checks");
    let found = checks.iter().find(|check| check["check"] == quantity);
    found.unwrap_or_else(|| panic!("no check of {quantity}: {}", summary["verdict"]))
}

fn value(row: &Value, key: &str) -> f64 {
    row[key]
        .as_f64()
        .unwrap_or_else(|| panic!("{key} of {row}"))
}

fn near(row: &Value, key: &str, known: f64, tolerance: f64) {
    let found = value(row, key);
    assert!(
        (found - known).abs() <= tolerance * known,
        "{key}: {found}, {known} within {tolerance}: {row}"
    );
}

fn omitted(summary: &Value, words: &str) -> bool {
    let all = summary["verdict"]["not_checked"]
        .as_array()
        .expect("a list");
    all.iter().any(|one| one.to_string().contains(words))
}

/// A crane girder of 12 m whose surge truss, 1 m away, meets it every 2 m and hangs on it: in the vertical plane there are
/// two supports.
fn with_surge_truss() -> Value {
    let at = |k: usize| 2.0 * k as f64;
    let points: Vec<Value> = (0..7)
        .map(|k| json!([at(k), 0, 0]))
        .chain((0..7).map(|k| json!([at(k), 0, 1])))
        .collect();
    let girder: Vec<Value> = (0..6).map(|k| json!([k, k + 1])).collect();
    let chord = (0..6).map(|k| json!([k + 7, k + 8]));
    let posts = (0..7).map(|k| json!([k, k + 7]));
    let diagonals = (0..6).map(|k| json!([k, k + 8]));
    let truss: Vec<Value> = chord.chain(posts).chain(diagonals).collect();
    let segments: Vec<Value> = (0..6).map(|k| json!({"cell": [0, k]})).collect();
    let held = |point: usize, fix: Value| json!({"point": point, "fix": fix});
    let mut supports = vec![
        held(0, json!(["ux", "uy", "uz", "rx"])),
        held(6, json!(["uy", "uz", "rx"])),
        held(7, json!(["ux", "uy", "uz"])),
        held(13, json!(["uy", "uz"])),
    ];
    supports.extend((8..13).map(|point| held(point, json!(["uy"]))));
    json!({"format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
        "theory": "euler-bernoulli", "points": points,
        "cells": [{"type": "line", "data": girder}, {"type": "line", "data": truss}],
        "cell_data": {"kind": ["beam", "truss"], "section": ["g", "t"]},
        "materials": [{"name": "steel", "E": 2.1e8, "G": 8.1e7}],
        "sections": [{"name": "g", "material": "steel", "shape": "HEB 500"},
            {"name": "t", "material": "steel", "A": 0.0015}],
        "supports": supports,
        "rails": {"rail": {"origin": [0, 0, 0], "axis": [1, 0, 0], "segments": segments,
            "stations": [0, 2, 4, 6, 8, 10, 12]}}})
}

/// Analytic: the largest deflection of a simple beam of 12 m under two wheels of 150 kN, 3.6 m apart, is that at midspan with
/// the wheels placed symmetrically, P a (3 L^2 - 4 a^2)/(24 E I), a = 4.2 m; L/600 is 20 mm.
#[test]
fn points_that_sink_with_the_girder_end_no_span() {
    let mut design = crane(15.0, json!({"code": "EN 1993-6"}));
    design["trains"][0]["wheels"] = json!([{"x": 0, "vertical": 150}, {"x": 3.6, "vertical": 150}]);
    let found = solved(&with_surge_truss(), &design);
    let row = check(&found, "vertical deflection");
    let known = 150.0 * 4.2 * (3.0 * 144.0 - 4.0 * 4.2 * 4.2) / (24.0 * 2.1e8 * 1.0718e-3);
    near(row, "applied", known, 1e-4);
    near(row, "limit", 0.02, 1e-12);
    assert_eq!(found["verdict"]["result"], "not ok");
    assert_eq!(found["within"], false);
}

/// Analytic: two lateral forces H, 3 m apart on 9 m, bend the girder by H a (3 L^2 - 4 a^2)/(24 E I_l) and turn its rail by
/// H h a/(G J) between them, h = 0.335 m; a = 3 m is the worst place. CMAA 70 names a tenth of the wheel loads, whatever the
/// side thrust of the train is.
#[test]
fn a_limit_for_a_tenth_of_the_wheel_loads_is_checked_under_it() {
    let bending = 3.0 * (3.0 * 81.0 - 36.0) / (24.0 * 2.1e8 * 1.2624e-4);
    let twist = 0.335 * 0.335 * 3.0 / (8.1e7 * 5.3844e-6);
    for lateral in [0.0, 2.0, 40.0] {
        let found = solved(
            &girder(9.0, 0.0),
            &crane(lateral, json!({"code": "CMAA 70"})),
        );
        let row = check(&found, "lateral deflection");
        near(row, "applied", 20.0 * (bending + twist), 1e-3);
        near(row, "limit", 9.0 / 400.0, 1e-12);
        assert_eq!(row["result"], "fail");
        assert!(
            row["bound"]
                .as_str()
                .is_some_and(|why| why.contains("warping"))
        );
    }
}

/// Identity: a case with factors has the limits of the same case without.
#[test]
fn cases_with_factors_are_checked_at_factor_one() {
    let practice = json!({"code": "CMAA 70"});
    let plain = solved(&girder(9.0, 0.0), &crane(2.0, practice.clone()));
    let mut design = crane(2.0, practice);
    design["cases"] =
        json!([{"name": "LRFD", "trains": ["c"], "factors": {"vertical": 1.6, "lateral": 1.6}}]);
    let factored = solved(&girder(9.0, 0.0), &design);
    for quantity in ["vertical deflection", "lateral deflection"] {
        let [a, b] = [&plain, &factored].map(|found| value(check(found, quantity), "applied"));
        assert!((a / b - 1.0).abs() < 1e-12, "{quantity}: {a} {b}");
    }
    assert_eq!(factored["verdict"]["result"], "not ok");
    let (_folder, output) = run(&girder(9.0, 0.0), &design, &["--fail-on-limit"]);
    assert_eq!(output.status.code(), Some(1));
}

/// Analytic: EN 1993-6 names the horizontal loads; skewing forces of 30 kN on the first wheel govern over a side thrust of
/// 2 kN on both, although no case has a factor of `skewing`. One force H at midspan bends by H L^3/(48 E I_l) and turns the rail
/// by H h^2 L/(4 G J).
#[test]
fn lateral_limits_of_the_eurocode_include_skewing() {
    let mut design = crane(2.0, json!({"code": "EN 1993-6"}));
    design["trains"][0]["wheels"][0]["skewing"] = json!(30);
    let found = solved(&girder(9.0, 0.0), &design);
    let row = check(&found, "lateral deflection");
    let bending = 729.0 / (48.0 * 2.1e8 * 1.2624e-4);
    let twist = 0.335 * 0.335 * 9.0 / (4.0 * 8.1e7 * 5.3844e-6);
    near(row, "applied", 30.0 * (bending + twist), 1e-3);
    assert!(
        row["loads"]
            .as_str()
            .is_some_and(|loads| loads.contains("skewing"))
    );
}

/// Analytic: the tip of an overhang c under two wheels, at the tip and 3 m before it at the support, moves by
/// P c^2 (L + c)/(3 E I).
#[test]
fn an_overhang_has_the_limit_that_is_given_or_is_named() {
    let named = solved(&girder(9.0, 3.0), &crane(0.0, json!({"code": "EN 1993-6"})));
    assert!(
        omitted(&named, "overhang from 9 to 12"),
        "{}",
        named["verdict"]
    );
    let limits = json!({"overhang": "L/250", "vertical": "L/750", "lateral": ["L/600", 0.02]});
    let own = solved(&girder(9.0, 3.0), &crane(0.0, json!({ "limits": limits })));
    let row = check(&own, "deflection of the overhang");
    near(
        row,
        "applied",
        200.0 * 9.0 * 12.0 / (3.0 * 2.1e8 * 1.0718e-3),
        1e-4,
    );
    near(row, "limit", 3.0 / 250.0, 1e-12);
    assert!(row.get("code").is_none());
    assert_eq!(row["source"], "given in the input");
    near(
        check(&own, "vertical deflection"),
        "limit",
        9.0 / 750.0,
        1e-12,
    );
    assert!(omitted(&own, "no train has lateral forces, or"));
}

/// A design that names no code is not checked; where it names one, "OK" never stands alone, and `strict` fails.
#[test]
fn what_was_not_checked_is_said() {
    let mut light = crane(0.0, json!({}));
    for wheel in light["trains"][0]["wheels"].as_array_mut().expect("wheels") {
        wheel["vertical"] = json!(10);
    }
    let (folder, output) = run(&girder(9.0, 0.0), &light, &["--fail-on-limit=strict"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(summary(&folder)["verdict"]["result"], "not checked");
    light["practice"] = json!({"code": "EN 1993-6"});
    let (folder, output) = run(&girder(9.0, 0.0), &light, &["--fail-on-limit"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("verdict: OK for 1 check; "), "{said}");
    assert!(said.contains("checks of EN 1993-6 not done"), "{said}");
    let found = summary(&folder);
    assert_eq!(found["verdict"]["result"], "ok");
    assert!(omitted(&found, "lateral-torsional buckling"));
    let (_folder, output) = run(&girder(9.0, 0.0), &light, &["--fail-on-limit=strict"]);
    assert_eq!(output.status.code(), Some(1));
    let page = std::fs::read_to_string(folder.path().join("out/report.html")).expect("a report");
    let banner = page.find("OK for 1 check").expect("the banner");
    let first = page.find("<table").expect("a table");
    assert!(banner < first && page.contains("Not checked"));
}

/// The Eurocode asks for eccentric wheel loads; a design without them says so. A code without load groups needs no parts of
/// vertical forces.
#[test]
fn what_a_code_requires_of_the_loads_is_said() {
    let central = solved(&girder(9.0, 0.0), &crane(0.0, json!({"code": "EN 1993-6"})));
    assert!(omitted(&central, "torsion from eccentric wheel loads"));
    let mut design = crane(0.0, json!({"code": "EN 1993-6"}));
    design["trains"][0]["eccentricity"] = json!(0.0163);
    assert!(!omitted(
        &solved(&girder(9.0, 0.0), &design),
        "torsion from eccentric"
    ));
    let guide = json!({"code": "AISC Design Guide 7", "class": "D", "combinations": true});
    let found = solved(&girder(9.0, 0.0), &crane(0.0, guide));
    assert!(omitted(
        &found,
        "defines deflection limits but no load groups"
    ));
}

/// A limit from memory accepts nothing: AISC Design Guide 7 is not confirmed.
#[test]
fn a_limit_from_memory_fails_a_design_but_accepts_none() {
    let practice = json!({"code": "AISC Design Guide 7", "class": "C"});
    let heavy = solved(&girder(9.0, 0.0), &crane(0.0, practice.clone()));
    assert_eq!(check(&heavy, "vertical deflection")["result"], "fail");
    let mut light = crane(0.0, practice);
    for wheel in light["trains"][0]["wheels"].as_array_mut().expect("wheels") {
        wheel["vertical"] = json!(10);
    }
    let found = solved(&girder(9.0, 0.0), &light);
    assert_eq!(found["verdict"]["result"], "not checked");
    assert!(omitted(&found, "L/600 is from memory"));
}

/// Each slip leaves a warning on the terminal, and a line among what was not checked.
#[test]
fn slips_of_units_and_half_inputs_are_told() {
    let built_up = json!({"format": "girderway-beam/1", "units": {"length": "in", "force": "kip", "time": "s"},
        "girder": {"spans": [360], "E": 29000, "G": 11200, "fy": 50, "rail_height": 12.3, "crane_rail": "ASCE 60",
            "shape": {"kind": "I", "height": 32, "width": 16, "flange": 1, "lower_width": 12, "lower_flange": 1,
                "web": 0.5}}});
    let in_inches = |practice: Value| {
        let mut design = crane(0.0, practice);
        design["units"] = json!({"length": "in", "force": "kip", "time": "s"});
        for (wheel, x) in design["trains"][0]["wheels"]
            .as_array_mut()
            .expect("wheels")
            .iter_mut()
            .zip([0, 144])
        {
            *wheel = json!({"x": x, "vertical": 45});
        }
        design
    };
    let with = |base: &Value, pointer: &str, value: Value| {
        let mut out = base.clone();
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
        out.pointer_mut(parent).expect("a member")[key] = value;
        out
    };
    let plain = crane(2.0, json!({"code": "EN 1993-6"}));
    let wheels = |force: f64| json!([{"x": 0, "vertical": force}, {"x": 3, "vertical": force}]);
    let beam = girder(9.0, 0.0);
    let cases = [
        (
            built_up.clone(),
            in_inches(json!({})),
            "only its crane rail has mass",
        ),
        (
            with(&built_up, "/girder/I_vertical", json!(9402)),
            in_inches(json!({})),
            "`I_vertical` is 9402 in^4, that of the section",
        ),
        (
            with(&built_up, "/girder/J", json!(116)),
            in_inches(json!({})),
            "`J` is 116 in^4",
        ),
        (
            with(&beam, "/girder/I_lateral", json!(1.26e-5)),
            plain.clone(),
            "`I_lateral` is 0.0000126 m^4",
        ),
        (
            with(&beam, "/girder/A", json!(2.4)),
            plain.clone(),
            "`A` is 2.4 m^2",
        ),
        (
            beam.clone(),
            with(&plain, "/trains/0/wheels", wheels(6e4)),
            "a wheel has 60000 kN",
        ),
        (
            beam.clone(),
            with(&plain, "/trains/0/wheels", wheels(0.1)),
            "a wheel has 0.1 kN",
        ),
        (
            beam.clone(),
            with(&plain, "/trains/0/lateral", json!(2000)),
            "a wheel has 2000 kN laterally",
        ),
        (
            beam.clone(),
            with(&plain, "/practice/hoist_speed", json!(8)),
            "it is 8 m/s; usual are 0.02 to 1 m/s",
        ),
        (
            with(&beam, "/girder/spans", json!([6000])),
            plain.clone(),
            "a span has 6000 m",
        ),
        (
            with(&beam, "/girder/fy", json!(235)),
            plain.clone(),
            "plausibility of the spec",
        ),
        (
            with(&beam, "/girder/E", json!(210)),
            plain.clone(),
            "plausibility of the spec",
        ),
        (
            with(&beam, "/girder/rail_height", json!(250)),
            plain.clone(),
            "plausibility of the spec",
        ),
    ];
    for (spec, design, words) in cases {
        let (folder, output) = run(&spec, &design, &[]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{words}: {said}");
        assert!(
            omitted(&summary(&folder), words),
            "{words}: {}",
            summary(&folder)["verdict"]
        );
        assert!(said.contains("warning: "), "{words}: {said}");
    }
}

/// No example and no starter has such a line.
#[test]
fn sound_inputs_raise_no_doubt() {
    let starter = tempfile::tempdir().expect("a temporary folder");
    let made = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(["init", "runway", "runway"])
        .current_dir(starter.path())
        .status();
    assert!(made.expect("the program starts").success());
    for design in [
        root().join("examples/runway/design.json"),
        starter.path().join("runway/design.json"),
    ] {
        let out = starter.path().join("out");
        let output = Command::new(env!("CARGO_BIN_EXE_girderway"))
            .args(["design", "--force", "-o"])
            .arg(&out)
            .arg(&design)
            .output()
            .expect("the program starts");
        assert!(output.status.success(), "{}", design.display());
        let text = std::fs::read_to_string(out.join("summary.json")).expect("a summary");
        for words in [
            "unit of",
            "plausibility",
            "self-weight and mass",
            "agreement of",
        ] {
            assert!(!text.contains(words), "{}: {words}", design.display());
        }
    }
}
