//! Foundations of scenes in every form, against closed forms of their compliance, frequencies and mass.

use std::path::Path;

use fea::Girder;
use formats::scene::{Document, Foundation, Structure};
use foundations::{
    BuiltFoundation, Error, ModeCache, MotionBasis, SolvedStructure, TrialObserver, build,
    distinct_specs, full_mesh_foundation, rigid_parts_foundation, solution_of, solve_specs,
};
use sim::Dynamics;
use splines::{Axis, Influence, Probe};

/// An example and the solutions of its specs.
fn example(name: &str) -> (Document, Vec<SolvedStructure>) {
    let path = format!("../../examples/{name}/scene.json");
    let document = Document::open(Path::new(&path)).expect("a scene without faults");
    let solved = solve_specs(&document, &distinct_specs(&document)).expect("structures that stand");
    (document, solved)
}

fn built(structure: &Structure, solved: &[SolvedStructure]) -> Result<BuiltFoundation, Error> {
    build(
        &mut ModeCache::default(),
        structure,
        solution_of(solved, &structure.origin),
        false,
    )
}

/// Displacement at x under a unit load at z, both vertical.
fn give(foundation: &sim::Foundation, x: f64, z: f64) -> f64 {
    let at = [x, z].map(|x| Probe {
        rail: 0,
        x,
        axis: Axis::Vertical,
    });
    let mut out = Influence::zeros(2);
    foundation
        .compliance
        .as_ref()
        .expect("a compliance")
        .fill(&at, &mut out)
        .expect("on the rail");
    out.value[(0, 1)]
}

fn frequencies(foundation: &sim::Foundation) -> Vec<f64> {
    match &foundation.structure.as_ref().expect("mass").dynamics {
        Dynamics::Modes { omega, .. } => omega.clone(),
        Dynamics::Matrices { .. } => panic!("natural modes"),
    }
}

/// Bridge of Yang and Yau: length, EI and mass per length.
const BRIDGE: [f64; 3] = [25.0, 2.87e9 * 2.9, 2303.0];

/// Analytic: (r pi/l)^2 sqrt(EI/m).
fn bridge(r: usize) -> f64 {
    let [l, ei, m] = BRIDGE;
    (r as f64 * std::f64::consts::PI / l).powi(2) * (ei / m).sqrt()
}

#[test]
fn a_rigid_foundation_has_the_rails_of_its_structure_and_no_motion() {
    let (document, solved) = example("bogie");
    let mut structure = document.scene().structures[0].clone();
    structure.foundation = Foundation::Rigid;
    let BuiltFoundation { foundation, basis } = built(&structure, &solved).expect("rigid");
    assert!(basis.is_none() && foundation.compliance.is_none() && foundation.dofs() == 0);
    let ranges: Vec<_> = foundation.rails.iter().map(|rail| rail.range).collect();
    assert_eq!(ranges, [Some([-15.0, 75.0])]);
}

/// Analytic: l^3/48EI at midspan, with the residual flexibility beside any number of modes as without mass.
#[test]
fn influence_functions_and_modes_have_the_static_compliance_of_the_bridge() {
    let (document, solved) = example("yang_yau");
    let [l, ei, _] = BRIDGE;
    let expected = l.powi(3) / (48.0 * ei);
    let mut structure = document.scene().structures[0].clone();
    structure.foundation = Foundation::Influence;
    let influence = built(&structure, &solved)
        .expect("a bridge that stands")
        .foundation;
    assert!((give(&influence, 0.5 * l, 0.5 * l) / expected - 1.0).abs() < 1e-12);
    structure.foundation = Foundation::Modal {
        modes: 5,
        damping: 0.0,
    };
    let modal = built(&structure, &solved)
        .expect("a bridge with mass")
        .foundation;
    let own = |r: usize| 2.0 / (BRIDGE[2] * l) / bridge(r).powi(2);
    let rest = expected - [1, 3, 5].map(own).iter().sum::<f64>();
    assert!((give(&modal, 0.5 * l, 0.5 * l) - rest).abs() < 1e-5 * expected);
}

/// Analytic: 64 modes of one member, and all modes of meshes whose elements divide it into 16 to 80 equal parts, have every
/// frequency of the bridge; sin(16 pi x/l) is zero at the ends of 16 equal parts.
#[test]
fn no_mode_is_taken_for_one_that_wheels_cannot_excite() {
    let (document, solved) = example("yang_yau");
    let mut structure = document.scene().structures[0].clone();
    let modal = |modes| {
        (
            Foundation::Modal {
                modes,
                damping: 0.0,
            },
            modes,
        )
    };
    let full = |elements| {
        (
            Foundation::Full {
                elements,
                damping: 0.0,
            },
            elements / 2,
        )
    };
    for (foundation, count) in [modal(20), modal(64), full(16), full(32), full(64), full(80)] {
        structure.foundation = foundation;
        let found = frequencies(
            &built(&structure, &solved)
                .expect("a bridge with mass")
                .foundation,
        );
        for r in 1..=count {
            assert!(
                (found[r - 1] / bridge(r) - 1.0).abs() < 0.01,
                "mode {r} of {count}: {}",
                found[r - 1] / bridge(1)
            );
        }
    }
}

/// Analytic: frequencies of the bridge, within 1e-6.
#[test]
fn a_number_of_modes_has_the_frequencies_of_the_bridge() {
    let (document, solved) = example("yang_yau");
    let mut structure = document.scene().structures[0].clone();
    structure.foundation = Foundation::Modal {
        modes: 6,
        damping: 0.03,
    };
    let omega = frequencies(
        &built(&structure, &solved)
            .expect("a bridge with mass")
            .foundation,
    );
    assert!(omega.len() >= 6, "{}", omega.len());
    for (k, omega) in omega.iter().take(6).enumerate() {
        let error = (omega / bridge(k + 1) - 1.0).abs();
        assert!(error < 1e-6, "mode {k}: {error:e}");
    }
    let Dynamics::Modes { ratio, .. } = &built(&structure, &solved)
        .expect("a bridge")
        .foundation
        .structure
        .expect("mass")
        .dynamics
    else {
        panic!("natural modes")
    };
    assert!(ratio.iter().all(|ratio| *ratio == 0.03));
}

/// Two equal bridges side by side have each frequency twice, analytic as above. An odd number of modes, of which the last pair
/// is incomplete, needs no finer mesh than an even number some modes above it.
#[test]
fn an_odd_number_of_modes_of_two_equal_bridges_needs_few_more() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let spec = r#"{"format": "girderway-beam/1", "units": {"length": "m", "force": "N", "time": "s"},
        "theory": "euler-bernoulli", "points": [[0, 0, 0], [25, 0, 0], [0, 0, 9], [25, 0, 9]],
        "cells": [{"type": "line", "data": [[0, 1], [2, 3]]}],
        "materials": [{"name": "concrete", "E": 2.87e9, "G": 1.2e9, "density": 1151.5}],
        "sections": [{"name": "bridge", "material": "concrete", "A": 2, "Iy": 1, "Iz": 2.9, "J": 1}],
        "supports": [{"point": 0, "fix": ["ux", "uy", "uz", "rx"]}, {"point": 1, "fix": ["uy", "uz", "rx"]},
            {"point": 2, "fix": ["ux", "uy", "uz", "rx"]}, {"point": 3, "fix": ["uy", "uz", "rx"]}],
        "rails": {"a": {"axis": [1, 0, 0], "segments": [{"cell": [0, 0]}], "stations": [0, 25]},
            "b": {"origin": [0, 0, 9], "axis": [1, 0, 0], "segments": [{"cell": [0, 1]}], "stations": [0, 25]}}}"#;
    let scene = r#"{"format": "girderway-scene/1", "units": {"length": "m", "force": "N", "time": "s"}, "gravity": 9.81,
        "structures": {"s": {"spec": "spec.json", "foundation": "modal"}},
        "bodies": {"car": {"mass": 5750, "inertia": [1000, 1000, 1000], "dof": ["y", "roll", "pitch"], "track": ["s.a", "s.b"]}},
        "wheels": {"w": {"radius": 0.5, "vertical": {"k": 1.6e6}}},
        "trucks": [{"name": "a", "body": "car", "tree": [0], "rail": "s.a", "wheel": "w", "at": [0, 0, -4.5]},
            {"name": "b", "body": "car", "tree": [0], "rail": "s.b", "wheel": "w", "at": [0, 0, 4.5]}],
        "motions": [{"body": "car", "dof": "x", "kind": "prescribed", "position": [[0, 0], [1, 25]]}],
        "end": {"time": 1}}"#;
    let path = folder.path().join("scene.json");
    std::fs::write(folder.path().join("spec.json"), spec).expect("a writable folder");
    std::fs::write(&path, scene).expect("a writable folder");
    let document = Document::open(&path).expect("a scene without faults");
    let solved = solve_specs(&document, &distinct_specs(&document)).expect("structures that stand");
    let mesh = |modes: usize| {
        let mut structure = document.scene().structures[0].clone();
        structure.foundation = Foundation::Modal {
            modes,
            damping: 0.0,
        };
        let found = built(&structure, &solved).expect("bridges with mass");
        let Some(MotionBasis::Modes { refined, .. }) = found.basis else {
            panic!("natural modes")
        };
        (refined.parts, frequencies(&found.foundation))
    };
    for modes in [1, 3, 5] {
        let (parts, omega) = mesh(modes);
        assert!(parts[0] <= mesh(modes + 9).0[0], "{modes}: {parts:?}");
        for (k, omega) in omega.iter().take(modes).enumerate() {
            let error = (omega / bridge(k / 2 + 1) - 1.0).abs();
            assert!(error < 1e-6, "mode {k} of {modes}: {error:e}");
        }
    }
}

#[test]
fn a_full_mesh_has_the_frequencies_of_the_bridge_without_damping() {
    let (document, solved) = example("yang_yau");
    let structure = &document.scene().structures[0];
    let known = solution_of(&solved, &structure.origin).expect("solved");
    let coarse = full_mesh_foundation(known, 4).expect("a bridge with mass");
    let fine = full_mesh_foundation(known, 16).expect("a bridge with mass");
    let error = |of: &sim::Foundation| (frequencies(of)[0] / bridge(1) - 1.0).abs();
    // Analytic: cubic elements with their consistent mass err by (pi/n)^4/1440 in the first of n elements.
    for (foundation, count) in [(&coarse, 4.0), (&fine, 16.0)] {
        let expected = (std::f64::consts::PI / count).powi(4) / 1440.0;
        let found = error(foundation);
        assert!(
            (found / expected - 1.0).abs() < 0.05,
            "{count} elements: {found:e}, not {expected:e}"
        );
    }
    assert!(coarse.dofs() < fine.dofs());
    // The scene asks for 32 elements.
    let BuiltFoundation { foundation, basis } =
        built(structure, &solved).expect("a bridge with mass");
    let Some(MotionBasis::Modes { refined, .. }) = basis else {
        panic!("natural modes")
    };
    assert_eq!((refined.parts, refined.model.members.len()), (vec![32], 32));
    assert!(error(&foundation) < 1e-7);
}

/// Analytic: a load P at the joint of two rigid halves bends the beam of 45 ft between their centres by the moment
/// P/2 30 ft; the joint sinks by P 30^2 45/(4 EI).
#[test]
fn rigid_halves_have_the_closed_form_of_their_joint() {
    let (e, i_vertical) = (4.32e9, 9.528);
    let girder = Girder {
        spans: vec![60.0],
        overhangs: [15.0; 2],
        e,
        i_vertical,
        ..Girder::default()
    };
    for window in [None, Some(20.0)] {
        let foundation = rigid_parts_foundation(&girder, 2, window).expect("a chain that stands");
        let expected = 15.0 * 15.0 * 45.0 / (e * i_vertical);
        let found = give(&foundation, 30.0, 30.0);
        assert!(
            (found / expected - 1.0).abs() < 1e-12,
            "{found:e}, not {expected:e}"
        );
    }
    assert!(matches!(
        rigid_parts_foundation(&girder, 3, Some(50.0)),
        Err(Error::Windows)
    ));
}

#[test]
fn forms_that_need_a_solution_or_a_girder_are_refused_without_it() {
    let (document, _) = example("bogie");
    let mut structure = document.scene().structures[0].clone();
    structure.foundation = Foundation::Modal {
        modes: 2,
        damping: 0.0,
    };
    assert!(
        matches!(built(&structure, &[]), Err(Error::NoSpec { structure }) if structure == "girder")
    );
    structure.foundation = Foundation::Full {
        elements: 2,
        damping: 0.0,
    };
    assert!(matches!(built(&structure, &[]), Err(Error::NoSpec { .. })));
    let parts = document
        .cases
        .iter()
        .find(|case| case.label.as_deref() == Some("parts-blended"));
    let parts = &parts.expect("the example compares them").scene.structures[0];
    assert!(
        matches!(built(parts, &[]), Err(Error::NoGirder { structure }) if structure == "girder")
    );
}

/// A spec with an area is known along its rail, a table of vertical deflections is not.
#[test]
fn compliance_along_the_rail_is_required_where_forces_act_along_it() {
    let (document, solved) = example("bogie");
    let mut structure = document.scene().structures[0].clone();
    assert!(
        !built(&structure, &solved)
            .expect("a girder")
            .foundation
            .is_loaded_along
    );
    structure.longitudinal = true;
    let foundation = built(&structure, &solved)
        .expect("a girder with an area")
        .foundation;
    assert!(foundation.is_loaded_along);
    let tables = document
        .cases
        .iter()
        .find(|case| case.label.as_deref() == Some("printed-akispl"));
    let mut tables = tables.expect("the example compares them").scene.structures[0].clone();
    assert!(built(&tables, &solved).is_ok());
    tables.longitudinal = true;
    let refused = built(&tables, &solved);
    assert!(matches!(refused, Err(Error::NoLongitudinal { structure }) if structure == "girder"));
}

/// Analytic: two box girders of 75 ft on the bridge of the crane; 19.7986 slug/ft^3 times 2.0312 ft^2 each. The rails of
/// the aisle are uneven and stand on the ground.
#[test]
fn a_structure_on_a_body_has_its_mass_and_an_uneven_rail_its_irregularity() {
    let (document, solved) = example("bridge_crane");
    let [aisle, girders] = &document.scene().structures[..] else {
        panic!("two structures")
    };
    let foundation = built(girders, &solved)
        .expect("girders that stand")
        .foundation;
    let carrier = foundation.carrier.expect("on the bridge");
    let mass = 2.0 * 75.0 * 19.7986 * 2.0312;
    assert_eq!(carrier.body, 0);
    for k in 0..3 {
        assert!(
            (carrier.mass[k][k] / mass - 1.0).abs() < 1e-12,
            "{} of {mass}",
            carrier.mass[k][k]
        );
    }
    assert!(carrier.coupling.is_empty() && foundation.irregularities.is_empty());
    assert_eq!(carrier.rails.len(), girders.rails.len());
    let ground = built(aisle, &solved)
        .expect("an aisle that stands")
        .foundation;
    assert!(ground.carrier.is_none() && ground.is_loaded_along);
    assert_eq!(ground.irregularities, aisle.irregularities);
    assert_eq!(ground.irregularities.len(), 2);
    // With modes, the mass that moves with the bridge is that of the mesh, and every mode has a momentum.
    let modal = Structure {
        foundation: Foundation::Modal {
            modes: 4,
            damping: 0.0,
        },
        ..girders.clone()
    };
    let foundation = built(&modal, &solved)
        .expect("girders with mass")
        .foundation;
    let carrier = foundation.carrier.expect("on the bridge");
    assert!(
        (carrier.mass[1][1] / mass - 1.0).abs() < 1e-9,
        "{} of {mass}",
        carrier.mass[1][1]
    );
    let dofs = foundation.structure.expect("mass").dynamics.dofs();
    assert_eq!(carrier.coupling.len(), dofs);
    assert!(dofs >= 4);
}

/// The members of a rail on ties end at the ties and are not divided further; without mass there is no motion.
#[test]
fn a_rail_on_ties_moves_at_its_ties() {
    let (document, solved) = example("ties");
    let structure = &document.scene().structures[0];
    let known = solution_of(&solved, &structure.origin).expect("solved");
    let BuiltFoundation { foundation, basis } = built(structure, &solved).expect("ties with mass");
    let Some(MotionBasis::Modes { refined, .. }) = basis else {
        panic!("natural modes")
    };
    assert_eq!(refined.model.members.len(), known.model.members.len());
    assert!(refined.parts.iter().all(|parts| *parts == 1) && foundation.dofs() > 0);
    let light = document
        .cases
        .iter()
        .find(|case| case.label.as_deref() == Some("without mass"));
    let light = &light.expect("the example compares them").scene.structures[0];
    let BuiltFoundation { foundation, basis } = built(light, &solved).expect("ties without mass");
    assert!(basis.is_none() && foundation.dofs() == 0 && foundation.compliance.is_some());
}

#[test]
fn without_an_observer_no_effects_are_judged() {
    let (document, solved) = example("yang_yau");
    let basis = built(&document.scene().structures[0], &solved)
        .expect("a bridge")
        .basis
        .expect("modes");
    assert_eq!(
        ().effects(0, &basis).expect("nothing is computed"),
        Vec::new()
    );
}
