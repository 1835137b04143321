//! Errors of writing the deck of a scene and of comparing it with the simulator.

use formats::scene::motion::UnequalFractions;
use formats::text::diagnostic::Diagnostic;
use thiserror::Error;

/// The reason why a deck cannot be written, or cannot be compared with the simulator.
#[derive(Debug, Error)]
pub enum Error {
    /// The scene has an item that decks do not support.
    #[error("{0}")]
    Refused(Box<Diagnostic>),
    /// A truck of the scene cannot be simulated.
    #[error(transparent)]
    Truck(#[from] UnequalFractions),
    /// A foundation cannot be built.
    #[error(transparent)]
    Foundation(#[from] foundations::Error),
    /// The tables of a structure cannot be used.
    #[error("{structure}: {source}")]
    Tables {
        /// Name of the structure.
        structure: String,
        /// The error in them.
        source: splines::Error,
    },
    /// A table does not form a valid SPLINE.
    #[error("SPLINE/{id} of {name}: {fault}")]
    Spline {
        /// Number of the SPLINE.
        id: u32,
        /// Name of the quantity in the table.
        name: String,
        /// The fault in the table.
        fault: adams::AdamsFault,
    },
    /// The text of a deck cannot be read or executed.
    #[error(transparent)]
    Language(#[from] adams::Error),
    /// The compliance of a rail cannot be evaluated where a wheel stands.
    #[error(transparent)]
    Compliance(#[from] splines::Error),
    /// The simulator cannot evaluate the first instant of the scene.
    #[error("the deck's first instant: {0}")]
    Start(sim::Error),
    /// The simulator cannot run the quasi-static sweep of the scene.
    #[error("the quasi-static sweep: {0}")]
    Sweep(sim::Error),
    /// Too few states with contact forces were found to compare.
    #[error("found {found} of {count} states with contact forces{}", cause(last.as_ref()))]
    States {
        /// Number of states that were found.
        found: usize,
        /// Number of requested states.
        count: usize,
        /// The last error of the simulator.
        last: Option<sim::Error>,
    },
}

/// The last error of the simulator as the end of a message.
fn cause(last: Option<&sim::Error>) -> String {
    last.map_or(String::new(), |error| format!(": {error}"))
}

impl From<Diagnostic> for Error {
    fn from(diagnostic: Diagnostic) -> Error {
        Error::Refused(Box::new(diagnostic))
    }
}
