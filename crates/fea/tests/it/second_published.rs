//! Problems of buckling and of beam-columns with published solutions, one member between the places where anything happens.
//!
//! Where the source gives an equation, its first root is found here; where it gives a number, that is compared.
//! TG: Timoshenko and Gere, Theory of Elastic Stability (1961). CL: Chen and Lui, Structural Stability (1987). LC: Livesley and
//! Chandler, Stability Functions for Structural Frameworks (1956).

use std::f64::consts::PI;

use fea::{
    BeamTheory, CriticalFactor, CrossSection, Dof, FactoredFrame, GroundSpring, Member, MemberKind,
    Model, Preload, Rail, RailSegment, Support, preloaded,
};
use nalgebra::DMatrix;
use splines::{Axis, Probe};

const FIXED: [bool; 6] = [true; 6];
const PINNED: [bool; 6] = [true, true, true, true, false, false];
const ROLLER: [bool; 6] = [false, true, true, true, false, false];
const FREE: [bool; 6] = [false; 6];
/// Free to move across the member in its x-y plane alone, held against turning.
const SWAYING: [bool; 6] = [false, false, true, true, true, true];

/// Members along x of the given lengths and second moments, E = 1 and stiff out of the x-y plane, and the supports of their points.
fn chain(parts: &[[f64; 2]], supports: &[[bool; 6]]) -> Model {
    let mut points = vec![[0.0; 3]];
    let mut sections = Vec::new();
    for [length, second] in parts {
        points.push([points[points.len() - 1][0] + length, 0.0, 0.0]);
        sections.push(CrossSection {
            e: 1.0,
            g: 1.0,
            area: 1e9,
            iy: 1e3,
            iz: *second,
            j: 1.0,
            ..CrossSection::default()
        });
    }
    Model {
        members: (0..parts.len())
            .map(|k| Member::beam([k, k + 1], k, [0.0, 1.0, 0.0]))
            .collect(),
        supports: supports
            .iter()
            .enumerate()
            .map(|(point, &fixed)| Support { point, fixed })
            .collect(),
        up: [0.0, 1.0, 0.0],
        points,
        sections,
        ..Model::default()
    }
}

fn pushed(forces: &[(usize, f64)]) -> Preload {
    Preload {
        points: forces
            .iter()
            .map(|&(point, p)| (point, [-p, 0.0, 0.0]))
            .collect(),
        ..Preload::default()
    }
}

/// The critical load of `m` under the force p at its last point.
fn critical(m: &Model, p: f64) -> f64 {
    critical_under(m, &pushed(&[(m.points.len() - 1, p)])) * p
}

fn critical_under(m: &Model, preload: &Preload) -> f64 {
    match preloaded(m, &[], preload).expect("stable").critical {
        CriticalFactor::At(factor, _) => factor,
        CriticalFactor::Above(_) => f64::INFINITY,
    }
}

/// The root of f between two places of different sign.
fn root(f: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    let below = f(low) < 0.0;
    assert_ne!(below, f(high) < 0.0, "a root between {low} and {high}");
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if (f(middle) < 0.0) == below {
            low = middle
        } else {
            high = middle
        }
    }
    0.5 * (low + high)
}

fn close(found: f64, known: f64, name: &str) {
    assert!(
        (found / known - 1.0).abs() < 2e-9,
        "{name}: {found}, not {known}"
    );
}

/// Stiffness of a compressed member of length and EI one against the rotation of one end, the other pinned and fixed; LC.
fn far_pinned(u: f64) -> f64 {
    u * u / (1.0 - u / u.tan())
}

fn far_fixed(u: f64) -> f64 {
    u * (u.sin() - u * u.cos()) / (2.0 * (1.0 - u.cos()) - u * u.sin())
}

/// TG 2.1 to 2.6, CL 2 and 4: columns with ends that sway, with springs, over supports and of two sections.
#[test]
fn columns_buckle_at_their_published_loads() {
    let one = [[1.0, 1.0]];
    close(
        critical(&chain(&one, &[FIXED, SWAYING]), 1.0),
        PI * PI,
        "fixed, swaying",
    );
    close(
        critical(&chain(&one, &[PINNED, SWAYING]), 0.5),
        PI * PI / 4.0,
        "pinned, swaying",
    );
    close(
        critical(
            &chain(&[[1.0, 1.0], [1.0, 1.0]], &[PINNED, ROLLER, ROLLER]),
            2.0,
        ),
        PI * PI,
        "two equal spans",
    );
    // Unequal spans: the stiffness of both sides of the middle support vanishes together; TG 2.6.
    let two = |p: f64| far_pinned(p.sqrt()) + far_pinned(0.6 * p.sqrt()) / 0.6;
    let known = root(two, [9.9, 20.0]);
    close(
        critical(
            &chain(&[[1.0, 1.0], [0.6, 1.0]], &[PINNED, ROLLER, ROLLER]),
            2.0,
        ),
        known,
        "two unequal spans",
    );
    // A cantilever on a rotational spring k: u tan u = k L/EI; CL 2.
    let known = root(|u| u * u.tan() - 1.0, [0.1, 1.5]).powi(2);
    let base = [true, true, true, true, true, false];
    let mut m = chain(&one, &[base, FREE]);
    m.springs.push(GroundSpring {
        point: 0,
        dof: Dof::Rz,
        stiffness: 1.0,
    });
    close(critical(&m, 0.2), known, "rotational spring at the base");
    assert!((known - 0.740_174).abs() < 1e-6);
    // A cantilever whose tip is held by a spring k across: tan u = u - u^3 EI/(k L^3); TG 2.3.
    let known = root(|u| u.sin() - (u - u.powi(3) / 10.0) * u.cos(), [1.7, 4.0]).powi(2);
    let mut m = chain(&one, &[FIXED, FREE]);
    m.springs.push(GroundSpring {
        point: 1,
        dof: Dof::Uy,
        stiffness: 10.0,
    });
    close(critical(&m, 1.0), known, "spring across the tip");
    // Two sections, 1 being the upper one: tan(k1 l1) tan(k2 l2) = k1/k2; TG 2.14.
    let (lower, upper) = ([0.6, 3.0], [0.4, 1.0]);
    let stepped = |p: f64| {
        let [a, b] = [f64::sqrt(p / lower[1]), f64::sqrt(p / upper[1])];
        (a * lower[0]).tan() * (b * upper[0]).tan() - b / a
    };
    close(
        critical(&chain(&[lower, upper], &[FIXED, FREE]), 1.0),
        root(stepped, [0.5, 7.0]),
        "stepped cantilever",
    );
    // The same with forces at the step and at the top, 1 being the upper part: tan(k1 l1) tan(k2 l2) = (k1/k2) (P1 + P2)/P1; TG 2.14.
    let both = |p: f64| {
        let [a, b] = [f64::sqrt(3.0 * p / lower[1]), f64::sqrt(p / upper[1])];
        (a * lower[0]).tan() * (b * upper[0]).tan() - b / a * 3.0
    };
    let m = chain(&[lower, upper], &[FIXED, FREE]);
    close(
        critical_under(&m, &pushed(&[(1, 2.0 * 0.3), (2, 0.3)])) * 0.3,
        root(both, [0.3, 6.0]),
        "two forces",
    );
}

/// Engesser's column with fixed ends and as a cantilever, TG 2.17: 1/P = 1/P_E + 1/(G As).
#[test]
fn shear_lowers_critical_loads_of_other_columns() {
    for (ends, euler) in [
        ([FIXED, ROLLER_GUIDED], 4.0 * PI * PI),
        ([FIXED, FREE], PI * PI / 4.0),
    ] {
        let mut m = chain(&[[1.0, 1.0]], &ends);
        m.theory = BeamTheory::Timoshenko;
        (m.sections[0].shear_y, m.sections[0].g) = (Some(15.0), 1.0);
        close(
            critical(&m, 0.4),
            1.0 / (1.0 / euler + 1.0 / 15.0),
            "Engesser",
        );
    }
}

const ROLLER_GUIDED: [bool; 6] = [false, true, true, true, true, true];

/// A portal in the x-y plane, P down on both columns; lengths and EI one.
fn portal(feet: [bool; 6], top: [bool; 6]) -> Model {
    let beam = |points| Member::beam(points, 0, [0.0, 0.0, 1.0]);
    let section = CrossSection {
        e: 1.0,
        g: 1.0,
        area: 1e9,
        iy: 1.0,
        iz: 1e3,
        j: 1.0,
        ..CrossSection::default()
    };
    let supports = [(0, feet), (3, feet), (1, top), (2, top)];
    Model {
        points: vec![[0.0; 3], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
        sections: vec![CrossSection { iy: 1.0, ..section }],
        members: vec![beam([0, 1]), beam([1, 2]), beam([2, 3])],
        supports: supports
            .iter()
            .map(|&(point, fixed)| Support { point, fixed })
            .collect(),
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    }
}

/// TG 2.4, CL 4: frames held against sway buckle with their beam bent to one side, whose end resists with 2 EI/L.
#[test]
fn braced_frames_buckle_at_their_published_loads() {
    let held = [true, false, true, true, true, false];
    let down = |p: f64| Preload {
        points: vec![(1, [0.0, -p, 0.0]), (2, [0.0, -p, 0.0])],
        ..Preload::default()
    };
    let hinged = [true, true, true, true, true, false];
    let known = root(|u| far_pinned(u) + 2.0, [3.2, 4.4]).powi(2);
    close(
        critical_under(&portal(hinged, held), &down(1.0)),
        known,
        "braced, hinged feet",
    );
    let known = root(|u| far_fixed(u) + 2.0, [4.6, 6.2]).powi(2);
    close(
        critical_under(&portal(FIXED, held), &down(1.0)),
        known,
        "braced, fixed feet",
    );
    assert!((known - 25.182).abs() < 1e-2, "{known}");
}

/// CL 4.8: a column that leans on a cantilever without load falls when P/L is what the cantilever resists, 3 EI/L^3; on a loaded
/// one when both share: the stiffness of the loaded tip is P u/(L (tan u - u)).
#[test]
fn leaning_columns_fall_on_what_holds_them() {
    let section = CrossSection {
        e: 1.0,
        g: 1.0,
        area: 1e9,
        iy: 1.0,
        iz: 1.0,
        j: 1.0,
        ..CrossSection::default()
    };
    let post = |points, kind| Member {
        kind,
        ..Member::beam(points, 0, [0.0, 0.0, 1.0])
    };
    let plane = [false, false, true, true, true, false];
    let hinge = [true, true, true, true, true, true];
    let m = Model {
        points: vec![[0.0; 3], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]],
        sections: vec![section],
        members: vec![
            post([0, 1], MemberKind::Beam),
            post([2, 3], MemberKind::Truss),
            post([1, 3], MemberKind::Truss),
        ],
        supports: [
            (0, FIXED),
            (1, plane),
            (2, hinge),
            (3, [false, false, true, true, true, true]),
        ]
        .map(|(point, fixed)| Support { point, fixed })
        .to_vec(),
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    };
    let on = |a: f64, b: f64| Preload {
        points: vec![(1, [0.0, -a, 0.0]), (3, [0.0, -b, 0.0])],
        ..Preload::default()
    };
    let found = critical_under(&m, &on(0.0, 1.0));
    assert!((found / 3.0 - 1.0).abs() < 1e-7, "{found}");
    let both = |p: f64| {
        let u = p.sqrt();
        u / (u.tan() - u) - 1.0
    };
    let found = critical_under(&m, &on(0.5, 0.5)) * 0.5;
    assert!(
        (found / root(both, [0.5, 2.4]) - 1.0).abs() < 1e-7,
        "{found}"
    );
}

/// Compliance of points of a chain under the force p (compression) at its last point.
fn compliance(m: &Model, p: f64, points: &[usize]) -> DMatrix<f64> {
    let state = preloaded(m, &[], &pushed(&[(m.points.len() - 1, p)])).expect("stable");
    FactoredFrame::new(&state.model, &[])
        .and_then(|frame| frame.point_compliance(points))
        .expect("points")
}

/// TG 1.3, 1.5, 1.7 and 1.11: deflections and rotations of beam-columns under forces and moments.
#[test]
fn beam_columns_deflect_as_published() {
    let (v, r) = (Dof::Uy as usize, Dof::Rz as usize);
    let one = [[1.0, 1.0]];
    // Cantilever, u = k L: tip force 3 (tan u - u)/u^3, tip moment 2 (1 - cos u)/(u^2 cos u), rotation tan u/u.
    let u = 1.1_f64;
    let c = compliance(&chain(&one, &[FIXED, FREE]), u * u, &[1]);
    close(
        c[(v, v)] * 3.0,
        3.0 * (u.tan() - u) / u.powi(3),
        "tip force",
    );
    close(
        c[(v, r)] * 2.0,
        2.0 * (1.0 - u.cos()) / (u * u * u.cos()),
        "tip moment",
    );
    close(c[(r, r)], u.tan() / u, "rotation under a tip moment");
    // Cantilever tie: 2 (cosh u - 1)/(u^2 cosh u) and tanh u/u.
    let c = compliance(&chain(&one, &[FIXED, FREE]), -u * u, &[1]);
    close(
        c[(v, r)] * 2.0,
        2.0 * (u.cosh() - 1.0) / (u * u * u.cosh()),
        "tip moment in tension",
    );
    close(c[(r, r)], u.tanh() / u, "rotation in tension");
    // Pinned, 2 u = k L: end rotations M L/(3 EI) psi and M L/(6 EI) phi.
    let u = 0.9_f64;
    let c = compliance(&chain(&one, &[PINNED, ROLLER]), 4.0 * u * u, &[0, 1]);
    let psi = 1.5 / u * (0.5 / u - 1.0 / (2.0 * u).tan());
    let phi = 3.0 / u * (1.0 / (2.0 * u).sin() - 0.5 / u);
    close(c[(r, r)] * 3.0, psi, "psi");
    close(-c[(r, 6 + r)] * 6.0, phi, "phi");
    // Fixed at both ends, 2 u = k L, unit force at midspan: 12 (2 tan(u/2) - u)/u^3 times L^3/(192 EI).
    let u = 2.0_f64;
    let m = chain(&[[0.5, 1.0], [0.5, 1.0]], &[FIXED, FREE, ROLLER_GUIDED]);
    let c = compliance(&m, 4.0 * u * u, &[1]);
    close(
        c[(v, v)] * 192.0,
        12.0 * (2.0 * (0.5 * u).tan() - u) / u.powi(3),
        "fixed ends",
    );
    // A force at the fraction a of a pinned beam: sin(k a) sin(k b)/(P k sin k) - a b/P at its place; TG 1.3.
    let (k, a) = (2.2_f64, 0.3);
    let c = compliance(
        &chain(&[[a, 1.0], [1.0 - a, 1.0]], &[PINNED, FREE, ROLLER]),
        k * k,
        &[1],
    );
    let known =
        (k * a).sin() * (k * (1.0 - a)).sin() / (k.powi(3) * k.sin()) - a * (1.0 - a) / (k * k);
    close(c[(v, v)], known, "force at a third");
}

/// TG 1.4 and 1.11: a uniform load on the pinned beam, by the influence function between the nodes of one member: midspan 5/384 times
/// 12 (2 sec u - 2 - u^2)/(5 u^4), and in tension (sech u - 1 + u^2/2)/(5 u^4/24).
#[test]
fn uniform_load_is_the_integral_of_the_influence_function() {
    const GAUSS: [[f64; 2]; 4] = [
        [0.183_434_642_495_649_8, 0.362_683_783_378_362],
        [0.525_532_409_916_329, 0.313_706_645_877_887_3],
        [0.796_666_477_413_626_7, 0.222_381_034_453_374_48],
        [0.960_289_856_497_536_3, 0.101_228_536_290_376_26],
    ];
    let m = chain(&[[1.0, 1.0]], &[PINNED, ROLLER]);
    let segments = vec![RailSegment {
        member: 0,
        offset: [0.0; 3],
    }];
    let rail = Rail {
        axis: [1.0, 0.0, 0.0],
        segments,
        ..Rail::default()
    };
    let at = |x: f64| Probe {
        rail: 0,
        x,
        axis: Axis::Vertical,
    };
    for p in [6.0_f64, -20.0] {
        let u = 0.5 * p.abs().sqrt();
        let known = if p > 0.0 {
            12.0 * (2.0 / u.cos() - 2.0 - u * u) / (5.0 * u.powi(4))
        } else {
            (1.0 / u.cosh() - 1.0 + 0.5 * u * u) * 24.0 / (5.0 * u.powi(4))
        };
        let state = preloaded(&m, std::slice::from_ref(&rail), &pushed(&[(1, p)])).expect("stable");
        let frame = FactoredFrame::new(&state.model, std::slice::from_ref(&rail)).expect("stable");
        let mut sum = 0.0;
        for [place, weight] in GAUSS.into_iter().flat_map(|[x, w]| [[x, w], [-x, w]]) {
            for part in 0..4 {
                let x = (f64::from(part) + 0.5 * (1.0 + place)) / 4.0;
                sum += weight / 8.0
                    * frame.grid(&[at(0.5), at(x)]).expect("on the rail").value[(0, 1)];
            }
        }
        close(sum * 384.0 / 5.0, known, "uniform load");
    }
}

/// Two taut cables from a point resist a force across them with T (1/a + 1/b); Irvine, Cable Structures (1981), section 2.
#[test]
fn taut_cables_resist_across() {
    let (a, b, t) = (1.5, 2.5, 40.0);
    let mut m = chain(
        &[[a, 1.0], [b, 1.0]],
        &[FIXED, FREE, [false, true, true, true, true, true]],
    );
    m.members
        .iter_mut()
        .for_each(|member| member.kind = MemberKind::Cable);
    let state = preloaded(&m, &[], &pushed(&[(2, -t)])).expect("taut");
    let c = FactoredFrame::new(&state.model, &[])
        .and_then(|frame| frame.point_compliance(&[1]))
        .expect("a point");
    close(1.0 / c[(1, 1)], t * (1.0 / a + 1.0 / b), "across");
    close(
        1.0 / c[(2, 2)],
        t * (1.0 / a + 1.0 / b),
        "across, the other way",
    );
}

/// Errors of cubic elements with the consistent geometric stiffness, P/P_E = 0.5, for midspan of the pinned beam: 3.5e-3, 2.5e-4, 1.6e-5
/// and 1.0e-6 with 2, 4, 8 and 16 elements, order 4, where one member here has none. Przemieniecki, Theory of Matrix Structural
/// Analysis (1968), section 15.1.
#[test]
fn one_member_replaces_many_cubic_elements() {
    let p = 0.5 * PI * PI;
    let exact = compliance(&chain(&[[0.5, 1.0]; 2], &[PINNED, FREE, ROLLER]), p, &[1])[(1, 1)];
    let errors = [2_usize, 4, 8, 16].map(|n| {
        let h = 1.0 / n as f64;
        let mut k = DMatrix::<f64>::zeros(2 * n + 2, 2 * n + 2);
        let bending = [
            [12.0, 6.0, -12.0, 6.0],
            [6.0, 4.0, -6.0, 2.0],
            [-12.0, -6.0, 12.0, -6.0],
            [6.0, 2.0, -6.0, 4.0],
        ];
        let geometric = [
            [36.0, 3.0, -36.0, 3.0],
            [3.0, 4.0, -3.0, -1.0],
            [-36.0, -3.0, 36.0, -3.0],
            [3.0, -1.0, -3.0, 4.0],
        ];
        for e in 0..n {
            for i in 0..4 {
                for j in 0..4 {
                    let unit = h.powi((i % 2) as i32 + (j % 2) as i32);
                    k[(2 * e + i, 2 * e + j)] +=
                        unit * (bending[i][j] / h.powi(3) - p * geometric[i][j] / (30.0 * h));
                }
            }
        }
        let free: Vec<usize> = (0..2 * n + 2).filter(|&k| k != 0 && k != 2 * n).collect();
        let reduced = DMatrix::from_fn(free.len(), free.len(), |i, j| k[(free[i], free[j])]);
        let at = free
            .iter()
            .position(|&k| k == n)
            .expect("the middle node is free");
        (1.0 - reduced.try_inverse().expect("stable")[(at, at)] / exact).abs()
    });
    for (error, known) in errors.iter().zip([3.5e-3, 2.5e-4, 1.6e-5, 1.0e-6]) {
        assert!((error / known - 1.0).abs() < 0.06, "{errors:?}");
    }
    assert!(
        errors
            .windows(2)
            .all(|pair| ((pair[0] / pair[1]).log2() - 4.0).abs() < 0.25),
        "{errors:?}"
    );
}
