//! SPLINE tables of an ADAMS data set as a structure.

use std::sync::Arc;

use adams::{Curves, Tables};

use super::raw::RawTables;
use super::structure::{Origin, TablePair};
use crate::check::Check;
use crate::diagnostic::Diagnostic;
use crate::fault::Fault;
use crate::place::Place;
use crate::source::Source;
use crate::units::{Dimension, Scale, Units};

/// Reads the tables that `raw` names from `source`, in the units of the scene.
pub(super) fn read(
    raw: &RawTables,
    file: &str,
    source: &Source,
    at: &Place<'_>,
    units: Units,
    elsewhere: &mut Vec<Diagnostic>,
    check: &mut Check<'_>,
) -> Option<Origin> {
    let set = match adams::tables::read(&source.text) {
        Ok(set) => set,
        Err(error) => {
            elsewhere.push(unreadable(source, &error));
            return None;
        }
    };
    let Some(given) = set.units else {
        let fault = Diagnostic::of_file(&source.name, "has no UNITS statement");
        elsewhere.push(
            fault.hint("such as UNITS/ FORCE = POUND_FORCE, MASS = SLUG, LENGTH = FOOT, TIME = SECOND"),
        );
        return None;
    };
    let scale = Scale { from: Units::of_adams(given), to: units };
    let vertical = table(&set, raw.vertical, &at.key("vertical"), check);
    let lateral = table(&set, raw.lateral, &at.key("lateral"), check);
    let first = vertical.or(lateral)?;
    if let Some((own, other)) = vertical.zip(lateral)
        && own.x() != other.x()
    {
        let fault = Fault::new(&at.key("lateral"), "must have the stations of `vertical`");
        check.faults.add(fault.hint("one rail has one list of stations"));
        return None;
    }
    let length = scale.factor(Dimension::LENGTH);
    let give = scale.factor(Dimension::FLEXIBILITY);
    let rows = |table: &Curves| {
        let rows = table.y().iter();
        rows.map(|row| row.iter().map(|value| value * give).collect()).collect()
    };
    let tables = TablePair {
        stations: first.x().iter().map(|x| x * length).collect(),
        vertical: vertical.map(rows),
        lateral: lateral.map(rows),
    };
    Some(Origin::Tables { file: file.to_owned(), tables: Arc::new(tables) })
}

/// The table of one direction: a family with a curve for each station.
fn table<'s>(set: &'s Tables, id: Option<u32>, at: &Place<'_>, check: &mut Check<'_>) -> Option<&'s Curves> {
    let id = id?;
    let Some(spline) = set.splines.iter().find(|spline| spline.id == id) else {
        let known: Vec<String> = set.splines.iter().map(|spline| spline.id.to_string()).collect();
        let hint = if known.is_empty() {
            "the file has none".to_owned()
        } else {
            format!("known: {}", known.join(", "))
        };
        check.faults.add(Fault::new(at, "must be the number of a SPLINE in the file").got(id).hint(hint));
        return None;
    };
    if spline.curves.z() != spline.curves.x() {
        let fault = Fault::new(at, format!("SPLINE/{id} must have a curve at each of its x"));
        check.faults.add(fault.hint("an influence table has the same stations for loads and deflections"));
        return None;
    }
    Some(&spline.curves)
}

/// A data set's error with its place in the file.
pub(crate) fn unreadable(source: &Source, error: &adams::Error) -> Diagnostic {
    match error {
        adams::Error::At { line, column, fault } => Diagnostic {
            line: Some(*line),
            column: Some(*column),
            ..Diagnostic::of_file(&source.name, fault.to_string())
        },
        other => Diagnostic::of_file(&source.name, other.to_string()),
    }
}
