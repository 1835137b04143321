//! Tables of a grid at the fewest stations that keep a tolerance.

use nalgebra::DMatrix;
use serde_json::{Value, json};
use splines::check::{Extreme, Strip, Way, deviation, places};
use splines::{Axis, Compliance, Error, Search, Sheet, Surface, Table};

use crate::table_quality::TableReadingMethod;
use formats::block::GridBlock;
use formats::grid::{Grid, GridRail, axes};

/// The most stations of a rail.
pub const MOST: usize = 400;
/// Places along a rail where blocks between two rails are looked at.
const PLACES: usize = 200;
/// Rounds of a tighter tolerance, where blocks between two rails need one, and by how much it is tightened.
const ROUNDS: usize = 6;
const TIGHTER: f64 = 0.7;

/// What is wanted.
#[derive(Clone, Debug)]
pub struct StationGoal {
    /// How the tables will be read.
    pub manner: TableReadingMethod,
    /// Error allowed, of the largest coefficient.
    pub tolerance: f64,
    /// Directions that must keep it.
    pub axes: Vec<Axis>,
}

/// Stations of one rail.
#[derive(Clone, Debug)]
pub struct ChosenStations {
    /// The rail's name.
    pub rail: String,
    /// Its stations and the error of the reading at them.
    pub stations: splines::Stations,
}

/// Error of the reading of one block, of the geometric mean of its directions' largest coefficients.
#[derive(Clone, Copy, Debug)]
pub struct BlockError {
    /// Deflection and load.
    pub ways: [Way; 2],
    /// Relative.
    pub error: f64,
    /// The error itself, and where.
    pub worst: Extreme,
}

/// A grid at chosen stations.
pub struct StationChoice {
    /// The grid.
    pub grid: Grid,
    /// Its rails.
    pub rails: Vec<ChosenStations>,
    /// Blocks between two rails, and those that the goal leaves out.
    pub others: Vec<BlockError>,
}

/// The grid at the fewest stations found for the goal, from its exact surface.
///
/// # Errors
/// As [`splines::stations()`].
pub fn choose(grid: &Grid, surface: &Surface, goal: &StationGoal) -> Result<StationChoice, Error> {
    let mut tolerance = goal.tolerance;
    for round in 0.. {
        let choice = attempt(grid, surface, &StationGoal { tolerance, ..goal.clone() })?;
        let wanted = |block: &&BlockError| block.ways.iter().all(|way| goal.axes.contains(&way.1));
        let worst = choice.others.iter().filter(wanted).map(|block| block.error).fold(0.0, f64::max);
        if worst <= goal.tolerance {
            return Ok(choice);
        }
        if round == ROUNDS {
            return Err(Error::Stations { most: choice.grid.size(), error: worst });
        }
        tolerance *= TIGHTER;
    }
    Err(Error::NoSheets)
}

fn attempt(grid: &Grid, surface: &Surface, goal: &StationGoal) -> Result<StationChoice, Error> {
    let mut rails = Vec::new();
    for (rail, given) in grid.rails.iter().enumerate() {
        let range = surface.range(rail).ok_or(Error::NoRail { rail })?;
        let search = Search {
            exact: surface,
            rail,
            axes: &goal.axes,
            range,
            fixed: &surface.breaks(rail),
            read: &|sheets: &[Sheet]| goal.manner.read(sheets),
            order: goal.manner.order(),
            tolerance: goal.tolerance,
            most: MOST,
        };
        rails.push(ChosenStations { rail: given.name.clone(), stations: splines::stations(&search)? });
    }
    let named =
        |rail: &ChosenStations| GridRail { name: rail.rail.clone(), stations: rail.stations.at.clone() };
    let grid = at(grid, surface, rails.iter().map(named).collect())?;
    let others = others(&grid, surface, goal)?;
    Ok(StationChoice { grid, rails, others })
}

/// The same blocks at other stations.
///
/// # Errors
/// A station beyond its rail.
pub fn at(grid: &Grid, surface: &Surface, rails: Vec<GridRail>) -> Result<Grid, Error> {
    let mut out = Grid { rails, effects: None, ..grid.clone() };
    for (quantity, block) in &mut out.blocks {
        let (deflection, load) = axes(*quantity);
        let parts = out.rails.iter().enumerate().map(|(r, row)| {
            let parts = out.rails.iter().enumerate().map(|(c, column)| {
                let strip = Strip { compliance: surface, deflection: (r, deflection), load: (c, load) };
                strip.block(&row.stations, &column.stations)
            });
            parts.collect::<Result<Vec<_>, _>>()
        });
        let parts = parts.collect::<Result<Vec<_>, Error>>()?;
        *block = assemble(&parts);
    }
    Ok(out)
}

fn assemble(parts: &[Vec<DMatrix<f64>>]) -> DMatrix<f64> {
    let rows = parts.iter().map(|row| row.first().map_or(0, DMatrix::nrows)).sum();
    let columns = parts.first().map_or(0, |row| row.iter().map(DMatrix::ncols).sum());
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

/// Errors of the blocks that no rail's own search has seen.
fn others(grid: &Grid, surface: &Surface, goal: &StationGoal) -> Result<Vec<BlockError>, Error> {
    if goal.manner == TableReadingMethod::Exact {
        return Ok(Vec::new());
    }
    let sheets = sheets(grid)?;
    let reading = goal.manner.read(&sheets)?;
    let spots: Vec<Vec<f64>> = grid
        .rails
        .iter()
        .map(|rail| {
            let range = [rail.stations[0], rail.stations[rail.stations.len() - 1]];
            places(&rail.stations, range, PLACES.max(3 * rail.stations.len()))
        })
        .collect();
    let largest = |(rail, axis): Way| {
        let at = &spots[rail];
        Ok::<f64, Error>(Strip::direct(surface, (rail, axis)).block(at, at)?.amax())
    };
    let mut out = Vec::new();
    for Sheet { deflection, load, .. } in &sheets {
        let own = deflection.0 == load.0;
        if own && goal.axes.contains(&deflection.1) && goal.axes.contains(&load.1) {
            continue;
        }
        let strips = [reading.as_ref(), surface as &dyn Compliance].map(|compliance| Strip {
            compliance,
            deflection: *deflection,
            load: *load,
        });
        let found = deviation(&strips[0], &strips[1], &spots[load.0], &spots[deflection.0])?;
        let scale = (largest(*deflection)? * largest(*load)?).sqrt();
        let error = if scale > 0.0 { found.largest.value.abs() / scale } else { 0.0 };
        out.push(BlockError { ways: [*deflection, *load], error, worst: found.largest });
    }
    Ok(out)
}

/// All blocks as tables: of two rails a direct one once, couplings both ways.
fn sheets(grid: &Grid) -> Result<Vec<Sheet>, Error> {
    let mut out = Vec::new();
    let mut top = 0;
    for (r, row) in grid.rails.iter().enumerate() {
        let mut left = 0;
        for (c, column) in grid.rails.iter().enumerate() {
            for (quantity, block) in &grid.blocks {
                let (deflection, load) = axes(*quantity);
                if r <= c || deflection != load {
                    let values = block.view((top, left), (row.stations.len(), column.stations.len()));
                    let table =
                        Table::new(column.stations.clone(), row.stations.clone(), values.into_owned())?;
                    out.push(Sheet { deflection: (r, deflection), load: (c, load), table });
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
        let name = |way: Way| json!({ "rail": self.grid.rails[way.0].name, "axis": word(way.1) });
        let error = |ways: [Way; 2], relative: f64, worst: Extreme| {
            json!({
                "relative": relative, "value": worst.value, "x": worst.x, "z": worst.z,
                "deflection": name(ways[0]), "load": name(ways[1]),
            })
        };
        let rails = self.rails.iter().map(|rail| {
            let found = &rail.stations;
            json!({
                "name": rail.rail, "count": found.at.len(), "stations": found.at,
                "error": error(found.ways, found.error, found.worst),
            })
        });
        let others = self.others.iter().map(|block| error(block.ways, block.error, block.worst));
        json!({
            "format": "girderway-stations/1",
            "reading": goal.manner.word(),
            "tolerance": goal.tolerance,
            "rails": rails.collect::<Vec<_>>(),
            "others": others.collect::<Vec<_>>(),
        })
    }

    /// The same for people, a line a rail and one for what the goal leaves out.
    #[must_use]
    pub fn lines(&self, goal: &StationGoal) -> Vec<String> {
        let mut out: Vec<String> = self
            .rails
            .iter()
            .map(|rail| {
                let found = &rail.stations;
                format!(
                    "rail {}: {} stations, {} errs by {:.2e} at most ({} of {}, x = {:.4}, z = {:.4})",
                    rail.rail,
                    found.at.len(),
                    goal.manner.word(),
                    found.error,
                    word(found.ways[0].1),
                    word(found.ways[1].1),
                    found.worst.x,
                    found.worst.z,
                )
            })
            .collect();
        let wanted = |block: &BlockError| block.ways.iter().all(|way| goal.axes.contains(&way.1));
        let worst = |within: bool| {
            let blocks = self.others.iter().filter(|block| wanted(block) == within);
            blocks.max_by(|a, b| a.error.total_cmp(&b.error))
        };
        let tell = |block: &BlockError| {
            let [(r, deflection), (c, load)] = block.ways;
            let [row, column] = [r, c].map(|rail| self.grid.rails[rail].name.as_str());
            format!(
                "{:.2e} ({} of rail {row} from {} of rail {column})",
                block.error,
                word(deflection),
                word(load)
            )
        };
        if let Some(block) = worst(true) {
            out.push(format!("between rails: {}", tell(block)));
        }
        if let Some(block) = worst(false) {
            out.push(format!("note: directions that were not asked for err by up to {}", tell(block)));
        }
        out
    }
}

/// Directions that a goal covers where the user names none: vertical and lateral, as far as the grid has them.
#[must_use]
pub fn usual(grid: &Grid) -> Vec<Axis> {
    let both = [(GridBlock::Vertical, Axis::Vertical), (GridBlock::Lateral, Axis::Lateral)];
    let known: Vec<Axis> = both
        .into_iter()
        .filter(|(quantity, _)| grid.block(*quantity).is_some())
        .map(|(_, axis)| axis)
        .collect();
    if known.is_empty() { vec![Axis::Longitudinal] } else { known }
}

/// A direction's word.
#[must_use]
pub const fn word(axis: Axis) -> &'static str {
    match axis {
        Axis::Longitudinal => "longitudinal",
        Axis::Vertical => "vertical",
        Axis::Lateral => "lateral",
    }
}
