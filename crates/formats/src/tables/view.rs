//! Tables as commands of Adams View.

use super::adm::{comments, drafts, remarks, unreadable};
use super::parsed::Parsed;
use super::set::{TableSet, adams_name};
use crate::spec::stem;
use crate::text::diagnostic::Diagnostic;
use crate::text::source::Source;
use crate::units::Units;

/// The text of a command file: comments with the products, followed by units, model and splines.
///
/// # Errors
/// Two tables with the same number.
pub(super) fn write(set: &TableSet) -> Result<String, adams::Error> {
    let mut tables = set.adams();
    tables.title = Some(view_name(&set.name));
    for spline in &mut tables.splines {
        spline.name = spline.name.take().map(|name| view_name(&name));
    }
    adams::view::write(&tables, &remarks(set))
}

/// A name that is valid in Adams View: it does not begin with a digit.
fn view_name(name: &str) -> String {
    let mut name = adams_name(name);
    if name.starts_with(|c: char| c.is_ascii_digit()) {
        name.insert(0, '_');
    }
    name
}

/// Reads the splines of a command file. Those that a later command modifies are left out and named in `left_out`.
pub(super) fn read(source: &Source) -> Result<Parsed, Vec<Diagnostic>> {
    let (set, left_out) = adams::view::read_with_modified(&source.text)
        .map_err(|error| vec![unreadable(source, &error)])?;
    Ok(Parsed {
        name: set.title.unwrap_or_else(|| stem(&source.name)),
        units: set.units.map(Units::of_adams),
        missing_units: [
            "has no `defaults units`",
            "such as: defaults units length=foot force=pound_force mass=slug time=sec",
        ],
        drafts: drafts(set.splines),
        comments: comments(&source.text, '!'),
        products: Vec::new(),
        left_out,
    })
}
