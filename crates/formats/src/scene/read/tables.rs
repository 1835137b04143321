//! Influence tables of a file as the source of the influence coefficients of a structure.

use std::sync::Arc;

use adams::SplineValues;

use crate::check::Check;
use crate::scene::raw::{RawPick, RawTables};
use crate::scene::values::structure::{Origin, TablePair};
use crate::tables::{self, Table, TableSet};
use crate::text::diagnostic::Diagnostic;
use crate::text::fault::{Fault, nearest};
use crate::text::inputs::Input;
use crate::text::place::Place;
use crate::units::{Dimension, Scale, Units};

/// Reads the tables selected by `raw` from `input` and converts them to the units of the scene.
pub(super) fn read(
    raw: &RawTables,
    input: &Input,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Result<Option<Origin>, Vec<Diagnostic>> {
    let units = match &raw.units {
        None => None,
        given => {
            let Some(units) = Units::read(given, at, check.faults) else {
                return Ok(None);
            };
            Some(units)
        }
    };
    let set = tables::expand(&tables::read(&input.display_name, &input.bytes, units)?);
    Ok(pair(&set, raw, at, check).map(|tables| Origin::Tables {
        file: input.name.clone(),
        tables: Arc::new(tables),
    }))
}

/// The tables of a set that are selected by `raw`.
fn pair(
    set: &TableSet,
    raw: &RawTables,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<TablePair> {
    let scale = Scale {
        from: set.units,
        to: check.scale.to,
    };
    let vertical = table(set, raw.vertical.as_ref(), &at.key("vertical"), check);
    let lateral = table(set, raw.lateral.as_ref(), &at.key("lateral"), check);
    let first = vertical.or(lateral)?;
    if let Some((own, other)) = vertical.zip(lateral)
        && own.x() != other.x()
    {
        let fault = Fault::new(
            &at.key("lateral"),
            "must have the same stations as `vertical`",
        );
        check
            .faults
            .add(fault.hint("both tables of a rail have the same stations"));
        return None;
    }
    let length = scale.factor(Dimension::LENGTH);
    let compliance = scale.factor(Dimension::FLEXIBILITY);
    let rows = |table: &SplineValues| {
        let rows = table.y().iter();
        rows.map(|row| row.iter().map(|value| value * compliance).collect())
            .collect()
    };
    Some(TablePair {
        stations: first.x().iter().map(|x| x * length).collect(),
        vertical: vertical.map(rows),
        lateral: lateral.map(rows),
    })
}

/// The table of one direction: a family of curves, one for each station.
fn table<'s>(
    set: &'s TableSet,
    pick: Option<&RawPick>,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<&'s SplineValues> {
    let found = match pick? {
        RawPick::Id(id) => by_id(set, *id, at, check),
        RawPick::Name(name) => by_name(set, name, at, check),
    }?;
    if found.curves.z() != found.curves.x() {
        let fault = Fault::new(
            at,
            format!("SPLINE/{} must have a curve at each of its x", found.id),
        );
        check
            .faults
            .add(fault.hint("an influence table has the same stations for loads and deflections"));
        return None;
    }
    Some(&found.curves)
}

fn by_id<'s>(
    set: &'s TableSet,
    id: u32,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<&'s Table> {
    let found = set.table(id);
    if found.is_none() {
        let known: Vec<String> = set
            .tables
            .iter()
            .map(|table| table.id.to_string())
            .collect();
        let fault = match set.left_out.iter().find(|table| table.id == Some(id)) {
            Some(table) => modified(at, table.line).got(id),
            None => Fault::new(at, "must be the number of a SPLINE in the file").got(id),
        };
        check.faults.add(fault.hint(hint(&known)));
    }
    found
}

/// The table with that name, or the only one with that quantity.
fn by_name<'s>(
    set: &'s TableSet,
    name: &str,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<&'s Table> {
    let called: Vec<&Table> = set
        .tables
        .iter()
        .filter(|table| table.name == name)
        .collect();
    let quantity = |table: &&Table| {
        table
            .quantity
            .is_some_and(|quantity| quantity.name() == name)
    };
    let own: Vec<&Table> = set.tables.iter().filter(quantity).collect();
    match (called.as_slice(), own.as_slice()) {
        ([one], _) | ([], [one]) => return Some(one),
        _ => {}
    }
    let known: Vec<String> = set
        .tables
        .iter()
        .map(|table| format!("\"{}\"", table.name))
        .collect();
    let names: Vec<&str> = set.tables.iter().map(|table| table.name.as_str()).collect();
    if let Some(table) = set.left_out.iter().find(|table| table.name == name) {
        check.faults.add(
            modified(at, table.line)
                .got(format!("\"{name}\""))
                .hint(hint(&known)),
        );
        return None;
    }
    let several = !called.is_empty() || !own.is_empty();
    let expected = if several {
        "must be the name of exactly one table"
    } else {
        "must be the name of a table in the file"
    };
    let near = nearest(name, &names)
        .map(|near| format!("did you mean \"{near}\"? "))
        .unwrap_or_default();
    let fault = Fault::new(at, expected).got(format!("\"{name}\""));
    check
        .faults
        .add(fault.hint(format!("{near}{}", hint(&known))));
    None
}

/// The fault of a table that was left out, because the command at `line` modifies it.
fn modified(at: &Place<'_>, line: usize) -> Fault {
    let expected = "must be a table that no later command of the file modifies";
    Fault::new(
        at,
        format!("{expected} (`data_element modify spline` in line {line})"),
    )
}

fn hint(known: &[String]) -> String {
    if known.is_empty() {
        "the file has none".to_owned()
    } else {
        format!("known: {}", known.join(", "))
    }
}
