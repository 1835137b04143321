//! The steppers of diffsol (BDF of variable order; ESDIRK of order 3) beside ours, on equations of motion written here.

use std::ops::ControlFlow;

use diffsol::{
    DiffsolError, MatrixCommon, NalgebraLU, NalgebraMat, NalgebraVec, OdeBuilder,
    OdeEquationsImplicit, OdeSolverMethod, OdeSolverProblem,
};
use sim::{
    Actuators, Analysis, Body, BodyDof, Channel, Contact, Damper, Foundation, Friction,
    FrictionLaw, MotionKind, NormalLaw, Profile, Run, Scene, Status, Wheel,
};
use splines::{Axis, Compliance, Error, Influence, Probe};

type Mat = NalgebraMat<f64>;
type Lu = NalgebraLU<f64>;

const GRAVITY: f64 = 32.174;
const SPAN: f64 = 60.0;
const EI: f64 = 9.528 * 4.32e9;
const STIFFNESS: f64 = 1e8;
const DAMPING: f64 = 1e5;
const ARM: f64 = 4.0 / 3.0;
const MASS: f64 = 4.8e6 / GRAVITY;
const INERTIA: f64 = MASS * 2.25;

/// Stepper of diffsol.
#[derive(Clone, Copy, Debug)]
enum Stepper {
    Bdf,
    Esdirk,
}

/// States at `times`, one row a time.
fn solved<E>(
    problem: &OdeSolverProblem<E>,
    stepper: Stepper,
    times: &[f64],
) -> Result<Vec<Vec<f64>>, DiffsolError>
where
    E: OdeEquationsImplicit<M = Mat, T = f64, V = NalgebraVec<f64>, C = diffsol::NalgebraContext>,
{
    let states = match stepper {
        Stepper::Bdf => problem.bdf::<Lu>()?.solve_dense(times)?.0,
        Stepper::Esdirk => problem.esdirk34::<Lu>()?.solve_dense(times)?.0,
    };
    let rows = states.nrows();
    Ok((0..times.len())
        .map(|k| (0..rows).map(|i| states.inner()[(i, k)]).collect())
        .collect())
}

/// Influence of a simply supported beam with overhangs: |x - z|^3 / 12 EI less what its supports take back.
fn give(x: f64, z: f64) -> f64 {
    let kernel = |a: f64, b: f64| (a - b).abs().powi(3) / (12.0 * EI);
    let shares = |a: f64| [(0.0, 1.0 - a / SPAN), (SPAN, a / SPAN)];
    let mut sum = kernel(x, z);
    for (s, l) in shares(x) {
        sum -= l * kernel(s, z);
        for (r, m) in shares(z) {
            sum += l * m * kernel(s, r);
        }
    }
    shares(z)
        .iter()
        .fold(sum, |sum, (s, l)| sum - l * kernel(x, *s))
}

/// The same with its slope by central differences, exact for the cubic pieces but for the kinks' third derivatives.
struct Girder;

impl Compliance for Girder {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        let vertical = |p: &Probe| p.axis == Axis::Vertical;
        for (i, p) in at.iter().enumerate() {
            for (j, q) in at.iter().enumerate() {
                let both = vertical(p) && vertical(q);
                out.value[(i, j)] = if both { give(p.x, q.x) } else { 0.0 };
                out.slope[(i, j)] = if both {
                    (give(p.x + 1e-3, q.x) - give(p.x - 1e-3, q.x)) / 2e-3
                } else {
                    0.0
                };
            }
        }
        Ok(())
    }

    fn breaks(&self, _: usize) -> Vec<f64> {
        vec![0.0, SPAN]
    }

    fn range(&self, _: usize) -> Option<[f64; 2]> {
        Some([-15.0, 75.0])
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

/// Forces (G + 1/k) F = d + (c/k) d' of the bogie's wheels, rear and front.
fn wheel_forces(trunnion: f64, [z, pitch, z_rate, pitch_rate]: [f64; 4]) -> [f64; 2] {
    let [rear, front] = [trunnion - ARM, trunnion + ARM];
    let [a, b, c] = [
        give(rear, rear) + 1.0 / STIFFNESS,
        give(front, front) + 1.0 / STIFFNESS,
        give(rear, front),
    ];
    let drop = |arm: f64| z + arm * pitch + DAMPING / STIFFNESS * (z_rate + arm * pitch_rate);
    let [d, e] = [drop(-ARM), drop(ARM)];
    let determinant = a * b - c * c;
    [(b * d - c * e) / determinant, (a * e - c * d) / determinant]
}

/// z'', pitch'' less gravity: linear in the state.
fn pulled(trunnion: f64, state: &[f64], rate: &mut [f64]) {
    let [rear, front] = wheel_forces(trunnion, [state[0], state[1], state[2], state[3]]);
    rate[0] = state[2];
    rate[1] = state[3];
    rate[2] = -(rear + front) / MASS;
    rate[3] = -ARM * (front - rear) / INERTIA;
}

fn body(mass: f64) -> Body {
    Body {
        mass,
        inertia: [0.0; 3],
        cg: [0.0; 3],
        free: [false; 6],
        start: [0.0; 6],
        start_speed: [0.0; 6],
        motion: None,
        pinned: None,
    }
}

fn scene(body: Body, wheel: Wheel, offsets: &[f64], end: f64) -> Scene {
    let contact = |offset: &f64| Contact {
        body: 0,
        structure: 0,
        rail: 0,
        at: [0.0; 3],
        offsets: vec![*offset],
        wheel: 0,
    };
    Scene {
        gravity: GRAVITY,
        bodies: vec![body],
        wheels: vec![wheel],
        contacts: offsets.iter().map(contact).collect(),
        gauges: Vec::new(),
        actuators: Actuators::default(),
        analysis: Analysis::Dynamic,
        end,
        output_dt: end / 200.0,
        output_parts: 1,
        accuracy: 1e-9,
    }
}

fn ours(scene: &Scene, foundation: Foundation) -> Run {
    let run =
        sim::run(scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    run
}

/// Largest difference of `column` and component `i`, times `sign`, by the largest value.
fn apart(column: &[f64], states: &[Vec<f64>], i: usize, sign: f64) -> f64 {
    assert_eq!(column.len(), states.len());
    let largest = states
        .iter()
        .fold(0.0_f64, |max, row| max.max(row[i].abs()));
    let pairs = column.iter().zip(states);
    pairs.fold(0.0_f64, |max, (value, row)| {
        max.max((value - sign * row[i]).abs())
    }) / largest
}

fn times(run: &Run) -> Vec<f64> {
    run.history.column(Channel::Time)
}

#[test]
fn bogie_over_a_girder_without_mass_agrees_with_both_steppers() -> Result<(), DiffsolError> {
    let speed = 5.0;
    let mut bogie = body(MASS);
    bogie.inertia[2] = INERTIA;
    bogie.free = [false, true, false, false, false, true];
    bogie.motion =
        Some(Profile::new(MotionKind::Speed, &[[0.0, speed]], 0.0, 0.0).expect("a valid table"));
    let wheel = Wheel {
        radius: 1.25,
        normal: NormalLaw::linear(STIFFNESS, DAMPING, Damper::Ground),
        flange: None,
        friction: None,
        spin_inertia: None,
    };
    let run = ours(
        &scene(bogie, wheel, &[-ARM, ARM], 12.0),
        Foundation::massless(Box::new(Girder), 1),
    );
    // At rest each wheel carries half of the weight.
    let half = 0.5 * MASS * GRAVITY;
    let rear = half * (give(-ARM, -ARM) + give(-ARM, ARM) + 1.0 / STIFFNESS);
    let front = half * (give(ARM, ARM) + give(-ARM, ARM) + 1.0 / STIFFNESS);
    for stepper in [Stepper::Bdf, Stepper::Esdirk] {
        let mut problem = OdeBuilder::<Mat>::new()
            .rtol(1e-10)
            .atol(vec![1e-11, 1e-11, 1e-10, 1e-10])
            .rhs_implicit(
                |state, _, t, rate| {
                    pulled(speed * t, state, rate);
                    rate[2] += GRAVITY;
                },
                |_, _, t, change, rate| pulled(speed * t, change, rate),
            )
            .init(
                |_, _, state| {
                    state.copy_from_slice(&[
                        0.5 * (rear + front),
                        (front - rear) / (2.0 * ARM),
                        0.0,
                        0.0,
                    ]);
                },
                4,
            )
            .build()?;
        problem.ode_options.update_rhs_jacobian_after_steps = 1;
        let states = solved(&problem, stepper, &times(&run))?;
        let z = apart(
            &run.history.column(Channel::Displacement(0, BodyDof::Y)),
            &states,
            0,
            -1.0,
        );
        let pitch = apart(
            &run.history.column(Channel::Displacement(0, BodyDof::Pitch)),
            &states,
            1,
            -1.0,
        );
        println!(
            "{stepper:?}: z {z:.1e}, pitch {pitch:.1e}, {:?}",
            run.counts
        );
        assert!(z < 1e-6 && pitch < 1e-6, "{stepper:?}: {z:e} {pitch:e}");
    }
    Ok(())
}

const RADIUS: f64 = 1.25;
const MU: f64 = 0.2;
const SLIP: f64 = 0.1;
const WEIGHT: f64 = 5e6;
const SPIN: f64 = 0.5 * WEIGHT / GRAVITY * RADIUS * RADIUS;

/// Share of the full friction at the slip `s`, and its slope.
fn share(law: FrictionLaw, s: f64) -> (f64, f64) {
    let r = s / SLIP;
    match law {
        FrictionLaw::Coulomb => (r.tanh(), (1.0 - r.tanh().powi(2)) / SLIP),
        FrictionLaw::Step if r.abs() < 1.0 => (0.5 * r * (3.0 - r * r), 1.5 * (1.0 - r * r) / SLIP),
        FrictionLaw::Step => (r.signum(), 0.0),
    }
}

/// Penetration p, its rate, speed v along the rail, spin w: m p'' = m g - N, N = k p + c p', m v' = -T,
/// I w' = -(R - p) T, T = mu N S(v + w (R - p)).
#[test]
fn sliding_wheel_that_bounces_agrees_with_both_steppers() -> Result<(), DiffsolError> {
    let mass = WEIGHT / GRAVITY;
    for law in [FrictionLaw::Coulomb, FrictionLaw::Step] {
        let mut sliding = body(mass);
        sliding.free = [true, true, false, false, false, false];
        sliding.start_speed = [10.0, -0.5, 0.0, 0.0, 0.0, 0.0];
        let wheel = Wheel {
            radius: RADIUS,
            normal: NormalLaw::linear(STIFFNESS, DAMPING, Damper::Rail),
            flange: None,
            friction: Some(Friction {
                law,
                coefficient: MU,
                slip: SLIP,
            }),
            spin_inertia: Some(SPIN),
        };
        let run = ours(&scene(sliding, wheel, &[0.0], 1.0), Foundation::rigid());
        let start = -run.history.column(Channel::Displacement(0, BodyDof::Y))[0];
        for stepper in [Stepper::Bdf, Stepper::Esdirk] {
            let mut problem = OdeBuilder::<Mat>::new()
                .rtol(1e-10)
                .atol(vec![1e-11; 4])
                .rhs_implicit(
                    |state, _, _, rate| {
                        let [p, p_rate, v, w] = [state[0], state[1], state[2], state[3]];
                        let normal = STIFFNESS * p + DAMPING * p_rate;
                        let friction = MU * normal * share(law, v + w * (RADIUS - p)).0;
                        rate[0] = p_rate;
                        rate[1] = GRAVITY - normal / mass;
                        rate[2] = -friction / mass;
                        rate[3] = -(RADIUS - p) * friction / SPIN;
                    },
                    |state, _, _, change, rate| {
                        let [p, p_rate, v, w] = [state[0], state[1], state[2], state[3]];
                        let normal = STIFFNESS * p + DAMPING * p_rate;
                        let (share, slope) = share(law, v + w * (RADIUS - p));
                        let more = STIFFNESS * change[0] + DAMPING * change[1];
                        let faster = change[2] + change[3] * (RADIUS - p) - w * change[0];
                        let friction = MU * (more * share + normal * slope * faster);
                        rate[0] = change[1];
                        rate[1] = -more / mass;
                        rate[2] = -friction / mass;
                        rate[3] =
                            (change[0] * MU * normal * share - (RADIUS - p) * friction) / SPIN;
                    },
                )
                .init(
                    |_, _, state| state.copy_from_slice(&[start, 0.5, 10.0, 0.0]),
                    4,
                )
                .build()?;
            problem.ode_options.update_rhs_jacobian_after_steps = 1;
            let states = solved(&problem, stepper, &times(&run))?;
            let errors = [
                apart(
                    &run.history.column(Channel::Displacement(0, BodyDof::Y)),
                    &states,
                    0,
                    -1.0,
                ),
                apart(
                    &run.history.column(Channel::Speed(0, BodyDof::X)),
                    &states,
                    2,
                    1.0,
                ),
                apart(&run.history.column(Channel::SpinSpeed(0)), &states, 3, 1.0),
            ];
            println!("{law:?} {stepper:?}: {errors:?}, {:?}", run.counts);
            assert!(
                errors.iter().all(|error| *error < 1e-6),
                "{law:?} {stepper:?}: {errors:?}"
            );
        }
    }
    Ok(())
}
