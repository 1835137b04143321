//! Checks of the numbers of a table, independent of the file format.

use adams::SplineValues;

use crate::text::number::number;

/// The part of a table that has a defect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// All x.
    Xs,
    /// One x.
    X(usize),
    /// One z.
    Z(usize),
    /// All values.
    Values,
    /// The row of one z.
    Row(usize),
    /// A value by row and column.
    Value(usize, usize),
}

/// A defect of a table: its location, the requirement, and the value found.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Defect {
    pub part: Part,
    pub expected: String,
    pub found: Option<String>,
    pub hint: Option<&'static str>,
}

impl Defect {
    fn of(part: Part, expected: impl Into<String>, found: impl ToString) -> Defect {
        Defect {
            part,
            expected: expected.into(),
            found: Some(found.to_string()),
            hint: None,
        }
    }
}

/// Makes a table of these numbers. `x` and `z` must increase; `values` has a row for each z, or one row if `z` is
/// empty.
///
/// # Errors
/// The first defect: fewer than four x, coordinates that do not increase, rows of a wrong length, or numbers that are
/// not finite.
pub(super) fn checked(
    x: Vec<f64>,
    z: Vec<f64>,
    values: Vec<Vec<f64>>,
) -> Result<SplineValues, Defect> {
    if x.len() < SplineValues::MIN_POINTS {
        let expected = format!("must have at least {} x values", SplineValues::MIN_POINTS);
        let hint = Some("a SPLINE needs at least four x values");
        return Err(Defect {
            hint,
            ..Defect::of(Part::Xs, expected, x.len())
        });
    }
    let part_x: fn(usize) -> Part = Part::X;
    for (list, part) in [(&x, part_x), (&z, Part::Z)] {
        if let Some(k) = list.iter().position(|value| !value.is_finite()) {
            return Err(Defect::of(part(k), "must be finite", list[k]));
        }
        if let Some(k) = list.windows(2).position(|pair| pair[0] >= pair[1]) {
            let expected = format!("must be above the one before it, {}", number(list[k]));
            return Err(Defect::of(part(k + 1), expected, list[k + 1]));
        }
    }
    if values.len() != z.len().max(1) {
        let expected = format!("must have {} rows, one for each z", z.len().max(1));
        return Err(Defect::of(Part::Values, expected, values.len()));
    }
    for (i, row) in values.iter().enumerate() {
        if row.len() != x.len() {
            let expected = format!("must have {} numbers, one for each x", x.len());
            return Err(Defect::of(Part::Row(i), expected, row.len()));
        }
        if let Some(j) = row.iter().position(|value| !value.is_finite()) {
            return Err(Defect::of(Part::Value(i, j), "must be finite", row[j]));
        }
    }
    SplineValues::new(x, z, values).map_err(|fault| Defect {
        part: Part::Values,
        expected: fault.to_string(),
        found: None,
        hint: None,
    })
}

/// Describes why the last of these rows (x, value) is invalid. x must not decrease, and at most two rows, which form
/// a step, may have the same x.
pub(crate) fn disorder(rows: &[[f64; 2]]) -> Option<String> {
    match rows {
        [.., before, last] if last[0] < before[0] => Some(format!(
            "x must not decrease: the previous row is at {}",
            number(before[0])
        )),
        [.., first, _, last] if last[0] == first[0] => {
            Some("at most two rows can have the same x: they form a step".to_owned())
        }
        _ => None,
    }
}
