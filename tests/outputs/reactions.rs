//! Extremes of reactions in the summary: closed forms, statics, equilibrium, the static design, and the history.

use super::*;

/// Weight of the car.
const WEIGHT: f64 = 8000.0 * 9.81;

/// The value of an extreme of a reaction in the summary of a case, and its row.
fn reaction(ran: &Ran, case: usize, name: &str, kind: &str) -> (f64, Value) {
    let summary = results::summary::run(
        &ran.document.cases[case].scene,
        &ran.outcomes[case],
        case + 1,
    );
    let rows = summary["extremes"].as_array().expect("extremes").clone();
    let is_it = |row: &&Value| {
        row["quantity"] == "reaction"
            && format!(
                "{} {}",
                row["support"].as_str().expect("a name"),
                row["direction"].as_str().expect("a word")
            ) == name
            && row["kind"] == kind
    };
    let row = rows
        .iter()
        .find(is_it)
        .unwrap_or_else(|| panic!("no {kind} of {name} in {rows:?}"))
        .clone();
    (row["value"].as_f64().expect("a number"), row)
}

/// Girders of the general form over the same axis: each from the first to the second coordinate, supported at its ends, or
/// clamped at its first end alone.
fn apart(girders: &[[f64; 2]], is_clamped: bool) -> Value {
    let points: Vec<Value> = girders
        .iter()
        .flatten()
        .map(|x| json!([x, 0.0, 0.0]))
        .collect();
    let cells: Vec<Value> = (0..girders.len())
        .map(|k| json!([2 * k, 2 * k + 1]))
        .collect();
    let segments: Vec<Value> = (0..girders.len())
        .map(|k| json!({"cell": [0, k]}))
        .collect();
    let supports: Vec<Value> = (0..points.len())
        .filter(|point| !is_clamped || point % 2 == 0)
        .map(|point| match (is_clamped, point % 2) {
            (true, _) => json!({"point": point, "fix": ["ux", "uy", "uz", "rx", "ry", "rz"]}),
            (_, 0) => json!({"point": point, "fix": ["ux", "uy", "uz", "rx"]}),
            _ => json!({"point": point, "fix": ["uy", "uz", "rx"]}),
        })
        .collect();
    let last = girders[girders.len() - 1][1];
    json!({
        "format": "girderway-beam/1", "name": "apart", "units": {"length": "m", "force": "N", "time": "s"},
        "theory": "euler-bernoulli", "points": points, "cells": [{"type": "line", "data": cells}],
        "cell_data": {"section": [vec![0; girders.len()]], "orientation": [vec![[0.0, 1.0, 0.0]; girders.len()]]},
        "materials": [{"name": "steel", "E": 2.1e11, "G": 8.1e10, "density": 8000.0}],
        "sections": [{"name": "I", "material": "steel", "A": 0.05, "Iz": 2e-3, "Iy": 3e-4, "J": 1e-4}],
        "supports": supports,
        "rails": {"rail": {"origin": [0.0, 0.0, 0.0], "axis": [1.0, 0.0, 0.0], "segments": segments,
                           "stations": [girders[0][0], last]}},
    })
}

/// Closed form (three-moment theorem): the first support of two spans l lifts most with the wheel at 2 l - l/sqrt(3), by
/// P/(6 sqrt(3)); no output is there.
#[test]
fn extremes_of_reactions_are_those_between_outputs() {
    let mut given = scene(&json!([0.0]), 1.0, 17.0, 0.25);
    given["analysis"] = json!("quasi-static");
    given["compare"] = json!([{"label": "dead", "output": {"dead_load": true}}]);
    let ran = run(&given, &girder(&[10.0, 10.0]));
    let exact = -WEIGHT / (6.0 * 3.0_f64.sqrt());
    let (value, row) = reaction(&ran, 0, "girder.support1 uy", "min");
    assert!((value / exact - 1.0).abs() < 1e-12, "{value}, not {exact}");
    let time = 20.0 - 10.0 / 3.0_f64.sqrt() - 1.5;
    assert!(
        (row["time"].as_f64().expect("a time") - time).abs() < 1e-5,
        "{row}"
    );
    assert_eq!(
        (row["case"].as_u64(), row["dead"].as_f64()),
        (Some(1), Some(0.0))
    );
    // three eighths of the weight of a span are added where the scene asks for dead load
    let dead = 0.375 * 400.0 * 9.81 * 10.0;
    let (with, row) = reaction(&ran, 1, "girder.support1 uy", "min");
    assert!((with - exact - dead).abs() < 1e-9 * WEIGHT, "{with}");
    assert!(
        (row["dead"].as_f64().expect("a number") - dead).abs() < 1e-9 * WEIGHT,
        "{row}"
    );
    // every direction of every support has two rows, also where it is zero
    let count = ran.outcomes[0].girders().reactions.len();
    assert_eq!(
        count,
        2 * (4 + 3 + 3),
        "four directions at the first support, three at the others"
    );
}

/// Statics: a rail over the gap between two simple girders moves with the nearer one. A wheel just before the middle of the
/// gap presses beyond the end of the first: its supports have the largest and the smallest force in that instant, which is
/// between two outputs.
#[test]
fn reactions_at_a_jump_are_those_of_the_instant_before_it() {
    let mut given = scene(&json!([0.0]), 1.0, 17.0, 0.24);
    given["analysis"] = json!("quasi-static");
    let ran = run(&given, &apart(&[[0.0, 9.9], [10.3, 20.0]], false));
    let [far, near] = [-0.2 / 9.9, 10.1 / 9.9].map(|share| share * WEIGHT);
    for (point, kind, exact) in [(0, "min", far), (1, "max", near)] {
        let (value, row) = reaction(&ran, 0, &format!("girder.point{point} uy"), kind);
        assert!(
            (value - exact).abs() < 1e-9 * WEIGHT,
            "{value}, not {exact}: {row}"
        );
        assert!(
            (row["time"].as_f64().expect("a time") - (10.1 - 1.5)).abs() < 1e-9,
            "{row}"
        );
    }
    let share = (10.1 - 10.3) / 9.7;
    let (value, _) = reaction(&ran, 0, "girder.point3 uy", "min");
    assert!(
        (value - share * WEIGHT).abs() < 1e-9 * WEIGHT,
        "{value}, not {}",
        share * WEIGHT
    );
}

/// Equilibrium: the one support of a cantilever bears the wheel forces, the weight and minus the inertia of the girder, whose
/// momentum is integrated from the shapes of its modes alone.
#[test]
fn the_reaction_of_a_cantilever_is_in_equilibrium_with_wheels_weight_and_inertia() {
    let mut given = scene(&json!([-0.9, 0.9]), 6.0, 1.0, 0.0005);
    given["structures"]["girder"] =
        json!({"spec": "spec.json", "foundation": "modal", "modes": 3, "damping": 0.02});
    given["bodies"]["car"]["start"] = json!({"y": 0.004});
    given["output"]["dead_load"] = json!(true);
    let ran = run(&given, &apart(&[[0.0, 10.0]], true));
    let history = &ran.outcomes[0].run.history;
    let mut expected = ran.sum(0, ".reaction");
    for (k, momentum) in super::motion::momenta(&ran.laid(0), 400.0)
        .iter()
        .enumerate()
    {
        let acceleration = history.column(Channel::Acceleration(0, k));
        expected
            .iter_mut()
            .zip(acceleration)
            .for_each(|(sum, a)| *sum += momentum * a);
    }
    let weight = 400.0 * 9.81 * 10.0;
    // the vertex of the parabola through the largest value at an output and those beside it
    let inner = 1..expected.len() - 1;
    let at = inner
        .max_by(|a, b| expected[*a].total_cmp(&expected[*b]))
        .expect("a history with rows");
    let [a, b, c] = [expected[at - 1], expected[at], expected[at + 1]];
    let most = b + weight - (c - a).powi(2) / (8.0 * (a - 2.0 * b + c));
    // the car falls from above the rail
    let least = expected
        .iter()
        .copied()
        .reduce(f64::min)
        .expect("a history with rows")
        + weight;
    for (kind, exact) in [("max", most), ("min", least)] {
        let (value, _) = reaction(&ran, 0, "girder.point0 uy", kind);
        println!("cantilever, {kind}: {value:.3} N, {exact:.3} N by equilibrium");
        assert!(
            (value - exact).abs() < 2e-5 * WEIGHT,
            "{kind}: {value}, not {exact}"
        );
    }
    let response = &ran.outcomes[0].response;
    for (column, envelope) in response.columns.iter().zip(&response.envelopes) {
        let own = |is_max: bool| {
            let all = ran.outcomes[0].girders().reactions.iter();
            let is_own = |own: &&results::girders::GirderReaction| {
                own.is_max == is_max && format!("{}.{}", own.support, own.direction) == column.name
            };
            let mut own = all.filter(is_own);
            own.next()
                .map(|own| own.value)
                .expect("a reaction for every column of one")
        };
        let slack = 1e-9 * WEIGHT;
        println!(
            "{} {:e} {:e} at {} / {:e} {:e} at {}",
            column.name,
            own(true),
            envelope.max.value,
            envelope.max.time,
            own(false),
            envelope.min.value,
            envelope.min.time
        );
        assert!(own(true) >= envelope.max.value - slack, "{}", column.name);
        assert!(own(false) <= envelope.min.value + slack, "{}", column.name);
    }
    assert!(most - weight > 1.05 * WEIGHT, "the car bounces: {most}");
}

/// Two independent computations: over the whole runway a quasi-static run has the extremes that the static design finds as
/// roots of polynomials. The run's own columns, at the output times, lie between them.
#[test]
fn a_quasi_static_run_has_the_reactions_of_the_static_design() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/runway");
    let read = |name: &str| -> Value {
        let text = std::fs::read_to_string(folder.join(name)).expect("an example");
        serde_json::from_str(&text).expect("JSON")
    };
    let mut given = read("scene.json");
    given["analysis"] = json!("quasi-static");
    given["structures"]["girder"]["foundation"] = json!("influence");
    given["output"]["dead_load"] = json!(true);
    given.as_object_mut().expect("an object").remove("compare");
    let ran = run(&given, &read("spec.json"));
    let mut design = read("design.json");
    let crane = design["trains"][0].as_object_mut().expect("an object");
    crane.remove("lateral");
    crane.remove("longitudinal");
    design["trains"][0]["turned"] = json!(false);
    design["cases"] = json!([["crane"]]);
    let place = tempfile::tempdir().expect("a temporary folder");
    std::fs::copy(folder.join("spec.json"), place.path().join("spec.json")).expect("a file");
    let file = place.path().join("design.json");
    std::fs::write(&file, design.to_string()).expect("a file");
    let (design, inputs) =
        formats::design::Design::open(&file).unwrap_or_else(|wrong| panic!("{wrong:?}"));
    let found = design::solve(&design, &inputs).unwrap_or_else(|wrong| panic!("{wrong:?}"));
    let mut worst = 0.0_f64;
    for own in &found.cases[0].reactions {
        let name = format!("girder.{} {}", own.name.support, own.name.direction);
        for (kind, exact) in ["max", "min"].into_iter().zip(&own.extremes) {
            let (value, row) = reaction(&ran, 0, &name, kind);
            worst = worst.max((value - exact.value).abs() / 360.0);
            assert!(
                (value - exact.value).abs() < 1e-9 * 360.0,
                "{name} {kind}: {value}, {}",
                exact.value
            );
            assert!(
                (row["dead"].as_f64().expect("a number") - exact.dead).abs() < 1e-9 * 360.0,
                "{row}"
            );
        }
    }
    println!("reactions of the runway within {worst:.1e} of the weight of the crane");
    for (column, envelope) in ran.outcomes[0]
        .response
        .columns
        .iter()
        .zip(&ran.outcomes[0].response.envelopes)
    {
        let Some(support) = column.name.strip_suffix(".vertical") else {
            continue;
        };
        let [most, least] =
            ["max", "min"].map(|kind| reaction(&ran, 0, &format!("{support} uy"), kind).0);
        assert!(
            envelope.max.value <= most + 1e-9 && envelope.min.value >= least - 1e-9,
            "{}",
            column.name
        );
        assert!(
            most - envelope.max.value < 1e-9 && envelope.min.value - least < 1e-9,
            "{}",
            column.name
        );
    }
}
