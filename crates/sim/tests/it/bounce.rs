//! Wheels that bounce: each flight and each stay against closed forms, and no end of bounces that stops a run.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::{GRAVITY, WEIGHT, bogie, girder, single};
use sim::{BodyDof, Channel, Damper, Foundation, Run, Scene, Status, run};

/// One wheel under a mass at `x` of the paper's girder, let go `height` above the rail, with the damping `c`.
fn dropped(x: f64, height: f64, c: f64, end: f64) -> Scene {
    let mut scene = bogie(0.0, end, Damper::Rail);
    scene.contacts = vec![single()];
    let body = &mut scene.bodies[0];
    (body.motion, body.free) = (None, [false, true, false, false, false, false]);
    (body.start[0], body.start[1]) = (x, height);
    scene.wheels[0].normal.damping = c;
    scene
}

fn go(scene: &Scene, foundation: Foundation) -> Run {
    let run = run(scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(run.status, Status::Done, "{:?}", run.counts);
    run
}

/// Analytic: free flights of 2 sqrt(2 h/g) and stays of (pi + 2 atan(g/(v w)))/w, w^2 = k/m, in turn; every flight reaches h.
#[test]
fn an_undamped_wheel_bounces_for_ever_to_the_same_height() {
    let (height, k) = (0.05_f64, 1e8_f64);
    let omega = (k * GRAVITY / WEIGHT).sqrt();
    let speed = (2.0 * GRAVITY * height).sqrt();
    let flight = 2.0 * speed / GRAVITY;
    let stay = (std::f64::consts::PI + 2.0 * (GRAVITY / (speed * omega)).atan()) / omega;
    let bounces = 40;
    let mut scene = dropped(30.0, height, 0.0, f64::from(bounces) * (flight + stay));
    scene.accuracy = 1e-7;
    let run = go(&scene, Foundation::rigid());
    let y = run.history.column(Channel::Displacement(0, BodyDof::Y));
    let last = y.last().copied().expect("samples");
    println!(
        "after {bounces} bounces {last} ft, {:?}, energy {:e}",
        run.counts,
        run.audit.residual()
    );
    assert_eq!(run.counts.events, 2 * bounces as usize, "{:?}", run.counts);
    assert!((last / height - 1.0).abs() < 1e-3, "{last}");
    assert!(run.audit.residual() < 1e-5, "{:e}", run.audit.residual());
}

/// Analytic: whatever the damping and the accuracy, bounces on a rail that does not give die out and leave the mass at rest with
/// its weight on the wheel. A girder in series with the wheel takes most of the stroke, undamped: there they go on.
#[test]
fn bounces_on_a_rigid_rail_die_out_and_leave_the_weight_at_rest() {
    for (name, flexible) in [("rigid", false), ("flexible", true)] {
        for c in [1e5, 4e5, 1e6] {
            for accuracy in [1e-3, 1e-5] {
                let mut scene = dropped(22.0, 0.2, c, 40.0);
                scene.accuracy = accuracy;
                let run = go(
                    &scene,
                    if flexible {
                        girder()
                    } else {
                        Foundation::rigid()
                    },
                );
                let force = run.history.column(Channel::Vertical(0));
                let last = force.last().copied().expect("samples") / WEIGHT;
                let off = force.iter().filter(|force| **force == 0.0).count();
                println!(
                    "{name}, c {c:e}, accuracy {accuracy:e}: {:?}, force {last}, energy {:e}",
                    run.counts,
                    run.audit.residual()
                );
                assert!(off > 0, "it never left the rail");
                assert!(
                    flexible || (last - 1.0).abs() < 1e-6,
                    "{name}, c {c:e}, {accuracy:e}: {last}"
                );
                assert!(
                    run.audit.residual() < 10.0 * accuracy,
                    "{:e}",
                    run.audit.residual()
                );
            }
        }
    }
}

/// Independent: the same at a far finer accuracy. An output time in the step at whose end the wheel leaves belongs to a wheel that
/// still presses: taken as off, it errs by 1e-2 to 7e-2. Compared from the largest force on.
#[test]
fn samples_just_before_a_damped_wheel_leaves_have_its_force() {
    let forces = |accuracy: f64| {
        let mut scene = dropped(22.0, 0.1, 1e6, 0.9);
        (scene.output_dt, scene.accuracy) = (scene.end / 5000.0, accuracy);
        let run = go(&scene, girder());
        run.history.column(Channel::Vertical(0))
    };
    let fine = forces(1e-7);
    let peak = fine.iter().fold(0.0_f64, |most, force| most.max(*force));
    let first = fine
        .iter()
        .position(|force| *force == peak)
        .expect("a sample");
    assert!(fine[first..].contains(&0.0), "it leaves");
    for accuracy in [1e-3, 1e-4, 1e-5] {
        let found = forces(accuracy);
        let off = found[first..]
            .iter()
            .zip(&fine[first..])
            .fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
            / peak;
        println!("accuracy {accuracy:e}: {off:.1e} of the largest force");
        assert!(off < 5e-3, "{accuracy:e}: {off:e}");
    }
}

/// A tilted body of two wheels that falls on a girder without mass, which couples them: they clatter, and the run gets through.
#[test]
fn two_wheels_that_clatter_on_a_girder_come_to_rest() {
    for c in [0.0, 1e4, 1e5, 1e6] {
        for accuracy in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
            let mut scene = bogie(0.0, 4.0, Damper::Rail);
            let body = &mut scene.bodies[0];
            body.motion = None;
            (body.start[0], body.start[1], body.start[5]) = (20.0, 0.08, 0.02);
            scene.wheels[0].normal.damping = c;
            scene.accuracy = accuracy;
            let run = go(&scene, girder());
            let residual = run.audit.residual();
            println!(
                "c {c:e}, accuracy {accuracy:e}: {:?}, energy {residual:e}",
                run.counts
            );
            assert!(run.counts.events > 4, "{:?}", run.counts);
            assert!(
                run.counts.stages < 60 * run.counts.steps,
                "{:?}",
                run.counts
            );
            assert!(
                residual < 10.0 * accuracy,
                "c {c:e}, {accuracy:e}: {residual:e}"
            );
        }
    }
}
