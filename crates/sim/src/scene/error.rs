//! Errors in a scene. They contain indices and numbers only; the caller adds names.

use super::dof::BodyDof;
use super::method::Method;

/// How a body falls that its wheels cannot carry: a motion in which no wheel is pressed on its rail, and its weight and loads do
/// work.
#[derive(Clone, Debug, PartialEq)]
pub struct Fall {
    /// The body whose weight and loads do most of the work.
    pub body: usize,
    /// Its x, y, z, roll, yaw and pitch, each by the displacement of the contact that it moves most; the largest is 1 or -1.
    pub motion: [f64; 6],
}

/// Errors of the simulator.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A compliance could not be evaluated.
    #[error("structure {structure}: {source}")]
    Compliance {
        /// Which structure.
        structure: usize,
        /// Error of the compliance.
        source: splines::Error,
    },
    /// The mass or inertia of a free degree of freedom that is not positive.
    #[error("body {body}: degree of freedom {dof:?} is free but has no inertia")]
    NoInertia {
        /// Which body.
        body: usize,
        /// Which degree of freedom.
        dof: BodyDof,
    },
    /// A body, structure or rail index beyond the scene's.
    #[error("{what} {index} does not exist")]
    NoSuch {
        /// Kind of object.
        what: &'static str,
        /// The invalid index.
        index: usize,
    },
    /// A number that must be positive, or finite, is not.
    #[error("{what} must be {wanted}, got {found}")]
    Number {
        /// Name of the quantity.
        what: &'static str,
        /// Requirement that is not met.
        wanted: &'static str,
        /// Actual value.
        found: f64,
    },
    /// The wheels in contact cannot carry the bodies at rest, or, without a fall, the forces did not converge.
    #[error("no static equilibrium at t = {time}{}", .fall.as_ref().map_or(" was found", |_| ": the wheels on the rail cannot carry the weight"))]
    NoEquilibrium {
        /// Time of the attempt.
        time: f64,
        /// How a body falls, which proves that there is no equilibrium; `None` where none was found.
        fall: Option<Fall>,
    },
    /// A quasi-static sweep with a body whose position along the rail is not prescribed.
    #[error("body {body}: a quasi-static sweep needs its x prescribed")]
    NotPrescribed {
        /// Which body.
        body: usize,
    },
    /// A body that is pinned to itself through other bodies, or that has translations of its own in addition to its
    /// pin.
    #[error(
        "body {body}: a pinned body must have no translation of its own, and pins must not form a loop"
    )]
    Pinned {
        /// Which body.
        body: usize,
    },
    /// An unsupported arrangement of a body on a structure that another body carries: on several carriers, on rails
    /// of different directions, as the carrier of its own carrier, with a load, rope or stop, or on a structure with
    /// mass or parts of its own.
    #[error(
        "body {body}: this arrangement of bodies and structures on other bodies is not supported"
    )]
    Carried {
        /// Which body.
        body: usize,
    },
    /// A load, drive or brake on a degree of freedom that is fixed or prescribed.
    #[error("body {body}: degree of freedom {dof:?} is not free, so a load cannot act on it")]
    NotFree {
        /// Which body.
        body: usize,
        /// Which degree of freedom.
        dof: BodyDof,
    },
    /// A driven or braked wheel with a spin of its own.
    #[error("contact {contact}: a driven or braked wheel cannot have a spin of its own")]
    Spins {
        /// Which contact.
        contact: usize,
    },
    /// No contact forces exist at the given state.
    #[error(
        "no contact forces at t = {time}: the given penetrations are inconsistent with the state"
    )]
    NoForces {
        /// Time of the state.
        time: f64,
    },
    /// A method of integration that is not applicable to the scene.
    #[error("the stepper {method:?} needs {wanted}")]
    Method {
        /// Which method.
        method: Method,
        /// Requirement of the method that the scene does not meet.
        wanted: &'static str,
    },
}
