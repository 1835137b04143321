//! An error with its place: what was expected, what was found, and what the user can do.

use std::fmt;

use serde::Serialize;

/// One error of an input with its place in the file, if known.
///
/// ```
/// use formats::text::diagnostic::Diagnostic;
///
/// let missing = Diagnostic::of_file("scene.json", "cannot be read: no such file").hint("check the path");
/// assert_eq!(missing.to_string(), "scene.json: cannot be read: no such file  hint: check the path");
/// ```
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Diagnostic {
    /// The file, as named by the user or by another input file.
    pub file: String,
    /// Line, counted from 1; `None` if the error concerns the whole file.
    pub line: Option<usize>,
    /// Column in characters, counted from 1.
    pub column: Option<usize>,
    /// JSON path of the value, such as `girder.spans[1]`; empty for the file's root.
    pub path: String,
    /// The requirement, such as `must be positive`.
    pub expected: String,
    /// The value that was found.
    pub found: Option<String>,
    /// What the user can do about it.
    pub hint: Option<String>,
}

impl Diagnostic {
    /// An error that concerns a whole file: it is missing, cannot be read or cannot be written.
    #[must_use]
    pub fn of_file(file: impl Into<String>, expected: impl Into<String>) -> Self {
        Diagnostic {
            file: file.into(),
            line: None,
            column: None,
            path: String::new(),
            expected: expected.into(),
            found: None,
            hint: None,
        }
    }

    /// Adds a hint.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file)?;
        if let (Some(line), Some(column)) = (self.line, self.column) {
            write!(f, ":{line}:{column}")?;
        }
        write!(f, ": ")?;
        if !self.path.is_empty() {
            write!(f, "{}: ", self.path)?;
        }
        write!(f, "{}", self.expected)?;
        if let Some(found) = &self.found {
            write!(f, ", got {found}")?;
        }
        if let Some(hint) = &self.hint {
            write!(f, "  hint: {hint}")?;
        }
        Ok(())
    }
}
