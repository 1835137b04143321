//! The order of the method with fixed steps, against closed forms.

use super::Stepper;
use crate::solver::Solver;
use crate::state::State;
use crate::system::System;
use crate::{Analysis, Body, Contact, Damper, Error, Foundation, NormalLaw, Scene, Wheel};

/// One undamped wheel of mass 1 and stiffness 100 on a rigid rail, in weight 10; it starts 0.05 above its rest.
fn scene() -> Scene {
    Scene {
        gravity: 10.0,
        bodies: vec![Body {
            mass: 1.0,
            inertia: [0.0; 3],
            cg: [0.0; 3],
            free: [false, true, false, false, false, false],
            start: [0.0; 6],
            start_speed: [0.0; 6],
            motion: None,
            pinned: None,
        }],
        wheels: vec![Wheel {
            radius: 1.0,
            normal: NormalLaw::linear(100.0, 0.0, Damper::Rail),
            flange: None,
            friction: None,
            spin_inertia: None,
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
        actuators: crate::Actuators::default(),
        analysis: Analysis::Dynamic,
        end: 1.0,
        output_dt: 1.0,
        accuracy: 1e-6,
    }
}

/// Runs `body` with a stepper that starts at height `y` with speed `v`.
fn with<T>(y: f64, v: f64, body: impl FnOnce(&mut Stepper<'_, '_>) -> Result<T, Error>) -> Result<T, Error> {
    let (scene, foundations) = (scene(), [Foundation::rigid()]);
    let system = System::new(&scene, &foundations)?;
    let mut solver = Solver::new(&system)?;
    let mut state = State::zeros(system.freedoms, system.normals.len(), system.components());
    (state.q[0], state.v[0]) = (y, v);
    solver.settle(&mut state)?;
    body(&mut Stepper::new(&mut solver, state, 1.0, 1.0))
}

fn slope(errors: &[f64]) -> f64 {
    (errors[0] / errors[errors.len() - 1]).log2() / (errors.len() - 1) as f64
}

#[test]
fn error_of_an_oscillation_falls_with_the_fourth_power_of_the_step() -> Result<(), Error> {
    let mut errors = Vec::new();
    for steps in [40_u32, 80, 160, 320] {
        let end = with(-0.05, 0.0, |stepper| {
            for _ in 0..steps {
                stepper.from.copy_from(&stepper.to);
                assert!(stepper.attempt(1.0 / f64::from(steps))?);
            }
            Ok(stepper.to.q[0])
        })?;
        // Analytic: y = -0.1 + 0.05 cos(10 t).
        errors.push((end - (-0.1 + 0.05 * 10.0_f64.cos())).abs());
    }
    assert!((slope(&errors) - 4.0).abs() < 0.1, "{errors:?}");
    Ok(())
}

#[test]
fn instant_at_which_a_wheel_leaves_converges_with_the_step() -> Result<(), Error> {
    // Analytic: y = -0.1 + (3/10) sin(10 t) reaches 0 at sin(10 t) = 1/3.
    let wanted = (1.0_f64 / 3.0).asin() / 10.0;
    let mut errors = Vec::new();
    for steps in [1_u32, 2, 4, 8] {
        let h = 0.05 / f64::from(steps);
        errors.push(with(-0.1, 3.0, |stepper| {
            loop {
                stepper.from.copy_from(&stepper.to);
                assert!(stepper.attempt(h)?);
                if let Some((share, _)) = stepper.first_event()? {
                    return Ok((stepper.from.t + share * h - wanted).abs());
                }
            }
        })?);
    }
    assert!(slope(&errors) > 3.5, "{errors:?}");
    Ok(())
}
