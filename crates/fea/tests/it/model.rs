//! Everything that a frame can be made of, each against a closed form (analytic).

use crate::common;

use common::{mill, probes};
use fea::{
    BeamTheory, CrossSection, Dof, Effect, FactoredFrame, ForceComponent, GroundSpring, Member,
    MemberKind, Model, PointMass, Rail, RailSegment, Restraint, RigidLink, Support, grid,
    point_compliance,
};
use splines::{Axis, Probe};

const EA: f64 = 4.0e6;
const EI: f64 = 9.0e4;
const SPAN: f64 = 12.0;

const HELD: [bool; 6] = [true; 6];

fn section() -> CrossSection {
    CrossSection {
        e: 1.0,
        g: 1.0,
        area: EA,
        iy: EI,
        iz: EI,
        j: EI,
        ..CrossSection::default()
    }
}

fn member(points: [usize; 2]) -> Member {
    Member::beam(points, 0, [0.0, 1.0, 0.0])
}

/// A beam along x through `x`, and a rail over all its members.
fn beam(x: &[f64]) -> (Model, Rail) {
    let members: Vec<Member> = (1..x.len()).map(|k| member([k - 1, k])).collect();
    let segments = (0..members.len())
        .map(|member| RailSegment {
            member,
            offset: [0.0; 3],
        })
        .collect();
    let model = Model {
        points: x.iter().map(|&x| [x, 0.0, 0.0]).collect(),
        sections: vec![section()],
        members,
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    };
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

fn support(point: usize, names: &str) -> Support {
    let fix = Dof::ALL.map(|freedom| names.split(' ').any(|name| name == freedom.to_string()));
    Support { point, fixed: fix }
}

fn spring(point: usize, freedom: Dof, stiffness: f64) -> GroundSpring {
    GroundSpring {
        point,
        dof: freedom,
        stiffness,
    }
}

fn vertical(model: &Model, rail: &Rail, x: f64) -> f64 {
    grid(
        model,
        std::slice::from_ref(rail),
        &probes(Axis::Vertical, &[x]),
    )
    .expect("solvable")
    .value[(0, 0)]
}

fn near(found: f64, exact: f64, tolerance: f64) {
    assert!(
        (found - exact).abs() <= tolerance * exact.abs().max(1.0),
        "{found} {exact}"
    );
}

/// Simple beam: a^2 b^2/(3 EI L).
fn simple(x: f64) -> f64 {
    (x * (SPAN - x)).powi(2) / (3.0 * EI * SPAN)
}

/// Source: superposition of the simple beam and the lever rule.
#[test]
fn beam_on_springs_sinks_with_them_by_the_lever_rule() {
    let (mut model, rail) = beam(&[0.0, SPAN]);
    model.supports = vec![support(0, "ux uz rx"), support(1, "uz rx")];
    model.springs = vec![spring(0, Dof::Uy, 500.0), spring(1, Dof::Uy, 800.0)];
    for x in [0.0, 2.0, 6.0, 11.0] {
        let (a, b) = (1.0 - x / SPAN, x / SPAN);
        let exact = simple(x) + a * a / 500.0 + b * b / 800.0;
        near(vertical(&model, &rail, x) / exact, 1.0, 1e-13);
    }
    let frame = FactoredFrame::new(&model, &[rail]).expect("solvable");
    let hold = Restraint {
        point: 1,
        dof: Dof::Uy,
        spring: Some(1),
    };
    let found = frame.effects(
        &model,
        &[Effect::Reaction(hold)],
        &probes(Axis::Vertical, &[3.0]),
    );
    near(found.expect("on the rail")[(0, 0)], -0.25, 1e-13);
}

/// Source: cantilever with a root that rotates, L^3/3EI + L^2/k.
#[test]
fn rotational_spring_holds_a_cantilever() {
    let (mut model, rail) = beam(&[0.0, SPAN]);
    model.supports = vec![support(0, "ux uy uz rx ry")];
    model.springs = vec![spring(0, Dof::Rz, 7e3)];
    let exact = SPAN.powi(3) / (3.0 * EI) + SPAN * SPAN / 7e3;
    near(vertical(&model, &rail, SPAN) / exact, 1.0, 1e-13);
}

#[test]
fn springs_are_added_to_supports_and_to_each_other() {
    let (mut model, rail) = beam(&[0.0, SPAN]);
    model.supports = vec![support(0, "ux uy uz rx"), support(1, "uz rx")];
    model.springs = vec![spring(1, Dof::Uy, 300.0), spring(1, Dof::Uy, 500.0)];
    let two = vertical(&model, &rail, 9.0);
    model.springs = vec![spring(1, Dof::Uy, 800.0), spring(0, Dof::Uy, 1e5)];
    near(vertical(&model, &rail, 9.0) / two, 1.0, 1e-13);
}

#[test]
fn masses_do_not_change_statics_by_a_bit() {
    let (mut model, rail) = mill(BeamTheory::Timoshenko);
    let at = probes(Axis::Vertical, &[12.0, 150.0]);
    let bare = grid(&model, std::slice::from_ref(&rail), &at).expect("solvable");
    model.masses = vec![PointMass {
        point: 9,
        mass: 2e5,
        inertia: [1.0, 2.0, 3.0],
        offset: [0.0, 1.0, 0.0],
    }];
    assert!(grid(&model, &[rail], &at).expect("solvable").value == bare.value);
}

/// Source: Timoshenko, Strength of Materials: two bars at angle a to the vertical, P l/(2 EA cos^2 a).
#[test]
fn two_bar_truss_sinks_as_published() {
    let mut model = Model {
        points: vec![[-3.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, -4.0, 0.0]],
        sections: vec![section()],
        members: [[0, 2], [1, 2]]
            .map(|ends| Member {
                kind: MemberKind::Truss,
                ..member(ends)
            })
            .to_vec(),
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    };
    model.supports = vec![
        support(0, "ux uy uz"),
        support(1, "ux uy uz"),
        support(2, "uz"),
    ];
    let (found, _) = point_compliance(&model, &[2]).expect("solvable");
    near(found[(1, 1)] / (5.0 / (2.0 * EA * 0.64)), 1.0, 1e-13);
    // Bars transmit no moment: nothing stiffens the rotations.
    assert!(found[(5, 5)] == f64::INFINITY);
}

/// Source: statics and the unit-load theorem. The right end stands on a strut at 45 degrees, whose thrust along
/// the beam equals the force that it carries.
#[test]
fn inclined_support_by_a_strut_pulls_the_beam() {
    let (mut model, rail) = beam(&[0.0, SPAN]);
    model.points.push([SPAN + 2.0, -2.0, 0.0]);
    model.members.push(Member {
        kind: MemberKind::Truss,
        ..member([1, 2])
    });
    model.supports = vec![
        support(0, "ux uy uz rx"),
        support(1, "uz rx"),
        support(2, "ux uy uz"),
    ];
    let strut = 8f64.sqrt();
    for x in [3.0, 9.0] {
        let share = x / SPAN;
        let exact = simple(x) + share * share * (SPAN / EA + 2.0 * strut / EA);
        near(vertical(&model, &rail, x) / exact, 1.0, 1e-12);
    }
    let frame = FactoredFrame::new(&model, &[rail]).expect("solvable");
    let axial = |member| Effect::InternalForce {
        member,
        place: 0.5,
        component: ForceComponent::Axial,
    };
    let found = frame.effects(
        &model,
        &[axial(0), axial(1)],
        &probes(Axis::Vertical, &[3.0, 9.0]),
    );
    let found = found.expect("on the rail");
    for (j, share) in [0.25, 0.75].into_iter().enumerate() {
        near(found[(0, j)], share, 1e-12);
        near(found[(1, j)], share * 2f64.sqrt(), 1e-12);
    }
}

/// Source: geometry. A rigid lever at 45 degrees with a fixed far end: the end of the beam can move only across
/// it, as on a roller on an inclined plane, while the lever rotates.
#[test]
fn inclined_support_by_a_rigid_link_guides_across_the_link() {
    let (mut model, rail) = beam(&[0.0, SPAN]);
    model
        .points
        .extend([[SPAN, 0.0, 0.0], [SPAN + 2.0, -2.0, 0.0]]);
    model.links = vec![RigidLink { from: 2, to: 3 }];
    // A short stiff joint with a hinge, so that the lever can rotate relative to the beam.
    model.members[0] = Member {
        points: [0, 2],
        ..model.members[0]
    };
    model.members[0].releases[1][5] = true;
    model.points[1] = [SPAN, 5.0, 0.0];
    model.supports = vec![
        support(0, "ux uy uz rx ry rz"),
        support(1, "ux uy uz rx ry rz"),
    ];
    model.supports.push(support(3, "ux uy uz rx ry"));
    let (moved, _) = point_compliance(&model, &[2]).expect("solvable");
    // Displacements at the joint lie along (1, 1)/sqrt 2.
    for k in 0..6 {
        assert!(
            (moved[(0, k)] - moved[(1, k)]).abs() <= 1e-12 * moved.amax(),
            "degree of freedom {k}"
        );
    }
    // Cantilever bending 3EI/L^3 and stretch EA/L resist the motion s along it, each by s/sqrt 2.
    let stiffness = 0.5 * (3.0 * EI / SPAN.powi(3) + EA / SPAN);
    near(2.0 * moved[(1, 1)] * stiffness, 1.0, 1e-12);
    let at = probes(Axis::Vertical, &[SPAN]);
    let found = grid(&model, &[rail], &at).expect("solvable").value[(0, 0)];
    near(found / moved[(1, 1)], 1.0, 1e-12);
}

/// Source: clamped beam L^3/192EI, simple beam L^3/48EI.
#[test]
fn hinges_at_both_clamps_make_a_simple_beam() {
    let (mut model, rail) = beam(&[0.0, SPAN]);
    model.supports = [0, 1].map(|point| Support { point, fixed: HELD }).to_vec();
    near(
        vertical(&model, &rail, 0.5 * SPAN) * 192.0 * EI / SPAN.powi(3),
        1.0,
        1e-13,
    );
    model.members[0].releases = [[false, false, false, false, false, true]; 2];
    near(
        vertical(&model, &rail, 0.5 * SPAN) * 48.0 * EI / SPAN.powi(3),
        1.0,
        1e-13,
    );
    near(
        vertical(&model, &rail, 0.3 * SPAN) / simple(0.3 * SPAN),
        1.0,
        1e-13,
    );
}

/// Source: statics of a Gerber beam: cantilever of length a, hinge, span b to a roller.
#[test]
fn rail_runs_across_a_hinge_and_its_influence_lines_break_there() {
    let (a, b) = (5.0, 7.0);
    let (mut model, rail) = beam(&[0.0, a, a + b]);
    model.supports = vec![
        Support {
            point: 0,
            fixed: HELD,
        },
        support(2, "uy uz rx"),
    ];
    model.members[1].releases[0][5] = true;
    let frame = FactoredFrame::new(&model, &[rail]).expect("solvable");
    let moment = |member, place| Effect::InternalForce {
        member,
        place,
        component: ForceComponent::BendingZ,
    };
    let shear = Effect::InternalForce {
        member: 0,
        place: 1.0,
        component: ForceComponent::ShearY,
    };
    let x = [0.0, 2.0, 4.0, a, 6.0, 9.0, 12.0];
    let effects = [moment(0, 0.0), moment(0, 1.0), moment(1, 0.0), shear];
    let found = frame
        .effects(&model, &effects, &probes(Axis::Vertical, &x))
        .expect("on the rail");
    let given = |z: f64| if z <= a { 1.0 } else { (a + b - z) / b };
    for (j, &z) in x.iter().enumerate() {
        near(found[(0, j)], if z <= a { z } else { a * given(z) }, 1e-12);
        near(found[(1, j)], 0.0, 1e-12);
        near(found[(2, j)], 0.0, 1e-12);
        near(found[(3, j)], if z < a { 0.0 } else { given(z) }, 1e-12);
    }
    // Deflection is continuous across the hinge, its slope is not.
    let at = |x: f64| Probe {
        rail: 0,
        x,
        axis: Axis::Vertical,
    };
    let places = [a - 2e-6, a - 1e-6, a, a + 1e-6, a + 2e-6, 9.0].map(at);
    let value = frame.grid(&places).expect("on the rail").value;
    near((value[(3, 5)] - value[(1, 5)]) / value[(2, 5)], 0.0, 1e-5);
    let slopes = [value[(1, 5)] - value[(0, 5)], value[(4, 5)] - value[(3, 5)]].map(|d| d / 1e-6);
    assert!(
        (slopes[1] - slopes[0]).abs() > 0.1 * slopes[0].abs(),
        "{slopes:?}"
    );
}

/// Source: statics. An expansion joint passes bending and shear and no thrust.
#[test]
fn expansion_joint_passes_no_thrust() {
    let (mut model, rail) = beam(&[0.0, 6.0, SPAN]);
    model.supports = [0, 2].map(|point| Support { point, fixed: HELD }).to_vec();
    let whole = vertical(&model, &rail, 7.0);
    model.members[1].releases[0][0] = true;
    near(vertical(&model, &rail, 7.0) / whole, 1.0, 1e-12);
    let frame = FactoredFrame::new(&model, &[rail]).expect("solvable");
    let axial = |member| Effect::InternalForce {
        member,
        place: 0.5,
        component: ForceComponent::Axial,
    };
    let at = probes(Axis::Longitudinal, &[5.0, 8.0]);
    let found = frame
        .effects(&model, &[axial(0), axial(1)], &at)
        .expect("on the rail");
    let exact = [[1.0, 0.0], [0.0, -1.0]];
    for i in 0..2 {
        for j in 0..2 {
            // Each section lies between its load and its clamp.
            near(found[(i, j)], exact[i][j], 1e-12);
        }
    }
}

/// Source: a rail on cells in a bend has the coordinate of the projection; statics of a bracket.
#[test]
fn rail_over_a_bent_member_chain_follows_the_projection() {
    // An L in the ground plane, clamped at one end, loaded at the free end: bending and torsion of both legs.
    let mut model = Model {
        points: vec![[0.0; 3], [3.0, 0.0, 4.0], [6.0, 0.0, 0.0]],
        sections: vec![section()],
        members: vec![member([0, 1]), member([1, 2])],
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    };
    model.supports = vec![Support {
        point: 0,
        fixed: HELD,
    }];
    let segments = [0, 1]
        .map(|member| RailSegment {
            member,
            offset: [0.0; 3],
        })
        .to_vec();
    let rail = Rail {
        origin: [0.0; 3],
        axis: [1.0, 0.0, 0.0],
        segments,
        stations: Vec::new(),
    };
    // Each leg 5 long; turned by 2 x 53.13 degrees: cos = -0.28 between them (unit-load theorem).
    let (l, c, s) = (5.0_f64, -0.28_f64, 0.96_f64);
    let second = l.powi(3) / (3.0 * EI);
    let first = l.powi(3) / (3.0 * EI) + l * (c * l).powi(2) / EI + l * l * (c * l) / EI;
    let torsion = l * (s * l).powi(2) / EI;
    near(
        vertical(&model, &rail, 6.0) / (second + first + torsion),
        1.0,
        1e-12,
    );
    let frame = FactoredFrame::new(&model, &[rail]).expect("solvable");
    let root = |component| Effect::InternalForce {
        member: 0,
        place: 0.0,
        component,
    };
    let effects = [
        root(ForceComponent::BendingZ),
        root(ForceComponent::Torsion),
    ];
    let found = frame
        .effects(&model, &effects, &probes(Axis::Vertical, &[6.0]))
        .expect("on the rail");
    near(found[(0, 0)], l + c * l, 1e-12);
    near(found[(1, 0)].abs(), s * l, 1e-12);
}
