//! Rods resist elongation and twist, and have no bending of their own.

use fea::{
    BeamTheory, CrossSection, Dof, GroundSpring, Member, MemberKind, Model, PointMass, Support,
    modes, point_compliance, refined_modes,
};

const STEEL: CrossSection = CrossSection {
    e: 2.1e11,
    g: 8e10,
    area: 0.001,
    iy: 0.0,
    iz: 0.0,
    j: 1e-7,
    shear_y: None,
    shear_z: None,
    mass: 7.85,
};

fn member(kind: MemberKind, points: [usize; 2]) -> Member {
    Member {
        kind,
        ..Member::beam(points, 0, [0.0; 3])
    }
}

#[test]
fn a_rod_elongates_by_l_over_ea_and_twists_by_l_over_gj() {
    let model = Model {
        points: vec![[0.0; 3], [0.0, 3.0, 0.0]],
        sections: vec![CrossSection {
            iy: 1.0,
            iz: 1.0,
            ..STEEL
        }],
        members: vec![member(MemberKind::Rod, [0, 1])],
        supports: vec![Support {
            point: 0,
            fixed: [true; 6],
        }],
        ..Model::default()
    };
    let (found, _) = point_compliance(&model, &[1]).expect("solvable");
    assert!((found[(1, 1)] / (3.0 / (2.1e11 * 0.001)) - 1.0).abs() < 1e-14);
    assert!((found[(4, 4)] / (3.0 / (8e10 * 1e-7)) - 1.0).abs() < 1e-14);
    for k in [0, 2, 3, 5] {
        assert!(found[(k, k)].is_infinite(), "degree of freedom {k}");
    }
}

/// A mass on three members of one kind from its place to the ground.
fn tripod(kind: MemberKind) -> Model {
    Model {
        points: vec![[0.0; 3], [0.0, 0.0, 3.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]],
        sections: vec![STEEL],
        members: [[0, 1], [2, 1], [3, 1]]
            .map(|points| member(kind, points))
            .to_vec(),
        supports: [0, 2, 3]
            .map(|point| Support {
                point,
                fixed: [true; 6],
            })
            .to_vec(),
        masses: vec![PointMass {
            point: 1,
            mass: 1000.0,
            inertia: [0.0; 3],
            offset: [0.0; 3],
        }],
        up: [0.0, 0.0, 1.0],
        ..Model::default()
    }
}

#[test]
fn rods_with_torsional_stiffness_have_the_frequencies_of_trusses() {
    let [rods, trusses] = [MemberKind::Rod, MemberKind::Truss].map(|kind| {
        let mut model = tripod(kind);
        model.supports.push(Support {
            point: 1,
            fixed: [false, false, false, true, true, true],
        });
        refined_modes(&model, &[], 3, 1e-3).expect("solvable")
    });
    assert_eq!(rods.parts, [1; 3]);
    for (a, b) in rods.modes.modes.iter().zip(&trusses.modes.modes) {
        assert!(
            (a.omega / b.omega - 1.0).abs() < 1e-12,
            "{} {}",
            a.omega,
            b.omega
        );
    }
}

#[test]
fn a_massless_rod_acts_as_one_spring_along_it_and_one_about_it() {
    let girder = CrossSection {
        area: 0.02,
        iy: 1e-4,
        iz: 4e-4,
        j: 1e-5,
        mass: 157.0,
        ..STEEL
    };
    let rod = CrossSection {
        mass: 0.0,
        j: 2e-5,
        ..STEEL
    };
    let beam = |points| Member::beam(points, 0, [0.0, 0.0, 1.0]);
    let mut sprung = Model {
        points: vec![[0.0; 3], [6.0, 0.0, 0.0], [12.0, 0.0, 0.0], [6.0, 0.0, 6.0]],
        sections: vec![girder, rod],
        members: vec![beam([0, 1]), beam([1, 2])],
        supports: vec![
            Support {
                point: 0,
                fixed: [true; 6],
            },
            Support {
                point: 2,
                fixed: [false, true, true, true, true, true],
            },
            Support {
                point: 3,
                fixed: [true; 6],
            },
        ],
        up: [0.0, 0.0, 1.0],
        theory: BeamTheory::Timoshenko,
        ..Model::default()
    };
    let mut hung = sprung.clone();
    hung.members.push(Member {
        section: 1,
        ..member(MemberKind::Rod, [1, 3])
    });
    for (dof, stiffness) in [
        (Dof::Uz, 2.1e11 * 0.001 / 6.0),
        (Dof::Rz, 8e10 * 2e-5 / 6.0),
    ] {
        sprung.springs.push(GroundSpring {
            point: 1,
            dof,
            stiffness,
        });
    }
    let [hung, sprung] = [hung, sprung].map(|model| modes(&model, &[], 6).expect("solvable").modes);
    for (a, b) in hung.iter().zip(&sprung) {
        assert!(
            (a.omega / b.omega - 1.0).abs() < 1e-10,
            "{} {}",
            a.omega,
            b.omega
        );
    }
}
