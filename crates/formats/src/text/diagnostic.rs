//! A located error: where, what was expected, what was found, what to do.

use std::fmt;

use serde::Serialize;

/// One error of an input with its place in the file, as far as that is known.
///
/// ```
/// use formats::text::diagnostic::Diagnostic;
///
/// let missing = Diagnostic::of_file("scene.json", "cannot be read: no such file").hint("check the path");
/// assert_eq!(missing.to_string(), "scene.json: cannot be read: no such file  hint: check the path");
/// ```
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Diagnostic {
    /// The file, as the user named it (or as another input named it).
    pub file: String,
    /// Line, counted from 1; `None` where the file as a whole is meant.
    pub line: Option<usize>,
    /// Column in characters, counted from 1.
    pub column: Option<usize>,
    /// JSON path of the value, such as `girder.spans[1]`; empty for the file's root.
    pub path: String,
    /// What would be right, such as `must be positive`.
    pub expected: String,
    /// What was found instead.
    pub found: Option<String>,
    /// What the user can do about it.
    pub hint: Option<String>,
}

impl Diagnostic {
    /// An error about a file as a whole: missing, unreadable, not writable.
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

    /// The same with a hint.
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
