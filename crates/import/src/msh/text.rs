//! Division of a mesh file into sections, lines and words.

use formats::limits::MAGNITUDES;
use formats::text::fault::number;

use crate::findings::{FilePlace, ImportFinding, ImportFindings};

/// Largest magnitude of a coordinate. In every unit of length it is within the limits of a beam spec.
pub(super) const LARGEST: f64 = MAGNITUDES[1] / 1e4;

/// A line divided into words, with the column of each word.
#[derive(Clone, Debug)]
pub struct MeshRecord<'t> {
    /// Its position.
    pub at: FilePlace,
    /// The whole line, trimmed.
    pub line: &'t str,
    words: Vec<(usize, &'t str)>,
}

impl<'t> MeshRecord<'t> {
    fn new(text: &'t str, line: usize) -> MeshRecord<'t> {
        let trimmed = text.trim();
        let mut words = Vec::new();
        for word in trimmed.split_ascii_whitespace() {
            // offset of the word in bytes from the start of the line
            let column = word.as_ptr() as usize - text.as_ptr() as usize;
            words.push((column + 1, word));
        }
        let column = words.first().map_or(1, |(column, _)| *column);
        MeshRecord {
            at: FilePlace {
                file: 0,
                line,
                column,
            },
            line: trimmed,
            words,
        }
    }

    /// Number of words.
    #[must_use]
    pub fn len(&self) -> usize {
        self.words.len()
    }

    /// Returns a word by index; adds an error if the line has fewer words.
    fn word(
        &self,
        index: usize,
        what: &str,
        findings: &mut ImportFindings,
    ) -> Option<(FilePlace, &'t str)> {
        let word = self
            .words
            .get(index)
            .map(|&(column, word)| (FilePlace { column, ..self.at }, word));
        if word.is_none() {
            findings.error(
                ImportFinding::new(self.at, what, "is missing on this line")
                    .with_found(format!("{} words", self.len())),
            );
        }
        word
    }

    /// Reads a non-negative integer.
    pub fn whole(&self, index: usize, what: &str, findings: &mut ImportFindings) -> Option<u64> {
        let (at, word) = self.word(index, what, findings)?;
        let value = word.parse().ok();
        if value.is_none() {
            findings.error(
                ImportFinding::new(at, what, "must be a whole number from 0").with_found(word),
            );
        }
        value
    }

    /// Reads the magnitude of an integer: the number of a physical group is negative for a reversed curve.
    pub fn tag(&self, index: usize, what: &str, findings: &mut ImportFindings) -> Option<u64> {
        let (at, word) = self.word(index, what, findings)?;
        let value = word.parse().ok().map(i64::unsigned_abs);
        if value.is_none() {
            findings.error(ImportFinding::new(at, what, "must be a whole number").with_found(word));
        }
        value
    }

    /// Reads a coordinate.
    pub fn coordinate(
        &self,
        index: usize,
        what: &str,
        findings: &mut ImportFindings,
    ) -> Option<f64> {
        let (at, word) = self.word(index, what, findings)?;
        let value = word.parse().ok().filter(|value: &f64| value.is_finite());
        match value {
            None => findings
                .error(ImportFinding::new(at, what, "must be a finite number").with_found(word)),
            Some(value) if value.abs() > LARGEST => {
                let expected = format!("must be at most {} in magnitude", number(LARGEST));
                findings.error(ImportFinding::new(at, what, expected).with_found(word));
                return None;
            }
            _ => {}
        }
        value
    }
}

/// The lines of one section, between `$Name` and `$EndName`.
#[derive(Debug)]
pub struct MeshBlock<'t> {
    /// Its name.
    pub name: &'t str,
    /// Position at which it begins.
    pub at: FilePlace,
    lines: Vec<MeshRecord<'t>>,
    next: usize,
}

impl<'t> MeshBlock<'t> {
    /// Returns the next line that is not blank; adds an error if there is none.
    pub fn next(&mut self, findings: &mut ImportFindings) -> Option<MeshRecord<'t>> {
        let record = self.lines.get(self.next).cloned();
        self.next += 1;
        if record.is_none() {
            let finding = ImportFinding::new(self.at, format!("${}", self.name), "ends too early");
            findings.error(
                finding.hint("the section has fewer entries than stated; save the mesh again"),
            );
        }
        record
    }
}

/// Divides the text of a mesh file into its sections, and adds an error for each section without a matching end.
pub fn sections<'t>(text: &'t str, findings: &mut ImportFindings) -> Vec<MeshBlock<'t>> {
    let mut sections: Vec<MeshBlock<'t>> = Vec::new();
    let mut open = false;
    for (index, line) in text.lines().enumerate() {
        let record = MeshRecord::new(line, index + 1);
        match record.line.strip_prefix('$') {
            Some(name) if !open => {
                if let Some(name) = name.strip_prefix("End") {
                    findings.error(ImportFinding::new(
                        record.at,
                        format!("$End{name}"),
                        "has no matching beginning",
                    ));
                    continue;
                }
                sections.push(MeshBlock {
                    name,
                    at: record.at,
                    lines: Vec::new(),
                    next: 0,
                });
                open = true;
            }
            Some(name) => {
                let Some(section) = sections.last() else {
                    continue;
                };
                open = false;
                if name.strip_prefix("End") != Some(section.name) {
                    let expected = format!("must be $End{}", section.name);
                    findings
                        .error(ImportFinding::new(record.at, "", expected).with_found(record.line));
                    return sections;
                }
            }
            None if open => {
                if let Some(section) = sections.last_mut()
                    && record.len() > 0
                {
                    section.lines.push(record);
                }
            }
            None if record.len() > 0 => {
                let finding = ImportFinding::new(record.at, "", "must be within a section");
                findings.error(finding.hint(
                    "sections are between $Name and $EndName; check that the file is a gmsh mesh",
                ));
                return sections;
            }
            None => {}
        }
    }
    if let Some(section) = sections.last().filter(|_| open) {
        let finding = ImportFinding::new(section.at, format!("${}", section.name), "has no end");
        findings.error(finding.hint("the file is incomplete; save the mesh again"));
    }
    sections
}
