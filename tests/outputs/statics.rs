//! Slow wheels: closed forms.

use super::*;

/// Reactions and the moment in a span of two equal spans under a unit load at the share `a` of the first: the
/// three-moment theorem.
fn two_spans(a: f64) -> [f64; 3] {
    let cube = a * a * a;
    [
        0.25 * (4.0 - 5.0 * a + cube),
        0.5 * (3.0 * a - cube),
        -0.25 * (a - cube),
    ]
}

#[test]
fn reactions_of_two_spans_are_those_of_the_three_moment_theorem() {
    let (span, weight) = (10.0, 8000.0 * 9.81);
    let mut spec = girder(&[span, span]);
    spec["effects"] = json!([{"name": "mid", "x": 5.0}]);
    let mut given = scene(&json!([0.0]), 1.0, 17.0, 0.25);
    given["analysis"] = json!("quasi-static");
    given["compare"] =
        json!([{"label": "rigid", "structures": {"girder": {"foundation": "rigid"}}}]);
    let ran = run(&given, &spec);
    for case in 0..2 {
        let x = ran.column(case, "truck.wheel1.x").to_vec();
        let mut worst = 0.0_f64;
        for (i, &x) in x.iter().enumerate() {
            let near = x <= span;
            let [a, b, c] = two_spans(if near {
                x / span
            } else {
                (2.0 * span - x) / span
            });
            let expected = if near { [a, b, c] } else { [c, b, a] };
            for (support, share) in expected.into_iter().enumerate() {
                let found = ran.column(case, &format!("girder.support{}.vertical", support + 1))[i];
                worst = worst.max((found - share * weight).abs() / weight);
            }
            let moment = expected[0] * 5.0 - if x < 5.0 { 5.0 - x } else { 0.0 };
            let found = ran.column(case, "girder.mid.Mz")[i];
            worst = worst.max((found - moment * weight).abs() / (weight * span));
        }
        println!("two spans, case {case}: within {worst:.1e} of the closed form");
        assert!(worst < 1e-10, "case {case}: {worst:e}");
    }
}

#[test]
fn envelopes_name_the_instant_and_the_place_that_govern() {
    let mut given = scene(&json!([0.0]), 1.0, 17.0, 0.25);
    given["analysis"] = json!("quasi-static");
    let ran = run(&given, &girder(&[10.0, 10.0]));
    let response = &ran.outcomes[0].response;
    let of = |name: &str| {
        let found = response
            .envelopes
            .iter()
            .find(|envelope| envelope.column == name);
        found
            .unwrap_or_else(|| panic!("no envelope of {name}"))
            .clone()
    };
    // the middle support has all of a wheel that stands on it
    let middle = of("girder.support2.vertical");
    assert_eq!(middle.max.bodies[0].0, "car");
    assert!((middle.max.bodies[0].1[0] - 10.0).abs() < 1e-8);
    assert!((middle.max.time - 8.5).abs() < 1e-8);
    assert!((middle.max.value / (8000.0 * 9.81) - 1.0).abs() < 1e-10);
    assert!((middle.max.wheels[0].1[0] / (8000.0 * 9.81) - 1.0).abs() < 1e-10);
    // the first lifts most with the wheel at 1/sqrt(3) of the far span: 2 l - l/sqrt(3) = 14.23
    let first = of("girder.support1.vertical");
    let place = 20.0 - 10.0 / 3.0_f64.sqrt();
    assert!((first.min.bodies[0].1[0] - place).abs() < 1e-4);
    assert!((first.min.value / (8000.0 * 9.81) + 1.0 / (6.0 * 3.0_f64.sqrt())).abs() < 1e-8);
}

/// Analytic: the envelope of moments of a simple beam under one wheel is P x (L - x)/L, also at places that the wheel
/// passes between two outputs.
#[test]
fn the_figure_of_moments_has_the_exact_envelope() {
    let mut given = scene(&json!([0.0]), 1.0, 7.0, 0.7);
    given["analysis"] = json!("quasi-static");
    given["bodies"]["car"]["x0"] = json!(0.3);
    let ran = run(&given, &girder(&[8.0]));
    let figures = report::figures::run::figures(
        &ran.document,
        &ran.outcomes,
        &ran.known,
        &RunComparison::default(),
        None,
    );
    let figure = figures
        .figures
        .iter()
        .find(|figure| figure.name.starts_with("moments-"))
        .expect("a figure");
    let report::Picture::Chart(chart) = &figure.picture else {
        panic!("it is a chart")
    };
    let largest = chart
        .series
        .iter()
        .find(|series| series.label == "largest")
        .expect("a curve");
    let inside: Vec<&[f64; 2]> = largest
        .points
        .iter()
        .filter(|p| p[0] >= 0.3 && p[0] <= 7.3)
        .collect();
    assert!(inside.len() > 15, "{} places", inside.len());
    for [x, moment] in inside {
        // the scene is in N, the figure in kN m
        let exact = 8.0 * 9.81 * x * (8.0 - x) / 8.0;
        assert!(
            (moment / exact - 1.0).abs() < 1e-6,
            "{moment} at {x}, not {exact}"
        );
    }
}

#[test]
fn weight_of_the_structure_is_told_and_added_where_it_is_asked_for() {
    let mut given = scene(&json!([0.0]), 1.0, 1.0, 0.5);
    given["analysis"] = json!("quasi-static");
    given["compare"] = json!([{"label": "dead", "output": {"dead_load": true}}]);
    let ran = run(&given, &girder(&[10.0, 10.0]));
    let weight = 400.0 * 9.81 * 10.0;
    for (support, share) in [(1, 0.375), (2, 1.25), (3, 0.375)] {
        let name = format!("girder.support{support}.vertical");
        let response = &ran.outcomes[0].response;
        let at = response
            .columns
            .iter()
            .position(|column| column.name == name)
            .expect("a column");
        assert!((response.dead_load[at] / (share * weight) - 1.0).abs() < 1e-10);
        for (with, without) in ran.column(1, &name).iter().zip(ran.column(0, &name)) {
            assert!((with - without - share * weight).abs() < 1e-9 * weight);
        }
    }
}

#[test]
fn a_span_sags_by_the_classical_share_under_a_wheel_at_its_middle() {
    let (span, weight) = (10.0, 8000.0 * 9.81);
    let mut given = scene(&json!([0.0]), 1.0, 7.0, 0.25);
    given["analysis"] = json!("quasi-static");
    let ran = run(&given, &girder(&[span]));
    let found = &ran.outcomes[0].response.deflections;
    assert_eq!(found.len(), 1);
    let classical = weight * span.powi(3) / (48.0 * 2.1e11 * 2e-3);
    assert!(
        (found[0].value / classical - 1.0).abs() < 1e-9,
        "{:?}",
        found[0]
    );
    assert!((found[0].x - 5.0).abs() < 1e-8 && (found[0].time - 3.5).abs() < 1e-8);
    assert!((found[0].ratio().expect("it sags") / (span / classical) - 1.0).abs() < 1e-9);
    assert!(found[0].is_within(600.0));
}

#[test]
fn columns_are_those_that_the_scene_asks_for() {
    let mut given = scene(&json!([0.0]), 1.0, 1.0, 0.5);
    given["analysis"] = json!("quasi-static");
    given["output"]["reactions"] = json!(["girder.support2", "girder.support1.twist"]);
    given["compare"] = json!([{"label": "none", "output": {"reactions": false}}]);
    let mut spec = girder(&[10.0, 10.0]);
    spec["girder"]["rail_height"] = json!(0.5);
    let ran = run(&given, &spec);
    let names = |case: usize| -> Vec<String> {
        ran.outcomes[case]
            .response
            .columns
            .iter()
            .map(|column| column.name.clone())
            .collect()
    };
    let expected = [
        "girder.support1.twist",
        "girder.support2.vertical",
        "girder.support2.lateral",
        "girder.support2.twist",
    ];
    assert_eq!(names(0), expected);
    assert!(names(1).is_empty());
}

#[test]
fn a_drive_pushes_the_rail_back_and_its_support_holds_it() {
    let mut given = scene(&json!([-1.0, 1.0]), 1.0, 2.0, 0.05);
    given["bodies"]["car"]["dof"] = json!(["x", "y", "pitch"]);
    given["wheels"]["steel"]["driven"] = json!(true);
    given["motions"] = json!([{"body": "car", "dof": "x", "kind": "drive", "speed": [[0, 0], [1, 2]], "gain": 2e4}]);
    let ran = run(&given, &girder(&[10.0]));
    let drive = ran.column(0, "car.drive");
    let held = ran.column(0, "girder.support1.longitudinal");
    assert!(largest(drive.iter().copied()) > 1e4, "it drives");
    for (drive, held) in drive.iter().zip(held) {
        assert!(
            (drive - held).abs() < 1e-9 * 1e4,
            "{drive} drives, {held} holds"
        );
    }
}

#[test]
fn spans_of_the_mill_girderway_end_at_its_columns() {
    let example =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/mill_girderway");
    let document =
        Document::open(&example.join("scene.json")).unwrap_or_else(|wrong| panic!("{wrong:?}"));
    let (_, _, spec) = distinct_specs(&document).remove(0);
    let (model, rails) = spec.model().expect("a model");
    let found = spec.spans(&model, &rails, 0);
    assert_eq!(found, [0.0, 40.0, 95.0, 170.0, 230.0, 275.0, 325.0]);
    let [reactions, sections] = formats::scene::columns::names("aisle", spec);
    for name in ["aisle.column3.uy", "aisle.roof2.uz", "aisle.brace.ux"] {
        assert!(
            reactions.iter().any(|known| known == name),
            "{name} is not among {reactions:?}"
        );
    }
    assert!(sections.iter().any(|known| known == "aisle.bay3.Mz"));
}
