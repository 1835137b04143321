//! Tables of a grid at the fewest stations whose errors are within a tolerance.
//!
//! Stations of each rail are searched by [`splines::fewest_stations()`], which considers the direct blocks of this
//! rail. Blocks between two rails or two directions are evaluated afterwards at these stations. Where one of them
//! exceeds the tolerance, all rails are searched again with a tolerance 0.7 times as large, up to six times.

use nalgebra::DMatrix;
use serde_json::{Value, json};
use splines::quality::{BlockExtreme, CouplingBlock, RailDirection, reading_error, sample_places};
use splines::{Axis, Compliance, Error, ExactSurface, InfluenceBlock, SplineTable, StationSearch};

use crate::table_quality::TableReadingMethod;
use formats::grid::block::GridBlock;
use formats::grid::{GridRail, StationGrid, axes};

/// Largest number of stations of a rail.
pub const MAX_STATIONS: usize = 400;
/// Smallest number of places along a rail at which blocks between two rails are evaluated.
const PLACES: usize = 200;
/// Largest number of searches with a smaller tolerance, and the factor between them.
const ROUNDS: usize = 6;
const TIGHTER: f64 = 0.7;

/// The goal of a search.
#[derive(Clone, Debug)]
pub struct StationGoal {
    /// The method by which the tables will be read.
    pub method: TableReadingMethod,
    /// Tolerance, relative to the largest coefficient.
    pub tolerance: f64,
    /// Directions whose errors must be within the tolerance.
    pub axes: Vec<Axis>,
}

/// Stations of one rail.
#[derive(Clone, Debug)]
pub struct ChosenStations {
    /// The name of the rail.
    pub rail: String,
    /// Its stations and the error of the reading at them.
    pub stations: splines::StationSet,
}

/// Error of the reading of one block, relative to the geometric mean of the largest coefficients of its two direct
/// blocks.
#[derive(Clone, Copy, Debug)]
pub struct BlockError {
    /// Paths of deflection and load.
    pub paths: [RailDirection; 2],
    /// Relative error.
    pub error: f64,
    /// The error itself and its place.
    pub worst: BlockExtreme,
}

/// A grid at chosen stations.
pub struct StationChoice {
    /// The grid.
    pub grid: StationGrid,
    /// The stations of its rails.
    pub rails: Vec<ChosenStations>,
    /// Errors of blocks between two rails or directions, and of directions that the goal does not cover.
    pub others: Vec<BlockError>,
}

/// The grid at the fewest stations for the goal, with values from its exact surface.
///
/// # Errors
/// As [`splines::fewest_stations()`]; [`splines::Error::TooFewStations`] where
/// blocks between rails exceed the tolerance.
pub fn choose(
    grid: &StationGrid,
    surface: &ExactSurface,
    goal: &StationGoal,
) -> Result<StationChoice, Error> {
    let mut tolerance = goal.tolerance;
    for round in 0.. {
        let choice = attempt(
            grid,
            surface,
            &StationGoal {
                tolerance,
                ..goal.clone()
            },
        )?;
        let wanted =
            |block: &&BlockError| block.paths.iter().all(|path| goal.axes.contains(&path.1));
        let worst = choice
            .others
            .iter()
            .filter(wanted)
            .map(|block| block.error)
            .fold(0.0, f64::max);
        if worst <= goal.tolerance {
            return Ok(choice);
        }
        if round == ROUNDS {
            return Err(Error::TooFewStations {
                most: choice.grid.size(),
                error: worst,
            });
        }
        tolerance *= TIGHTER;
    }
    Err(Error::NoBlocks)
}

/// One search of all rails.
fn attempt(
    grid: &StationGrid,
    surface: &ExactSurface,
    goal: &StationGoal,
) -> Result<StationChoice, Error> {
    let mut rails = Vec::new();
    for (rail, given) in grid.rails.iter().enumerate() {
        let range = surface.range(rail).ok_or(Error::NoRail { rail })?;
        let search = StationSearch {
            exact: surface,
            rail,
            axes: &goal.axes,
            range,
            fixed: &surface.breaks(rail),
            read: &|blocks: &[InfluenceBlock]| goal.method.read(blocks),
            order: goal.method.order(),
            tolerance: goal.tolerance,
            max_stations: MAX_STATIONS,
        };
        rails.push(ChosenStations {
            rail: given.name.clone(),
            stations: splines::fewest_stations(&search)?,
        });
    }
    let named = |rail: &ChosenStations| GridRail {
        name: rail.rail.clone(),
        stations: rail.stations.at.clone(),
    };
    let grid = at(grid, surface, rails.iter().map(named).collect())?;
    let others = others(&grid, surface, goal)?;
    Ok(StationChoice {
        grid,
        rails,
        others,
    })
}

/// The same blocks at other stations.
///
/// # Errors
/// A station beyond its rail.
pub fn at(
    grid: &StationGrid,
    surface: &ExactSurface,
    rails: Vec<GridRail>,
) -> Result<StationGrid, Error> {
    let mut out = StationGrid {
        rails,
        effects: None,
        ..grid.clone()
    };
    for (quantity, block) in &mut out.blocks {
        let (deflection, load) = axes(*quantity);
        let parts = out.rails.iter().enumerate().map(|(r, row)| {
            let parts = out.rails.iter().enumerate().map(|(c, column)| {
                let block = CouplingBlock {
                    compliance: surface,
                    deflection: (r, deflection),
                    load: (c, load),
                };
                block.matrix(&row.stations, &column.stations)
            });
            parts.collect::<Result<Vec<_>, _>>()
        });
        let parts = parts.collect::<Result<Vec<_>, Error>>()?;
        *block = assemble(&parts);
    }
    Ok(out)
}

/// One matrix from blocks by rows and columns of rails.
fn assemble(parts: &[Vec<DMatrix<f64>>]) -> DMatrix<f64> {
    let rows = parts
        .iter()
        .map(|row| row.first().map_or(0, DMatrix::nrows))
        .sum();
    let columns = parts
        .first()
        .map_or(0, |row| row.iter().map(DMatrix::ncols).sum());
    let mut out = DMatrix::zeros(rows, columns);
    let mut top = 0;
    for row in parts {
        let mut left = 0;
        for part in row {
            out.view_mut((top, left), part.shape()).copy_from(part);
            left += part.ncols();
        }
        top += row.first().map_or(0, DMatrix::nrows);
    }
    out
}

/// Errors of the blocks that the searches of single rails do not consider.
fn others(
    grid: &StationGrid,
    surface: &ExactSurface,
    goal: &StationGoal,
) -> Result<Vec<BlockError>, Error> {
    if goal.method == TableReadingMethod::Exact {
        return Ok(Vec::new());
    }
    let blocks = blocks(grid)?;
    let reading = goal.method.read(&blocks)?;
    let at_rails: Vec<Vec<f64>> = grid
        .rails
        .iter()
        .map(|rail| {
            let range = [rail.stations[0], rail.stations[rail.stations.len() - 1]];
            sample_places(&rail.stations, range, PLACES.max(3 * rail.stations.len()))
        })
        .collect();
    let largest = |(rail, axis): RailDirection| {
        let at = &at_rails[rail];
        Ok::<f64, Error>(
            CouplingBlock::direct(surface, (rail, axis))
                .matrix(at, at)?
                .amax(),
        )
    };
    let mut out = Vec::new();
    for InfluenceBlock {
        deflection, load, ..
    } in &blocks
    {
        let own = deflection.0 == load.0;
        if own && goal.axes.contains(&deflection.1) && goal.axes.contains(&load.1) {
            continue;
        }
        let pair = [reading.as_ref(), surface as &dyn Compliance].map(|compliance| CouplingBlock {
            compliance,
            deflection: *deflection,
            load: *load,
        });
        let error_of_block = reading_error(
            &pair[0],
            &pair[1],
            &at_rails[load.0],
            &at_rails[deflection.0],
        )?;
        let scale = (largest(*deflection)? * largest(*load)?).sqrt();
        let error = if scale > 0.0 {
            error_of_block.largest.value.abs() / scale
        } else {
            0.0
        };
        out.push(BlockError {
            paths: [*deflection, *load],
            error,
            worst: error_of_block.largest,
        });
    }
    Ok(out)
}

/// All blocks as tables: a direct block between two rails once, couplings in both orders.
fn blocks(grid: &StationGrid) -> Result<Vec<InfluenceBlock>, Error> {
    let mut out = Vec::new();
    let mut top = 0;
    for (r, row) in grid.rails.iter().enumerate() {
        let mut left = 0;
        for (c, column) in grid.rails.iter().enumerate() {
            for (quantity, block) in &grid.blocks {
                let (deflection, load) = axes(*quantity);
                if r <= c || deflection != load {
                    let values =
                        block.view((top, left), (row.stations.len(), column.stations.len()));
                    let table = SplineTable::new(
                        column.stations.clone(),
                        row.stations.clone(),
                        values.into_owned(),
                    )?;
                    out.push(InfluenceBlock {
                        deflection: (r, deflection),
                        load: (c, load),
                        table,
                    });
                }
            }
            left += column.stations.len();
        }
        top += row.stations.len();
    }
    Ok(out)
}

impl StationChoice {
    /// The stations and their errors as JSON.
    #[must_use]
    pub fn json(&self, goal: &StationGoal) -> Value {
        let name = |path: RailDirection| json!({ "rail": self.grid.rails[path.0].name, "axis": word(path.1) });
        let error = |paths: [RailDirection; 2], relative: f64, worst: BlockExtreme| {
            json!({
                "relative": relative, "value": worst.value, "x": worst.x, "z": worst.z,
                "deflection": name(paths[0]), "load": name(paths[1]),
            })
        };
        let rails = self.rails.iter().map(|rail| {
            let found = &rail.stations;
            json!({
                "name": rail.rail, "count": found.at.len(), "stations": found.at,
                "error": error(found.directions, found.error, found.worst),
            })
        });
        let others = self
            .others
            .iter()
            .map(|block| error(block.paths, block.error, block.worst));
        json!({
            "format": "girderway-stations/1",
            "reading": goal.method.word(),
            "tolerance": goal.tolerance,
            "rails": rails.collect::<Vec<_>>(),
            "others": others.collect::<Vec<_>>(),
        })
    }

    /// The stations and their errors as text: one line for each rail, and one for directions outside the goal.
    #[must_use]
    pub fn lines(&self, goal: &StationGoal) -> Vec<String> {
        let mut out: Vec<String> = self
            .rails
            .iter()
            .map(|rail| {
                let found = &rail.stations;
                format!(
                    "rail {}: {} stations, {} has an error of at most {:.2e} ({} deflection under {} load, x = {:.4}, \
                     z = {:.4})",
                    rail.rail,
                    found.at.len(),
                    goal.method.word(),
                    found.error,
                    word(found.directions[0].1),
                    word(found.directions[1].1),
                    found.worst.x,
                    found.worst.z,
                )
            })
            .collect();
        let wanted =
            |block: &BlockError| block.paths.iter().all(|path| goal.axes.contains(&path.1));
        let worst = |within: bool| {
            let blocks = self.others.iter().filter(|block| wanted(block) == within);
            blocks.max_by(|a, b| a.error.total_cmp(&b.error))
        };
        let describe = |block: &BlockError| {
            let [(r, deflection), (c, load)] = block.paths;
            let [row, column] = [r, c].map(|rail| self.grid.rails[rail].name.as_str());
            format!(
                "{:.2e} ({} deflection of rail {row} under {} load on rail {column})",
                block.error,
                word(deflection),
                word(load)
            )
        };
        if let Some(block) = worst(true) {
            out.push(format!("between rails: {}", describe(block)));
        }
        if let Some(block) = worst(false) {
            out.push(format!(
                "note: directions that were not requested have errors up to {}",
                describe(block)
            ));
        }
        out
    }
}

/// Directions that a goal covers by default: vertical and lateral, as far as the grid has them.
#[must_use]
pub fn usual(grid: &StationGrid) -> Vec<Axis> {
    let both = [
        (GridBlock::Vertical, Axis::Vertical),
        (GridBlock::Lateral, Axis::Lateral),
    ];
    let known: Vec<Axis> = both
        .into_iter()
        .filter(|(quantity, _)| grid.block(*quantity).is_some())
        .map(|(_, axis)| axis)
        .collect();
    if known.is_empty() {
        vec![Axis::Longitudinal]
    } else {
        known
    }
}

/// The word of a direction.
#[must_use]
pub const fn word(axis: Axis) -> &'static str {
    match axis {
        Axis::Longitudinal => "longitudinal",
        Axis::Vertical => "vertical",
        Axis::Lateral => "lateral",
    }
}
