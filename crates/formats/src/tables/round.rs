//! Tables rounded to a number of significant digits.

use adams::SplineValues;
use serde_json::{Value, json};

use super::set::{Table, TableSet};
use crate::text::number::rounded;

/// The effect of rounding.
#[derive(Clone, Debug, PartialEq)]
pub struct Rounding {
    /// Number of significant digits after rounding.
    pub digits: usize,
    /// Largest relative change |rounded - original| / |original| over all values and stations.
    pub largest: f64,
    /// Location of the largest change: number of the table, x, and z (`None` in a table of one curve), before
    /// rounding. `None` if no number changed.
    pub at: Option<(u32, f64, Option<f64>)>,
    /// Whether stations were changed too.
    pub stations: bool,
}

/// The reason why tables cannot be rounded to this number of digits.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RoundError {
    /// A value that overflows when rounded.
    #[error("SPLINE/{id} has a value that overflows when rounded")]
    Overflow {
        /// The table.
        id: u32,
    },
    /// Two stations that become equal.
    #[error("SPLINE/{id} has stations that coincide after rounding")]
    Stations {
        /// The table.
        id: u32,
    },
}

impl Rounding {
    /// One line for the terminal.
    #[must_use]
    pub fn message(&self) -> String {
        let Some((id, x, z)) = self.at else {
            return format!("rounded to {} digits: no number changed", self.digits);
        };
        let z = z.map(|z| format!(", z = {z}")).unwrap_or_default();
        let stations = if self.stations {
            "; stations changed too"
        } else {
            ""
        };
        let (digits, largest) = (self.digits, self.largest);
        format!(
            "rounded to {digits} digits: the largest relative change is {largest:.2e}, SPLINE/{id} at \
             x = {x}{z}{stations}"
        )
    }

    /// The same as JSON.
    #[must_use]
    pub fn json(&self) -> Value {
        let at = self
            .at
            .map(|(id, x, z)| json!({ "id": id, "x": x, "z": z }));
        json!({ "digits": self.digits, "largest": self.largest, "at": at, "stations": self.stations })
    }
}

/// Rounds every number of the tables to `digits` significant decimal digits, with ties to even, and reports the
/// changes.
///
/// # Errors
/// A value that overflows; stations that become equal.
pub fn round(set: &TableSet, digits: usize) -> Result<(TableSet, Rounding), RoundError> {
    let mut rounding = Rounding {
        digits,
        largest: 0.0,
        at: None,
        stations: false,
    };
    let tables = set
        .tables
        .iter()
        .map(|table| table_rounded(table, &mut rounding))
        .collect::<Result<_, _>>()?;
    Ok((
        TableSet {
            tables,
            ..set.clone()
        },
        rounding,
    ))
}

/// Rounds a table and records each change in `rounding`.
fn table_rounded(table: &Table, rounding: &mut Rounding) -> Result<Table, RoundError> {
    let id = table.id;
    let (x, z) = (table.curves.x(), table.curves.z());
    let mut one = |value: f64, x: f64, z: Option<f64>, station: bool| {
        let nearest = rounded(value, rounding.digits);
        if !nearest.is_finite() {
            return Err(RoundError::Overflow { id });
        }
        if nearest != value {
            // the value is not 0, because rounding does not change 0
            let error = ((nearest - value) / value).abs();
            rounding.stations |= station;
            if rounding.at.is_none() || error > rounding.largest {
                (rounding.largest, rounding.at) = (error, Some((id, x, z)));
            }
        }
        Ok(nearest)
    };
    let first = z.first().copied();
    let new_x = x
        .iter()
        .map(|&x| one(x, x, first, true))
        .collect::<Result<_, _>>()?;
    let new_z = z
        .iter()
        .map(|&z| one(z, x[0], Some(z), true))
        .collect::<Result<_, _>>()?;
    let mut rows = Vec::new();
    for (i, row) in table.curves.y().iter().enumerate() {
        let z = z.get(i).copied();
        let values = row
            .iter()
            .zip(x)
            .map(|(&value, &x)| one(value, x, z, false));
        rows.push(values.collect::<Result<_, _>>()?);
    }
    let curves = SplineValues::new(new_x, new_z, rows).map_err(|_| RoundError::Stations { id })?;
    Ok(Table {
        curves,
        ..table.clone()
    })
}
