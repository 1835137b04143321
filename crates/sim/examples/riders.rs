//! Time of one pass over the equations of scenes whose bodies ride on bodies.
//!
//! ```text
//! cargo run --release -p girderway-sim --example riders      scene,freedoms,steps,stages,us a stage,residual
//! ```
//!
//! A bridge on four wheels, a trolley on four that crosses it; least of nine runs. History, audit and events are on.

#![allow(
    clippy::print_stdout,
    reason = "the figures are what the example is for"
)]

#[path = "../tests/it/common/mod.rs"]
mod common;

use std::ops::ControlFlow;
use std::time::Instant;

use common::crane::{carried, crane, travelling};
use sim::{BodyDof, Error, Foundation};

const REPETITIONS: usize = 9;

fn main() -> Result<(), Error> {
    use BodyDof::{Pitch, Roll, X, Y, Yaw, Z};
    println!("scene,freedoms,steps,stages,us a stage,residual");
    for (name, bridge, trolley) in [
        ("plane", &[Y, Pitch][..], &[Y, Pitch][..]),
        ("level", &[Y, Roll, Pitch], &[Y, Roll, Pitch]),
        ("all", &[X, Y, Z, Roll, Yaw, Pitch], &[Y, Roll, Pitch]),
    ] {
        let mut scene = crane(bridge, trolley, 4.0);
        scene.bodies[1].motion = travelling(3.0, -6.0);
        scene.accuracy = 1e-7;
        let mut least = f64::INFINITY;
        let mut figures = (0, 0, 0.0);
        for _ in 0..REPETITIONS {
            let foundations = [
                Foundation::rigid(),
                carried([0.0, 0.0, 1.0], [1.5, 3.0, -2.0]),
            ];
            let start = Instant::now();
            let run = sim::run(&scene, &foundations, &mut |_| ControlFlow::Continue(()))?;
            least = least.min(start.elapsed().as_secs_f64());
            figures = (run.counts.steps, run.counts.stages, run.audit.residual());
        }
        let (steps, stages, residual) = figures;
        let freedoms = bridge.len() + trolley.len();
        println!(
            "{name},{freedoms},{steps},{stages},{:.2},{residual:.1e}",
            1e6 * least / stages as f64
        );
    }
    Ok(())
}
