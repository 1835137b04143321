//! Driven wheels over rails whose head turns with girders that are hinged: it steps along x at every joint.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::bogie;
use common::hinged::Hinged;
use sim::{BodyDof, Channel, Damper, Drive, Foundation, Scene, Schedule, Status};

/// The paper's bogie on hinged lengths, driven at `speed` from 5 ft/s.
fn driven(end: f64, speed: &[[f64; 2]], gain: f64, max_force: f64) -> (Scene, Foundation) {
    let mut scene = bogie(0.0, end, Damper::Rail);
    let body = &mut scene.bodies[0];
    body.motion = None;
    body.free[0] = true;
    body.start[0] = 5.0;
    body.start_speed[0] = 5.0;
    let speed = Schedule::new(speed).expect("a valid table");
    let contacts = vec![0, 1];
    scene.actuators.drives = vec![Drive {
        body: 0,
        speed,
        gain,
        max_force,
        contacts,
        until: f64::INFINITY,
    }];
    let mut foundation = Foundation::massless(Box::new(Hinged), 1);
    foundation.is_loaded_along = true;
    (scene, foundation)
}

/// Analytic: a drive stiffer than the give of its rail gives all it can until the speed is reached, then what holds it there. Its
/// force follows the slip within gain times give, 0.2 s at 1e7 lbf s/ft; at 1e9 that is longer than the run. Newton's
/// method once went from one limit to the other without end there.
#[test]
fn stiff_limited_drives_come_to_their_speed() {
    for (speed, gain, end) in [
        (6.0, 1e7, 2.0),
        (4.0, 1e7, 2.0),
        (6.0, 1e9, 1.0),
        (4.0, 1e9, 1.0),
    ] {
        let (scene, foundation) = driven(end, &[[0.0, speed]], gain, 1e6);
        let run = sim::run(&scene, &[foundation], &mut |_| ControlFlow::Continue(()))
            .expect("a valid scene");
        assert_eq!(run.status, Status::Done, "gain {gain}");
        let v = run.history.column(Channel::Speed(0, BodyDof::X));
        let (end, residual) = (v[v.len() - 1], run.audit.residual());
        println!(
            "gain {gain:e} to {speed}: ends at {end}, residual {residual:.1e}, {:?}",
            run.counts
        );
        assert!(residual < 1e-3, "{residual}");
        if gain < 1e8 {
            assert!((end - speed).abs() < 0.03, "{end}");
        }
    }
}

/// Taken as smooth, the steps of the rail cost 0.16 of the peak energy whatever the accuracy; measured 7.8e-5 to 8.1e-6.
#[test]
fn driven_wheels_keep_their_energy_over_joints_that_step_along_the_rail() {
    for (accuracy, allowed) in [(1e-3, 2e-4), (1e-4, 1e-4), (1e-5, 2e-5)] {
        let (mut scene, foundation) = driven(6.0, &[[0.0, 5.0], [6.0, 8.0]], 1e6, f64::INFINITY);
        scene.accuracy = accuracy;
        let run = sim::run(&scene, &[foundation], &mut |_| ControlFlow::Continue(()))
            .expect("a valid scene");
        assert_eq!(run.status, Status::Done);
        let x = run.history.column(Channel::Displacement(0, BodyDof::X));
        assert!(x[x.len() - 1] > 40.0, "both wheels have passed four joints");
        let residual = run.audit.residual();
        println!(
            "asked {accuracy:.0e}: residual {residual:.1e}, {:?}",
            run.counts
        );
        assert!(residual < allowed, "{residual}");
    }
}
