//! What can go wrong with the book.

use std::fmt::Display;
use std::path::{Path, PathBuf};

/// Why the book could not be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Error {
    /// A file that cannot be read, or holds something else.
    #[error("{0}: {1}")]
    File(PathBuf, String),
    /// A part that nothing is known of.
    #[error("{0}: no part is called \"{1}\"")]
    Part(PathBuf, String),
    /// A part without an end.
    #[error("{0}: \"{1}\" has no end")]
    Open(PathBuf, String),
    /// Points of a map are refused, and the book does not say why.
    #[error("points of the map \"{0}\" are refused, and crates/claims/src/maps.rs has no reason")]
    Reason(String),
    /// Cargo, a test or a benchmark failed.
    #[error("{0}")]
    Run(String),
}

impl Error {
    /// A file with what is wrong with it.
    pub fn file(path: &Path, error: &impl Display) -> Error {
        Error::File(path.to_owned(), error.to_string())
    }
}
