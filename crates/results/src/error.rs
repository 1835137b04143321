//! Why a checked scene has no results.

use formats::scene::motion::UnequalFractions;
use thiserror::Error;

/// Why a scene has no results.
#[derive(Debug, Error)]
pub enum Error {
    /// A foundation cannot be built.
    #[error(transparent)]
    Foundation(#[from] foundations::Error),
    /// A truck of the scene cannot be simulated.
    #[error(transparent)]
    Truck(#[from] UnequalFractions),
    /// The run of a case cannot start.
    #[error("{label}: {why}")]
    Run {
        /// Label of the case.
        label: String,
        /// The reason, with names of the scene in place of indices.
        why: String,
    },
    /// The influence lines of a structure cannot be found.
    #[error("{structure}: {source}")]
    Lines {
        /// Name of the structure.
        structure: String,
        /// What the solver refuses.
        source: fea::Error,
    },
    /// The deflections of a structure cannot be evaluated.
    #[error("{structure}: {source}")]
    Rails {
        /// Name of the structure.
        structure: String,
        /// What its surface refuses.
        source: splines::Error,
    },
    /// A history has no envelope.
    #[error(transparent)]
    Envelope(practice::Error),
    /// The cycles of a stress history cannot be counted.
    #[error("{column}: {source}")]
    Cycles {
        /// Name of the column.
        column: String,
        /// What the count refuses.
        source: practice::Error,
    },
}
