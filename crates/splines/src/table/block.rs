//! Tables of values and the rail directions that they relate.

use super::values::SplineTable;
use crate::error::Error;
use crate::probe::{Axis, Probe};

/// Distance beyond the stations, relative to the largest of their coordinates, that counts as rounding.
const ROUNDING: f64 = 1e-12;

/// One table of influence coefficients with the direction of its deflections and that of its loads. A
/// direction is a rail and an axis.
///
/// ```
/// use nalgebra::DMatrix;
/// use splines::{Axis, InfluenceBlock, SplineTable};
///
/// let x = vec![0.0, 1.0, 2.0, 3.0];
/// let table = SplineTable::new(x.clone(), x, DMatrix::identity(4, 4))?;
/// // Lateral deflections of the first rail under its own vertical loads.
/// let coupling = InfluenceBlock { deflection: (0, Axis::Lateral), load: (0, Axis::Vertical), table };
/// assert_ne!(coupling.deflection, coupling.load);
/// # Ok::<(), splines::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct InfluenceBlock {
    /// Rail and axis of the deflection, whose stations are the table's z.
    pub deflection: (usize, Axis),
    /// Rail and axis of the load, whose stations are the table's x.
    pub load: (usize, Axis),
    /// The influence coefficients, length/force.
    pub table: SplineTable,
}

/// The directions that have tables, numbered in increasing order of rail and axis.
#[derive(Clone, Debug)]
pub(super) struct Directions {
    /// Rail and axis of each.
    pub names: Vec<(usize, Axis)>,
    /// First and last coordinate at which each is tabulated.
    pub ranges: Vec<[f64; 2]>,
    /// Stations of all tables that involve each, in no order.
    pub stations: Vec<Vec<f64>>,
}

/// Index of the table of a deflection and a load, `[deflection][load]`, directions by number.
pub(super) type Pairs = Vec<Vec<Option<usize>>>;

impl Directions {
    /// Numbers the directions of tables and finds the table of every pair.
    ///
    /// # Errors
    /// No table; two tables for one pair; a coupling between directions of which one has no table of its own;
    /// a table with fewer than two curves.
    pub fn new(blocks: &[InfluenceBlock]) -> Result<(Directions, Pairs), Error> {
        if blocks.is_empty() {
            return Err(Error::NoBlocks);
        }
        let mut names: Vec<(usize, Axis)> = blocks
            .iter()
            .filter(|s| s.deflection == s.load)
            .map(|s| s.load)
            .collect();
        names.sort_unstable();
        names.dedup();
        let mut pairs = vec![vec![None; names.len()]; names.len()];
        for (index, sheet) in blocks.iter().enumerate() {
            let number = |name| {
                names
                    .binary_search(&name)
                    .map_err(|_| Error::BlockAlone { sheet: index })
            };
            let (i, j) = (number(sheet.deflection)?, number(sheet.load)?);
            if pairs[i][j].is_some() || pairs[j][i].is_some() {
                return Err(Error::BlockTwice { sheet: index });
            }
            if sheet.table.z().len() < 2 {
                return Err(Error::TooFewPoints {
                    found: sheet.table.z().len(),
                    least: 2,
                });
            }
            pairs[i][j] = Some(index);
        }
        let mut ranges = vec![[f64::NEG_INFINITY, f64::INFINITY]; names.len()];
        let mut stations = vec![Vec::new(); names.len()];
        for (i, row) in pairs.iter().enumerate() {
            for (j, index) in row.iter().enumerate() {
                let Some(index) = *index else { continue };
                let table = &blocks[index].table;
                for (direction, points) in [(i, table.z()), (j, table.x())] {
                    ranges[direction][0] = ranges[direction][0].max(points[0]);
                    ranges[direction][1] = ranges[direction][1].min(points[points.len() - 1]);
                    stations[direction].extend_from_slice(points);
                }
            }
        }
        Ok((
            Directions {
                names,
                ranges,
                stations,
            },
            pairs,
        ))
    }

    /// Number of the direction of a probe, and its place, which rounding may have moved beyond the stations.
    ///
    /// # Errors
    /// A rail or a direction without a table, or a place beyond its stations.
    pub fn find(&self, p: Probe) -> Result<(usize, f64), Error> {
        let Ok(direction) = self.names.binary_search(&(p.rail, p.axis)) else {
            let known = self.names.iter().any(|name| name.0 == p.rail);
            return Err(if known {
                Error::NoStiffness {
                    rail: p.rail,
                    x: p.x,
                    axis: p.axis,
                }
            } else {
                Error::NoRail { rail: p.rail }
            });
        };
        let [first, last] = self.ranges[direction];
        let slack = ROUNDING * first.abs().max(last.abs());
        if p.x >= first - slack && p.x <= last + slack {
            Ok((direction, p.x.max(first).min(last)))
        } else {
            Err(Error::OffRail {
                rail: p.rail,
                x: p.x,
            })
        }
    }

    /// All stations of a rail, increasing, each once.
    pub fn breaks(&self, rail: usize) -> Vec<f64> {
        let mut out: Vec<f64> = self
            .of_rail(rail, &self.stations)
            .flatten()
            .copied()
            .collect();
        out.sort_by(f64::total_cmp);
        out.dedup();
        out
    }

    /// First and last coordinate at which every direction of a rail is tabulated.
    pub fn range(&self, rail: usize) -> Option<[f64; 2]> {
        self.of_rail(rail, &self.ranges)
            .copied()
            .reduce(|a, b| [a[0].max(b[0]), a[1].min(b[1])])
    }

    fn of_rail<'a, T>(&'a self, rail: usize, all: &'a [T]) -> impl Iterator<Item = &'a T> {
        self.names
            .iter()
            .zip(all)
            .filter(move |(name, _)| name.0 == rail)
            .map(|(_, item)| item)
    }
}

/// The stations of each direction's own table, after checking that every coupling is tabulated at those of
/// its two directions.
///
/// # Errors
/// Stations along z that differ from those along x, or from those of the direction's own table.
pub(super) fn common_stations<'a>(
    pairs: &Pairs,
    blocks: &'a [InfluenceBlock],
) -> Result<Vec<&'a [f64]>, Error> {
    let own = |i: usize| pairs[i][i].map_or(&[][..], |k| blocks[k].table.x());
    for (i, row) in pairs.iter().enumerate() {
        for (j, index) in row.iter().enumerate() {
            let Some(index) = *index else { continue };
            if blocks[index].table.z() != own(i) || blocks[index].table.x() != own(j) {
                return Err(Error::BlockStations { sheet: index });
            }
        }
    }
    Ok((0..pairs.len()).map(own).collect())
}
