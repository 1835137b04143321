//! The energy audit: its terms against closed forms, and balances that close only with the terms of hand-over, of climbing
//! flanges and of damped contacts.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::kutta::Kernel;
use common::parts::{CENTRES, STATES, arms, basis, chain, stiffness};
use common::{GRAVITY, WEIGHT, bogie};
use nalgebra::DMatrix;
use sim::{
    Audit, BodyDof, Channel, Damper, Extent, Flange, Foundation, Load, Run, Scene, Schedule, Status,
};
use splines::{Axis, ExactSurface, Probe};

fn run(scene: &Scene, foundation: Foundation) -> Run {
    let run =
        sim::run(scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    run
}

/// |stored + lost - supplied - stored at the start| of the audit at the end.
fn gap(audit: &Audit) -> f64 {
    (audit.end.total() + audit.exchanged.net_loss() - audit.start.total()).abs()
}

#[test]
fn the_residual_is_the_imbalance_by_the_peak_of_elastic_energy() {
    let audit = |imbalance, peak_stored| Audit {
        imbalance,
        peak_stored,
        ..Audit::default()
    };
    assert_eq!(audit(3.0, 12.0).residual(), 0.25);
    // Where nothing is elastic there is no scale, and the imbalance itself is given.
    assert_eq!(audit(3.0, 0.0).residual(), 3.0);
    assert_eq!(audit(0.0, 0.0).residual(), 0.0);
}

/// Two rigid halves without mass and one force a part and wheel, handed over within 60 ft of the joint.
fn separate() -> Foundation {
    let flexible = stiffness().try_inverse().expect("the beam holds the parts");
    let states = basis() * flexible * basis().transpose();
    let mut nodal = DMatrix::zeros(12, 12);
    for (i, &row) in STATES.iter().enumerate() {
        for (j, &column) in STATES.iter().enumerate() {
            nodal[(row, column)] = states[(i, j)];
        }
    }
    let chain = chain(Some(60.0));
    let extent = Extent {
        range: Some(chain.range()),
        breaks: chain.breaks(),
    };
    Foundation {
        compliance: Some(Box::new(
            ExactSurface::new(arms(&CENTRES), nodal).expect("two states"),
        )),
        parts: Some(vec![chain]),
        rails: vec![extent],
        ..Foundation::default()
    }
}

/// Identity: the law of a part is multiplied by a fraction that changes along the rail, which takes its elastic energy
/// away or adds to it. With this exchange the balance closes, for every law and both dampers.
#[test]
fn handing_a_wheel_over_from_part_to_part_closes_the_balance() {
    for (damper, damping, exponent, depth) in [
        (Damper::Rail, 0.0, 1.0, 0.0),
        (Damper::Rail, 1e5, 1.0, 0.0),
        (Damper::Ground, 1e5, 1.0, 0.0),
        (Damper::Ground, 1e5, 1.3, 0.01),
    ] {
        let mut scene = bogie(10.0, 5.8, damper);
        let law = &mut scene.wheels[0].normal;
        (law.damping, law.exponent, law.depth) = (damping, exponent, depth);
        scene.accuracy = 1e-7;
        let audit = run(&scene, separate()).audit;
        let handed = audit.exchanged.handover;
        println!(
            "{damper:?} {exponent}: {handed:.4e} of {:.4e}, gap {:.1e}",
            audit.peak_stored,
            gap(&audit)
        );
        assert!(handed.abs() > 1e-4 * audit.peak_stored, "{handed:e}");
        assert!(
            audit.residual() < 1e-6 && gap(&audit) < 1e-6 * audit.peak_stored,
            "{:e}",
            audit.residual()
        );
    }
}

/// Identity: a load pushes the flange of a wheel, which jumps. While it climbs, S(h) releases the flange force, and its
/// elastic energy k S overlap^2/2 decreases without work; while it falls, it increases. The balance closes with this
/// exchange alone.
#[test]
fn a_flange_that_climbs_loses_the_energy_of_its_release() {
    let (stiffness, clearance, push) = (4e4, 0.01, 300.0);
    let mut scene = bogie(0.0, 0.35, Damper::Rail);
    let body = &mut scene.bodies[0];
    (body.mass, body.inertia) = (10.0, [10.0; 3]);
    body.free = [false, true, true, false, false, false];
    body.start_speed[1] = 1.5;
    scene.contacts.truncate(1);
    scene.contacts[0].offsets = vec![0.0];
    let wheel = &mut scene.wheels[0];
    (wheel.normal.stiffness, wheel.normal.damping) = (2e5, 0.0);
    wheel.flange = Some(Flange {
        stiffness,
        clearance,
        release: Some([1.26, 1.32]),
    });
    let value = Schedule::new(&[[0.0, push]]).expect("a row");
    scene.actuators.loads.push(Load {
        body: 0,
        dof: BodyDof::Z,
        value,
    });
    scene.accuracy = 1e-9;
    let found = run(&scene, Foundation::rigid());
    let audit = &found.audit;
    let lost = audit.exchanged.flanges;
    let side = found.history.column(Channel::Lateral(0));
    println!(
        "lost {lost:.4e} of {:.4e}, residual {:.1e}",
        audit.peak_stored,
        audit.residual()
    );
    let holds = side.iter().filter(|force| **force != 0.0).count();
    assert!(
        holds > 10 && holds + 10 < side.len(),
        "the flange holds, and lets go while the wheel is high"
    );
    assert!(lost.abs() > 1e-3 * audit.peak_stored, "{lost:e}");
    assert!(audit.residual() < 1e-6, "{:e}", audit.residual());
    // Analytic: what the load supplies is the push times the way to the side.
    let z = found.history.column(Channel::Displacement(0, BodyDof::Z));
    let work = push * (z[z.len() - 1] - z[0]);
    assert!(
        (audit.exchanged.loads - work).abs() < 1e-7 * work.abs(),
        "{} of {work}",
        audit.exchanged.loads
    );
}

/// Analytic: m g y of a body at y from the place where it touches the unloaded rail, and m v^2/2.
#[test]
fn gravity_is_measured_from_the_unloaded_rail() {
    let mut scene = bogie(0.0, 0.1, Damper::Rail);
    scene.bodies[0].start_speed[1] = 2.0;
    scene.contacts.truncate(1);
    scene.contacts[0].offsets = vec![0.0];
    scene.bodies[0].free = [false, true, false, false, false, false];
    let found = run(&scene, Foundation::rigid());
    let (start, end) = (found.audit.start, found.audit.end);
    let y = found.history.column(Channel::Displacement(0, BodyDof::Y));
    assert!(
        (y[0] + WEIGHT / 1e8).abs() < 1e-12,
        "it begins at rest on its wheel"
    );
    let last = y[y.len() - 1];
    assert!(
        (start.gravity - WEIGHT * y[0]).abs() < 1e-9 * WEIGHT,
        "{start:?} at {}",
        y[0]
    );
    assert!(
        (end.gravity - WEIGHT * last).abs() < 1e-9 * WEIGHT,
        "{end:?} at {last}"
    );
    let speed = found.history.column(Channel::Speed(0, BodyDof::Y));
    let v = speed[speed.len() - 1];
    assert!(
        (end.kinetic - 0.5 * WEIGHT / GRAVITY * v * v).abs() < 1e-9 * WEIGHT,
        "{end:?} at {v}"
    );
}

/// Identity: on a rail that gives to the side, the force of a flange acts on the slope of the deflected rail, and slows or
/// drives its own body. Two bodies of different mass exchange energy through the rail alone, so that the balance closes.
#[test]
fn flanges_on_a_rail_that_gives_to_the_side_push_their_own_bodies_along() {
    let give = [1e-6, 4e-4];
    let kernel = Kernel(move |p: Probe, q: Probe| {
        let g = match (p.axis, q.axis) {
            (Axis::Vertical, Axis::Vertical) => give[0],
            (Axis::Lateral, Axis::Lateral) => give[1],
            _ => return [0.0; 2],
        };
        [g * (1.0 + 0.3 * p.x * q.x), 0.3 * g * q.x]
    });
    let mut scene = bogie(0.0, 1.0, Damper::Rail);
    let wheel = &mut scene.wheels[0];
    (wheel.normal.stiffness, wheel.normal.damping) = (2e5, 0.0);
    wheel.flange = Some(Flange {
        stiffness: 4e4,
        clearance: 0.002,
        release: None,
    });
    let first = scene.bodies[0].clone();
    let bodies = [(40.0, 1.0, 2.0, 150.0), (90.0, 3.0, -0.5, -80.0)];
    scene.bodies = bodies
        .iter()
        .map(|&(mass, x, v, _)| sim::Body {
            mass,
            inertia: [mass; 3],
            free: [true, true, true, false, false, false],
            motion: None,
            start: [x, 0.0, 0.0, 0.0, 0.0, 0.0],
            start_speed: [v, 0.0, 0.0, 0.0, 0.0, 0.0],
            ..first.clone()
        })
        .collect();
    scene
        .contacts
        .iter_mut()
        .enumerate()
        .for_each(|(body, contact)| {
            (contact.body, contact.offsets) = (body, vec![0.0]);
        });
    for (body, &(.., push)) in bodies.iter().enumerate() {
        let value = Schedule::new(&[[0.0, push]]).expect("a row");
        scene.actuators.loads.push(Load {
            body,
            dof: BodyDof::Z,
            value,
        });
    }
    scene.accuracy = 1e-9;
    let found = run(&scene, Foundation::massless(Box::new(kernel), 1));
    let audit = &found.audit;
    for (body, &(mass, _, v, _)) in bodies.iter().enumerate() {
        let speed = found.history.column(Channel::Speed(body, BodyDof::X));
        let gained = 0.5 * mass * (speed[speed.len() - 1].powi(2) - v * v);
        println!("body {body}: {gained:.3e} of {:.3e}", audit.peak_stored);
        assert!(gained.abs() > 1e-3 * audit.peak_stored, "{gained:e}");
    }
    println!("residual {:.1e}", audit.residual());
    assert!(audit.residual() < 1e-6, "{:e}", audit.residual());
}
