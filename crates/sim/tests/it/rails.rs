//! Several rails of one structure in one contact problem: a crane on two coupled rails against a dense solution by hand.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::bogie;
use common::kutta::Kernel;
use nalgebra::{DMatrix, DVector};
use sim::{
    Analysis, BodyDof, Channel, Contact, Damper, Foundation, MotionKind, Profile, Scene, Status,
};
use splines::{Axis, Probe};

const GAUGE: f64 = 12.0;
const BASE: f64 = 7.0;
const SPEED: f64 = 3.0;
const LENGTH: f64 = 40.0;
/// Centre of mass off the middle, so that no two wheels carry alike.
const CG: [f64; 3] = [0.9, 4.0, 1.7];

/// Down by a unit force down: two rails that bend in a sine each, and together twice that; (value, slope by the first x).
fn give(rails: [usize; 2], x: f64, z: f64) -> [f64; 2] {
    let (a, b) = (
        std::f64::consts::PI / LENGTH,
        if rails[0] == rails[1] { 3.0 } else { 1.0 },
    );
    let shape = |k: f64, x: f64| (k * a * x).sin();
    let sum = |row: fn(f64, f64, f64) -> f64| -> f64 {
        [1.0, 2.0, 3.0]
            .iter()
            .map(|&k| row(k, a, x) * shape(k, z) / k.powi(4))
            .sum()
    };
    let value = sum(|k, a, x| (k * a * x).sin());
    let slope = sum(|k, a, x| k * a * (k * a * x).cos());
    [1e-8 * b * value, 1e-8 * b * slope]
}

/// A crane on two wheels a rail.
fn crane() -> Scene {
    let mut scene = bogie(0.0, 8.0, Damper::Rail);
    let body = &mut scene.bodies[0];
    (body.mass, body.inertia, body.cg) = (4e4, [1e6; 3], CG);
    body.free = [false, true, false, true, false, true];
    body.motion = Some(Profile::new(MotionKind::Speed, &[[0.0, SPEED]], 8.0, 0.0).expect("a row"));
    (
        scene.wheels[0].normal.stiffness,
        scene.wheels[0].normal.damping,
    ) = (2e7, 0.0);
    scene.contacts = (0..4)
        .map(|w| Contact {
            body: 0,
            structure: 0,
            rail: w / 2,
            at: [
                (f64::from(u8::from(w % 2 == 1)) - 0.5) * BASE,
                0.0,
                if w < 2 { -0.5 } else { 0.5 } * GAUGE,
            ],
            offsets: vec![0.0],
            wheel: 0,
        })
        .collect();
    scene.analysis = Analysis::QuasiStatic;
    scene.output_dt = 0.25;
    scene
}

#[test]
fn crane_on_two_rails_that_one_structure_couples_stands_as_the_dense_solution() {
    let scene = crane();
    let kernel = Kernel(|p: Probe, q: Probe| {
        let vertical = p.axis == Axis::Vertical && q.axis == Axis::Vertical;
        if vertical {
            give([p.rail, q.rail], p.x, q.x)
        } else {
            [0.0; 2]
        }
    });
    let foundation = Foundation::massless(Box::new(kernel), 2);
    let found =
        sim::run(&scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(found.status, Status::Done);
    let column = |channel| found.history.column(channel);
    let time = column(Channel::Time);
    let weight = 4e4 * scene.gravity;
    let (mut forces, mut moved, mut drives) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (row, t) in time.iter().enumerate() {
        let hub = |w: usize| scene.contacts[w].at;
        let x = |w: usize| 8.0 + SPEED * t + hub(w)[0];
        // Analytic: (G + 1/k) F + y + roll-free levers = 0 and balance, in one dense matrix of F, y, roll and pitch.
        let mut matrix = DMatrix::zeros(7, 7);
        let mut right = DVector::zeros(7);
        for i in 0..4 {
            for j in 0..4 {
                matrix[(i, j)] = give([i / 2, j / 2], x(i), x(j))[0];
            }
            matrix[(i, i)] += 1.0 / 2e7;
            // The hub's way down by y, roll and pitch.
            for (k, lever) in [-1.0, hub(i)[2], -hub(i)[0]].into_iter().enumerate() {
                matrix[(i, 4 + k)] = -lever;
                matrix[(4 + k, i)] = lever;
            }
        }
        for (k, lever) in [-1.0, CG[2], -CG[0]].into_iter().enumerate() {
            right[4 + k] = lever * weight;
        }
        let solved = matrix
            .lu()
            .solve(&right)
            .expect("a matrix that is not singular");
        let mut drive = 0.0;
        for i in 0..4 {
            assert!(solved[i] > 0.0, "every wheel carries");
            forces = forces.max((column(Channel::Vertical(i))[row] - solved[i]).abs() / weight);
            // Slope of the deflected rail: towards larger give the wheel is pushed, and its drive holds it.
            drive -= solved[i]
                * (0..4)
                    .map(|j| give([i / 2, j / 2], x(i), x(j))[1] * solved[j])
                    .sum::<f64>();
        }
        for (k, freedom) in [BodyDof::Y, BodyDof::Roll, BodyDof::Pitch]
            .into_iter()
            .enumerate()
        {
            let value = column(Channel::Displacement(0, freedom))[row];
            let scale = solved[4].abs() / [1.0, GAUGE, BASE][k];
            moved = moved.max((value - solved[4 + k]).abs() / scale);
        }
        drives = drives.max((column(Channel::Drive(0))[row] - drive).abs() / weight);
    }
    println!(
        "{} places: forces {forces:.1e}, motion {moved:.1e}, drive {drives:.1e}",
        time.len()
    );
    assert!(forces < 1e-12 && moved < 1e-12 && drives < 1e-12);
    let spread = column(Channel::Vertical(0))[0] / column(Channel::Vertical(3))[0];
    assert!(
        !(0.8..1.25).contains(&spread),
        "the wheels do not carry alike"
    );
}
