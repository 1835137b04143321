//! Tables as commands of Adams View.

use super::adm::{comments, remarks, unreadable};
use super::format::Parsed;
use super::set::{TableSet, plain};
use crate::diagnostic::Diagnostic;
use crate::source::Source;
use crate::units::Units;

/// The text of a command file: units, model, splines; the products in comments at its head.
///
/// # Errors
/// An identifier that stands twice.
pub(super) fn write(set: &TableSet) -> Result<String, adams::Error> {
    let mut tables = set.adams();
    tables.title = Some(word(&set.name));
    for spline in &mut tables.splines {
        spline.name = spline.name.take().map(|name| word(&name));
    }
    adams::view::write(&tables, &remarks(set))
}

/// A name that does not begin with a digit.
fn word(name: &str) -> String {
    let mut name = plain(name);
    if name.starts_with(|c: char| c.is_ascii_digit()) {
        name.insert(0, '_');
    }
    name
}

/// Reads the splines of a command file.
pub(super) fn read(source: &Source) -> Result<Parsed, Vec<Diagnostic>> {
    let set = adams::view::read(&source.text).map_err(|error| vec![unreadable(source, &error)])?;
    Ok(Parsed {
        name: set.title.unwrap_or_else(|| crate::spec::stem(&source.name)),
        units: set.units.map(Units::of_adams),
        lacks: [
            "has no `defaults units`",
            "such as: defaults units length=foot force=pound_force mass=slug time=sec",
        ],
        drafts: TableSet::drafts(set.splines),
        remarks: comments(&source.text, '!'),
        products: Vec::new(),
    })
}
