//! The SPLINE tables of a grid.

use nalgebra::DMatrix;
use splines::Table;
use splines::adams::{self, DataSet, Spline};

use crate::crosscheck::Quantity;
use crate::exit::Failure;
use crate::grid::Grid;
use crate::units::{Dimension, Force, Length, Units};

/// Identifiers of the paper's tables: the first rail's vertical and lateral splines.
const FIRST_ID: u32 = 6;

/// A grid as an ADAMS data set: for every rail a SPLINE of its vertical grid and one of its lateral grid, with
/// x the load's station and z the deflection's. `None` where no rail has the stations that a SPLINE needs.
///
/// # Errors
/// None for a grid that was solved or read.
pub fn data_set(name: &str, grid: &Grid) -> Result<Option<String>, Failure> {
    let mut splines = Vec::new();
    let mut first = 0;
    for rail in &grid.rails {
        let n = rail.stations.len();
        for (quantity, word) in [(Quantity::Vertical, "vertical"), (Quantity::Lateral, "lateral")] {
            let Some(block) = grid.block(quantity) else { continue };
            let values: DMatrix<f64> = block.view((first, first), (n, n)).into_owned();
            let Ok(table) = Table::new(rail.stations.clone(), rail.stations.clone(), values) else { continue };
            let id = FIRST_ID + u32::try_from(splines.len()).unwrap_or(u32::MAX - FIRST_ID);
            let name = Some(format!("{name}_{}_{word}", rail.name).replace(['-', ' '], "_"));
            splines.push(Spline { id, name, units: Some("no_units".to_owned()), linear: true, table });
        }
        first += n;
    }
    if splines.is_empty() {
        return Ok(None);
    }
    let title = format!("{name}: influence coefficients, {} per unit load", grid.units.label(Dimension::FLEXIBILITY));
    let set = DataSet { title: Some(title), units: Some(units(grid.units)), splines };
    let text = adams::write(&set).map_err(|error| Failure::Untrusted(format!("{name}: {error}")))?;
    Ok(Some(text))
}

/// UNITS of a data set. ADAMS reconciles the unit of mass with the others.
fn units(units: Units) -> adams::Units {
    adams::Units {
        force: match units.force {
            Force::Pound => adams::Force::Pound,
            Force::Kip => adams::Force::Kilopound,
            Force::Newton => adams::Force::Newton,
            Force::Kilonewton => adams::Force::Kilonewton,
        },
        mass: match units.length {
            Length::Foot | Length::Inch => adams::Mass::Slug,
            Length::Metre | Length::Millimetre => adams::Mass::Kilogram,
        },
        length: match units.length {
            Length::Foot => adams::Length::Foot,
            Length::Inch => adams::Length::Inch,
            Length::Metre => adams::Length::Meter,
            Length::Millimetre => adams::Length::Millimeter,
        },
    }
}
