//! A table as a matrix: x in the first row, z in the first column.

use super::Sheet;
use super::cells::Cell;
use crate::tables::defect::{self, Part};
use crate::tables::parsed::Draft;
use crate::text::diagnostic::Diagnostic;

/// Reads the single table of the file. The corner is empty, text or missing. It may be 0 if x and z are the same
/// stations.
pub(super) fn read(sheet: &Sheet<'_>) -> Result<Draft, Vec<Diagnostic>> {
    let (head, body) = (&sheet.rows[0], &sheet.rows[1..]);
    let one = |fault: Box<Diagnostic>| vec![*fault];
    let Some(first) = body.first() else {
        let fault = sheet.fault(&head[0], "must have rows of values below x");
        return Err(vec![fault.hint(HINT)]);
    };
    let cornerless = head.len() + 1 == first.len() && sheet.maybe_number(&head[0]).is_some();
    let heads = if cornerless { &head[..] } else { &head[1..] };
    let numbers = |cells: &[Cell]| {
        cells
            .iter()
            .map(|cell| sheet.number(cell))
            .collect::<Result<Vec<f64>, _>>()
    };
    let x = numbers(heads).map_err(one)?;
    let mut z = Vec::new();
    let mut values = Vec::new();
    for row in body {
        z.push(sheet.number(&row[0]).map_err(one)?);
        values.push(numbers(&row[1..]).map_err(one)?);
    }
    // a different number in the corner may be the first value of a matrix without x and z
    let corner = if cornerless {
        None
    } else {
        sheet.maybe_number(&head[0])
    };
    if corner.is_some_and(|corner| corner != 0.0 || x != z) {
        let mut fault = sheet.fault(&head[0], "the corner must be empty or text");
        fault.found = Some(head[0].text.clone());
        return Err(vec![fault.hint(HINT)]);
    }
    let curves = defect::checked(x, z, values).map_err(|defect| {
        let cell = match defect.part {
            Part::X(k) => heads.get(k),
            Part::Z(i) | Part::Row(i) => body.get(i).map(|row| &row[0]),
            Part::Value(i, j) => body.get(i).and_then(|row| row.get(j + 1)),
            Part::Xs | Part::Values => None,
        };
        let fault = sheet.fault(cell.unwrap_or(&head[0]), defect.expected);
        vec![Diagnostic {
            found: defect.found,
            hint: defect.hint.map(str::to_owned),
            ..fault
        }]
    })?;
    Ok(Draft::of(curves))
}

const HINT: &str = "a matrix has x in its first row and z in its first column";
