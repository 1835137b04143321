//! Friction, drives and brakes on rails that give along x, against closed forms and independent integrations.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::kutta::{Kernel, rk4, sled};
use common::{GRAVITY, bogie};
use sim::{
    BodyDof, Brake, Channel, Contact, Damper, Drive, Foundation, Friction, FrictionLaw, Gauge, Run,
    Scene, Schedule, Status,
};
use splines::{Axis, Probe};

const MASS: f64 = 5.0;
const MU: f64 = 0.3;
const SLIP: f64 = 0.05;
const K: f64 = 4000.0;
const SPEED: f64 = 3.0;
const WEIGHT: f64 = MASS * GRAVITY;

/// One wheel under a body that rolls freely at [`SPEED`], and a gauge of the rail along x.
fn free(end: f64) -> Scene {
    let mut scene = bogie(0.0, end, Damper::Rail);
    let body = &mut scene.bodies[0];
    (body.mass, body.inertia, body.motion) = (MASS, [MASS; 3], None);
    body.free = [true, true, false, false, false, false];
    body.start_speed[0] = SPEED;
    scene.contacts.truncate(1);
    scene.contacts[0].offsets = vec![0.0];
    let wheel = &mut scene.wheels[0];
    (wheel.normal.stiffness, wheel.normal.damping) = (1e5, 0.0);
    wheel.friction = Some(Friction {
        law: FrictionLaw::Coulomb,
        coefficient: MU,
        slip: SLIP,
    });
    scene.gauges = vec![Gauge {
        structure: 0,
        probe: Probe {
            rail: 0,
            x: 0.0,
            axis: Axis::Longitudinal,
        },
    }];
    scene.accuracy = 1e-8;
    scene
}

fn braked(end: f64) -> Scene {
    let mut scene = free(end);
    scene.actuators.brakes = vec![Brake {
        body: 0,
        from: 0.0,
        speed: SLIP,
        contacts: vec![0],
    }];
    scene
}

fn run(scene: &Scene, foundation: Foundation) -> Run {
    let run =
        sim::run(scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    run
}

fn last(run: &Run, channel: Channel) -> f64 {
    run.history
        .column(channel)
        .last()
        .copied()
        .expect("a run has rows")
}

const X: Channel = Channel::Displacement(0, BodyDof::X);
const V: Channel = Channel::Speed(0, BodyDof::X);

fn close(what: &str, found: f64, expected: f64, tolerance: f64) {
    println!(
        "{what}: {found} of {expected}, {:.1e}",
        (found - expected).abs()
    );
    assert!(
        (found - expected).abs() < tolerance,
        "{what}: {found} is not {expected}"
    );
}

#[test]
fn braked_wheel_pushes_a_rail_that_is_a_spring_and_a_mass() {
    // Analytic while it slides: v = v0 - mu g t, u = (mu m g/k) (1 - cos wt). Sliding at 40 slips, tanh is one.
    let (rail, end) = (8.0, 0.08);
    let scene = braked(end);
    let found = run(&scene, sled(rail, K, 0.0, [1.0, 0.0, 0.0]));
    let (t, u) = (
        found.history.column(Channel::Time),
        found.history.column(Channel::Gauge(0)),
    );
    let omega = (K / rail).sqrt();
    let brake = MU * WEIGHT;
    let mut worst = 0.0_f64;
    for (t, u) in t.iter().zip(&u) {
        worst = worst.max((u - brake / K * (1.0 - (omega * t).cos())).abs());
    }
    println!("rail: {:.1e} of its give", worst * K / brake);
    assert!(worst < 1e-7 * brake / K);
    close("speed", last(&found, V), SPEED - brake / MASS * end, 1e-8);
    // Balance along x: what holds the rail is - sum of m a.
    let held = -K * u.last().copied().expect("rows");
    let accelerations = -brake + rail * brake / K * omega * omega * (omega * end).cos();
    close("reaction", held, accelerations, 1e-7 * brake);
    assert!(
        found.audit.residual() < 1e-8,
        "{:e}",
        found.audit.residual()
    );
}

#[test]
fn braked_wheel_stops_and_swings_with_its_rail() {
    let (rail, c, end) = (8.0, 20.0, 0.6);
    let found = run(&braked(end), sled(rail, K, c, [1.0, 0.0, 0.0]));
    // External: v, u and u' by Runge-Kutta.
    let [v, u, w] = rk4([SPEED, 0.0, 0.0], end, 200_000, |_, [v, u, w]| {
        let brake = MU * WEIGHT * ((v - w) / SLIP).tanh();
        [-brake / MASS, w, (brake - K * u - c * w) / rail]
    });
    close("speed", last(&found, V), v, 1e-6);
    close("rail", last(&found, Channel::Gauge(0)), u, 1e-7);
    assert!(w.abs() > 1e-3, "the rail still swings");
    assert!(
        found.audit.residual() < 1e-7,
        "{:e}",
        found.audit.residual()
    );
}

#[test]
fn braked_wheel_on_a_massless_rail_slides_on_what_the_rail_moves() {
    // Vertical, longitudinal and coupling give alike everywhere.
    let (gyy, gxx, gxy, k, end) = (3e-4, 1.0 / K, 1e-4, 1e5, 0.6);
    let kernel = Kernel(move |p: Probe, q: Probe| match (p.axis, q.axis) {
        (Axis::Vertical, Axis::Vertical) => [gyy, 0.0],
        (Axis::Longitudinal, Axis::Longitudinal) => [gxx, 0.0],
        (Axis::Vertical, Axis::Longitudinal) | (Axis::Longitudinal, Axis::Vertical) => [gxy, 0.0],
        _ => [0.0; 2],
    });
    let foundation = Foundation {
        is_loaded_along: true,
        ..Foundation::massless(Box::new(kernel), 1)
    };
    let (mut scene, speed, slip) = (braked(end), 1.0, 0.5);
    scene.bodies[0].start_speed[0] = speed;
    scene.actuators.brakes[0].speed = slip;
    let found = run(&scene, foundation);
    // External: v, u, y, y' with N and B from y = ... and u, and du/dt = v - slip artanh(B / mu N).
    let start = [speed, -gxy * WEIGHT, -WEIGHT * (gyy + 1.0 / k), 0.0];
    let [v, u, y, _] = rk4(start, end, 100_000, |_, [v, u, y, vy]| {
        // u = gxx B - gxy N, -y = (gyy + 1/k) N - gxy B: forces down press, those along +x push.
        let det = gxx * (gyy + 1.0 / k) - gxy * gxy;
        let n = (-y * gxx + gxy * u) / det;
        let b = ((gyy + 1.0 / k) * u - gxy * y) / det;
        [
            -b / MASS,
            v - slip * (b / (MU * n)).atanh(),
            vy,
            n / MASS - GRAVITY,
        ]
    });
    close("speed", last(&found, V), v, 1e-6);
    close("rail", last(&found, Channel::Gauge(0)), u, 1e-7);
    close(
        "height",
        last(&found, Channel::Displacement(0, BodyDof::Y)),
        y,
        1e-7,
    );
    assert!(
        found.audit.residual() < 1e-6,
        "{:e}",
        found.audit.residual()
    );
}

#[test]
fn heavy_brake_grips_a_rail_that_hardly_gives_and_comes_to_a_stand() {
    // A crane of 1600 kip: in short steps the brake turns from end to end of its force within 1e-6 of that force.
    let (mass, gxx, end) = (5e4, 1e-6, 1.0);
    let kernel = Kernel(move |p: Probe, q: Probe| match (p.axis, q.axis) {
        (Axis::Vertical, Axis::Vertical) => [1e-8, 0.0],
        (Axis::Longitudinal, Axis::Longitudinal) => [gxx, 0.0],
        _ => [0.0; 2],
    });
    let foundation = Foundation {
        is_loaded_along: true,
        ..Foundation::massless(Box::new(kernel), 1)
    };
    let mut scene = braked(end);
    (scene.bodies[0].mass, scene.bodies[0].inertia) = (mass, [mass; 3]);
    scene.wheels[0].normal.stiffness = 1e8;
    scene.actuators.brakes[0].speed = 0.002;
    scene.accuracy = 1e-5;
    let found = run(&scene, foundation);
    // Analytic: it stands after v / (mu g), within v^2 / (2 mu g) and the give of the rail; then it swings on the rail by
    // at most the give under the brake.
    let (path, give) = (
        SPEED * SPEED / (2.0 * MU * GRAVITY),
        gxx * MU * mass * GRAVITY,
    );
    assert!(
        SPEED / (MU * GRAVITY) < 0.5 * end,
        "it stands for half the time"
    );
    close("path", last(&found, X), path, 2.0 * give);
    assert!(
        last(&found, V).abs() < give * (gxx * mass).powf(-0.5),
        "{}",
        last(&found, V)
    );
    assert!(
        found.audit.residual() < 2e-4,
        "{:e}",
        found.audit.residual()
    );
}

#[test]
fn slip_is_measured_against_the_rail_and_not_along_the_path_of_the_wheel() {
    // G(x, z) = a + b x z along the rail: under a force that stays, a wheel that moves on sees u change by its place alone.
    let (a, b, end, speed, slip) = (1.0 / K, 4.0 / K, 0.8, 1.0, 0.5);
    let kernel = Kernel(move |p: Probe, q: Probe| match (p.axis, q.axis) {
        (Axis::Longitudinal, Axis::Longitudinal) => [a + b * p.x * q.x, b * q.x],
        _ => [0.0; 2],
    });
    let foundation = Foundation {
        is_loaded_along: true,
        ..Foundation::massless(Box::new(kernel), 1)
    };
    let mut scene = braked(end);
    scene.bodies[0].start_speed[0] = speed;
    scene.actuators.brakes[0].speed = slip;
    let found = run(&scene, foundation);
    // External: u = (a + b x^2) B, du/dt = v - s + x' b x B.
    let [x, v, u] = rk4([0.0, speed, 0.0], end, 100_000, |_, [x, v, u]| {
        let brake = u / (a + b * x * x);
        let slide = slip * (brake / (MU * WEIGHT)).atanh();
        [v, -brake / MASS, v - slide + v * b * x * brake]
    });
    close("place", last(&found, X), x, 1e-7);
    close("speed", last(&found, V), v, 1e-6);
    println!("give {u}, audit {:.1e}", found.audit.residual());
    assert!(
        found.audit.residual() < 1e-6,
        "{:e}",
        found.audit.residual()
    );
}

#[test]
fn sliding_wheel_spins_up_on_a_rail_that_swings() {
    let (rail, c, inertia, radius, end) = (8.0, 20.0, 2.0, 1.25, 0.5);
    let mut scene = free(end);
    scene.wheels[0].spin_inertia = Some(inertia);
    let found = run(&scene, sled(rail, K, c, [1.0, 0.0, 0.0]));
    // External: v, spin, u and u' by Runge-Kutta; the hub stands the penetration lower than the radius.
    let arm = radius - WEIGHT / 1e5;
    let [v, spin, u, _] = rk4(
        [SPEED, 0.0, 0.0, 0.0],
        end,
        200_000,
        |_, [v, spin, u, w]| {
            let friction = MU * WEIGHT * ((v + arm * spin - w) / SLIP).tanh();
            [
                -friction / MASS,
                -friction * arm / inertia,
                w,
                (friction - K * u - c * w) / rail,
            ]
        },
    );
    close("speed", last(&found, V), v, 1e-6);
    close("spin", last(&found, Channel::SpinSpeed(0)), spin, 1e-6);
    close("rail", last(&found, Channel::Gauge(0)), u, 1e-7);
    assert!(
        found.audit.residual() < 1e-7,
        "{:e}",
        found.audit.residual()
    );
}

#[test]
fn drive_pushes_its_rail_backwards_and_follows_the_speed_against_it() {
    let (gain, end) = (60.0, 0.5);
    let mut scene = free(end);
    scene.bodies[0].start_speed[0] = 0.0;
    scene.wheels[0].friction = None;
    scene.actuators.drives = vec![Drive {
        body: 0,
        speed: Schedule::new(&[[0.0, SPEED]]).expect("a row"),
        gain,
        max_force: f64::INFINITY,
        contacts: vec![0],
        until: f64::INFINITY,
    }];
    let kernel = Kernel(|p: Probe, q: Probe| {
        let both = p.axis == Axis::Longitudinal && q.axis == Axis::Longitudinal;
        [if both { 1.0 / K } else { 0.0 }, 0.0]
    });
    let massless = Foundation {
        is_loaded_along: true,
        ..Foundation::massless(Box::new(kernel), 1)
    };
    let found = run(&scene, massless);
    // External: u = -D/k, D = gain (v_ref - v + u').
    let [v, u] = rk4([0.0, 0.0], end, 100_000, |_, [v, u]| {
        [-K * u / MASS, v - SPEED - K * u / gain]
    });
    close("speed", last(&found, V), v, 1e-6);
    close("rail", last(&found, Channel::Gauge(0)), u, 1e-7);
    assert!(
        found.audit.residual() < 1e-6,
        "{:e}",
        found.audit.residual()
    );
    let found = run(&scene, sled(2.0, K, 10.0, [1.0, 0.0, 0.0]));
    let [v, u, _] = rk4([0.0; 3], end, 100_000, |_, [v, u, w]| {
        let drive = gain * (SPEED - v + w);
        [drive / MASS, w, (-drive - K * u - 10.0 * w) / 2.0]
    });
    close("speed, rail with mass", last(&found, V), v, 1e-6);
    close("rail with mass", last(&found, Channel::Gauge(0)), u, 1e-7);
    assert!(
        found.audit.residual() < 1e-6,
        "{:e}",
        found.audit.residual()
    );
}

/// Identity: two girders that share nothing are the same as one structure whose two rails do not deflect each other.
#[test]
fn drive_on_two_structures_feels_the_rails_of_both() {
    let kernel = || {
        let of = |p: Probe, q: Probe| {
            let (give, along) = (1.0 / K, p.axis == Axis::Longitudinal);
            if p.axis != q.axis || p.rail != q.rail || p.axis == Axis::Lateral {
                return [0.0; 2];
            }
            if along {
                [give * (1.0 + 0.3 * p.x * q.x), 0.3 * give * q.x]
            } else {
                [1e-5, 0.0]
            }
        };
        Foundation {
            is_loaded_along: true,
            ..Foundation::massless(Box::new(Kernel(of)), 2)
        }
    };
    let mut scene = free(0.5);
    scene.bodies[0].start_speed[0] = 0.0;
    scene.wheels[0].friction = None;
    scene.contacts.push(Contact {
        rail: 1,
        ..Contact::new(0, [1.5, 0.0, 0.0])
    });
    scene.contacts[1].at[1] = scene.contacts[0].at[1];
    scene.actuators.drives = vec![Drive {
        body: 0,
        speed: Schedule::new(&[[0.0, SPEED]]).expect("a row"),
        gain: 60.0,
        max_force: f64::INFINITY,
        contacts: vec![0, 1],
        until: f64::INFINITY,
    }];
    let channels = [V, Channel::Drive(0), Channel::Displacement(0, BodyDof::Y)];
    let of = |scene: &Scene, foundations: &[Foundation]| {
        let run = sim::run(scene, foundations, &mut |_| ControlFlow::Continue(()))
            .expect("a valid scene");
        assert_eq!(run.status, Status::Done);
        assert!(run.audit.residual() < 1e-6, "{:e}", run.audit.residual());
        channels.map(|channel| run.history.column(channel))
    };
    let one = of(&scene, &[kernel()]);
    scene.contacts[1].structure = 1;
    let two = of(&scene, &[kernel(), kernel()]);
    for (one, two) in one.iter().zip(&two) {
        let most = one
            .iter()
            .fold(0.0, |most: f64, value| most.max(value.abs()));
        let apart = one
            .iter()
            .zip(two)
            .fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        println!("apart {:.1e}", apart / most);
        assert!(apart < 1e-7 * most, "{apart} of {most}");
    }
}
