//! Orders of convergence of the methods with fixed steps, and their conservation of energy.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use super::Step;
use crate::contact::solver::{RailMemory, Solver};
use crate::contact::system::System;
use crate::instant::settle::settle;
use crate::mechanics::state::State;
use crate::time::events::first_switch;
use std::sync::Arc;

use nalgebra::DMatrix;
use splines::{Compliance, ExactSurface, Flexibility, Influence, Probe, RailElement, Rails};

use crate::{
    Analysis, BlendedParts, Body, BodyDof, Contact, Damper, Dynamics, Error, Flange, Foundation,
    Load, Method, MotionKind, NormalLaw, PartChain, Profile, Schedule,
};
use crate::{Scene, Shapes, Structure, Wheel};

/// One undamped wheel of mass 1 and stiffness 100 on a rigid rail, with weight 10; it starts 0.05 above its
/// equilibrium.
fn scene() -> Scene {
    Scene {
        gravity: 10.0,
        bodies: vec![Body {
            mass: 1.0,
            inertia: [0.0; 3],
            cg: [0.0; 3],
            free: [false, true, false, false, false, false],
            start: [0.0; 6],
            start_speed: [0.0; 6],
            motion: None,
            pinned: None,
        }],
        wheels: vec![Wheel {
            radius: 1.0,
            normal: NormalLaw::linear(100.0, 0.0, Damper::Rail),
            flange: None,
            friction: None,
            spin_inertia: None,
        }],
        contacts: vec![Contact {
            body: 0,
            structure: 0,
            rail: 0,
            at: [0.0; 3],
            offsets: vec![0.0],
            wheel: 0,
        }],
        gauges: Vec::new(),
        actuators: crate::Actuators::default(),
        analysis: Analysis::Dynamic,
        end: 1.0,
        output_dt: 1.0,
        output_parts: 1,
        accuracy: 1e-6,
    }
}

/// Calls `body` with a step that starts at height `y` with speed `v`.
fn with<T>(
    y: f64,
    v: f64,
    body: impl FnOnce(&mut Step<'_, '_>) -> Result<T, Error>,
) -> Result<T, Error> {
    let (scene, foundations) = (scene(), [Foundation::rigid()]);
    let system = System::new(&scene, &foundations)?;
    let mut solver = Solver::new(&system, RailMemory::Known)?;
    let mut state = system.state();
    (state.q[0], state.v[0]) = (y, v);
    settle(&mut solver, &mut state)?;
    solver.store_open(&state);
    body(&mut Step::new(&mut solver, state, Method::Sdirk4))
}

fn slope(errors: &[f64]) -> f64 {
    (errors[0] / errors[errors.len() - 1]).log2() / (errors.len() - 1) as f64
}

#[test]
fn error_of_an_oscillation_falls_with_the_fourth_power_of_the_step() -> Result<(), Error> {
    let mut errors = Vec::new();
    for steps in [40_u32, 80, 160, 320] {
        let end = with(-0.05, 0.0, |step| {
            for _ in 0..steps {
                step.begin();
                assert!(step.attempt(1.0 / f64::from(steps), f64::INFINITY, &mut 0)?);
            }
            Ok(step.to.q[0])
        })?;
        // Analytic: y = -0.1 + 0.05 cos(10 t).
        errors.push((end - (-0.1 + 0.05 * 10.0_f64.cos())).abs());
    }
    assert!((slope(&errors) - 4.0).abs() < 0.1, "{errors:?}");
    Ok(())
}

/// Identity: a flange that nothing at the start of a step leads to its rail, with neither speed nor acceleration, is left out of
/// the step; where it touches at the end, all stages are taken again with it, and its force is that of its law.
#[test]
fn a_step_in_which_a_flange_that_was_left_out_touches_is_repeated() -> Result<(), Error> {
    let (mut scene, foundations) = (scene(), [Foundation::rigid()]);
    scene.bodies[0].free[2] = true;
    let (stiffness, clearance) = (100.0, 0.01);
    scene.wheels[0].flange = Some(Flange {
        stiffness,
        clearance,
        release: None,
    });
    let value = Schedule::new(&[[0.0, 0.0], [1.0, 30.0]])?;
    scene.actuators.loads.push(Load {
        body: 0,
        dof: BodyDof::Z,
        value,
    });
    let system = System::new(&scene, &foundations)?;
    // Free motion by the load 30 t of a mass of 1: z = 5 t^3, 5e-3 and 0.04 at the ends of these steps.
    for (h, touches) in [(0.1, false), (0.2, true)] {
        let mut solver = Solver::new(&system, RailMemory::Known)?;
        let mut state = system.state();
        state.q[0] = -0.1;
        settle(&mut solver, &mut state)?;
        solver.store_open(&state);
        let (mut step, mut stages) = (Step::new(&mut solver, state, Method::Sdirk4), 0);
        step.begin();
        assert!(step.attempt(h, f64::INFINITY, &mut stages)?);
        assert_eq!(stages, if touches { 10 } else { 5 }, "step {h}");
        let wanted = if touches {
            stiffness * (step.to.q[1] - clearance)
        } else {
            0.0
        };
        assert!(
            (step.to.force[1] - wanted).abs() < 1e-9,
            "step {h}: {} of {wanted}",
            step.to.force[1]
        );
        assert_eq!(wanted > 0.0, touches);
    }
    Ok(())
}

#[test]
fn instant_at_which_a_wheel_leaves_converges_with_the_step() -> Result<(), Error> {
    // Analytic: y = -0.1 + (3/10) sin(10 t) reaches 0 at sin(10 t) = 1/3.
    let wanted = (1.0_f64 / 3.0).asin() / 10.0;
    let mut errors = Vec::new();
    for steps in [1_u32, 2, 4, 8] {
        let h = 0.05 / f64::from(steps);
        errors.push(with(-0.1, 3.0, |step| {
            loop {
                step.begin();
                assert!(step.attempt(h, f64::INFINITY, &mut 0)?);
                if let Some((share, _)) = first_switch(step, 10.0)? {
                    return Ok((step.from.t + share * h - wanted).abs());
                }
            }
        })?);
    }
    assert!(slope(&errors) > 3.5, "{errors:?}");
    Ok(())
}

/// Shapes of three modes of a span of 10; the wheel starts at 2 with speed 3.
struct Sines;

impl Shapes for Sines {
    fn row(&self, at: Probe, value: &mut [f64], slope: &mut [f64]) -> Result<(), splines::Error> {
        for (k, (value, slope)) in value.iter_mut().zip(slope).enumerate() {
            let wave = (k + 1) as f64 * std::f64::consts::PI / 10.0;
            (*value, *slope) = ((wave * at.x).sin(), wave * (wave * at.x).cos());
        }
        Ok(())
    }
}

/// A rail whose compliance varies with the square of a sine.
struct Give;

impl Compliance for Give {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), splines::Error> {
        for (i, p) in at.iter().enumerate() {
            for (j, q) in at.iter().enumerate() {
                out.value[(i, j)] = 0.02 * (0.3 * p.x).sin() * (0.3 * q.x).sin();
                out.slope[(i, j)] = 0.006 * (0.3 * p.x).cos() * (0.3 * q.x).sin();
            }
        }
        Ok(())
    }

    fn breaks(&self, _: usize) -> Vec<f64> {
        Vec::new()
    }

    fn range(&self, _: usize) -> Option<[f64; 2]> {
        None
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

fn modal() -> Foundation {
    let dynamics = Dynamics::Modes {
        omega: vec![4.0, 9.0, 17.0],
        ratio: vec![0.0, 0.02, 0.05],
    };
    Foundation {
        structure: Some(Structure {
            dynamics,
            shapes: Box::new(Sines),
        }),
        ..Foundation::default()
    }
}

/// Two rigid parts on springs, joined by a beam. Their datum is blended from 1.5 to 6.5, where the wheel stays.
fn parts() -> Foundation {
    let cells = [2.0, 6.0]
        .iter()
        .enumerate()
        .map(|(j, centre)| RailElement {
            rail: j,
            x: [0.0, 10.0],
            ends: [j, j],
            length: 10.0,
            frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            offset: [-centre, 0.0, 0.0],
            flexibility: Flexibility::default(),
            member: None,
        });
    let line = Rails::new(cells.collect()).expect("rigid arms");
    let mut nodal = DMatrix::zeros(12, 12);
    let give = DMatrix::from_row_slice(
        4,
        4,
        &[
            0.02, 0.002, 0.008, -0.001, //
            0.002, 0.004, 0.001, 0.0005, //
            0.008, 0.001, 0.025, -0.002, //
            -0.001, 0.0005, -0.002, 0.003,
        ],
    );
    for (i, row) in [1, 5, 7, 11].into_iter().enumerate() {
        for (j, column) in [1, 5, 7, 11].into_iter().enumerate() {
            nodal[(row, column)] = give[(i, j)];
        }
    }
    let surface = ExactSurface::new(Arc::new(line), nodal).expect("two parts");
    let chain = PartChain::new(vec![0.0, 4.0, 10.0], 0, Some(5.0)).expect("one joint");
    Foundation::massless(
        Box::new(BlendedParts {
            surface,
            chains: vec![chain],
        }),
        1,
    )
}

/// A pinned beam of three elements with all its natural modes; the wheel stays on the middle element, from 1.5 to
/// 6.5.
struct Beam {
    /// Degrees of freedom by modes: deflection and slope of each end of the middle element, 4 x 6.
    middle: DMatrix<f64>,
}

const ENDS: [f64; 4] = [0.0, 1.5, 6.5, 10.0];

impl Shapes for Beam {
    fn row(&self, at: Probe, value: &mut [f64], slope: &mut [f64]) -> Result<(), splines::Error> {
        let length = ENDS[2] - ENDS[1];
        let s = (at.x - ENDS[1]) / length;
        let (t, by) = (1.0 - s, 6.0 * s * (1.0 - s) / length);
        let own = [
            t * t * (1.0 + 2.0 * s),
            length * s * t * t,
            s * s * (3.0 - 2.0 * s),
            -length * s * s * t,
        ];
        let rate = [-by, t * (1.0 - 3.0 * s), by, s * (3.0 * s - 2.0)];
        for (k, column) in self.middle.column_iter().enumerate() {
            (value[k], slope[k]) = (0.0, 0.0);
            for (i, shape) in column.iter().enumerate() {
                value[k] += own[i] * shape;
                slope[k] += rate[i] * shape;
            }
        }
        Ok(())
    }
}

fn full() -> Foundation {
    let (bending, line_mass) = (200.0, 2.0);
    let (mut stiffness, mut mass) = (DMatrix::<f64>::zeros(8, 8), DMatrix::<f64>::zeros(8, 8));
    for (e, ends) in ENDS.windows(2).enumerate() {
        let l = ends[1] - ends[0];
        let k = [
            [12.0, 6.0 * l, -12.0, 6.0 * l],
            [6.0 * l, 4.0 * l * l, -6.0 * l, 2.0 * l * l],
        ];
        let m = [
            [156.0, 22.0 * l, 54.0, -13.0 * l],
            [22.0 * l, 4.0 * l * l, 13.0 * l, -3.0 * l * l],
        ];
        let mirror = [2, 3, 0, 1];
        for i in 0..4 {
            for j in 0..4 {
                let of = |rows: &[[f64; 4]; 2]| {
                    let sign = if i < 2 || (i + j) % 2 == 0 { 1.0 } else { -1.0 };
                    sign * if i < 2 {
                        rows[i][j]
                    } else {
                        rows[i - 2][mirror[j]]
                    }
                };
                stiffness[(2 * e + i, 2 * e + j)] += bending / l.powi(3) * of(&k);
                mass[(2 * e + i, 2 * e + j)] += line_mass * l / 420.0 * of(&m);
            }
        }
    }
    let free = [1, 2, 3, 4, 5, 7];
    let inner = |whole: &DMatrix<f64>| DMatrix::from_fn(6, 6, |i, j| whole[(free[i], free[j])]);
    let lower = inner(&mass).cholesky().expect("it has mass").l();
    let inverse = lower.try_inverse().expect("it has mass");
    let own = (&inverse * inner(&stiffness) * inverse.transpose()).symmetric_eigen();
    let shapes = inverse.transpose() * own.eigenvectors;
    let omega = own.eigenvalues.iter().map(|square| square.sqrt()).collect();
    let dynamics = Dynamics::Modes {
        omega,
        ratio: vec![0.02; 6],
    };
    let shapes = Beam {
        middle: shapes.rows(1, 4).into_owned(),
    };
    Foundation {
        structure: Some(Structure {
            dynamics,
            shapes: Box::new(shapes),
        }),
        ..Foundation::default()
    }
}

/// Height and speed of the wheel at time 1, after `steps` equal steps.
fn end(
    method: Method,
    law: NormalLaw,
    foundation: Foundation,
    steps: u32,
) -> Result<[f64; 2], Error> {
    let mut scene = scene();
    scene.wheels[0].normal = law;
    scene.bodies[0].motion = Some(Profile::new(MotionKind::Speed, &[[0.0, 3.0]], 2.0, 0.0)?);
    let foundations = [foundation];
    let system = System::new(&scene, &foundations)?;
    method.check(&system)?;
    let mut solver = Solver::new(&system, RailMemory::Known)?;
    let mut state = system.state();
    state.q[0] = -0.12;
    settle(&mut solver, &mut state)?;
    solver.store_open(&state);
    let mut step = Step::new(&mut solver, state, method);
    // Nothing jumps at the start, so that every step of ESDIRK5 may be its own.
    step.begins_smoothly = true;
    for _ in 0..steps {
        step.begin();
        assert!(step.attempt(1.0 / f64::from(steps), f64::INFINITY, &mut 0)?);
    }
    Ok([step.to.q[0], step.to.v[0]])
}

/// Errors of height and speed at the end with each number of steps.
fn errors(
    counts: [u32; 3],
    wanted: [f64; 2],
    found: impl Fn(u32) -> Result<[f64; 2], Error>,
) -> Result<Vec<f64>, Error> {
    let error = |found: [f64; 2]| (found[0] - wanted[0]).hypot(0.1 * (found[1] - wanted[1]));
    counts
        .into_iter()
        .map(|steps| found(steps).map(error))
        .collect()
}

/// The order is measured between the two finest of three steps. The reference is Gauss of order 6, or Radau if the
/// damper rules out Gauss.
#[test]
fn collocation_keeps_its_order_on_every_foundation() -> Result<(), Error> {
    let influence = || Foundation::massless(Box::new(Give), 1);
    let foundations: [(&str, &dyn Fn() -> Foundation); 5] = [
        ("rigid", &Foundation::rigid),
        ("influence", &influence),
        ("parts", &parts),
        ("modal", &modal),
        ("full", &full),
    ];
    let mut missed = Vec::new();
    for (name, foundation) in foundations {
        let structure = foundation().structure.is_some();
        for (law, damping, damper) in [
            ("none", 0.0, Damper::Rail),
            ("ground", 2.0, Damper::Ground),
            ("rail", 2.0, Damper::Rail),
        ] {
            let best = if law == "rail" {
                Method::Radau
            } else {
                Method::Gauss3
            };
            let radau = if law == "rail" { 5.0 } else { 9.0 };
            let wheel = || NormalLaw::linear(100.0, damping, damper);
            let wanted = end(
                best,
                wheel(),
                foundation(),
                if law == "rail" { 1280 } else { 640 },
            )?;
            for (method, order) in [
                (Method::Sdirk4, 4.0),
                (Method::Esdirk5, 5.0),
                (Method::Radau, radau),
                (Method::Gauss2, 4.0),
                (Method::Gauss3, 6.0),
            ] {
                if law == "rail" && matches!(method, Method::Gauss2 | Method::Gauss3) {
                    continue;
                }
                // Its errors are near rounding before it resolves the fastest mode, and the relaxation on parts.
                let is_fine =
                    matches!((name, law), ("full", "none" | "ground") | ("parts", "rail"));
                if method == Method::Esdirk5 && is_fine {
                    continue;
                }
                // The deflection of the rail relaxes against the damper within a time of 0.02, which only shorter
                // steps resolve.
                let counts = match (method, law) {
                    (Method::Sdirk4, "rail") if structure => [160, 320, 640],
                    (Method::Sdirk4, "rail") => [320, 640, 1280],
                    (Method::Sdirk4, _) => [80, 160, 320],
                    (Method::Esdirk5, "rail") if structure => [160, 320, 640],
                    (Method::Esdirk5, "rail") if name == "rigid" => [40, 80, 160],
                    (Method::Esdirk5, "rail") => [320, 640, 1280],
                    (Method::Esdirk5, _) => [20, 40, 80],
                    (_, "rail") => [80, 160, 320],
                    (Method::Radau, _) if name == "full" => [10, 20, 40],
                    (Method::Radau, _) if name == "modal" => [10, 20, 40],
                    (Method::Radau, _) => [4, 8, 16],
                    // Its fastest mode has a period of 0.06.
                    _ if name == "full" => [40, 80, 160],
                    _ => [20, 40, 80],
                };
                let errors = errors(counts, wanted, |steps| {
                    end(method, wheel(), foundation(), steps)
                })?;
                let seen = slope(&errors[1..]);
                println!(
                    "{name}, damper {law}, {method:?}: order {seen:.3} for {order}, {errors:?}"
                );
                // With few steps the fastest modes of the mesh are not resolved yet, and the order is approached from above.
                let is_coarse = name == "full" && method == Method::Radau && law != "rail";
                if (seen - order).abs() > 0.1 && !(is_coarse && seen > order) {
                    missed.push((name, law, method, seen));
                }
            }
        }
    }
    assert!(missed.is_empty(), "{missed:?}");
    Ok(())
}

/// A law that is not linear takes more than one iteration in a stage or a step, also where the wheel's place is known. The
/// reference has at least eight times as many steps.
#[test]
fn methods_keep_their_order_with_laws_that_are_not_linear() -> Result<(), Error> {
    let influence = || Foundation::massless(Box::new(Give), 1);
    let foundations: [(&str, &dyn Fn() -> Foundation); 4] = [
        ("rigid", &Foundation::rigid),
        ("influence", &influence),
        ("modal", &modal),
        ("full", &full),
    ];
    let mut missed = Vec::new();
    for (name, foundation) in foundations {
        let is_massless = matches!(name, "rigid" | "influence");
        // The fastest mode of the mesh has a period of 0.06.
        let stages = if name == "full" {
            [80, 160, 320]
        } else {
            [40, 80, 160]
        };
        let under_dampers = if name == "influence" {
            [320, 640, 1280]
        } else {
            [80, 160, 320]
        };
        let mut by_ground = vec![
            (Method::Sdirk4, 4.0, stages),
            (Method::Gauss3, 6.0, [40, 80, 160]),
            (
                Method::Radau,
                9.0,
                if is_massless {
                    [6, 12, 24]
                } else {
                    [10, 20, 40]
                },
            ),
        ];
        // On the mesh its errors are near rounding before it resolves the fastest mode.
        if name != "full" {
            by_ground.push((
                Method::Esdirk5,
                5.0,
                if is_massless {
                    [15, 30, 60]
                } else {
                    [40, 80, 160]
                },
            ));
        }
        for (damper, finest, cases) in [
            (Damper::Ground, 320, by_ground),
            (
                Damper::Rail,
                5120,
                vec![(Method::Radau, 5.0, under_dampers)],
            ),
        ] {
            let law = || NormalLaw {
                exponent: 1.5,
                ..NormalLaw::linear(300.0, 2.0, damper)
            };
            let wanted = end(Method::Radau, law(), foundation(), finest)?;
            for (method, order, counts) in cases {
                let errors = errors(counts, wanted, |steps| {
                    end(method, law(), foundation(), steps)
                })?;
                let seen = slope(&errors[1..]);
                println!("{name}, {damper:?}, {method:?}: order {seen:.3} for {order}, {errors:?}");
                // With few steps the fastest modes are not resolved yet, and the order is approached from above.
                let is_coarse = !is_massless && order > 8.0;
                if (seen - order).abs() > 0.1 && !(is_coarse && seen > order) {
                    missed.push((name, damper, method, seen));
                }
            }
        }
    }
    assert!(missed.is_empty(), "{missed:?}");
    Ok(())
}

/// Analytic: E = v^2/2 + 50 p^2 + 10 y is constant; ten thousand periods of 2 pi/10 with 12 steps each.
#[test]
fn gauss_conserves_the_energy_of_ten_thousand_cycles() -> Result<(), Error> {
    for (method, bound) in [
        (Method::Gauss2, 1e-10),
        (Method::Gauss3, 1e-10),
        (Method::Radau, 1.0),
        (Method::Sdirk4, 1.0),
    ] {
        let (scene, foundations) = (scene(), [Foundation::rigid()]);
        let system = System::new(&scene, &foundations)?;
        let mut solver = Solver::new(&system, RailMemory::Known)?;
        let mut state = State::zeros(1, 1, 1);
        state.q[0] = -0.05;
        settle(&mut solver, &mut state)?;
        solver.store_open(&state);
        let mut step = Step::new(&mut solver, state, method);
        let h = 2.0 * std::f64::consts::PI / 120.0;
        let of = |at: &State| 0.5 * at.v[0].powi(2) + 50.0 * (at.q[0] + 0.1).powi(2);
        let begun = of(&step.to);
        let mut drift = 0.0_f64;
        for _ in 0..120_000 {
            step.begin();
            assert!(step.attempt(h, f64::INFINITY, &mut 0)?);
            drift = drift.max((of(&step.to) / begun - 1.0).abs());
        }
        println!("{method:?}: largest relative change of the energy {drift:.2e}");
        assert!(drift <= bound, "{method:?}: {drift}");
    }
    Ok(())
}
