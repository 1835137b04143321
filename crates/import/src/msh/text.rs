//! A mesh file as lines of words.

use crate::findings::{Finding, Findings, Spot};

/// A line of words, with the column of each.
#[derive(Clone, Debug)]
pub struct Record<'t> {
    /// Its place.
    pub at: Spot,
    /// The whole line without blanks around it.
    pub line: &'t str,
    words: Vec<(usize, &'t str)>,
}

impl<'t> Record<'t> {
    fn new(text: &'t str, line: usize) -> Record<'t> {
        let trimmed = text.trim();
        let mut words = Vec::new();
        for word in trimmed.split_ascii_whitespace() {
            // where a word begins, counted in bytes from the beginning of the line
            let column = word.as_ptr() as usize - text.as_ptr() as usize;
            words.push((column + 1, word));
        }
        let column = words.first().map_or(1, |(column, _)| *column);
        Record { at: Spot { file: 0, line, column }, line: trimmed, words }
    }

    /// Number of words.
    #[must_use]
    pub fn len(&self) -> usize {
        self.words.len()
    }

    /// A word by index; where the line has too few, that is an error.
    fn word(&self, index: usize, what: &str, findings: &mut Findings) -> Option<(Spot, &'t str)> {
        let word = self.words.get(index).map(|&(column, word)| (Spot { column, ..self.at }, word));
        if word.is_none() {
            findings.error(
                Finding::new(self.at, what, "is missing in this line").got(format!("{} words", self.len())),
            );
        }
        word
    }

    /// A whole number.
    pub fn whole(&self, index: usize, what: &str, findings: &mut Findings) -> Option<u64> {
        let (at, word) = self.word(index, what, findings)?;
        let value = word.parse().ok();
        if value.is_none() {
            findings.error(Finding::new(at, what, "must be a whole number from 0").got(word));
        }
        value
    }

    /// A whole number without its sign: physical groups of reversed curves have one.
    pub fn tag(&self, index: usize, what: &str, findings: &mut Findings) -> Option<u64> {
        let (at, word) = self.word(index, what, findings)?;
        let value = word.parse().ok().map(i64::unsigned_abs);
        if value.is_none() {
            findings.error(Finding::new(at, what, "must be a whole number").got(word));
        }
        value
    }

    /// A finite number.
    pub fn real(&self, index: usize, what: &str, findings: &mut Findings) -> Option<f64> {
        let (at, word) = self.word(index, what, findings)?;
        let value = word.parse().ok().filter(|value: &f64| value.is_finite());
        if value.is_none() {
            findings.error(Finding::new(at, what, "must be a finite number").got(word));
        }
        value
    }
}

/// The lines of one section, between `$Name` and `$EndName`.
#[derive(Debug)]
pub struct Section<'t> {
    /// Its name.
    pub name: &'t str,
    /// Where it begins.
    pub at: Spot,
    lines: Vec<Record<'t>>,
    next: usize,
}

impl<'t> Section<'t> {
    /// The next line that is not blank; its lack is an error.
    pub fn next(&mut self, findings: &mut Findings) -> Option<Record<'t>> {
        let record = self.lines.get(self.next).cloned();
        self.next += 1;
        if record.is_none() {
            let finding = Finding::new(self.at, format!("${}", self.name), "ends too early");
            findings
                .error(finding.hint("the numbers of entries do not fit what follows; write the mesh again"));
        }
        record
    }
}

/// Cuts a text into its sections.
pub fn sections<'t>(text: &'t str, findings: &mut Findings) -> Vec<Section<'t>> {
    let mut sections: Vec<Section<'t>> = Vec::new();
    let mut open = false;
    for (index, line) in text.lines().enumerate() {
        let record = Record::new(line, index + 1);
        match record.line.strip_prefix('$') {
            Some(name) if !open => {
                if let Some(name) = name.strip_prefix("End") {
                    findings.error(Finding::new(
                        record.at,
                        format!("$End{name}"),
                        "must end a section that has begun",
                    ));
                    continue;
                }
                sections.push(Section { name, at: record.at, lines: Vec::new(), next: 0 });
                open = true;
            }
            Some(name) => {
                let Some(section) = sections.last() else { continue };
                open = false;
                if name.strip_prefix("End") != Some(section.name) {
                    let expected = format!("must be $End{}", section.name);
                    findings.error(Finding::new(record.at, "", expected).got(record.line));
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
                let finding = Finding::new(record.at, "", "must be within a section");
                findings.error(finding.hint("sections are between $Name and $EndName; is this a gmsh mesh?"));
                return sections;
            }
            None => {}
        }
    }
    if let Some(section) = sections.last().filter(|_| open) {
        let finding = Finding::new(section.at, format!("${}", section.name), "has no end");
        findings.error(finding.hint("the file is cut off; write the mesh again"));
    }
    sections
}
