//! Errors of studies and of the evaluation of tables.

use formats::scene::motion::UnequalFractions;
use formats::text::diagnostic::Diagnostic;
use thiserror::Error;

/// Why a study or an evaluation of tables has no result.
#[derive(Debug, Error)]
pub enum Error {
    /// A file of tables is invalid or cannot be read.
    #[error("{}", lines(.0))]
    Input(Vec<Diagnostic>),
    /// A truck of the scene cannot be simulated.
    #[error(transparent)]
    Truck(#[from] UnequalFractions),
    /// A foundation cannot be built.
    #[error(transparent)]
    Foundation(#[from] foundations::Error),
    /// A run has no results.
    #[error(transparent)]
    Results(#[from] results::Error),
    /// A table cannot be used, or a rail cannot be evaluated at its stations.
    #[error(transparent)]
    Tables(#[from] splines::Error),
    /// A structure has no exact surface from which tables could be evaluated.
    #[error("the exact surface is not known")]
    NoSurface,
    /// The simulator refuses a run.
    #[error("{0}")]
    Run(String),
    /// No reference could be run.
    #[error("no reference could be run: {0}")]
    NoReference(String),
    /// None of the references could be run; the reason of the first.
    #[error("{0}")]
    NoReferences(String),
}

fn lines(diagnostics: &[Diagnostic]) -> String {
    diagnostics
        .iter()
        .map(ToString::to_string)
        .collect::<Vec<_>>()
        .join("; ")
}

impl From<Diagnostic> for Error {
    fn from(diagnostic: Diagnostic) -> Error {
        Error::Input(vec![diagnostic])
    }
}

impl From<Box<Diagnostic>> for Error {
    fn from(diagnostic: Box<Diagnostic>) -> Error {
        Error::from(*diagnostic)
    }
}

impl From<Vec<Diagnostic>> for Error {
    fn from(diagnostics: Vec<Diagnostic>) -> Error {
        Error::Input(diagnostics)
    }
}
