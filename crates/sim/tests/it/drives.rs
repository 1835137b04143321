//! Loads, drives and brakes against closed forms.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::f64::consts::PI;
use std::ops::ControlFlow;

use common::{GRAVITY, WEIGHT, bogie, girder};
use sim::{
    BodyDof, Brake, Channel, Damper, Drive, Error, Foundation, Friction, FrictionLaw, Load, Run,
    Scene, Schedule, Status,
};

const MASS: f64 = WEIGHT / GRAVITY;

/// Speed at which a brake has 76 % of its friction, ft/s.
const BRAKE_SPEED_FT: f64 = 0.02;

fn run(scene: &Scene, foundation: Foundation) -> Run {
    sim::run(scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("a valid scene")
}

/// Where `range` is the whole rail, rigid.
fn rigid() -> Foundation {
    Foundation {
        rails: girder().rails,
        ..Foundation::default()
    }
}

fn schedule(table: &[[f64; 2]]) -> Schedule {
    Schedule::new(table).expect("a valid table")
}

/// The bogie, free to roll, its wheels undamped.
fn free(speed: f64, end: f64) -> Scene {
    let mut scene = bogie(0.0, end, Damper::Rail);
    scene.wheels[0].normal.damping = 0.0;
    let body = &mut scene.bodies[0];
    body.motion = None;
    body.free[0] = true;
    body.start_speed[0] = speed;
    scene.accuracy = 1e-8;
    scene
}

fn drive(speed: &[[f64; 2]], gain: f64, max_force: f64, contacts: &[usize]) -> Drive {
    Drive {
        body: 0,
        speed: schedule(speed),
        gain,
        max_force,
        contacts: contacts.to_vec(),
        until: f64::INFINITY,
    }
}

/// Largest difference of a channel from `wanted` over time.
fn error(run: &Run, channel: Channel, wanted: impl Fn(f64) -> f64) -> f64 {
    let (t, values) = (
        run.history.column(Channel::Time),
        run.history.column(channel),
    );
    assert_eq!(run.status, Status::Done);
    assert_eq!(t.len(), values.len());
    t.iter()
        .zip(&values)
        .fold(0.0, |max, (&t, value)| max.max((value - wanted(t)).abs()))
}

const X: Channel = Channel::Displacement(0, BodyDof::X);
const SPEED: Channel = Channel::Speed(0, BodyDof::X);

#[test]
fn load_along_the_rail_moves_a_free_body_as_newton_says() {
    let force = 2e4;
    let mut scene = free(0.0, 4.0);
    // Constant, then falling to zero from t = 1 to 3.
    let table = [[1.0, force], [3.0, 0.0]];
    scene.actuators.loads = vec![Load {
        body: 0,
        dof: BodyDof::X,
        value: schedule(&table),
    }];
    let run = run(&scene, rigid());
    // Analytic: v = F t / m; then F (1 + s - s^2/4) / m with s = t - 1; then 2 F / m.
    let speed = |t: f64| {
        let s = (t - 1.0).clamp(0.0, 2.0);
        force / MASS * (t.min(1.0) + s - 0.25 * s * s)
    };
    let err = error(&run, SPEED, speed);
    println!(
        "speed errs by {err:.1e} of {:.3}, {:?}",
        speed(4.0),
        run.counts
    );
    assert!(err < 1e-12 * speed(4.0));
    let work = 0.5 * MASS * speed(4.0).powi(2);
    assert!((run.audit.exchanged.loads / work - 1.0).abs() < 1e-12);
    assert!(run.audit.residual() < 1e-12, "{}", run.audit.residual());
}

#[test]
fn growing_moment_pitches_the_bogie_as_its_oscillator_does() {
    let (rate, arm) = (1e6, 4.0 / 3.0);
    let mut scene = free(0.0, 1.0);
    let value = schedule(&[[0.0, 0.0], [1.0, rate]]);
    scene.actuators.loads = vec![Load {
        body: 0,
        dof: BodyDof::Pitch,
        value,
    }];
    let run = run(&scene, rigid());
    // Analytic: I p'' + K p = r t from rest: p = r/K (t - sin(w t)/w), K = 2 k a^2, w = sqrt(K/I).
    let stiffness = 2.0 * 1e8 * arm * arm;
    let w = (stiffness / (MASS * 2.25)).sqrt();
    let pitch = |t: f64| rate / stiffness * (t - (w * t).sin() / w);
    let err = error(&run, Channel::Displacement(0, BodyDof::Pitch), pitch);
    println!(
        "pitch errs by {err:.1e} of {:.1e}, residual {:.1e}",
        pitch(1.0),
        run.audit.residual()
    );
    assert!(err < 1e-6 * pitch(1.0));
    assert!(run.audit.exchanged.loads > 0.0);
    assert!(run.audit.residual() < 1e-7, "{}", run.audit.residual());
}

#[test]
fn run_starts_at_rest_under_the_loads_of_its_start() {
    let mut scene = free(0.0, 0.5);
    for (freedom, value) in [(BodyDof::Y, -6e5), (BodyDof::Pitch, 4e5)] {
        scene.actuators.loads.push(Load {
            body: 0,
            dof: freedom,
            value: schedule(&[[0.0, value]]),
        });
    }
    let run = run(&scene, rigid());
    // Analytic: both springs and the lever of 4/3 ft.
    let sink = (WEIGHT + 6e5) / 2e8;
    assert!(error(&run, Channel::Displacement(0, BodyDof::Y), |_| -sink) < 1e-12);
    let tilt = 4e5 / (2e8 * 16.0 / 9.0);
    assert!(error(&run, Channel::Displacement(0, BodyDof::Pitch), |_| tilt) < 1e-12);
}

#[test]
fn drive_approaches_its_speed_exponentially() {
    for gain in [1e5, 1e8] {
        let mut scene = free(0.0, 4.0);
        scene.actuators.drives = vec![drive(&[[0.0, 5.0]], gain, f64::INFINITY, &[])];
        let run = run(&scene, rigid());
        // Analytic: m v' = gain (v_ref - v).
        let err = error(&run, SPEED, |t| 5.0 * (1.0 - (-gain * t / MASS).exp()));
        let column = error(&run, Channel::Drive(0), |t| {
            gain * 5.0 * (-gain * t / MASS).exp()
        });
        println!(
            "gain {gain:.0e}: speed errs by {err:.1e}, force by {column:.1e}, {:?}",
            run.counts
        );
        assert!(err < 3e-7 * 5.0);
        assert!(column < 3e-7 * gain * 5.0);
        assert!(run.audit.residual() < 1e-6, "{}", run.audit.residual());
    }
}

#[test]
fn drive_at_its_largest_force_ramps_up_and_then_approaches() {
    let (gain, most) = (1e5, 2e5);
    let mut scene = free(0.0, 8.0);
    scene.actuators.drives = vec![drive(&[[0.0, 5.0]], gain, most, &[])];
    let run = run(&scene, rigid());
    // Analytic: v = F t / m until gain (v_ref - v) = F, then exponential.
    let free_of_limit = (5.0 - most / gain) * MASS / most;
    let speed = |t: f64| {
        if t < free_of_limit {
            most * t / MASS
        } else {
            5.0 - most / gain * (-(t - free_of_limit) * gain / MASS).exp()
        }
    };
    let err = error(&run, SPEED, speed);
    println!("speed errs by {err:.1e}, {:?}", run.counts);
    assert!(err < 1e-6);
    assert!(
        error(&run, Channel::Drive(0), |t| (gain * (5.0 - speed(t)))
            .min(most))
            < 0.2
    );
}

#[test]
fn drive_stays_within_the_traction_of_its_wheels() {
    let mu = 0.2;
    let mut scene = free(0.0, 4.0);
    scene.wheels[0].friction = Some(Friction {
        law: FrictionLaw::Step,
        coefficient: mu,
        slip: 0.1,
    });
    scene.actuators.drives = vec![drive(&[[0.0, 100.0]], 1e6, f64::INFINITY, &[0, 1])];
    let all = run(&scene, rigid());
    // Analytic: both wheels carry the weight together, whatever the pitch does.
    let err = error(&all, SPEED, |t| mu * GRAVITY * t);
    println!("all driven: speed errs by {err:.1e}, {:?}", all.counts);
    assert!(err < 1e-6);
    assert!(all.audit.residual() < 1e-6, "{}", all.audit.residual());
    // The rear wheels alone. The force acts at the treads, 1.25 ft below the centre of mass: with a damper the pitch
    // settles at F R = (N_rear - N_front) a, so that F = mu (W/2) / (1 - mu R / 2a). Analytic.
    scene.wheels[0].normal.damping = 2e6;
    scene.end = 6.0;
    scene.actuators.drives = vec![drive(&[[0.0, 100.0]], 1e6, f64::INFINITY, &[0])];
    let rear = run(&scene, rigid());
    assert_eq!(rear.status, Status::Done);
    let wanted = mu * 0.5 * WEIGHT / (1.0 - mu * 1.25 / (2.0 * 4.0 / 3.0));
    let force = rear.history.column(Channel::Drive(0));
    let last = force.last().copied().unwrap_or_default();
    println!("rear driven: {last} of {wanted}");
    assert!((last / wanted - 1.0).abs() < 1e-6);
    let vertical = rear.history.column(Channel::Vertical(0));
    for (force, vertical) in force.iter().zip(vertical).skip(1) {
        assert!((force / (mu * vertical) - 1.0).abs() < 1e-9);
    }
    // the rear wheel alone pushes the rail back
    let along = [0, 1].map(|w| rear.history.column(Channel::Traction(w)));
    for (k, force) in force.iter().enumerate() {
        assert_eq!([along[0][k], along[1][k]], [-force, 0.0]);
    }
}

#[test]
fn driven_bogie_crosses_the_girder_as_the_prescribed_one_within_its_slip() {
    let end = 12.0;
    let mut prescribed = bogie(5.0, end, Damper::Ground);
    prescribed.output_dt = end / 3000.0;
    let mut driven = prescribed.clone();
    driven.bodies[0].motion = None;
    driven.bodies[0].free[0] = true;
    driven.bodies[0].start_speed[0] = 5.0;
    // The force lags by m / gain = 0.15 ms.
    let gain = 1e9;
    driven.actuators.drives = vec![drive(&[[0.0, 5.0]], gain, f64::INFINITY, &[])];
    let (prescribed, driven) = (run(&prescribed, girder()), run(&driven, girder()));
    let wanted = prescribed.history.column(Channel::Drive(0));
    let found = driven.history.column(Channel::Drive(0));
    let x = driven.history.column(X);
    let (at, peak) = found
        .iter()
        .copied()
        .enumerate()
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
        .expect("a sample");
    println!(
        "peak {peak:.0} lb at {:.2} ft; {:?}, {:?}",
        x[at], driven.counts, prescribed.counts
    );
    // Analytic: one static wheel of all the weight has 64,635 lb against the motion at 12.68 ft.
    assert!((peak + 64_635.0).abs() < 1e-3 * 64_635.0, "{peak}");
    assert!((x[at] - 12.68).abs() < 0.05, "{}", x[at]);
    let apart = wanted
        .iter()
        .zip(&found)
        .skip(3)
        .fold(0.0_f64, |max, (a, b)| max.max((a - b).abs()));
    println!("force along the rail differs by {apart:.1} lb");
    assert!(apart < 5e-4 * peak.abs());
    // The body is behind by the integral of F / gain at most: 12 s of the peak.
    let behind = error(&driven, X, |t| 5.0 * t);
    println!("behind by {behind:.1e} ft");
    assert!(behind < peak.abs() / gain * end);
    let deepest = |run: &Run| {
        run.history
            .column(Channel::Displacement(0, BodyDof::Y))
            .iter()
            .fold(0.0_f64, |max, y| max.max(-y))
    };
    assert!((deepest(&driven) - deepest(&prescribed)).abs() < 1e-5);
    assert!(
        driven.audit.residual() < 1e-5,
        "{}",
        driven.audit.residual()
    );
}

#[test]
fn brake_stops_in_the_distance_of_its_friction() {
    let (mu, v0, from) = (0.2, 5.0, 0.4);
    let mut scene = free(v0, 3.0);
    scene.wheels[0].friction = Some(Friction {
        law: FrictionLaw::Step,
        coefficient: mu,
        slip: 0.1,
    });
    scene.bodies[0].free[5] = false;
    let speed = BRAKE_SPEED_FT;
    scene.actuators.brakes = vec![Brake {
        body: 0,
        from,
        speed,
        contacts: vec![0, 1],
    }];
    let run = run(&scene, rigid());
    // Analytic: m v' = -mu W tanh(v/s): sinh(v/s) = sinh(v0/s) exp(-mu g t/s), written without overflow.
    let wanted = |t: f64| {
        let log = v0 / speed - mu * GRAVITY * (t - from).max(0.0) / speed;
        let half = log.exp() * 0.5;
        if log > 30.0 {
            speed * log
        } else {
            speed * half.asinh()
        }
    };
    let err = error(&run, SPEED, wanted);
    // The stopping distance, v0^2 / 2 mu g, and what tanh adds: the integral of v (1/tanh(v/s) - 1) / mu g.
    let distance = v0 * v0 / (2.0 * mu * GRAVITY);
    let creep = (PI * speed).powi(2) / (12.0 * mu * GRAVITY);
    let x = run.history.column(X);
    let stopped = x.last().copied().unwrap_or_default() - v0 * from;
    println!(
        "speed errs by {err:.1e}; stops in {stopped:.9} ft of {distance:.9} + {creep:.1e}, {:?}",
        run.counts
    );
    assert!(err < 1e-5);
    assert!((stopped - distance - creep).abs() < 1e-6);
    let lost = 0.5 * MASS * v0 * v0;
    assert!((run.audit.exchanged.friction / lost - 1.0).abs() < 1e-6);
    assert!(run.audit.residual() < 1e-6, "{}", run.audit.residual());
    let most = run
        .history
        .column(Channel::Brake(0))
        .iter()
        .fold(0.0_f64, |max, force| max.min(*force));
    assert!((most / (mu * WEIGHT) + 1.0).abs() < 1e-9, "{most}");
    // each wheel pushes the rail by the friction of its own load, and together by the whole brake
    let brake = run.history.column(Channel::Brake(0));
    let along = [0, 1].map(|w| run.history.column(Channel::Traction(w)));
    for (k, brake) in brake.iter().enumerate() {
        assert!((along[0][k] + along[1][k] + brake).abs() < 1e-9 * WEIGHT);
        assert!(
            (along[0][k] - along[1][k]).abs() < 1e-9 * WEIGHT,
            "the bogie is even"
        );
    }
}

#[test]
fn drive_that_gives_way_to_its_brake_keeps_its_energy_on_the_girder() {
    let mut scene = bogie(0.0, 10.0, Damper::Rail);
    scene.wheels[0].friction = Some(Friction {
        law: FrictionLaw::Step,
        coefficient: 0.2,
        slip: 0.1,
    });
    scene.bodies[0].motion = None;
    scene.bodies[0].free[0] = true;
    let mut up = drive(&[[0.0, 0.0], [2.0, 5.0]], 1e6, 3e5, &[0, 1]);
    up.until = 6.0;
    scene.actuators.drives = vec![up];
    let brake = Brake {
        body: 0,
        from: 6.0,
        speed: BRAKE_SPEED_FT,
        contacts: vec![0, 1],
    };
    scene.actuators.brakes = vec![brake];
    let run = run(&scene, girder());
    assert_eq!(run.status, Status::Done);
    let speed = run.history.column(SPEED);
    println!(
        "{:?}, residual {:.1e}, last speed {:.1e}",
        run.counts,
        run.audit.residual(),
        speed[100]
    );
    assert!(speed[59] > 4.5 && speed[100].abs() < BRAKE_SPEED_FT);
    assert_eq!(run.history.column(Channel::Drive(0))[61], 0.0);
    assert!(run.audit.residual() < 1e-5, "{}", run.audit.residual());
}

#[test]
fn actuators_that_cannot_act_are_refused() {
    let refused = |change: &dyn Fn(&mut Scene)| {
        let mut scene = free(0.0, 1.0);
        change(&mut scene);
        sim::run(&scene, &[rigid()], &mut |_| ControlFlow::Continue(())).err()
    };
    let load = |freedom| Load {
        body: 0,
        dof: freedom,
        value: schedule(&[[0.0, 1.0]]),
    };
    let held = refused(&|scene| scene.actuators.loads = vec![load(BodyDof::Z)]);
    assert_eq!(
        held,
        Some(Error::NotFree {
            body: 0,
            dof: BodyDof::Z
        })
    );
    let prescribed = refused(&|scene| {
        scene.bodies[0].motion = bogie(5.0, 1.0, Damper::Rail).bodies[0].motion.clone();
        scene.actuators.drives = vec![drive(&[[0.0, 1.0]], 1.0, 1.0, &[])];
    });
    assert_eq!(
        prescribed,
        Some(Error::NotFree {
            body: 0,
            dof: BodyDof::X
        })
    );
    let backwards =
        refused(&|scene| scene.actuators.drives = vec![drive(&[[0.0, 1.0]], -1.0, 1.0, &[])]);
    assert!(matches!(
        backwards,
        Some(Error::Number {
            what: "gain of a drive",
            ..
        })
    ));
    let missing =
        refused(&|scene| scene.actuators.drives = vec![drive(&[[0.0, 1.0]], 1.0, 1.0, &[7])]);
    assert_eq!(
        missing,
        Some(Error::NoSuch {
            what: "contact",
            index: 7
        })
    );
    let smooth = refused(&|scene| {
        scene.actuators.brakes = vec![Brake {
            body: 0,
            from: 0.0,
            speed: 0.02,
            contacts: vec![1],
        }];
    });
    assert_eq!(
        smooth,
        Some(Error::NoSuch {
            what: "friction of braked contact",
            index: 1
        })
    );
    let spinning = refused(&|scene| {
        scene.wheels[0].friction = Some(Friction {
            law: FrictionLaw::Step,
            coefficient: 0.2,
            slip: 0.1,
        });
        scene.wheels[0].spin_inertia = Some(1.0);
        scene.actuators.drives = vec![drive(&[[0.0, 1.0]], 1.0, 1.0, &[0])];
    });
    assert_eq!(spinning, Some(Error::Spins { contact: 0 }));
}
