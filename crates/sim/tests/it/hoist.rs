//! A ladle on a rope below a trolley that rides on a bridge, and stops on its rails: against closed forms,
//! conservation laws and equations written out for the case.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::f64::consts::PI;
use std::ops::ControlFlow;

use common::GRAVITY;
use common::crane::{BASE, BRIDGE, TROLLEY, body, carried, crane_of, travelling};
use sim::{BodyDof, Channel, Rope, RopeEnd, Run, Scene, Schedule, Status, Stop};

const LADLE: f64 = 31_700.0;
const EA: f64 = 2.8e8;
const LENGTH: f64 = 40.0;
/// Rail of the trolley on the bridge: along z.
const ALONG: [f64; 3] = [0.0, 0.0, 1.0];
/// Where the trolley's x is 0, from the bridge's origin.
const AT: [f64; 3] = [1.5, 3.0, -2.0];
/// The rope's end on the trolley, from its origin: x ahead, so z of the bridge; z right, so -x of the bridge.
const BLOCK: [f64; 3] = [0.5, 1.0, 0.25];

fn run(scene: &Scene) -> Run {
    let foundations = [sim::Foundation::rigid(), carried(ALONG, AT)];
    let run =
        sim::run(scene, &foundations, &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    run
}

/// The crane with a ladle on its trolley; all hang at rest at the start.
fn scene(bridge: &[BodyDof], trolley: &[BodyDof], end: f64) -> Scene {
    let mut scene = crane_of(
        body(BRIDGE, [1e6, 4e6, 4e6], bridge),
        body(TROLLEY, [9e4, 2e5, 2e5], trolley),
        end,
    );
    scene
        .bodies
        .push(body(LADLE, [0.0; 3], &[BodyDof::X, BodyDof::Y, BodyDof::Z]));
    scene.actuators.hanging = vec![2];
    scene.actuators.ropes = vec![Rope {
        from: RopeEnd {
            body: Some(1),
            at: BLOCK,
        },
        to: RopeEnd {
            body: Some(2),
            at: [0.0; 3],
        },
        stiffness: EA,
        damping: 0.0,
        length: LENGTH,
        speed: Schedule::new(&[[0.0, 0.0]]).expect("a valid table"),
    }];
    scene.output_dt = end / 100.0;
    scene
}

const SITS: [BodyDof; 3] = [BodyDof::Y, BodyDof::Roll, BodyDof::Pitch];

#[test]
fn rope_and_wheels_carry_what_hangs_and_rides() {
    let mut scene = scene(&SITS, &SITS, 0.1);
    scene.bodies[1].start[0] = 7.0;
    let run = run(&scene);
    let first = |channel| run.history.column(channel)[0];
    let weight = |mass: f64| mass * GRAVITY;
    let all = weight(BRIDGE + TROLLEY + LADLE);
    // Analytic: the rope carries the ladle, the trolley's wheels both, the bridge's wheels all, by four equal springs.
    let tension = first(Channel::Tension(0)) / weight(LADLE) - 1.0;
    let upper: f64 = (4..8).map(|w| first(Channel::Vertical(w))).sum();
    let upper = upper / weight(TROLLEY + LADLE) - 1.0;
    let (x, z) = (AT[0] - BLOCK[2], AT[2] + 7.0 + BLOCK[0]);
    let about = [
        weight(TROLLEY) * AT[0] + weight(LADLE) * x,
        weight(TROLLEY) * (AT[2] + 7.0) + weight(LADLE) * z,
    ];
    let mut worst = 0.0_f64;
    for w in 0..4 {
        let [wx, _, wz] = scene.contacts[w].at;
        let wanted =
            0.25 * (all + about[0] * wx / BASE[0].powi(2) + about[1] * wz / BASE[1].powi(2));
        worst = worst.max((first(Channel::Vertical(w)) - wanted).abs() / all);
    }
    let y = run.history.column(Channel::Displacement(2, BodyDof::Y));
    let still = y
        .iter()
        .fold(0.0_f64, |max, now| max.max((now - y[0]).abs()));
    println!("tension {tension:.1e}, trolley {upper:.1e}, bridge {worst:.1e}, moves {still:.1e}");
    assert!(
        tension.abs() < 1e-9 && upper.abs() < 1e-9,
        "{tension} {upper}"
    );
    assert!(worst < 1e-9, "a wheel errs by {worst}");
    assert!(still < 1e-9, "it moves by {still}");
}

#[test]
fn a_swing_below_a_free_crane_has_the_period_of_both_masses() {
    // Bridge and trolley roll as one along X, the ladle swings by 1e-4 rad.
    let mut scene = scene(&[BodyDof::X], &[], 20.0);
    scene.bodies[1].start[0] = 4.0;
    scene.actuators.ropes[0].stiffness = 1e12;
    let from = [
        AT[0] - BLOCK[2],
        AT[1] + BLOCK[1] + scene.wheels[0].radius,
        AT[2] + 4.0 + BLOCK[0],
    ];
    let stretched = LENGTH * (1.0 + LADLE * GRAVITY / 1e12);
    scene.actuators.hanging.clear();
    let swing = 1e-4 * stretched;
    let drop = (stretched * stretched - swing * swing).sqrt();
    let height = from[1] - drop - bridge_lift(&scene);
    scene.bodies[2].start[..3].copy_from_slice(&[from[0] + swing, height, from[2]]);
    scene.accuracy = 1e-8;
    let run = run(&scene);
    let (time, x) = (
        run.history.column(Channel::Time),
        run.history.column(Channel::Displacement(2, BodyDof::X)),
    );
    let above = run.history.column(Channel::Displacement(0, BodyDof::X));
    // Analytic: l a'' = -g a (1 + m/M), the common centre of mass stays.
    let share = LADLE / (BRIDGE + TROLLEY);
    let omega = (GRAVITY / stretched * (1.0 + share)).sqrt();
    let mut worst = 0.0_f64;
    for (t, (x, above)) in time.iter().zip(x.iter().zip(&above)) {
        worst = worst.max((x - above - from[0] - swing * (omega * t).cos()).abs() / swing);
    }
    println!(
        "swing {worst:.1e}, energy {:.1e}, {:?}",
        run.audit.residual(),
        run.counts
    );
    assert!(worst < 1e-6, "the swing errs by {worst}");
}

/// Height of the origin of the bridge less that of its hubs: the hubs are at radius above the rail.
fn bridge_lift(scene: &Scene) -> f64 {
    scene.contacts[0].at[1]
}

#[test]
fn a_crossing_with_a_ladle_keeps_momentum_and_energy() {
    let bridge = [
        BodyDof::X,
        BodyDof::Y,
        BodyDof::Roll,
        BodyDof::Yaw,
        BodyDof::Pitch,
    ];
    let mut scene = scene(&bridge, &SITS, 6.0);
    scene.bodies[0].start_speed[0] = 2.0;
    scene.bodies[2].start_speed[0] = -1.0;
    scene.bodies[1].motion = travelling(4.0, -8.0);
    scene.actuators.ropes[0].speed =
        Schedule::new(&[[0.0, 0.0], [1.0, 1.5]]).expect("a valid table");
    let run = run(&scene);
    let speed = |b, freedom| run.history.column(Channel::Speed(b, freedom));
    let [x, yaw, pitch] = [BodyDof::X, BodyDof::Yaw, BodyDof::Pitch].map(|f| speed(0, f));
    let turned = run.history.column(Channel::Displacement(0, BodyDof::Yaw));
    let (travel, ladle) = (
        run.history.column(Channel::Displacement(1, BodyDof::X)),
        speed(2, BodyDof::X),
    );
    let start = (BRIDGE + TROLLEY) * 2.0 - LADLE;
    let mut worst = 0.0_f64;
    for k in 0..x.len() {
        // Analytic: speed along X of the trolley's centre, which runs along z: x' + yaw' z - pitch' y + travel' yaw.
        let trolley = x[k] + yaw[k] * (AT[2] + travel[k]) - pitch[k] * AT[1] + 4.0 * turned[k];
        let momentum = BRIDGE * x[k] + TROLLEY * trolley + LADLE * ladle[k];
        worst = worst.max((momentum - start).abs() / start);
    }
    println!(
        "momentum {worst:.1e}, energy {:.1e}, {:?}",
        run.audit.residual(),
        run.counts
    );
    assert!(worst < 1e-7, "momentum errs by {worst}");
    assert!(
        run.audit.residual() < 1e-7,
        "energy residual {}",
        run.audit.residual()
    );
    assert!(run.audit.exchanged.hoists != 0.0 && run.audit.exchanged.drives != 0.0);
}

/// Analytic: positions in space of the block on a bridge that moves along X alone; RK4.
#[test]
fn ladle_and_free_bridge_follow_their_own_equations() {
    let speed = 3.0;
    let mut scene = scene(&[BodyDof::X], &[], 5.0);
    scene.bodies[1].motion = travelling(speed, -6.0);
    scene.bodies[2].start_speed = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    scene.accuracy = 1e-8;
    let run = run(&scene);
    let columns = [
        (0, BodyDof::X),
        (2, BodyDof::X),
        (2, BodyDof::Y),
        (2, BodyDof::Z),
    ]
    .map(|(b, freedom)| run.history.column(Channel::Displacement(b, freedom)));
    let starts = columns.each_ref().map(|column| column[0]);
    // s: x of the bridge, ladle's X, Y, Z, and their speeds; the block from the bridge's origin at x = 0.
    let height = starts[2] + LENGTH * (1.0 + LADLE * GRAVITY / EA);
    let rate = |t: f64, s: [f64; 8]| {
        let block = [
            s[0] + AT[0] - BLOCK[2],
            height,
            AT[2] + BLOCK[0] - 6.0 + speed * t,
        ];
        let reach = [0, 1, 2].map(|k| s[k + 1] - block[k]);
        let l = reach.iter().map(|r| r * r).sum::<f64>().sqrt();
        let pull = (EA * (l / LENGTH - 1.0)).max(0.0);
        let [x, y, z] = reach.map(|r| pull * r / l);
        [
            s[4],
            s[5],
            s[6],
            s[7],
            x / (BRIDGE + TROLLEY),
            -x / LADLE,
            -y / LADLE - GRAVITY,
            -z / LADLE,
        ]
    };
    let mut s = [
        starts[0], starts[1], starts[2], starts[3], 0.0, 1.0, 0.0, 0.0,
    ];
    let (h, mut worst) = (1e-3, 0.0_f64);
    for step in 0..=5000_u32 {
        if step % 50 == 0 {
            for (k, column) in columns.iter().enumerate() {
                worst = worst.max((column[step as usize / 50] - s[k]).abs());
            }
        }
        let t = f64::from(step) * h;
        let plus = |k: [f64; 8], by: f64| -> [f64; 8] { std::array::from_fn(|i| s[i] + by * k[i]) };
        let k1 = rate(t, s);
        let k2 = rate(t + 0.5 * h, plus(k1, 0.5 * h));
        let k3 = rate(t + 0.5 * h, plus(k2, 0.5 * h));
        let k4 = rate(t + h, plus(k3, h));
        s = std::array::from_fn(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    println!(
        "places {worst:.1e}, energy {:.1e}, {:?}",
        run.audit.residual(),
        run.counts
    );
    assert!(worst < 1e-6, "a place errs by {worst}");
    assert!(
        run.audit.residual() < 1e-7,
        "energy residual {}",
        run.audit.residual()
    );
}

/// Analytic: two masses and an elastic stop between them exchange m v in pi / sqrt(k (1/m + 1/M)).
#[test]
fn a_trolley_that_meets_the_end_of_its_rails_pushes_the_bridge() {
    let mut scene = crane_of(
        body(BRIDGE, [1e6, 4e6, 4e6], &[BodyDof::X]),
        body(TROLLEY, [9e4, 2e5, 2e5], &[BodyDof::X]),
        3.0,
    );
    (scene.bodies[1].start[0], scene.bodies[1].start_speed[0]) = (2.0, 5.0);
    scene.actuators.stops = vec![Stop {
        body: 1,
        against: None,
        at: [6.0, 0.0, 0.0],
        axis: 0,
        place: 14.0,
        side: 1.0,
        stiffness: 1e6,
        damping: 0.0,
    }];
    (scene.accuracy, scene.output_dt) = (1e-9, 0.01);
    let foundations = [sim::Foundation::rigid(), carried([1.0, 0.0, 0.0], AT)];
    let run =
        sim::run(&scene, &foundations, &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    let speed = |b| {
        *run.history
            .column(Channel::Speed(b, BodyDof::X))
            .last()
            .expect("samples")
    };
    let whole = BRIDGE + TROLLEY;
    let wanted = 2.0 * TROLLEY * 5.0 / whole;
    let errors = [(speed(0) - wanted) / wanted, (speed(1) + 5.0) / 5.0];
    let reduced = BRIDGE * TROLLEY / whole;
    let peak = run
        .history
        .column(Channel::Stop(0))
        .into_iter()
        .fold(0.0, f64::max)
        / (5.0 * (1e6 * reduced).sqrt());
    let time = PI * (reduced / 1e6).sqrt();
    println!(
        "speeds {errors:?}, peak {peak:.6}, lasts {time:.3}, energy {:.1e}",
        run.audit.residual()
    );
    assert!(errors.iter().all(|e| e.abs() < 1e-7), "{errors:?}");
    assert!((peak - 1.0).abs() < 1e-2, "{peak}");
    assert!(
        run.audit.residual() < 1e-7,
        "energy residual {}",
        run.audit.residual()
    );
}
