//! Ends of spans by plane.

use fea::{Girder, GroundSpring, Model, Rail};
use splines::Axis;
use trains::{Structure, SupportedEnds, supported_ends};

/// A girder of HEB 500 over `count` spans of `length`, in m and kN.
fn girder(count: usize, length: f64) -> (Model, Rail) {
    let girder = Girder {
        spans: vec![length; count],
        e: 2.1e8,
        g: Some(8.1e7),
        area: Some(0.0239),
        i_vertical: 1.072e-3,
        i_lateral: Some(1.262e-4),
        j: Some(5.4e-6),
        ..Girder::default()
    };
    girder.model_and_rail().expect("a girder")
}

fn ends(model: &Model, rail: &Rail, axis: Axis, candidates: &[f64]) -> SupportedEnds {
    let rails = std::slice::from_ref(rail);
    let structure = Structure::new(model, rails, false).expect("stable");
    let surface = structure.frame().surface().expect("a surface").surface;
    let found = supported_ends(model, rails, &surface, &[candidates.to_vec()]);
    let [vertical, lateral] = found.expect("candidates on the rail").remove(0);
    if axis == Axis::Vertical {
        vertical
    } else {
        lateral
    }
}

fn places(count: usize, length: f64) -> Vec<f64> {
    (0..=count).map(|k| length * k as f64).collect()
}

/// Replaces the vertical restraint of a support by a spring.
fn on_spring(model: &mut Model, support: usize, stiffness: f64) {
    model.supports[support].fixed[1] = false;
    model.springs.push(GroundSpring {
        point: model.supports[support].point,
        dof: fea::Dof::Uy,
        stiffness,
    });
}

#[test]
fn lateral_supports_end_no_vertical_span() {
    let (mut model, rail) = girder(6, 2.0);
    for support in 1..6 {
        model.supports[support].fixed[1] = false;
    }
    let at = places(6, 2.0);
    assert_eq!(ends(&model, &rail, Axis::Vertical, &at).ends, [0.0, 12.0]);
    assert_eq!(ends(&model, &rail, Axis::Lateral, &at).ends, at);
}

#[test]
fn the_only_two_supports_end_a_span_however_soft_they_are() {
    for stiffness in [1e8, 1e4, 1e2, 1.0] {
        let (mut model, rail) = girder(2, 6.0);
        for support in 0..3 {
            model.supports[support].fixed[1] = false;
        }
        on_spring(&mut model, 0, stiffness);
        on_spring(&mut model, 2, stiffness);
        let found = ends(&model, &rail, Axis::Vertical, &places(2, 6.0));
        assert_eq!(
            (found.ends, found.has_elastic_bed),
            (vec![0.0, 12.0], false)
        );
    }
}

// The middle spring of a girder over two spans of 6 m has the stiffness k; the girder resists it by 48 E I/12^3.
#[test]
fn a_spring_ends_a_span_from_a_twentieth_of_the_stiffness_of_the_girder() {
    let girder_stiffness = 48.0 * 2.1e8 * 1.072e-3 / 12f64.powi(3);
    for (share, count) in [(10.0, 3), (0.06, 3), (0.04, 2), (1e-4, 2)] {
        let (mut model, rail) = girder(2, 6.0);
        on_spring(&mut model, 1, share * girder_stiffness);
        let found = ends(&model, &rail, Axis::Vertical, &places(2, 6.0));
        assert_eq!(found.ends.len(), count, "{share}");
        assert_eq!(found.firm.len(), if share < 1.0 { 2 } else { 3 }, "{share}");
    }
}

#[test]
fn a_girder_on_many_springs_has_no_spans() {
    let (mut model, rail) = girder(160, 0.6);
    for support in 0..161 {
        on_spring(&mut model, support, 2e4);
    }
    let found = ends(&model, &rail, Axis::Vertical, &places(160, 0.6));
    assert!(found.has_elastic_bed, "{found:?}");
}

#[test]
fn a_load_point_at_the_tip_of_an_overhang_is_no_support() {
    let (mut model, rail) = girder(3, 4.0);
    model.supports[3].fixed = [false; 6];
    let found = ends(&model, &rail, Axis::Vertical, &places(3, 4.0));
    assert_eq!(
        (found.ends, found.has_elastic_bed),
        (vec![0.0, 4.0, 8.0], false)
    );
}
