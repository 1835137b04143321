//! Results do not depend on the direction of the global axes, where rotations of points are stiffened by nothing.

use fea::{
    BeamTheory, CrossSection, Dof, Error, FactoredFrame, Member, Model, Support, modes,
    point_compliance,
};
use nalgebra::{Matrix3, Rotation3, Vector3};

/// A beam of two members of 5 m along x without torsional stiffness, clamped at both ends, and its section.
fn without_torsion() -> Model {
    let section = CrossSection {
        e: 2.1e11,
        g: 8.1e10,
        area: 0.01,
        iy: 2e-4,
        iz: 1e-4,
        mass: 78.5,
        ..CrossSection::default()
    };
    Model {
        points: [0.0, 5.0, 10.0].map(|x| [x, 0.0, 0.0]).to_vec(),
        sections: vec![section],
        members: [[0, 1], [1, 2]]
            .map(|points| Member::beam(points, 0, [0.0, 0.0, 1.0]))
            .to_vec(),
        supports: [0, 2]
            .map(|point| Support {
                point,
                fixed: [true; 6],
            })
            .to_vec(),
        up: [0.0, 0.0, 1.0],
        theory: BeamTheory::EulerBernoulli,
        ..Model::default()
    }
}

/// The model turned about the origin, then moved by `shift` along each axis.
fn turned(model: &Model, turn: &Rotation3<f64>, shift: f64) -> Model {
    let mut out = model.clone();
    for point in &mut out.points {
        *point = (turn * Vector3::from(*point)).add_scalar(shift).into();
    }
    for member in &mut out.members {
        member.orientation = (turn * Vector3::from(member.orientation)).into();
    }
    out
}

/// Turns by 45 degrees about z, and about all axes.
fn turns() -> [Rotation3<f64>; 3] {
    let quarter = std::f64::consts::FRAC_PI_4;
    [
        Rotation3::from_axis_angle(&Vector3::z_axis(), quarter),
        Rotation3::from_axis_angle(&Vector3::z_axis(), 0.3),
        Rotation3::from_euler_angles(0.4, -0.9, 1.7),
    ]
}

/// Displacements of point 1 per unit force on it, in the axes of the model that was turned.
fn displacements(model: &Model, turn: &Rotation3<f64>) -> Matrix3<f64> {
    let (found, _) = point_compliance(model, &[1]).expect("solvable");
    turn.inverse() * Matrix3::from_fn(|i, j| found[(i, j)]) * turn
}

fn assert_same(model: &Model, tolerance: f64) {
    let expected = displacements(model, &Rotation3::identity());
    let frequencies = |model: &Model| -> Vec<f64> {
        let found = modes(model, &[], 3).expect("solvable");
        found.modes.iter().map(|mode| mode.omega).collect()
    };
    for turn in turns() {
        for shift in [0.0, 3e3] {
            let model_turned = turned(model, &turn, shift);
            let found = displacements(&model_turned, &turn);
            let error = (found - expected).amax() / expected.amax();
            assert!(error < tolerance, "{turn} {shift}: {error:e}");
            for (a, b) in frequencies(model).iter().zip(frequencies(&model_turned)) {
                assert!((a / b - 1.0).abs() < tolerance, "{turn} {shift}: {a} {b}");
            }
        }
    }
}

#[test]
fn beams_without_torsional_stiffness_have_the_same_compliance_and_modes_in_every_direction() {
    let model = without_torsion();
    assert_same(&model, 1e-9);
    let exact = 10f64.powi(3) / (192.0 * 2.1e11 * 1e-4);
    let found = displacements(&model, &Rotation3::identity());
    assert!((found[(2, 2)] / exact - 1.0).abs() < 1e-12);
}

#[test]
fn loads_on_a_free_rotation_about_a_skew_axis_are_refused_and_others_are_not() {
    let turn = turns()[0];
    let (found, _) =
        point_compliance(&turned(&without_torsion(), &turn, 0.0), &[1]).expect("solvable");
    let infinite: Vec<bool> = (0..6).map(|k| found[(k, k)].is_infinite()).collect();
    assert_eq!(infinite, [false, false, false, true, true, false]);
}

#[test]
fn hinges_of_all_members_at_a_point_about_one_skew_axis_leave_its_rotation_out() {
    let mut model = without_torsion();
    model.sections[0].j = 3e-4;
    model.members[0].releases[1][Dof::Rz as usize] = true;
    model.members[1].releases[0][Dof::Rz as usize] = true;
    assert_same(&model, 1e-9);
}

#[test]
fn a_weak_torsional_stiffness_about_a_skew_axis_is_kept() {
    let mut model = without_torsion();
    model.sections[0].j = 1e-16;
    let turn = turns()[2];
    let (found, _) = point_compliance(&turned(&model, &turn, 0.0), &[1]).expect("solvable");
    let twist = turn.inverse() * Matrix3::from_fn(|i, j| found[(3 + i, 3 + j)]) * turn;
    let exact = 2.5 / (8.1e10 * 1e-16);
    assert!(
        (twist[(0, 0)] / exact - 1.0).abs() < 1e-6,
        "{} {exact}",
        twist[(0, 0)]
    );
}

#[test]
fn a_skew_structure_that_turns_as_a_whole_is_a_mechanism() {
    let mut model = without_torsion();
    model.sections[0].j = 3e-4;
    let mut model = turned(&model, &turns()[2], 0.0);
    for support in &mut model.supports {
        support.fixed = [true, true, true, false, false, false];
    }
    let refused = FactoredFrame::new(&model, &[]).err();
    assert!(
        matches!(
            refused,
            Some(Error::Mechanism {
                dof: Dof::Rx | Dof::Ry | Dof::Rz,
                ..
            })
        ),
        "{refused:?}"
    );
}
