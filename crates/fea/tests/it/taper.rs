//! Tapered members by uniform parts, against closed forms (analytic).

use crate::common;

use common::{paper, probes};
use fea::{
    BeamTheory, CrossSection, Effect, FactoredFrame, ForceComponent, Member, MemberKind, Model,
    Rail, RailSegment, Support, Taper, grid, point_compliance,
};
use splines::Axis;

const LENGTH: f64 = 12.0;
const RATIO: f64 = 0.3;

/// A cantilever along x, in `parts`, all of whose stiffnesses fall linearly to `RATIO` of their value at the tip.
fn cantilever(parts: usize, theory: BeamTheory) -> (Model, Rail) {
    let root = CrossSection {
        e: 2e8,
        g: 8e7,
        area: 0.02,
        iy: 3e-5,
        iz: 4e-4,
        j: 2e-5,
        shear_y: Some(0.008),
        shear_z: None,
        mass: 0.3,
    };
    let tip = CrossSection {
        area: RATIO * root.area,
        iy: RATIO * root.iy,
        iz: RATIO * root.iz,
        j: RATIO * root.j,
        shear_y: root.shear_y.map(|area| RATIO * area),
        mass: RATIO * root.mass,
        ..root
    };
    let member = Member {
        points: [0, 1],
        kind: MemberKind::Beam,
        section: 0,
        orientation: [0.0, 1.0, 0.0],
        offsets: [[0.0; 3], [-0.5, 0.0, 0.0]],
        releases: [[false; 6]; 2],
        tension: 0.0,
    };
    let model = Model {
        points: vec![[0.0; 3], [LENGTH + 0.5, 0.0, 0.0]],
        sections: vec![root, tip],
        members: vec![member],
        supports: vec![Support {
            point: 0,
            fixed: [true; 6],
        }],
        up: [0.0, 1.0, 0.0],
        theory,
        ..Model::default()
    };
    let (model, ranges) = model.tapered(&[Some(Taper { section: 1, parts })]);
    let segments = ranges[0]
        .clone()
        .map(|member| RailSegment {
            member,
            offset: [0.0; 3],
        })
        .collect();
    (
        model,
        Rail {
            origin: [0.0; 3],
            axis: [1.0, 0.0, 0.0],
            segments,
            stations: Vec::new(),
        },
    )
}

/// Integral of (L - x)^2/(1 - (1 - r) x/L) over the length, divided by L^3: u = 1 - (1 - r) t gives
/// ((u - r)/(1 - r))^2/u, a polynomial and a logarithm.
fn bending() -> f64 {
    let r = RATIO;
    (0.5 * (1.0 - r * r) - 2.0 * r * (1.0 - r) - r * r * r.ln()) / (1.0 - r).powi(3)
}

fn tip(parts: usize, theory: BeamTheory, axis: Axis) -> f64 {
    let (model, rail) = cantilever(parts, theory);
    grid(&model, &[rail], &probes(axis, &[LENGTH]))
        .expect("solvable")
        .value[(0, 0)]
}

#[test]
fn tapered_cantilever_converges_with_order_two() {
    for (theory, shear) in [
        (BeamTheory::EulerBernoulli, 0.0),
        (BeamTheory::Timoshenko, 1.0),
    ] {
        let root = cantilever(1, theory).0.sections[0];
        let mean = -RATIO.ln() / (1.0 - RATIO);
        let exact = LENGTH.powi(3) / (root.e * root.iz) * bending()
            + shear * LENGTH * mean / (root.g * 0.008);
        let error = |parts: usize| (tip(parts, theory, Axis::Vertical) / exact - 1.0).abs();
        let errors: Vec<f64> = [1, 2, 4, 8, 16, 32, 64].map(error).to_vec();
        let orders: Vec<f64> = errors
            .windows(2)
            .map(|pair| (pair[0] / pair[1]).log2())
            .collect();
        println!("{theory:?}: errors {errors:?}, orders {orders:.2?}");
        assert!((orders[5] - 2.0).abs() < 0.05, "{orders:?}");
        assert!(errors[3] < 5e-3 && errors[6] < 1e-4, "{errors:?}");
    }
}

#[test]
fn axial_give_and_twist_of_a_taper_are_exact_in_any_number_of_parts() {
    let mean = -RATIO.ln() / (1.0 - RATIO);
    for parts in [1, 3, 7] {
        let (model, _) = cantilever(parts, BeamTheory::Timoshenko);
        let root = model.sections[0];
        let (found, _) = point_compliance(&model, &[1]).expect("solvable");
        let axial = LENGTH * mean / (root.e * root.area);
        let twist = LENGTH * mean / (root.g * root.j);
        assert!((found[(0, 0)] / axial - 1.0).abs() < 1e-13, "{parts}");
        assert!((found[(3, 3)] / twist - 1.0).abs() < 1e-13, "{parts}");
    }
}

#[test]
fn tapered_truss_stays_one_bar_of_the_same_give() {
    let (mut model, _) = cantilever(1, BeamTheory::Timoshenko);
    model.sections.truncate(2);
    model.members = vec![Member {
        kind: MemberKind::Truss,
        section: 0,
        offsets: [[0.0; 3]; 2],
        ..model.members[0]
    }];
    model.supports.push(Support {
        point: 1,
        fixed: [false, true, true, true, true, true],
    });
    let (model, ranges) = model.tapered(&[Some(Taper {
        section: 1,
        parts: 5,
    })]);
    assert_eq!((ranges[0].clone(), model.members.len()), (0..1, 1));
    let (found, _) = point_compliance(&model, &[1]).expect("solvable");
    let exact = (LENGTH + 0.5) * -RATIO.ln() / (1.0 - RATIO) / (2e8 * 0.02);
    assert!((found[(0, 0)] / exact - 1.0).abs() < 1e-13);
}

#[test]
fn parts_of_a_uniform_member_change_nothing() {
    let (model, rail) = paper().model_and_rail().expect("sound");
    let tapers: Vec<Option<Taper>> = [1, 4, 2]
        .map(|parts| Some(Taper { section: 0, parts }))
        .to_vec();
    let (parted, ranges) = model.tapered(&tapers);
    assert_eq!((parted.members.len(), parted.sections.len()), (7, 1));
    let segments = rail
        .segments
        .iter()
        .flat_map(|segment| {
            ranges[segment.member]
                .clone()
                .map(|member| RailSegment { member, ..*segment })
        })
        .collect();
    let parted_rail = Rail {
        segments,
        ..rail.clone()
    };
    let at: Vec<_> = Axis::ALL
        .iter()
        .flat_map(|&axis| probes(axis, &[-11.0, 7.0, 30.0, 52.0, 75.0]))
        .collect();
    let one = grid(&model, &[rail], &at).expect("solvable").value;
    let two = grid(&parted, &[parted_rail], &at).expect("solvable").value;
    assert!((&one - &two).amax() < 1e-12 * one.amax());
}

#[test]
fn forces_of_a_statically_determined_taper_do_not_depend_on_it() {
    // The moment at the root, and inside the third part, is force times distance.
    let (model, rail) = cantilever(4, BeamTheory::Timoshenko);
    let frame = FactoredFrame::new(&model, &[rail]).expect("solvable");
    let moment = |member, place| Effect::InternalForce {
        member,
        place,
        component: ForceComponent::BendingZ,
    };
    let found = frame
        .effects(
            &model,
            &[moment(0, 0.0), moment(2, 0.5)],
            &probes(Axis::Vertical, &[LENGTH, 5.0]),
        )
        .expect("on the rail");
    for (i, j, exact) in [
        (0, 0, LENGTH),
        (0, 1, 5.0),
        (1, 0, LENGTH - 7.5),
        (1, 1, 0.0),
    ] {
        assert!(
            (found[(i, j)] - exact).abs() < 1e-12 * LENGTH,
            "({i}, {j}): {}",
            found[(i, j)]
        );
    }
}

/// Identity: a member between arms in any direction is cut at equal distances along its own line; the arms and the
/// releases stay at its ends, and every part has the section of its own stretch.
#[test]
fn parts_lie_evenly_on_the_line_of_a_member_between_its_arms() {
    let root = CrossSection {
        e: 1.0,
        area: 1.0,
        iy: 1.0,
        iz: 1.0,
        mass: 1.0,
        ..CrossSection::default()
    };
    let mut member = Member::beam([1, 0], 0, [0.0, 1.0, 0.3]);
    member.offsets = [[0.1, -0.2, 0.4], [-0.3, 0.5, 0.25]];
    member.releases = [
        [false, false, false, false, true, false],
        [false, false, false, true, false, false],
    ];
    let model = Model {
        points: vec![[4.0, 7.0, -3.0], [1.0, -2.0, 5.0]],
        sections: vec![root, CrossSection { mass: 3.0, ..root }],
        members: vec![member],
        ..Model::default()
    };
    let (from, to) = ([1.1, -2.2, 5.4], [3.7, 7.5, -2.75]);
    let parts = 5;
    let (cut, ranges) = model.tapered(&[Some(Taper { section: 1, parts })]);
    assert_eq!(
        (ranges.len(), ranges[0].clone(), cut.members.len()),
        (1, 0..parts, parts)
    );
    for (k, part) in cut.members.iter().enumerate() {
        for end in [0, 1] {
            let fraction = (k + end) as f64 / parts as f64;
            let place = cut.points[part.points[end]];
            for axis in 0..3 {
                let expected = from[axis] + (to[axis] - from[axis]) * fraction;
                let found = place[axis] + part.offsets[end][axis];
                assert!(
                    (found - expected).abs() < 1e-14,
                    "part {k}, end {end}: {found}, not {expected}"
                );
            }
            let is_outer = k + end == 0 || k + end == parts;
            let kept = if is_outer {
                (member.offsets[end], member.releases[end])
            } else {
                Default::default()
            };
            assert_eq!(
                (part.offsets[end], part.releases[end]),
                kept,
                "part {k}, end {end}"
            );
        }
        let middle = 1.0 + 2.0 * (k as f64 + 0.5) / parts as f64;
        assert!(
            (cut.sections[part.section].mass - middle).abs() < 1e-15,
            "part {k}"
        );
    }
}
