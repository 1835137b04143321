//! Modes that given forces excite: against closed forms, and against all modes of the same frame.

use crate::common;

use common::{mill, paper};
use fea::{
    BeamTheory, Error, ExcitingForces, FactoredFrame, Girder, Model, Modes, PointMass, Rail,
    excited_modes, modes,
};
use splines::{Axis, Probe};

/// A girder on two supports whose lateral, axial and torsional modes lie among the vertical ones.
fn girder() -> Girder {
    Girder {
        overhangs: [0.0; 2],
        stations: vec![0.0, 60.0],
        mass_per_length: Some(15.2),
        ..paper()
    }
}

fn largest(modes: &Modes, axis: Axis, range: [f64; 2]) -> Vec<f64> {
    let mut out = vec![0.0_f64; modes.modes.len()];
    for k in 0..=40 {
        let x = range[0] + (range[1] - range[0]) * f64::from(k) / 40.0;
        let Ok(values) = modes.at(Probe { rail: 0, x, axis }) else {
            continue;
        };
        out.iter_mut()
            .zip(values)
            .for_each(|(most, [value, _])| *most = most.max(value.abs()));
    }
    out
}

#[test]
fn vertical_forces_excite_the_vertical_modes_and_no_others() {
    let given = girder();
    let (model, rail) = given.model_and_rail().expect("a girder on two supports");
    let found =
        excited_modes(&model, &[rail], &ExcitingForces::vertical(), 24, 1e-4).expect("it has mass");
    assert_eq!(found.modes.modes.len(), 24);
    // Closed form: omega_n = (n pi/L)^2 sqrt(EI/m), every n without a gap.
    let unit = (given.e * given.i_vertical / 15.2).sqrt() * (std::f64::consts::PI / 60.0).powi(2);
    for (n, mode) in (1..).zip(&found.modes.modes) {
        let exact = f64::from(n * n) * unit;
        assert!(
            (mode.omega / exact - 1.0).abs() < 1e-4,
            "{n}: {} {exact}",
            mode.omega
        );
        assert!(
            mode.points
                .iter()
                .all(|motion| [0, 2, 3, 4].iter().all(|&k| motion[k] == 0.0))
        );
    }
}

/// Members without mass have no modes of their own, however they are cut.
#[test]
fn members_without_mass_are_not_cut() {
    let given = Girder {
        overhangs: [0.0, 9.0],
        mass_per_length: None,
        ..girder()
    };
    let (mut model, rail) = given.model_and_rail().expect("a girder on two supports");
    let along = |point: usize| model.points[point][0];
    let tip = (0..model.points.len()).max_by(|&a, &b| along(a).total_cmp(&along(b)));
    model.masses.push(PointMass {
        point: tip.expect("it has points"),
        mass: 7.0,
        inertia: [0.0; 3],
        offset: [0.0; 3],
    });
    let found =
        excited_modes(&model, &[rail], &ExcitingForces::vertical(), 24, 1e-4).expect("it has mass");
    assert_eq!(found.parts, vec![1; model.members.len()]);
    // Closed form: a force at the tip moves it by a^2 (L + a)/(3 E I) for an overhang a of a span L.
    let flexibility = 9.0_f64.powi(2) * (60.0 + 9.0) / (3.0 * given.e * given.i_vertical);
    let [mode] = found.modes.modes.as_slice() else {
        panic!("one mass moves vertically: {:?}", found.modes.modes.len());
    };
    let exact = (7.0 * flexibility).sqrt().recip();
    assert!(
        (mode.omega / exact - 1.0).abs() < 1e-9,
        "{} {exact}",
        mode.omega
    );
}

/// The two searches share the matrices, not the unknowns: a mode that moves the rail vertically must be in both.
fn assert_same_vertical_modes(model: &Model, rail: &Rail, count: usize) {
    let frame = FactoredFrame::new(model, std::slice::from_ref(rail)).expect("it stands");
    let all = frame.modes(model, count).expect("it has mass");
    let excited = frame
        .excited_modes(model, &ExcitingForces::vertical(), count)
        .expect("it has mass");
    let [a, b] = frame.line().expect("a rail").range(0).expect("a rail");
    let moves = largest(&all, Axis::Vertical, [a, b]);
    let limit = 1e-6 * moves.iter().fold(0.0_f64, |most, &value| most.max(value));
    let mut left = excited
        .modes
        .iter()
        .zip(largest(&excited, Axis::Vertical, [a, b]));
    let mut compared = 0;
    for (mode, _) in all
        .modes
        .iter()
        .zip(&moves)
        .filter(|(_, moves)| **moves > limit)
    {
        let found = left
            .find(|(_, moves)| *moves > limit)
            .expect("none is missing")
            .0;
        assert!(
            (found.omega / mode.omega - 1.0).abs() < 1e-8,
            "{} {}",
            found.omega,
            mode.omega
        );
        compared += 1;
    }
    assert!(compared > 3, "{compared} modes move the rail vertically");
}

#[test]
fn every_mode_that_moves_the_rail_is_found() {
    // A building in space, all of whose motions are connected.
    let (mut building, rail) = mill(BeamTheory::Timoshenko);
    building
        .sections
        .iter_mut()
        .for_each(|section| section.mass = 3.0);
    assert_same_vertical_modes(&building, &rail, 30);
    // A girder oblique to the global axes: bending and torsion share the global rotations.
    let (mut model, mut rail) = girder().model_and_rail().expect("a girder on two supports");
    let turn = |[x, y, z]: [f64; 3]| [0.6 * x - 0.8 * z, y, 0.8 * x + 0.6 * z];
    let given = model.points.clone();
    let (cut, cut_rail) = {
        model.points = given.into_iter().map(turn).collect();
        model
            .members
            .iter_mut()
            .for_each(|member| member.orientation = turn(member.orientation));
        model
            .supports
            .iter_mut()
            .for_each(|support| support.fixed[..4].fill(true));
        (rail.axis, rail.origin) = (turn(rail.axis), turn(rail.origin));
        rail.segments
            .iter_mut()
            .for_each(|segment| segment.offset = turn(segment.offset));
        let found = excited_modes(&model, &[rail], &ExcitingForces::vertical(), 6, 1e-4)
            .expect("it has mass");
        (found.model, found.rails)
    };
    assert_same_vertical_modes(&cut, &cut_rail[0], 40);
}

#[test]
fn motions_of_the_supports_excite_modes_in_their_direction() {
    let given = girder();
    let (model, rail) = given.model_and_rail().expect("a girder on two supports");
    // Lateral motion: only lateral bending, here with pinned ends, omega_n = (n pi/L)^2 sqrt(EI/m).
    let forces = ExcitingForces {
        axes: vec![],
        motions: vec![[0.0, 0.0, 1.0, 0.0, 0.0, 0.0]],
    };
    let found =
        excited_modes(&model, std::slice::from_ref(&rail), &forces, 5, 1e-7).expect("it has mass");
    let lateral = given.i_lateral.expect("a lateral stiffness");
    let unit = (given.e * lateral / 15.2).sqrt() * (std::f64::consts::PI / 60.0).powi(2);
    for (n, mode) in (1..).zip(&found.modes.modes) {
        assert!(
            (mode.omega / (f64::from(n * n) * unit) - 1.0).abs() < 2e-7,
            "{n}: {}",
            mode.omega
        );
    }
    // No force: no mode.
    let none =
        excited_modes(&model, &[rail], &ExcitingForces::default(), 5, 1e-4).expect("it has mass");
    assert!(none.modes.modes.is_empty() && none.modes.next.is_none());
}

#[test]
fn modes_asked_for_without_forces_are_all_modes() {
    let (model, rail) = girder().model_and_rail().expect("a girder on two supports");
    let cut =
        excited_modes(&model, &[rail], &ExcitingForces::vertical(), 4, 1e-5).expect("it has mass");
    let all = modes(&cut.model, &cut.rails, 12).expect("it has mass");
    let moves = largest(&all, Axis::Vertical, [0.0, 60.0]);
    assert!(
        moves.iter().filter(|&&most| most < 1e-9).count() > 4,
        "{moves:?}"
    );
}

#[test]
fn a_structure_without_mass_is_refused_whatever_the_forces() {
    let (model, rail) = Girder {
        mass_per_length: None,
        ..girder()
    }
    .model_and_rail()
    .expect("a girder");
    for forces in [ExcitingForces::vertical(), ExcitingForces::default()] {
        let refused = excited_modes(&model, std::slice::from_ref(&rail), &forces, 3, 1e-3);
        assert_eq!(refused.err(), Some(Error::NoMass));
    }
}
