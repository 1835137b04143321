//! Wheels with nonlinear contact laws and dampers that pass a step of the rail.

mod common;

use std::ops::ControlFlow;

use common::modes::beam;
use common::{WEIGHT, bogie, girder, single};
use sim::{Damper, Foundation, Irregularity, MotionKind, NormalLaw, Profile, Run, Scene, Status};

/// Compression of a wheel of the bogie at rest by the linear law of the paper.
const REST: f64 = 0.024;

struct Case {
    exponent: f64,
    damping: f64,
    height: f64,
    bilateral: bool,
    wheels: usize,
}

fn scene(case: &Case, accuracy: f64) -> Scene {
    let (speed, x0) = (30.0, 20.0);
    let mut scene = bogie(speed, 0.6, Damper::Rail);
    let body = &mut scene.bodies[0];
    body.motion = Some(Profile::new(MotionKind::Speed, &[[0.0, speed]], x0, 0.0).expect("a valid table"));
    if case.wheels == 1 {
        body.mass *= 0.5;
        body.free = [false, true, false, false, false, false];
        scene.contacts = vec![single()];
    }
    let stiffness = 0.5 * WEIGHT / REST.powf(case.exponent);
    scene.wheels[0].normal = NormalLaw {
        exponent: case.exponent,
        depth: 0.3 * REST,
        bilateral: case.bilateral,
        ..NormalLaw::linear(stiffness, case.damping, Damper::Rail)
    };
    scene.output_dt = 0.01;
    scene.accuracy = accuracy;
    scene
}

fn uneven(foundation: Foundation, height: f64) -> Foundation {
    let shape = Irregularity::new(&[[28.0, 0.0], [28.0, height]], &[]).expect("rows in order");
    Foundation { irregularities: vec![shape], ..foundation }
}

fn run(case: &Case, accuracy: f64, foundation: Foundation) -> Run {
    sim::run(&scene(case, accuracy), &[uneven(foundation, case.height)], &mut |_| ControlFlow::Continue(()))
        .expect("a valid scene")
}

type Named = (&'static str, fn() -> Foundation);

#[test]
fn no_wheel_is_stopped_by_a_step_of_its_rail() {
    let foundations: [Named; 4] = [
        ("massless", girder),
        ("modes", || beam(6, false)),
        ("modes and the rest", || beam(3, true)),
        ("rigid", Foundation::rigid),
    ];
    let (mut bad, mut all, mut abandoned) = (0, 0, 0);
    for (name, foundation) in foundations {
        for wheels in [1, 2] {
            for exponent in [1.0, 1.1, 1.5, 2.0] {
                for damping in [2e3, 2e4, 1e5, 4e5] {
                    for height in [0.1, 0.5, 2.0, -0.1, -0.5, -2.0] {
                        for bilateral in [false, true] {
                            let case = Case { exponent, damping, height: height * REST, bilateral, wheels };
                            for accuracy in [1e-2, 1e-4, 1e-6] {
                                let found = run(&case, accuracy, foundation());
                                all += 1;
                                abandoned += usize::from(found.abandoned.is_some());
                                if found.status != Status::Done {
                                    bad += 1;
                                    println!(
                                        "{name} {wheels} e {exponent} c {damping:e} h {height} {bilateral} {accuracy:e}: {:?}",
                                        found.status
                                    );
                                }
                            }
                        }
                    }
                }
            }
        }
    }
    println!("{bad} of {all}, {abandoned} abandoned");
    assert_eq!(bad, 0);
}
