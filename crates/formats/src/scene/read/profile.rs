//! Measured profiles of rails: rows in a scene, or columns of a file.

use super::files::Files;
use crate::check::Check;
use crate::limits::{MAGNITUDES, ROWS};
use crate::scene::raw::RawIrregularity;
use crate::tables::{CsvColumns, disorder};
use crate::text::fault::{Fault, nearest, number};
use crate::text::place::Place;
use crate::units::Dimension;

/// Reads the rows (x, value) of a profile, from the scene or from columns of a file, in the unit of length of the
/// scene.
pub(super) fn profile(
    raw: &RawIrregularity,
    at: &Place<'_>,
    files: &mut Files<'_>,
    check: &mut Check<'_>,
) -> Option<Vec<[f64; 2]>> {
    let scale = check.number(
        raw.scale.unwrap_or(1.0),
        &at.key("scale"),
        Dimension::NUMBER,
    );
    let (rows, place) = match (&raw.rows, &raw.file) {
        (Some(rows), None) => {
            if let Some(columns) = &raw.columns {
                let fault =
                    Fault::new(&at.key("columns"), "needs a `file`").got(columns.join(", "));
                check.faults.add(fault.at_key());
            }
            (check_rows(rows, &at.key("rows"), check), at.key("rows"))
        }
        (None, Some(file)) => (read_file(raw, file, at, files, check)?, at.key("file")),
        (rows, _) => {
            let found = if rows.is_some() { "both" } else { "neither" };
            let fault = Fault::new(at, "must have either `rows` or `file`").got(found);
            check
                .faults
                .add(fault.hint("rows [x, height], or a file with such columns"));
            return None;
        }
    };
    let length = check.scale.factor(Dimension::LENGTH);
    let scaled = |[x, value]: [f64; 2]| [x * length, value * length * scale];
    let rows: Vec<[f64; 2]> = rows.into_iter().map(scaled).collect();
    check.items(rows.len(), &ROWS, &place);
    let [_, largest] = MAGNITUDES;
    if rows
        .iter()
        .flatten()
        .any(|number| number.is_nan() || number.abs() > largest)
    {
        let expected = format!(
            "must have numbers of at most {} after `scale`",
            number(largest)
        );
        check.faults.add(Fault::new(&place, expected));
    }
    Some(rows)
}

fn check_rows(rows: &[[f64; 2]], at: &Place<'_>, check: &mut Check<'_>) -> Vec<[f64; 2]> {
    if rows.is_empty() {
        check
            .faults
            .add(Fault::new(at, "must have at least one row [x, value]"));
    }
    for index in 0..rows.len() {
        if let Some(why) = disorder(&rows[..=index]) {
            check
                .faults
                .add(Fault::new(&at.index(index), why).got(number(rows[index][0])));
        }
    }
    rows.to_vec()
}

fn read_file(
    raw: &RawIrregularity,
    file: &str,
    at: &Place<'_>,
    files: &mut Files<'_>,
    check: &mut Check<'_>,
) -> Option<Vec<[f64; 2]>> {
    let rows = files.read(file, &at.key("file"), check, |input, check| {
        let source = input.source().map_err(|error| vec![*error])?;
        let columns = CsvColumns::of(&source).map_err(|error| vec![*error])?;
        select_columns(raw, &columns, at, check)
            .map(|picked| columns.rows(picked))
            .transpose()
    });
    rows.flatten()
}

/// Indices of the columns of x and of the value: the named columns, otherwise the first two.
fn select_columns(
    raw: &RawIrregularity,
    columns: &CsvColumns<'_>,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<[usize; 2]> {
    let Some(wanted) = &raw.columns else {
        return Some([0, 1]);
    };
    let known: Vec<&str> = columns.names().iter().map(String::as_str).collect();
    let mut find = |k: usize| {
        let found = known.iter().position(|name| *name == wanted[k]);
        if found.is_none() {
            let near = nearest(&wanted[k], &known).map(|near| format!("did you mean \"{near}\"? "));
            let list = if known.is_empty() {
                "it has no header".to_owned()
            } else {
                format!("known: {}", known.join(", "))
            };
            let fault = Fault::new(
                &at.key("columns").index(k),
                "must be the name of a column of the file",
            );
            let hint = format!("{}{list}", near.unwrap_or_default());
            check
                .faults
                .add(fault.got(format!("\"{}\"", wanted[k])).hint(hint));
        }
        found
    };
    let (x, value) = (find(0), find(1));
    Some([x?, value?])
}
