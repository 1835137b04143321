//! Comparison of the quasi-static path of the deck with the sweep of the simulator.

use std::ops::ControlFlow;

use adams::AdamsModel;
use sim::{Analysis, BodyDof, Channel, Foundation, Status};

use crate::DeckPlan;
use crate::Error;
use crate::words::ids::number;

/// Number of time intervals between the equilibria that are compared.
const INTERVALS: u32 = 40;
/// Limit of the relative differences of heights and forces. They are not zero because parts of ADAMS have finite
/// rotations and bodies of the simulator small ones.
const LIMIT: f64 = 1e-4;

/// Differences between the two paths.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepDifference {
    /// Number of equilibria compared.
    pub places: usize,
    /// Largest difference of the height of a body's origin.
    pub height: f64,
    /// Largest vertical displacement of a body.
    pub deepest: f64,
    /// Largest difference of a wheel's vertical force.
    pub force: f64,
    /// Largest vertical force.
    pub largest: f64,
    /// The reason why one of the two paths could not be computed; `None` if both were.
    pub failed: Option<String>,
}

impl SweepDifference {
    /// Limit of the differences, relative to the largest displacement and force.
    #[must_use]
    pub fn limit(&self) -> f64 {
        LIMIT
    }

    /// Relative differences of heights and forces.
    #[must_use]
    pub fn relative(&self) -> [f64; 2] {
        let of = |difference: f64, most: f64| {
            if difference == 0.0 {
                0.0
            } else {
                difference / most
            }
        };
        [of(self.height, self.deepest), of(self.force, self.largest)]
    }

    /// Whether both paths were computed and their differences are within the limit.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.failed.is_none() && self.relative().iter().all(|value| *value <= LIMIT)
    }
}

/// Compares static equilibria along the prescribed motion; `None` if a body is free along its rail and therefore has
/// no static equilibrium.
///
/// # Errors
/// A scene that the simulator cannot run.
pub(super) fn path(
    plan: &DeckPlan<'_>,
    model: &AdamsModel,
    foundations: &[Foundation],
) -> Result<Option<SweepDifference>, Error> {
    if plan.scene.bodies.iter().any(|body| body.motion.is_free()) {
        return Ok(None);
    }
    let mut scene = plan.input.scene.clone();
    scene.analysis = Analysis::QuasiStatic;
    scene.output_dt = scene.end / f64::from(INTERVALS);
    let run =
        sim::run(&scene, foundations, &mut |_| ControlFlow::Continue(())).map_err(Error::Sweep)?;
    let mut out = SweepDifference {
        places: 0,
        height: 0.0,
        deepest: 0.0,
        force: 0.0,
        largest: 0.0,
        failed: None,
    };
    if let Status::StepTooSmall(t) | Status::Failed(t, _) = run.status {
        out.failed = Some(format!("the simulator stopped at t = {t}"));
        return Ok(Some(out));
    }
    let times = run.history.column(Channel::Time);
    let found = match model.quasi_static_path(&times) {
        Ok(found) => found,
        Err(error) => {
            out.failed = Some(error.to_string());
            return Ok(Some(out));
        }
    };
    out.places = times.len();
    for (b, body) in plan.bodies.iter().enumerate() {
        let expected = run.history.column(Channel::Displacement(b, BodyDof::Y));
        for (one, expected) in found.iter().zip(expected) {
            let y = one
                .state
                .parts
                .get(&body.part)
                .map_or(f64::MAX, |pose| pose.origin[1]);
            out.height = out.height.max((y - body.position[0] - expected).abs());
            out.deepest = out.deepest.max(expected.abs());
        }
    }
    for w in 0..plan.wheels.len() {
        let expected = run.history.column(Channel::Vertical(w));
        for (one, expected) in found.iter().zip(expected) {
            let load = one.solution.loads.get(&("GFORCE", number(w)));
            let down = load.map_or(f64::MAX, |load| load.components[1]);
            out.force = out.force.max((down - expected).abs());
            out.largest = out.largest.max(expected.abs());
        }
    }
    Ok(Some(out))
}
