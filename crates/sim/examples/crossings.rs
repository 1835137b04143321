//! Work and precision of the public `run` on crossings of the paper's girder, and its cost by the number of wheels.
//!
//! ```text
//! cargo run --release -p girderway-sim --example crossings            scene,accuracy,steps,least ms,median ms,most ms,z,forces
//! cargo run --release -p girderway-sim --example crossings -- wheels  n,steps,stages,events,us a step,residual
//! ```
//!
//! S1 and S2 are the bogie at 5 and 100 ft/s, S3 eight wheels under a carriage at 10 ft/s, S4 a sprung mass over Yang and
//! Yau's bridge; "beam" has the mass of the girder, in its lowest modes. z is the body's deflection at 101 times, and the
//! vertical forces of each wheel at these times follow, one wheel after the other; `fea/bench_scenes.py` compares both.
//! History, audit and events are on. Settings are interleaved: every repetition runs all.

#![allow(
    clippy::print_stdout,
    reason = "the figures are what the example is for"
)]

#[path = "../tests/it/common/mod.rs"]
mod common;
#[path = "crossings/mesh.rs"]
mod mesh;

use std::ops::ControlFlow;

use common::{EI, GRAVITY, SPAN, WEIGHT, bogie, surface};
use mesh::Beam;
use rustix::time::{ClockId, clock_gettime};
use sim::{
    Body, BodyDof, Channel, Contact, Damper, Error, Foundation, Method, Pin, Run, Scene, Status,
    run_by,
};
use splines::{Axis, Compliance, Influence, Probe};

const REPETITIONS: usize = 15;

fn main() -> Result<(), Error> {
    if std::env::args().nth(1).as_deref() == Some("wheels") {
        wheels()
    } else {
        crossings()
    }
}

/// Time that this thread has worked, ms: other jobs of the machine do not count.
fn clock() -> f64 {
    let now = clock_gettime(ClockId::ThreadCPUTime);
    1e3 * now.tv_sec as f64 + 1e-6 * now.tv_nsec as f64
}

fn solve(scene: &Scene, foundations: &[Foundation]) -> Result<Run, Error> {
    run_by(Method::Auto, scene, foundations, &mut |_| {
        ControlFlow::Continue(())
    })
}

/// The span of Yang and Yau's bridge, m, and its bending stiffness, N m^2.
const BRIDGE: (f64, f64) = (25.0, 2.87e9 * 2.90);

/// Give of a simply supported span: (L - z) x (2 L z - z^2 - x^2) / 6 L E I for x <= z.
struct Bridge;

impl Compliance for Bridge {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), splines::Error> {
        let (length, bending) = BRIDGE;
        for (i, p) in at.iter().enumerate() {
            for (j, q) in at.iter().enumerate() {
                let (x, z, sign) = if p.x <= q.x {
                    (p.x, q.x, 1.0)
                } else {
                    (length - p.x, length - q.x, -1.0)
                };
                let by = (length - z) / (6.0 * length * bending);
                let vertical = p.axis == Axis::Vertical && q.axis == Axis::Vertical;
                let scale = if vertical { by } else { 0.0 };
                out.value[(i, j)] = scale * x * (2.0 * length * z - z * z - x * x);
                out.slope[(i, j)] = sign * scale * (2.0 * length * z - z * z - 3.0 * x * x);
            }
        }
        Ok(())
    }

    fn breaks(&self, _: usize) -> Vec<f64> {
        vec![0.0, BRIDGE.0]
    }

    fn range(&self, _: usize) -> Option<[f64; 2]> {
        // the last place comes out of a product
        Some([0.0, BRIDGE.0 * (1.0 + 1e-12)])
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

/// A sprung mass at 100 km/h, N, m, s.
fn car() -> Scene {
    let mut scene = bogie(BRIDGE.0 / 0.9, 0.9, Damper::Rail);
    scene.gravity = 9.81;
    scene.bodies[0].mass = 5750.0;
    scene.bodies[0].inertia = [0.0; 3];
    scene.bodies[0].free[5] = false;
    scene.wheels[0].normal.stiffness = 1595e3;
    scene.wheels[0].normal.damping = 0.0;
    scene.contacts.truncate(1);
    scene.contacts[0].offsets = vec![0.0];
    scene
}

/// A carriage on two equalisers on four bogies, eight wheels, 4.8e6 lb in all, at 10 ft/s.
fn train() -> Scene {
    let mut scene = bogie(10.0, 6.0, Damper::Ground);
    let mass = WEIGHT / GRAVITY - 1800.0;
    scene.bodies[0].mass = mass;
    scene.bodies[0].inertia[2] = 64.0 * mass;
    let rider = |to: usize, at: f64, inertia: f64| Body {
        mass: 300.0,
        inertia: [0.0, 0.0, inertia],
        free: [false, false, false, false, false, true],
        motion: None,
        pinned: Some(Pin {
            body: to,
            at: [at, 0.0, 0.0],
        }),
        ..scene.bodies[0].clone()
    };
    let equalisers = [-6.0, 6.0].map(|at| rider(0, at, 2700.0));
    let bogies = [(1, -3.0), (1, 3.0), (2, -3.0), (2, 3.0)].map(|(to, at)| rider(to, at, 300.0));
    scene.bodies.extend(equalisers);
    scene.bodies.extend(bogies);
    let wheel = scene.contacts[0].clone();
    let pair = |body| {
        [-4.0 / 3.0, 4.0 / 3.0].map(|at| Contact {
            body,
            offsets: vec![at],
            ..wheel.clone()
        })
    };
    scene.contacts = (3..7).flat_map(pair).collect();
    scene.wheels[0].normal.bilateral = true;
    scene
}

fn crossings() -> Result<(), Error> {
    let girder = || Foundation::massless(Box::new(surface()), 1);
    let paper = Beam {
        span: SPAN,
        overhang: 15.0,
        bending: EI,
        mass: 15.2,
    };
    let bridge = Beam {
        span: BRIDGE.0,
        overhang: 0.0,
        bending: BRIDGE.1,
        mass: 2303.0,
    };
    let none = Error::Number {
        what: "mass",
        wanted: "positive",
        found: 0.0,
    };
    let massive = |modes| {
        paper
            .foundation(1.25, modes, surface())
            .ok_or_else(|| none.clone())
    };
    let heavy = |modes| {
        bridge
            .foundation(BRIDGE.0 / 48.0, modes, Bridge)
            .ok_or_else(|| none.clone())
    };
    let (slow, quick) = ((5.0, 12.0), (100.0, 0.55));
    let mut scenes = vec![
        (
            "S1",
            String::new(),
            bogie(slow.0, slow.1, Damper::Ground),
            girder(),
        ),
        (
            "S2",
            String::new(),
            bogie(quick.0, quick.1, Damper::Ground),
            girder(),
        ),
        ("S3", String::new(), train(), girder()),
    ];
    for modes in [2, 6] {
        let told = format!(" {modes} modes");
        scenes.push((
            "S1 beam",
            told.clone(),
            bogie(slow.0, slow.1, Damper::Rail),
            massive(modes)?,
        ));
        scenes.push((
            "S2 beam",
            told.clone(),
            bogie(quick.0, quick.1, Damper::Rail),
            massive(modes)?,
        ));
        scenes.push(("S4 beam", told, car(), heavy(modes)?));
    }
    let mut settings = Vec::new();
    for (name, told, scene, foundation) in scenes {
        let foundations = [foundation];
        let mut rows = Vec::new();
        for tenths in (4..=14).step_by(if told.is_empty() { 1 } else { 2 }) {
            let mut scene = scene.clone();
            scene.output_dt = scene.end / 100.0;
            // the last row is at the end to the last bit
            scene.end = 100.0 * scene.output_dt;
            scene.accuracy = 10_f64.powf(-f64::from(tenths) / 2.0 + 1.0);
            rows.push((scene, Vec::new()));
        }
        settings.push((name, told, foundations, rows));
    }
    for _ in 0..REPETITIONS {
        for (.., foundations, rows) in &mut settings {
            for (scene, times) in rows {
                let start = clock();
                std::hint::black_box(solve(scene, foundations)?);
                times.push(clock() - start);
            }
        }
    }
    println!("scene,setting,steps,least ms,median ms,most ms,z,forces");
    for (name, told, foundations, rows) in &mut settings {
        for (scene, times) in rows {
            let run = solve(scene, foundations)?;
            assert_eq!(run.status, Status::Done, "{name}");
            let y = run.history.column(Channel::Displacement(0, BodyDof::Y));
            times.sort_by(f64::total_cmp);
            let (least, median, most) = (times[0], times[times.len() / 2], times[times.len() - 1]);
            print!(
                "{name},{:.3e}{told},{},{least:.5},{median:.5},{most:.5}",
                scene.accuracy, run.counts.steps
            );
            y.iter().for_each(|y| print!(",{:.10e}", -y));
            for wheel in 0..scene.contacts.len() {
                let forces = run.history.column(Channel::Vertical(wheel));
                forces.iter().for_each(|force| print!(",{force:.10e}"));
            }
            println!();
        }
    }
    Ok(())
}

/// The bogie's load on n wheels 32 in to 0.02 ft apart, 5 ft/s from 25 to 26 ft: all stay within the span.
fn wheels() -> Result<(), Error> {
    println!("n,steps,stages,events,us a step,residual");
    for n in [1_u32, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1000] {
        let foundations = [Foundation::massless(Box::new(surface()), 1)];
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
            let start = clock();
            let watch = &mut |_| ControlFlow::Continue(());
            let done = run.insert(sim::run(&scene, &foundations, watch)?);
            us = us.min(1e3 * (clock() - start) / done.counts.steps.max(1) as f64);
        }
        let Some(run) = run else { continue };
        let sim::Counts {
            steps,
            stages,
            events,
            ..
        } = run.counts;
        println!(
            "{n},{steps},{stages},{events},{us:.2},{:.1e}",
            run.audit.residual()
        );
    }
    Ok(())
}
