//! Influence lines of internal forces against closed forms.
//!
//! Signs (one picture, in words): cut the member and look along local x at the part before the cut. The part
//! beyond pulls on it along +x (N), pushes its face along +y (Vy) and +z (Vz), and turns it right-handed
//! about x, y, z (Mx, My, Mz). A unit load acts up, along or to the right, so a beam hogs: Mz < 0.

use crate::common;

use common::{Stream, mill, paper, with_nodes};
use fea::{
    BeamTheory, Dof, Effect, EntryFault, Error, FactoredFrame, ForceComponent, Girder, Member,
    Model, ModelEntry, Rail, RailSegment, Restraint,
};
use splines::{Axis, Probe};

const SPAN: f64 = 60.0;

fn force(member: usize, place: f64, component: ForceComponent) -> Effect {
    Effect::InternalForce {
        member,
        place,
        component,
    }
}

fn probe(axis: Axis, x: f64) -> Probe {
    Probe { rail: 0, x, axis }
}

/// A girder of one member a span, without overhangs, and its factored frame.
fn girder(spans: &[f64], theory: BeamTheory) -> (Model, FactoredFrame) {
    let given = Girder {
        spans: spans.to_vec(),
        overhangs: [0.0; 2],
        ka_vertical: Some(0.4),
        ka_lateral: Some(0.3),
        theory,
        stations: Vec::new(),
        ..paper()
    };
    let (model, rail) = given.model_and_rail().expect("sound");
    let frame = FactoredFrame::new(&model, &[rail]).expect("solvable");
    (model, frame)
}

/// Largest difference of an influence line from its closed form, relative to `scale`.
fn worst(
    (model, frame): &(Model, FactoredFrame),
    effect: Effect,
    axis: Axis,
    x: &[f64],
    scale: f64,
    exact: impl Fn(f64) -> f64,
) -> f64 {
    let at: Vec<Probe> = x.iter().map(|&x| probe(axis, x)).collect();
    let found = frame.effects(model, &[effect], &at).expect("on the rail");
    found
        .iter()
        .zip(x)
        .map(|(found, &x)| (found - exact(x)).abs() / scale)
        .fold(0.0, f64::max)
}

const PLACES: [f64; 11] = [0.0, 0.1, 0.2, 0.3, 0.37, 0.5, 0.6, 0.71, 0.8, 0.999, 1.0];

fn along(length: f64) -> Vec<f64> {
    PLACES.iter().map(|place| place * length).collect()
}

/// Source: statics of a simply supported beam (Hibbeler, Structural Analysis, chapter 6).
#[test]
fn simple_beam_has_triangles_of_moment_and_a_jump_of_shear() {
    let beam = girder(&[SPAN], BeamTheory::Timoshenko);
    for s in [0.25, 0.5, 0.8] {
        let section = s * SPAN;
        let moment = |z: f64| {
            -if z < section {
                z * (SPAN - section)
            } else {
                section * (SPAN - z)
            } / SPAN
        };
        let shear = |z: f64| {
            let before = if z == section {
                0.5
            } else {
                f64::from(u8::from(z < section))
            };
            (SPAN - z) / SPAN - before
        };
        let x = [along(SPAN), vec![section]].concat();
        let vertical = worst(
            &beam,
            force(0, s, ForceComponent::BendingZ),
            Axis::Vertical,
            &x,
            SPAN,
            moment,
        );
        assert!(vertical < 1e-13, "{vertical:e}");
        let vertical = worst(
            &beam,
            force(0, s, ForceComponent::ShearY),
            Axis::Vertical,
            &x,
            1.0,
            shear,
        );
        assert!(vertical < 1e-13, "{vertical:e}");
        // In the plane x-z the moment about y has the other sign.
        let lateral = worst(
            &beam,
            force(0, s, ForceComponent::BendingY),
            Axis::Lateral,
            &x,
            SPAN,
            |z| -moment(z),
        );
        assert!(lateral < 1e-13, "{lateral:e}");
        let lateral = worst(
            &beam,
            force(0, s, ForceComponent::ShearZ),
            Axis::Lateral,
            &x,
            1.0,
            shear,
        );
        assert!(lateral < 1e-13, "{lateral:e}");
    }
    let (model, frame) = &beam;
    let mid = force(0, 0.5, ForceComponent::BendingZ);
    let quarter = frame
        .effects(model, &[mid], &[probe(Axis::Vertical, 30.0)])
        .expect("on the rail")[(0, 0)];
    assert!(
        (quarter + SPAN / 4.0).abs() < 1e-13 * SPAN,
        "L/4: {quarter}"
    );
}

#[test]
fn shear_on_both_sides_of_the_load_differs_by_the_load() {
    let (model, frame) = girder(&[SPAN], BeamTheory::EulerBernoulli);
    let section = [force(0, 0.4, ForceComponent::ShearY)];
    let x = [24.0 - 1e-9, 24.0, 24.0 + 1e-9];
    let at = x.map(|x| probe(Axis::Vertical, x));
    let v = frame.effects(&model, &section, &at).expect("on the rail");
    assert!((v[(0, 2)] - v[(0, 0)] - 1.0).abs() < 1e-9);
    assert!((v[(0, 1)] - 0.5 * (v[(0, 0)] + v[(0, 2)])).abs() < 1e-9);
}

/// Source: three-moment equation; the printed four digits are those of Anger, Ten-Division Influence Lines for
/// Continuous Beams (1956), for loads down.
#[test]
fn two_span_moments_are_those_of_the_influence_tables() {
    let beam = girder(&[SPAN, SPAN], BeamTheory::EulerBernoulli);
    let support = |a: f64| 0.25 * SPAN * a * (1.0 - a * a);
    let at_b = |z: f64| {
        if z < SPAN {
            support(z / SPAN)
        } else {
            support(2.0 - z / SPAN)
        }
    };
    let x = [along(SPAN), along(SPAN).iter().map(|x| x + SPAN).collect()].concat();
    for (member, place) in [(0, 1.0), (1, 0.0)] {
        let error = worst(
            &beam,
            force(member, place, ForceComponent::BendingZ),
            Axis::Vertical,
            &x,
            SPAN,
            at_b,
        );
        assert!(error < 1e-13, "{error:e}");
    }
    let (model, frame) = &beam;
    let read = |place: f64, z: f64| {
        let section = force(0, place, ForceComponent::BendingZ);
        -frame
            .effects(model, &[section], &[probe(Axis::Vertical, z * SPAN)])
            .expect("on the rail")[(0, 0)]
            / SPAN
    };
    for (place, z, printed) in [
        (1.0, 0.4, -0.0840),
        (1.0, 0.6, -0.0960),
        (1.0, 1.5, -0.0938),
        (0.4, 0.4, 0.2064),
        (0.5, 0.5, 0.2031),
        (0.4, 1.4, -0.0384),
    ] {
        assert!(
            (read(place, z) - printed).abs() < 5.1e-5,
            "{place} {z}: {}",
            read(place, z)
        );
    }
}

/// Source: three-moment equation for three equal spans, M_B = -4/15 P L a (1 - a^2) for a load in the first and
/// -P L b (1 - b) (7 - 5 b) / 15 for one in the second.
#[test]
fn three_span_support_moment_and_shear_follow_the_three_moment_equation() {
    let beam = girder(&[SPAN; 3], BeamTheory::EulerBernoulli);
    let at_b = |z: f64| {
        let (a, b, c) = (z / SPAN, z / SPAN - 1.0, 3.0 - z / SPAN);
        SPAN / 15.0
            * match z {
                z if z < SPAN => 4.0 * a * (1.0 - a * a),
                z if z < 2.0 * SPAN => b * (1.0 - b) * (7.0 - 5.0 * b),
                _ => -c * (1.0 - c * c),
            }
    };
    let x: Vec<f64> = (0..=60).map(|k| 3.0 * f64::from(k)).collect();
    let moment = force(1, 0.0, ForceComponent::BendingZ);
    let error = worst(&beam, moment, Axis::Vertical, &x, SPAN, at_b);
    assert!(error < 1e-13, "{error:e}");
    // In the first span the shear is that of a simple beam plus that of the end moment.
    let shear = |z: f64| {
        let own = if z < SPAN {
            (SPAN - z) / SPAN - f64::from(u8::from(z < 24.0))
        } else {
            0.0
        };
        own - at_b(z) / SPAN + if z == 24.0 { -0.5 } else { 0.0 }
    };
    let error = worst(
        &beam,
        force(0, 0.4, ForceComponent::ShearY),
        Axis::Vertical,
        &x,
        1.0,
        shear,
    );
    assert!(error < 1e-13, "{error:e}");
}

/// Source: statics. Overhangs of 15 ft on both sides; the lines of the span continue straight over them.
#[test]
fn overhangs_act_as_cantilevers_and_lift_the_span() {
    let (model, rail) = paper().model_and_rail().expect("sound");
    let frame = FactoredFrame::new(&model, &[rail]).expect("solvable");
    let beam = (model, frame);
    let x: Vec<f64> = (-15..=75).map(f64::from).collect();
    // Members: overhang, span, overhang. The section is just inside the root of the second overhang.
    let root = force(2, 0.0, ForceComponent::BendingZ);
    let error = worst(&beam, root, Axis::Vertical, &x, SPAN, |z| {
        (z - SPAN).max(0.0)
    });
    assert!(error < 1e-13, "{error:e}");
    let tip = force(0, 0.4, ForceComponent::BendingZ);
    let error = worst(&beam, tip, Axis::Vertical, &x, SPAN, |z| {
        (-9.0 - z).max(0.0)
    });
    assert!(error < 1e-13, "{error:e}");
    let shear = |z: f64| if z < -9.0 { -1.0 } else { 0.0 } - if z == -9.0 { 0.5 } else { 0.0 };
    let error = worst(
        &beam,
        force(0, 0.4, ForceComponent::ShearY),
        Axis::Vertical,
        &x,
        1.0,
        shear,
    );
    assert!(error < 1e-13, "{error:e}");
    let middle = |z: f64| -if z < 30.0 { z } else { SPAN - z } / 2.0;
    let error = worst(
        &beam,
        force(1, 0.5, ForceComponent::BendingZ),
        Axis::Vertical,
        &x,
        SPAN,
        middle,
    );
    assert!(error < 1e-13, "{error:e}");
}

/// Source: statics; both supports fix the twist, so that they carry a torque at z by the lever rule.
#[test]
fn lateral_load_above_the_axis_twists_the_girder() {
    let beam = girder(&[SPAN], BeamTheory::Timoshenko);
    let height = paper().rail_height;
    let torsion = |z: f64| {
        let before = if z == 18.0 {
            0.5
        } else {
            f64::from(u8::from(z < 18.0))
        };
        height * ((SPAN - z) / SPAN - before)
    };
    let error = worst(
        &beam,
        force(0, 0.3, ForceComponent::Torsion),
        Axis::Lateral,
        &along(SPAN),
        height,
        torsion,
    );
    assert!(error < 1e-13, "{error:e}");
    let error = worst(
        &beam,
        force(0, 0.3, ForceComponent::Torsion),
        Axis::Vertical,
        &along(SPAN),
        1.0,
        |_| 0.0,
    );
    assert!(error < 1e-13, "{error:e}");
}

/// Source: statics; only the first support fixes the displacement along x; the load acts at the height of the rail.
#[test]
fn longitudinal_load_pulls_and_bends() {
    let beam = girder(&[SPAN], BeamTheory::EulerBernoulli);
    let height = paper().rail_height;
    let before = |z: f64| {
        if z == 18.0 {
            0.5
        } else {
            f64::from(u8::from(z < 18.0))
        }
    };
    let x = along(SPAN);
    let normal = |z: f64| 1.0 - before(z);
    let error = worst(
        &beam,
        force(0, 0.3, ForceComponent::Axial),
        Axis::Longitudinal,
        &x,
        1.0,
        normal,
    );
    assert!(error < 1e-12, "{error:e}");
    let moment = |z: f64| height * (before(z) - 0.3);
    let error = worst(
        &beam,
        force(0, 0.3, ForceComponent::BendingZ),
        Axis::Longitudinal,
        &x,
        height,
        moment,
    );
    assert!(error < 1e-12, "{error:e}");
}

/// Every component at several sections of a real structure, loaded everywhere.
fn mill_cases() -> (Model, Rail, Vec<Probe>, Vec<(usize, f64)>) {
    let (model, rail) = mill(BeamTheory::Timoshenko);
    let x = [3.3, 18.0, 39.7, 61.0, 150.0, 169.9, 171.0, 240.0, 300.5];
    let at = Axis::ALL
        .iter()
        .flat_map(|&axis| x.map(|x| probe(axis, x)))
        .collect();
    let members = [0, 5, 28, 29, 30, 31, 32, model.members.len() - 1];
    let sections = members
        .iter()
        .flat_map(|&member| [0.0, 0.3, 0.5, 1.0].map(|s| (member, s)))
        .collect();
    (model, rail, at, sections)
}

fn all_components(sections: &[(usize, f64)]) -> Vec<Effect> {
    sections
        .iter()
        .flat_map(|&(m, s)| ForceComponent::ALL.map(|c| force(m, s, c)))
        .collect()
}

#[test]
fn sections_are_in_equilibrium_from_both_sides() {
    // The same members listed from their other ends: the forces are those of the other part of the member.
    let (model, rail, at, sections) = mill_cases();
    let mut turned = model.clone();
    for member in &mut turned.members {
        let Member {
            points,
            offsets,
            releases,
            ..
        } = *member;
        member.points = [points[1], points[0]];
        member.offsets = [offsets[1], offsets[0]];
        member.releases = [releases[1], releases[0]];
    }
    let mirrored: Vec<(usize, f64)> = sections.iter().map(|&(m, s)| (m, 1.0 - s)).collect();
    let rails = [rail];
    let one = FactoredFrame::new(&model, &rails).expect("solvable");
    let two = FactoredFrame::new(&turned, &rails).expect("solvable");
    let a = one
        .effects(&model, &all_components(&sections), &at)
        .expect("on the rail");
    let b = two
        .effects(&turned, &all_components(&mirrored), &at)
        .expect("on the rail");
    // Half a turn about local y, and the face of the other part.
    let sign = [1.0, -1.0, 1.0, 1.0, -1.0, 1.0];
    for (i, row) in a.row_iter().enumerate() {
        for (j, found) in row.iter().enumerate() {
            let error = (found - sign[i % 6] * b[(i, j)]).abs();
            assert!(
                error < 1e-9,
                "{:?} {:?}: {found} {}",
                sections[i / 6],
                at[j],
                b[(i, j)]
            );
        }
    }
}

#[test]
fn moments_are_the_integrals_of_shears() {
    let (model, rail, at, _) = mill_cases();
    let frame = FactoredFrame::new(&model, &[rail]).expect("solvable");
    for member in [28, 29, 30] {
        let given = &model.members[member];
        let end = |k: usize, a: usize| model.points[given.points[k]][a] + given.offsets[k][a];
        let length = (0..3)
            .map(|a| (end(1, a) - end(0, a)).powi(2))
            .sum::<f64>()
            .sqrt();
        let (s, h) = (0.43, 1e-3);
        let effects: Vec<Effect> = [s - h, s, s + h]
            .iter()
            .flat_map(|&s| {
                [
                    ForceComponent::BendingZ,
                    ForceComponent::BendingY,
                    ForceComponent::ShearY,
                    ForceComponent::ShearZ,
                ]
                .map(|c| force(member, s, c))
            })
            .collect();
        let value = frame.effects(&model, &effects, &at).expect("on the rail");
        for j in 0..at.len() {
            let rate = |k: usize| (value[(8 + k, j)] - value[(k, j)]) / (2.0 * h * length);
            assert!(
                (rate(0) + value[(6, j)]).abs() < 1e-8,
                "dMz/dx = -Vy: {:?}",
                at[j]
            );
            assert!(
                (rate(1) - value[(7, j)]).abs() < 1e-8,
                "dMy/dx = Vz: {:?}",
                at[j]
            );
        }
    }
}

#[test]
fn forces_under_loads_inside_members_equal_those_with_nodes_there() {
    // Rigid offsets, a hinge, shear; loads before, behind and beside the section, in all three directions.
    let (mut model, rail) = mill(BeamTheory::Timoshenko);
    model.members[29].releases[0] = [false, false, false, true, true, true];
    let member = 29;
    let given = model.members[member];
    let offset = rail
        .segments
        .iter()
        .find(|s| s.member == member)
        .expect("carries the rail")
        .offset;
    let end = |k: usize| model.points[given.points[k]][0] + given.offsets[k][0];
    let places = [0.2, 0.55, 0.8];
    let at: Vec<Probe> = places
        .iter()
        .flat_map(|s| {
            Axis::ALL.map(|axis| probe(axis, end(0) + s * (end(1) - end(0)) - rail.origin[0]))
        })
        .collect();
    let sections = [
        (member, 0.0),
        (member, 0.4),
        (member, 0.7),
        (member, 1.0),
        (28, 0.5),
    ];
    let rails = [rail.clone()];
    let frame = FactoredFrame::new(&model, &rails).expect("solvable");
    let found = frame
        .effects(&model, &all_components(&sections), &at)
        .expect("on the rail");

    // The same with the member cut at the loads: four members in a row that all carry the rail.
    let (cut, _) = with_nodes(&model, &places.map(|s| (member, s, offset)));
    let mut pieces = rail;
    pieces.segments = pieces
        .segments
        .iter()
        .flat_map(|segment| {
            let own = match segment.member {
                k if k < member => k..k + 1,
                k if k == member => k..k + 4,
                k => k + 3..k + 4,
            };
            own.map(|member| RailSegment { member, ..*segment })
        })
        .collect();
    let parts = FactoredFrame::new(&cut, &[pieces]).expect("solvable");
    // Section s of the member on the pieces between the cuts.
    let bounds = [0.0, 0.2, 0.55, 0.8, 1.0];
    let moved = sections.map(|(m, s)| {
        if m < member {
            return (m, s);
        }
        let k = (0..4).find(|&k| s <= bounds[k + 1]).unwrap_or(3);
        (member + k, (s - bounds[k]) / (bounds[k + 1] - bounds[k]))
    });
    let exact = parts
        .effects(&cut, &all_components(&moved), &at)
        .expect("on the rail");
    for i in 0..found.nrows() {
        for j in 0..found.ncols() {
            let error = (found[(i, j)] - exact[(i, j)]).abs();
            assert!(
                error < 1e-9,
                "{i} {:?}: {} {}",
                at[j],
                found[(i, j)],
                exact[(i, j)]
            );
        }
    }
}

#[test]
fn one_solve_an_effect_gives_what_one_solve_a_load_gives() {
    let (model, rail, at, sections) = mill_cases();
    let frame = FactoredFrame::new(&model, &[rail]).expect("solvable");
    let mut effects = all_components(&sections);
    effects.extend(frame.restraints(&model).into_iter().map(Effect::Reaction));
    assert!(effects.len() > at.len());
    let by_loads = frame.effects(&model, &effects, &at).expect("on the rail");
    let lines = frame.influence_lines(&model, &effects).expect("sound");
    let mut column = vec![0.0; effects.len()];
    for (j, &p) in at.iter().enumerate() {
        lines.fill(p, &mut column).expect("on the rail");
        for (i, value) in column.iter().enumerate() {
            let error = (value - by_loads[(i, j)]).abs();
            assert!(
                error < 1e-8 * by_loads.column(j).amax(),
                "{:?} {p:?}: {value}",
                effects[i]
            );
            assert_eq!(
                lines.value(i, p),
                Ok(*value),
                "{:?} {p:?} alone",
                effects[i]
            );
        }
    }
    assert!(
        lines.value(effects.len(), at[0]).is_err(),
        "there is no such effect"
    );
}

#[test]
fn effects_of_what_does_not_exist_are_refused() {
    let (model, frame) = girder(&[SPAN], BeamTheory::EulerBernoulli);
    let refused = |effect, fault| {
        let found = frame
            .influence_lines(&model, &[force(0, 0.5, ForceComponent::Axial), effect])
            .err();
        assert_eq!(
            found,
            Some(Error::Invalid {
                entry: ModelEntry::Effect(1),
                fault
            })
        );
    };
    refused(
        force(1, 0.5, ForceComponent::Axial),
        EntryFault::NoMember { member: 1 },
    );
    refused(
        force(0, 1.5, ForceComponent::Axial),
        EntryFault::NoPlace { place: 1.5 },
    );
    let restraint = |point, freedom| {
        Effect::Reaction(Restraint {
            point,
            dof: freedom,
            spring: None,
        })
    };
    refused(
        restraint(1, Dof::Ux),
        EntryFault::NoReaction {
            point: 1,
            dof: Dof::Ux,
        },
    );
    refused(
        restraint(7, Dof::Uy),
        EntryFault::NoReaction {
            point: 7,
            dof: Dof::Uy,
        },
    );
}

/// Forces are differences of displacements times stiffness: short members cost them digits.
#[test]
fn forces_keep_ten_digits_at_300_members_a_span() {
    let (model, rail) = Girder {
        overhangs: [0.0; 2],
        stations: Vec::new(),
        ..paper()
    }
    .model_and_rail()
    .expect("sound");
    let mut stream = Stream::new(7);
    for members in [2, 10, 30, 100, 300] {
        let mut cuts: Vec<f64> = (1..members)
            .map(|k| (k as f64 + stream.between(-0.4, 0.4)) / members as f64)
            .collect();
        cuts[members / 2 - 1] = 0.5;
        let places: Vec<(usize, f64, [f64; 3])> = cuts.iter().map(|&s| (0, s, [0.0; 3])).collect();
        let (chain, _) = with_nodes(&model, &places);
        let segments = (0..members)
            .map(|member| RailSegment {
                member,
                ..rail.segments[0]
            })
            .collect();
        let frame = FactoredFrame::new(
            &chain,
            &[Rail {
                segments,
                ..rail.clone()
            }],
        )
        .expect("solvable");
        let x: Vec<f64> = (1..20).map(|k| 3.0 * f64::from(k)).collect();
        let beam = (chain, frame);
        let middle = force(members / 2, 0.0, ForceComponent::BendingZ);
        let exact = |z: f64| -0.5 * f64::min(z, SPAN - z);
        let error = worst(&beam, middle, Axis::Vertical, &x, 0.25 * SPAN, exact);
        println!("{members} members a span: moment errs by {error:.1e} of L/4");
        assert!(error < 1e-10, "{members}: {error:e}");
    }
}
