//! How rails follow the members that carry them (analytic, and against nodes at the loads).

use crate::common;

use common::{mill, paper, probes, with_nodes};
use fea::{BeamTheory, FactoredFrame, Rail, Support, grid, point_compliance};
use nalgebra::{Matrix6, SMatrix, Vector3};
use splines::{Axis, Probe};

/// Displacement of a place rigidly attached to a point at r, by the six degrees of freedom of the point.
fn arm(r: Vector3<f64>) -> Matrix6<f64> {
    let mut a = Matrix6::identity();
    a.fixed_view_mut::<3, 3>(0, 3).copy_from(&-r.cross_matrix());
    a
}

#[test]
fn rail_in_a_gap_moves_rigidly_with_the_column() {
    // Over the columns at 40 (continuous) and 170 (hinged on its right); rail heights differ left and right.
    let (model, rail) = mill(BeamTheory::Timoshenko);
    for (x, point, member, segment) in [
        (39.6, 9, 28, 0),
        (40.3, 9, 29, 1),
        (169.6, 21, 30, 2),
        (170.3, 21, 31, 3),
    ] {
        let at: Vec<Probe> = Axis::ALL
            .iter()
            .flat_map(|&axis| probes(axis, &[x]))
            .collect();
        let found = grid(&model, std::slice::from_ref(&rail), &at)
            .expect("solvable")
            .value;
        let given = &model.members[member];
        let end = usize::from(given.points[1] == point);
        let place = Vector3::from(model.points[point]);
        let tip = Vector3::from(given.offsets[end]) + Vector3::from(rail.segments[segment].offset);
        let r = Vector3::new(x - place.x, tip.y, tip.z);
        let (own, _) = point_compliance(&model, &[point]).expect("solvable");
        let moved = arm(r) * own.fixed_view::<6, 6>(0, 0) * arm(r).transpose();
        let exact = moved.fixed_view::<3, 3>(0, 0);
        assert!((found - exact).amax() < 1e-12 * exact.amax(), "x = {x}");
    }
}

#[test]
fn two_rails_of_one_structure_are_coupled_through_it() {
    // One rail given as two, the second with an origin of its own.
    let (model, rail) = mill(BeamTheory::Timoshenko);
    let part = |segments: &[usize], origin: [f64; 3]| Rail {
        origin,
        segments: segments.iter().map(|&k| rail.segments[k]).collect(),
        stations: Vec::new(),
        ..rail.clone()
    };
    let rails = [
        part(&[0, 1, 2], [0.0; 3]),
        part(&[3, 4, 5], [100.0, 0.0, 0.0]),
    ];
    let split = |p: &Probe| {
        if p.x < 170.0 {
            *p
        } else {
            Probe {
                rail: 1,
                x: p.x - 100.0,
                ..*p
            }
        }
    };
    let whole: Vec<Probe> = Axis::ALL
        .iter()
        .flat_map(|&axis| probes(axis, &[20.0, 150.0, 200.0, 300.0]))
        .collect();
    let parts: Vec<Probe> = whole.iter().map(split).collect();
    let one = grid(&model, std::slice::from_ref(&rail), &whole)
        .expect("solvable")
        .value;
    let two = grid(&model, &rails, &parts).expect("solvable").value;
    assert!((&one - two).amax() < 1e-13 * one.amax());
}

#[test]
fn loads_inside_members_equal_loads_on_inserted_nodes() {
    // An inclined, offset, hinged two-member frame whose loads are applied once inside, once at nodes.
    let (mut model, mut rail) = common::two_spans().model_and_rail().expect("sound");
    model.points = vec![[0.0, 0.0, 0.0], [18.0, 5.0, 3.0], [40.0, 1.0, -2.0]];
    model.supports = [0, 2]
        .map(|point| Support {
            point,
            fixed: [true; 6],
        })
        .to_vec();
    model.members[0].releases[1] = [true, false, false, false, true, true];
    model.members[0].offsets = [[0.3, 0.2, 0.1], [-0.4, 0.5, 0.0]];
    let offset = Vector3::new(0.0, 0.7, 0.3);
    rail.segments
        .iter_mut()
        .for_each(|segment| segment.offset = offset.into());
    let x = [7.0, 13.0, 25.0];
    let at: Vec<Probe> = Axis::ALL
        .iter()
        .flat_map(|&axis| probes(axis, &x))
        .collect();
    let found = grid(&model, &[rail], &at).expect("solvable").value;

    // The same with nodes at the loads.
    let places = x.map(|x| {
        let ends = |k: usize, axis: usize| {
            let member = &model.members[usize::from(x > 18.0)];
            model.points[member.points[k]][axis] + member.offsets[k][axis]
        };
        (
            usize::from(x > 18.0),
            (x - ends(0, 0)) / (ends(1, 0) - ends(0, 0)),
            offset.into(),
        )
    });
    let (cut, places) = with_nodes(&model, &places);
    let (exact, _) = point_compliance(&cut, &places).expect("solvable");
    for i in 0..9 {
        for j in 0..9 {
            let entry = exact[(6 * (i % 3) + i / 3, 6 * (j % 3) + j / 3)];
            let scale = (found[(i, i)] * found[(j, j)]).sqrt();
            assert!(
                (found[(i, j)] - entry).abs() < 1e-11 * scale,
                "({i}, {j}): {} {entry}",
                found[(i, j)]
            );
        }
    }
}

#[test]
fn reading_a_rail_backwards_turns_two_axes() {
    // Along the opposite direction, longitudinal and lateral change sign, vertical does not.
    let (model, rail) = mill(BeamTheory::Timoshenko);
    let back = Rail {
        axis: [-3.0, 0.0, 0.0],
        origin: [325.0, 0.0, 0.0],
        stations: Vec::new(),
        ..rail.clone()
    };
    let x = [3.0, 40.2, 150.0, 171.0];
    let ahead: Vec<Probe> = Axis::ALL
        .iter()
        .flat_map(|&axis| probes(axis, &x))
        .collect();
    let behind: Vec<Probe> = ahead
        .iter()
        .map(|p| Probe {
            x: 325.0 - p.x,
            ..*p
        })
        .collect();
    let first = grid(&model, &[rail], &ahead).expect("solvable").value;
    let second = grid(&model, &[back], &behind).expect("solvable").value;
    let sign = |i: usize| if (4..8).contains(&i) { 1.0 } else { -1.0 };
    let turned = SMatrix::<f64, 12, 12>::from_fn(|i, j| sign(i) * sign(j) * second[(i, j)]);
    assert!((&first - turned).amax() < 1e-12 * first.amax());
}

#[test]
fn one_frame_answers_like_the_free_functions() {
    let (model, rail) = paper().model_and_rail().expect("sound");
    let rails = [rail];
    let at = probes(Axis::Lateral, &rails[0].stations);
    let frame = FactoredFrame::new(&model, &rails).expect("solvable");
    let once = grid(&model, &rails, &at).expect("solvable");
    assert!(frame.grid(&at).expect("solvable").value == once.value);
    assert_eq!(frame.certificate().condition, once.certificate.condition);
}
