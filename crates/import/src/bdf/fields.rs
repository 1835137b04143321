//! Access to the fields of a card by number, with checks of their types.

use super::card::Card;
use super::divide::CardField;
use super::field::{Number, freedoms, number};
use crate::findings::{FilePlace, ImportFinding, ImportFindings};
use formats::limits::MAGNITUDES;
use formats::text::fault::number as written;

/// Reads the fields of one card; field 1 is the first after the name.
#[derive(Debug)]
pub struct CardFields<'c, 'f> {
    /// The card.
    pub card: &'c Card,
    /// Collection to which errors and warnings are added.
    pub findings: &'f mut ImportFindings,
}

static BLANK: CardField = CardField {
    at: FilePlace {
        file: 0,
        line: 0,
        column: 0,
    },
    text: String::new(),
};

/// Returns the text with every character other than printable ASCII and blanks escaped as `\u{...}`.
fn ascii(text: &str) -> String {
    let escape = |c: char| {
        if c.is_ascii_graphic() || c == ' ' {
            c.to_string()
        } else {
            c.escape_unicode().to_string()
        }
    };
    text.chars().map(escape).collect()
}

impl CardFields<'_, '_> {
    /// The text of a field; empty if the field is blank or the card has fewer fields.
    #[must_use]
    pub fn text(&self, index: usize) -> &str {
        &self.field(index).text
    }

    fn field(&self, index: usize) -> &CardField {
        index
            .checked_sub(1)
            .and_then(|index| self.card.fields.get(index))
            .unwrap_or(&BLANK)
    }

    /// Whether a field is blank.
    #[must_use]
    pub fn blank(&self, index: usize) -> bool {
        self.text(index).is_empty()
    }

    /// Position of a field, or of the card if the field is blank or does not exist.
    #[must_use]
    pub fn at(&self, index: usize) -> FilePlace {
        let at = self.field(index).at;
        if at.line == 0 || self.blank(index) {
            self.card.at
        } else {
            at
        }
    }

    /// Name and number of the card for messages, such as `CBAR 12`.
    #[must_use]
    pub fn label(&self) -> String {
        let id = self.text(1);
        if id.is_empty() {
            self.card.name.clone()
        } else {
            format!("{} {id}", self.card.name)
        }
    }

    /// Creates a finding that concerns a field.
    #[must_use]
    pub fn fault(&self, index: usize, name: &str, expected: impl Into<String>) -> ImportFinding {
        let about = if name.is_empty() {
            self.label()
        } else {
            format!("{}: {name}", self.label())
        };
        let finding = ImportFinding::new(self.at(index), about, expected);
        if self.blank(index) {
            finding
        } else {
            finding.with_found(ascii(self.text(index)))
        }
    }

    /// Adds an error that concerns a field.
    pub fn refuse(&mut self, index: usize, name: &str, expected: &str, hint: &str) {
        let fault = self.fault(index, name, expected);
        self.findings.error(if hint.is_empty() {
            fault
        } else {
            fault.hint(hint)
        });
    }

    /// Reads a required positive integer.
    pub fn id(&mut self, index: usize, name: &str) -> Option<u64> {
        match number(self.text(index)) {
            Some(Number::Integer(id)) if id > 0 => u64::try_from(id).ok(),
            _ if self.blank(index) => {
                self.refuse(
                    index,
                    name,
                    "is missing",
                    "it must be a whole number above 0",
                );
                None
            }
            _ => {
                self.refuse(index, name, "must be a whole number above 0", "");
                None
            }
        }
    }

    /// Reads a positive integer; returns `default` if the field is blank.
    pub fn id_or(&mut self, index: usize, name: &str, default: u64) -> Option<u64> {
        if self.blank(index) {
            Some(default)
        } else {
            self.id(index, name)
        }
    }

    /// Reads a non-negative integer; returns 0 if the field is blank.
    pub fn whole(&mut self, index: usize, name: &str) -> Option<u64> {
        if matches!(number(self.text(index)), Some(Number::Integer(0))) || self.blank(index) {
            return Some(0);
        }
        self.id(index, name)
    }

    /// Reads an optional real number; returns `Some(None)` if the field is blank and `None`, with an error, if it is
    /// not a real number.
    pub fn optional(&mut self, index: usize, name: &str) -> Option<Option<f64>> {
        if self.blank(index) {
            return Some(None);
        }
        match number(self.text(index)) {
            Some(Number::Real(value)) if value == 0.0 || is_within(value) => {
                return Some(Some(value));
            }
            Some(Number::Real(_)) => {
                let [least, most] = MAGNITUDES;
                self.refuse(
                    index,
                    name,
                    &format!("must be 0, or between {least:e} and {most:e} in magnitude"),
                    "",
                );
            }
            Some(Number::Integer(value)) => {
                let hint = format!("write {value}. instead of {value}, and check the columns");
                self.refuse(
                    index,
                    name,
                    "must be a real number with a decimal point",
                    &hint,
                );
            }
            Some(Number::Huge) => self.refuse(
                index,
                name,
                "must be within the range of double precision",
                "",
            ),
            None => self.refuse(
                index,
                name,
                "must be a real number",
                "such as 12. or 1.2+3 or 1.2E3",
            ),
        }
        None
    }

    /// Reads a required real number.
    pub fn real(&mut self, index: usize, name: &str) -> Option<f64> {
        let value = self.optional(index, name)?;
        if value.is_none() {
            self.refuse(index, name, "is missing", "it must be a real number");
        }
        value
    }

    /// Reads a real number; returns `default` if the field is blank.
    pub fn real_or(&mut self, index: usize, name: &str, default: f64) -> Option<f64> {
        Some(self.optional(index, name)?.unwrap_or(default))
    }

    /// Reads a real number that must not be negative; returns 0 if the field is blank.
    pub fn not_negative(&mut self, index: usize, name: &str) -> Option<f64> {
        let value = self.real_or(index, name, 0.0)?;
        if value < 0.0 {
            self.refuse(index, name, "must not be negative", "");
        }
        (value >= 0.0).then_some(value)
    }

    /// Reads a component of a position, an offset or a direction; returns 0 if the field is blank. A magnitude below the
    /// smallest one of a spec is a rounding error of a program that wrote the deck, and is 0.
    pub fn component(&mut self, index: usize, name: &str) -> Option<f64> {
        match number(self.text(index)) {
            Some(Number::Real(value)) if value.abs() < MAGNITUDES[0] => Some(0.0),
            _ => self.real_or(index, name, 0.0),
        }
    }

    /// Reads three components of a vector from consecutive fields; blank fields are 0.
    pub fn vector(&mut self, index: usize, names: [&str; 3]) -> Option<[f64; 3]> {
        let x = self.component(index, names[0]);
        let y = self.component(index + 1, names[1]);
        let z = self.component(index + 2, names[2]);
        Some([x?, y?, z?])
    }

    /// Reads a set of degrees of freedom, which is empty if the field is blank or 0.
    pub fn freedoms(&mut self, index: usize, name: &str) -> Option<[bool; 6]> {
        let text = if self.text(index) == "0" {
            ""
        } else {
            self.text(index)
        };
        let set = freedoms(text);
        if set.is_none() {
            self.refuse(
                index,
                name,
                "must consist of digits from 1 to 6, each at most once",
                "such as 123456",
            );
        }
        set
    }

    /// Requires a field to be 0 or blank; otherwise adds an error with `hint` as the reason.
    pub fn zero(&mut self, index: usize, name: &str, hint: &str) -> Option<()> {
        let value = match number(self.text(index)) {
            Some(Number::Integer(value)) => value as f64,
            _ => self.real_or(index, name, 0.0)?,
        };
        if value != 0.0 {
            let fault = self.fault(index, name, "must be 0 or blank").hint(hint);
            self.findings.error(ImportFinding {
                found: Some(written(value)),
                ..fault
            });
            return None;
        }
        Some(())
    }

    /// Requires all fields from `from` on to be blank; otherwise adds an error.
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

    /// Number of the last field that is not blank, 0 if there is none.
    #[must_use]
    pub fn last(&self) -> usize {
        (1..=self.card.fields.len())
            .rev()
            .find(|index| !self.blank(*index))
            .unwrap_or(0)
    }
}

/// Whether a beam spec accepts the magnitude of a number.
fn is_within(value: f64) -> bool {
    let [least, most] = MAGNITUDES;
    (least..=most).contains(&value.abs())
}
