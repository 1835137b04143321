//! Errors of the libraries as exceptions of the package.

use formats::spec::SolveError;
use formats::text::diagnostic::Diagnostic;
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::source::is_in_memory;

/// Why a call has no result.
#[derive(Debug)]
pub(crate) enum Refusal {
    /// Faults of an input, or a file that cannot be read or written.
    Input(Vec<Diagnostic>),
    /// Numbers that cannot be trusted.
    Untrusted(String),
    /// The caller has stopped the call.
    Stopped,
}

impl Refusal {
    /// The exception of the package.
    pub(crate) fn exception(self, py: Python<'_>) -> PyErr {
        let made = match self {
            Refusal::Input(diagnostics) => input_error(py, &diagnostics),
            Refusal::Untrusted(why) => untrusted_error(py, &why),
            Refusal::Stopped => return PyKeyboardInterrupt::new_err("the run was stopped"),
        };
        made.unwrap_or_else(|error| error)
    }

    /// The refusal of one argument of a call.
    pub(crate) fn argument(
        name: &str,
        expected: impl Into<String>,
        found: Option<String>,
    ) -> Refusal {
        let mut fault = Diagnostic::of_file("argument", expected);
        name.clone_into(&mut fault.path);
        fault.found = found;
        Refusal::Input(vec![fault])
    }
}

fn input_error(py: Python<'_>, diagnostics: &[Diagnostic]) -> PyResult<PyErr> {
    let mut all = Vec::new();
    for diagnostic in diagnostics {
        let dict = PyDict::new(py);
        // the text of a dictionary has lines of its own, which tell the caller nothing
        let has_lines = !is_in_memory(&diagnostic.file);
        dict.set_item("file", &diagnostic.file)?;
        dict.set_item("line", diagnostic.line.filter(|_| has_lines))?;
        dict.set_item("column", diagnostic.column.filter(|_| has_lines))?;
        dict.set_item("path", &diagnostic.path)?;
        dict.set_item("expected", &diagnostic.expected)?;
        dict.set_item("found", &diagnostic.found)?;
        dict.set_item("hint", &diagnostic.hint)?;
        all.push(dict);
    }
    let class = py.import("girderway._errors")?.getattr("InputError")?;
    Ok(PyErr::from_value(class.call1((all,))?))
}

/// The exception of numbers that cannot be trusted.
pub(crate) fn untrusted_error(py: Python<'_>, why: &str) -> PyResult<PyErr> {
    let class = py.import("girderway._errors")?.getattr("UntrustedError")?;
    Ok(PyErr::from_value(class.call1((why,))?))
}

impl From<Vec<Diagnostic>> for Refusal {
    fn from(diagnostics: Vec<Diagnostic>) -> Self {
        Refusal::Input(diagnostics)
    }
}

impl From<Box<Diagnostic>> for Refusal {
    fn from(diagnostic: Box<Diagnostic>) -> Self {
        Refusal::Input(vec![*diagnostic])
    }
}

impl From<SolveError> for Refusal {
    fn from(error: SolveError) -> Self {
        match error {
            SolveError::Input(diagnostics) => Refusal::Input(diagnostics),
            SolveError::NoSolution(why) => Refusal::Untrusted(why),
        }
    }
}

impl From<results::Error> for Refusal {
    fn from(error: results::Error) -> Self {
        match error {
            results::Error::Input(diagnostics) => Refusal::Input(diagnostics),
            results::Error::Stopped => Refusal::Stopped,
            other => Refusal::Untrusted(other.to_string()),
        }
    }
}

impl From<outputs::Error> for Refusal {
    fn from(error: outputs::Error) -> Self {
        match error {
            outputs::Error::Files(diagnostics) => Refusal::Input(diagnostics),
            outputs::Error::NotShown(why) | outputs::Error::NoResults(why) => {
                Refusal::Untrusted(why)
            }
        }
    }
}

/// The exception of something that cannot happen.
pub(crate) fn internal(error: impl std::fmt::Display) -> PyErr {
    let version = env!("CARGO_PKG_VERSION");
    PyRuntimeError::new_err(format!(
        "internal error in version {version}: please report it: {error}"
    ))
}
