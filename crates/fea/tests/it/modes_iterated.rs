//! Modes after a step of inverse iteration with the mass as it is distributed along members that are flexible in shear:
//! against closed forms, continuity and equilibrium.

use std::f64::consts::PI;

use fea::{
    BeamTheory, CrossSection, Dof, Effect, ExcitingForces, ForceComponent, Member, Model, Rail,
    RailSegment, RefinedModes, Support, excited_modes, full_modes,
};
use splines::{Axis, Probe};

const SPAN: f64 = 12.0;

fn section() -> CrossSection {
    CrossSection {
        e: 2.1e11,
        g: 8.1e10,
        area: 0.04,
        iy: 9e-5,
        iz: 6e-4,
        j: 3e-5,
        shear_y: Some(0.02),
        shear_z: Some(0.011),
        mass: 340.0,
    }
}

/// Members along x between the given points, each directed along x or against it, with local y axes `up`.
fn chain(points: &[f64], reversed: &[bool], up: [f64; 3]) -> Model {
    let mut model = Model {
        up: [0.0, 1.0, 0.0],
        theory: BeamTheory::Timoshenko,
        ..Model::default()
    };
    model.sections.push(section());
    model.points = points.iter().map(|&x| [x, 0.0, 0.0]).collect();
    let ends = |k: usize| if reversed[k] { [k + 1, k] } else { [k, k + 1] };
    model
        .members
        .extend((0..points.len() - 1).map(|k| Member::beam(ends(k), 0, up)));
    model
}

fn rail(model: &Model) -> Rail {
    let segments = (0..model.members.len())
        .map(|member| RailSegment {
            member,
            offset: [0.0; 3],
        })
        .collect();
    Rail {
        origin: [0.0; 3],
        axis: [1.0, 0.0, 0.0],
        segments,
        stations: vec![0.0],
    }
}

fn modes(model: &Model, axes: &[Axis], parts: usize) -> RefinedModes {
    let rail = rail(model);
    let forces = ExcitingForces {
        axes: axes.to_vec(),
        motions: Vec::new(),
    };
    let mut refined = full_modes(model, &[rail], &forces, parts).expect("it has mass");
    refined.keep_resolved(model, &forces).expect("it has mass");
    refined
}

/// Closed form: (EI k^2 + GAs - m r^2 w^2)((GAs + N) k^2 - m w^2) = (GAs k)^2 of a beam on two supports, k = n pi/L, with the
/// axial force N, its lower root.
///
/// Source: Timoshenko, Vibration Problems in Engineering (1955), section 55; with N the strain energy of Engesser, Timoshenko
/// and Gere, Theory of Elastic Stability (1961), section 2.17.
fn closed_form(n: usize, tension: f64) -> f64 {
    let s = section();
    let k = n as f64 * PI / SPAN;
    let (gas, ei, m) = (s.g * s.shear_y.expect("given"), s.e * s.iz, s.mass);
    let j = m * s.iz / s.area;
    let (p, q) = ((gas + tension) * k * k / m, (ei * k * k + gas) / j);
    let half = 0.5 * (p + q);
    let product = k * k * (gas * (ei * k * k + tension) + tension * ei * k * k) / (m * j);
    (product / (half + (half * half - product).sqrt())).sqrt()
}

/// By Rayleigh's quotient an error e of the frequencies of a mesh becomes one of the order of e^2.
#[test]
fn iteration_squares_the_errors_of_frequencies() {
    errors_are_squared(0.0);
}

/// The same about a state with half of the Euler load, and with three times as much in tension.
#[test]
fn iteration_squares_the_errors_about_a_loaded_state() {
    let euler = PI * PI * section().e * section().iz / (SPAN * SPAN);
    errors_are_squared(-0.5 * euler);
    errors_are_squared(3.0 * euler);
}

/// A mesh for iterated modes errs by more than its accuracy before the iteration, and by less after it.
#[test]
fn members_are_cut_as_far_as_iterated_modes_need() {
    let mut model = chain(&[0.0, SPAN], &[false], [0.0, 1.0, 0.0]);
    for point in 0..2 {
        model.supports.push(Support {
            point,
            fixed: [point == 0, true, true, true, false, false],
        });
    }
    let (rails, forces, count) = ([rail(&model)], ExcitingForces::vertical(), 8);
    for accuracy in [1e-2, 1e-3, 1e-4, 1e-6] {
        let mut refined =
            excited_modes(&model, &rails, &forces, count, accuracy).expect("it has mass");
        let before: Vec<f64> = refined.modes.modes.iter().map(|mode| mode.omega).collect();
        refined.iterate().expect("it has eigenvalues");
        let mut largest = 0.0_f64;
        for (n, (mode, before)) in (1..).zip(refined.modes.modes.iter().zip(before)) {
            let exact = closed_form(n, 0.0);
            let error = mode.omega / exact - 1.0;
            let estimate = refined
                .iterated_error(&model, &forces, mode.omega)
                .expect("it has mass");
            assert!(
                error > -1e-9 && error <= accuracy,
                "{accuracy}, mode {n}: {error:e}"
            );
            assert!(
                error <= estimate + 1e-9,
                "{accuracy}, mode {n}: {error:e}, estimated {estimate:e}"
            );
            largest = largest.max(before / exact - 1.0);
        }
        println!(
            "{accuracy}: {} parts, {largest:.1e} before the iteration",
            refined.parts[0]
        );
        assert!(
            largest > accuracy || accuracy > 1e-3,
            "{accuracy}: no coarser than needed, {largest:e}"
        );
    }
}

fn errors_are_squared(tension: f64) {
    let mut model = chain(&[0.0, SPAN], &[false], [0.0, 1.0, 0.0]);
    model.members[0].tension = tension;
    // stiff enough beside the plane of the modes
    model.sections[0].iy = if tension == 0.0 {
        model.sections[0].iy
    } else {
        1e-3
    };
    for point in 0..2 {
        model.supports.push(Support {
            point,
            fixed: [point == 0, true, true, true, false, false],
        });
    }
    for parts in [6, 12, 24] {
        let before = modes(&model, &[Axis::Vertical], parts);
        let mut after = before.clone();
        after.iterate().expect("it has eigenvalues");
        let count = before.modes.modes.len();
        let errors: Vec<[f64; 2]> = (0..count)
            .map(|k| {
                [&before, &after]
                    .map(|of| of.modes.modes[k].omega / closed_form(k + 1, tension) - 1.0)
            })
            .collect();
        for (k, [old, new]) in errors.into_iter().enumerate() {
            assert!(
                old > -1e-10 && new > -1e-10,
                "{parts} parts, mode {k}: from above, {old:e} {new:e}"
            );
            assert!(
                new < 6.0 * old * old + 1e-10,
                "{parts} parts, mode {k}: {old:e} {new:e}"
            );
        }
    }
}

/// The slope of a mode where two parts of a member meet, relative to its largest: jumps as computed from the mesh, none
/// after the iteration. Members are directed along the rail and against it, turned about their axes, of different lengths,
/// and one has a hinge.
#[test]
fn slopes_of_iterated_modes_are_continuous_within_members() {
    let ends = [0.0, 5.0, 12.5, 19.0];
    let mut model = chain(&ends, &[false, true, false], [0.0, 0.8, 0.6]);
    model.members[1].releases[0] = [false, false, false, false, false, true];
    for (point, along) in [(0, true), (1, false), (3, false)] {
        model.supports.push(Support {
            point,
            fixed: [along, true, true, true, false, false],
        });
    }
    let parts = 5;
    for axis in [Axis::Vertical, Axis::Lateral] {
        let mut refined = modes(&model, &[Axis::Vertical, Axis::Lateral], parts);
        let jumps = |refined: &RefinedModes| {
            let count = refined.modes.modes.len();
            let slopes = |x: f64| {
                refined
                    .modes
                    .at(Probe { rail: 0, x, axis })
                    .expect("on the rail")
            };
            let (mut jump, mut largest) = (vec![0.0_f64; count], vec![0.0_f64; count]);
            for pair in ends.windows(2) {
                for k in 1..parts {
                    let x = pair[0] + (pair[1] - pair[0]) * k as f64 / parts as f64;
                    for (mode, (a, b)) in slopes(x - 1e-9).iter().zip(slopes(x + 1e-9)).enumerate()
                    {
                        jump[mode] = jump[mode].max((a[1] - b[1]).abs());
                        largest[mode] = largest[mode].max(a[1].abs());
                    }
                }
            }
            let most = largest.iter().fold(0.0_f64, |most, &slope| most.max(slope));
            jump.into_iter().fold(0.0_f64, f64::max) / most
        };
        let before = jumps(&refined);
        refined.iterate().expect("it has eigenvalues");
        let after = jumps(&refined);
        println!("{axis:?}: jumps {before:.1e} before, {after:.1e} after");
        assert!(
            before > 1e-3 && after < 1e-7,
            "{axis:?}: {before:e}, {after:e}"
        );
    }
}

/// Rail shapes and modes are the same functions.
#[test]
fn rail_shapes_of_iterated_modes_are_the_modes() {
    let mut model = chain(&[0.0, 5.0, 12.0], &[true, false], [0.0, 0.8, 0.6]);
    for point in 0..3 {
        model.supports.push(Support {
            point,
            fixed: [point == 0, true, true, true, false, false],
        });
    }
    let mut refined = modes(&model, &[Axis::Vertical], 4);
    refined.iterate().expect("it has eigenvalues");
    let shapes = refined
        .modes
        .rail_shapes(|mode| mode.omega)
        .expect("a rail");
    let (mut value, mut slope) = (vec![0.0; shapes.count()], vec![0.0; shapes.count()]);
    for x in [0.0, 0.3, 2.5, 4.99, 5.0, 7.1, 12.0] {
        let at = Probe {
            rail: 0,
            x,
            axis: Axis::Vertical,
        };
        shapes.row(at, &mut value, &mut slope).expect("on the rail");
        let known = refined.modes.at(at).expect("on the rail");
        for (k, (mode, own)) in refined.modes.modes.iter().zip(&known).enumerate() {
            let size = mode.omega.recip();
            assert!(
                (value[k] * mode.omega - own[0]).abs() < 1e-11 * (1.0 + size),
                "{x} {k}"
            );
            assert!(
                (slope[k] * mode.omega - own[1]).abs() < 1e-10 * (1.0 + own[1].abs()),
                "{x} {k}"
            );
        }
    }
}

/// Equilibrium: the reactions to the inertia of an iterated mode add up to its momentum, and the shear force and moment are
/// the same on both sides of a node without load.
#[test]
fn inertia_of_iterated_modes_is_in_equilibrium() {
    let mut model = chain(&[0.0, 5.0, 12.0], &[false, true], [0.0, 0.8, 0.6]);
    for point in 0..3 {
        model.supports.push(Support {
            point,
            fixed: [point == 0, true, true, true, false, false],
        });
    }
    let mut refined = modes(&model, &[Axis::Vertical], 4);
    refined.iterate().expect("it has eigenvalues");
    let frame = &refined.frame;
    let holds = frame.restraints(&refined.model);
    let mut effects: Vec<Effect> = holds.iter().copied().map(Effect::Reaction).collect();
    let components = [
        ForceComponent::ShearY,
        ForceComponent::ShearZ,
        ForceComponent::BendingY,
    ];
    for component in components {
        for (member, place) in [(0, 1.0), (1, 0.0), (1, 1.0), (2, 0.0)] {
            effects.push(Effect::InternalForce {
                member,
                place,
                component,
            });
        }
    }
    let modes = &refined.modes.modes;
    let inertia = frame.inertia_of_modes(&refined.model, modes);
    let found = frame
        .effects_of_modes(&refined.model, &effects, modes, &inertia)
        .expect("effects");
    for (mode, shape) in modes.iter().enumerate() {
        for (k, freedom) in [Dof::Ux, Dof::Uy, Dof::Uz].into_iter().enumerate() {
            let rows = (0..holds.len()).filter(|&row| holds[row].dof == freedom);
            let (sum, whole) = rows.fold((0.0, 0.0_f64), |(sum, whole), row| {
                (sum + found[(row, mode)], whole + found[(row, mode)].abs())
            });
            let apart = (sum + shape.coupling[k]).abs();
            assert!(
                apart <= 1e-9 * whole.max(1.0),
                "mode {mode}, axis {k}: {sum} {}",
                shape.coupling[k]
            );
        }
        for pair in (0..2 * components.len()).map(|pair| holds.len() + 2 * pair) {
            let [a, b] = [found[(pair, mode)], found[(pair + 1, mode)]];
            assert!(
                (a - b).abs() < 1e-9 * (a.abs() + 1.0),
                "mode {mode}, effect {pair}: {a} {b}"
            );
        }
    }
}
