//! Wheels whose spin is prescribed against closed forms and an independent integration.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::kutta::rk4;
use common::{GRAVITY, bogie};
use sim::{
    BodyDof, Channel, Damper, Error, Foundation, Friction, FrictionLaw, Load, MotionKind,
    PrescribedSpin, Profile, Run, Scene, Schedule, Status,
};

const MASS: f64 = 5.0;
const WEIGHT: f64 = MASS * GRAVITY;
const MU: f64 = 0.3;
const INERTIA: f64 = 2.0;
const K: f64 = 1e5;
const X: Channel = Channel::Displacement(0, BodyDof::X);
const V: Channel = Channel::Speed(0, BodyDof::X);

/// A body on one wheel (and `others` with a spin of their own) of friction STEP, whose spin follows `table`.
fn turned(given: MotionKind, table: &[[f64; 2]], slip: f64, others: usize, end: f64) -> Scene {
    let mut scene = bogie(0.0, end, Damper::Rail);
    let body = &mut scene.bodies[0];
    (body.mass, body.inertia, body.motion) = (MASS, [MASS; 3], None);
    body.free = [true, true, false, false, false, false];
    scene.contacts.truncate(1 + others);
    let wheel = &mut scene.wheels[0];
    (
        wheel.normal.stiffness,
        wheel.normal.damping,
        wheel.spin_inertia,
    ) = (K, 0.0, Some(INERTIA));
    wheel.friction = Some(Friction {
        law: FrictionLaw::Step,
        coefficient: MU,
        slip,
    });
    let motion = Profile::new(given, table, 0.0, 0.0).expect("rows");
    scene.actuators.spins = vec![PrescribedSpin {
        contact: 0,
        wheel: 0,
        motion,
    }];
    scene.accuracy = 1e-8;
    scene
}

fn run(scene: &Scene) -> Run {
    let run = sim::run(scene, &[Foundation::rigid()], &mut |_| {
        ControlFlow::Continue(())
    });
    let run = run.expect("a valid scene");
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

/// Height of the hub over the rail.
fn arm() -> f64 {
    1.25 - WEIGHT / K
}

/// s at which STEP(s, -slip, -1, slip, 1) = (3 s/slip - (s/slip)^3)/2 is `share`.
fn slide(slip: f64, share: f64) -> f64 {
    slip * 2.0 * (share.asin() / 3.0).sin()
}

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
fn wheel_slides_steadily_where_friction_balances_a_load() {
    // Analytic: mu N S(s) = P; the moment holds h P against the load.
    let (slip, spin, share) = (0.2, -4.0, 0.5);
    let mut scene = turned(MotionKind::Speed, &[[0.0, spin]], slip, 0, 3.0);
    let pushed = share * MU * WEIGHT;
    let value = Schedule::new(&[[0.0, pushed]]).expect("a row");
    scene.actuators.loads = vec![Load {
        body: 0,
        dof: BodyDof::X,
        value,
    }];
    let found = run(&scene);
    close(
        "speed",
        last(&found, V),
        -spin * arm() + slide(slip, share),
        1e-8,
    );
    close(
        "friction",
        last(&found, Channel::Traction(0)),
        pushed,
        1e-6 * pushed,
    );
    close(
        "moment",
        last(&found, Channel::SpinMoment(0)),
        arm() * pushed,
        1e-6 * pushed,
    );
    close(
        "angle",
        last(&found, Channel::SpinAngle(0)),
        3.0 * spin,
        1e-12,
    );
    assert!(
        found.audit.imbalance < 1e-7 * 0.5 * MASS * 25.0,
        "{:e}",
        found.audit.imbalance
    );
}

#[test]
fn body_follows_the_rim_of_its_wheel_where_hardly_any_slip_is_needed() {
    // Analytic: under constant acceleration the wheel slides by the s whose friction is m a; the less slip, the less.
    let (alpha, end) = (-3.0, 2.0);
    let share = MASS * 3.0 * arm() / (MU * WEIGHT);
    for slip in [1e-2, 1e-4] {
        let found = run(&turned(
            MotionKind::Acceleration,
            &[[0.0, alpha]],
            slip,
            0,
            end,
        ));
        let rim = -alpha * end * arm();
        close("speed", last(&found, V), rim - slide(slip, share), 1e-7);
        close(
            "moment",
            last(&found, Channel::SpinMoment(0)),
            INERTIA * alpha - arm() * MASS * 3.0 * arm(),
            1e-5,
        );
        let travel = last(&found, X);
        assert!((travel + alpha * end * end / 2.0 * arm()).abs() < 2.0 * slip * end);
        // What the moment puts in is what moves, and a little friction.
        let exchanged = &found.audit.exchanged;
        let moving = 0.5 * MASS * last(&found, V).powi(2) + 0.5 * INERTIA * (alpha * end).powi(2);
        close(
            "work",
            exchanged.drives - exchanged.friction,
            moving,
            1e-6 * moving,
        );
        assert!(exchanged.friction < 2.0 * slip * MU * WEIGHT * end);
        assert!(
            found.audit.imbalance < 1e-7 * moving,
            "{:e}",
            found.audit.imbalance
        );
    }
}

#[test]
fn spinning_wheel_pulls_with_all_its_friction_until_it_rolls() {
    // Analytic: v = mu g t while it slides; the moment is -h mu N, its power splits evenly into speed and heat.
    let (slip, spin, end) = (0.05, -40.0, 1.0);
    let found = run(&turned(
        MotionKind::Position,
        &[[0.0, 0.0], [1.0, spin]],
        slip,
        0,
        end,
    ));
    close("speed", last(&found, V), MU * GRAVITY * end, 1e-7);
    let history = found.history.column(Channel::SpinMoment(0));
    close("moment", history[50], -arm() * MU * WEIGHT, 1e-7);
    // The table ends with the run: there the wheel is stopped, and gives its own energy back.
    let put_in = arm() * MU * WEIGHT * -spin * end - 0.5 * INERTIA * spin * spin;
    close(
        "work",
        found.audit.exchanged.drives,
        put_in,
        1e-6 * put_in.abs(),
    );
    assert!(
        found.audit.imbalance < 1e-7 * put_in.abs(),
        "{:e}",
        found.audit.imbalance
    );
}

#[test]
fn driven_wheel_takes_its_body_and_the_other_wheel_along() {
    let (slip, end) = (0.3, 1.5);
    let found = run(&turned(
        MotionKind::Speed,
        &[[0.0, 0.0], [1.0, -6.0]],
        slip,
        1,
        end,
    ));
    // External: v and the other spin by Runge-Kutta; both wheels carry half of the weight.
    let arm = 1.25 - 0.5 * WEIGHT / K;
    let friction = |s: f64| {
        let s = (s / slip).clamp(-1.0, 1.0);
        0.5 * MU * WEIGHT * (1.5 * s - 0.5 * s * s * s)
    };
    let [v, other] = rk4([0.0, 0.0], end, 150_000, |t, [v, other]| {
        let (driven, rolling) = (
            friction(v - arm * 6.0 * t.min(1.0)),
            friction(v + arm * other),
        );
        [-(driven + rolling) / MASS, -rolling * arm / INERTIA]
    });
    close("speed", last(&found, V), v, 1e-6);
    close("spin", last(&found, Channel::SpinSpeed(1)), other, 1e-6);
    assert!(
        found.audit.imbalance < 1e-6 * 0.5 * MASS * v * v,
        "{:e}",
        found.audit.imbalance
    );
}

#[test]
fn spins_that_cannot_be_prescribed_are_refused() {
    let table = [[0.0, 1.0]];
    let refused = |scene: &Scene| {
        sim::run(scene, &[Foundation::rigid()], &mut |_| {
            ControlFlow::Continue(())
        })
        .err()
    };
    let mut scene = turned(MotionKind::Speed, &table, 0.1, 0, 1.0);
    scene.actuators.spins[0].wheel = 1;
    assert!(matches!(refused(&scene), Some(Error::NoSuch { .. })));
    let mut scene = turned(MotionKind::Speed, &table, 0.1, 0, 1.0);
    scene.actuators.spins.push(scene.actuators.spins[0].clone());
    assert!(matches!(refused(&scene), Some(Error::Number { .. })));
    let mut scene = turned(MotionKind::Speed, &table, 0.1, 0, 1.0);
    scene.wheels[0].friction = None;
    assert!(matches!(refused(&scene), Some(Error::NoSuch { .. })));
}
