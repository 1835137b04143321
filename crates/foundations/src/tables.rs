//! Foundations without mass: influence functions, exact or read from tables.

use formats::grid::axes;
use formats::scene::{Origin, Reading as Words, Structure};
use nalgebra::DMatrix;
use sim::Foundation;
use splines::{Axis, Couplings, Kind, Parted, Probe, Reading, Sheet, Table};

use crate::error::Error;
use crate::solved::SolvedModel;

/// Influence functions of a structure as its foundation.
pub(crate) fn influence(structure: &Structure, solved: Option<&SolvedModel>) -> Result<Foundation, Error> {
    let rails = structure.rails.len();
    let exact = structure.reading == Words::Exact;
    if let (true, Some(surface)) = (exact, solved.and_then(|solved| solved.surface.as_ref())) {
        let surface = surface.clone();
        return Ok(match structure.couplings {
            Couplings::All => Foundation::influence(Box::new(surface), rails),
            some => Foundation::influence(Box::new(Parted::new(surface, some)), rails),
        });
    }
    let sheets = influence_blocks(structure, solved)?;
    let kind = match structure.reading {
        // A table of values alone has no exact form; its natural splines are the closest reading.
        Words::Exact | Words::Natural => Kind::Natural,
        Words::Akispl => Kind::Akispl,
        Words::Cubspl => Kind::Cubspl,
    };
    let reading = Reading::new(kind, &sheets).map_err(Error::rails(&structure.name))?;
    Ok(Foundation::influence(Box::new(reading), rails))
}

/// The tables of a structure: its direct grids and the couplings that count, station by station.
///
/// # Errors
/// A spec that has not been solved; what a table refuses.
pub fn influence_blocks(structure: &Structure, solved: Option<&SolvedModel>) -> Result<Vec<Sheet>, Error> {
    let mut sheets = Vec::new();
    let mut add = |row: (usize, Axis), column: (usize, Axis), stations: [&[f64]; 2], values: DMatrix<f64>| {
        let probe = |(rail, axis)| Probe { rail, x: 0.0, axis };
        if !structure.couplings.keep(&probe(row), &probe(column)) {
            return Ok(());
        }
        let [at, loads] = stations.map(<[f64]>::to_vec);
        let table = Table::new(loads, at, values).map_err(Error::rails(&structure.name))?;
        sheets.push(Sheet { deflection: row, load: column, table });
        Ok::<(), Error>(())
    };
    match (&structure.origin, solved) {
        (Origin::Tables { tables, .. }, _) => {
            for (axis, values) in [(Axis::Vertical, &tables.vertical), (Axis::Lateral, &tables.lateral)] {
                if let Some(values) = values {
                    let n = tables.stations.len();
                    let matrix = DMatrix::from_fn(n, n, |i, j| values[i][j]);
                    add((0, axis), (0, axis), [&tables.stations; 2], matrix)?;
                }
            }
        }
        (Origin::Spec { .. }, Some(solved)) => {
            let mut first = 0;
            for (r, row) in solved.rails.iter().enumerate() {
                let mut left = 0;
                for (c, column) in solved.rails.iter().enumerate() {
                    let stations: [&[f64]; 2] = [&row.stations, &column.stations];
                    let size = stations.map(<[f64]>::len);
                    for (quantity, grid) in &solved.grid.blocks {
                        let (a, b) = axes(*quantity);
                        // one of (row, column) and (column, row) is enough where both are the same block
                        if a != b || r <= c {
                            let block = grid.view((first, left), (size[0], size[1])).into_owned();
                            add((r, a), (c, b), stations, block)?;
                        }
                    }
                    left += column.stations.len();
                }
                first += row.stations.len();
            }
        }
        (Origin::Spec { .. }, None) => {
            return Err(Error::Unsolved { structure: structure.name.clone() });
        }
    }
    Ok(sheets)
}
