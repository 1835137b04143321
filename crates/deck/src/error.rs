//! Why a scene has no deck, or a deck cannot be compared with the simulator.

use formats::scene::motion::UnequalFractions;
use formats::text::diagnostic::Diagnostic;
use thiserror::Error;

/// Why there is no deck, or no comparison of one with the simulator.
#[derive(Debug, Error)]
pub enum Error {
    /// The scene has something that a deck does not support.
    #[error("{0}")]
    Refused(Box<Diagnostic>),
    /// A truck of the scene cannot be simulated.
    #[error(transparent)]
    Truck(#[from] UnequalFractions),
    /// A foundation cannot be made.
    #[error(transparent)]
    Foundation(#[from] foundations::Error),
    /// The tables of a structure cannot be used.
    #[error("{structure}: {source}")]
    Tables {
        /// Name of the structure.
        structure: String,
        /// What is wrong with them.
        source: splines::Error,
    },
    /// A table is no SPLINE.
    #[error("SPLINE/{id} of {name}: {fault}")]
    Spline {
        /// Number of the SPLINE.
        id: u32,
        /// What it belongs to.
        name: String,
        /// What is wrong with it.
        fault: adams::AdamsFault,
    },
    /// The text of a deck cannot be read or executed.
    #[error(transparent)]
    Language(#[from] adams::Error),
    /// The compliance of a rail cannot be evaluated where a wheel stands.
    #[error(transparent)]
    Compliance(#[from] splines::Error),
    /// The simulator refuses the first instant of the scene.
    #[error("the deck's first instant: {0}")]
    Start(sim::Error),
    /// The simulator refuses the quasi-static sweep of the scene.
    #[error("the quasi-static sweep: {0}")]
    Sweep(sim::Error),
    /// Too few states with contact forces were found to compare.
    #[error("found {found} of {count} states with contact forces{}", last.as_ref().map_or(String::new(), |error| format!(": {error}")))]
    States {
        /// States that were found.
        found: usize,
        /// States that were asked for.
        count: usize,
        /// What the simulator refused last.
        last: Option<sim::Error>,
    },
}

impl From<Diagnostic> for Error {
    fn from(diagnostic: Diagnostic) -> Error {
        Error::Refused(Box::new(diagnostic))
    }
}
