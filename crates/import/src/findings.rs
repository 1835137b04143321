//! Errors and warnings of the import, with their positions in files.

use std::collections::BTreeMap;

use formats::text::diagnostic::Diagnostic;

/// A position in one of the files of a model; `line` and `column` count from 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct FilePlace {
    /// Index of the file among [`ImportFindings::files`].
    pub file: usize,
    /// Line; 0 if the finding concerns the whole file.
    pub line: usize,
    /// Column in characters.
    pub column: usize,
}

/// An error or a warning at a position of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImportFinding {
    /// Its position.
    pub at: FilePlace,
    /// The card or field that it concerns, such as `CBAR 12: GA`; may be empty.
    pub about: String,
    /// The requirement that is not met, or the action of the reader.
    pub expected: String,
    /// The text or value in the file.
    pub found: Option<String>,
    /// Suggested correction.
    pub hint: Option<String>,
}

impl ImportFinding {
    /// Creates a finding at a position.
    #[must_use]
    pub fn new(
        at: FilePlace,
        about: impl Into<String>,
        expected: impl Into<String>,
    ) -> ImportFinding {
        ImportFinding {
            at,
            about: about.into(),
            expected: expected.into(),
            found: None,
            hint: None,
        }
    }

    /// Returns the finding with the text or value in the file.
    #[must_use]
    pub fn with_found(mut self, found: impl ToString) -> ImportFinding {
        self.found = Some(found.to_string());
        self
    }

    /// Returns the finding with a hint.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> ImportFinding {
        self.hint = Some(hint.into());
        self
    }
}

/// Collected errors and warnings, and the names of the files that were read.
#[derive(Clone, Debug, Default)]
pub struct ImportFindings {
    /// Names of the files read.
    pub files: Vec<String>,
    errors: Vec<ImportFinding>,
    warnings: Vec<ImportFinding>,
}

impl ImportFindings {
    /// Adds an error; a model with errors is rejected.
    pub fn error(&mut self, finding: ImportFinding) {
        self.errors.push(finding);
    }

    /// Adds a warning; the model is imported without the part concerned, or with a change.
    pub fn warn(&mut self, finding: ImportFinding) {
        self.warnings.push(finding);
    }

    /// Whether there is any error.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        !self.errors.is_empty()
    }

    /// The errors in the order of their positions. Three or more of one kind, such as the same missing field of many
    /// cards, become one error at the first of them, with their number.
    #[must_use]
    pub fn errors(&self) -> Vec<Diagnostic> {
        let mut index: BTreeMap<(String, &str, &Option<String>), usize> = BTreeMap::new();
        let mut groups: Vec<Vec<&ImportFinding>> = Vec::new();
        for finding in &self.errors {
            let kind = kind_of(&finding.about);
            let key = (kind, finding.expected.as_str(), &finding.hint);
            let group = *index.entry(key).or_insert_with(|| {
                groups.push(Vec::new());
                groups.len() - 1
            });
            groups[group].push(finding);
        }
        let mut errors = Vec::new();
        for mut group in groups {
            group.sort_by_key(|finding| finding.at);
            match group.as_slice() {
                [first, .., last] if group.len() >= GROUP => {
                    let count = group.len();
                    let line = last.at.line;
                    let expected = format!(
                        "{} ({count} errors of this kind, the last in line {line})",
                        first.expected
                    );
                    errors.push(ImportFinding {
                        expected,
                        ..(*first).clone()
                    });
                }
                _ => errors.extend(group.into_iter().cloned()),
            }
        }
        self.placed(&errors)
    }

    /// The warnings in the order of their positions.
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
            excerpt: None,
        };
        let mut placed: Vec<Diagnostic> = sorted.iter().map(place).collect();
        placed.dedup();
        placed
    }
}

/// The error of a file without members. `others` is the number of its elements of each other type.
#[must_use]
pub fn no_members(others: &BTreeMap<String, usize>) -> String {
    let counted = others
        .iter()
        .map(|(name, number)| format!("{name} ({number})"));
    let counted: Vec<String> = counted.collect();
    if counted.is_empty() {
        "contains no members".to_owned()
    } else {
        format!(
            "contains no members; its elements are {}",
            counted.join(", ")
        )
    }
}

/// Least number of errors of one kind that are reported as one.
const GROUP: usize = 3;

/// What a finding concerns, without the numbers that distinguish cards: `CBAR 12: GA` gives `CBAR: GA`.
fn kind_of(about: &str) -> String {
    let words = about.split(' ').map(|word| {
        let number = word.strip_suffix(':').unwrap_or(word);
        let is_number = !number.is_empty() && number.bytes().all(|digit| digit.is_ascii_digit());
        match (is_number, word.ends_with(':')) {
            (true, true) => ":",
            (true, false) => "",
            (false, _) => word,
        }
    });
    let kept: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    kept.join(" ").replace(" :", ":")
}
