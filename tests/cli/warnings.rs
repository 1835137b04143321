//! Warnings where the limits of a method are near.

use std::fs;

use super::{example, folder, girderway, json, text};

const GIRDER: &str = r#"{"format": "girderway-beam/1", "theory": "euler-bernoulli",
 "units": {"length": "ft", "force": "lbf", "time": "s"},
 "girder": {"spans": [60, 60], "E": 4.32e9, "I_vertical": 9.528, "mass_per_length": 15.2}, "stations": [0, 30, 60, 90, 120]}"#;

/// Both ends hold the length.
const TAUT: &str = r#"{"format": "girderway-beam/1", "theory": "euler-bernoulli",
 "units": {"length": "ft", "force": "lbf", "time": "s"},
 "points": [[0, 0, 0], [60, 0, 0]], "cells": [{"type": "line", "data": [[0, 1]]}],
 "materials": [{"name": "steel", "E": 4.32e9, "G": 1.6e9}],
 "sections": [{"name": "girder", "material": "steel", "A": 4, "Iy": 1, "Iz": 9.528, "J": 1}],
 "supports": [{"point": 0, "fix": ["ux", "uy", "uz", "rx"]}, {"point": 1, "fix": ["ux", "uy", "uz", "rx"]}],
 "rails": {"rail": {"axis": [1, 0, 0], "segments": [{"cell": [0, 0]}], "stations": [0, 30, 60]}}}"#;

/// Zero at both ends.
const HELD: &str = "UNITS/, FORCE = POUND_FORCE, MASS = SLUG, LENGTH = FOOT, TIME = SECOND\n\
    SPLINE/6, X = 0, 15, 30, 45, 60\n, Y = 0, 0, 0, 0, 0, 0\n, Y = 15, 0, 6.15E-8, 7.51E-8, 4.78E-8, 0\n\
    , Y = 30, 0, 7.51E-8, 1.09E-7, 7.51E-8, 0\n, Y = 45, 0, 4.78E-8, 7.51E-8, 6.15E-8, 0\n, Y = 60, 0, 0, 0, 0, 0\n";

/// Warnings of a mass of `weight` lb on one wheel that starts at `x0` and goes at `speed`, prescribed or free.
fn warned(structure: &str, weight: f64, x0: f64, speed: f64, free: bool) -> Vec<String> {
    warned_with(structure, weight, x0, speed, free, "")
}

/// The same, with more members of the body.
fn warned_with(
    structure: &str,
    weight: f64,
    x0: f64,
    speed: f64,
    free: bool,
    more: &str,
) -> Vec<String> {
    let folder = folder();
    let write =
        |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("written");
    write("girder.json", GIRDER);
    write("held.adm", HELD);
    write("taut.json", TAUT);
    fs::copy(
        example("bogie").join("printed.adm"),
        folder.path().join("printed.adm"),
    )
    .expect("a copy");
    let (dof, motion) = if free {
        (r#"["x", "y"]"#, String::new())
    } else {
        let table = format!(
            r#"{{"body": "car", "dof": "x", "kind": "prescribed", "speed": [[0, {speed}]]}}"#
        );
        (r#"["y"]"#, table)
    };
    let v0 = if free {
        format!(r#", "v0": {speed}"#)
    } else {
        String::new()
    };
    let scene = format!(
        r#"{{"format": "girderway-scene/1", "units": {{"length": "ft", "force": "lbf", "time": "s"}}, "gravity": 32.174,
        "structures": {{"bridge": {structure}}}, "bodies": {{"car": {{"weight": {weight}, "dof": {dof}, "x0": {x0}{v0}{more}}}}},
        "wheels": {{"wheel": {{"radius": 1, "vertical": {{"k": 1e8, "c": 1e5}}}}}},
        "trucks": [{{"name": "truck", "body": "car", "tree": [0], "wheel": "wheel"}}],
        "motions": [{motion}], "end": {{"time": 0.01}}, "output": {{"dt": 0.001}}, "accuracy": 1e-5}}"#
    );
    write("scene.json", &scene);
    let run = girderway(&folder, &["run", "scene.json", "-o", "out"]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    let summary = json(&fs::read(folder.path().join("out/summary.json")).expect("a summary"));
    let list = summary["warnings"].as_array().cloned().unwrap_or_default();
    let all: Vec<String> = list
        .iter()
        .filter_map(|warning| warning.as_str().map(str::to_owned))
        .collect();
    for warning in &all {
        let told = text(&run.stderr)
            .lines()
            .any(|line| line.starts_with("warning: ") && line.ends_with(warning));
        assert!(told, "{warning:?} is told: {}", text(&run.stderr));
    }
    all
}

/// Analytic: 2 L f_1 = (pi / 60) sqrt(4.32e9 9.528 / 15.2) = 2724.7 ft/s.
#[test]
fn girders_taken_without_their_mass_warn_from_half_of_the_critical_speed_on() {
    let influence = r#"{"spec": "girder.json", "foundation": "influence"}"#;
    assert_eq!(
        warned(influence, 1e3, 10.0, 1360.0, false),
        Vec::<String>::new()
    );
    let fast = warned(influence, 1e3, 10.0, 1366.0, false);
    assert!(
        fast.len() == 1 && fast[0].contains("run at 0.50 of the critical speed"),
        "{fast:?}"
    );
    let modal = r#"{"spec": "girder.json", "foundation": "modal", "modes": 4}"#;
    assert_eq!(
        warned(modal, 1e3, 10.0, 1366.0, false),
        Vec::<String>::new()
    );
}

/// Analytic: in the middle of one of two spans a load sinks by 23/32 of P L^3/48EI, 0.6 ft under 7.64e6 lb. The span
/// counts, not the length of the rail.
#[test]
fn rails_that_give_by_a_hundredth_of_their_span_warn() {
    let influence = r#"{"spec": "girder.json", "foundation": "influence"}"#;
    assert_eq!(
        warned(influence, 7.5e6, 30.0, 0.0, false),
        Vec::<String>::new()
    );
    let bent = warned(influence, 7.8e6, 30.0, 0.0, false);
    assert!(
        bent.len() == 1 && bent[0].contains("bridge.rail deflects by 0.010 of its span"),
        "{bent:?}"
    );
}

/// Analytic: A delta^2 / (4 I) = 0.01 at delta = 0.3087 ft, under 48 E I delta / L^3 = 2.824e6 lb.
#[test]
fn rails_held_lengthwise_at_both_ends_warn_where_that_would_stiffen_them() {
    let influence = r#"{"spec": "taut.json", "foundation": "influence"}"#;
    // the tension itself is a second-order effect, most of the shear force
    let is_second = |text: &String| text.contains("second-order effects");
    let loose = warned(influence, 2.8e6, 30.0, 0.0, false);
    assert!(loose.len() == 1 && is_second(&loose[0]), "{loose:?}");
    let taut = warned(influence, 2.85e6, 30.0, 0.0, false);
    assert!(
        taut.len() == 2 && taut[0].contains("restrain it longitudinally") && is_second(&taut[1]),
        "{taut:?}"
    );
}

#[test]
fn tables_that_are_zero_at_an_end_warn_of_wheels_next_to_it() {
    let held = r#"{"tables": {"file": "held.adm", "vertical": 6}, "foundation": "influence"}"#;
    assert_eq!(warned(held, 1e5, 30.0, 5.0, false), Vec::<String>::new());
    let next = warned(held, 1e5, 50.0, 5.0, false);
    assert!(
        next.len() == 1 && next[0].contains("is zero at its end 60, and wheels are in the bay"),
        "{next:?}"
    );
    let open = r#"{"tables": {"file": "printed.adm", "vertical": 6}, "foundation": "influence"}"#;
    assert_eq!(warned(open, 1e5, 70.0, 0.0, false), Vec::<String>::new());
}

#[test]
fn bodies_that_roll_freely_over_akispl_warn() {
    let read = |reading: &str| {
        format!(
            r#"{{"tables": {{"file": "printed.adm", "vertical": 6}}, "foundation": "influence", "reading": "{reading}"}}"#
        )
    };
    let free = warned(&read("akispl"), 1e5, 20.0, 5.0, true);
    assert!(
        free.iter()
            .any(|warning| warning.contains("read by akispl, which is not symmetric")),
        "{free:?}"
    );
    for (reading, free) in [("natural", true), ("akispl", false)] {
        let all = warned(&read(reading), 1e5, 20.0, 5.0, free);
        assert!(
            all.iter()
                .all(|warning| !warning.contains("not symmetric:")),
            "{reading}: {all:?}"
        );
        assert!(
            !all.iter()
                .any(|warning| warning.contains("rolls freely over")),
            "{reading}: {all:?}"
        );
    }
}

/// Analytic: let go 1 ft above the rail, a wheel meets it after 0.25 s.
#[test]
fn wheels_off_their_rail_warn_with_the_time() {
    let rigid = r#"{"spec": "girder.json", "foundation": "rigid"}"#;
    let all = warned_with(rigid, 1e6, 20.0, 5.0, false, r#", "start": {"y": 1}"#);
    assert_eq!(
        all,
        ["truck.wheel1 is not in contact with its rail for 0.01 s from 0 s"]
    );
}

#[test]
fn wheels_that_are_braked_alone_warn_with_what_applies_a_brake() {
    let rigid = r#"{"spec": "girder.json", "foundation": "rigid"}"#;
    let braked = |motion: &str| -> Vec<String> {
        let folder = folder();
        fs::write(folder.path().join("girder.json"), GIRDER).expect("written");
        let scene = format!(
            r#"{{"format": "girderway-scene/1", "units": {{"length": "ft", "force": "lbf", "time": "s"}}, "gravity": 32.174,
            "structures": {{"bridge": {rigid}}}, "bodies": {{"car": {{"weight": 1e5, "dof": ["x", "y"], "x0": 10, "v0": 5}}}},
            "wheels": {{"wheel": {{"radius": 1, "vertical": {{"k": 1e8, "c": 1e5}}, "friction": {{"mu": 0.2, "slip": 0.1}}, "braked": true}}}},
            "trucks": [{{"name": "truck", "body": "car", "tree": [0], "wheel": "wheel"}}],
            "motions": [{motion}], "end": {{"time": 0.01}}, "output": {{"dt": 0.001}}}}"#
        );
        fs::write(folder.path().join("scene.json"), scene).expect("written");
        let run = girderway(&folder, &["run", "scene.json", "-o", "out"]);
        assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
        text(&run.stderr)
            .lines()
            .filter(|line| line.contains("braked"))
            .map(str::to_owned)
            .collect()
    };
    let alone = braked("");
    assert_eq!(alone.len(), 1, "{alone:?}");
    assert!(alone[0].contains(r#"{"brake": "car"}"#), "{alone:?}");
    assert!(
        !alone[0].contains("friction"),
        "the wheels have it: {alone:?}"
    );
    assert!(braked(r#"{"body": "car", "dof": "x", "kind": "free", "brake": 0.005}"#).is_empty());
}

/// Analytic: a wheel of 1e-6 lb on 1e8 lb/ft vibrates 9 million times a second. A push on it would take tens of millions of steps.
#[test]
fn a_run_of_millions_of_steps_is_given_up_with_its_reason() {
    let folder = folder();
    fs::write(folder.path().join("girder.json"), GIRDER).expect("written");
    let scene = r#"{"format": "girderway-scene/1", "units": {"length": "ft", "force": "lbf", "time": "s"}, "gravity": 32.174,
        "structures": {"bridge": {"spec": "girder.json", "foundation": "rigid"}},
        "bodies": {"car": {"weight": 1e-6, "dof": ["y"], "x0": 10}},
        "wheels": {"wheel": {"radius": 1, "vertical": {"k": 1e8}}},
        "trucks": [{"name": "truck", "body": "car", "tree": [0], "wheel": "wheel"}],
        "loads": [{"body": "car", "dof": "y", "value": [[0, -5], [1e-7, -4]]}],
        "motions": [{"body": "car", "dof": "x", "kind": "prescribed", "speed": [[0, 1]]}], "end": {"time": 1}}"#;
    fs::write(folder.path().join("scene.json"), scene).expect("written");
    let run = girderway(&folder, &["run", "scene.json", "-o", "out"]);
    let said = text(&run.stderr);
    assert_ne!(run.status.code(), Some(0), "{said}");
    assert!(
        said.contains("the run was given up at t = 0.0004"),
        "{said}"
    );
    assert!(said.contains("a small mass on a stiff wheel"), "{said}");
    let summary = json(&fs::read(folder.path().join("out/summary.json")).expect("a summary"));
    assert_eq!(summary["status"], "too many steps");
}
