//! Carriages on equalisers with mass: trees of pinned bodies against derivations of their own.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::{GRAVITY, WEIGHT, bogie, girder, give};
use nalgebra::{DMatrix, DVector, SMatrix, SVector};
use sim::{Analysis, Body, BodyDof, Channel, Contact, Damper, Error, Pin, Run, Scene, Status};

const WHEEL: f64 = 4.0 / 3.0;
/// Body, pin on it, mass and inertia of every body after the carriage.
const TREE: [(usize, f64, f64, f64); 6] = [
    (0, -6.0, 300.0, 2700.0),
    (0, 6.0, 300.0, 2700.0),
    (1, -3.0, 300.0, 300.0),
    (1, 3.0, 300.0, 300.0),
    (2, -3.0, 300.0, 300.0),
    (2, 3.0, 300.0, 300.0),
];
const SPEED: f64 = 10.0;
const STIFFNESS: f64 = 1e8;
const DAMPING: f64 = 1e5;

fn carriage_mass() -> f64 {
    WEIGHT / GRAVITY - TREE.iter().map(|(_, _, mass, _)| mass).sum::<f64>()
}

/// Carriage, two equalisers, four bogies and eight wheels.
fn carriage(end: f64) -> Scene {
    let mut scene = bogie(SPEED, end, Damper::Ground);
    let mass = carriage_mass();
    (scene.bodies[0].mass, scene.bodies[0].inertia) = (mass, [0.0, 0.0, 64.0 * mass]);
    for (to, at, mass, inertia) in TREE {
        scene.bodies.push(Body {
            mass,
            inertia: [0.0, 0.0, inertia],
            cg: [0.0; 3],
            free: [false, false, false, false, false, true],
            start: [0.0; 6],
            start_speed: [0.0; 6],
            motion: None,
            pinned: Some(Pin {
                body: to,
                at: [at, 0.0, 0.0],
            }),
        });
    }
    let contact = |body, offset| Contact {
        body,
        offsets: vec![offset],
        ..scene.contacts[0].clone()
    };
    scene.contacts = (3..7)
        .flat_map(|body| [contact(body, -WHEEL), contact(body, WHEEL)])
        .collect();
    scene
}

fn run(scene: &Scene) -> Run {
    let run =
        sim::run(scene, &[girder()], &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    run
}

/// Analytic: seven bodies in absolute heights and pitches, pinned by Lagrange multipliers, RK4 in force form.
struct Reference {
    /// Accelerations per force on the 14 coordinates.
    inverse: DMatrix<f64>,
    /// Wheels x coordinates: heights of the wheels.
    wheels: DMatrix<f64>,
    /// Offsets of the wheels from the carriage.
    offsets: [f64; 8],
    weight: DVector<f64>,
}

impl Reference {
    fn new() -> Self {
        let mut saddle = DMatrix::zeros(20, 20);
        let mut weight = DVector::zeros(20);
        let mass = carriage_mass();
        (saddle[(0, 0)], saddle[(1, 1)], weight[0]) = (mass, 64.0 * mass, -mass * GRAVITY);
        let mut place = [0.0; 7];
        for (i, (to, at, mass, inertia)) in TREE.into_iter().enumerate() {
            let body = i + 1;
            place[body] = place[to] + at;
            (
                saddle[(2 * body, 2 * body)],
                saddle[(2 * body + 1, 2 * body + 1)],
            ) = (mass, inertia);
            weight[2 * body] = -mass * GRAVITY;
            for (column, value) in [(2 * body, 1.0), (2 * to, -1.0), (2 * to + 1, -at)] {
                (saddle[(14 + i, column)], saddle[(column, 14 + i)]) = (value, value);
            }
        }
        let mut wheels = DMatrix::zeros(8, 14);
        let mut offsets = [0.0; 8];
        for wheel in 0..8 {
            let (body, offset) = (3 + wheel / 2, if wheel % 2 == 0 { -WHEEL } else { WHEEL });
            (wheels[(wheel, 2 * body)], wheels[(wheel, 2 * body + 1)]) = (1.0, offset);
            offsets[wheel] = place[body] + offset;
        }
        let inverse = saddle.try_inverse().expect("pins do not repeat each other");
        Reference {
            inverse,
            wheels,
            offsets,
            weight,
        }
    }

    fn compliance(&self, t: f64) -> SMatrix<f64, 8, 8> {
        let x = |i: usize| SPEED * t + self.offsets[i];
        SMatrix::from_fn(|i, j| give(x(i), x(j)).0)
    }

    /// All wheels carry alike: every pin lies midway.
    fn start(&self) -> DVector<f64> {
        let each = WEIGHT / 8.0;
        let down = self.compliance(0.0) * SVector::<f64, 8>::repeat(each);
        let wheel = |i: usize| -down[i] - each / STIFFNESS;
        let mut q = DVector::zeros(28);
        for body in 3..7 {
            let (rear, front) = (wheel(2 * body - 6), wheel(2 * body - 5));
            (q[2 * body], q[2 * body + 1]) = (0.5 * (rear + front), 0.5 * (front - rear) / WHEEL);
        }
        for (body, [rear, front], half) in [(1, [3, 4], 3.0), (2, [5, 6], 3.0), (0, [1, 2], 6.0)] {
            let (rear, front) = (q[2 * rear], q[2 * front]);
            (q[2 * body], q[2 * body + 1]) = (0.5 * (rear + front), 0.5 * (front - rear) / half);
        }
        q
    }

    fn forces(&self, t: f64, state: &DVector<f64>) -> SVector<f64, 8> {
        let down = |from: usize| -(&self.wheels * state.rows(from, 14));
        let (d, rate) = (down(0), down(14));
        let matrix = self.compliance(t) + SMatrix::identity() / STIFFNESS;
        let rhs = SVector::from_fn(|i, _| d[i] + DAMPING / STIFFNESS * rate[i]);
        matrix.lu().solve(&rhs).expect("positive definite")
    }

    fn rate(&self, t: f64, state: &DVector<f64>) -> DVector<f64> {
        let mut load = self.weight.clone();
        let forces = self.forces(t, state);
        let lifted = self.wheels.transpose() * DVector::from_column_slice(forces.as_slice());
        load.rows_mut(0, 14)
            .zip_apply(&lifted, |load, up| *load += up);
        let accelerations = &self.inverse * load;
        DVector::from_fn(28, |i, _| {
            if i < 14 {
                state[14 + i]
            } else {
                accelerations[i - 14]
            }
        })
    }

    fn step(&self, t: f64, h: f64, state: &DVector<f64>) -> DVector<f64> {
        let k1 = self.rate(t, state);
        let k2 = self.rate(t + 0.5 * h, &(state + 0.5 * h * &k1));
        let k3 = self.rate(t + 0.5 * h, &(state + 0.5 * h * &k2));
        let k4 = self.rate(t + h, &(state + h * &k3));
        state + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    }
}

/// Largest errors of the carriage's deflection and of the wheel forces, relative to their peaks.
fn errors(run: &Run, h: f64) -> [f64; 2] {
    let reference = Reference::new();
    let (time, y) = (
        run.history.column(Channel::Time),
        run.history.column(Channel::Displacement(0, BodyDof::Y)),
    );
    let wheels: Vec<Vec<f64>> = (0..8)
        .map(|w| run.history.column(Channel::Vertical(w)))
        .collect();
    let (mut state, mut peak, mut worst) = (reference.start(), [0.0_f64; 2], [0.0_f64; 2]);
    let (mut t, mut done) = (0.0, 0);
    for (i, &sample) in time.iter().enumerate() {
        let steps = ((sample - t) / h).round() as usize;
        for _ in 0..steps {
            state = reference.step(done as f64 * h, h, &state);
            done += 1;
        }
        t = sample;
        let forces = reference.forces(t, &state);
        peak[0] = peak[0].max(state[0].abs());
        worst[0] = worst[0].max((y[i] - state[0]).abs());
        for w in 0..8 {
            assert!(forces[w] > 0.0, "the reference knows no separation");
            peak[1] = peak[1].max(forces[w]);
            worst[1] = worst[1].max((wheels[w][i] - forces[w]).abs());
        }
    }
    [worst[0] / peak[0], worst[1] / peak[1]]
}

/// The audit keeps what the method itself loses; no quadrature takes that out.
#[test]
fn eight_wheels_under_massive_equalisers_follow_lagrange_multipliers() {
    for (accuracy, bound) in [(1e-3, 1e-3), (1e-7, 1e-8)] {
        let mut scene = carriage(0.5);
        (scene.accuracy, scene.output_dt) = (accuracy, 0.025);
        let run = run(&scene);
        let [z, force] = errors(&run, 2.5e-4);
        println!(
            "asked {accuracy:.0e}: z {z:.1e}, wheel force {force:.1e}, residual {:.1e}, {:?}",
            run.audit.residual(),
            run.counts
        );
        assert!(z < bound, "z errs by {z}");
        assert!(force < 10.0 * bound, "a wheel force errs by {force}");
        assert!(
            run.audit.residual() < 0.03 * bound,
            "energy residual {}",
            run.audit.residual()
        );
    }
}

#[test]
fn a_tree_at_rest_is_the_carriage_on_massless_equalisers() {
    let mut tree = carriage(6.0);
    (tree.analysis, tree.output_dt) = (Analysis::QuasiStatic, 0.5);
    let mut nested = bogie(SPEED, 6.0, Damper::Ground);
    (nested.analysis, nested.output_dt) = (Analysis::QuasiStatic, 0.5);
    let offsets = |side: f64| {
        [-3.0 - WHEEL, -3.0 + WHEEL, 3.0 - WHEEL, 3.0 + WHEEL]
            .map(|offset| offset + side)
            .to_vec()
    };
    nested.contacts = [-6.0, 6.0]
        .map(|side| Contact {
            offsets: offsets(side),
            ..nested.contacts[0].clone()
        })
        .to_vec();
    let (tree, nested) = (run(&tree), run(&nested));
    for freedom in [BodyDof::X, BodyDof::Y, BodyDof::Pitch] {
        let [a, b] =
            [&tree, &nested].map(|run| run.history.column(Channel::Displacement(0, freedom)));
        for (a, b) in a.iter().zip(&b) {
            assert!(
                (a - b).abs() < 1e-10 * (1.0 + b.abs()),
                "{freedom:?}: {a} and {b}"
            );
        }
    }
    for w in 0..8 {
        let [places, others] = [&tree, &nested].map(|run| run.history.column(Channel::Position(w)));
        for (x, other) in places.iter().zip(&others) {
            assert!(
                (x - other).abs() < 1e-12 * 100.0,
                "wheel {w} at {x} and {other}"
            );
        }
        for force in tree.history.column(Channel::Vertical(w)) {
            assert!(
                (force - WEIGHT / 8.0).abs() < 1e-8 * WEIGHT,
                "wheel {w} carries {force}"
            );
        }
    }
}

#[test]
fn pins_in_a_circle_and_translations_of_pinned_bodies_are_refused() {
    let refused =
        |scene: &Scene| sim::run(scene, &[girder()], &mut |_| ControlFlow::Continue(())).err();
    let mut circle = carriage(0.5);
    circle.bodies[1].pinned = Some(Pin {
        body: 3,
        at: [0.0; 3],
    });
    assert!(matches!(refused(&circle), Some(Error::Pinned { .. })));
    let mut sliding = carriage(0.5);
    sliding.bodies[2].free[0] = true;
    assert_eq!(refused(&sliding), Some(Error::Pinned { body: 2 }));
    let mut nowhere = carriage(0.5);
    nowhere.bodies[2].pinned = Some(Pin {
        body: 9,
        at: [0.0; 3],
    });
    assert_eq!(
        refused(&nowhere),
        Some(Error::NoSuch {
            what: "body",
            index: 9
        })
    );
}
