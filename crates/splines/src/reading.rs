//! Influence coefficients read from tables of values.

use std::sync::Arc;

use nalgebra::DMatrix;

use crate::cubic::interleaved;
use crate::curve::{Curve, Place};
use crate::{
    Axis, Cell, Compliance, Error, Flexibility, Influence, Line, Probe, Surface, Table, akima, natural,
};

/// How values between the stations are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// W T W^T with natural cubic cardinal splines W along both directions: symmetric, positive
    /// semi-definite where the table is, twice continuously differentiable.
    Natural,
    /// As ADAMS reads a SPLINE by AKISPL: Akima's curve along x, where the load stands, linear along z, where
    /// the deflection is taken. Neither symmetric nor positive between stations; slopes jump at stations.
    Akispl,
    /// As ADAMS reads it by CUBSPL: the natural cubic spline along x, linear along z.
    Cubspl,
}

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

/// Tables of values as a structure's give.
///
/// A direction without a table of its own cannot be asked for; two directions without a common table do
/// not couple. A coupling is given once: the opposite one is its transpose.
#[derive(Clone, Debug)]
pub struct Reading {
    kind: Kind,
    /// Every direction: rail and axis.
    ways: Vec<(usize, Axis)>,
    ranges: Vec<[f64; 2]>,
    stations: Vec<Vec<f64>>,
    inner: Inner,
}

#[derive(Clone, Debug)]
enum Inner {
    /// The natural tensor is the surface of cells without flexibility: every direction is a rail of its own.
    Tensor(Surface),
    /// `pairs[deflection][load]`: index of a family.
    Families { pairs: Vec<Vec<Option<usize>>>, families: Vec<Family> },
}

/// A table ready for AKISPL or CUBSPL.
#[derive(Clone, Debug)]
struct Family {
    x: Vec<f64>,
    z: Vec<f64>,
    curves: Vec<Curve>,
}

impl Reading {
    /// `sheets`: for every direction its own table, and couplings between them as there are.
    ///
    /// # Errors
    /// No sheet; two sheets for one pair; a coupling between directions without tables of their own; a table
    /// with fewer than two curves; for [`Kind::Natural`] stations along z that differ from those along x.
    pub fn new(kind: Kind, sheets: &[Sheet]) -> Result<Reading, Error> {
        if sheets.is_empty() {
            return Err(Error::NoSheets);
        }
        let mut ways: Vec<(usize, Axis)> =
            sheets.iter().filter(|s| s.deflection == s.load).map(|s| s.load).collect();
        ways.sort_unstable();
        ways.dedup();
        let mut pairs = vec![vec![None; ways.len()]; ways.len()];
        for (index, sheet) in sheets.iter().enumerate() {
            let place = |way| ways.binary_search(&way).map_err(|_| Error::SheetAlone { sheet: index });
            let (i, j) = (place(sheet.deflection)?, place(sheet.load)?);
            if pairs[i][j].is_some() || pairs[j][i].is_some() {
                return Err(Error::SheetTwice { sheet: index });
            }
            if sheet.table.z().len() < 2 {
                return Err(Error::Points { found: sheet.table.z().len(), least: 2 });
            }
            pairs[i][j] = Some(index);
        }
        let mut ranges = vec![[f64::NEG_INFINITY, f64::INFINITY]; ways.len()];
        let mut stations = vec![Vec::new(); ways.len()];
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
        let inner = match kind {
            Kind::Natural => Inner::Tensor(tensor(&pairs, sheets)?),
            Kind::Akispl => families(pairs, sheets, akima)?,
            Kind::Cubspl => families(pairs, sheets, natural)?,
        };
        Ok(Reading { kind, ways, ranges, stations, inner })
    }

    /// How it reads.
    #[must_use]
    pub fn kind(&self) -> Kind {
        self.kind
    }

    fn way(&self, p: Probe) -> Result<usize, Error> {
        let Ok(way) = self.ways.binary_search(&(p.rail, p.axis)) else {
            let known = self.ways.iter().any(|way| way.0 == p.rail);
            return Err(if known {
                Error::Unstiffened { rail: p.rail, x: p.x, axis: p.axis }
            } else {
                Error::NoRail { rail: p.rail }
            });
        };
        let [first, last] = self.ranges[way];
        if p.x >= first && p.x <= last { Ok(way) } else { Err(Error::OffRail { rail: p.rail, x: p.x }) }
    }

    fn of_rail<'a, T>(&'a self, rail: usize, all: &'a [T]) -> impl Iterator<Item = &'a T> {
        self.ways.iter().zip(all).filter(move |(way, _)| way.0 == rail).map(|(_, item)| item)
    }
}

impl Compliance for Reading {
    /// Where the slope along z jumps (at a station), `slope` is the mean of both sides.
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        out.expect(at.len())?;
        // Probes by the number of their direction in place of the rail; on the stack if few.
        let mut few = [Probe { rail: 0, x: 0.0, axis: Axis::Vertical }; 16];
        let mut many = Vec::new();
        let spots = if at.len() <= few.len() {
            &mut few[..at.len()]
        } else {
            many.resize(at.len(), few[0]);
            &mut many[..]
        };
        for (spot, p) in spots.iter_mut().zip(at) {
            *spot = Probe { rail: self.way(*p)?, x: p.x, axis: Axis::Vertical };
        }
        match &self.inner {
            Inner::Tensor(surface) => surface.fill(spots, out),
            Inner::Families { pairs, families } => {
                // The place along x is found once for all deflections that read the same family.
                for (j, load) in spots.iter().enumerate() {
                    let mut last = None;
                    let (mut along, mut weights) = (Place::default(), [0.0; 4]);
                    for (i, p) in spots.iter().enumerate() {
                        let index = pairs[p.rail][load.rail];
                        let Some(family) = index.and_then(|k| families.get(k)) else {
                            (out.value[(i, j)], out.slope[(i, j)]) = (0.0, 0.0);
                            continue;
                        };
                        if last != index {
                            last = index;
                            along = Place::find(&family.x, load.x);
                            weights = along.weights();
                        }
                        (out.value[(i, j)], out.slope[(i, j)]) = family.read(along.k, &weights, p.x);
                    }
                }
                Ok(())
            }
        }
    }

    fn breaks(&self, rail: usize) -> Vec<f64> {
        let mut out: Vec<f64> = self.of_rail(rail, &self.stations).flatten().copied().collect();
        out.sort_by(f64::total_cmp);
        out.dedup();
        out
    }

    fn range(&self, rail: usize) -> Option<[f64; 2]> {
        self.of_rail(rail, &self.ranges).copied().reduce(|a, b| [a[0].max(b[0]), a[1].min(b[1])])
    }

    fn is_symmetric(&self) -> bool {
        self.kind == Kind::Natural
    }
}

impl Family {
    /// Value and its derivative along z, at interval k with weights along x.
    fn read(&self, k: usize, weights: &[f64; 4], z: f64) -> (f64, f64) {
        let Place { k: i, s, h } = Place::find(&self.z, z);
        let (low, high) = (self.curves[i].blend(k, weights), self.curves[i + 1].blend(k, weights));
        let value = (1.0 - s) * low + s * high;
        let mut slope = (high - low) / h;
        if s == 0.0 && i > 0 {
            let before = self.curves[i - 1].blend(k, weights);
            slope = 0.5 * (slope + (low - before) / (self.z[i] - self.z[i - 1]));
        }
        (value, slope)
    }
}

fn families(
    mut pairs: Vec<Vec<Option<usize>>>,
    sheets: &[Sheet],
    through: fn(&[f64], &[f64]) -> Result<Curve, Error>,
) -> Result<Inner, Error> {
    let family = |table: &Table| {
        let curve = |row: usize| {
            let y: Vec<f64> = table.values().row(row).iter().copied().collect();
            through(table.x(), &y)
        };
        let curves = (0..table.z().len()).map(curve).collect::<Result<_, _>>()?;
        Ok(Family { x: table.x().to_vec(), z: table.z().to_vec(), curves })
    };
    let mut all = sheets.iter().map(|sheet| family(&sheet.table)).collect::<Result<Vec<_>, _>>()?;
    for (index, sheet) in sheets.iter().enumerate().filter(|(_, sheet)| sheet.deflection != sheet.load) {
        let mut opposite = Vec::new();
        for (i, row) in pairs.iter().enumerate() {
            opposite.extend(row.iter().position(|&k| k == Some(index)).map(|j| (j, i)));
        }
        for (i, j) in opposite {
            pairs[i][j] = Some(all.len());
        }
        all.push(family(&sheet.table.transposed()?)?);
    }
    Ok(Inner::Families { pairs, families: all })
}

/// Cells without flexibility between stations have Hermite shapes and no kernel of their own; with the
/// values and slopes of natural splines at their ends they make the tensor spline.
fn tensor(pairs: &[Vec<Option<usize>>], sheets: &[Sheet]) -> Result<Surface, Error> {
    let own = |i: usize| pairs[i][i].map(|k| sheets[k].table.x());
    let mut cells = Vec::new();
    let mut first = Vec::new();
    let mut states = 0;
    for i in 0..pairs.len() {
        first.push(states);
        let Some(x) = own(i) else { continue };
        cells.extend(chain(i, states, x, Flexibility::default()));
        states += x.len();
    }
    let mut nodal = DMatrix::zeros(6 * states, 6 * states);
    for (i, row) in pairs.iter().enumerate() {
        for (j, index) in row.iter().enumerate() {
            let (Some(index), Some(z), Some(x)) = (*index, own(i), own(j)) else { continue };
            let table = &sheets[index].table;
            if table.z() != z || table.x() != x {
                return Err(Error::SheetStations { sheet: index });
            }
            let block = interleaved(z) * table.values() * interleaved(x).transpose();
            let block = if i == j { 0.5 * (&block + block.transpose()) } else { block };
            scatter(&mut nodal, [first[i], first[j]], &block);
            if i != j {
                scatter(&mut nodal, [first[j], first[i]], &block.transpose());
            }
        }
    }
    Surface::new(Arc::new(Line::new(cells)?), nodal)
}

/// Cells from station to station, their states numbered from `first`.
pub(crate) fn chain(rail: usize, first: usize, x: &[f64], flexibility: Flexibility) -> Vec<Cell> {
    let cell = |(k, pair): (usize, &[f64])| Cell {
        rail,
        x: [pair[0], pair[1]],
        ends: [first + k, first + k + 1],
        length: pair[1] - pair[0],
        frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        offset: [0.0; 3],
        flexibility,
        carrier: None,
    };
    x.windows(2).enumerate().map(cell).collect()
}

/// Puts a block over interleaved (v, theta z) into the freedoms of states.
pub(crate) fn scatter(nodal: &mut DMatrix<f64>, first: [usize; 2], block: &DMatrix<f64>) {
    let freedom = |first: usize, k: usize| 6 * (first + k / 2) + if k.is_multiple_of(2) { 1 } else { 5 };
    for i in 0..block.nrows() {
        for j in 0..block.ncols() {
            nodal[(freedom(first[0], i), freedom(first[1], j))] = block[(i, j)];
        }
    }
}
