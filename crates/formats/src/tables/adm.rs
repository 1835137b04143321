//! Tables as ADAMS data sets: SPLINE statements.

use adams::{DataSet, Spline, Tables};

use super::parsed::{Draft, Parsed};
use super::set::{Product, Table, TableSet, adams_name};
use crate::grid::StationGrid;
use crate::spec::stem;
use crate::text::diagnostic::Diagnostic;
use crate::text::source::Source;
use crate::units::{Dimension, Units};

impl TableSet {
    /// The tables as SPLINE statements, all with linear extrapolation.
    pub(super) fn adams(&self) -> Tables {
        let unit = self.units.label(Dimension::FLEXIBILITY);
        let spline = |table: &Table| Spline {
            id: table.id,
            name: Some(adams_name(&table.name)),
            units: Some("no_units".to_owned()),
            linear_extrapolate: true,
            curves: table.curves.clone(),
        };
        Tables {
            title: Some(format!("{}{TITLE}{unit}", self.name)),
            units: Some(self.units.to_adams()),
            splines: self.tables.iter().map(spline).collect(),
        }
    }
}

/// Converts SPLINE statements to tables.
pub(super) fn drafts(splines: Vec<Spline>) -> Vec<Draft> {
    let draft = |spline: Spline| Draft {
        id: Some(spline.id),
        name: Some(
            spline
                .name
                .unwrap_or_else(|| format!("SPLINE_{}", spline.id)),
        ),
        linear_extrapolate: Some(spline.linear_extrapolate),
        ..Draft::of(spline.curves)
    };
    splines.into_iter().map(draft).collect()
}

/// Text between the name of the structure and the unit of the values in the title of a data set.
const TITLE: &str = ": influence coefficients, ";

/// The name of the structure in the title of a data set written by this program, by Adams View or by another program.
fn name_of_title(title: &str) -> &str {
    let own = title.split_once(TITLE).map(|(name, _)| name);
    own.or_else(|| title.strip_prefix("Adams View model name: "))
        .unwrap_or(title)
        .trim()
}

/// The tables of a grid, [`TableSet::of_grid`], as SPLINE statements.
#[must_use]
pub fn data_set(grid: &StationGrid) -> Tables {
    TableSet::of_grid(grid).adams()
}

/// The tables of a grid as the text of an ADAMS data set for the structure `name`. The result is `None` if no rail
/// has the four stations that a SPLINE requires.
///
/// # Errors
/// More tables than available identifiers.
pub fn adm(name: &str, grid: &StationGrid) -> Result<Option<String>, adams::Error> {
    let set = data_set(&StationGrid {
        name: name.to_owned(),
        ..grid.clone()
    });
    if set.splines.is_empty() {
        Ok(None)
    } else {
        adams::tables::write(&set).map(Some)
    }
}

/// The text of a data set: comments with the products, followed by UNITS and SPLINE statements.
///
/// # Errors
/// Two tables with the same number.
pub(super) fn write(set: &TableSet) -> Result<String, adams::Error> {
    let tables = set.adams();
    let mut statements: Vec<_> = tables
        .units
        .iter()
        .map(adams::AdamsUnits::statement)
        .collect();
    if let Some(first) = statements.first_mut() {
        first.remarks = remarks(set);
    }
    statements.extend(tables.splines.iter().map(adams::Spline::statement));
    DataSet {
        title: tables.title.unwrap_or_default(),
        statements,
    }
    .write()
}

/// Comment lines that state the products of the factored form.
pub(super) fn remarks(set: &TableSet) -> Vec<String> {
    if set.products.is_empty() {
        return Vec::new();
    }
    let head =
        "x: where the load stands, z: where the deflection is taken. Deflection per unit load:"
            .to_owned();
    std::iter::once(head)
        .chain(set.products.iter().map(Product::expression))
        .collect()
}

/// The text of the comment lines, which are the lines that begin with `mark`.
pub(super) fn comments(text: &str, mark: char) -> String {
    let lines = text
        .lines()
        .filter_map(|line| line.trim_start().strip_prefix(mark));
    lines.collect::<Vec<_>>().join("\n")
}

/// Reads the SPLINE statements of a data set.
pub(super) fn read(source: &Source) -> Result<Parsed, Vec<Diagnostic>> {
    let set =
        adams::tables::read(&source.text).map_err(|error| vec![unreadable(source, &error)])?;
    let title = set
        .title
        .as_deref()
        .map(name_of_title)
        .filter(|name| !name.is_empty());
    Ok(Parsed {
        name: title.map_or_else(|| stem(&source.name), str::to_owned),
        units: set.units.map(Units::of_adams),
        missing_units: [
            "has no UNITS statement",
            "such as UNITS/ FORCE = POUND_FORCE, MASS = SLUG, LENGTH = FOOT, TIME = SECOND",
        ],
        drafts: drafts(set.splines),
        comments: comments(&source.text, '!'),
        products: Vec::new(),
        left_out: Vec::new(),
    })
}

/// Converts an error of `adams` to a diagnostic with its position in the file.
pub(super) fn unreadable(source: &Source, error: &adams::Error) -> Diagnostic {
    match error {
        adams::Error::At {
            line,
            column,
            fault,
        } => Diagnostic {
            line: Some(*line),
            column: Some(*column),
            ..Diagnostic::of_file(&source.name, fault.to_string())
        },
        other => Diagnostic::of_file(&source.name, other.to_string()),
    }
}
