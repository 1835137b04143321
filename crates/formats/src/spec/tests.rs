//! Specs converted to other units describe the same structure.

use fea::FactoredFrame;

use super::{Form, Spec};
use crate::grid::StationGrid;
use crate::text::source::Source;
use crate::units::{Dimension, Force, Length, Scale, Units};

const FT_KIP: Units = Units {
    length: Length::Foot,
    force: Force::Kip,
};

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
    Source {
        name: "frame.json".to_owned(),
        text: text.to_owned(),
    }
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
    let factor = Scale {
        from: own.units,
        to: FT_KIP,
    }
    .factor(Dimension::FLEXIBILITY);
    let (own, other) = (solve(&own), solve(&other));
    assert_eq!(own.blocks.len(), 6);
    for ((quantity, a), (_, b)) in own.blocks.iter().zip(&other.blocks) {
        let largest = a.amax() * factor;
        let difference = (a * factor - b).amax();
        assert!(
            difference < 1e-12 * largest,
            "{quantity}: {difference:e} of {largest:e}"
        );
    }
}

#[test]
fn masses_are_converted_by_force_time_squared_over_length() {
    let Form::Frame(own) = read(&frame(), None).form else {
        panic!("the general form")
    };
    let Form::Frame(other) = read(&frame(), Some(FT_KIP)).form else {
        panic!("the general form")
    };
    // one kip s^2/ft in kilograms, one foot in metres
    let kip = 4448.2216152605 / 0.3048;
    let close = |a: f64, b: f64| (a - b).abs() < 1e-15 * a.abs();
    let (a, b) = (&own.model.masses[0], &other.model.masses[0]);
    assert!(close(a.mass, b.mass * kip));
    assert!(close(a.inertia[2], b.inertia[2] * kip * 0.3048 * 0.3048));
    assert!(close(a.offset[2], b.offset[2] * 0.3048));
    assert!(close(own.model.sections[0].mass, 7850.0 * 0.02));
    assert!(close(
        own.model.sections[0].mass,
        other.model.sections[0].mass * kip / 0.3048
    ));
}

#[test]
fn equal_units_leave_every_bit() {
    let own = read(&frame(), None);
    assert_eq!(own, read(&frame(), Some(own.units)));
    let range = own.rails()[0].range;
    assert_eq!(range, [-1.0, 8.0]);
}

#[test]
fn named_sections_and_rails_are_the_same_in_all_units() {
    let text = |units: &str, [length, modulus, density]: [f64; 3]| {
        let [span, offset] = [6.096, 0.3048].map(|metres: f64| metres / length);
        format!(
            r#"{{"format": "girderway-beam/1", "units": {units}, "points": [[0, 0, 0], [{span}, 0, 0]],
              "cells": [{{"type": "line", "data": [[0, 1]]}}],
              "materials": [{{"name": "steel", "E": {}, "G": {}, "density": {}}}],
              "sections": [{{"name": "girder", "material": "steel", "shape": "W24X94"}}],
              "supports": [{{"point": 0, "fix": ["ux", "uy", "uz", "rx"]}}, {{"point": 1, "fix": ["uy", "uz", "rx"]}}],
              "rails": {{"top": {{"axis": [1, 0, 0], "stations": [0, {span}], "crane_rail": "A100", "composite": true,
                                "segments": [{{"cell": [0, 0], "offset": [0, {offset}, 0]}}]}}}}}}"#,
            210e9 / modulus,
            81e9 / modulus,
            7850.0 / density
        )
    };
    let own = |units: Units| {
        let si = Scale {
            from: units,
            to: Units::SI,
        };
        [Dimension::LENGTH, Dimension::STRESS, Dimension::DENSITY]
            .map(|dimension| si.factor(dimension))
    };
    let all = [
        (r#"{"length": "m", "force": "N", "time": "s"}"#, Units::SI),
        (r#"{"length": "ft", "force": "kip", "time": "s"}"#, FT_KIP),
        (
            r#"{"length": "in", "force": "lbf", "time": "s"}"#,
            Units {
                length: Length::Inch,
                force: Force::Pound,
            },
        ),
        (
            r#"{"length": "mm", "force": "kN", "time": "s"}"#,
            Units {
                length: Length::Millimetre,
                force: Force::Kilonewton,
            },
        ),
    ];
    let specs = all.map(|(words, units)| {
        let source = Source {
            name: "frame.json".to_owned(),
            text: text(words, own(units)),
        };
        assert_eq!(read(&source, None).notes.len(), 2);
        let Form::Frame(frame) = read(&source, Some(Units::SI)).form else {
            panic!("a frame")
        };
        (
            frame.model.sections[frame.model.members[0].section],
            frame.rails[0].1.segments[0].offset,
        )
    });
    let (known, offset) = specs[0];
    // an A100 of 95 mm on a base 304.8 mm above the axis
    assert!((offset[1] - 0.3998).abs() < 1e-15);
    assert!((known.mass - (7850.0 * (known.area - 94.7e-4) + 74.3)).abs() < 1e-9);
    for (found, other) in specs {
        let numbers = |section: fea::CrossSection| {
            let shear = [section.shear_y, section.shear_z].map(|area| area.expect("a shear area"));
            [
                section.e,
                section.g,
                section.area,
                section.iy,
                section.iz,
                section.j,
                section.mass,
                shear[0],
                shear[1],
            ]
        };
        for (one, two) in numbers(known).into_iter().zip(numbers(found)) {
            assert!((one / two - 1.0).abs() < 1e-13, "{known:?} {found:?}");
        }
        assert!((other[1] - offset[1]).abs() < 1e-13);
    }
}

/// A girder of HEB 400 in m and N on which two rails lie, with further keys of cells and of each rail.
fn two_rails(cell_data: &str, keys: [&str; 2]) -> Source {
    let text = format!(
        r#"{{"format": "girderway-beam/1", "units": {{"length": "m", "force": "N", "time": "s"}}, "parts": 4,
          "points": [[0, 0, 0], [6, 0, 0], [12, 0, 0]],
          "cells": [{{"type": "line", "data": [[0, 1], [1, 2]]}}], "cell_data": {{{cell_data}}},
          "materials": [{{"name": "steel", "E": 2.1e11, "G": 8.1e10, "density": 7850}}],
          "sections": [{{"name": "girder", "material": "steel", "shape": "HEB 400"}},
                       {{"name": "deep", "material": "steel", "shape": "HEB 800"}}],
          "supports": [{{"point": 0, "fix": ["ux", "uy", "uz", "rx"]}}, {{"point": 2, "fix": ["uy", "uz", "rx"]}}],
          "rails": {{
            "one": {{"axis": [1, 0, 0], "stations": [0, 6], "segments": [{{"cell": [0, 0], "offset": [0, 0.2, 0]}}]{}}},
            "two": {{"axis": [-1, 0, 0], "stations": [-12, 0], "segments": [{{"cell": [0, 0], "offset": [0, 0.2, 0]}},
                                                              {{"cell": [0, 1], "offset": [0, 0.2, 0]}}]{}}}}}}}"#,
        keys[0], keys[1]
    );
    Source {
        name: "rails.json".to_owned(),
        text,
    }
}

fn sections_of(source: &Source) -> Vec<fea::CrossSection> {
    let Form::Frame(frame) = read(source, None).form else {
        panic!("a frame")
    };
    frame
        .model
        .members
        .iter()
        .map(|member| frame.model.sections[member.section])
        .collect()
}

#[test]
fn each_rail_adds_its_mass_to_its_own_members() {
    let uniform = r#""section": [0]"#;
    let bare = sections_of(&two_rails(uniform, ["", ""]));
    let railed = sections_of(&two_rails(
        uniform,
        [r#", "crane_rail": "A75""#, r#", "crane_rail": "A45""#],
    ));
    assert!((railed[0].mass - bare[0].mass - 56.2 - 22.1).abs() < 1e-10);
    assert!((railed[1].mass - bare[1].mass - 22.1).abs() < 1e-10);
    assert_eq!(
        fea::CrossSection {
            mass: bare[0].mass,
            ..railed[0]
        },
        bare[0]
    );
}

#[test]
fn a_composite_rail_stiffens_the_plane_that_is_upright() {
    let rail = [r#", "crane_rail": "A75", "composite": true"#, ""];
    let upright = sections_of(&two_rails(r#""section": [0]"#, rail));
    let lying = sections_of(&two_rails(
        r#""section": [0], "orientation": [[0, 0, 1]]"#,
        rail,
    ));
    let bare = sections_of(&two_rails(r#""section": [0]"#, ["", ""]))[0];
    let (own, part, distance) = (bare.area, 71.6e-4, 0.2 + 35.27e-3);
    let steiner = own * part / (own + part) * distance * distance;
    for (section, vertical, lateral) in [
        (upright[0], upright[0].iz - bare.iz, upright[0].iy - bare.iy),
        (lying[0], lying[0].iy - bare.iy, lying[0].iz - bare.iz),
    ] {
        assert!(
            (vertical / (531e-8 + steiner) - 1.0).abs() < 1e-12,
            "{section:?}"
        );
        assert!((lateral / 1011e-8 - 1.0).abs() < 1e-12, "{section:?}");
        assert!((section.area - own - part).abs() < 1e-15);
    }
    assert_eq!(upright[1], bare);
    let twice = r#", "crane_rail": "A75", "composite": true"#;
    let faults = Spec::read(&two_rails(r#""section": [0]"#, [twice; 2]), None)
        .expect_err("two composite rails");
    assert_eq!(faults.len(), 1, "{faults:?}");
    assert_eq!(faults[0].path, "rails.two.composite");
    assert_eq!(
        faults[0].expected,
        "a member can be composite with one rail only"
    );
}

#[test]
fn rails_lie_on_every_part_of_a_tapered_member() {
    let tapered = r#""section": [0], "section_b": [[1, null]]"#;
    let bare = sections_of(&two_rails(tapered, ["", ""]));
    let railed = sections_of(&two_rails(tapered, ["", r#", "crane_rail": "A75""#]));
    assert_eq!((bare.len(), railed.len()), (5, 5));
    for (one, other) in bare.iter().zip(&railed) {
        assert!((other.mass - one.mass - 56.2).abs() < 1e-10);
    }
    assert!(bare[0].iz < bare[3].iz);
}

#[test]
fn stations_are_tenths_of_the_spans_by_default() {
    let text = r#"{"format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
        "girder": {"spans": [6, 10], "overhangs": [1.5, 0], "section": "HEB 400"}}"#;
    let source = Source {
        name: "spec.json".to_owned(),
        text: text.to_owned(),
    };
    let spec = Spec::read(&source, None).expect("a spec of a section and its spans");
    let stations = &spec.rails()[0].stations;
    assert_eq!(stations.len(), 1 + 10 + 10 + 1);
    assert_eq!((stations[0], stations[1], stations[2]), (-1.5, 0.0, 0.6));
    assert_eq!((stations[11], stations[12], stations[21]), (6.0, 7.0, 16.0));
    let spans = vec!["6"; 3000].join(", ");
    let many = Source {
        text: text.replace("6, 10", &spans),
        ..source
    };
    let spec = Spec::read(&many, None).expect("a long runway");
    let stations = &spec.rails()[0].stations;
    assert!(
        (500..=1100).contains(&stations.len()) && stations.windows(2).all(|pair| pair[0] < pair[1])
    );
}

/// The portal of two columns and a girder with a preload of its own weight and forces on its corners.
fn portal(preload: &str) -> Source {
    let text = r#"{"format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
        "points": [[0, 0, 0], [0, 5, 0], [6, 5, 0], [6, 0, 0]], "point_sets": {"corner": [1]},
        "cells": [{"type": "line", "data": [[0, 1], [1, 2], [3, 2]]}],
        "cell_data": {"orientation": [[[0, 0, 1], [0, 1, 0], [0, 0, 1]]]},
        "materials": [{"name": "steel", "E": 2.1e8, "G": 8.1e7, "density": 7.85}],
        "sections": [{"name": "all", "material": "steel", "A": 0.01, "Iy": 5e-5, "Iz": 5e-5, "J": 1e-5}],
        "supports": [{"point": 0, "fix": ["ux", "uy", "uz", "rx", "ry", "rz"]},
                     {"point": 3, "fix": ["ux", "uy", "uz", "rx", "ry", "rz"]}],
        "rails": {"top": {"origin": [0, 5, 0], "axis": [1, 0, 0], "segments": [{"cell": [0, 1]}], "stations": [0, 3, 6]}},
        "preload": PRELOAD}"#;
    Source {
        name: "portal.json".to_owned(),
        text: text.replace("PRELOAD", preload),
    }
}

#[test]
fn the_model_of_a_spec_with_a_preload_is_that_about_its_state() {
    let loads = r#"{"loads": [{"point": "corner", "force": [0, -200, 0]}, {"point": 2, "force": [0, -200, 0]}]}"#;
    let spec = Spec::read(&portal(loads), None).expect("a spec with a preload");
    let (model, _) = spec.model().expect("it stands");
    let (unloaded, _) = spec.unloaded_model().expect("a model");
    assert_eq!(model.members.len(), 3);
    for (column, expected) in [(0, -200.0), (2, -200.0)] {
        assert!((model.members[column].tension / expected - 1.0).abs() < 1e-9);
    }
    assert!(unloaded.members.iter().all(|member| member.tension == 0.0));
    // The state is solved once: copies share it, and other units have their own.
    let state = spec.preloaded().expect("it stands").expect("a state");
    let copy = spec
        .clone()
        .preloaded()
        .expect("it stands")
        .expect("a state");
    assert!(std::sync::Arc::ptr_eq(&state, &copy));
    let si =
        Spec::read(&portal(loads), Some(crate::units::Units::SI)).expect("the same in newtons");
    let (model, _) = si.model().expect("it stands");
    assert!((model.members[0].tension / -200e3 - 1.0).abs() < 1e-9);
    let factor = si
        .preloaded()
        .expect("it stands")
        .expect("a state")
        .critical
        .value();
    assert!(
        (factor / state.critical.value() - 1.0).abs() < 1e-9,
        "{factor}"
    );
}

#[test]
fn weight_cuts_the_members_that_rise_and_warnings_name_cells() {
    let spec = Spec::read(
        &portal(r#"{"weight": true, "loads": [{"point": 1, "force": [0, -300, 0]}]}"#),
        None,
    )
    .expect("a spec with a preload");
    let Form::Frame(frame) = &spec.form else {
        panic!("the general form")
    };
    // w L^3/EI of a column is 0.0092: one part suffices; ten times as long it is cut.
    assert_eq!(frame.model.members.len(), 3);
    let high = portal(r#"{"weight": true}"#)
        .text
        .replace("5, 0]", "20, 0]")
        .replace("[0, 5, 0]", "[0, 20, 0]");
    let tall = Spec::read(
        &Source {
            name: "tall.json".to_owned(),
            text: high,
        },
        None,
    )
    .expect("a tall portal");
    let Form::Frame(frame) = &tall.form else {
        panic!("the general form")
    };
    assert!(
        frame.model.members.len() > 5
            && frame.cells.iter().filter(|cell| **cell == [0, 1]).count() == 1
    );
    let warnings = spec.warnings();
    assert!(
        warnings
            .iter()
            .any(|text| text.contains("critical factor") && text.contains("5.2.1(3)")),
        "{warnings:?}"
    );
    assert!(
        warnings.iter().any(|text| text.contains("cell [0, 0]")),
        "{warnings:?}"
    );
}
