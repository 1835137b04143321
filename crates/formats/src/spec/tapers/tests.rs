//! Tapered members of beam specs whose sections have shapes, against quadrature of the unit-load integral.

use crate::spec::Spec;
use crate::text::source::Source;
use fea::FactoredFrame;
use splines::{Axis, Probe};

const LENGTH: f64 = 20.0;
const E: f64 = 4.32e9;
const G: f64 = 1.66e9;

/// A cantilever along x in `parts`, from one section to another.
fn cantilever(root: &str, tip: &str, theory: &str, parts: usize) -> Spec {
    let text = format!(
        r#"{{"format": "girderway-beam/1", "units": {{"length": "ft", "force": "lbf", "time": "s"}},
        "theory": "{theory}", "points": [[0, 0, 0], [{LENGTH}, 0, 0]], "cells": [{{"type": "line", "data": [[0, 1]]}}],
        "cell_data": {{"section": [[0]], "section_b": [[1]]}}, "parts": {parts},
        "materials": [{{"name": "m", "E": {E}, "G": {G}, "density": 15.2}}],
        "sections": [{{"name": "root", "material": "m", {root}}}, {{"name": "tip", "material": "m", {tip}}}],
        "supports": [{{"point": 0, "fix": ["ux", "uy", "uz", "rx", "ry", "rz"]}}],
        "rails": {{"r": {{"axis": [1, 0, 0], "segments": [{{"cell": [0, 0]}}], "stations": [{LENGTH}]}}}}}}"#
    );
    Spec::read(
        &Source {
            name: "taper.json".to_owned(),
            text,
        },
        None,
    )
    .expect("a spec without faults")
}

/// Displacement of the tip under a unit force along the same axis.
fn tip(spec: &Spec, axis: Axis) -> f64 {
    let (model, rails) = spec.model().expect("usable numbers");
    let frame = FactoredFrame::new(&model, &rails).expect("a stable structure");
    frame
        .grid(&[Probe {
            rail: 0,
            x: LENGTH,
            axis,
        }])
        .expect("on the rail")
        .value[(0, 0)]
}

/// Integral over the length by Simpson's rule in 20,000 intervals; f takes the fraction of the length.
fn integral(f: impl Fn(f64) -> f64) -> f64 {
    let n = 20_000;
    let h = 1.0 / f64::from(n);
    let inner = |k: i32| if k % 2 == 1 { 4.0 } else { 2.0 } * f(f64::from(k) * h);
    (f(0.0) + (1..n).map(inner).sum::<f64>() + f(1.0)) * h / 3.0 * LENGTH
}

/// Errors relative to `exact` with 2 to 64 parts fall with the square of the number of parts.
fn assert_second_order(exact: f64, tip: impl Fn(usize) -> f64) -> f64 {
    let error = |parts: usize| (tip(parts) / exact - 1.0).abs();
    let errors = [2, 4, 8, 16, 32, 64].map(error);
    for pair in errors.windows(2).skip(1) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.1, "order {order}: {errors:?}");
    }
    println!("{errors:?}");
    errors[4]
}

#[test]
fn tapered_bars_converge_to_the_quadrature_of_m_squared_over_ei() {
    let sections =
        [2.0, 1.0].map(|h| format!(r#""shape": {{"kind": "bar", "height": {h}, "width": 0.5}}"#));
    let tip_of = |parts| {
        tip(
            &cantilever(&sections[0], &sections[1], "euler-bernoulli", parts),
            Axis::Vertical,
        )
    };
    let exact = integral(|s| (LENGTH * (1.0 - s)).powi(2) / (E * 0.5 * (2.0 - s).powi(3) / 12.0));
    assert!((exact / 3.0288e-6 - 1.0).abs() < 1e-4);
    let error = assert_second_order(exact, tip_of);
    assert!(error < 1e-3, "32 parts: {error:e}");
    assert!((tip_of(1000) / exact - 1.0).abs() < 1e-6);
}

#[test]
fn tapered_boxes_in_other_units_converge_in_both_planes_with_shear() {
    let sections = [[36.0, 18.0], [18.0, 12.0]].map(|[h, b]| {
        format!(r#""shape": {{"kind": "box", "height": {h}, "width": {b}, "flange": 1, "web": 0.5, "length": "in"}}"#)
    });
    let second = |b: f64, h: f64, web: f64, flange: f64| {
        (b * h.powi(3) - (b - 2.0 * web) * (h - 2.0 * flange).powi(3)) / 12.0 / 12f64.powi(4)
    };
    let lever = |s: f64| (LENGTH * (1.0 - s)).powi(2);
    let vertical = integral(|s| {
        let [h, b] = [36.0 - 18.0 * s, 18.0 - 6.0 * s];
        lever(s) / (E * second(b, h, 0.5, 1.0)) + 1.0 / (G * (h - 2.0) / 144.0)
    });
    let lateral = integral(|s| {
        let [h, b] = [36.0 - 18.0 * s, 18.0 - 6.0 * s];
        lever(s) / (E * second(h, b, 1.0, 0.5)) + 1.0 / (G * 2.0 * (b - 1.0) / 144.0)
    });
    for (axis, exact) in [(Axis::Vertical, vertical), (Axis::Lateral, lateral)] {
        let error = assert_second_order(exact, |parts| {
            tip(
                &cantilever(&sections[0], &sections[1], "timoshenko", parts),
                axis,
            )
        });
        assert!(error < 1e-3, "{axis:?}: {error:e}");
    }
    let exact = integral(|s| {
        let [h, b] = [36.0 - 18.0 * s, 18.0 - 6.0 * s];
        144.0 / (E * (b * h - (b - 1.0) * (h - 2.0)))
    });
    let found = tip(
        &cantilever(&sections[0], &sections[1], "timoshenko", 3),
        Axis::Longitudinal,
    );
    assert!(
        (found / exact - 1.0).abs() < 1e-12,
        "elongation is exact in any number of parts"
    );
}

#[test]
fn mass_of_a_tapered_shape_is_that_of_its_volume_in_any_number_of_parts() {
    let sections = [[2.0, 0.5], [1.0, 0.2]]
        .map(|[h, b]| format!(r#""shape": {{"kind": "bar", "height": {h}, "width": {b}}}"#));
    let volume = integral(|s| (2.0 - s) * (0.5 - 0.3 * s));
    for parts in [1, 5] {
        let (model, _) = cantilever(&sections[0], &sections[1], "timoshenko", parts)
            .model()
            .expect("usable numbers");
        let mass = fea::rigid_mass(&model).expect("usable numbers")[0][0];
        assert!(
            (mass / (15.2 * volume) - 1.0).abs() < 1e-12,
            "{parts} parts: {mass}"
        );
    }
}

#[test]
fn stated_properties_of_tapered_shapes_vary_linearly_as_before() {
    let shape = |h: f64| format!(r#""shape": {{"kind": "bar", "height": {h}, "width": 0.5}}"#);
    let numbers = |h: f64| {
        let (area, iz, iy) = (0.5 * h, 0.5 * h.powi(3) / 12.0, 0.125 * h / 12.0);
        format!(r#""A": {area}, "Iz": {iz}, "Iy": {iy}, "J": 0.02, "Asy": {area}, "Asz": {area}"#)
    };
    let both = |h: f64| format!("{}, {}", numbers(h), shape(h));
    let model = |root: String, tip: String| {
        cantilever(&root, &tip, "timoshenko", 7)
            .model()
            .expect("usable numbers")
            .0
            .sections
    };
    let plain = model(numbers(2.0), numbers(1.0));
    assert_eq!(
        plain,
        model(both(2.0), both(1.0)),
        "numbers beside a shape take precedence"
    );
    assert_eq!(
        plain,
        model(both(2.0), numbers(1.0)),
        "one end has no shape"
    );
}
