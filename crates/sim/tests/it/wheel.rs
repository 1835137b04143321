//! The wheel of the paper's Fig. 1, lift-off, and the flange.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::{GRAVITY, bogie, girder};
use sim::{
    Analysis, Body, BodyDof, Channel, Contact, Damper, Flange, Foundation, Friction, FrictionLaw,
    NormalLaw, Run, Scene, Status, Wheel,
};

const LOAD: f64 = 5e6;

fn impact() -> NormalLaw {
    NormalLaw {
        stiffness: 1e8,
        exponent: 1.1,
        damping: 0.0,
        depth: 0.0,
        damper: Damper::Rail,
        bilateral: false,
    }
}

/// W = 5e6 lb, radius 1.25 ft, mu 0.2, slip 0.1 ft/s, starting at 10 ft/s without spin.
fn wheel() -> Scene {
    let mass = LOAD / GRAVITY;
    Scene {
        gravity: GRAVITY,
        bodies: vec![Body {
            mass,
            inertia: [0.0; 3],
            cg: [0.0; 3],
            free: [true, true, false, false, false, false],
            start: [0.0; 6],
            start_speed: [10.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            motion: None,
            pinned: None,
        }],
        wheels: vec![Wheel {
            radius: 1.25,
            normal: impact(),
            flange: None,
            friction: Some(Friction {
                law: FrictionLaw::Step,
                coefficient: 0.2,
                slip: 0.1,
            }),
            spin_inertia: Some(mass * 1.25 * 1.25 / 2.0),
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
        actuators: sim::Actuators::default(),
        analysis: Analysis::Dynamic,
        end: 1.0,
        output_dt: 1e-3,
        output_parts: 1,
        accuracy: 1e-7,
    }
}

fn run(scene: &Scene, foundation: Foundation) -> Run {
    let run =
        sim::run(scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    run
}

/// Slip velocity of the contact point over time.
fn slips(run: &Run) -> Vec<f64> {
    let speed = run.history.column(Channel::Speed(0, BodyDof::X));
    let spin = run.history.column(Channel::SpinSpeed(0));
    let depth = run.history.column(Channel::Penetration(0));
    (0..speed.len())
        .map(|i| speed[i] + spin[i] * (1.25 - depth[i]))
        .collect()
}

#[test]
fn sliding_wheel_needs_the_closed_form_time_until_it_almost_rolls() {
    let mut scene = wheel();
    scene.output_dt = 1e-5;
    let run = run(&scene, Foundation::rigid());
    let time = run.history.column(Channel::Time);
    let slip = slips(&run);
    let i = slip
        .iter()
        .position(|&s| s <= 0.1)
        .expect("the wheel almost rolls");
    let share = (slip[i - 1] - 0.1) / (slip[i - 1] - slip[i]);
    let found = time[i - 1] + share * (time[i] - time[i - 1]);
    // Analytic: constant friction until then; R = 1.25 - (W/1e8)^(1/1.1).
    let radius = 1.25 - (LOAD / 1e8_f64).powf(1.0 / 1.1);
    let mass = LOAD / GRAVITY;
    let closed = 9.9 / (0.2 * LOAD * (1.0 / mass + radius * radius / (mass * 1.25 * 1.25 / 2.0)));
    println!(
        "found {found:.7}, closed form {closed:.7}, residual {:.1e}",
        run.audit.residual()
    );
    assert!((closed - 0.550_366).abs() < 1e-6);
    assert!((found - closed).abs() < 1e-5 * closed);
    assert!(run.audit.residual() < 1e-6);
    let (last, speed) = (
        slip.len() - 1,
        run.history.column(Channel::Speed(0, BodyDof::X)),
    );
    assert!(
        slip[last].abs() < 1e-3 && speed[last] > 5.0,
        "the wheel rolls on"
    );
}

/// Analytic: with A = 1/m + R^2/I, s' = -mu N A tanh(s / slip), so sinh(s / slip) decays at the rate mu N A / slip.
#[test]
fn wheel_under_coulomb_friction_slides_by_its_closed_form() {
    let mut scene = wheel();
    let (mu, slip) = (0.2, 0.5);
    scene.wheels[0].friction = Some(Friction {
        law: FrictionLaw::Coulomb,
        coefficient: mu,
        slip,
    });
    scene.end = 0.8;
    let mass = LOAD / GRAVITY;
    let inertia = mass * 1.25 * 1.25 / 2.0;
    let radius = 1.25 - (LOAD / 1e8_f64).powf(1.0 / 1.1);
    let compliance = 1.0 / mass + radius * radius / inertia;
    let run = run(&scene, Foundation::rigid());
    let mut worst = 0.0_f64;
    for (t, s) in run.history.column(Channel::Time).iter().zip(slips(&run)) {
        let closed =
            slip * ((10.0 / slip).sinh() * (-mu * LOAD * compliance * t / slip).exp()).asinh();
        worst = worst.max((s - closed).abs());
    }
    let speed = run.history.column(Channel::Speed(0, BodyDof::X));
    let last = slips(&run)[speed.len() - 1];
    // Momentum about the contact: the speed lost is the share 1/(m A) of the sliding lost.
    let closed = 10.0 - (10.0 - last) / (mass * compliance);
    let (found, residual) = (speed[speed.len() - 1], run.audit.residual());
    println!("worst {worst:.1e} of 10, speed {found:.8} for {closed:.8}, residual {residual:.1e}");
    assert!(last > 0.0 && last < 0.1 * slip, "{last}");
    assert!(worst < 1e-5);
    assert!((found - closed).abs() < 1e-9 * closed);
    // The audit's scale is elastic energy, a hundredth of the kinetic energy here.
    assert!(residual < 1e-6);
}

#[test]
fn all_forces_are_zero_off_the_rail_and_the_wheel_lands_again() {
    let mut scene = wheel();
    scene.wheels[0].flange = Some(Flange {
        stiffness: 1e8,
        clearance: 0.04,
        release: Some([1.25, 1.385]),
    });
    scene.bodies[0].start_speed[1] = 8.0;
    scene.accuracy = 1e-8;
    let run = run(&scene, Foundation::rigid());
    let [depth, vertical, lateral, traction] = [
        Channel::Penetration(0),
        Channel::Vertical(0),
        Channel::Lateral(0),
        Channel::Traction(0),
    ]
    .map(|channel| run.history.column(channel));
    let off: Vec<usize> = (0..depth.len()).filter(|&i| depth[i] < 0.0).collect();
    assert!(off.len() > 100, "the wheel flies");
    for &i in &off {
        assert_eq!((vertical[i], lateral[i], traction[i]), (0.0, 0.0, 0.0));
    }
    let landed = (off[0]..depth.len())
        .find(|&i| depth[i] > 0.0)
        .expect("the wheel lands");
    assert!(vertical[landed] > 0.0);
    assert!(run.counts.events >= 2);
    assert!(run.audit.residual() < 1e-6, "{}", run.audit.residual());
}

#[test]
fn free_flight_lasts_as_long_as_its_closed_form() {
    // Undamped linear wheel on a rigid rail: it leaves at p = 0 with the speed that energy gives, and lands 2 v/g later.
    let mut scene = wheel();
    scene.wheels[0] = Wheel {
        radius: 1.25,
        normal: NormalLaw::linear(1e8, 0.0, Damper::Rail),
        flange: None,
        friction: None,
        spin_inertia: None,
    };
    scene.bodies[0].start_speed = [0.0, 5.0, 0.0, 0.0, 0.0, 0.0];
    scene.output_dt = 1e-5;
    scene.end = 0.6;
    let run = run(&scene, Foundation::rigid());
    let (time, depth) = (
        run.history.column(Channel::Time),
        run.history.column(Channel::Penetration(0)),
    );
    let crossing = |from: usize, rising: bool| {
        let i = (from..depth.len() - 1).find(|&i| {
            if rising {
                depth[i] < 0.0 && depth[i + 1] >= 0.0
            } else {
                depth[i] >= 0.0 && depth[i + 1] < 0.0
            }
        });
        let i = i.expect("the wheel crosses the rail's level");
        (
            i,
            time[i] + (time[i + 1] - time[i]) * depth[i] / (depth[i] - depth[i + 1]),
        )
    };
    let (i, leaves) = crossing(0, false);
    let (_, lands) = crossing(i + 1, true);
    let mass = LOAD / GRAVITY;
    // Analytic: m v^2/2 = m v0^2/2 + k p0^2/2 - m g p0 with p0 = W/k.
    let rest = LOAD / 1e8;
    let speed = (25.0 + 1e8 * rest * rest / mass - 2.0 * GRAVITY * rest).sqrt();
    println!(
        "flight {} closed form {}",
        lands - leaves,
        2.0 * speed / GRAVITY
    );
    assert!((lands - leaves - 2.0 * speed / GRAVITY).abs() < 1e-7);
}

#[test]
fn flange_force_tips_the_body_with_the_moment_of_its_lever() {
    // Held at a height that a prescribed lift keeps: z and roll free, no weight, wheel pressed by its start.
    let mut scene = wheel();
    scene.wheels[0].friction = None;
    scene.wheels[0].flange = Some(Flange {
        stiffness: 1e6,
        clearance: 0.04,
        release: Some([1.25, 1.385]),
    });
    let body = &mut scene.bodies[0];
    body.inertia = [3e4, 0.0, 0.0];
    body.free = [false, true, true, true, false, false];
    body.start = [0.0, 0.0, 0.05, 0.0, 0.0, 0.0];
    body.start_speed = [0.0; 6];
    scene.end = 1e-4;
    scene.output_dt = 1e-5;
    let run = run(&scene, Foundation::rigid());
    let lateral = run.history.column(Channel::Lateral(0));
    let height = 1.25 - run.history.column(Channel::Penetration(0))[0];
    // Analytic: L = k (z - clearance); z'' = -L/m, roll'' = TX/Ixx with TX = FZ x DY = L height.
    assert!((lateral[0] - 1e6 * 0.01).abs() < 1e-6);
    let roll = run.history.column(Channel::Speed(0, BodyDof::Roll));
    let slide = run.history.column(Channel::Speed(0, BodyDof::Z));
    let (mass, t) = (LOAD / GRAVITY, 1e-4);
    assert!(
        (roll[10] / (lateral[0] * height / 3e4 * t) - 1.0).abs() < 1e-4,
        "{}",
        roll[10]
    );
    assert!(
        (slide[10] / (-lateral[0] / mass * t) - 1.0).abs() < 1e-4,
        "{}",
        slide[10]
    );
}

#[test]
fn flange_lets_go_between_the_release_heights() {
    for (lift, share) in [(0.0_f64, 1.0), (0.0675, 0.5), (0.135, 0.0), (0.2, 0.0)] {
        let mut scene = wheel();
        scene.gravity = 1e-9;
        scene.wheels[0].friction = None;
        scene.wheels[0].flange = Some(Flange {
            stiffness: 1e6,
            clearance: 0.04,
            release: Some([1.25, 1.385]),
        });
        scene.bodies[0].free = [false, true, true, false, false, false];
        scene.bodies[0].start = [0.0, lift.max(1e-12), 0.05, 0.0, 0.0, 0.0];
        scene.bodies[0].start_speed = [0.0; 6];
        scene.end = 1e-6;
        scene.output_dt = 1e-6;
        let run = run(&scene, Foundation::rigid());
        let lateral = run.history.column(Channel::Lateral(0))[0];
        assert!((lateral - share * 1e4).abs() < 1e-3, "at {lift}: {lateral}");
    }
}

#[test]
fn wheel_that_would_pull_leaves_the_rail_and_energy_still_closes() {
    // Past 57.24 ft a two-sided wheel would pull at 100 ft/s.
    let mut scene = bogie(100.0, 0.7, Damper::Ground);
    scene.output_dt = 1e-3;
    let run = run(&scene, girder());
    let forces: Vec<f64> = [0, 1]
        .iter()
        .flat_map(|&w| run.history.column(Channel::Vertical(w)))
        .collect();
    assert!(forces.iter().all(|&f| f >= 0.0));
    assert!(forces.contains(&0.0), "a wheel leaves the rail");
    println!("{:?} residual {:.1e}", run.counts, run.audit.residual());
    assert!(run.counts.events >= 1);
    assert!(run.audit.residual() < 1e-5, "{}", run.audit.residual());
}
