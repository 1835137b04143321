//! Stresses, local wheel stresses, end stops, pairs of rails and groups of loads of a design, against hand calculations.

use serde_json::{Value, json};

use super::{by_name, coded, lateral_spec, number, run, summary, table};

/// A simple beam of 8 m of HEB 400 whose numbers are given, with the rail on its axis.
fn beam() -> Value {
    json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"}, "theory": "euler-bernoulli",
        "girder": {"spans": [8], "section": "HEB 400", "fy": 2.35e5, "E": 2.1e8, "G": 8.1e7, "A": 0.02, "I_vertical": 5.8e-4,
                   "I_lateral": 1.1e-4, "J": 3.6e-6, "mass_per_length": 0},
        "stations": [0, 4, 8]
    })
}

/// One wheel of 100 kN with 10 kN across and 50 kN along the rail.
fn wheel(practice: Value) -> Value {
    json!({
        "format": "girderway-design/1", "name": "wheel", "units": {"length": "m", "force": "kN", "time": "s"},
        "spec": "spec.json",
        "trains": [{"name": "crane", "wheels": [{"x": 0, "vertical": 100}], "lateral": 10, "longitudinal": 50}],
        "practice": practice
    })
}

pub(super) fn solved(spec: &Value, design: &Value) -> Value {
    let (folder, output) = run(spec, design, &[]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    summary(&folder)
}

pub(super) fn row<'s>(summary: &'s Value, list: &str, wanted: &[(&str, Value)]) -> &'s Value {
    let rows = summary[list]
        .as_array()
        .unwrap_or_else(|| panic!("no {list}"));
    let same = |row: &&Value| wanted.iter().all(|(key, value)| row[*key] == *value);
    rows.iter()
        .find(same)
        .unwrap_or_else(|| panic!("no row with {wanted:?} in {rows:?}"))
}

pub(super) fn value(row: &Value, key: &str) -> f64 {
    row[key]
        .as_f64()
        .unwrap_or_else(|| panic!("no number {key} in {row}"))
}

pub(super) fn close(found: f64, known: f64, what: &str) {
    assert!(
        (found / known - 1.0).abs() < 1e-9,
        "{what}: {found}, not {known}"
    );
}

/// Hand calculation: M_v = 100 * 8/4 = 200 kN m and M_l = 10 * 8/4 = 20 kN m under the wheel at midspan, N = 50 kN between the
/// wheel and the first support. sigma = 50/0.02 + 200 * 0.2/5.8e-4 + 20 * 0.15/1.1e-4 = 98738 kN/m2. The three extremes occur in
/// one state, so that the bound is the value. Shear: 100 kN at a support, over 0.4 m * 0.0135 m, against f_y/sqrt(3).
#[test]
fn stresses_are_those_of_the_coincident_forces() {
    let found = solved(&beam(), &wheel(json!({})));
    let direct = row(&found, "stresses", &[("quantity", json!("direct stress"))]);
    let parts = [50.0 / 0.02, 200.0 * 0.2 / 5.8e-4, 20.0 * 0.15 / 1.1e-4];
    let stress: f64 = parts.iter().sum();
    close(value(direct, "value").abs(), stress, "direct stress");
    close(value(direct, "utilisation"), stress / 2.35e5, "utilisation");
    close(value(direct, "bound"), stress / 2.35e5, "bound");
    for (name, part) in ["normal", "vertical", "lateral"].iter().zip(parts) {
        close(value(&direct["parts"], name).abs(), part, name);
    }
    assert_eq!(
        (value(direct, "x"), value(direct, "position")),
        (4.0, 4.0),
        "{direct}"
    );
    assert_eq!(
        (&direct["lateral_section"], &direct["sampled"]),
        (&json!("whole section"), &json!(true))
    );
    let shear = row(
        &found,
        "stresses",
        &[("quantity", json!("shear stress in the web"))],
    );
    close(
        value(shear, "value").abs(),
        100.0 / (0.4 * 0.0135),
        "shear stress",
    );
    close(value(shear, "strength"), 2.35e5 / 3f64.sqrt(), "strength");
    assert_eq!(found["within"], json!(true));
}

/// Hand calculation: the top flange alone, 24 mm by 300 mm, has W = 0.024 * 0.3^2/6 = 3.6e-4 m3 and takes 20/3.6e-4 kN/m2; the
/// bottom flange takes nothing of the lateral moment. The largest stress is therefore compression at the top.
#[test]
fn the_top_flange_alone_takes_lateral_moments_where_it_is_asked_to() {
    let (folder, output) = run(
        &beam(),
        &wheel(json!({"lateral_section": "top flange"})),
        &[],
    );
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let page = std::fs::read_to_string(folder.path().join("out/report.html")).expect("a report");
    for part in [
        "Largest stresses of each rail",
        "lateral moments on the top flange alone",
    ] {
        assert!(page.contains(part), "the page does not say: {part}");
    }
    let found = summary(&folder);
    let direct = row(&found, "stresses", &[("quantity", json!("direct stress"))]);
    let stress = 200.0 * 0.2 / 5.8e-4 + 20.0 / (0.024 * 0.09 / 6.0) + 50.0 / 0.02;
    close(value(direct, "value"), -stress, "top flange");
    close(
        value(&direct["parts"], "lateral"),
        -20.0 / 3.6e-4,
        "lateral part",
    );
    assert!(
        direct["fibre"]
            .as_str()
            .is_some_and(|fibre| fibre.starts_with("top")),
        "{direct}"
    );
    assert_eq!(direct["lateral_section"], json!("top flange"));
}

/// Analytic: a stress above its strength makes `within` false and, where asked, the exit status 1.
#[test]
fn a_stress_above_its_strength_is_a_result() {
    let mut spec = beam();
    spec["girder"]["fy"] = json!(9e4);
    let (folder, output) = run(&spec, &wheel(json!({})), &["--fail-on-limit"]);
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        said.contains("NOT OK: direct stress, the rail, span 1, case 1"),
        "{said}"
    );
    assert_eq!(summary(&folder)["within"], json!(false));
    let (_folder, output) = run(&spec, &wheel(json!({})), &[]);
    assert_eq!(output.status.code(), Some(0));
}

/// Analytic: what a row needs and the files lack is named; nothing is assumed.
#[test]
fn stresses_without_data_are_left_out_by_name() {
    let mut spec = beam();
    spec["girder"]
        .as_object_mut()
        .expect("an object")
        .remove("fy");
    let found = solved(&spec, &wheel(json!({})));
    assert!(found.get("stresses").is_none());
    let said = found["left_out"].to_string();
    for part in [
        "stress utilisation on the rail: the material of section HEB 400 has no yield strength `fy`",
        "local wheel stress in the web on the rail: specify the `crane_rail`",
    ] {
        assert!(said.contains(part), "{said}");
    }
    let mut spec = lateral_spec();
    spec["girder"]["fy"] = json!(2.35e5);
    let said = solved(&spec, &wheel(json!({})))["left_out"].to_string();
    assert!(
        said.contains("section girder has no shape: name a rolled section"),
        "{said}"
    );
}

/// Hand calculation in mm: A65 has I_r = 319e4, A_r = 5490, its centroid 30.84 above its base of 175, and is 75 high (DIN 536-1
/// and British Steel); HEB 400 has t_w = 13.5, t_f = 24, b = 300. b_eff = 175 + 75 + 24 = 274, I_f = 274 * 24^3/12 = 315648.
/// Loose: 3.25 (3505648/13.5)^(1/3) = 207.346; pad: 4.25 in place of 3.25; rigid, with A_f = 274 * 24 = 6576 and d = 42.84:
/// I_rf = 3505648 + 5490 * 6576/12066 * 42.84^2 = 8996846.
#[test]
fn local_stresses_follow_from_the_effective_length() {
    let mut spec = beam();
    spec["girder"]["crane_rail"] = json!("A65");
    let loose = 3.25 * (3_505_648.0f64 / 13.5).cbrt();
    let rigid = 3_505_648.0 + 5490.0 * 6576.0 / 12066.0 * 42.84f64.powi(2);
    for (practice, word, assumed, length) in [
        (json!({}), "loose", true, loose),
        (json!({"rail_fastening": "loose"}), "loose", false, loose),
        (
            json!({"rail_fastening": "pad"}),
            "pad",
            false,
            loose * 4.25 / 3.25,
        ),
        (
            json!({"rail_fastening": "rigid"}),
            "rigid",
            false,
            3.25 * (rigid / 13.5).cbrt(),
        ),
    ] {
        let mut design = wheel(practice);
        design["cases"] = json!([["crane"], {"name": "factored", "trains": ["crane"], "factors": {"vertical": 1.5}}]);
        let found = solved(&spec, &design);
        for (case, force) in [(1, 100.0), (2, 150.0)] {
            let local = row(&found, "wheel_stresses", &[("case", json!(case))]);
            assert_eq!(
                (&local["fastening"], &local["fastening_assumed"]),
                (&json!(word), &json!(assumed))
            );
            close(value(local, "effective_length"), 1e-3 * length, word);
            let stress = force / (1e-3 * length * 0.0135);
            close(value(local, "vertical"), stress, "sigma_oz");
            close(value(local, "shear"), 0.2 * stress, "local shear");
            // One wheel: sigma_oz comes and goes once a passage, the local shear reverses. The girder's own largest shear is the
            // whole wheel at a support.
            assert_eq!(local["cycles"].as_array().map(Vec::len), Some(1));
            close(
                value(&local["cycles"][0], "vertical"),
                stress,
                "range of sigma_oz",
            );
            close(
                value(&local["cycles"][0], "shear"),
                0.4 * stress,
                "range of the local shear",
            );
            let girder = value(local, "global_shear");
            assert!(girder >= force / (0.4 * 0.0135) * (1.0 - 1e-12), "{girder}");
            close(
                value(local, "total_shear"),
                girder + 0.2 * stress,
                "total shear",
            );
            close(value(local, "utilisation"), stress / 2.35e5, "utilisation");
        }
    }
}

/// Hand calculation: two wheels of 100 kN at 0.15 m on an effective length of 0.207 m press together on the web; at 0.3 m they do
/// not, and a passage has a cycle for each.
#[test]
fn wheels_closer_than_the_effective_length_press_together() {
    let mut spec = beam();
    spec["girder"]["crane_rail"] = json!("A65");
    for (distance, together) in [(0.15, 200.0), (0.3, 100.0)] {
        let mut design = wheel(json!({}));
        design["trains"][0]["wheels"] =
            json!([{"x": 0, "vertical": 100}, {"x": distance, "vertical": 100}]);
        let found = solved(&spec, &design);
        let local = row(&found, "wheel_stresses", &[("case", json!(1))]);
        assert_eq!(
            (value(local, "force"), value(local, "overlapping")),
            (100.0, together),
            "{local}"
        );
        close(
            value(local, "vertical"),
            together / (value(local, "effective_length") * 0.0135),
            "sigma_oz",
        );
        assert_eq!(local["cycles"].as_array().map(Vec::len), Some(2));
    }
}

/// Facts of the table: CR 104 has dimensions but no second moment there, and A45 no area, which a rigid rail needs.
#[test]
fn crane_rails_without_data_are_left_out_by_name() {
    for (rail, practice, known) in [
        (
            "CR 104",
            json!({}),
            "the tables have no second moment of area for vertical bending of the crane rail CR 104",
        ),
        (
            "A45",
            json!({"rail_fastening": "rigid"}),
            "the tables have no area or no centroid of the crane rail A45",
        ),
    ] {
        let mut spec = beam();
        spec["girder"]["crane_rail"] = json!(rail);
        let found = solved(&spec, &wheel(practice));
        let said = found["left_out"].to_string();
        assert!(
            said.contains(known) && found.get("wheel_stresses").is_none(),
            "{said}"
        );
    }
}

/// Hand calculation: a buffer force of 80 kN with the factor 1.25 presses 100 kN on the stop at either end; without a factor no
/// stop has a force.
#[test]
fn end_stops_have_the_factored_buffer_force() {
    let mut design = wheel(json!({}));
    design["trains"][0]["buffer"] = json!(80);
    let found = solved(&beam(), &design);
    assert!(found.get("end_stops").is_none());
    assert!(
        found["left_out"]
            .to_string()
            .contains("forces on end stops: no case has a factor for `buffer`")
    );
    design["cases"] = json!([{"name": "stop", "trains": ["crane"], "factors": {"buffer": 1.25}}]);
    let found = solved(&beam(), &design);
    for (stop, x, force) in [("first", 0.0, -100.0), ("last", 8.0, 100.0)] {
        let row = row(&found, "end_stops", &[("stop", json!(stop))]);
        assert_eq!((value(row, "x"), value(row, "force")), (x, force), "{row}");
    }
    assert_eq!(found["end_stops"].as_array().map(Vec::len), Some(2));
    design["trains"][0]["signs"] = json!("given");
    let found = solved(&beam(), &design);
    assert_eq!(
        found["end_stops"].as_array().map(Vec::len),
        Some(1),
        "a force along +x meets the last stop only"
    );
}

/// Hand calculation, EN 1991-3: group 6 has the force of the trolley's drives 0.1 (Q + T) = 0.1 (240 + 40) = 28 kN, 14 kN on each of
/// two wheels; group 8 has phi1 = 1.1 on the crane, phi5 = 1.5 on drives and the test load: 1.25 Q, more than phi6 1.1 Q = 1.0726 *
/// 1.1 Q. A single wheel over a support brings its whole lateral force there.
#[test]
fn groups_6_and_8_follow_from_the_weights_and_the_test_load() {
    let practice =
        json!({"code": "EN 1991-3", "hoisting": "HC2", "hoist_speed": 0.133, "combinations": true});
    let mut design = coded(practice);
    let found = solved(&lateral_spec(), &design);
    let said = found["left_out"].to_string();
    for part in [
        "group 6 (EN 1991-3:2006): no train has `hoist_load` and `trolley`",
        "group 10 (EN 1991-3:2006): no wheel has a `tilting` force",
        "in-service wind in groups 1, 2, 3, 4, 5, 8",
    ] {
        assert!(said.contains(part), "{said}");
    }
    let eighth = &by_name(&found, "crane: EN 1991-3:2006 group 8")["factors"];
    for (load, known) in [
        ("crane", 1.1),
        ("hoist", 1.25),
        ("longitudinal", 1.5),
        ("buffer", 0.0),
        ("skewing", 0.0),
    ] {
        close(1.0 + value(eighth, load), 1.0 + known, load);
    }
    design["trains"][0]["hoist_load"] = json!(240);
    design["trains"][0]["trolley"] = json!(40);
    let (folder, output) = run(&lateral_spec(), &design, &[]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let found = summary(&folder);
    let sixth = by_name(&found, "crane: EN 1991-3:2006 group 6");
    for (load, known) in [
        ("crane", 1.0),
        ("hoist", 1.0),
        ("trolley drives", 1.0),
        ("lateral", 0.0),
    ] {
        close(1.0 + value(&sixth["factors"], load), 1.0 + known, load);
    }
    let rows = table(&folder.path().join("out"), "reactions.csv");
    let case = sixth["case"].to_string();
    let own = |row: &&std::collections::BTreeMap<String, String>| {
        row["load"] == "trolley drives"
            && row["direction"] == "uz"
            && row["support"] == "support1"
            && row["kind"] == "max"
    };
    let listed: Vec<_> = rows.iter().filter(own).collect();
    assert!(
        listed.len() == 1 && listed[0]["case"] == case,
        "only group 6 has this load: {listed:?}"
    );
    // 14 kN over the support and 14 kN at 3.6 m, as a fraction of the vertical reaction of the same wheels of 180 kN (equal spans,
    // no shear flexibility laterally): between 14 and 28 kN.
    let reaction = number(&listed[0]["value"]);
    assert!(reaction > 14.0 && reaction < 28.0, "{reaction}");
}

/// Two simple beams of 6 m, 10 m apart, with a crane that stands on both.
pub(super) fn runways() -> (Value, Value) {
    let support = |point: usize, last: bool| {
        let fix = if last {
            json!(["uy", "uz", "rx"])
        } else {
            json!(["ux", "uy", "uz", "rx"])
        };
        json!({"point": point, "fix": fix})
    };
    let rail = |z: f64, cell: usize| json!({"origin": [0, 0, z], "axis": [1, 0, 0], "segments": [{"cell": [0, cell]}], "stations": [0, 3, 6]});
    let spec = json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"}, "theory": "euler-bernoulli",
        "points": [[0, 0, 0], [6, 0, 0], [0, 0, 10], [6, 0, 10]],
        "cells": [{"type": "line", "data": [[0, 1], [2, 3]]}],
        "materials": [{"name": "S355", "E": 2.1e8, "G": 8.1e7, "fy": 3.55e5}],
        "sections": [{"name": "girder", "material": "S355",
                      "shape": {"kind": "I", "length": "mm", "height": 600, "width": 300, "flange": 20, "web": 10}}],
        "supports": [support(0, false), support(1, true), support(2, false), support(3, true)],
        "rails": {"west": rail(0.0, 0), "east": rail(10.0, 1)}
    });
    let design = json!({
        "format": "girderway-design/1", "name": "pair", "units": {"length": "m", "force": "kN", "time": "s"}, "spec": "spec.json",
        "trains": [{"name": "crane", "rail": "west", "signs": "given",
                    "wheels": [{"x": 0, "vertical": 120, "lateral": -6}, {"x": 0, "vertical": 40, "lateral": 4, "rail": "east"}]}],
        "practice": {"code": "EN 1991-3"}
    });
    (spec, design)
}

/// Hand calculation: both wheels at midspan deflect their beams by F L^3/(48 E I). In mm: I_v = 300 * 600^3/12 - 290 * 560^3/12,
/// I_l = 2 * 20 * 300^3/12 + 560 * 10^3/12. The second rail is above the first by 80 kN of the formula, and they move apart by 10
/// kN of it. Limits: s/600 = 10 m/600 and 10 mm (EN 1993-6, Tables 7.2 and 7.1).
#[test]
fn two_rails_have_a_gauge_and_a_difference_in_height() {
    let (spec, design) = runways();
    let found = solved(&spec, &design);
    let vertical = 1e-12 * (300.0 * 600f64.powi(3) - 290.0 * 560f64.powi(3)) / 12.0;
    let lateral = 1e-12 * (40.0 * 300f64.powi(3) + 560.0 * 1000.0) / 12.0;
    let sag = |force: f64, i: f64| force * 216.0 / (48.0 * 2.1e8 * i);
    for (quantity, known, limit) in [
        ("difference in height", -sag(80.0, vertical), 10.0 / 600.0),
        ("change of gauge", sag(10.0, lateral), 0.010),
    ] {
        let response = row(&found, "pairs", &[("quantity", json!(quantity))]);
        close(value(response, "value"), known, quantity);
        assert_eq!(
            (value(response, "x"), value(response, "distance")),
            (3.0, 10.0),
            "{response}"
        );
        let limited = row(&found, "limits", &[("quantity", json!(quantity))]);
        close(value(limited, "limit"), limit, "limit");
        close(value(limited, "value"), known.abs(), "limited value");
        assert_eq!(
            (&limited["sampled"], &limited["rail"]),
            (&json!(true), &json!("west, east"))
        );
    }
    let said = found["left_out"].to_string();
    assert!(
        !said.contains("gauge_change") && !said.contains("height_difference"),
        "{said}"
    );
}

/// Hand calculation on the same beams: the wheel of 120 kN at midspan gives M_v = 180 and M_l = 9 kN m.
#[test]
fn plates_of_the_general_form_have_fibres() {
    let (spec, design) = runways();
    let found = solved(&spec, &design);
    let west = row(
        &found,
        "stresses",
        &[
            ("rail", json!("west")),
            ("quantity", json!("direct stress")),
        ],
    );
    let vertical = 1e-12 * (300.0 * 600f64.powi(3) - 290.0 * 560f64.powi(3)) / 12.0;
    let lateral = 1e-12 * (40.0 * 300f64.powi(3) + 560.0 * 1000.0) / 12.0;
    close(
        value(west, "value").abs(),
        180.0 * 0.3 / vertical + 9.0 * 0.15 / lateral,
        "stress",
    );
    close(value(west, "strength"), 3.55e5, "strength");
    let shear = row(
        &found,
        "stresses",
        &[
            ("rail", json!("east")),
            ("quantity", json!("shear stress in the web")),
        ],
    );
    close(value(shear, "value").abs(), 40.0 / 0.006, "shear");
}

/// Hand calculation: an I section with unequal flanges upside down. Plates 300 x 20 (wide), 560 x 10 and 150 x 20 in mm: areas
/// 6000, 5600, 3000; the centroid lies (6000 * 10 + 5600 * 300 + 3000 * 590)/14600 = 240.41 mm from the edge of the wide flange,
/// which is at the bottom where local y points down. The largest stress is at the narrow flange, above.
#[test]
fn sections_upside_down_keep_their_plates() {
    let (mut spec, mut design) = runways();
    spec["sections"][0]["shape"] = json!({"kind": "I", "length": "mm", "height": 600, "width": 300, "flange": 20, "web": 10, "lower_width": 150});
    spec["cell_data"] = json!({"orientation": [[0, -1, 0]]});
    for wheel in 0..2 {
        design["trains"][0]["wheels"][wheel]["lateral"] = json!(0);
    }
    let found = solved(&spec, &design);
    let west = row(
        &found,
        "stresses",
        &[
            ("rail", json!("west")),
            ("quantity", json!("direct stress")),
        ],
    );
    let low = (6000.0 * 10.0 + 5600.0 * 300.0 + 3000.0 * 590.0) / 14600.0;
    let own = (300.0 * 8000.0 + 150.0 * 8000.0 + 10.0 * 560f64.powi(3)) / 12.0;
    let inertia = own
        + 6000.0 * (low - 10.0f64).powi(2)
        + 5600.0 * (300.0f64 - low).powi(2)
        + 3000.0 * (590.0f64 - low).powi(2);
    close(
        value(west, "value"),
        -180.0 * 1e-3 * (600.0 - low) / (1e-12 * inertia),
        "compression above",
    );
    assert!(
        west["fibre"]
            .as_str()
            .is_some_and(|fibre| fibre.starts_with("top")),
        "{west}"
    );
}

/// Hand calculation: W24X94 is 24.3 in deep with a web of 0.515 in (AISC). The spec is in ft and lbf, the design in in and kip:
/// 20 kip at a support over 24.3 * 0.515 in2, against 50/sqrt(3) ksi; M = 20 * 240/4 kip in over I.
#[test]
fn stresses_have_the_units_of_the_design() {
    let spec = json!({
        "format": "girderway-beam/1", "units": {"length": "ft", "force": "lbf", "time": "s"}, "theory": "euler-bernoulli",
        "girder": {"spans": [20], "section": "W24x94", "fy": 7.2e6, "I_vertical": 0.13, "mass_per_length": 0}, "stations": [0, 20]
    });
    let design = json!({
        "format": "girderway-design/1", "name": "inches", "units": {"length": "in", "force": "kip", "time": "s"},
        "spec": "spec.json", "trains": [{"name": "hoist", "wheels": [{"x": 0, "vertical": 20}]}]
    });
    let found = solved(&spec, &design);
    let shear = row(
        &found,
        "stresses",
        &[("quantity", json!("shear stress in the web"))],
    );
    close(
        value(shear, "value").abs(),
        20.0 / (24.3 * 0.515),
        "shear stress",
    );
    close(value(shear, "strength"), 50.0 / 3f64.sqrt(), "strength");
    let direct = row(&found, "stresses", &[("quantity", json!("direct stress"))]);
    close(
        value(direct, "value").abs(),
        20.0 * 60.0 * 12.15 / (0.13 * 12f64.powi(4)),
        "direct stress",
    );
}

/// Analytic, sampled here every 2 mm with the section at either wheel: wheels of 100 and 60 kN whose lateral forces of 5 and 15 kN
/// are not in proportion, so that both moments are not largest at once. The value is a stress that occurs, not above the largest
/// and not far below it; the bound is not exceeded.
#[test]
fn the_utilisation_is_enclosed_by_its_bound() {
    let mut design = wheel(json!({}));
    design["trains"] = json!([{"name": "crane", "turned": false,
        "wheels": [{"x": 0, "vertical": 100, "lateral": 5}, {"x": 3, "vertical": 60, "lateral": 15}]}]);
    let found = solved(&beam(), &design);
    let direct = row(&found, "stresses", &[("quantity", json!("direct stress"))]);
    let moment = |x: f64, at: f64, force: f64| {
        if x <= at {
            force * (8.0 - at) / 8.0 * x
        } else {
            force * at / 8.0 * (8.0 - x)
        }
    };
    let mut largest: f64 = 0.0;
    for step in 0..=2500 {
        let p = 0.002 * f64::from(step);
        for x in [p, p + 3.0] {
            let vertical = moment(x, p, 100.0) + moment(x, p + 3.0, 60.0);
            let lateral = moment(x, p, 5.0) + moment(x, p + 3.0, 15.0);
            largest = largest.max(vertical * 0.2 / 5.8e-4 + lateral * 0.15 / 1.1e-4);
        }
    }
    let (stress, bound) = (
        value(direct, "value").abs(),
        2.35e5 * value(direct, "bound"),
    );
    assert!(
        stress <= largest * (1.0 + 1e-4) && stress >= 0.99 * largest,
        "{stress} and {largest}"
    );
    assert!(
        bound >= largest * (1.0 - 1e-12) && bound > stress * 1.001,
        "{bound} and {largest}"
    );
}
