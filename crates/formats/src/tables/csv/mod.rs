//! Tables as rows of cells: one value per line, or a matrix with x in the first row and z in the first column.

mod cells;
mod columns;
mod long;
mod matrix;

use ::csv::WriterBuilder;
use serde_json::json;

use super::adm::remarks;
use super::parsed::Parsed;
use super::set::TableSet;
use crate::spec::stem;
use crate::text::diagnostic::Diagnostic;
use crate::text::source::Source;
use crate::units::{Dimension, Units};
use cells::Sheet;

pub use columns::CsvColumns;

/// The text: comments with the products, a header with the units, and one value per line.
pub(super) fn write(set: &TableSet) -> String {
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    let length = set.units.label(Dimension::LENGTH);
    let value = set.units.label(Dimension::FLEXIBILITY);
    let value = if set.products.is_empty() {
        value
    } else {
        format!("({value})^0.5")
    };
    let header = [
        "id",
        "name",
        &format!("z [{length}]"),
        &format!("x [{length}]"),
        &format!("value [{value}]"),
    ];
    // writing to memory cannot fail
    let _ = writer.write_record(header);
    for table in &set.tables {
        for (i, row) in table.curves.y().iter().enumerate() {
            let z = table
                .curves
                .z()
                .get(i)
                .map(|z| json!(z).to_string())
                .unwrap_or_default();
            for (x, value) in table.curves.x().iter().zip(row) {
                let cells = [
                    &table.id.to_string(),
                    &table.name,
                    &z,
                    &json!(x).to_string(),
                    &json!(value).to_string(),
                ];
                let _ = writer.write_record(cells);
            }
        }
    }
    let body = writer.into_inner().unwrap_or_default();
    let comments: String = remarks(set)
        .iter()
        .map(|line| format!("# {line}\n"))
        .collect();
    comments + &String::from_utf8_lossy(&body)
}

/// Reads either layout. If the header has a column `value`, the file has one value per line; otherwise it is a
/// matrix.
pub(super) fn read(source: &Source) -> Result<Parsed, Vec<Diagnostic>> {
    let sheet = Sheet::of(source).map_err(|error| vec![*error])?;
    let (drafts, given) = match long::Header::of(&sheet)? {
        Some(header) => (long::read(&sheet, &header)?, header.units),
        None => (vec![matrix::read(&sheet)?], None),
    };
    Ok(Parsed {
        name: stem(&source.name),
        units: given.or_else(|| units_in(&sheet.comments)),
        missing_units: [
            "states no units",
            "such as a comment line: # units: ft, lbf, s",
        ],
        drafts,
        comments: sheet.comments,
        products: Vec::new(),
        left_out: Vec::new(),
    })
}

/// The units in a comment `units: ft, lbf, s`.
fn units_in(comments: &str) -> Option<Units> {
    comments
        .lines()
        .find_map(|line| Units::parse(line.trim().strip_prefix("units:")?))
}
