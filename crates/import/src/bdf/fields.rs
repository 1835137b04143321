//! Fields of a card by number, read as values of the type that they must have.

use super::card::{Card, CardField};
use super::field::{Number, freedoms, number};
use crate::findings::{FilePlace, ImportFinding, ImportFindings};
use formats::text::fault::number as written;

/// Reads the fields of one card; field 1 is the first after the name.
#[derive(Debug)]
pub struct CardFields<'c, 'f> {
    /// The card.
    pub card: &'c Card,
    /// Errors and warnings are added here.
    pub findings: &'f mut ImportFindings,
}

static BLANK: CardField = CardField { at: FilePlace { file: 0, line: 0, column: 0 }, text: String::new() };

/// A text with everything that is not ASCII as `\u{...}`.
fn ascii(text: &str) -> String {
    let escape = |c: char| if c.is_ascii_graphic() { c.to_string() } else { c.escape_unicode().to_string() };
    text.chars().map(escape).collect()
}

impl CardFields<'_, '_> {
    /// The text of a field; empty where it is blank or beyond the card's end.
    #[must_use]
    pub fn text(&self, index: usize) -> &str {
        &self.field(index).text
    }

    fn field(&self, index: usize) -> &CardField {
        index.checked_sub(1).and_then(|index| self.card.fields.get(index)).unwrap_or(&BLANK)
    }

    /// Whether a field is blank.
    #[must_use]
    pub fn blank(&self, index: usize) -> bool {
        self.text(index).is_empty()
    }

    /// Where a field stands; the card where it is beyond its end.
    #[must_use]
    pub fn at(&self, index: usize) -> FilePlace {
        let at = self.field(index).at;
        if at.line == 0 || self.blank(index) { self.card.at } else { at }
    }

    /// The card with its number, such as `CBAR 12`.
    #[must_use]
    pub fn label(&self) -> String {
        let id = self.text(1);
        if id.is_empty() { self.card.name.clone() } else { format!("{} {id}", self.card.name) }
    }

    /// A finding about a field.
    #[must_use]
    pub fn fault(&self, index: usize, name: &str, expected: impl Into<String>) -> ImportFinding {
        let about = if name.is_empty() { self.label() } else { format!("{}: {name}", self.label()) };
        let finding = ImportFinding::new(self.at(index), about, expected);
        if self.blank(index) { finding } else { finding.with_found(ascii(self.text(index))) }
    }

    /// Adds an error about a field.
    pub fn refuse(&mut self, index: usize, name: &str, expected: &str, hint: &str) {
        let fault = self.fault(index, name, expected);
        self.findings.error(if hint.is_empty() { fault } else { fault.hint(hint) });
    }

    /// A positive integer that must be there.
    pub fn id(&mut self, index: usize, name: &str) -> Option<u64> {
        match number(self.text(index)) {
            Some(Number::Integer(id)) if id > 0 => u64::try_from(id).ok(),
            _ if self.blank(index) => {
                self.refuse(index, name, "is missing", "it must be a whole number above 0");
                None
            }
            _ => {
                self.refuse(index, name, "must be a whole number above 0", "");
                None
            }
        }
    }

    /// A positive integer, or `default` where the field is blank.
    pub fn id_or(&mut self, index: usize, name: &str, default: u64) -> Option<u64> {
        if self.blank(index) { Some(default) } else { self.id(index, name) }
    }

    /// A whole number from 0, 0 where the field is blank.
    pub fn whole(&mut self, index: usize, name: &str) -> Option<u64> {
        if matches!(number(self.text(index)), Some(Number::Integer(0))) || self.blank(index) {
            return Some(0);
        }
        self.id(index, name)
    }

    /// A real number; `Some(None)` where the field is blank.
    pub fn optional(&mut self, index: usize, name: &str) -> Option<Option<f64>> {
        if self.blank(index) {
            return Some(None);
        }
        match number(self.text(index)) {
            Some(Number::Real(value)) => return Some(Some(value)),
            Some(Number::Integer(value)) => {
                let hint = format!("write {value}. for {value}, and check the columns");
                self.refuse(index, name, "must be a real number, with its decimal point", &hint);
            }
            Some(Number::Huge) => self.refuse(index, name, "must be a number that a double can hold", ""),
            None => self.refuse(index, name, "must be a real number", "such as 12. or 1.2+3 or 1.2E3"),
        }
        None
    }

    /// A real number that must be there.
    pub fn real(&mut self, index: usize, name: &str) -> Option<f64> {
        let value = self.optional(index, name)?;
        if value.is_none() {
            self.refuse(index, name, "is missing", "it must be a real number");
        }
        value
    }

    /// A real number, or `default` where the field is blank.
    pub fn real_or(&mut self, index: usize, name: &str, default: f64) -> Option<f64> {
        Some(self.optional(index, name)?.unwrap_or(default))
    }

    /// A real number that is not negative, 0 where the field is blank.
    pub fn not_negative(&mut self, index: usize, name: &str) -> Option<f64> {
        let value = self.real_or(index, name, 0.0)?;
        if value < 0.0 {
            self.refuse(index, name, "must not be negative", "");
        }
        (value >= 0.0).then_some(value)
    }

    /// Three real numbers from a field on, 0 where a field is blank.
    pub fn vector(&mut self, index: usize, names: [&str; 3]) -> Option<[f64; 3]> {
        let x = self.real_or(index, names[0], 0.0);
        let y = self.real_or(index + 1, names[1], 0.0);
        let z = self.real_or(index + 2, names[2], 0.0);
        Some([x?, y?, z?])
    }

    /// A set of degrees of freedom; empty where the field is blank or 0.
    pub fn freedoms(&mut self, index: usize, name: &str) -> Option<[bool; 6]> {
        let text = if self.text(index) == "0" { "" } else { self.text(index) };
        let set = freedoms(text);
        if set.is_none() {
            self.refuse(index, name, "must be digits from 1 to 6, each once", "such as 123456");
        }
        set
    }

    /// Adds an error where a field has a number other than 0, with the reason.
    pub fn zero(&mut self, index: usize, name: &str, hint: &str) -> Option<()> {
        let value = match number(self.text(index)) {
            Some(Number::Integer(value)) => value as f64,
            _ => self.real_or(index, name, 0.0)?,
        };
        if value != 0.0 {
            let fault = self.fault(index, name, "can only be 0 or blank").hint(hint);
            self.findings.error(ImportFinding { found: Some(written(value)), ..fault });
            return None;
        }
        Some(())
    }

    /// Adds an error where a field from this one on is not blank.
    pub fn end(&mut self, from: usize) {
        let beyond = (from..=self.card.fields.len()).find(|index| !self.blank(*index));
        if let Some(index) = beyond {
            self.refuse(
                index,
                &format!("field {}", index + 1),
                "must be blank",
                "this card has no such field; check the columns",
            );
        }
    }

    /// The card's last field that is not blank.
    #[must_use]
    pub fn last(&self) -> usize {
        (1..=self.card.fields.len()).rev().find(|index| !self.blank(*index)).unwrap_or(0)
    }
}
