//! Scenes of bodies on bodies: equalisers with mass, and a trolley on a bridge.

use std::fs;

use tempfile::TempDir;

use super::{example, folder, girderway, json, text};

const BEAM: &str = r#"{"format": "girderway-beam/1", "units": {"length": "m", "force": "N", "time": "s"},
 "girder": {"spans": [20], "E": 2.1e11, "I_vertical": 0.02, "mass_per_length": 300}, "stations": [0, 5, 10, 15, 20]}"#;

/// A bridge of 10 t on four wheels over a rigid runway; on it a girder along x, from x = -10 to 10 m and 1 m up, and on
/// that a trolley of 4 t at -8 m + 2 m/s t.
const CRANE: &str = r#"{"format": "girderway-scene/1", "units": {"length": "m", "force": "N", "time": "s"}, "gravity": 9.80665,
 "analysis": "quasi-static",
 "structures": {"runway": {"spec": "long.json", "foundation": "rigid"},
   "girder": {"spec": "beam.json", "foundation": "influence", "on": "bridge", "at": [-10, 1, 0]}},
 "bodies": {"bridge": {"mass": 10000, "inertia": [1e5, 1e5, 1e5], "dof": ["y", "pitch"], "track": ["runway.rail"], "x0": 50},
   "trolley": {"mass": 4000, "inertia": [1e4, 1e4, 1e4], "dof": ["y", "pitch"], "track": ["girder.rail"], "x0": 2}},
 "wheels": {"crane": {"radius": 0.3, "vertical": {"k": 1e8}}},
 "trucks": [{"name": "base", "body": "bridge", "rail": "runway.rail", "tree": [-9, 9], "wheel": "crane"},
   {"name": "cart", "body": "trolley", "rail": "girder.rail", "tree": [-1, 1], "wheel": "crane"}],
 "motions": [{"body": "trolley", "dof": "x", "kind": "prescribed", "speed": [[0, 2]]}],
 "end": {"time": 8}, "output": {"dt": 1}}"#;

/// Runs a scene beside the files; the columns of its history.
fn run(scene: &str, files: &[(&str, &str)], columns: &[&str]) -> Vec<Vec<f64>> {
    run_in(&folder(), scene, files, columns)
}

fn run_in(
    folder: &TempDir,
    scene: &str,
    files: &[(&str, &str)],
    columns: &[&str],
) -> Vec<Vec<f64>> {
    fs::copy(
        example("bogie").join("spec.json"),
        folder.path().join("spec.json"),
    )
    .expect("a copy");
    for (name, text) in [("scene.json", scene)].iter().chain(files) {
        fs::write(folder.path().join(name), text).expect("written");
    }
    let run = girderway(folder, &["run", "scene.json", "-o", "out"]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    json(&fs::read(folder.path().join("out/summary.json")).expect("a summary"));
    let history = fs::read_to_string(folder.path().join("out/history.csv")).expect("a history");
    let mut lines = history.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let place = |name: &&str| {
        header
            .iter()
            .position(|column| column == name)
            .unwrap_or_else(|| panic!("{name} among {header:?}"))
    };
    let places: Vec<usize> = columns.iter().map(place).collect();
    let row = |line: &str| -> Vec<f64> {
        let values: Vec<&str> = line.split(',').collect();
        places
            .iter()
            .map(|&place| values[place].parse().expect("a number"))
            .collect()
    };
    lines.map(row).collect()
}

#[test]
fn runway_wheels_carry_the_trolley_and_the_girder_by_their_levers() {
    let long = BEAM
        .replace("[20]", "[100]")
        .replace("[0, 5, 10, 15, 20]", "[0, 50, 100]");
    let files = [("beam.json", BEAM), ("long.json", &long)];
    let columns = [
        "time",
        "base.wheel1.vertical",
        "base.wheel2.vertical",
        "cart.wheel1.vertical",
    ];
    for foundation in ["influence", "parts", "auto"] {
        let rows = run(&crane_on(foundation), &files, &columns);
        assert_eq!(rows.len(), 9);
        for row in rows {
            // Analytic: the girder of 300 kg/m lies evenly, the trolley at -8 + 2 t.
            let (even, trolley) = (0.5 * 9.80665 * (10_000.0 + 6000.0), 0.5 * 9.80665 * 4000.0);
            let lever = (-8.0 + 2.0 * row[0]) / 9.0;
            let wanted = [1.0 - lever, 1.0 + lever].map(|share| even + trolley * share);
            for (found, wanted) in row[1..3].iter().zip(wanted) {
                assert!(
                    (found - wanted).abs() < 1e-6 * wanted,
                    "{foundation}, {row:?}: {wanted}"
                );
            }
        }
    }
}

/// The crane with its girder on another foundation.
fn crane_on(foundation: &str) -> String {
    let girder = |word: &str| format!(r#""spec": "beam.json", "foundation": "{word}""#);
    CRANE.replace(&girder("influence"), &girder(foundation))
}

#[test]
fn auto_climbs_on_a_carrier_as_on_the_ground() {
    let long = BEAM
        .replace("[20]", "[100]")
        .replace("[0, 5, 10, 15, 20]", "[0, 50, 100]");
    let files = [("beam.json", BEAM), ("long.json", &long)];
    let moving = |foundation: &str| {
        crane_on(foundation)
            .replace("quasi-static", "dynamic")
            .replace("\"time\": 8", "\"time\": 1")
    };
    let columns = ["trolley.deflection", "cart.wheel1.vertical"];
    let folder = folder();
    let strict = r#"auto", "tolerance": 1e-3, "measure": "history"#;
    let found = run_in(&folder, &moving(strict), &files, &columns);
    let summary = json(&fs::read(folder.path().join("out/summary.json")).expect("a summary"));
    let rung = &summary["foundation"]["girder"];
    assert_eq!(rung["foundation"], "modal", "{rung}");
    assert!(
        rung["reason"]
            .as_str()
            .is_some_and(|why| why.contains("within the tolerance")),
        "{rung}"
    );
    let wanted = run(&moving("full"), &files, &columns);
    for (found, wanted) in found.iter().zip(&wanted) {
        for (found, wanted) in found.iter().zip(wanted) {
            assert!(
                (found - wanted).abs() < 0.01 * wanted.abs().max(0.002),
                "{found} for {wanted}"
            );
        }
    }
}

/// Two girders along z, 20 m long and 3 m apart, tied at their ends; 300 kg/m, ties 100 kg/m; a hoist of 500 kg hangs
/// midway off one of them. Rails 0.4 m above the members.
const BRIDGE: &str = r#"{"format": "girderway-beam/1", "units": {"length": "m", "force": "N", "time": "s"},
 "points": [[-1.5, 0, 0], [-1.5, 0, 10], [-1.5, 0, 20], [1.5, 0, 0], [1.5, 0, 10], [1.5, 0, 20]],
 "cells": [{"type": "line", "data": [[0, 1], [1, 2], [3, 4], [4, 5]]}, {"type": "line", "data": [[0, 3], [2, 5]]}],
 "cell_data": {"section": [[0, 0, 0, 0], [1, 1]], "orientation": [[[0, 1, 0], [0, 1, 0], [0, 1, 0], [0, 1, 0]], [[0, 1, 0], [0, 1, 0]]]},
 "materials": [{"name": "steel", "E": 2.1e11, "G": 8.1e10, "density": 10000}],
 "sections": [{"name": "girder", "material": "steel", "A": 0.03, "Iy": 2e-4, "Iz": 2e-3, "J": 1e-4},
   {"name": "tie", "material": "steel", "A": 0.01, "Iy": 1e-4, "Iz": 1e-4, "J": 1e-4}],
 "masses": [{"point": 1, "mass": 500}],
 "supports": [{"point": 0, "fix": ["ux", "uy", "uz"]}, {"point": 2, "fix": ["ux", "uy"]}, {"point": 3, "fix": ["uy"]}, {"point": 5, "fix": ["uy"]}],
 "up": [0, 1, 0],
 "rails": {"west": {"origin": [-1.5, 0.4, 0], "axis": [0, 0, 1], "segments": [{"cell": [0, 0], "offset": [0, 0.4, 0]}, {"cell": [0, 1], "offset": [0, 0.4, 0]}], "stations": [0, 5, 10, 15, 20]},
   "east": {"origin": [1.5, 0.4, 0], "axis": [0, 0, 1], "segments": [{"cell": [0, 2], "offset": [0, 0.4, 0]}, {"cell": [0, 3], "offset": [0, 0.4, 0]}], "stations": [0, 5, 10, 15, 20]}}}"#;

/// A bridge on two end trucks, one a runway, and a trolley that crosses it at 2 m/s from z = -8 m of its origin.
const OVERHEAD: &str = r#"{"format": "girderway-scene/1", "units": {"length": "m", "force": "N", "time": "s"}, "gravity": 9.80665,
 "analysis": "quasi-static",
 "structures": {"north": {"spec": "long.json", "foundation": "influence"}, "south": {"spec": "long.json", "foundation": "influence"},
   "girders": {"spec": "bridge.json", "foundation": "influence", "on": "bridge", "at": [0, 1, -10]}},
 "bodies": {"bridge": {"mass": 6000, "inertia": [2e5, 2e5, 1e4], "cg": [0, 0.5, 0], "dof": ["y", "roll", "pitch"], "x0": 50},
   "trolley": {"mass": 4000, "inertia": [1e4, 1e4, 1e4], "cg": [0.1, 0.8, 0.2], "dof": ["y", "roll", "pitch"], "x0": 2}},
 "wheels": {"crane": {"radius": 0.3, "vertical": {"k": 1e8}}},
 "trucks": [{"name": "n", "body": "bridge", "rail": "north.rail", "at": [0, 0, -10], "tree": [-2, 2], "wheel": "crane"},
   {"name": "s", "body": "bridge", "rail": "south.rail", "at": [0, 0, 10], "tree": [-2, 2], "wheel": "crane"},
   {"name": "w", "body": "trolley", "rail": "girders.west", "at": [0, 0, 1.5], "tree": [-1, 1], "wheel": "crane"},
   {"name": "e", "body": "trolley", "rail": "girders.east", "at": [0, 0, -1.5], "tree": [-1, 1], "wheel": "crane"}],
 "motions": [{"body": "trolley", "dof": "x", "kind": "prescribed", "speed": [[0, 2]]}],
 "end": {"time": 8}, "output": {"dt": 1}}"#;

/// Wheel loads of the overhead crane on runways of one foundation, and the time before them.
fn overhead(foundation: &str) -> Vec<Vec<f64>> {
    let long = BEAM
        .replace("[20]", "[100]")
        .replace("[0, 5, 10, 15, 20]", "[0, 50, 100]");
    let runway = |scene: &str, name: &str| {
        let word = format!("\"{name}\": {{\"spec\": \"long.json\", \"foundation\": ");
        scene.replace(
            &format!("{word}\"influence\""),
            &format!("{word}\"{foundation}\""),
        )
    };
    let scene = runway(&runway(OVERHEAD, "north"), "south");
    let columns = [
        "n.wheel1", "n.wheel2", "s.wheel1", "s.wheel2", "w.wheel1", "w.wheel2", "e.wheel1",
        "e.wheel2",
    ]
    .map(|wheel| format!("{wheel}.vertical"));
    let columns: Vec<&str> = ["time"]
        .into_iter()
        .chain(columns.iter().map(String::as_str))
        .collect();
    run(
        &scene,
        &[("bridge.json", BRIDGE), ("long.json", &long)],
        &columns,
    )
}

/// Analytic: weights of bridge, girders, ties, hoist and trolley at their places (x, z) from the bridge's origin.
fn weights(time: f64) -> [(f64, f64, f64); 5] {
    // The trolley's rail runs along z, its right is -x.
    [
        (6000.0, 0.0, 0.0),
        (12_000.0, 0.0, 0.0),
        (600.0, 0.0, 0.0),
        (500.0, -1.5, 0.0),
        (4000.0, -0.2, 2.0 * time - 8.0 + 0.1),
    ]
    .map(|(mass, x, z)| (9.80665 * mass, x, z))
}

#[test]
fn end_trucks_carry_girders_hoist_and_trolley_at_every_place() {
    for foundation in ["influence", "rigid"] {
        let (mut balance, mut levers) = (0.0_f64, 0.0_f64);
        let rows = overhead(foundation);
        assert_eq!(rows.len(), 9);
        for row in rows {
            let weights = weights(row[0]);
            let sum = |of: &dyn Fn(&(f64, f64, f64)) -> f64| weights.iter().map(of).sum::<f64>();
            let (all, about_z, about_x) = (sum(&|w| w.0), sum(&|w| w.0 * w.1), sum(&|w| w.0 * w.2));
            let places = [(-2.0, -10.0), (2.0, -10.0), (-2.0, 10.0), (2.0, 10.0)];
            let (mut forces, mut turns) = (-all, [-about_z, -about_x]);
            for (force, (x, z)) in row[1..5].iter().zip(places) {
                forces += force;
                turns = [turns[0] + force * x, turns[1] + force * z];
                // Analytic: four equal springs under a load.
                let wanted = 0.25 * (all + about_z * x / 4.0 + about_x * z / 100.0);
                levers = levers.max((force - wanted).abs() / all);
            }
            let trolley = row[5..].iter().sum::<f64>() - weights[4].0;
            balance = [forces, turns[0] / 2.0, turns[1] / 10.0, trolley]
                .iter()
                .fold(balance, |max, e| max.max(e.abs() / all));
        }
        println!("{foundation}: balance {balance:.1e}, levers {levers:.1e}");
        assert!(
            balance < 1e-9,
            "{foundation}: the forces miss the weights by {balance}"
        );
        assert!(
            foundation != "rigid" || levers < 1e-9,
            "a wheel errs by {levers}"
        );
    }
}

/// A ladle of 8 t on a rope below the trolley; everything moves, and at the start all hang at rest.
#[test]
fn a_ladle_below_the_trolley_loads_rope_trolley_and_end_trucks() {
    let ladle = r#""ladle": {"mass": 8000, "dof": ["X", "Y", "Z"]}}"#;
    let rope = r#""ropes": [{"name": "hoist", "from": {"body": "trolley", "at": [0.2, 0.5, -0.3]}, "to": {"body": "ladle"}, "EA": 5e7, "length": 6, "speed": [[0, 0], [0.5, 0.4]]}],
 "motions""#;
    let scene = OVERHEAD
        .replace("\"analysis\": \"quasi-static\",", "")
        .replace("\"motions\"", rope);
    let scene = scene
        .replace("\"x0\": 2}}", &format!("\"x0\": 2}}, {ladle}"))
        .replace("\"speed\": [[0, 2]]", "\"speed\": [[0, 0], [0.5, 2]]");
    let scene = scene
        .replace("\"time\": 8", "\"time\": 2")
        .replace("\"dt\": 1}}", "\"dt\": 0.1}, \"accuracy\": 1e-7}");
    let long = BEAM
        .replace("[20]", "[100]")
        .replace("[0, 5, 10, 15, 20]", "[0, 50, 100]");
    let columns = [
        "hoist.tension",
        "north.rail.reaction",
        "south.rail.reaction",
        "girders.west.reaction",
        "girders.east.reaction",
        "ladle.X",
        "ladle.Z",
    ];
    let folder = folder();
    let rows = run_in(
        &folder,
        &scene,
        &[("bridge.json", BRIDGE), ("long.json", &long)],
        &columns,
    );
    let g = 9.80665;
    let (tension, ground, girders) = (
        rows[0][0] / (8000.0 * g),
        (rows[0][1] + rows[0][2]) / (31_100.0 * g),
        (rows[0][3] + rows[0][4]) / (12_000.0 * g),
    );
    // Analytic: at rest; the bridge tilts a little, the rope hangs from (0.2, -0.3) of the trolley, whose x is z of the bridge and whose right is -x.
    assert!(
        [tension, ground, girders]
            .iter()
            .all(|share| (share - 1.0).abs() < 1e-8),
        "{tension} {ground} {girders}"
    );
    let [x, z] = [rows[0][5] - 50.3, rows[0][6] + 7.8];
    assert!(x.abs() < 0.1 && z.abs() < 0.1, "{x} {z}");
    let summary = json(&fs::read(folder.path().join("out/summary.json")).expect("a summary"));
    let residual = summary["energy"]["residual"].as_f64().expect("a number");
    println!(
        "tension {:.1e}, ground {:.1e}, girders {:.1e}, energy {residual:.1e}",
        tension - 1.0,
        ground - 1.0,
        girders - 1.0
    );
    assert!(residual < 1e-7, "energy residual {residual}");
    let swung = rows.last().expect("rows")[6] - rows[0][6];
    assert!(swung > 0.1, "the ladle follows the trolley, by {swung}");
}

/// A girder of 20 m in four members, 300 kg/m; what holds its ends comes in.
fn spanning(ends: &str) -> String {
    format!(
        r#"{{"format": "girderway-beam/1", "units": {{"length": "m", "force": "N", "time": "s"}},
 "points": [[0, 0, 0], [5, 0, 0], [10, 0, 0], [15, 0, 0], [20, 0, 0]],
 "cells": [{{"type": "line", "data": [[0, 1], [1, 2], [2, 3], [3, 4]]}}],
 "cell_data": {{"section": [[0, 0, 0, 0]], "orientation": [[[0, 1, 0], [0, 1, 0], [0, 1, 0], [0, 1, 0]]]}},
 "materials": [{{"name": "steel", "E": 2.1e11, "G": 8.1e10, "density": 10000}}],
 "sections": [{{"name": "girder", "material": "steel", "A": 0.03, "Iy": 2e-4, "Iz": 2e-3, "J": 1e-4}}],
 {ends}, "up": [0, 1, 0],
 "rails": {{"rail": {{"origin": [0, 0, 0], "axis": [1, 0, 0], "segments": [{{"cell": [0, 0]}}, {{"cell": [0, 1]}}, {{"cell": [0, 2]}}, {{"cell": [0, 3]}}], "stations": [0, 5, 10, 15, 20]}}}}}}"#
    )
}

/// External to the carrier's own equations: a rigid body of mass m and inertia m L^2 / 4 on two springs is two masses m / 2
/// at the ends of the girder, which then stands in one FE model on the ground. Wheels are small: above the axis, what pitches
/// moves along it. The trolley starts at rest: its speed along a tilted rail has a part upwards.
#[test]
fn a_girder_on_a_sprung_body_is_a_girder_on_springs_and_masses() {
    let fixed = spanning(
        r#""supports": [{"point": 0, "fix": ["ux", "uy", "uz", "rx"]}, {"point": 4, "fix": ["uy", "uz"]}]"#,
    );
    let sprung = spanning(
        r#""supports": [{"point": 0, "fix": ["ux", "uz", "rx"]}, {"point": 4, "fix": ["uz"]}],
 "springs": [{"point": 0, "dof": "uy", "k": 2e6}, {"point": 4, "dof": "uy", "k": 2e6}], "masses": [{"point": 0, "mass": 1000}, {"point": 4, "mass": 1000}]"#,
    );
    let long = BEAM
        .replace("[20]", "[100]")
        .replace("[0, 5, 10, 15, 20]", "[0, 50, 100]");
    let scene = |girder: &str, body: &str, truck: &str| {
        format!(
            r#"{{"format": "girderway-scene/1", "units": {{"length": "m", "force": "N", "time": "s"}}, "gravity": 9.80665,
 "structures": {{{girder}}},
 "bodies": {{{body}"trolley": {{"mass": 3000, "inertia": [0, 0, 2500], "dof": ["y", "pitch"], "track": ["girder.rail"], "x0": 3}}}},
 "wheels": {{"crane": {{"radius": 1e-6, "vertical": {{"k": 2e6}}}}, "spring": {{"radius": 0.3, "vertical": {{"k": 2e6, "bilateral": true}}}}}},
 "trucks": [{truck}{{"name": "cart", "body": "trolley", "rail": "girder.rail", "tree": [-1, 1], "wheel": "crane"}}],
 "motions": [{{"body": "trolley", "dof": "x", "kind": "prescribed", "speed": [[0, 0], [0.4, 10]]}}],
 "end": {{"time": 0.6}}, "output": {{"dt": 0.02}}, "accuracy": 1e-7}}"#
        )
    };
    let files = [
        ("fixed.json", fixed.as_str()),
        ("sprung.json", &sprung),
        ("long.json", &long),
    ];
    let columns = ["cart.wheel1.vertical", "cart.wheel2.vertical"];
    let kind = r#""full", "elements": 1"#;
    let upper = scene(
        &format!(
            r#""runway": {{"spec": "long.json", "foundation": "rigid"}}, "girder": {{"spec": "fixed.json", "foundation": {kind}, "on": "bridge", "at": [-10, 0, 0]}}"#
        ),
        r#""bridge": {"mass": 2000, "inertia": [0, 0, 2e5], "dof": ["y", "pitch"], "track": ["runway.rail"], "x0": 50}, "#,
        r#"{"name": "base", "body": "bridge", "rail": "runway.rail", "tree": [-10, 10], "wheel": "spring"}, "#,
    );
    let lower = scene(
        &format!(r#""girder": {{"spec": "sprung.json", "foundation": {kind}}}"#),
        "",
        "",
    );
    let upper = run(&upper, &files, &columns);
    let lower = run(&lower, &files, &columns);
    assert_eq!(upper.len(), lower.len());
    let pairs = upper.iter().flatten().zip(lower.iter().flatten());
    let worst = pairs.fold(0.0_f64, |max, (a, b)| max.max((a - b).abs())) / (1500.0 * 9.80665);
    let swing = upper.iter().map(|row| row[0]).fold(0.0_f64, f64::max) / (1500.0 * 9.80665);
    println!("{kind}: {worst:.1e} of the weight on a wheel, which peaks at {swing:.2}");
    assert!(worst < 1e-6, "a wheel errs by {worst}");
}

#[test]
fn a_trolley_runs_over_a_bridge_that_moves() {
    let long = BEAM
        .replace("[20]", "[100]")
        .replace("[0, 5, 10, 15, 20]", "[0, 50, 100]");
    let files = [("beam.json", BEAM), ("long.json", &long)];
    let scene = CRANE
        .replace("quasi-static", "dynamic")
        .replace("\"time\": 8", "\"time\": 1");
    let rows = run(
        &scene,
        &files,
        &["base.wheel1.vertical", "base.wheel2.vertical"],
    );
    for row in rows {
        assert!(
            (row[0] + row[1] - 9.80665 * 20_000.0).abs() < 0.2 * 9.80665 * 20_000.0,
            "{row:?}"
        );
    }
}

#[test]
fn eight_wheels_under_massive_equalisers_run_from_a_scene() {
    let mut bodies = String::new();
    for (name, to, at, inertia) in [
        ("rear", "carriage", -6, 2700),
        ("front", "carriage", 6, 2700),
        ("b1", "rear", -3, 300),
        ("b2", "rear", 3, 300),
        ("b3", "front", -3, 300),
        ("b4", "front", 3, 300),
    ] {
        bodies += &format!(
            r#", "{name}": {{"mass": 300, "inertia": [0, 0, {inertia}], "dof": ["pitch"], "pinned": {{"to": "{to}", "at": [{at}, 0, 0]}}}}"#
        );
    }
    let trucks = ["b1", "b2", "b3", "b4"].map(|b| format!(r#"{{"name": "{b}", "body": "{b}", "tree": [-1.3333333333333333, 1.3333333333333333], "wheel": "crane"}}"#));
    let mass = 4.8e6 / 32.174 - 1800.0;
    let scene = format!(
        r#"{{"format": "girderway-scene/1", "units": {{"length": "ft", "force": "lbf", "time": "s"}}, "gravity": 32.174,
 "structures": {{"bridge": {{"spec": "spec.json", "foundation": "influence"}}}},
 "bodies": {{"carriage": {{"mass": {mass}, "inertia": [0, 0, {}], "dof": ["y", "pitch"]}}{bodies}}},
 "wheels": {{"crane": {{"radius": 1.25, "vertical": {{"k": 1e8, "c": 1e5}}}}}},
 "trucks": [{}],
 "motions": [{{"body": "carriage", "dof": "x", "kind": "prescribed", "speed": [[0, 10]]}}],
 "end": {{"time": 1}}, "output": {{"dt": 0.25}}}}"#,
        64.0 * mass,
        trucks.join(", ")
    );
    let columns: Vec<String> = (1..=4)
        .flat_map(|b| (1..=2).map(move |w| format!("b{b}.wheel{w}.vertical")))
        .collect();
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    let rows = run(&scene, &[], &columns);
    // Analytic: at rest every pin lies midway, and all wheels carry alike.
    assert!(
        rows[0].iter().all(|force| (force / 6e5 - 1.0).abs() < 1e-8),
        "{:?}",
        rows[0]
    );
    for row in rows {
        assert!(
            (row.iter().sum::<f64>() / 4.8e6 - 1.0).abs() < 0.2,
            "{row:?}"
        );
    }
}
