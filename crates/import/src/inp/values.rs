//! Values of data lines: numbers, node and element numbers, names of sets.

use super::keyword::{InpField, KeywordBlock};
use crate::findings::{ImportFinding, ImportFindings};
use formats::limits::MAGNITUDES;

/// Reads a number of a node or element. A number in an instance has the name of the instance before it, with a dot.
#[must_use]
pub fn number_of(text: &str) -> Option<u64> {
    let own = text.rsplit_once('.').map_or(text, |(_, own)| own);
    own.parse().ok()
}

/// The key of a name, in capital letters.
#[must_use]
pub fn key_of(name: &str) -> String {
    name.trim().trim_matches('"').to_uppercase()
}

/// The name of a value for messages: the keyword and the word for the value.
fn about(block: &KeywordBlock, what: &str) -> String {
    format!("{}: {what}", block.label())
}

/// A field of a data line of a keyword; adds an error if it is missing or blank.
pub fn field<'b>(
    block: &'b KeywordBlock,
    line: &'b [InpField],
    index: usize,
    what: &str,
    findings: &mut ImportFindings,
) -> Option<&'b InpField> {
    let found = line.get(index).filter(|field| !field.text.is_empty());
    if found.is_none() {
        let at = line.first().map_or(block.at, |field| field.at);
        findings.error(ImportFinding::new(
            at,
            about(block, what),
            "is missing on this line",
        ));
    }
    found
}

/// Reads the number of a node or element from a data line.
pub fn whole(
    block: &KeywordBlock,
    line: &[InpField],
    index: usize,
    what: &str,
    findings: &mut ImportFindings,
) -> Option<u64> {
    let field = field(block, line, index, what, findings)?;
    let value = number_of(&field.text).filter(|value| *value > 0);
    if value.is_none() {
        let finding = ImportFinding::new(
            field.at,
            about(block, what),
            "must be a whole number above 0",
        );
        findings.error(finding.with_found(ascii(&field.text)));
    }
    value
}

/// Reads a real number from a data line; a missing one is `default`, or an error if there is none.
pub fn real(
    block: &KeywordBlock,
    line: &[InpField],
    index: usize,
    (what, default): (&str, Option<f64>),
    findings: &mut ImportFindings,
) -> Option<f64> {
    if let (None | Some(""), Some(default)) =
        (line.get(index).map(|field| field.text.as_str()), default)
    {
        return Some(default);
    }
    let field = field(block, line, index, what, findings)?;
    let value = parsed(&field.text);
    let [least, most] = MAGNITUDES;
    let expected = match value {
        None => "must be a finite number".to_owned(),
        Some(value) if value == 0.0 || (least..=most).contains(&value.abs()) => return Some(value),
        Some(_) => format!("must be 0, or between {least:e} and {most:e} in magnitude"),
    };
    let finding = ImportFinding::new(field.at, about(block, what), expected);
    findings.error(finding.with_found(ascii(&field.text)));
    None
}

/// A finite number, whose exponent may have the letter d.
fn parsed(text: &str) -> Option<f64> {
    let value = text.replace(['d', 'D'], "e").parse::<f64>().ok();
    value.filter(|value| value.is_finite())
}

/// Reads a positive real number from a data line.
pub fn positive(
    block: &KeywordBlock,
    line: &[InpField],
    index: usize,
    what: &str,
    findings: &mut ImportFindings,
) -> Option<f64> {
    let value = real(block, line, index, (what, None), findings)?;
    if value <= 0.0 {
        let at = line.get(index).map_or(block.at, |field| field.at);
        findings.error(
            ImportFinding::new(at, about(block, what), "must be positive").with_found(value),
        );
    }
    (value > 0.0).then_some(value)
}

/// Reads a vector from a data line; missing components are 0, as are magnitudes below the smallest one of a spec, which
/// are rounding errors of the program that wrote the file.
pub fn vector(
    block: &KeywordBlock,
    line: &[InpField],
    first: usize,
    names: [&str; 3],
    findings: &mut ImportFindings,
) -> Option<[f64; 3]> {
    let part = |k: usize, findings: &mut ImportFindings| {
        let value = line.get(first + k).and_then(|field| parsed(&field.text));
        if value.is_some_and(|value| value.abs() < MAGNITUDES[0]) {
            return Some(0.0);
        }
        real(block, line, first + k, (names[k], Some(0.0)), findings)
    };
    let (x, y, z) = (part(0, findings), part(1, findings), part(2, findings));
    Some([x?, y?, z?])
}

/// The text with every character other than printable ASCII escaped.
fn ascii(text: &str) -> String {
    text.chars().flat_map(char::escape_default).collect()
}
