//! What a reader of models has to say: errors and warnings, by place in a file.

use formats::diagnostic::Diagnostic;

/// A place in one of the files of a model, all counted from 1; `file` is an index into their names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct FilePlace {
    /// Which file.
    pub file: usize,
    /// Line.
    pub line: usize,
    /// Column in characters.
    pub column: usize,
}

/// One thing to say about a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImportFinding {
    /// Where.
    pub at: FilePlace,
    /// What it is about, such as `CBAR 12: GA`; may be empty.
    pub about: String,
    /// What would have been right, or what has been done.
    pub expected: String,
    /// What stands there.
    pub found: Option<String>,
    /// What to do.
    pub hint: Option<String>,
}

impl ImportFinding {
    /// A finding at a place.
    #[must_use]
    pub fn new(at: FilePlace, about: impl Into<String>, expected: impl Into<String>) -> ImportFinding {
        ImportFinding { at, about: about.into(), expected: expected.into(), found: None, hint: None }
    }

    /// With what was found.
    #[must_use]
    pub fn got(mut self, found: impl ToString) -> ImportFinding {
        self.found = Some(found.to_string());
        self
    }

    /// With a hint.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> ImportFinding {
        self.hint = Some(hint.into());
        self
    }
}

/// Errors and warnings so far, and the names of the files that they are in.
#[derive(Clone, Debug, Default)]
pub struct ImportFindings {
    /// Names of the files read.
    pub files: Vec<String>,
    errors: Vec<ImportFinding>,
    warnings: Vec<ImportFinding>,
}

impl ImportFindings {
    /// Adds an error: the model will not be taken.
    pub fn error(&mut self, finding: ImportFinding) {
        self.errors.push(finding);
    }

    /// Adds a warning: the model is taken without this, or taken so.
    pub fn warn(&mut self, finding: ImportFinding) {
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

    fn placed(&self, findings: &[ImportFinding]) -> Vec<Diagnostic> {
        let mut sorted: Vec<&ImportFinding> = findings.iter().collect();
        sorted.sort_by_key(|finding| finding.at);
        let place = |finding: &&ImportFinding| Diagnostic {
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
