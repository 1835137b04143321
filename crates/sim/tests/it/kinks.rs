//! The force of a wheel that rolls over a table: what the kinks of its reading strike out of it.

use crate::common;
use crate::printed;

use std::ops::ControlFlow;

use common::near::assert_near;
use common::{GRAVITY, WEIGHT, bogie, give, surface};
use sim::{Channel, Damper, Foundation, MotionKind, Profile, Status};
use splines::{Axis, Compliance, Influence, InfluenceBlock, Probe, ReadingMethod, TableReading};

/// One wheel that carries the whole bogie, and the dampers of both; from where to where it rolls, ft.
const STIFFNESS: f64 = 1e8;
const DAMPING: f64 = 2e5;
const WAY: [f64; 2] = [2.0, 56.0];

fn akispl() -> TableReading {
    let way = (0, Axis::Vertical);
    let sheet = InfluenceBlock {
        deflection: way,
        load: way,
        table: printed::table(&printed::VERTICAL),
    };
    TableReading::new(ReadingMethod::Akispl, &[sheet]).expect("a table")
}

/// Rate at which a slow wheel sinks where it starts.
fn rate(speed: f64) -> f64 {
    let sag = |x: f64| WEIGHT * give(x, x).0;
    let h = 1e-3;
    speed * (sag(WAY[0] + h) - sag(WAY[0] - h)) / (2.0 * h)
}

/// Largest share by which its force differs from the weight.
fn swing(foundation: Foundation, speed: f64, damping: f64) -> f64 {
    let end = (WAY[1] - WAY[0]) / speed;
    let mut scene = bogie(speed, end, Damper::Ground);
    scene.contacts.truncate(1);
    scene.contacts[0].offsets = vec![0.0];
    (
        scene.wheels[0].normal.stiffness,
        scene.wheels[0].normal.damping,
    ) = (STIFFNESS, damping);
    let body = &mut scene.bodies[0];
    body.free[5] = false;
    body.start[0] = WAY[0];
    body.start_speed[1] = -rate(speed);
    body.motion = Some(
        Profile::new(MotionKind::Speed, &[[0.0, speed]], WAY[0], speed).expect("a valid table"),
    );
    (scene.accuracy, scene.output_dt) = (1e-6, end / 8000.0);
    let run = sim::run(&scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("valid");
    assert_eq!(run.status, Status::Done);
    run.history
        .column(Channel::Vertical(0))
        .iter()
        .fold(0.0, |worst, force| worst.max((force / WEIGHT - 1.0).abs()))
}

/// The same by the method of Runge and Kutta, m z'' = W - F, F = (z + c/k z') / (1/k + G(x, x)) or none.
fn by_hand(of: &dyn Compliance, speed: f64, damping: f64) -> f64 {
    let own = |x: f64| {
        let mut out = Influence::zeros(1);
        of.fill(
            &[Probe {
                rail: 0,
                x,
                axis: Axis::Vertical,
            }],
            &mut out,
        )
        .expect("on the table");
        1.0 / STIFFNESS + out.value[(0, 0)]
    };
    let force = |t: f64, [z, v]: [f64; 2]| {
        ((z + damping / STIFFNESS * v) / own(WAY[0] + speed * t)).max(0.0)
    };
    let slope = |t: f64, y: [f64; 2]| [y[1], GRAVITY * (1.0 - force(t, y) / WEIGHT)];
    let steps = (8000.0_f64).max(4000.0 * (WAY[1] - WAY[0]) / speed) as usize;
    let h = (WAY[1] - WAY[0]) / speed / steps as f64;
    let mut y = [WEIGHT * own(WAY[0]), rate(speed)];
    let mut worst = 0.0_f64;
    for i in 0..steps {
        let t = i as f64 * h;
        let at = |y: [f64; 2], k: [f64; 2], s: f64| [y[0] + s * k[0], y[1] + s * k[1]];
        let a = slope(t, y);
        let b = slope(t + 0.5 * h, at(y, a, 0.5 * h));
        let c = slope(t + 0.5 * h, at(y, b, 0.5 * h));
        let d = slope(t + h, at(y, c, h));
        y = [0, 1].map(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        worst = worst.max((force(t + h, y) / WEIGHT - 1.0).abs());
    }
    worst
}

/// External for the exact girder and the table; independent: the same equation by other steps.
#[test]
fn kinks_of_a_table_strike_a_wheel_that_the_girder_carries_smoothly() {
    // The prototype's scene is not published in full. With this one, a wheel of 4.8e6 lb that starts at 2 ft, all its values
    // for the exact girder are met. Those for the table are not: 0.023, 0.178, 0.204, 0.165 and 1.01 undamped, 0.0033, 0.02,
    // 0.066, 0.093 and 0.51 damped. Ours for the table agree with the Runge-Kutta method of this test.
    for (speed, exact) in [
        (1.0, [2e-4, 5e-4]),
        (2.5, [1.4e-3, 2e-3]),
        (5.0, [5.4e-3, 6.6e-3]),
        (10.0, [0.02, 0.022]),
        (20.0, [0.066, 0.066]),
    ] {
        for (damping, exact) in [(0.0, exact[0]), (DAMPING, exact[1])] {
            let how = if damping > 0.0 { "damped" } else { "undamped" };
            let of = |what: &str| {
                format!("{what}, {speed} ft/s, {how}: largest change of the wheel's force by it")
            };
            let found = swing(Foundation::massless(Box::new(surface()), 1), speed, damping);
            // one or two digits
            let tolerance = if exact == 2e-4 { 0.25 } else { 0.04 };
            assert_near(of("exact girder"), "prototype", exact, found, tolerance);
            let found = swing(Foundation::massless(Box::new(akispl()), 1), speed, damping);
            let wanted = by_hand(&akispl(), speed, damping);
            assert_near(
                of("AKISPL"),
                "Runge-Kutta method of this test",
                wanted,
                found,
                5e-3,
            );
        }
    }
}
