//! Stresses of tapered members, of members with a crane rail in their section and of girders by their plates; lateral limits
//! where vertical forces bend a girder sideways; the group of loads of a crane that tilts.

use serde_json::{Value, json};

use super::details::{close, row, solved, value};
use super::{by_name, run, summary, table};

/// A simple beam of 8 m that tapers from 400 mm to 800 mm in four parts; flanges 200 x 20 mm, web 10 mm. The cell may run
/// against the rail.
fn tapered(is_reversed: bool) -> Value {
    let section = |name: &str, height: f64| {
        json!({"name": name, "material": "S235",
               "shape": {"kind": "I", "length": "mm", "height": height, "width": 200, "flange": 20, "web": 10}})
    };
    let [cell, ends] = if is_reversed {
        [[1, 0], [1, 0]]
    } else {
        [[0, 1], [0, 1]]
    };
    json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"}, "theory": "euler-bernoulli",
        "points": [[0, 0, 0], [8, 0, 0]], "cells": [{"type": "line", "data": [cell]}],
        "cell_data": {"section": [[ends[0]]], "section_b": [[ends[1]]], "orientation": [[[0, 1, 0]]]}, "parts": 4,
        "materials": [{"name": "S235", "E": 2.1e8, "G": 8.1e7, "fy": 2.35e5}],
        "sections": [section("low", 400.0), section("high", 800.0)],
        "supports": [{"point": 0, "fix": ["ux", "uy", "uz", "rx"]}, {"point": 1, "fix": ["uy", "uz", "rx"]}],
        "rails": {"rail": {"axis": [1, 0, 0], "segments": [{"cell": [0, 0]}], "stations": [0, 4, 8]}}
    })
}

/// One wheel of a vertical and a longitudinal force.
fn wheel(vertical: f64, longitudinal: f64) -> Value {
    json!({
        "format": "girderway-design/1", "name": "wheel", "units": {"length": "m", "force": "kN", "time": "s"},
        "spec": "spec.json",
        "trains": [{"name": "crane", "wheels": [{"x": 0, "vertical": vertical}], "longitudinal": longitudinal}]
    })
}

/// Hand calculation: under the wheel at x the moment is 100 x (8 - x)/8 and the height 0.4 + 0.05 x, so that sigma = M (h/2)/I
/// with I = (0.2 h^3 - 0.19 (h - 0.04)^3)/12; the largest of the listed places governs. The shear force is 100 kN at the lower
/// end, over 0.4 m * 0.01 m.
#[test]
fn stresses_of_a_tapered_member_are_those_of_the_dimensions_at_the_place() {
    let stress = |x: f64| {
        let h: f64 = 0.4 + 0.05 * x;
        let second = (0.2 * h.powi(3) - 0.19 * (h - 0.04).powi(3)) / 12.0;
        100.0 * x * (8.0 - x) / 8.0 * 0.5 * h / second
    };
    for is_reversed in [false, true] {
        let found = solved(&tapered(is_reversed), &wheel(100.0, 0.0));
        let direct = row(&found, "stresses", &[("quantity", json!("direct stress"))]);
        close(
            value(direct, "value").abs(),
            stress(value(direct, "x")),
            "direct stress",
        );
        close(
            value(direct, "utilisation"),
            stress(value(direct, "x")) / 2.35e5,
            "utilisation",
        );
        let largest = (0..=20)
            .map(|k| stress(0.4 * f64::from(k)))
            .fold(0.0, f64::max);
        assert!(
            value(direct, "value").abs() >= largest * (1.0 - 1e-9),
            "{direct}, {largest} at the twentieths"
        );
        assert!(direct.get("bound").is_none(), "{direct}");
        let name = if is_reversed {
            "high to low"
        } else {
            "low to high"
        };
        assert_eq!(direct["section"], json!(name));
        let shear = row(
            &found,
            "stresses",
            &[("quantity", json!("shear stress in the web"))],
        );
        close(
            value(shear, "value").abs(),
            100.0 / (0.4 * 0.01),
            "shear stress",
        );
        assert_eq!(value(shear, "x"), 0.0);
    }
}

/// A taper between numbers, or between shapes of two kinds, has no dimensions between its ends: the row is left out by name.
#[test]
fn tapers_without_dimensions_are_left_out_by_name() {
    let mut numbers = tapered(false);
    numbers["sections"][1]["Iz"] = json!(1e-3);
    let mut kinds = tapered(false);
    kinds["sections"][1]["shape"] = json!({"kind": "bar", "height": 0.8, "width": 0.1});
    for spec in [numbers, kinds] {
        let found = solved(&spec, &wheel(100.0, 0.0));
        let known = "stress utilisation on the rail: the dimensions of members that taper from section low to section high";
        let said = found["left_out"].to_string();
        assert!(
            said.contains(known) && found.get("stresses").is_none(),
            "{said}"
        );
    }
}

/// A simple beam of 8 m of HEB 400 with the rail A65 as a part of its section; the base of the rail is at a height.
fn composite(height: f64) -> Value {
    json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"}, "theory": "euler-bernoulli",
        "girder": {"spans": [8], "section": "HEB 400", "fy": 2.35e5, "E": 2.1e8, "G": 8.1e7, "A": 0.02, "I_vertical": 5.8e-4,
                   "I_lateral": 1.1e-4, "J": 3.6e-6, "mass_per_length": 0, "crane_rail": "A65", "composite": true,
                   "rail_height": height},
        "stations": [0, 4, 8]
    })
}

/// Area, height e of the common centroid above the axis of the girder, and second moment of the girder with its rail: A65 has
/// 5490 mm2, 319e4 mm4 and its centroid 30.84 mm above its base (DIN 536-1 and British Steel). I = I_g + I_r + A_g A_r/A h^2.
fn whole(height: f64) -> [f64; 3] {
    let (rail, h) = (5490e-6, height + 0.03084);
    let area = 0.02 + rail;
    [
        area,
        h * rail / area,
        5.8e-4 + 319e-8 + 0.02 * rail / area * h * h,
    ]
}

/// Hand calculation: 200 kN m at midspan; the edges of the lower flange are 0.2 m + e below the common centroid. The stress in
/// the head of the rail is left out by name, and shear is that of the web.
#[test]
fn a_rail_in_the_section_moves_the_centroid_towards_it() {
    let found = solved(&composite(0.2), &wheel(100.0, 0.0));
    let direct = row(&found, "stresses", &[("quantity", json!("direct stress"))]);
    let [_, e, second] = whole(0.2);
    close(
        value(direct, "value"),
        200.0 * (0.2 + e) / second,
        "lower flange",
    );
    close(
        value(direct, "bound"),
        200.0 * (0.2 + e) / second / 2.35e5,
        "bound",
    );
    assert!(
        direct["fibre"]
            .as_str()
            .is_some_and(|fibre| fibre.starts_with("bottom")),
        "{direct}"
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
    let said = found["left_out"].to_string();
    let known = "direct stress of a crane rail that is a part of the section, on the rail: the spec does not specify its strength";
    assert!(said.contains(known), "{said}");
}

/// Hand calculation: a longitudinal force of 50 kN at the top of the rail, 0.075 m above the axis, near the far end: N = 50 kN in
/// the axis and M = -50 * 0.075 about it, which is M + N e about the common centroid. The upper flange has
/// N/A + (50 * 0.075 - N e)(0.2 - e)/I.
#[test]
fn normal_forces_act_in_the_axis_below_the_centroid() {
    let found = solved(&composite(0.0), &wheel(0.0, 50.0));
    let direct = row(&found, "stresses", &[("quantity", json!("direct stress"))]);
    let [area, e, second] = whole(0.0);
    let stress = 50.0 / area + (50.0 * 0.075 - 50.0 * e) * (0.2 - e) / second;
    close(value(direct, "value").abs(), stress, "upper flange");
    assert!(
        direct["fibre"]
            .as_str()
            .is_some_and(|fibre| fibre.starts_with("top")),
        "{direct}"
    );
}

/// Closed form: a wheel of 100 kN, 0.05 m beside the web of a simple beam, twists its middle by T L/(4 G J), T = 5 kN m, and
/// moves a rail 0.3 m above the axis sideways by 0.3 times as much, though no lateral force acts. Over the web nothing moves
/// sideways, and the row is left out by name.
#[test]
fn lateral_limits_count_where_vertical_forces_bend_sideways() {
    let spec = json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"}, "theory": "euler-bernoulli",
        "girder": {"spans": [8], "E": 2.1e8, "G": 8.1e7, "A": 0.02, "I_vertical": 5.8e-4, "I_lateral": 1.1e-4, "J": 3.6e-6,
                   "rail_height": 0.3},
        "stations": [0, 4, 8]
    });
    let mut design = wheel(100.0, 0.0);
    design["practice"] = json!({"code": "EN 1993-6"});
    let lateral = |found: &Value| {
        let rows = found["limits"].as_array().expect("limits").clone();
        rows.into_iter()
            .filter(|row| row["quantity"] == "lateral deflection")
            .collect::<Vec<Value>>()
    };
    let found = solved(&spec, &design);
    assert!(lateral(&found).is_empty());
    assert!(
        found["left_out"]
            .to_string()
            .contains("no train has lateral forces"),
        "{}",
        found["left_out"]
    );
    design["trains"][0]["eccentricity"] = json!(0.05);
    let found = solved(&spec, &design);
    let rows = lateral(&found);
    assert_eq!(rows.len(), 1, "{rows:?}");
    assert_eq!(
        rows[0]["loads"],
        json!("vertical wheel loads only, which displace the rail laterally")
    );
    close(
        value(&rows[0], "value"),
        0.3 * 5.0 * 8.0 / (4.0 * 8.1e7 * 3.6e-6),
        "lateral deflection",
    );
    assert!(
        !found["left_out"]
            .to_string()
            .contains("no train has lateral forces"),
        "{}",
        found["left_out"]
    );
}

/// Hand calculation: 600 x 300 mm, flanges 20 mm, web 10 mm: I = (0.3 * 0.6^3 - 0.29 * 0.56^3)/12 for 200 kN m.
#[test]
fn a_girder_by_its_plates_has_stresses() {
    let spec = json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"}, "theory": "euler-bernoulli",
        "girder": {"spans": [8], "E": 2.1e8, "G": 8.1e7, "fy": 2.35e5,
                   "shape": {"kind": "I", "length": "mm", "height": 600, "width": 300, "flange": 20, "web": 10}},
        "stations": [0, 4, 8]
    });
    let found = solved(&spec, &wheel(100.0, 0.0));
    let direct = row(&found, "stresses", &[("quantity", json!("direct stress"))]);
    let second = (0.3 * 0.6f64.powi(3) - 0.29 * 0.56f64.powi(3)) / 12.0;
    close(
        value(direct, "value").abs(),
        200.0 * 0.3 / second,
        "direct stress",
    );
}

/// EN 1991-3, Table 2.2 (from memory): group 10 has the crane, the hoisted load and the tilting force, each with the factor 1.
/// The crane tilts by 40 kN from one wheel to the other and pushes 8 kN sideways: over a support the lifted wheel
/// brings 180 - 40 kN there, in the group alone.
#[test]
fn group_10_has_the_forces_of_a_crane_that_tilts() {
    let mut spec = composite(0.0);
    spec["girder"]
        .as_object_mut()
        .expect("an object")
        .retain(|key, _| !key.starts_with("c"));
    let parts = |tilting: f64| json!({"crane": 60, "hoist": 120, "tilting": tilting});
    let design = json!({
        "format": "girderway-design/1", "name": "tilting", "units": {"length": "m", "force": "kN", "time": "s"},
        "spec": "spec.json",
        "trains": [{"name": "crane", "turned": false, "signs": "given",
                    "wheels": [{"x": 0, "vertical": parts(-40.0), "tilting": 8}, {"x": 8, "vertical": parts(40.0)}]}],
        "practice": {"code": "EN 1991-3", "hoisting": "HC2", "hoist_speed": 0.133, "combinations": true}
    });
    let (folder, output) = run(&spec, &design, &[]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let found = summary(&folder);
    let tenth = by_name(&found, "crane: EN 1991-3:2006 group 10");
    for (load, known) in [
        ("crane", 1.0),
        ("hoist", 1.0),
        ("tilting", 1.0),
        ("lateral", 0.0),
        ("buffer", 0.0),
    ] {
        close(1.0 + value(&tenth["factors"], load), 1.0 + known, load);
    }
    let reaction = |case: &Value, support: &str, direction: &str| {
        let wanted = [
            ("case", case.clone()),
            ("support", json!(support)),
            ("direction", json!(direction)),
        ];
        value(row(&found, "extremes", &wanted), "value")
    };
    let case = &tenth["case"];
    close(reaction(case, "support1", "uy"), 140.0, "the lifted wheel");
    close(reaction(case, "support2", "uy"), 220.0, "the pressed wheel");
    close(reaction(case, "support1", "uz"), -8.0, "sideways");
    close(
        reaction(&json!(1), "support1", "uy"),
        180.0,
        "without tilting",
    );
    assert_eq!(reaction(&json!(1), "support1", "uz"), 0.0);
    let rows = table(&folder.path().join("out"), "reactions.csv");
    let own = |row: &&std::collections::BTreeMap<String, String>| {
        row["load"] == "tilting"
            && row["support"] == "support1"
            && row["direction"] == "uy"
            && row["kind"] == "max"
    };
    let alone: Vec<f64> = rows
        .iter()
        .filter(own)
        .map(|row| super::number(&row["value"]))
        .collect();
    assert!(
        alone.iter().all(|value| (value + 40.0).abs() < 1e-9) && alone.len() > 1,
        "{alone:?}"
    );
    let said = found["left_out"].to_string();
    assert!(!said.contains("group 10"), "{said}");
    assert!(
        said.contains("part eta of the hoisted load that remains after release, in group 7"),
        "{said}"
    );
}
