//! Specs converted to other units describe the same structure.

use fea::FactoredFrame;

use super::{Form, Spec};
use crate::grid::StationGrid;
use crate::text::source::Source;
use crate::units::{Dimension, Force, Length, Scale, Units};

const FT_KIP: Units = Units { length: Length::Foot, force: Force::Kip };

fn frame() -> Source {
    let text = r#"{
      "format": "girderway-beam/1", "units": {"length": "m", "force": "N", "time": "s"}, "theory": "timoshenko",
      "points": [[0, 0, 0], [5, 0.4, 0], [9, 0, 0], [9, -3, 0.5], [5, 2, 0]],
      "cells": [{"type": "line", "data": [[0, 1], [1, 2], [2, 3]]}, {"type": "line", "data": [[1, 3]]}],
      "cell_data": {
        "kind": [["beam", "beam", "beam"], ["truss"]], "section": [[0, 0, 1], [1]],
        "orientation": [[[0, 1, 0], [0, 1, 0.2], [1, 0, 0]], [[0, 1, 0]]],
        "offset_b": [[[-0.1, 0, 0], [0, 0, 0], [0, 0.2, 0]], [[0, 0, 0]]],
        "release_a": [[[], [], ["rz"]], [[]]]
      },
      "materials": [{"name": "steel", "E": 2.1e11, "G": 8.1e10, "density": 7850}],
      "sections": [
        {"name": "girder", "material": "steel", "A": 0.02, "Iy": 2e-5, "Iz": 4e-4, "J": 2e-6, "Asy": 0.008, "Asz": 0.01},
        {"name": "column", "material": "steel", "A": 0.01, "Iy": 1e-5, "Iz": 1e-4, "J": 1e-6}
      ],
      "supports": [{"point": 0, "fix": ["ux", "uy", "uz", "rx"]}, {"point": 3, "fix": ["ux", "uy", "uz", "ry"]}],
      "springs": [{"point": 1, "dof": "uy", "k": 2e6}, {"point": 0, "dof": "ry", "k": 3e7}],
      "links": [{"from": 1, "to": 4}],
      "masses": [{"point": 4, "mass": 100, "inertia": [10, 20, 30], "offset": [0.1, 0.2, 0.3]}],
      "rails": {"top": {"origin": [1, 0, 0], "axis": [2, 0, 0], "stations": [-1, 2, 5, 8],
                        "segments": [{"cell": [0, 0], "offset": [0, 0.3, 0.1]}, {"cell": [0, 1], "offset": [0, 0.3, 0]}]}}
    }"#;
    Source { name: "frame.json".to_owned(), text: text.to_owned() }
}

fn read(source: &Source, units: Option<Units>) -> Spec {
    Spec::read(source, units).expect("a spec without faults")
}

fn solve(spec: &Spec) -> StationGrid {
    let (model, rails) = spec.model().expect("usable numbers");
    let frame = FactoredFrame::new(&model, &rails).expect("a stable structure");
    StationGrid::of(spec, &frame).expect("stations on the rail")
}

/// Source: the structure is the same, so its influence coefficients differ by the unit of length per force alone.
#[test]
fn a_frame_in_other_units_has_the_same_influence_coefficients() {
    let own = read(&frame(), None);
    let other = read(&frame(), Some(FT_KIP));
    let factor = Scale { from: own.units, to: FT_KIP }.factor(Dimension::FLEXIBILITY);
    let (own, other) = (solve(&own), solve(&other));
    assert_eq!(own.blocks.len(), 6);
    for ((quantity, a), (_, b)) in own.blocks.iter().zip(&other.blocks) {
        let largest = a.amax() * factor;
        let difference = (a * factor - b).amax();
        assert!(difference < 1e-12 * largest, "{quantity}: {difference:e} of {largest:e}");
    }
}

#[test]
fn masses_are_converted_by_force_time_squared_over_length() {
    let Form::Frame(own) = read(&frame(), None).form else { panic!("the general form") };
    let Form::Frame(other) = read(&frame(), Some(FT_KIP)).form else { panic!("the general form") };
    // one kip s^2/ft in kilograms, one foot in metres
    let kip = 4448.2216152605 / 0.3048;
    let close = |a: f64, b: f64| (a - b).abs() < 1e-15 * a.abs();
    let (a, b) = (&own.model.masses[0], &other.model.masses[0]);
    assert!(close(a.mass, b.mass * kip));
    assert!(close(a.inertia[2], b.inertia[2] * kip * 0.3048 * 0.3048));
    assert!(close(a.offset[2], b.offset[2] * 0.3048));
    assert!(close(own.model.sections[0].mass, 7850.0 * 0.02));
    assert!(close(own.model.sections[0].mass, other.model.sections[0].mass * kip / 0.3048));
}

#[test]
fn equal_units_leave_every_bit() {
    let own = read(&frame(), None);
    assert_eq!(own, read(&frame(), Some(own.units)));
    let range = own.rails()[0].range;
    assert_eq!(range, [-1.0, 8.0]);
}
