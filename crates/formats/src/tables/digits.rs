//! Numbers of few digits.

use adams::SplineValues;
use serde_json::{Value, json};

use super::set::{Table, TableSet};

/// What rounding did.
#[derive(Clone, Debug, PartialEq)]
pub struct Rounding {
    /// Significant digits kept.
    pub digits: usize,
    /// Largest |rounded - given| / |given| over all values and stations.
    pub largest: f64,
    /// Where: table, x and z (none for one curve), as given; `None` where nothing changed.
    pub at: Option<(u32, f64, Option<f64>)>,
    /// Whether stations changed too.
    pub stations: bool,
}

/// A number that cannot be rounded to so few digits.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Unrounded {
    /// A value beyond what a double holds.
    #[error("SPLINE/{id} has a value that overflows when rounded")]
    Overflow {
        /// The table.
        id: u32,
    },
    /// Two stations that become one.
    #[error("SPLINE/{id} has stations that fall together when rounded")]
    Stations {
        /// The table.
        id: u32,
    },
}

impl Rounding {
    /// For people.
    #[must_use]
    pub fn message(&self) -> String {
        let Some((id, x, z)) = self.at else {
            return format!("rounded to {} digits: no number changed", self.digits);
        };
        let z = z.map(|z| format!(", z = {z}")).unwrap_or_default();
        let stations = if self.stations { "; stations changed too" } else { "" };
        let (digits, largest) = (self.digits, self.largest);
        format!(
            "rounded to {digits} digits: by {largest:.2e} of a number at most, SPLINE/{id} at x = {x}{z}{stations}"
        )
    }

    /// For programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let at = self.at.map(|(id, x, z)| json!({ "id": id, "x": x, "z": z }));
        json!({ "digits": self.digits, "largest": self.largest, "at": at, "stations": self.stations })
    }
}

/// Every number rounded to so many significant decimal digits, half to even; what that changed.
///
/// # Errors
/// A number that overflows, stations that fall together.
pub fn round(set: &TableSet, digits: usize) -> Result<(TableSet, Rounding), Unrounded> {
    let mut rounding = Rounding { digits, largest: 0.0, at: None, stations: false };
    let tables =
        set.tables.iter().map(|table| table_rounded(table, &mut rounding)).collect::<Result<_, _>>()?;
    Ok((TableSet { tables, ..set.clone() }, rounding))
}

fn table_rounded(table: &Table, rounding: &mut Rounding) -> Result<Table, Unrounded> {
    let id = table.id;
    let (x, z) = (table.curves.x(), table.curves.z());
    let mut one = |value: f64, x: f64, z: Option<f64>, station: bool| {
        let rounded = nearest(value, rounding.digits);
        if !rounded.is_finite() {
            return Err(Unrounded::Overflow { id });
        }
        if rounded != value {
            // |value| is not 0: zero keeps its digits
            let error = ((rounded - value) / value).abs();
            rounding.stations |= station;
            if rounding.at.is_none() || error > rounding.largest {
                (rounding.largest, rounding.at) = (error, Some((id, x, z)));
            }
        }
        Ok(rounded)
    };
    let first = z.first().copied();
    let new_x = x.iter().map(|&x| one(x, x, first, true)).collect::<Result<_, _>>()?;
    let new_z = z.iter().map(|&z| one(z, x[0], Some(z), true)).collect::<Result<_, _>>()?;
    let mut rows = Vec::new();
    for (i, row) in table.curves.y().iter().enumerate() {
        let z = z.get(i).copied();
        let values = row.iter().zip(x).map(|(&value, &x)| one(value, x, z, false));
        rows.push(values.collect::<Result<_, _>>()?);
    }
    let curves = SplineValues::new(new_x, new_z, rows).map_err(|_| Unrounded::Stations { id })?;
    Ok(Table { curves, ..table.clone() })
}

/// The double nearest to `value` written with `digits` significant decimal digits.
fn nearest(value: f64, digits: usize) -> f64 {
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    text.parse().unwrap_or(f64::INFINITY)
}
