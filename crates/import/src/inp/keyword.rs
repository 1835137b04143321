//! Division of an Abaqus input file into keywords with parameters and data lines.
//!
//! A line that begins with `*` is a keyword with parameters, one that begins with `**` is a comment, and every other
//! line belongs to the data of the keyword before it. A keyword line that ends with a comma goes on in the next line.
//! Keywords and parameters do not depend on case; blanks in them have no meaning. `*INCLUDE` is replaced by the
//! contents of the file that it names.

use std::io;
use std::path::Path;

use crate::findings::{FilePlace, ImportFinding, ImportFindings};
use crate::includes::{Includes, OpenFile};

/// A value with its position.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InpField {
    /// Position at which it begins.
    pub at: FilePlace,
    /// Its text without blanks around it and without quotation marks.
    pub text: String,
}

/// A parameter of a keyword, such as `NSET=feet` or `GENERATE`.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name in capital letters without blanks.
    pub name: String,
    /// Its value; empty if it has none.
    pub value: InpField,
}

/// A keyword with its data lines.
#[derive(Clone, Debug, PartialEq)]
pub struct KeywordBlock {
    /// Its name in capital letters, with one blank between its words, without the asterisk.
    pub name: String,
    /// Position at which it begins.
    pub at: FilePlace,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
    /// Its data lines, divided at commas. An empty last field is left out.
    pub data: Vec<Vec<InpField>>,
}

impl KeywordBlock {
    /// The value of a parameter; `None` if the keyword does not have it.
    #[must_use]
    pub fn parameter(&self, name: &str) -> Option<&InpField> {
        self.parameters
            .iter()
            .find(|parameter| parameter.name == name)
            .map(|parameter| &parameter.value)
    }

    /// The keyword as messages name it, such as `*BEAM SECTION`.
    #[must_use]
    pub fn label(&self) -> String {
        format!("*{}", self.name)
    }

    /// The value of a required parameter; adds an error if it is missing.
    pub fn required(&self, name: &str, findings: &mut ImportFindings) -> Option<&InpField> {
        let found = self.parameter(name).filter(|value| !value.text.is_empty());
        if found.is_none() {
            let finding = ImportFinding::new(
                self.at,
                self.label(),
                format!("requires the parameter {name}"),
            );
            findings.error(finding);
        }
        found
    }
}

/// Reads a file and those that it includes.
///
/// # Errors
/// The file itself cannot be read. Errors of included files are added to the findings.
pub fn read(
    path: &Path,
    open: OpenFile<'_>,
    findings: &mut ImportFindings,
) -> io::Result<Vec<KeywordBlock>> {
    let bytes = open(path)?;
    let includes = Includes::new(path, open, "*INCLUDE");
    let mut reader = Reader {
        includes,
        blocks: Vec::new(),
        pending: None,
    };
    reader.file(path, &bytes, findings);
    Ok(reader.blocks)
}

struct Reader<'a> {
    includes: Includes<'a>,
    blocks: Vec<KeywordBlock>,
    /// The beginning of a keyword whose line ends with a comma.
    pending: Option<(FilePlace, Vec<InpField>)>,
}

impl Reader<'_> {
    fn file(&mut self, path: &Path, bytes: &[u8], findings: &mut ImportFindings) {
        let file = self.includes.begin(path, findings);
        // comments may have any encoding; a replaced byte in a value causes an error when the value is read
        let text = String::from_utf8_lossy(bytes);
        for (index, line) in text.lines().enumerate() {
            let at = FilePlace {
                file,
                line: index + 1,
                column: 1,
            };
            let trimmed = line.trim();
            if trimmed.is_empty() || trimmed.starts_with("**") {
                continue;
            }
            let fields = divided(line, at);
            let goes_on = trimmed.ends_with(',');
            if let Some((at, mut before)) = self.pending.take() {
                before.extend(fields);
                self.keyword(at, before, goes_on, findings);
            } else if trimmed.starts_with('*') {
                let at = fields.first().map_or(at, |field| field.at);
                self.keyword(at, fields, goes_on, findings);
            } else if let Some(block) = self.blocks.last_mut() {
                block.data.push(fields);
            } else {
                let finding = ImportFinding::new(
                    at,
                    "",
                    "must be preceded by a keyword line, which begins with *",
                );
                findings.error(finding.hint("check that the file is an Abaqus input file"));
                break;
            }
        }
        if let Some((at, before)) = self.pending.take() {
            self.keyword(at, before, false, findings);
        }
        self.includes.end();
    }

    fn keyword(
        &mut self,
        at: FilePlace,
        fields: Vec<InpField>,
        goes_on: bool,
        findings: &mut ImportFindings,
    ) {
        if goes_on {
            self.pending = Some((at, fields));
            return;
        }
        let mut fields = fields.into_iter();
        let head = fields.next().unwrap_or_default().text;
        let words: Vec<&str> = head.trim_start_matches('*').split_whitespace().collect();
        let mut block = KeywordBlock {
            name: words.join(" ").to_uppercase(),
            at,
            parameters: Vec::new(),
            data: Vec::new(),
        };
        for field in fields.filter(|field| !field.text.is_empty()) {
            let (name, value) = field.text.split_once('=').unwrap_or((&field.text, ""));
            let name: String = name.split_whitespace().collect();
            let value = InpField {
                at: field.at,
                text: value.trim().trim_matches('"').to_owned(),
            };
            block.parameters.push(Parameter {
                name: name.to_uppercase(),
                value,
            });
        }
        if block.name == "INCLUDE" {
            self.include(&block, findings);
        } else {
            self.blocks.push(block);
        }
    }

    fn include(&mut self, block: &KeywordBlock, findings: &mut ImportFindings) {
        let Some(name) = block.required("INPUT", findings) else {
            return;
        };
        if let Some((path, bytes)) = self.includes.open(&name.text, name.at, findings) {
            self.file(&path, &bytes, findings);
        }
    }
}

/// Divides a line at its commas; an empty last field is left out. Commas between quotation marks do not divide.
fn divided(line: &str, at: FilePlace) -> Vec<InpField> {
    let mut fields = Vec::new();
    let mut quoted = false;
    let parts = line.split(|c: char| {
        quoted ^= c == '"';
        c == ',' && !quoted
    });
    let mut column = 1;
    for part in parts {
        let blanks = part.chars().take_while(|c| c.is_whitespace()).count();
        let text = part.trim().to_owned();
        fields.push(InpField {
            at: FilePlace {
                column: column + blanks,
                ..at
            },
            text,
        });
        column += part.chars().count() + 1;
    }
    while fields.len() > 1 && fields.last().is_some_and(|field| field.text.is_empty()) {
        fields.pop();
    }
    fields
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keywords_go_on_after_a_comma_and_do_not_depend_on_case() {
        let text = "** a comment\n*Beam  Section, elset = \"a, b\",\n  Section=RECT,material=steel\n0.1, 0.2,\n0, 0, -1\n";
        let mut findings = ImportFindings::default();
        let open = |_: &Path| Ok(text.as_bytes().to_vec());
        let blocks = read(Path::new("a.inp"), &open, &mut findings).expect("a file");
        assert!(!findings.has_errors());
        let [block] = blocks.as_slice() else {
            panic!("{blocks:?}")
        };
        assert_eq!(block.label(), "*BEAM SECTION");
        assert_eq!(
            block.parameter("ELSET").map(|value| value.text.as_str()),
            Some("a, b")
        );
        assert_eq!(
            block.parameter("SECTION").map(|value| value.at.line),
            Some(3)
        );
        let data: Vec<Vec<&str>> = block
            .data
            .iter()
            .map(|line| line.iter().map(|field| field.text.as_str()).collect())
            .collect();
        assert_eq!(data, [vec!["0.1", "0.2"], vec!["0", "0", "-1"]]);
        assert_eq!(
            block.data[0][1].at,
            FilePlace {
                file: 0,
                line: 4,
                column: 6
            }
        );
    }
}
