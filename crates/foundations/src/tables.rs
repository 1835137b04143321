//! Foundations without mass: influence functions, either exact or interpolated in tables.

use formats::grid::axes;
use formats::scene::{Origin, Structure, TableInterpolation};
use nalgebra::DMatrix;
use sim::Foundation;
use splines::{
    Axis, Couplings, InfluenceBlock, Probe, ReadingMethod, SplineTable, TableReading, Uncoupled,
};

use crate::error::Error;
use crate::solved::SolvedModel;

/// The influence functions of a structure as its foundation. The exact surface of its solution is used where the
/// scene specifies the reading "exact" and the surface has been computed; otherwise tables at the stations are
/// interpolated as the scene specifies.
pub(crate) fn influence(
    structure: &Structure,
    solved: Option<&SolvedModel>,
) -> Result<Foundation, Error> {
    let rails = structure.rails.len();
    let exact = structure.interpolation == TableInterpolation::Exact;
    if let (true, Some(surface)) = (exact, solved.and_then(|solved| solved.surface.as_ref())) {
        let surface = surface.clone();
        return Ok(match structure.couplings {
            Couplings::All => Foundation::massless(Box::new(surface), rails),
            some => Foundation::massless(Box::new(Uncoupled::new(surface, some)), rails),
        });
    }
    let blocks = influence_blocks(structure, solved)?;
    let kind = match structure.interpolation {
        // a table of values has no exact surface; natural splines are exact for loads and supports at the stations
        TableInterpolation::Exact | TableInterpolation::Natural => ReadingMethod::Natural,
        TableInterpolation::Akispl => ReadingMethod::Akispl,
        TableInterpolation::Cubspl => ReadingMethod::Cubspl,
    };
    let reading = TableReading::new(kind, &blocks).map_err(Error::rails(&structure.name))?;
    Ok(Foundation::massless(Box::new(reading), rails))
}

/// The influence coefficients of a structure at its stations: one block for each pair of (rail, direction) that the
/// couplings of the structure include. Values are deflections (rows) due to unit loads (columns).
///
/// # Errors
/// [`Error::Unsolved`] for a spec without solution; [`Error::Rails`] for values or stations that are not a valid
/// table.
pub fn influence_blocks(
    structure: &Structure,
    solved: Option<&SolvedModel>,
) -> Result<Vec<InfluenceBlock>, Error> {
    let mut blocks = Vec::new();
    let mut add =
        |row: (usize, Axis), column: (usize, Axis), stations: [&[f64]; 2], values: DMatrix<f64>| {
            let probe = |(rail, axis)| Probe { rail, x: 0.0, axis };
            if !structure.couplings.keep(&probe(row), &probe(column)) {
                return Ok(());
            }
            let [at, loads] = stations.map(<[f64]>::to_vec);
            let table =
                SplineTable::new(loads, at, values).map_err(Error::rails(&structure.name))?;
            blocks.push(InfluenceBlock {
                deflection: row,
                load: column,
                table,
            });
            Ok::<(), Error>(())
        };
    match (&structure.origin, solved) {
        (Origin::Tables { tables, .. }, _) => {
            for (axis, values) in [
                (Axis::Vertical, &tables.vertical),
                (Axis::Lateral, &tables.lateral),
            ] {
                if let Some(values) = values {
                    let n = tables.stations.len();
                    let matrix = DMatrix::from_fn(n, n, |i, j| values[i][j]);
                    add((0, axis), (0, axis), [&tables.stations; 2], matrix)?;
                }
            }
        }
        (Origin::Spec { .. }, Some(solved)) => {
            let mut first_row = 0;
            for (r, row) in solved.rails.iter().enumerate() {
                let mut first_column = 0;
                for (c, column) in solved.rails.iter().enumerate() {
                    let stations: [&[f64]; 2] = [&row.stations, &column.stations];
                    let size = stations.map(<[f64]>::len);
                    for (quantity, grid) in &solved.grid.blocks {
                        let (a, b) = axes(*quantity);
                        // G is symmetric: only one of a block and its transpose is stored
                        if a != b || r <= c {
                            let block = grid
                                .view((first_row, first_column), (size[0], size[1]))
                                .into_owned();
                            add((r, a), (c, b), stations, block)?;
                        }
                    }
                    first_column += column.stations.len();
                }
                first_row += row.stations.len();
            }
        }
        (Origin::Spec { .. }, None) => {
            return Err(Error::Unsolved {
                structure: structure.name.clone(),
            });
        }
    }
    Ok(blocks)
}
