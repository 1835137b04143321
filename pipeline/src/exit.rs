//! How a command ends.

use std::process::ExitCode;

use formats::spec::SolveError;
use formats::tables::WriteError;
use formats::text::diagnostic::Diagnostic;

/// Exit status of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Done.
    Done,
    /// A comparison failed, or nothing could be compared.
    Differs,
    /// Usage, input or I/O.
    Input,
    /// The results cannot be trusted: mechanism, certified error above the tolerance, step too small.
    Untrusted,
}

impl Exit {
    /// The number the shell sees.
    #[must_use]
    pub const fn status(self) -> u8 {
        match self {
            Exit::Done => 0,
            Exit::Differs => 1,
            Exit::Input => 2,
            Exit::Untrusted => 3,
        }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> ExitCode {
        ExitCode::from(exit.status())
    }
}

/// Why a command gave no result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// Something is wrong with the input, or a file cannot be read or written.
    Input(Vec<Diagnostic>),
    /// Nothing could be compared, or a comparison failed.
    Differs(String),
    /// The numbers cannot be trusted.
    Untrusted(String),
}

impl Failure {
    /// The exit status it leads to.
    #[must_use]
    pub const fn exit(&self) -> Exit {
        match self {
            Failure::Input(_) => Exit::Input,
            Failure::Differs(_) => Exit::Differs,
            Failure::Untrusted(_) => Exit::Untrusted,
        }
    }

    /// Results that cannot be trusted, for the reason that a library returns.
    pub(crate) fn untrusted(error: impl std::fmt::Display) -> Failure {
        Failure::Untrusted(error.to_string())
    }

    /// What standard error shows: a line for each error, or one JSON object.
    #[must_use]
    pub fn report(&self, json: bool) -> String {
        if json {
            let errors = match self {
                Failure::Input(diagnostics) => serde_json::json!(diagnostics),
                Failure::Differs(message) | Failure::Untrusted(message) => {
                    serde_json::json!([{ "expected": message }])
                }
            };
            let object = serde_json::json!({ "status": self.exit().status(), "errors": errors });
            return format!("{object}\n");
        }
        match self {
            Failure::Input(diagnostics) => {
                let lines: Vec<String> =
                    diagnostics.iter().map(|diagnostic| format!("{diagnostic}\n")).collect();
                lines.concat()
            }
            Failure::Differs(message) | Failure::Untrusted(message) => format!("girderway: {message}\n"),
        }
    }
}

impl From<Diagnostic> for Failure {
    fn from(diagnostic: Diagnostic) -> Self {
        Failure::Input(vec![diagnostic])
    }
}

impl From<Box<Diagnostic>> for Failure {
    fn from(diagnostic: Box<Diagnostic>) -> Self {
        Failure::from(*diagnostic)
    }
}

impl From<Vec<Diagnostic>> for Failure {
    fn from(diagnostics: Vec<Diagnostic>) -> Self {
        Failure::Input(diagnostics)
    }
}

impl From<SolveError> for Failure {
    fn from(error: SolveError) -> Self {
        match error {
            SolveError::Input(diagnostics) => Failure::Input(diagnostics),
            SolveError::NoSolution(message) => Failure::Untrusted(message),
        }
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        Failure::untrusted(error)
    }
}

impl From<results::Error> for Failure {
    fn from(error: results::Error) -> Self {
        Failure::untrusted(error)
    }
}

impl From<foundations::Error> for Failure {
    fn from(error: foundations::Error) -> Self {
        Failure::untrusted(error)
    }
}

impl From<deck::Error> for Failure {
    fn from(error: deck::Error) -> Self {
        match error {
            deck::Error::Refused(diagnostic) => Failure::from(diagnostic),
            other => Failure::untrusted(other),
        }
    }
}

impl From<study::Error> for Failure {
    fn from(error: study::Error) -> Self {
        match error {
            study::Error::Input(diagnostics) => Failure::Input(diagnostics),
            other => Failure::untrusted(other),
        }
    }
}
