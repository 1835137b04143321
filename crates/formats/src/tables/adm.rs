//! Tables as ADAMS data sets.

use adams::DataSet;

use super::format::Parsed;
use super::set::{TableSet, name_of_title};
use crate::diagnostic::Diagnostic;
use crate::source::Source;
use crate::units::Units;

/// The text of a data set: UNITS, SPLINE statements; the products in comments at its head.
///
/// # Errors
/// An identifier that stands twice.
pub(super) fn write(set: &TableSet) -> Result<String, adams::Error> {
    let tables = set.adams();
    let mut statements: Vec<_> = tables.units.iter().map(adams::AdamsUnits::statement).collect();
    if let Some(first) = statements.first_mut() {
        first.remarks = remarks(set);
    }
    statements.extend(tables.splines.iter().map(adams::Spline::statement));
    DataSet { title: tables.title.unwrap_or_default(), statements }.write()
}

/// Comment lines: the products of the factored form.
pub(super) fn remarks(set: &TableSet) -> Vec<String> {
    if set.products.is_empty() {
        return Vec::new();
    }
    let head =
        "x: where the load stands, z: where the deflection is taken. Deflection per unit load:".to_owned();
    std::iter::once(head).chain(set.products.iter().map(super::Product::expression)).collect()
}

/// What stands in comments that begin with `mark`.
pub(super) fn comments(text: &str, mark: char) -> String {
    let lines = text.lines().filter_map(|line| line.trim_start().strip_prefix(mark));
    lines.collect::<Vec<_>>().join("\n")
}

/// Reads the SPLINE statements of a data set.
pub(super) fn read(source: &Source) -> Result<Parsed, Vec<Diagnostic>> {
    let set = adams::tables::read(&source.text).map_err(|error| vec![unreadable(source, &error)])?;
    let title = set.title.as_deref().map(name_of_title).filter(|name| !name.is_empty());
    Ok(Parsed {
        name: title.map_or_else(|| crate::spec::stem(&source.name), str::to_owned),
        units: set.units.map(Units::of_adams),
        lacks: [
            "has no UNITS statement",
            "such as UNITS/ FORCE = POUND_FORCE, MASS = SLUG, LENGTH = FOOT, TIME = SECOND",
        ],
        drafts: TableSet::drafts(set.splines),
        remarks: comments(&source.text, '!'),
        products: Vec::new(),
    })
}

/// A data set's error with its place in the file.
pub(super) fn unreadable(source: &Source, error: &adams::Error) -> Diagnostic {
    match error {
        adams::Error::At { line, column, fault } => Diagnostic {
            line: Some(*line),
            column: Some(*column),
            ..Diagnostic::of_file(&source.name, fault.to_string())
        },
        other => Diagnostic::of_file(&source.name, other.to_string()),
    }
}
