//! Errors of the evaluation of a checked scene.

use formats::scene::motion::UnequalFractions;
use formats::spec::SolveError;
use formats::text::diagnostic::Diagnostic;
use thiserror::Error;

/// The reason why a scene has no results.
#[derive(Debug, Error)]
pub enum Error {
    /// The scene or one of its files is invalid: every fault with its place.
    #[error("{}", lines(.0))]
    Input(Vec<Diagnostic>),
    /// A structure or a scene has no trustworthy solution.
    #[error("{0}")]
    NoSolution(String),
    /// The run was stopped by its observer.
    #[error("the run was stopped")]
    Stopped,
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
        /// The reason, with names of the scene instead of indices.
        why: String,
        /// The keys under which the scene has what is at fault; none where that is not known.
        at: Vec<String>,
    },
    /// The influence lines of a structure cannot be computed.
    #[error("{structure}: {source}")]
    Lines {
        /// Name of the structure.
        structure: String,
        /// The error of the solver.
        source: fea::Error,
    },
    /// The girders of a structure cannot be evaluated.
    #[error("{structure}: {source}")]
    Girders {
        /// Name of the structure.
        structure: String,
        /// The error of the structural solver.
        source: trains::Error,
    },
    /// The cycles of a stress history cannot be counted.
    #[error("{column}: {source}")]
    Cycles {
        /// Name of the column.
        column: String,
        /// The error of the cycle count.
        source: practice::Error,
    },
    /// A result is not a number or infinite.
    #[error("{label}: {column} is not a finite number at t = {time} s")]
    NotFinite {
        /// Label of the case.
        label: String,
        /// Name of the column.
        column: String,
        /// Time of the first such value.
        time: f64,
    },
}

/// One line for each diagnostic.
fn lines(diagnostics: &[Diagnostic]) -> String {
    diagnostics
        .iter()
        .map(ToString::to_string)
        .collect::<Vec<_>>()
        .join("\n")
}

impl From<Vec<Diagnostic>> for Error {
    fn from(diagnostics: Vec<Diagnostic>) -> Self {
        Error::Input(diagnostics)
    }
}

impl From<SolveError> for Error {
    fn from(error: SolveError) -> Self {
        match error {
            SolveError::Input(diagnostics) => Error::Input(diagnostics),
            SolveError::NoSolution(why) => Error::NoSolution(why),
        }
    }
}
