//! What is wrong with a table's numbers, by row and column, whatever the format.

use adams::SplineValues;

/// A part of a table.
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

/// What is wrong with it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Wrong {
    pub part: Part,
    pub expected: String,
    pub found: Option<String>,
    pub hint: Option<&'static str>,
}

impl Wrong {
    fn of(part: Part, expected: impl Into<String>, found: impl ToString) -> Wrong {
        Wrong { part, expected: expected.into(), found: Some(found.to_string()), hint: None }
    }
}

/// The table of these numbers, where they make one.
pub(super) fn curves(x: Vec<f64>, z: Vec<f64>, values: Vec<Vec<f64>>) -> Result<SplineValues, Wrong> {
    if x.len() < SplineValues::MIN_POINTS {
        let expected = format!("must have at least {} x", SplineValues::MIN_POINTS);
        let hint = Some("a SPLINE has four x values or more");
        return Err(Wrong { hint, ..Wrong::of(Part::Xs, expected, x.len()) });
    }
    let part_x: fn(usize) -> Part = Part::X;
    for (list, part) in [(&x, part_x), (&z, Part::Z)] {
        if let Some(k) = list.iter().position(|value| !value.is_finite()) {
            return Err(Wrong::of(part(k), "must be finite", list[k]));
        }
        if let Some(k) = list.windows(2).position(|pair| pair[0] >= pair[1]) {
            let expected = format!("must be above the one before it, {}", crate::fault::number(list[k]));
            return Err(Wrong::of(part(k + 1), expected, list[k + 1]));
        }
    }
    if values.len() != z.len().max(1) {
        let expected = format!("must have {} rows, one for each z", z.len().max(1));
        return Err(Wrong::of(Part::Values, expected, values.len()));
    }
    for (i, row) in values.iter().enumerate() {
        if row.len() != x.len() {
            let expected = format!("must have {} numbers, one for each x", x.len());
            return Err(Wrong::of(Part::Row(i), expected, row.len()));
        }
        if let Some(j) = row.iter().position(|value| !value.is_finite()) {
            return Err(Wrong::of(Part::Value(i, j), "must be finite", row[j]));
        }
    }
    SplineValues::new(x, z, values).map_err(|fault| Wrong {
        part: Part::Values,
        expected: fault.to_string(),
        found: None,
        hint: None,
    })
}
