//! Work and precision of the public `run` on crossings of the paper's girder, and its cost by the number of wheels.
//!
//! ```text
//! cargo run --release -p sim --example crossings            scene,accuracy,error,steps,least ms,median ms
//! cargo run --release -p sim --example crossings -- wheels  n,steps,stages,events,us a step,residual
//! ```
//!
//! Errors are the largest of the deflection over 101 samples, of its peak, against `fea/reference`. History, audit
//! and events are on. Settings are interleaved: every repetition runs all of them.

#![allow(clippy::print_stdout, reason = "the figures are what the example is for")]

#[path = "../tests/common/mod.rs"]
mod common;

use std::ops::ControlFlow;
use std::time::Instant;

use common::{bogie, reference, surface};
use sim::{Channel, Damper, Error, Foundation, Freedom, Run, Scene};

const SLOW: &str = include_str!("../../../fea/reference/bogie_s1.json");
const FAST: &str = include_str!("../../../fea/reference/bogie_s2.json");
const REPETITIONS: usize = 25;

fn main() -> Result<(), Error> {
    if std::env::args().nth(1).as_deref() == Some("wheels") { wheels() } else { crossings() }
}

fn solve(scene: &Scene, foundations: &[Foundation]) -> Result<Run, Error> {
    sim::run(scene, foundations, &mut |_| ControlFlow::Continue(()))
}

fn crossings() -> Result<(), Error> {
    let foundations = [Foundation::influence(Box::new(surface()), 1)];
    let mut settings = Vec::new();
    for (name, scene, text) in
        [("S1", bogie(5.0, 12.0, Damper::Ground), SLOW), ("S2", bogie(100.0, 0.55, Damper::Ground), FAST)]
    {
        let wanted = reference(text);
        for tenths in 4..=16 {
            let mut scene = scene.clone();
            scene.accuracy = 10_f64.powf(-f64::from(tenths) / 2.0 + 1.0);
            settings.push((name, scene, wanted.clone(), Vec::new()));
        }
    }
    for _ in 0..REPETITIONS {
        for (_, scene, _, times) in &mut settings {
            let start = Instant::now();
            std::hint::black_box(solve(scene, &foundations)?);
            times.push(1e3 * start.elapsed().as_secs_f64());
        }
    }
    println!("scene,accuracy,error,steps,least ms,median ms");
    for (name, scene, wanted, times) in &mut settings {
        let run = solve(scene, &foundations)?;
        let y = run.history.column(Channel::Displacement(0, Freedom::Y));
        let peak = wanted.iter().fold(0.0_f64, |max, row| max.max(row[1]));
        let error = wanted.iter().zip(y).fold(0.0_f64, |max, (row, y)| max.max((y + row[1]).abs())) / peak;
        times.sort_by(f64::total_cmp);
        let (least, median) = (times[0], times[times.len() / 2]);
        println!("{name},{:.3e},{error:.3e},{},{least:.5},{median:.5}", scene.accuracy, run.counts.steps);
    }
    Ok(())
}

/// The bogie's load on n wheels 32 in to 0.02 ft apart, 5 ft/s from 25 to 26 ft: all stay within the span.
fn wheels() -> Result<(), Error> {
    println!("n,steps,stages,events,us a step,residual");
    for n in [1_u32, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1000] {
        let foundations = [Foundation::influence(Box::new(surface()), 1)];
        let mut scene = bogie(5.0, 0.2, Damper::Rail);
        scene.bodies[0].start[0] = 25.0;
        scene.accuracy = 1e-3;
        scene.wheels[0].normal.stiffness = 2e8 / f64::from(n);
        scene.wheels[0].normal.damping = 2e5 / f64::from(n);
        let pattern = scene.contacts[0].clone();
        let spacing = (8.0 / 3.0_f64).min(20.0 / f64::from(n));
        scene.contacts = (0..n)
            .map(|i| {
                let mut contact = pattern.clone();
                contact.offsets = vec![spacing * (f64::from(i) - 0.5 * f64::from(n - 1))];
                contact
            })
            .collect();
        // One wheel cannot hold a pitch.
        scene.bodies[0].free[5] = n > 1;
        // A run of some milliseconds: one stall of the machine would be most of it.
        let mut us = f64::INFINITY;
        let mut run = None;
        for _ in 0..if n > 256 { 1 } else { 5 } {
            let start = Instant::now();
            let done = run.insert(solve(&scene, &foundations)?);
            us = us.min(1e6 * start.elapsed().as_secs_f64() / done.counts.steps.max(1) as f64);
        }
        let Some(run) = run else { continue };
        let sim::Counts { steps, stages, events, .. } = run.counts;
        println!("{n},{steps},{stages},{events},{us:.2},{:.1e}", run.audit.residual());
    }
    Ok(())
}
