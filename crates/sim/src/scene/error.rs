//! What can go wrong in a scene: ids and numbers; the caller knows the names.

use super::dof::BodyDof;
use super::method::Method;

/// Errors of the simulator.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A structure refused a probe.
    #[error("structure {structure}: {source}")]
    Compliance {
        /// Which structure.
        structure: usize,
        /// What it said.
        source: splines::Error,
    },
    /// The mass or inertia of a free degree of freedom that is not positive.
    #[error("body {body}: freedom {dof:?} is free but nothing has inertia there")]
    NoInertia {
        /// Which body.
        body: usize,
        /// Which degree of freedom.
        dof: BodyDof,
    },
    /// A body, structure or rail index beyond the scene's.
    #[error("{what} {index} does not exist")]
    NoSuch {
        /// What was looked for.
        what: &'static str,
        /// The index.
        index: usize,
    },
    /// A number that must be positive, or finite, is not.
    #[error("{what} must be {wanted}, got {found}")]
    Number {
        /// What it is.
        what: &'static str,
        /// What it must be.
        wanted: &'static str,
        /// What it is instead.
        found: f64,
    },
    /// The wheels in contact cannot carry the bodies at rest.
    #[error("no static equilibrium at t = {time}: the wheels on the rail cannot carry the weight")]
    NoEquilibrium {
        /// Time of the attempt.
        time: f64,
    },
    /// A quasi-static sweep of a body whose place along the rail is not prescribed.
    #[error("body {body}: a quasi-static sweep needs its x prescribed")]
    NotPrescribed {
        /// Which body.
        body: usize,
    },
    /// A body that is pinned to itself by way of others, or moves by translations of its own beside its pin.
    #[error("body {body}: a pinned body has no translation of its own, and pins do not run in a circle")]
    Pinned {
        /// Which body.
        body: usize,
    },
    /// A body on a structure that rides on a body, in an unknown arrangement: on several carriers or on rails of
    /// different directions, itself a carrier of its carrier, loaded, held by a rope or stop, or on a structure with
    /// mass or parts of its own.
    #[error("body {body}: not a way to ride on another body, or to carry a structure")]
    Carried {
        /// Which body.
        body: usize,
    },
    /// A load, drive or brake on a degree of freedom that is fixed or prescribed.
    #[error("body {body}: freedom {dof:?} is not free, nothing can push it")]
    NotFree {
        /// Which body.
        body: usize,
        /// Which degree of freedom.
        dof: BodyDof,
    },
    /// A driven or braked wheel that spins by itself.
    #[error("contact {contact}: a driven or braked wheel cannot have a spin of its own")]
    Spins {
        /// Which contact.
        contact: usize,
    },
    /// Contact forces that do not exist at a given state.
    #[error("no contact forces at t = {time}: the penetrations given do not belong to the state")]
    NoForces {
        /// Time of the state.
        time: f64,
    },
    /// A method of integration that the scene does not allow.
    #[error("method {method:?} needs {wanted}")]
    Method {
        /// Which method.
        method: Method,
        /// What is missing in the scene.
        wanted: &'static str,
    },
}
