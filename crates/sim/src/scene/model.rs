//! A scene: bodies on wheels along the rails of structures, and the actions on them.

use splines::Probe;

use super::actuators::Actuators;
use super::body::{Body, Contact};
use super::wheel::Wheel;

/// A point on a rail whose displacement is recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gauge {
    /// Which structure.
    pub structure: usize,
    /// Position on the rails and direction of the displacement.
    pub probe: Probe,
}

/// Type of analysis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Analysis {
    /// Integration of the equations of motion.
    #[default]
    Dynamic,
    /// A sequence of static equilibria along the prescribed motion.
    QuasiStatic,
}

/// All moving bodies, the actions on them, and the duration of the run.
///
/// [`Scene::default`] is an empty dynamic scene in SI units: gravity of 9.81 m/s^2, one second with an output every
/// 0.01 s, a relative accuracy of 1e-6.
/// ```
/// use sim::{Body, Contact, Damper, NormalLaw, Scene, Wheel};
///
/// // A mass on one wheel.
/// let scene = Scene {
///     bodies: vec![Body::new(1000.0, [0.0; 3])],
///     wheels: vec![Wheel::new(0.5, NormalLaw::linear(1e8, 0.0, Damper::Rail))],
///     contacts: vec![Contact::new(0, [0.0; 3])],
///     ..Scene::default()
/// };
/// assert!(scene.check(1).is_ok());
/// // There must be the structure that its contact names.
/// assert!(scene.check(0).is_err());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Acceleration of gravity, positive downwards.
    pub gravity: f64,
    /// Bodies.
    pub bodies: Vec<Body>,
    /// Kinds of wheels.
    pub wheels: Vec<Wheel>,
    /// Contacts.
    pub contacts: Vec<Contact>,
    /// Points whose displacement is recorded.
    pub gauges: Vec<Gauge>,
    /// Loads, drives, brakes, ropes, stops, prescribed spins and rules.
    pub actuators: Actuators,
    /// Type of analysis.
    pub analysis: Analysis,
    /// End time; the run starts at 0.
    pub end: f64,
    /// Output interval of the history.
    pub output_dt: f64,
    /// Number of samples of the history in each output interval, at least 1.
    pub output_parts: usize,
    /// Required relative accuracy of displacements and forces.
    pub accuracy: f64,
}

impl Default for Scene {
    fn default() -> Self {
        Scene {
            gravity: 9.81,
            bodies: Vec::new(),
            wheels: Vec::new(),
            contacts: Vec::new(),
            gauges: Vec::new(),
            actuators: Actuators::default(),
            analysis: Analysis::default(),
            end: 1.0,
            output_dt: 0.01,
            output_parts: 1,
            accuracy: 1e-6,
        }
    }
}

impl Scene {
    /// Time of sample `k`. It is exactly the end time where the product differs from it by rounding only.
    pub(crate) fn output_time(&self, k: u64) -> f64 {
        let parts = self.output_parts.max(1) as u64;
        // an integer division takes as long as ten products
        let (whole, part) = if parts == 1 {
            (k, 0)
        } else {
            (k / parts, k % parts)
        };
        let mut t = whole as f64 * self.output_dt;
        if part != 0 {
            t += part as f64 / parts as f64 * self.output_dt;
        }
        if (t - self.end).abs() <= 1e-12 * self.end {
            self.end
        } else {
            t
        }
    }

    /// Times at which a step must end, in ascending order; the last one is the end of the run.
    #[must_use]
    pub fn breaks(&self) -> Vec<f64> {
        let mut breaks: Vec<f64> = self
            .bodies
            .iter()
            .filter_map(|body| body.motion.as_ref())
            .flat_map(|profile| profile.breaks().iter().copied())
            .chain(self.actuators.breaks())
            .filter(|&t| t > 0.0 && t < self.end)
            .collect();
        breaks.push(self.end);
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }
}
