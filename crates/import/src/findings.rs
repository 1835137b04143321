//! What a reader of models has to say: errors and warnings, by place in a file.

use formats::diagnostic::Diagnostic;

/// A place in one of the files of a model, all counted from 1; `file` is an index into their names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Spot {
    /// Which file.
    pub file: usize,
    /// Line.
    pub line: usize,
    /// Column in characters.
    pub column: usize,
}

/// One thing to say about a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Where.
    pub at: Spot,
    /// What it is about, such as `CBAR 12: GA`; may be empty.
    pub about: String,
    /// What would have been right, or what has been done.
    pub expected: String,
    /// What stands there.
    pub found: Option<String>,
    /// What to do.
    pub hint: Option<String>,
}

impl Finding {
    /// A finding at a place.
    #[must_use]
    pub fn new(at: Spot, about: impl Into<String>, expected: impl Into<String>) -> Finding {
        Finding { at, about: about.into(), expected: expected.into(), found: None, hint: None }
    }

    /// With what was found.
    #[must_use]
    pub fn got(mut self, found: impl ToString) -> Finding {
        self.found = Some(found.to_string());
        self
    }

    /// With a hint.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Finding {
        self.hint = Some(hint.into());
        self
    }
}

/// Errors and warnings so far, and the names of the files that they are in.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    /// Names of the files read.
    pub files: Vec<String>,
    errors: Vec<Finding>,
    warnings: Vec<Finding>,
}

impl Findings {
    /// Adds an error: the model will not be taken.
    pub fn error(&mut self, finding: Finding) {
        self.errors.push(finding);
    }

    /// Adds a warning: the model is taken without this, or taken so.
    pub fn warn(&mut self, finding: Finding) {
        self.warnings.push(finding);
    }

    /// Whether anything forbids to take the model.
    #[must_use]
    pub fn wrong(&self) -> bool {
        !self.errors.is_empty()
    }

    /// The errors in the order of the files.
    #[must_use]
    pub fn errors(&self) -> Vec<Diagnostic> {
        self.placed(&self.errors)
    }

    /// The warnings in the order of the files.
    #[must_use]
    pub fn warnings(&self) -> Vec<Diagnostic> {
        self.placed(&self.warnings)
    }

    fn placed(&self, findings: &[Finding]) -> Vec<Diagnostic> {
        let mut sorted: Vec<&Finding> = findings.iter().collect();
        sorted.sort_by_key(|finding| finding.at);
        let place = |finding: &&Finding| Diagnostic {
            file: self.files.get(finding.at.file).cloned().unwrap_or_default(),
            line: (finding.at.line > 0).then_some(finding.at.line),
            column: (finding.at.line > 0).then_some(finding.at.column),
            path: finding.about.clone(),
            expected: finding.expected.clone(),
            found: finding.found.clone(),
            hint: finding.hint.clone(),
        };
        let mut placed: Vec<Diagnostic> = sorted.iter().map(place).collect();
        placed.dedup();
        placed
    }
}
