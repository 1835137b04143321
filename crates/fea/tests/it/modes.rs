//! Natural modes against closed forms.

use common::near::assert_near;
use std::f64::consts::PI;

use fea::{
    BeamTheory, CrossSection, Dof, DofSet, Error, GroundSpring, Member, MemberKind, Model, Modes,
    PointMass, Rail, RailSegment, RigidLink, Support, modes, refined_modes,
};
use splines::{Axis, Probe};

use crate::common;

const L: f64 = 7.3;
const FIXED: DofSet = [true; 6];

/// A steel box with all stiffnesses and mass.
fn section() -> CrossSection {
    CrossSection {
        e: 2.1e11,
        g: 8.1e10,
        area: 0.013,
        iy: 3.1e-5,
        iz: 8.7e-5,
        j: 2.3e-5,
        shear_y: Some(0.0061),
        shear_z: Some(0.0047),
        mass: 111.0,
    }
}

fn beam(points: [usize; 2]) -> Member {
    Member::beam(points, 0, [0.0, 1.0, 0.0])
}

/// A straight chain of equal members along x; `ends` are the fixed degrees of freedom of its ends.
fn chain(count: usize, theory: BeamTheory, ends: [DofSet; 2]) -> Model {
    let mut model = Model {
        up: [0.0, 1.0, 0.0],
        theory,
        ..Model::default()
    };
    model.sections.push(section());
    for k in 0..=count {
        model.points.push([L * k as f64 / count as f64, 0.0, 0.0]);
    }
    model.members.extend((0..count).map(|k| beam([k, k + 1])));
    for (fix, point) in ends.into_iter().zip([0, count]) {
        if fix.contains(&true) {
            model.supports.push(Support { point, fixed: fix });
        }
    }
    model
}

/// A chain that can bend only in its x-y plane.
fn plane(count: usize, theory: BeamTheory, ends: [DofSet; 2]) -> Model {
    let mut model = chain(count, theory, ends);
    let fix = [true, false, true, true, true, false];
    model
        .supports
        .extend((0..=count).map(|point| Support { point, fixed: fix }));
    model
}

const PINNED: DofSet = [false, true, false, false, false, false];
const FREE: DofSet = [false; 6];

/// The rail along the whole chain, and its modes.
fn solve(model: &Model, count: usize) -> Modes {
    let segments = (0..model.members.len())
        .map(|member| RailSegment {
            member,
            offset: [0.0; 3],
        })
        .collect();
    let rail = Rail {
        origin: [0.0; 3],
        axis: [1.0, 0.0, 0.0],
        segments,
        stations: vec![0.0, L],
    };
    modes(model, &[rail], count).expect("sound")
}

fn omega(model: &Model, mode: usize) -> f64 {
    solve(model, mode + 1).modes[mode].omega
}

/// Root of a function that changes its sign between two numbers.
fn root(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    assert!(f(a) * f(b) < 0.0, "no change of sign between {a} and {b}");
    for _ in 0..200 {
        let middle = 0.5 * (a + b);
        if f(a) * f(middle) <= 0.0 {
            b = middle
        } else {
            a = middle
        }
    }
    0.5 * (a + b)
}

/// omega = k^2 sqrt(EI/m) of an Euler-Bernoulli beam, by its k L.
fn bending(kl: f64) -> f64 {
    let s = section();
    (kl / L).powi(2) * (s.e * s.iz / s.mass).sqrt()
}

/// Source: Blevins, Formulas for Natural Frequency and Mode Shape (1979), table 8-1.
fn roots(ends: &str) -> Vec<f64> {
    let characteristic = move |x: f64, ends: &str| match ends {
        "clamped-free" => x.cos() + 1.0 / x.cosh(),
        "clamped-clamped" => x.cos() - 1.0 / x.cosh(),
        _ => x.tan() - x.tanh(),
    };
    (1..=3)
        .map(|k| {
            let k = f64::from(k);
            match ends {
                "pinned-pinned" => k * PI,
                "clamped-free" => root(|x| characteristic(x, ends), (k - 1.0) * PI + 1e-9, k * PI),
                "clamped-clamped" => {
                    root(|x| characteristic(x, ends), k * PI, (k + 1.0) * PI - 0.1)
                }
                _ => root(|x| characteristic(x, ends), k * PI + 0.01, (k + 0.49) * PI),
            }
        })
        .collect()
}

#[test]
fn frequencies_of_uniform_beams_converge_with_order_four() {
    let cases = [
        ("pinned-pinned", [PINNED, PINNED]),
        ("clamped-free", [FIXED, FREE]),
        ("clamped-clamped", [FIXED, FIXED]),
        ("clamped-pinned", [FIXED, PINNED]),
    ];
    for (name, ends) in cases {
        for (mode, kl) in roots(name).into_iter().enumerate() {
            let exact = bending(kl);
            let errors = [4, 8, 16, 32].map(|count| {
                omega(&plane(count, BeamTheory::EulerBernoulli, ends), mode) / exact - 1.0
            });
            assert!(
                errors.iter().all(|&error| error > 0.0),
                "{name} {mode}: not from above {errors:?}"
            );
            for pair in errors.windows(2).skip(usize::from(mode > 0)) {
                let order = (pair[0] / pair[1]).log2();
                println!(
                    "{name} mode {mode}: {:.2e} -> {:.2e}, order {order:.3}",
                    pair[0], pair[1]
                );
                assert!(
                    (order - 4.0).abs() < 0.25,
                    "{name} mode {mode}: order {order} of {errors:?}"
                );
            }
        }
    }
}

/// Lowest root of the frequency equation of a pinned Timoshenko beam that bends in `mode` + 1 half waves:
/// EI k^4 - (m + (r + m EI / GAs) k^2) omega^2 + m r / GAs omega^4 = 0, r = m I / A.
///
/// Source: Cowper (1966), J. Appl. Mech. 33; Huang (1961), J. Appl. Mech. 28.
fn sheared(mode: usize) -> f64 {
    let s = section();
    let k = (mode + 1) as f64 * PI / L;
    let (ei, gas, r) = (
        s.e * s.iz,
        s.g * s.shear_y.expect("given"),
        s.mass * s.iz / s.area,
    );
    let (a, b, c) = (
        s.mass * r / gas,
        s.mass + (r + s.mass * ei / gas) * k * k,
        ei * k.powi(4),
    );
    (2.0 * c / (b + (b * b - 4.0 * a * c).sqrt())).sqrt()
}

/// In an element the shapes without load and under a uniform load leave out two parts of the inertia: of the force its
/// linear part, whose shear makes 1/omega^2 too small by the fraction m omega^2 k^2 h^4 / (720 GAs), and the moment of
/// the rotation, by m omega^2 r^4 k^2 h^2 / (12 EI).
#[test]
fn frequencies_of_sheared_beams_err_by_the_inertia_left_out_within_elements() {
    let s = section();
    let (gas, ei) = (s.g * s.shear_y.expect("given"), s.e * s.iz);
    for mode in 0..4 {
        let exact = sheared(mode);
        for count in [8, 16, 32] {
            let h = L / count as f64;
            let error = omega(
                &plane(count, BeamTheory::Timoshenko, [PINNED, PINNED]),
                mode,
            ) / exact
                - 1.0;
            let wave = ((mode + 1) as f64 * PI / L).powi(2);
            let gyration = s.iz / s.area;
            let inertia = exact * exact * s.mass * wave;
            let expected = inertia * h.powi(4) / (1440.0 * gas)
                + inertia * gyration * gyration * h * h / (24.0 * ei);
            println!(
                "Timoshenko mode {mode}, {count} elements: {error:.3e}, expected {expected:.3e}"
            );
            // The parts are leading terms; they are coupled.
            assert!(
                error > 0.9 * expected && error < 1.4 * expected,
                "{mode} {count}: {error} {expected}"
            );
        }
    }
}

/// omega^2 = 6 c^2 (1 - cos k h) / (h^2 (2 + cos k h)) of a chain of linear elements with consistent mass.
///
/// Source: Hughes, The Finite Element Method (1987), section 9.1.
fn dispersion(c: f64, k: f64, h: f64) -> f64 {
    c / h * (6.0 * (1.0 - (k * h).cos()) / (2.0 + (k * h).cos())).sqrt()
}

#[test]
fn rods_follow_the_dispersion_of_linear_elements() {
    let s = section();
    let count = 9;
    let h = L / count as f64;
    let speeds = [
        (s.e * s.area / s.mass).sqrt(),
        (s.g * s.j / (s.mass * (s.iy + s.iz) / s.area)).sqrt(),
    ];
    for (freedom, speed) in [0, 3].into_iter().zip(speeds) {
        let mut model = chain(count, BeamTheory::EulerBernoulli, [FIXED, FREE]);
        let fix = std::array::from_fn(|k| k != freedom);
        model
            .supports
            .extend((0..=count).map(|point| Support { point, fixed: fix }));
        let solved = solve(&model, count);
        assert_eq!(
            (solved.modes.len(), solved.count_below_shift, solved.next),
            (count, count, None)
        );
        for (mode, found) in solved.modes.iter().enumerate() {
            let exact = dispersion(speed, (mode as f64 + 0.5) * PI / L, h);
            assert!(
                (found.omega / exact - 1.0).abs() < 1e-12,
                "{freedom}, {mode}: {} {exact}",
                found.omega
            );
            assert!(found.residual < 1e-14, "residual {}", found.residual);
        }
    }
}

#[test]
fn a_mass_at_the_tip_of_a_cantilever_has_its_transcendental_roots() {
    let s = section();
    for ratio in [0.1, 1.0, 20.0] {
        let mut model = plane(24, BeamTheory::EulerBernoulli, [FIXED, FREE]);
        let mass = ratio * s.mass * L;
        model.masses.push(PointMass {
            point: 24,
            mass,
            inertia: [0.0; 3],
            offset: [0.0; 3],
        });
        let solved = solve(&model, 3);
        // 1 + cos x cosh x + mu x (cos x sinh x - sin x cosh x) = 0, divided by cosh x.
        let f = |x: f64| 1.0 / x.cosh() + x.cos() + ratio * x * (x.cos() * x.tanh() - x.sin());
        for (mode, found) in solved.modes.iter().enumerate() {
            let at = mode as f64 * PI;
            let exact = bending(root(f, at + 1e-6, at + PI));
            assert!(
                (found.omega / exact - 1.0).abs() < 1e-5,
                "{ratio}, {mode}: {} {exact}",
                found.omega
            );
        }
    }
}

/// The frequency of a mass M at midspan of a pinned beam is lower than on a massless one by 1/2 m / M, where m
/// is 17/35 of the mass of the beam.
///
/// Source: Rayleigh, The Theory of Sound (1877), section 182: the static shape.
#[test]
fn a_heavy_mass_at_midspan_moves_half_of_17_35ths_of_the_beam() {
    let s = section();
    let mut model = plane(24, BeamTheory::EulerBernoulli, [PINNED, PINNED]);
    let mass = 50.0 * s.mass * L;
    model.masses.push(PointMass {
        point: 12,
        mass,
        inertia: [0.0; 3],
        offset: [0.0; 3],
    });
    let alone = (48.0 * s.e * s.iz / L.powi(3) / mass).sqrt();
    let shift = 1.0 - omega(&model, 0) / alone;
    let what = "mass of 50 beams at midspan: beam's share that moves with it, of 2 M times the shift of frequency";
    assert_near(
        what,
        "Rayleigh, 17/35",
        17.0 / 35.0,
        2.0 * shift * mass / (s.mass * L),
        0.02,
    );
}

/// Source: Meirovitch, Analytical Methods in Vibrations (1967), section 5-10, for one beam and one mass.
#[test]
fn a_massless_beam_leaves_the_modes_of_its_mass_alone() {
    let mut model = chain(5, BeamTheory::EulerBernoulli, [FIXED, FREE]);
    model.sections[0].mass = 0.0;
    model.masses.push(PointMass {
        point: 5,
        mass: 40.0,
        inertia: [0.0; 3],
        offset: [0.0; 3],
    });
    let s = section();
    let solved = solve(&model, 10);
    let mut exact = [
        3.0 * s.e * s.iy / L.powi(3),
        3.0 * s.e * s.iz / L.powi(3),
        s.e * s.area / L,
    ]
    .map(|stiffness| (stiffness / 40.0).sqrt());
    exact.sort_by(f64::total_cmp);
    assert_eq!((solved.modes.len(), solved.next), (3, None));
    for (found, exact) in solved.modes.iter().zip(exact) {
        assert!(
            (found.omega / exact - 1.0).abs() < 1e-11,
            "{} {exact}",
            found.omega
        );
    }
}

#[test]
fn a_mass_on_springs_has_the_modes_of_two_by_two() {
    // One point on a vertical spring and one about z; the mass sits 0.7 to its side.
    let (k, kr, mass, inertia, arm) = (3.0e4, 5.0e4, 12.0, 2.5, 0.7);
    let mut model = Model {
        points: vec![[2.0, 1.0, 0.0]],
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    };
    model.supports.push(Support {
        point: 0,
        fixed: [true, false, true, true, true, false],
    });
    model.springs.push(GroundSpring {
        point: 0,
        dof: Dof::Uy,
        stiffness: k,
    });
    model.springs.push(GroundSpring {
        point: 0,
        dof: Dof::Rz,
        stiffness: kr,
    });
    model.masses.push(PointMass {
        point: 0,
        mass,
        inertia: [0.0, 0.0, inertia],
        offset: [arm, 0.0, 0.0],
    });
    let solved = modes(&model, &[], 2).expect("sound");
    // M = [[m, m a], [m a, I + m a^2]], K = diag(k, kr).
    let about = inertia + mass * arm * arm;
    let (a, b, c) = (mass * inertia, k * about + kr * mass, k * kr);
    let root = (b * b - 4.0 * a * c).sqrt();
    let exact = [2.0 * c / (b + root), (b + root) / (2.0 * a)].map(f64::sqrt);
    for (found, exact) in solved.modes.iter().zip(exact) {
        assert!(
            (found.omega / exact - 1.0).abs() < 1e-13,
            "{} {exact}",
            found.omega
        );
    }
    let coupling: f64 = solved
        .modes
        .iter()
        .map(|mode| mode.coupling[1].powi(2))
        .sum();
    assert!((coupling / mass - 1.0).abs() < 1e-13);
    assert_eq!(solved.rigid_mass[1][1], mass);
    assert!((solved.rigid_mass[1][5] / (mass * 2.7) - 1.0).abs() < 1e-14);
}

/// A portal with a bracket, rotated in space. With `arms` the bracket is rigid offsets, otherwise linked points.
fn bracket(arms: bool, turn: bool) -> Model {
    let mut model = Model {
        up: [0.0, 1.0, 0.0],
        theory: BeamTheory::Timoshenko,
        ..Model::default()
    };
    model.sections.push(section());
    model.points = vec![
        [0.0, 0.0, 0.0],
        [0.0, 4.0, 0.0],
        [5.0, 4.0, 0.0],
        [5.0, 0.0, 0.0],
        [2.5, 4.0, 0.0],
    ];
    let offset = [0.4, 0.3, -0.2];
    let column = |points, turned: [f64; 3]| Member {
        orientation: turned,
        ..beam(points)
    };
    model.members.push(column([0, 1], [0.3, 0.0, 1.0]));
    model.members.push(column([3, 2], [1.0, 0.0, 0.0]));
    if arms {
        model.members.push(Member {
            offsets: [offset, [0.0; 3]],
            ..beam([1, 4])
        });
        model.members.push(Member {
            offsets: [[0.0; 3], [0.0, 0.3, -0.2]],
            ..beam([4, 2])
        });
    } else {
        model.points.push([0.4, 4.3, -0.2]);
        model.points.push([5.0, 4.3, -0.2]);
        model.links.push(RigidLink { from: 1, to: 5 });
        model.links.push(RigidLink { from: 6, to: 2 });
        model.members.extend([beam([5, 4]), beam([4, 6])]);
    }
    model.masses.push(PointMass {
        point: 4,
        mass: 70.0,
        inertia: [3.0, 3.0, 3.0],
        offset: [0.1, -0.5, 0.2],
    });
    model.supports.extend([0, 3].map(|point| Support {
        point,
        fixed: FIXED,
    }));
    if turn {
        let turned = |v: [f64; 3]| {
            let rotation = nalgebra::Rotation3::from_euler_angles(0.3, -1.1, 2.2);
            let out: [f64; 3] = (rotation * nalgebra::Vector3::from(v)).into();
            out
        };
        model
            .points
            .iter_mut()
            .for_each(|point| *point = turned(*point));
        for member in &mut model.members {
            member.orientation = turned(member.orientation);
            member.offsets = member.offsets.map(turned);
        }
        model.masses[0].offset = turned(model.masses[0].offset);
    }
    model
}

#[test]
fn rigid_arms_are_rigid_links_and_directions_do_not_matter() {
    let [arms, links, turned] = [(true, false), (false, false), (true, true)]
        .map(|(arms, turn)| modes(&bracket(arms, turn), &[], 14).expect("sound"));
    for (k, mode) in arms.modes.iter().enumerate() {
        assert!(
            (links.modes[k].omega / mode.omega - 1.0).abs() < 1e-11,
            "mode {k}"
        );
        assert!(
            (turned.modes[k].omega / mode.omega - 1.0).abs() < 1e-11,
            "mode {k}"
        );
    }
    // The beam is as long as before: the ends of the rigid offsets are the linked points.
    assert!((links.rigid_mass[0][0] / arms.rigid_mass[0][0] - 1.0).abs() < 1e-14);
}

#[test]
fn hinged_ends_of_a_clamped_chain_are_pins() {
    let errors = [8, 16, 32].map(|count| {
        let mut model = plane(count, BeamTheory::EulerBernoulli, [FIXED, FIXED]);
        model.members[0].releases[0][Dof::Rz as usize] = true;
        model.members[count - 1].releases[1][Dof::Rz as usize] = true;
        omega(&model, 0) / bending(PI) - 1.0
    });
    println!("hinges: {errors:?}");
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1]).log2() > 3.8, "{errors:?}");
    }
}

#[test]
fn shapes_along_the_rail_are_sines_and_effective_masses_theirs() {
    let s = section();
    let solved = solve(&plane(24, BeamTheory::EulerBernoulli, [PINNED, PINNED]), 3);
    let mass = s.mass * L;
    for x in [0.0, 0.11 * L, 0.3 * L, 0.52 * L, L] {
        let at = solved
            .at(Probe {
                rail: 0,
                x,
                axis: Axis::Vertical,
            })
            .expect("on the rail");
        for (k, &[value, slope]) in at.iter().enumerate() {
            let wave = (k + 1) as f64 * PI / L;
            let sign = solved.modes[k].states[1][1].signum();
            let size = sign * (2.0 / mass).sqrt();
            assert!(
                (value - size * (wave * x).sin()).abs() < 1e-4 * size.abs(),
                "mode {k} at {x}"
            );
            assert!((slope - size * wave * (wave * x).cos()).abs() < 1e-3 * wave * size.abs());
        }
    }
    for (k, mode) in solved.modes.iter().enumerate() {
        let n = (k + 1) as f64;
        let exact = if k % 2 == 0 {
            8.0 / (n * PI).powi(2) * mass
        } else {
            0.0
        };
        assert!(
            (mode.coupling[1].powi(2) - exact).abs() < 1e-5 * mass,
            "mode {k}"
        );
    }
    let total = solved.rigid_mass;
    let exact = [
        (1, 1, mass),
        (0, 0, mass),
        (1, 5, 0.5 * mass * L),
        (5, 5, mass * L * L / 3.0),
    ];
    for (i, j, exact) in exact {
        assert!(
            (total[i][j] / exact - 1.0).abs() < 1e-13,
            "{i} {j}: {} {exact}",
            total[i][j]
        );
    }
}

#[test]
fn effective_masses_of_all_modes_add_up_to_what_can_move() {
    // A cantilever whose clamped node carries half an element and nothing else.
    let model = chain(20, BeamTheory::Timoshenko, [FIXED, FREE]);
    // Six unknowns for each element, and its deflections under its own inertia in two planes.
    let solved = solve(&model, 160);
    assert_eq!((solved.modes.len(), solved.next), (160, None));
    let mass = section().mass * L;
    for axis in 0..3 {
        let sum: f64 = solved
            .modes
            .iter()
            .map(|mode| mode.coupling[axis].powi(2))
            .sum();
        // Shapes that are zero at the clamp lack a part of the rigid motion of the first element.
        assert!(sum < mass && sum > 0.98 * mass, "{axis}: {sum} of {mass}");
    }
}

#[test]
fn residual_flexibility_is_what_the_series_leaves() {
    let model = plane(24, BeamTheory::EulerBernoulli, [PINNED, PINNED]);
    let segments = (0..24)
        .map(|member| RailSegment {
            member,
            offset: [0.0; 3],
        })
        .collect();
    let rail = Rail {
        origin: [0.0; 3],
        axis: [1.0, 0.0, 0.0],
        segments,
        stations: vec![],
    };
    let frame = fea::FactoredFrame::new(&model, &[rail]).expect("sound");
    let exact = frame.surface().expect("one rail").surface;
    let mid = [Probe {
        rail: 0,
        x: 0.5 * L,
        axis: Axis::Vertical,
    }];
    let full = compliance(&exact, &mid)[(0, 0)];
    for count in [1, 2, 3, 5, 9] {
        let modes = frame.modes(&model, count).expect("sound");
        let rest = modes.residual(&exact).expect("same frame");
        // G(L/2, L/2) = 2 L^3 / (EI pi^4) sum over odd n of 1/n^4 = L^3 / 48 EI.
        let sum: f64 = (1..=count)
            .step_by(2)
            .map(|n| 96.0 / (n as f64 * PI).powi(4))
            .sum();
        let share = compliance(&rest, &mid)[(0, 0)] / full;
        println!("{count} modes leave {share:.3e} of the flexibility at midspan");
        assert!(
            (share - (1.0 - sum)).abs() < 4e-6,
            "{count}: {share} {}",
            1.0 - sum
        );
        if count == 1 {
            let what = "give at midspan that one mode leaves, by all";
            assert_near(what, "prototype", 0.0145, share, 0.01);
        }
        let probes: Vec<Probe> = (0..40)
            .map(|k| Probe {
                rail: 0,
                x: (k as f64 + 0.3) * L / 40.0,
                axis: Axis::Vertical,
            })
            .collect();
        let least = compliance(&rest, &probes).symmetric_eigenvalues().min();
        assert!(least > -1e-14 * full, "{count}: {least}");
    }
}

fn compliance(surface: &impl splines::Compliance, at: &[Probe]) -> nalgebra::DMatrix<f64> {
    let mut out = splines::Influence::zeros(at.len());
    surface.fill(at, &mut out).expect("on the rail");
    out.value
}

#[test]
fn what_nothing_holds_is_refused_by_name() {
    let free = modes(&chain(3, BeamTheory::EulerBernoulli, [FREE, FREE]), &[], 1);
    assert!(matches!(free, Err(Error::Mechanism { .. })), "{free:?}");
    // A plane truss: statics leaves out the third direction, but its mass lies there.
    let mut truss = Model {
        up: [0.0, 1.0, 0.0],
        sections: vec![section()],
        ..Model::default()
    };
    truss.points = vec![[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
    for points in [[0, 1], [1, 2], [2, 0]] {
        truss.members.push(Member {
            kind: MemberKind::Truss,
            ..beam(points)
        });
    }
    truss.supports.push(Support {
        point: 0,
        fixed: [true, true, true, false, false, false],
    });
    truss.supports.push(Support {
        point: 1,
        fixed: [false, true, true, false, false, false],
    });
    let loose = modes(&truss, &[], 2);
    assert_eq!(
        loose.err(),
        Some(Error::Mechanism {
            point: 2,
            dof: Dof::Uz
        })
    );
    truss.supports.push(Support {
        point: 2,
        fixed: [false, false, true, false, false, false],
    });
    assert_eq!(modes(&truss, &[], 3).expect("held").modes.len(), 3);
    truss.sections[0].mass = 0.0;
    assert_eq!(modes(&truss, &[], 3).err(), Some(Error::NoMass));
    // An inertia about an axis that nothing stiffens.
    truss.masses.push(PointMass {
        point: 2,
        mass: 1.0,
        inertia: [0.0, 0.0, 2.0],
        offset: [0.0; 3],
    });
    let spins = modes(&truss, &[], 1);
    assert_eq!(
        spins.err(),
        Some(Error::Mechanism {
            point: 2,
            dof: Dof::Rz
        })
    );
}

#[test]
fn a_plane_girder_needs_no_other_stiffness() {
    let mut girder = common::paper();
    girder.area = None;
    girder.i_lateral = None;
    girder.j = None;
    girder.overhangs = [0.0; 2];
    girder.stations = vec![0.0, 60.0];
    girder.mass_per_length = Some(26.4);
    let (model, rail) = girder.model_and_rail().expect("sound");
    let solved = modes(&model, &[rail], 5).expect("plane by intent");
    // One element: rotations of its ends alone, omega^2 = 120 and 2520 EI / m L^4.
    let unit = girder.e * girder.i_vertical / (26.4 * 60.0_f64.powi(4));
    assert_eq!(solved.modes.len(), 2);
    for (mode, exact) in solved.modes.iter().zip([120.0, 2520.0]) {
        assert!((mode.omega.powi(2) / (exact * unit) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn members_are_cut_until_the_mesh_does_not_show() {
    for accuracy in [1e-2, 1e-3, 1e-9] {
        for (theory, exact) in [
            (
                BeamTheory::EulerBernoulli,
                [PI, 2.0 * PI, 3.0 * PI].map(bending),
            ),
            (BeamTheory::Timoshenko, [0, 1, 2].map(sheared)),
        ] {
            let model = plane(1, theory, [PINNED, PINNED]);
            let rail = Rail {
                axis: [1.0, 0.0, 0.0],
                segments: vec![RailSegment {
                    member: 0,
                    offset: [0.0, 0.4, 0.0],
                }],
                stations: vec![0.0, L],
                ..Rail::default()
            };
            // Cut points move in all directions: modes out of the plane lie between those of the plane.
            let refined = fea::refined_modes(&model, &[rail], 12, accuracy).expect("sound");
            let estimate = refined.error.expect("estimated for the lowest modes");
            for exact in exact {
                let nearest = |a: f64, b: f64| {
                    if (b - exact).abs() < (a - exact).abs() {
                        b
                    } else {
                        a
                    }
                };
                let found = refined
                    .modes
                    .modes
                    .iter()
                    .map(|mode| mode.omega)
                    .fold(f64::INFINITY, nearest);
                let error = found / exact - 1.0;
                assert!(
                    error > -1e-9 && error < estimate,
                    "{theory:?} {accuracy}: {error}"
                );
            }
            println!(
                "{theory:?} {accuracy}: {} parts, {estimate}",
                refined.parts[0]
            );
            assert!(estimate <= accuracy || refined.parts[0] == 128);
            assert_eq!(refined.rails[0].segments.len(), refined.parts[0]);
        }
    }
}

#[test]
fn long_chains_keep_their_lowest_frequencies() {
    for (count, room) in [(256, 2e-9), (1024, 1e-11), (4096, 1e-12)] {
        let solved = modes(
            &plane(count, BeamTheory::EulerBernoulli, [PINNED, PINNED]),
            &[],
            3,
        )
        .expect("sound");
        for (k, mode) in solved.modes.iter().enumerate() {
            let error = mode.omega / bending((k + 1) as f64 * PI) - 1.0;
            assert!(error.abs() < room, "{count}, {k}: {error}");
        }
    }
}

/// Two equal beams beside each other have each frequency twice (symmetry): whatever the number that is asked for, both of a
/// pair are listed, by dense matrices and by the search for large structures, and the next frequency is another one.
#[test]
fn modes_of_equal_frequency_are_listed_together() {
    for members in [4, 60] {
        let one = plane(members, BeamTheory::EulerBernoulli, [PINNED, PINNED]);
        let mut two = one.clone();
        let count = one.points.len();
        two.points
            .extend(one.points.iter().map(|[x, y, _]| [*x, *y, 20.0]));
        two.members.extend(one.members.iter().map(|member| Member {
            points: member.points.map(|point| point + count),
            ..*member
        }));
        two.supports
            .extend(one.supports.iter().map(|support| Support {
                point: support.point + count,
                ..*support
            }));
        let segments = (0..members).map(|member| RailSegment {
            member,
            offset: [0.0; 3],
        });
        let rail = Rail {
            origin: [0.0; 3],
            axis: [1.0, 0.0, 0.0],
            segments: segments.collect(),
            stations: vec![0.0, L],
        };
        for asked in 1..=5 {
            let found = refined_modes(&two, std::slice::from_ref(&rail), asked, 1e-3);
            let found = found.expect("sound").modes;
            let listed = asked + asked % 2;
            assert_eq!(found.modes.len(), listed, "{members}: {asked}");
            assert_eq!(found.count_below_shift, listed, "{members}: {asked}");
            let last = found.modes[listed - 1].omega;
            let next = found.next.expect("there are more");
            assert!(next > 1.01 * last, "{next} {last}");
        }
    }
}
