//! Tables of values and the directions that they relate.

use crate::{Axis, Error, Probe, Table};

/// One table and what it relates: a deflection and a load, each of a rail and an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Rail and axis of the deflection, along z.
    pub deflection: (usize, Axis),
    /// Rail and axis of the load, along x.
    pub load: (usize, Axis),
    /// The values.
    pub table: Table,
}

/// Directions by number, increasing, each a rail and an axis, and where they can be asked for.
#[derive(Clone, Debug)]
pub(crate) struct Ways {
    pub names: Vec<(usize, Axis)>,
    pub ranges: Vec<[f64; 2]>,
    /// Stations of all tables that read the direction.
    pub stations: Vec<Vec<f64>>,
}

/// Index of the sheet of a deflection and a load: `[deflection][load]`, directions by number.
pub(crate) type Pairs = Vec<Vec<Option<usize>>>;

impl Ways {
    /// Sorts sheets by their directions.
    ///
    /// # Errors
    /// No sheet; two sheets for one pair; a coupling between directions without tables of their own; a table
    /// with fewer than two curves.
    pub fn new(sheets: &[Sheet]) -> Result<(Ways, Pairs), Error> {
        if sheets.is_empty() {
            return Err(Error::NoSheets);
        }
        let mut names: Vec<(usize, Axis)> =
            sheets.iter().filter(|s| s.deflection == s.load).map(|s| s.load).collect();
        names.sort_unstable();
        names.dedup();
        let mut pairs = vec![vec![None; names.len()]; names.len()];
        for (index, sheet) in sheets.iter().enumerate() {
            let place = |way| names.binary_search(&way).map_err(|_| Error::SheetAlone { sheet: index });
            let (i, j) = (place(sheet.deflection)?, place(sheet.load)?);
            if pairs[i][j].is_some() || pairs[j][i].is_some() {
                return Err(Error::SheetTwice { sheet: index });
            }
            if sheet.table.z().len() < 2 {
                return Err(Error::Points { found: sheet.table.z().len(), least: 2 });
            }
            pairs[i][j] = Some(index);
        }
        let mut ranges = vec![[f64::NEG_INFINITY, f64::INFINITY]; names.len()];
        let mut stations = vec![Vec::new(); names.len()];
        for (i, row) in pairs.iter().enumerate() {
            for (j, index) in row.iter().enumerate() {
                let Some(index) = *index else { continue };
                let table = &sheets[index].table;
                for (way, points) in [(i, table.z()), (j, table.x())] {
                    ranges[way][0] = ranges[way][0].max(points[0]);
                    ranges[way][1] = ranges[way][1].min(points[points.len() - 1]);
                    stations[way].extend_from_slice(points);
                }
            }
        }
        Ok((Ways { names, ranges, stations }, pairs))
    }

    /// Number of the direction of a probe.
    ///
    /// # Errors
    /// A rail or a direction without a table, or a place beyond its stations.
    pub fn find(&self, p: Probe) -> Result<usize, Error> {
        let Ok(way) = self.names.binary_search(&(p.rail, p.axis)) else {
            let known = self.names.iter().any(|way| way.0 == p.rail);
            return Err(if known {
                Error::Unstiffened { rail: p.rail, x: p.x, axis: p.axis }
            } else {
                Error::NoRail { rail: p.rail }
            });
        };
        let [first, last] = self.ranges[way];
        if p.x >= first && p.x <= last { Ok(way) } else { Err(Error::OffRail { rail: p.rail, x: p.x }) }
    }

    /// All stations of a rail, increasing, each once.
    pub fn breaks(&self, rail: usize) -> Vec<f64> {
        let mut out: Vec<f64> = self.of_rail(rail, &self.stations).flatten().copied().collect();
        out.sort_by(f64::total_cmp);
        out.dedup();
        out
    }

    /// First and last coordinate that every direction of a rail has.
    pub fn range(&self, rail: usize) -> Option<[f64; 2]> {
        self.of_rail(rail, &self.ranges).copied().reduce(|a, b| [a[0].max(b[0]), a[1].min(b[1])])
    }

    fn of_rail<'a, T>(&'a self, rail: usize, all: &'a [T]) -> impl Iterator<Item = &'a T> {
        self.names.iter().zip(all).filter(move |(way, _)| way.0 == rail).map(|(_, item)| item)
    }
}

/// The station table of each direction, and that every coupling stands on the stations of both.
///
/// # Errors
/// Stations along z that differ from those along x, or from those of the direction's own table.
pub(crate) fn square<'a>(pairs: &Pairs, sheets: &'a [Sheet]) -> Result<Vec<&'a [f64]>, Error> {
    let own = |i: usize| pairs[i][i].map_or(&[][..], |k| sheets[k].table.x());
    for (i, row) in pairs.iter().enumerate() {
        for (j, index) in row.iter().enumerate() {
            let Some(index) = *index else { continue };
            if sheets[index].table.z() != own(i) || sheets[index].table.x() != own(j) {
                return Err(Error::SheetStations { sheet: index });
            }
        }
    }
    Ok((0..pairs.len()).map(own).collect())
}
