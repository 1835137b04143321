//! Why results are not written.

use std::fmt;

use formats::text::diagnostic::Diagnostic;

/// Why results are not written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// Files or folders cannot be written, or belong to somebody else.
    Files(Vec<Diagnostic>),
    /// A table, picture or page cannot be made of the results.
    NotShown(String),
    /// There are no results to write.
    NoResults(String),
}

impl Error {
    /// The error of results of which a file cannot be made.
    pub(crate) fn not_shown(error: impl fmt::Display) -> Error {
        Error::NotShown(format!("the results cannot be shown: {error}"))
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Files(diagnostics) => {
                let lines: Vec<String> = diagnostics.iter().map(ToString::to_string).collect();
                f.write_str(&lines.join("\n"))
            }
            Error::NotShown(why) | Error::NoResults(why) => f.write_str(why),
        }
    }
}

impl std::error::Error for Error {}

impl From<Diagnostic> for Error {
    fn from(diagnostic: Diagnostic) -> Self {
        Error::Files(vec![diagnostic])
    }
}

impl From<Vec<Diagnostic>> for Error {
    fn from(diagnostics: Vec<Diagnostic>) -> Self {
        Error::Files(diagnostics)
    }
}
