//! Several rails on one member, against nodes and rigid offsets at the loads (analytic).

use crate::common;

use common::with_nodes;
use fea::{
    Effect, FactoredFrame, ForceComponent, Model, Rail, RailSegment, Support, point_compliance,
};
use nalgebra::{Matrix3, Vector3};
use splines::{Axis, Compliance, Influence, Probe};

/// Two inclined members with rigid offsets, hinges and shear; both ends clamped.
fn model() -> Model {
    let (mut model, _) = common::two_spans().model_and_rail().expect("sound");
    model.points = vec![[0.0, 0.0, 0.0], [18.0, 5.0, 3.0], [40.0, 1.0, -2.0]];
    model.supports = [0, 2]
        .map(|point| Support {
            point,
            fixed: [true; 6],
        })
        .to_vec();
    model.members[0].releases[1] = [true, false, false, false, true, true];
    model.members[0].offsets = [[0.3, 0.2, 0.1], [-0.4, 0.5, 0.0]];
    model
}

/// Three rails: above the members; below them, with the opposite direction; beside them, in another direction.
fn rails() -> [Rail; 3] {
    let rail = |origin, axis, offset| Rail {
        origin,
        axis,
        segments: [0, 1].map(|member| RailSegment { member, offset }).to_vec(),
        stations: Vec::new(),
    };
    [
        rail([0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.7, 0.3]),
        rail([45.0, 2.0, 0.0], [-2.0, 0.0, 0.0], [0.1, -0.6, 0.2]),
        rail([1.0, 0.0, 0.0], [1.0, 0.1, 0.3], [0.0, 0.1, -0.9]),
    ]
}

fn frame(model: &Model, rail: &Rail) -> Matrix3<f64> {
    let x = Vector3::from(rail.axis).normalize();
    let up = Vector3::from(model.up);
    let y = (up - x * x.dot(&up)).normalize();
    Matrix3::from_rows(&[x.transpose(), y.transpose(), x.cross(&y).transpose()])
}

/// Places (rail, member, fraction of the member), some of them on one section.
const PLACES: [(usize, usize, f64); 8] = [
    (0, 0, 0.3),
    (1, 0, 0.3),
    (2, 0, 0.55),
    (0, 0, 0.8),
    (1, 0, 0.65),
    (2, 1, 0.45),
    (1, 1, 0.2),
    (0, 1, 0.7),
];

/// The probes of all places and directions, and the same by nodes.
fn probes(model: &Model, rails: &[Rail]) -> (Vec<Probe>, nalgebra::DMatrix<f64>) {
    let mut at = Vec::new();
    let mut nodes = Vec::new();
    for (rail, member, fraction) in PLACES {
        let given = &model.members[member];
        let end = |k: usize| {
            Vector3::from(model.points[given.points[k]]) + Vector3::from(given.offsets[k])
        };
        let place = end(0) + (end(1) - end(0)) * fraction - Vector3::from(rails[rail].origin);
        let x = (frame(model, &rails[rail]) * place)[0];
        at.extend(Axis::ALL.map(|axis| Probe { rail, x, axis }));
        nodes.push((member, fraction, rails[rail].segments[member].offset));
    }
    let (cut, nodes) = with_nodes(model, &nodes);
    let (value, _) = point_compliance(&cut, &nodes).expect("solvable");
    let exact = nalgebra::DMatrix::from_fn(at.len(), at.len(), |i, j| {
        let (a, b) = (
            frame(model, &rails[at[i].rail]),
            frame(model, &rails[at[j].rail]),
        );
        let block = value.fixed_view::<3, 3>(6 * (i / 3), 6 * (j / 3));
        (a.row(i % 3) * block * b.row(j % 3).transpose())[0]
    });
    (at, exact)
}

#[test]
fn rails_on_one_member_equal_nodes_and_arms_at_the_loads() {
    let (model, rails) = (model(), rails());
    let (at, exact) = probes(&model, &rails);
    let solved = FactoredFrame::new(&model, &rails).expect("solvable");
    let grid = solved.grid(&at).expect("on the rails").value;
    let mut surface = Influence::zeros(at.len());
    solved
        .surface()
        .expect("has rails")
        .surface
        .fill(&at, &mut surface)
        .expect("on the rails");
    for i in 0..at.len() {
        for j in 0..at.len() {
            let scale = (exact[(i, i)] * exact[(j, j)]).sqrt();
            for found in [grid[(i, j)], surface.value[(i, j)]] {
                let error = (found - exact[(i, j)]).abs() / scale;
                assert!(
                    error < 1e-11,
                    "{:?} {:?}: {found} {}",
                    at[i],
                    at[j],
                    exact[(i, j)]
                );
            }
        }
    }
}

#[test]
fn influence_of_paired_rails_is_symmetric_to_the_last_bit_and_positive() {
    let (model, rails) = (model(), rails());
    let (at, _) = probes(&model, &rails);
    let solved = FactoredFrame::new(&model, &rails).expect("solvable");
    let grid = solved.grid(&at).expect("on the rails").value;
    let mut surface = Influence::zeros(at.len());
    solved
        .surface()
        .expect("has rails")
        .surface
        .fill(&at, &mut surface)
        .expect("on the rails");
    for value in [grid, surface.value] {
        assert!(value == value.transpose());
        let unit = nalgebra::DMatrix::from_fn(at.len(), at.len(), |i, j| {
            value[(i, j)] / (value[(i, i)] * value[(j, j)]).sqrt()
        });
        let least = unit.symmetric_eigenvalues().min();
        assert!(least > -1e-13, "{least:e}");
    }
}

#[test]
fn slopes_between_paired_rails_are_difference_quotients() {
    let (model, rails) = (model(), rails());
    let (at, _) = probes(&model, &rails);
    let surface = FactoredFrame::new(&model, &rails)
        .expect("solvable")
        .surface()
        .expect("has rails")
        .surface;
    let mut out = Influence::zeros(at.len());
    surface.fill(&at, &mut out).expect("on the rails");
    let mut pair = Influence::zeros(2);
    let mut value = |p: Probe, q: Probe| {
        surface.fill(&[p, q], &mut pair).expect("on the rails");
        pair.value[(0, 1)]
    };
    let step = 1e-4;
    for (i, &p) in at.iter().enumerate() {
        // Under the load itself slopes may jump.
        let apart =
            |j: usize| PLACES[i / 3].1 != PLACES[j / 3].1 || PLACES[i / 3].2 != PLACES[j / 3].2;
        for (j, &q) in at
            .iter()
            .enumerate()
            .filter(|&(j, q)| q.rail != p.rail && apart(j))
        {
            let moved = |by: f64| Probe { x: p.x + by, ..p };
            let quotient = (value(moved(step), q) - value(moved(-step), q)) / (2.0 * step);
            let scale = (out.value[(i, i)] * out.value[(j, j)]).sqrt();
            let error = (out.slope[(i, j)] - quotient).abs() / scale;
            assert!(
                error < 2e-6,
                "{p:?} {q:?}: {} {quotient}",
                out.slope[(i, j)]
            );
        }
    }
}

#[test]
fn forces_under_loads_on_paired_rails_equal_those_with_nodes_there() {
    let (model, rails) = (model(), rails());
    let (at, _) = probes(&model, &rails);
    // Member 0 in four parts, member 1 in four: cut at the places of all loads.
    let cuts = [vec![0.3, 0.55, 0.65, 0.8], vec![0.2, 0.45, 0.7]];
    let places: Vec<_> = PLACES
        .iter()
        .map(|&(_, member, s)| (member, s, [0.0; 3]))
        .collect();
    let (cut, _) = with_nodes(&model, &places);
    let first = [0, cuts[0].len() + 1];
    let pieces = rails.clone().map(|rail| {
        let over = |segment: &RailSegment| {
            let start = first[segment.member];
            let segment = *segment;
            (start..=start + cuts[segment.member].len())
                .map(move |member| RailSegment { member, ..segment })
        };
        Rail {
            segments: rail.segments.iter().flat_map(over).collect(),
            ..rail
        }
    });
    let sections = [
        (0, 0.0),
        (0, 0.1),
        (0, 0.6),
        (0, 0.9),
        (0, 1.0),
        (1, 0.3),
        (1, 0.6),
        (1, 1.0),
    ];
    let moved = sections.map(|(member, s)| {
        let bounds = [vec![0.0], cuts[member].clone(), vec![1.0]].concat();
        let k = (1..bounds.len())
            .find(|&k| s <= bounds[k])
            .expect("s is at most 1")
            - 1;
        (
            first[member] + k,
            (s - bounds[k]) / (bounds[k + 1] - bounds[k]),
        )
    });
    let all = |sections: [(usize, f64); 8]| -> Vec<Effect> {
        let one = |(member, place)| {
            ForceComponent::ALL.map(|component| Effect::InternalForce {
                member,
                place,
                component,
            })
        };
        sections.into_iter().flat_map(one).collect()
    };
    let whole = FactoredFrame::new(&model, &rails).expect("solvable");
    let parts = FactoredFrame::new(&cut, &pieces).expect("solvable");
    // With one solve for each load, and with one solve for each effect.
    for count in [3, at.len()] {
        let effects = all(sections);
        let step = if count == at.len() { 2 } else { 1 };
        let (own, other): (Vec<Effect>, Vec<Effect>) = effects
            .iter()
            .copied()
            .zip(all(moved))
            .step_by(step)
            .unzip();
        let found = whole
            .effects(&model, &own, &at[..count])
            .expect("on the rails");
        let exact = parts
            .effects(&cut, &other, &at[..count])
            .expect("on the rails");
        for i in 0..found.nrows() {
            for j in 0..found.ncols() {
                let error = (found[(i, j)] - exact[(i, j)]).abs();
                assert!(
                    error < 1e-9,
                    "{:?} {:?}: {} {}",
                    own[i],
                    at[j],
                    found[(i, j)],
                    exact[(i, j)]
                );
            }
        }
    }
}
