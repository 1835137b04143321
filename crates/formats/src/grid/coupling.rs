//! Strength of the coupling between the directions of a structure, and the error caused by neglecting it.

use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Value, json};

use super::block::GridBlock;
use super::influence::StationGrid;
use crate::text::number::number;

crate::text::object::objects!(RawCoupling, RawDropped, RawChange);

/// Lateral load used for the coupling error, as a fraction of the wheel load.
pub const LATERAL_LOAD_FRACTION: f64 = 0.1;

/// Compliance, relative to the largest, below which a station is considered fixed. Smaller values are rounding
/// errors.
const FIXED: f64 = 1e-9;

/// Relative coupling below which the summary is omitted.
const NEGLIGIBLE: f64 = 1e-3;

/// Strength of the couplings of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Coupling {
    /// Largest |G_ab(i, j)| / sqrt(G_aa(i, i) G_bb(j, j)) over all pairs of stations, for each coupling of the grid.
    /// It lies in 0..=1 except for rounding.
    pub largest: Vec<(GridBlock, f64)>,
    /// Error of the deflections if the coupling of vertical and lateral directions is neglected.
    pub error: Option<CouplingError>,
}

/// Relative change of the deflections of a station if the coupling of vertical and lateral directions is neglected.
///
/// A wheel load F and a lateral load of [`LATERAL_LOAD_FRACTION`] F at a station deflect it vertically by G_vv F +
/// G_vl 0.1 F and laterally by G_ll 0.1 F + G_lv F. The second terms are neglected; the change is the ratio of the
/// second term to the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CouplingError {
    /// Vertical deflection.
    pub vertical: Change,
    /// Lateral deflection.
    pub lateral: Change,
}

/// Statistics of a relative change over the stations that are not fixed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// Median.
    pub median: f64,
    /// Largest.
    pub largest: f64,
}

impl Coupling {
    /// The couplings of a grid; `None` if the grid has no coupling block.
    #[must_use]
    pub fn of(grid: &StationGrid) -> Option<Coupling> {
        let mut largest = Vec::new();
        for (quantity, block) in &grid.blocks {
            let [row, column] = quantity.direct();
            if row == column {
                continue;
            }
            if let (Some(a), Some(b)) = (grid.block(row), grid.block(column)) {
                largest.push((*quantity, relative(block, a, b)));
            }
        }
        let blocks = [
            GridBlock::Vertical,
            GridBlock::Lateral,
            GridBlock::VerticalLateral,
        ]
        .map(|q| grid.block(q));
        let cost = match blocks {
            [Some(vertical), Some(lateral), Some(coupling)] => {
                let vertical = change(coupling, vertical, LATERAL_LOAD_FRACTION);
                let lateral = change(coupling, lateral, 1.0 / LATERAL_LOAD_FRACTION);
                vertical
                    .zip(lateral)
                    .map(|(vertical, lateral)| CouplingError { vertical, lateral })
            }
            _ => None,
        };
        (!largest.is_empty()).then_some(Coupling {
            largest,
            error: cost,
        })
    }

    /// The member `coupling` of a grid file.
    #[must_use]
    pub fn json(&self) -> Value {
        let mut object = serde_json::Map::new();
        for (quantity, relative) in &self.largest {
            object.insert(quantity.name().to_owned(), json!(relative));
        }
        if let Some(cost) = &self.error {
            let change =
                |change: Change| json!({ "median": change.median, "largest": change.largest });
            let dropped = json!({
                "side_load": LATERAL_LOAD_FRACTION, "vertical": change(cost.vertical), "lateral": change(cost.lateral),
            });
            object.insert("dropped".to_owned(), dropped);
        }
        Value::Object(object)
    }

    /// One line for the terminal; `None` if the relative coupling of vertical and lateral directions is below 1e-3.
    #[must_use]
    pub fn summary(&self) -> Option<String> {
        let (_, relative) = self
            .largest
            .iter()
            .find(|(quantity, _)| *quantity == GridBlock::VerticalLateral)?;
        let cost = self.error.filter(|_| *relative >= NEGLIGIBLE)?;
        let percent = |change: Change| {
            format!(
                "{:.1} % (median; at most {:.1} %)",
                100.0 * change.median,
                100.0 * change.largest
            )
        };
        Some(format!(
            "coupling: the vertical-lateral coefficients are up to {relative:.3} of sqrt(Gvv Gll); under a side load \
             of {} of the wheel load, neglecting them changes the lateral deflection by {} and the vertical deflection \
             by {}",
            number(LATERAL_LOAD_FRACTION),
            percent(cost.lateral),
            percent(cost.vertical),
        ))
    }
}

/// Returns a function that determines from the diagonal of a direct block whether a station is not fixed.
fn moving(block: &DMatrix<f64>) -> impl Fn(usize) -> bool + '_ {
    let least = FIXED * block.diagonal().amax();
    move |i| block[(i, i)] > least
}

/// Largest |G_ab(i, j)| / sqrt(G_aa(i, i) G_bb(j, j)), with `row` G_aa and `column` G_bb.
fn relative(coupling: &DMatrix<f64>, row: &DMatrix<f64>, column: &DMatrix<f64>) -> f64 {
    let (row_moves, column_moves) = (moving(row), moving(column));
    let mut largest = 0.0_f64;
    for i in (0..row.nrows()).filter(|&i| row_moves(i)) {
        for j in (0..row.nrows()).filter(|&j| column_moves(j)) {
            largest =
                largest.max(coupling[(i, j)].abs() / (row[(i, i)].sqrt() * column[(j, j)].sqrt()));
        }
    }
    largest
}

/// Median and largest of |coupling(i, i)| `factor` / direct(i, i) over the stations that are not fixed.
fn change(coupling: &DMatrix<f64>, direct: &DMatrix<f64>, factor: f64) -> Option<Change> {
    let moves = moving(direct);
    let stations = (0..direct.nrows()).filter(|&i| moves(i));
    let mut changes: Vec<f64> = stations
        .map(|i| coupling[(i, i)].abs() * factor / direct[(i, i)])
        .collect();
    changes.sort_by(f64::total_cmp);
    let n = changes.len();
    let largest = *changes.last()?;
    Some(Change {
        median: 0.5 * (changes[(n - 1) / 2] + changes[n / 2]),
        largest,
    })
}

/// Size of the coupling of directions, for information: it follows from the grids.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawCoupling {
    /// Largest |G_ab(i, j)| / sqrt(G_aa(i, i) G_bb(j, j)) of vertical and lateral.
    #[serde(rename = "vertical_lateral")]
    _vertical_lateral: Option<f64>,
    /// Largest |G_ab(i, j)| / sqrt(G_aa(i, i) G_bb(j, j)) of vertical and longitudinal.
    #[serde(rename = "vertical_longitudinal")]
    _vertical_longitudinal: Option<f64>,
    /// Largest |G_ab(i, j)| / sqrt(G_aa(i, i) G_bb(j, j)) of lateral and longitudinal.
    #[serde(rename = "lateral_longitudinal")]
    _lateral_longitudinal: Option<f64>,
    /// Error of leaving out the coupling of vertical and lateral.
    #[serde(rename = "dropped")]
    _dropped: Option<RawDropped>,
}

/// Error of leaving out the coupling of vertical and lateral, under a wheel load and a side load at one station.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
struct RawDropped {
    /// Side load as a fraction of the wheel load.
    #[serde(rename = "side_load")]
    _side_load: f64,
    /// Relative error of the vertical deflection.
    #[serde(rename = "vertical")]
    _vertical: RawChange,
    /// Relative error of the lateral deflection.
    #[serde(rename = "lateral")]
    _lateral: RawChange,
}

/// Relative error over the stations.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
struct RawChange {
    /// Median.
    #[serde(rename = "median")]
    _median: f64,
    /// Largest value.
    #[serde(rename = "largest")]
    _largest: f64,
}
