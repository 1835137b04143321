//! Properties of every frame: symmetry, sign, equilibrium, invariance (analytic).

use crate::common;

use common::{mill, paper, probes};
use fea::{
    BeamTheory, CrossSection, Dof, FactoredFrame, Girder, Member, Model, Rail, RailSegment,
    RigidLink, Support, grid, point_compliance,
};
use nalgebra::{Rotation3, SymmetricEigen, Vector3};
use splines::{Axis, Probe};

fn spread(rail: &Rail) -> Vec<Probe> {
    Axis::ALL
        .iter()
        .flat_map(|&axis| probes(axis, &rail.stations))
        .collect()
}

#[test]
fn grid_is_symmetric_to_the_last_bit() {
    let (model, rail) = mill(BeamTheory::Timoshenko);
    let at = spread(&rail);
    let value = grid(&model, &[rail], &at).expect("solvable").value;
    for i in 0..at.len() {
        for j in 0..i {
            assert!(
                value[(i, j)].to_bits() == value[(j, i)].to_bits(),
                "{i} {j}"
            );
        }
    }
}

#[test]
fn grid_is_positive_semidefinite() {
    let (model, rail) = mill(BeamTheory::Timoshenko);
    let at = spread(&rail);
    let value = grid(&model, &[rail], &at).expect("solvable").value;
    let values = SymmetricEigen::new(value).eigenvalues;
    assert!(
        values.min() > -1e-14 * values.max(),
        "{} {}",
        values.min(),
        values.max()
    );
}

#[test]
fn same_input_gives_the_same_bits() {
    let (model, rail) = mill(BeamTheory::Timoshenko);
    let at = spread(&rail);
    let rails = [rail];
    let first = grid(&model, &rails, &at).expect("solvable").value;
    assert!(first == grid(&model, &rails, &at).expect("solvable").value);
}

/// Forces and moments about the origin of unit loads and their reactions must vanish.
fn imbalance(model: &Model, rail: Rail) -> f64 {
    let (origin, axis, up) = (
        Vector3::from(rail.origin),
        Vector3::from(rail.axis),
        Vector3::from(model.up),
    );
    let at = spread(&rail);
    let segments = rail.segments.clone();
    let frame = FactoredFrame::new(model, &[rail]).expect("solvable");
    let reactions = frame.reactions(model, &at).expect("solvable");
    let line = frame.line().expect("has a rail");
    let z = axis.cross(&up);
    let mut worst = 0.0_f64;
    for (j, probe) in at.iter().enumerate() {
        let cell = line.row(*probe).expect("on the rail").element;
        let member = model.members[segments[cell].member];
        let start =
            Vector3::from(model.points[member.points[0]]) + Vector3::from(member.offsets[0]);
        let offset = Vector3::from(segments[cell].offset);
        let place = start + axis * (probe.x - (start - origin).dot(&axis)) + offset;
        let mut force = [axis, up, z][probe.axis.component()];
        let mut moment = place.cross(&force);
        for (i, hold) in reactions.restraints.iter().enumerate() {
            let mut along = Vector3::zeros();
            along[hold.dof as usize % 3] = reactions.value[(i, j)];
            if hold.dof < Dof::Rx {
                force += along;
                moment += Vector3::from(model.points[hold.point]).cross(&along);
            } else {
                moment += along;
            }
        }
        worst = worst.max(force.norm()).max(moment.norm() / 300.0);
    }
    worst
}

#[test]
fn reactions_balance_the_loads() {
    let (model, rail) = paper().model_and_rail().expect("sound");
    assert!(imbalance(&model, rail) < 1e-13);
    let (model, rail) = mill(BeamTheory::Timoshenko);
    let worst = imbalance(&model, rail);
    assert!(worst < 1e-9, "{worst:.1e}");
}

#[test]
fn two_span_reactions_are_the_published_ones() {
    // Unit load at the middle of the first of two equal spans: 13/32, 11/16, -3/32 (analytic).
    let girder = Girder {
        spans: vec![60.0, 60.0],
        e: 4.32e9,
        i_vertical: 9.528,
        ..Girder::default()
    };
    let (model, rail) = girder.model_and_rail().expect("sound");
    let frame = FactoredFrame::new(&model, &[rail]).expect("solvable");
    let found = frame
        .reactions(&model, &probes(Axis::Vertical, &[30.0]))
        .expect("solvable");
    for (point, expected) in [(0, 13.0 / 32.0), (1, 11.0 / 16.0), (2, -3.0 / 32.0)] {
        let row = found
            .restraints
            .iter()
            .position(|hold| hold.point == point && hold.dof == Dof::Uy)
            .expect("supported");
        assert!((found.value[(row, 0)] + expected).abs() < 1e-14);
    }
}

#[test]
fn flipped_members_give_the_same_grid() {
    let (model, rail) = mill(BeamTheory::Timoshenko);
    let at = spread(&rail);
    let mut flipped = model.clone();
    for member in &mut flipped.members {
        member.points.swap(0, 1);
        member.offsets.swap(0, 1);
        member.releases.swap(0, 1);
    }
    let rails = [rail];
    let first = grid(&model, &rails, &at).expect("solvable").value;
    let second = grid(&flipped, &rails, &at).expect("solvable").value;
    assert!((first - &second).amax() < 1e-12 * second.amax());
}

#[test]
fn rotated_frames_give_the_same_grid() {
    // All supports fix all degrees of freedom, so that the frame can be rotated.
    let turn = Rotation3::from_euler_angles(0.4, -1.1, 2.3);
    let (mut model, rail) = mill(BeamTheory::Timoshenko);
    for support in &mut model.supports {
        support.fixed = [true; 6];
    }
    model.springs.clear();
    let at = spread(&rail);
    let first = grid(&model, std::slice::from_ref(&rail), &at)
        .expect("solvable")
        .value;
    let spin = |v: &mut [f64; 3]| *v = (turn * Vector3::from(*v)).into();
    let mut rail = rail;
    model.points.iter_mut().for_each(spin);
    for member in &mut model.members {
        spin(&mut member.orientation);
        member.offsets.iter_mut().for_each(spin);
    }
    spin(&mut model.up);
    spin(&mut rail.origin);
    spin(&mut rail.axis);
    rail.segments
        .iter_mut()
        .for_each(|segment| spin(&mut segment.offset));
    // Stations at the very ends are beyond them by rounding.
    let at: Vec<Probe> = at
        .into_iter()
        .map(|p| Probe {
            x: p.x.clamp(0.7501, 324.2499),
            ..p
        })
        .collect();
    let mut shifted = first.clone();
    rail.stations.clear();
    let second = grid(&model, &[rail.clone()], &at).expect("solvable").value;
    for k in 0..3 {
        for i in [41 * k, 41 * k + 40] {
            shifted.row_mut(i).copy_from(&second.row(i));
            shifted.column_mut(i).copy_from(&second.column(i));
        }
    }
    let error = (shifted - &second).amax() / second.amax();
    assert!(error < 1e-12, "{error:.1e}");
}

/// Cantilever along x with its tip loaded through an arm.
fn cantilever(elements: usize, theory: BeamTheory) -> Model {
    let section = CrossSection {
        e: 2e11,
        g: 8e10,
        area: 0.02,
        iy: 3e-5,
        iz: 4e-4,
        j: 2e-5,
        shear_y: Some(0.004),
        shear_z: Some(0.01),
        ..CrossSection::default()
    };
    let points = (0..=elements)
        .map(|k| [5.0 * k as f64 / elements as f64, 0.0, 0.0])
        .collect();
    let members = (0..elements)
        .map(|k| Member::beam([k, k + 1], 0, [0.0, 1.0, 0.0]))
        .collect();
    Model {
        points,
        sections: vec![section],
        members,
        supports: vec![Support {
            point: 0,
            fixed: [true; 6],
        }],
        up: [0.0, 1.0, 0.0],
        theory,
        ..Model::default()
    }
}

#[test]
fn one_element_is_exact_and_does_not_lock() {
    // Tip of a cantilever: L^3/3EI + L/GAs, L^2/2EI, L/EI, L/EA, L/GJ (analytic).
    let (l, ei) = (5.0_f64, 2e11 * 4e-4);
    for elements in [1, 2, 7] {
        let (value, _) =
            point_compliance(&cantilever(elements, BeamTheory::Timoshenko), &[elements])
                .expect("solvable");
        let close =
            |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{elements} elements: {a} {b}");
        close(value[(1, 1)], l.powi(3) / (3.0 * ei) + l / (8e10 * 0.004));
        close(value[(1, 5)], l * l / (2.0 * ei));
        close(value[(5, 5)], l / ei);
        close(
            value[(2, 2)],
            l.powi(3) / (3.0 * 2e11 * 3e-5) + l / (8e10 * 0.01),
        );
        close(value[(2, 4)], -l * l / (2.0 * 2e11 * 3e-5));
        close(value[(0, 0)], l / (2e11 * 0.02));
        close(value[(3, 3)], l / (8e10 * 2e-5));
    }
}

#[test]
fn links_and_offsets_are_exact_rigid_arms() {
    // Tip compliance moved along an arm r: u' = u + theta x r (analytic); by link and by member offset.
    let r = Vector3::new(0.3, -0.7, 1.1);
    let plain = cantilever(1, BeamTheory::Timoshenko);
    let (tip, _) = point_compliance(&plain, &[1]).expect("solvable");
    let mut arm = nalgebra::Matrix6::identity();
    arm.fixed_view_mut::<3, 3>(0, 3)
        .copy_from(&-r.cross_matrix());
    let exact = arm * tip.fixed_view::<6, 6>(0, 0) * arm.transpose();

    let mut linked = plain.clone();
    linked.points.push([5.3, -0.7, 1.1]);
    linked.links.push(RigidLink { from: 1, to: 2 });
    let (found, _) = point_compliance(&linked, &[2]).expect("solvable");
    assert!((found - exact).amax() < 1e-14 * exact.amax());

    let mut offset = plain;
    offset.points[1] = [5.3, -0.7, 1.1];
    offset.members[0].offsets[1] = [-0.3, 0.7, -1.1];
    let (found, _) = point_compliance(&offset, &[1]).expect("solvable");
    assert!((found - exact).amax() < 1e-13 * exact.amax());
}

#[test]
fn supports_on_linked_points_hold_the_body() {
    // Two supported points 2 apart on a rigid body: the displacement along the line between them is fixed twice,
    // and the body can only rotate about this line, like a single point with one free rotation (analytic).
    let mut linked = cantilever(1, BeamTheory::Timoshenko);
    linked.points.extend([[5.0, 0.0, 1.0], [5.0, 0.0, -1.0]]);
    linked.links = vec![RigidLink { from: 2, to: 1 }, RigidLink { from: 3, to: 2 }];
    let pinned = [true, true, true, false, false, false];
    linked.supports.extend([2, 3].map(|point| Support {
        point,
        fixed: pinned,
    }));
    let (found, _) = point_compliance(&linked, &[1]).expect("solvable");
    let mut plain = cantilever(1, BeamTheory::Timoshenko);
    plain.supports.push(Support {
        point: 1,
        fixed: [true, true, true, true, true, false],
    });
    let (exact, _) = point_compliance(&plain, &[1]).expect("solvable");
    assert!(exact[(5, 5)] > 0.0);
    assert!((found - &exact).amax() < 1e-14 * exact.amax());
}

#[test]
fn hinged_girder_acts_as_two_simple_spans() {
    // A hinge over the middle support: each span is simply supported, l^3/48EI and no coupling (analytic).
    let girder = Girder {
        spans: vec![60.0, 60.0],
        e: 4.32e9,
        i_vertical: 9.528,
        ..Girder::default()
    };
    let (mut model, rail) = girder.model_and_rail().expect("sound");
    model.members[1].releases[0][Dof::Rz as usize] = true;
    let at = probes(Axis::Vertical, &[15.0, 30.0, 90.0]);
    let value = grid(&model, &[rail], &at).expect("solvable").value;
    let unit = 60.0_f64.powi(3) / (4.32e9 * 9.528);
    assert!((value[(1, 1)] / unit - 1.0 / 48.0).abs() < 1e-15);
    assert!((value[(2, 2)] / unit - 1.0 / 48.0).abs() < 1e-15);
    assert!((value[(0, 1)] / unit - 11.0 / 768.0).abs() < 1e-15);
    assert!((value[(1, 2)] / unit).abs() < 1e-16);
}

#[test]
fn rail_on_a_girder_held_at_both_ends_is_its_clamped_form() {
    // There are no unknowns: l^3/192EI at midspan (analytic).
    let mut model = cantilever(1, BeamTheory::EulerBernoulli);
    model.supports.push(Support {
        point: 1,
        fixed: [true; 6],
    });
    let segments = vec![RailSegment {
        member: 0,
        offset: [0.0; 3],
    }];
    let rail = Rail {
        axis: [2.0, 0.0, 0.0],
        segments,
        ..Rail::default()
    };
    let frame = FactoredFrame::new(&model, &[rail]).expect("solvable");
    let value = frame
        .grid(&probes(Axis::Vertical, &[2.5]))
        .expect("solvable")
        .value[(0, 0)];
    assert!((value / (125.0 / (192.0 * 2e11 * 4e-4)) - 1.0).abs() < 1e-14);
    assert!(frame.unknowns() == 0);
}
