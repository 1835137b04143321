//! The state of a preload: axial forces, critical factors, and influence about the loaded state.

use std::f64::consts::PI;

use fea::{
    BeamTheory, CautionKind, CriticalFactor, CrossSection, Dof, EntryFault, Error, FactoredFrame,
    GroundSpring, Member, MemberKind, Model, ModelEntry, Preload, PreloadedState, Rail,
    RailSegment, RigidLink, Support, preloaded,
};
use splines::{Axis, Probe};

/// EI = 1 in both planes, hardly extensible.
fn section() -> CrossSection {
    CrossSection {
        e: 1.0,
        g: 1.0,
        area: 1e9,
        iy: 1.0,
        iz: 1.0,
        j: 1.0,
        ..CrossSection::default()
    }
}

/// A straight beam of length `l` along x in `parts`, y up.
fn straight(l: f64, parts: usize, supports: &[(usize, [bool; 6])]) -> Model {
    Model {
        points: (0..=parts)
            .map(|k| [l * k as f64 / parts as f64, 0.0, 0.0])
            .collect(),
        sections: vec![section()],
        members: (0..parts)
            .map(|k| Member::beam([k, k + 1], 0, [0.0, 1.0, 0.0]))
            .collect(),
        supports: supports
            .iter()
            .map(|&(point, fixed)| Support { point, fixed })
            .collect(),
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    }
}

fn rail(m: &Model) -> Rail {
    let segments = (0..m.members.len())
        .map(|member| RailSegment {
            member,
            offset: [0.0; 3],
        })
        .collect();
    Rail {
        axis: [1.0, 0.0, 0.0],
        segments,
        ..Rail::default()
    }
}

fn at_points(forces: &[(usize, [f64; 3])]) -> Preload {
    Preload {
        points: forces.to_vec(),
        ..Preload::default()
    }
}

fn critical(m: &Model, preload: &Preload) -> f64 {
    match preloaded(m, &[], preload).expect("stable").critical {
        CriticalFactor::At(factor, _) => factor,
        CriticalFactor::Above(_) => f64::INFINITY,
    }
}

const FIXED: [bool; 6] = [true; 6];
const PINNED: [bool; 6] = [true, true, true, true, false, false];
const ROLLER: [bool; 6] = [false, true, true, true, false, false];
const GUIDED: [bool; 6] = [false, true, true, true, true, true];

fn vertical(x: f64) -> Probe {
    Probe {
        rail: 0,
        x,
        axis: Axis::Vertical,
    }
}

/// Closed forms of Euler: pi^2, pi^2/4, 20.190729 and 4 pi^2 times EI/L^2; Timoshenko and Gere (1961), sections 2.1, 2.2 and
/// 2.9. The last is that of a member between fixed ends, which no node shows.
#[test]
fn euler_loads_are_found_by_count_with_one_member() {
    let l = 2.5;
    let euler = PI * PI / (l * l);
    let cases = [
        ([PINNED, ROLLER], 1.0),
        ([FIXED, [false; 6]], 0.25),
        ([FIXED, ROLLER], 20.190_728_556_426_63 / (PI * PI)),
        ([FIXED, GUIDED], 4.0),
    ];
    for (ends, share) in cases {
        for parts in [1, 3] {
            let m = straight(l, parts, &[(0, ends[0]), (parts, ends[1])]);
            let p = 0.2 * share * euler;
            let found = critical(&m, &at_points(&[(parts, [-p, 0.0, 0.0])]));
            assert!(
                (found / 5.0 - 1.0).abs() < 1e-9,
                "{share} in {parts} parts: {found}"
            );
        }
    }
}

/// Engesser: 1/P = 1/P_E + 1/(G As) for the pinned column; at G As = 10 P_E 0.90909 P_E.
#[test]
fn shear_lowers_the_critical_load_as_engesser_has_it() {
    let l = 3.0;
    let euler = PI * PI / (l * l);
    let mut m = straight(l, 1, &[(0, PINNED), (1, ROLLER)]);
    m.theory = BeamTheory::Timoshenko;
    m.sections[0].g = 10.0 * euler;
    (m.sections[0].shear_y, m.sections[0].shear_z) = (Some(1.0), Some(1.0));
    let found = critical(&m, &at_points(&[(1, [-0.3 * euler, 0.0, 0.0])])) * 0.3;
    assert!((found - 1.0 / 1.1).abs() < 1e-9, "{found}");
}

/// A portal of two columns and a beam of equal EI and length in the x-y plane, P on each column.
fn portal(feet: [bool; 6]) -> Model {
    let beam = |points| Member::beam(points, 0, [0.0, 0.0, 1.0]);
    Model {
        points: vec![
            [0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [1.0, 1.0, 0.0],
            [1.0, 0.0, 0.0],
        ],
        sections: vec![section()],
        members: vec![beam([0, 1]), beam([1, 2]), beam([2, 3])],
        supports: vec![
            Support {
                point: 0,
                fixed: feet,
            },
            Support {
                point: 3,
                fixed: feet,
            },
            Support {
                point: 1,
                fixed: [false, false, true, false, false, false],
            },
            Support {
                point: 2,
                fixed: [false, false, true, false, false, false],
            },
        ],
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    }
}

/// Closed form: roots of the sway equation of the portal, u tan u = 6 with pinned feet and tan u = -u/6 with fixed ones; P L^2/EI =
/// 1.82129 and 7.37915. Timoshenko and Gere (1961), section 2.4; Bleich, Buckling Strength of Metal Structures (1952).
#[test]
fn portal_sways_at_its_closed_load() {
    let hinged = [true, true, true, true, true, false];
    for (feet, known) in [(hinged, 1.82129), (FIXED, 7.37915)] {
        let p = 0.1 * known;
        let preload = at_points(&[(1, [0.0, -p, 0.0]), (2, [0.0, -p, 0.0])]);
        let state = preloaded(&portal(feet), &[], &preload).expect("stable");
        let CriticalFactor::At(factor, mode) = &state.critical else {
            panic!("it sways")
        };
        assert!((factor * p / known - 1.0).abs() < 3e-6, "{}", factor * p);
        assert_eq!(mode.most.dof, Dof::Ux, "sway");
        assert!(!mode.most.between_ends && mode.most.member != 1);
        assert!(
            (mode.points[1][0] - mode.points[2][0]).abs() < 1e-6 && mode.points[1][0].abs() > 0.999
        );
    }
}

/// Closed form: a cantilever column under its own weight buckles at w L = 7.83735 EI/L^2 (the first zero of the Bessel
/// function J of order -1/3); Timoshenko and Gere (1961), section 2.12. Mean forces of parts: order 2.
#[test]
fn own_weight_counts_by_its_mean_with_order_two() {
    let known = 7.837_347_44;
    let errors = [2, 4, 8, 16].map(|parts| {
        let mut m = straight(1.0, parts, &[(0, FIXED)]);
        m.sections[0].mass = 1.0;
        let found = critical(
            &m,
            &Preload {
                acceleration: [-0.5, 0.0, 0.0],
                ..Preload::default()
            },
        );
        (0.5 * found / known - 1.0).abs()
    });
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.25, "{errors:?}");
    }
    assert!(errors[3] < 2e-3, "{errors:?}");
}

fn tip_stiffness(state: &PreloadedState, point: usize, dof: usize) -> f64 {
    let frame = FactoredFrame::new(&state.model, &[]).expect("stable");
    1.0 / frame.point_compliance(&[point]).expect("a point")[(dof, dof)]
}

/// Closed form: a string under W resists W/L across, which is a mechanism in first order; with its own weight w L it is
/// w/ln(1 + w L/W): 1.442695 and 1.049206 W/L for w L = W and 0.1 W. Mean forces in 1, 2, 4, 8 parts: order 2.
#[test]
fn hanger_is_as_stiff_as_a_string() {
    let (l, load) = (4.0, 50.0);
    let hanger = |parts: usize, mass: f64, kind: MemberKind| {
        let mut m = straight(l, parts, &[(0, [true, true, true, true, true, true])]);
        m.points
            .iter_mut()
            .for_each(|point| *point = [0.0, -point[0], 0.0]);
        m.members.iter_mut().for_each(|member| member.kind = kind);
        m.sections[0].mass = mass;
        m.sections[0].area = 1e7;
        m
    };
    for kind in [MemberKind::Truss, MemberKind::Cable, MemberKind::Rod] {
        let m = hanger(1, 0.0, kind);
        assert!(
            FactoredFrame::new(&m, &[])
                .and_then(|frame| frame.point_compliance(&[1]))
                .is_ok_and(|compliance| compliance[(0, 0)].is_infinite())
        );
        let state = preloaded(&m, &[], &at_points(&[(1, [0.0, -load, 0.0])])).expect("it hangs");
        assert!((state.model.members[0].tension / load - 1.0).abs() < 1e-12);
        assert!((tip_stiffness(&state, 1, 0) * l / load - 1.0).abs() < 1e-12);
        assert_eq!(state.critical, CriticalFactor::Above(fea::MOST_CRITICAL));
    }
    let known = [4.0e-2, 1.1e-2, 2.8e-3, 7.0e-4];
    for (share, exact) in [
        (1.0, std::f64::consts::LOG2_E),
        (0.1, 1.049_205_869_319_586),
    ] {
        let errors = [1, 2, 4, 8].map(|parts| {
            let m = hanger(parts, share * load / l, MemberKind::Truss);
            let preload = Preload {
                acceleration: [0.0, -1.0, 0.0],
                ..at_points(&[(parts, [0.0, -load, 0.0])])
            };
            let state = preloaded(&m, &[], &preload).expect("it hangs");
            (tip_stiffness(&state, parts, 0) * l / load / exact - 1.0).abs()
        });
        if share == 1.0 {
            assert!(
                errors
                    .iter()
                    .zip(known)
                    .all(|(error, known)| (error / known - 1.0).abs() < 0.06),
                "{errors:?}"
            );
        }
        assert!(
            errors
                .windows(2)
                .all(|pair| (pair[0] / pair[1]).log2() > 1.8),
            "{errors:?}"
        );
    }
}

/// Closed form: a rigid arm h on a rotational spring k with the weight W on top falls at k/(W h), whether the arm is a link, an
/// offset of a member or the offset of a mass.
#[test]
fn weight_on_a_rigid_arm_falls_at_the_closed_factor() {
    let (h, k, w) = (1.7, 11.0, 2.0);
    let spring = |dof| GroundSpring {
        point: 0,
        dof,
        stiffness: k,
    };
    let base = Model {
        points: vec![[0.0; 3], [0.0, h, 0.0]],
        sections: vec![section()],
        supports: vec![Support {
            point: 0,
            fixed: [true, true, true, false, true, false],
        }],
        springs: vec![spring(Dof::Rx), spring(Dof::Rz)],
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    };
    let linked = Model {
        links: vec![RigidLink { from: 0, to: 1 }],
        ..base.clone()
    };
    let found = critical(&linked, &at_points(&[(1, [0.0, -w, 0.0])]));
    assert!((found * w * h / k - 1.0).abs() < 1e-10, "{found}");
    let mass = fea::PointMass {
        point: 0,
        mass: w,
        inertia: [0.0; 3],
        offset: [0.0, h, 0.0],
    };
    let heavy = Model {
        masses: vec![mass],
        points: vec![[0.0; 3]],
        ..base.clone()
    };
    let found = critical(
        &heavy,
        &Preload {
            acceleration: [0.0, -1.0, 0.0],
            ..Preload::default()
        },
    );
    assert!((found * w * h / k - 1.0).abs() < 1e-10, "{found}");
    // A stiff post on the arm, held along x and z at its top by nothing but the arm.
    let mut post = base;
    post.points[1] = [0.0, h + 1.0, 0.0];
    post.sections[0] = CrossSection {
        e: 1e7,
        ..section()
    };
    let member = Member {
        offsets: [[0.0, h, 0.0], [0.0; 3]],
        ..Member::beam([0, 1], 0, [0.0, 0.0, 1.0])
    };
    post.members.push(member);
    let found = critical(&post, &at_points(&[(1, [0.0, -w, 0.0])]));
    assert!((found * w * (h + 1.0) / k - 1.0).abs() < 2e-6, "{found}");
}

/// Closed form: a bar of four members, 1e12 times stiffer than the rotational spring that holds it, falls at k/(W h).
#[test]
fn counts_are_certain_where_doubles_are_not() {
    let (h, k, w) = (1.7, 11.0, 2.0);
    let mut bar = straight(h, 4, &[(0, [true, true, true, true, false, false])]);
    bar.sections[0] = CrossSection {
        e: 1e12 * k,
        ..section()
    };
    bar.springs = [Dof::Ry, Dof::Rz]
        .map(|dof| GroundSpring {
            point: 0,
            dof,
            stiffness: k,
        })
        .to_vec();
    let found = critical(&bar, &at_points(&[(4, [-w, 0.0, 0.0])]));
    assert!((found * w * h / k - 1.0).abs() < 1e-9, "{found}");
}

/// The same by a force on a rail above its members, which may stand between the nodes.
#[test]
fn force_on_a_rail_above_the_axis_turns_the_girder() {
    let (h, k, w, l) = (0.8, 30.0, 3.0, 2.0);
    let hold = [true, true, true, false, true, true];
    let mut m = straight(l, 1, &[(0, hold), (1, hold)]);
    m.sections[0].j = 1e9;
    m.springs = [0, 1]
        .map(|point| GroundSpring {
            point,
            dof: Dof::Rx,
            stiffness: 0.5 * k,
        })
        .to_vec();
    let mut rail = rail(&m);
    rail.segments[0].offset = [0.0, h, 0.0];
    let force = fea::RailForce {
        rail: 0,
        x: 0.5 * l,
        force: [0.0, -w, 0.0],
    };
    let state = preloaded(
        &m,
        &[rail],
        &Preload {
            rails: vec![force],
            ..Preload::default()
        },
    )
    .expect("stable");
    assert!(
        (state.critical.value() * w * h / k - 1.0).abs() < 1e-6,
        "{:?}",
        state.critical.value()
    );
}

/// Closed form: 3 (tan u - u)/u^3 at midspan, from any number of members, and order of convergence 4 of cubic elements with
/// the axial force at their chord is not needed: one member is exact. Values: Timoshenko and Gere (1961), section 1.3.
#[test]
fn grid_about_the_state_is_exact_with_one_member() {
    let l = 3.0;
    let euler = PI * PI / (l * l);
    for (p, known) in [
        (0.1, 1.10965),
        (0.5, 1.98629),
        (0.9, 9.87123),
        (-1.0, 0.505945),
        (-10.0, 0.0971106),
    ] {
        let u = 0.5 * PI * f64::abs(p).sqrt();
        let exact = if p > 0.0 { u.tan() - u } else { u - u.tanh() } * 3.0 / u.powi(3);
        for parts in [1, 2, 5] {
            let m = straight(l, parts, &[(0, PINNED), (parts, ROLLER)]);
            let rail = rail(&m);
            let state = preloaded(
                &m,
                std::slice::from_ref(&rail),
                &at_points(&[(parts, [-p * euler, 0.0, 0.0])]),
            )
            .expect("stable");
            let frame = FactoredFrame::new(&state.model, &[rail]).expect("stable");
            let at = [0.3, 0.5 * l, 2.1].map(vertical);
            let grid = frame.grid(&at).expect("on the rail");
            let ratio = grid.value[(1, 1)] * 48.0 / l.powi(3);
            assert!(
                (ratio / exact - 1.0).abs() < 1e-11,
                "{p} in {parts}: {ratio}, not {exact}"
            );
            assert!((ratio / known - 1.0).abs() < 5e-6);
            assert_eq!(grid.value, grid.value.transpose());
            assert!(
                grid.certificate.error_bound < 1e-11,
                "{:e}",
                grid.certificate.error_bound
            );
            let surface = frame.surface().expect("few states").surface;
            let mut out = splines::Influence::zeros(3);
            splines::Compliance::fill(&surface, &at, &mut out).expect("on the rail");
            assert!((out.value - &grid.value).abs().max() < 1e-11 * grid.value.max());
        }
    }
}

/// Closed form: the first frequency of the pinned beam is sqrt(1 - P/P_E) of that without P, mode n sqrt(1 - P/(n^2 P_E)); Clough
/// and Penzien, Dynamics of Structures (1993), section 18.
#[test]
fn frequencies_of_the_loaded_beam() {
    let (l, parts) = (3.0, 12);
    let euler = PI * PI / (l * l);
    let mut m = straight(l, parts, &[(0, PINNED), (parts, ROLLER)]);
    m.sections[0].mass = 2.0;
    m.sections[0].iy = 100.0;
    for p in [0.5, -2.0, 0.95] {
        let preload = at_points(&[(parts, [-p * euler, 0.0, 0.0])]);
        let state = preloaded(&m, &[], &preload).expect("stable");
        let found = fea::modes(&state.model, &[], 3).expect("it has mass");
        for (n, mode) in found.modes.iter().enumerate() {
            let n = (n + 1) as f64;
            let exact = (n * PI / l).powi(2) * (0.5_f64 * (1.0 - p / (n * n))).sqrt();
            assert!(
                (mode.omega / exact - 1.0).abs() < 2e-4 * n,
                "{p}, mode {n}: {} {exact}",
                mode.omega
            );
        }
    }
}

/// Identity: with a vanishing preload all numbers are those without one, to rounding.
#[test]
fn vanishing_preload_changes_nothing() {
    let m = portal(FIXED);
    let state = preloaded(
        &m,
        &[],
        &at_points(&[(1, [0.0, -1e-13, 0.0]), (2, [1e-13, -1e-13, 0.0])]),
    )
    .expect("stable");
    let [with, without] = [&state.model, &m].map(|m| {
        FactoredFrame::new(m, &[])
            .expect("stable")
            .point_compliance(&[1, 2])
            .expect("points")
    });
    for (a, b) in with.iter().zip(without.iter()) {
        assert!(
            (a - b).abs() < 1e-12 * without[(0, 0)].abs(),
            "{a}, not {b}"
        );
    }
}

/// Loads beyond the critical one, forces on what is not held and slack cables are refused by name.
#[test]
fn what_has_no_state_is_refused_by_name() {
    let m = straight(2.0, 1, &[(0, FIXED)]);
    let p = 1.1 * PI * PI / 16.0;
    match preloaded(&m, &[], &at_points(&[(1, [-p, 0.0, 0.0])])) {
        Err(Error::Buckled { factor, mode }) => {
            assert!((factor * 1.1 - 1.0).abs() < 1e-9, "{factor}");
            assert_eq!((mode.point, mode.member), (1, 0));
        }
        other => panic!("{other:?}"),
    }
    // Between fixed ends: a mode that no node shows.
    let fixed = straight(2.0, 1, &[(0, FIXED), (1, GUIDED)]);
    match preloaded(&fixed, &[], &at_points(&[(1, [-1.01 * PI * PI, 0.0, 0.0])])) {
        Err(Error::Buckled { factor, mode }) => {
            assert!(
                (factor * 1.01 - 1.0).abs() < 1e-9 && mode.between_ends,
                "{factor}"
            );
        }
        other => panic!("{other:?}"),
    }
    let mut free = straight(2.0, 1, &[(0, [false, true, true, true, true, true])]);
    free.sections[0].area = 0.0;
    let refused = Error::Invalid {
        entry: ModelEntry::PreloadForce(0),
        fault: EntryFault::NotHeld { dof: Dof::Ux },
    };
    assert_eq!(
        preloaded(&free, &[], &at_points(&[(1, [1.0, 0.0, 0.0])])).err(),
        Some(refused)
    );
    let mut cable = straight(2.0, 2, &[(0, FIXED), (2, FIXED)]);
    cable.members[1].kind = MemberKind::Cable;
    match preloaded(&cable, &[], &at_points(&[(1, [1.0, 0.0, 0.0])])) {
        Err(Error::Invalid {
            entry: ModelEntry::Member(1),
            fault: EntryFault::Slack { tension },
        }) => {
            assert!((tension + 0.5).abs() < 1e-6, "{tension}");
        }
        other => panic!("{other:?}"),
    }
    let mut sagging = cable;
    sagging.members[0].kind = MemberKind::Beam;
    (
        sagging.sections[0].mass,
        sagging.sections[0].iy,
        sagging.sections[0].iz,
    ) = (2.0, 1e3, 1e3);
    let preload = Preload {
        acceleration: [0.0, -1.0, 0.0],
        ..at_points(&[(1, [-3.0, 0.0, 0.0])])
    };
    assert!(matches!(
        preloaded(&sagging, &[], &preload),
        Err(Error::Invalid {
            fault: EntryFault::Sag { .. },
            ..
        })
    ));
}

/// Closed form: moment at midspan of the pinned beam under a unit load there, (L/4) tan u/u with u = (pi/2) sqrt(P/P_E); Timoshenko
/// and Gere (1961), section 1.3. Identity: dM/dx = -V, and reactions in equilibrium with the load and with P at the deflected place.
#[test]
fn internal_forces_are_those_of_the_deflected_member() {
    use fea::Effect;
    use splines::ForceComponent::{BendingZ, ShearY};
    let l = 3.0;
    let p = 0.6 * PI * PI / (l * l);
    let u = 0.5 * PI * 0.6_f64.sqrt();
    for parts in [1, 2] {
        let m = straight(l, parts, &[(0, PINNED), (parts, ROLLER)]);
        let rail = rail(&m);
        let state = preloaded(
            &m,
            std::slice::from_ref(&rail),
            &at_points(&[(parts, [-p, 0.0, 0.0])]),
        )
        .expect("stable");
        let frame = FactoredFrame::new(&state.model, &[rail]).expect("stable");
        let section = |x: f64, component| {
            let place = x / l * parts as f64;
            let member = (place as usize).min(parts - 1);
            Effect::InternalForce {
                member,
                place: place - member as f64,
                component,
            }
        };
        let load = vertical(0.5 * l);
        let at = |x: f64| {
            let effects = [section(x, BendingZ), section(x, ShearY)];
            let lines = frame
                .influence_lines(&state.model, &effects)
                .expect("sections");
            let mut out = [0.0; 2];
            lines.fill(load, &mut out).expect("on the rail");
            let by_load = frame
                .effects(&state.model, &effects, &[load])
                .expect("sections");
            assert!(
                (by_load[(0, 0)] - out[0]).abs() < 1e-11
                    && (by_load[(1, 0)] - out[1]).abs() < 1e-11
            );
            out
        };
        let [moment, _] = at(0.5 * l);
        assert!(
            (moment / (-0.25 * l * u.tan() / u) - 1.0).abs() < 1e-11,
            "{moment}"
        );
        for x in [0.2, 0.7, 1.3, 2.4] {
            let step = 1e-5;
            let slope = (at(x + step)[0] - at(x - step)[0]) * 0.5 / step;
            let [moment, shear] = at(x);
            assert!((slope + shear).abs() < 1e-8, "{slope} {shear}");
            // Moment of the part before the section: half of the load, and P at the deflection.
            let deflection = frame.grid(&[vertical(x), load]).expect("on the rail").value[(0, 1)];
            let static_moment = if x < 0.5 * l {
                -0.5 * x
            } else {
                -0.5 * (l - x)
            };
            assert!(
                (moment - (static_moment - p * deflection)).abs() < 1e-10,
                "{x}: {moment}"
            );
        }
        let reactions = frame.reactions(&state.model, &[load]).expect("on the rail");
        assert!((reactions.value.sum() + 1.0).abs() < 1e-11);
    }
}

/// Closed form: under its own weight the pinned beam with P has at midspan (w L^2/8) 2 (sec u - 1)/u^2 with u = (pi/2) sqrt(P/P_E), from
/// one member; Timoshenko and Gere (1961), section 1.4. Tension: the hyperbolic functions. Identity: one member and two agree elsewhere.
#[test]
fn own_weight_bends_the_loaded_member_as_published() {
    use fea::Effect;
    use splines::ForceComponent::{BendingZ, ShearY};
    let (l, w) = (3.0, 0.7);
    for share in [0.6, -1.5] {
        let p = share * PI * PI / (l * l);
        let u = 0.5 * PI * f64::abs(share).sqrt();
        let known = if share > 0.0 {
            2.0 * (1.0 / u.cos() - 1.0)
        } else {
            2.0 * (1.0 - 1.0 / u.cosh())
        } / (u * u);
        let values = [1, 2].map(|parts| {
            let mut m = straight(l, parts, &[(0, PINNED), (parts, ROLLER)]);
            m.sections[0].mass = w;
            let state = preloaded(&m, &[], &at_points(&[(parts, [-p, 0.0, 0.0])])).expect("stable");
            let frame = FactoredFrame::new(&state.model, &[]).expect("stable");
            let at = |x: f64, component| {
                let member = ((x * parts as f64) as usize).min(parts - 1);
                Effect::InternalForce {
                    member,
                    place: x * parts as f64 - member as f64,
                    component,
                }
            };
            let effects = [at(0.5, BendingZ), at(0.3, BendingZ), at(0.3, ShearY)];
            let weight = frame.weight(&state.model, [0.0, -1.0, 0.0]);
            frame
                .effects_of_weight(&state.model, &weight, &effects)
                .expect("sections")
        });
        let midspan = w * l * l / 8.0 * known;
        for own in &values {
            assert!(
                (own[0] / midspan - 1.0).abs() < 1e-11,
                "{share}: {}, not {midspan}",
                own[0]
            );
        }
        for (one, two) in values[0].iter().zip(&values[1]) {
            assert!((one / two - 1.0).abs() < 1e-10, "{share}: {one}, not {two}");
        }
    }
}

/// Identity: for given axial forces one member and three agree within the sum of their certified bounds, up to near buckling.
#[test]
fn certificate_bounds_the_error_for_given_axial_forces() {
    let l = 3.0;
    let euler = PI * PI / (l * l);
    for share in [-30.0, -1.0, 0.3, 0.9, 0.999] {
        let grids = [1, 3].map(|parts| {
            let mut m = straight(l, parts, &[(0, PINNED), (parts, ROLLER)]);
            m.members
                .iter_mut()
                .for_each(|member| member.tension = -share * euler);
            let rail = rail(&m);
            let frame = FactoredFrame::new(&m, &[rail]).expect("stable");
            frame
                .grid(&[0.25, 0.7, 1.5, 2.9].map(vertical))
                .expect("on the rail")
        });
        let bound = grids[0].certificate.error_bound + grids[1].certificate.error_bound;
        for i in 0..4 {
            for j in 0..4 {
                let [a, b] = [&grids[0], &grids[1]].map(|grid| grid.value[(i, j)]);
                let size = (grids[0].value[(i, i)] * grids[0].value[(j, j)]).sqrt();
                assert!(
                    (a - b).abs() <= bound * size,
                    "{share}: {:e} beyond {bound:e}",
                    (a - b).abs() / size
                );
            }
        }
    }
}

/// Ratios by hand for EI = 1: L sqrt(N/EI), M L/(pi sqrt(EI GJ)), N i_p^2/GJ, N/(G As).
#[test]
fn what_the_state_leaves_out_is_named_with_its_ratio() {
    let named = |m: &Model, forces: &[(usize, [f64; 3])]| {
        let state = preloaded(m, &[], &at_points(forces)).expect("stable");
        state
            .cautions
            .iter()
            .map(|own| (own.member, own.kind, own.ratio))
            .collect::<Vec<_>>()
    };
    let m = straight(3.0, 1, &[(0, FIXED), (1, GUIDED)]);
    let tension = |u: f64| [(1, [u * u / 9.0, 0.0, 0.0])];
    assert!(named(&m, &tension(24.9)).is_empty());
    let found = named(&m, &tension(30.0));
    assert!(
        matches!(found[..], [(0, CautionKind::Slender, ratio)] if (ratio - 30.0).abs() < 1e-9),
        "{found:?}"
    );
    // A cantilever of length 2 with the force 0.01 at its tip has the moment 0.02; GJ = 0.01.
    let mut m = straight(2.0, 1, &[(0, FIXED)]);
    m.sections[0].j = 0.01;
    let found = named(&m, &[(1, [0.0, -0.01, 0.0])]);
    let by_hand = 0.02 * 2.0 / (PI * 0.1);
    assert!(
        matches!(found[..], [(0, CautionKind::Moments, ratio)] if (ratio - by_hand).abs() < 1e-9),
        "{found:?}"
    );
    // i_p^2 = (Iy + Iz)/A = 0.2, and G As = 8.
    let mut m = straight(1.0, 1, &[(0, FIXED), (1, GUIDED)]);
    m.theory = BeamTheory::Timoshenko;
    let own = &mut m.sections[0];
    (own.area, own.g, own.j, own.shear_y, own.shear_z) = (10.0, 8.0, 0.125, Some(1.0), Some(1.0));
    let found = named(&m, &[(1, [1.6, 0.0, 0.0])]);
    let [
        (_, CautionKind::Twist, twist),
        (_, CautionKind::Shear, shear),
    ] = found[..]
    else {
        panic!("{found:?}")
    };
    assert!(
        (twist - 0.32).abs() < 1e-12 && (shear - 0.2).abs() < 1e-12,
        "{twist} {shear}"
    );
}
