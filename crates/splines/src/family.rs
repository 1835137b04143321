//! Tables read as ADAMS reads a SPLINE: a curve along x, straight lines along z.

use crate::curve::{Curve, Place};
use crate::sheet::{Pairs, Sheet};
use crate::{Error, Influence, Jet2, Probe, Table};

/// How a curve runs through one row of a table.
pub(crate) type Through = fn(&[f64], &[f64]) -> Result<Curve, Error>;

/// Tables ready for AKISPL or CUBSPL. Probes carry the number of their direction in place of the rail.
#[derive(Clone, Debug)]
pub(crate) struct Families {
    /// Index of a family, `[deflection][load]`.
    pairs: Pairs,
    families: Vec<Family>,
    /// Stations along x of each direction's own table.
    home: Vec<Vec<f64>>,
    /// Whether G(p, q) and G(q, p) are averaged.
    symmetrised: bool,
}

#[derive(Clone, Debug)]
struct Family {
    /// Stations along x, unless they are those of the load's own table; likewise along z.
    x: Option<Vec<f64>>,
    z: Option<Vec<f64>>,
    /// Values and slopes of a curve at its points, interleaved; one curve after the other, `stride` apart.
    nodes: Vec<f64>,
    stride: usize,
}

/// A place among the stations of a direction's own table, with the weights of its interval's ends.
#[derive(Clone, Copy, Debug, Default)]
struct Spot {
    place: Place,
    weights: [f64; 4],
    rates: [f64; 4],
}

impl Spot {
    #[inline]
    fn new(points: &[f64], x: f64) -> Spot {
        let place = Place::find(points, x);
        Spot { place, weights: place.weights(), rates: place.rates() }
    }
}

impl Families {
    pub fn new(
        mut pairs: Pairs,
        sheets: &[Sheet],
        through: Through,
        symmetrised: bool,
    ) -> Result<Families, Error> {
        let own = |i: usize| pairs[i][i].map_or(Vec::new(), |k| sheets[k].table.x().to_vec());
        let home: Vec<Vec<f64>> = (0..pairs.len()).map(own).collect();
        let mut families = Vec::new();
        for i in 0..home.len() {
            for j in 0..home.len() {
                // An entry of the opposite of an earlier coupling points beyond the sheets.
                let Some(index) = pairs[i][j].filter(|_| i == j || pairs[j][i].is_none()) else { continue };
                let table = &sheets[index].table;
                pairs[i][j] = Some(families.len());
                families.push(Family::new(table, [&home[i], &home[j]], through)?);
                if i != j {
                    pairs[j][i] = Some(families.len());
                    families.push(Family::new(&table.transposed()?, [&home[j], &home[i]], through)?);
                }
            }
        }
        Ok(Families { pairs, families, home, symmetrised })
    }

    pub fn is_symmetric(&self) -> bool {
        self.symmetrised
    }

    /// As [`crate::Compliance::fill`].
    pub fn fill(&self, at: &[Probe], out: &mut Influence) {
        let n = at.len();
        match n {
            0..=2 => self.assemble(at, &mut [Spot::default(); 2][..n], out),
            3..=16 => self.assemble(at, &mut [Spot::default(); 16][..n], out),
            _ => self.assemble(at, &mut vec![Spot::default(); n], out),
        }
    }

    fn assemble(&self, at: &[Probe], spots: &mut [Spot], out: &mut Influence) {
        let n = at.len();
        for (spot, p) in spots.iter_mut().zip(at) {
            *spot = Spot::new(&self.home[p.rail], p.x);
        }
        let value = out.value.as_mut_slice();
        let slope = out.slope.as_mut_slice();
        if self.symmetrised {
            slope.fill(0.0);
        }
        for (j, q) in at.iter().enumerate() {
            for (i, p) in at.iter().enumerate() {
                let family = self.pairs[p.rail][q.rail].and_then(|k| self.families.get(k));
                let Some(family) = family else {
                    value[i + n * j] = 0.0;
                    if !self.symmetrised {
                        slope[i + n * j] = 0.0;
                    }
                    continue;
                };
                let along = family.x.as_ref().map_or(spots[j], |points| Spot::new(points, q.x));
                let across = family.z.as_ref().map_or(spots[i].place, |points| Place::find(points, p.x));
                let (own, rise) = family.line(&self.home[p.rail], &along.place, &along.weights, &across);
                value[i + n * j] = own;
                if self.symmetrised {
                    slope[i + n * j] += 0.5 * rise;
                    slope[j + n * i] += 0.5 * family.mix(&along.place, &along.rates, &across);
                } else {
                    slope[i + n * j] = rise;
                }
            }
        }
        if self.symmetrised {
            for j in 0..n {
                for i in 0..j {
                    let mean = 0.5 * (value[i + n * j] + value[j + n * i]);
                    (value[i + n * j], value[j + n * i]) = (mean, mean);
                }
            }
        }
    }

    /// As [`crate::Jets::jet`].
    pub fn jet(&self, p: Probe, q: Probe) -> Jet2 {
        let there = self.one(p, q);
        if self.symmetrised { there.mean(self.one(q, p).swapped()) } else { there }
    }

    fn one(&self, p: Probe, q: Probe) -> Jet2 {
        let Some(family) = self.pairs[p.rail][q.rail].and_then(|k| self.families.get(k)) else {
            return Jet2::default();
        };
        let (x, z) = (family.x.as_ref(), family.z.as_ref());
        let (x, z) = (x.unwrap_or(&self.home[q.rail]), z.unwrap_or(&self.home[p.rail]));
        let (along, across) = (Place::find(x, q.x), Place::find(z, p.x));
        let (value, slope) = family.line(z, &along, &along.weights(), &across);
        let (rate, twist) = family.line(z, &along, &along.rates(), &across);
        let mut bend = family.mix(&along, &along.bends(), &across);
        if let Some(before) = along.before(x) {
            bend = 0.5 * (bend + family.mix(&before, &before.bends(), &across));
        }
        Jet2 { value, p: slope, q: rate, pp: 0.0, pq: twist, qq: bend }
    }
}

impl Family {
    /// `home`: stations of the own tables of the deflection and of the load.
    fn new(table: &Table, home: [&Vec<f64>; 2], through: Through) -> Result<Family, Error> {
        let mut nodes = Vec::with_capacity(2 * table.values().len());
        for row in table.values().row_iter() {
            let y: Vec<f64> = row.iter().copied().collect();
            let curve = through(table.x(), &y)?;
            nodes.extend(y.iter().zip(curve.slopes()).flat_map(|(y, t)| [*y, *t]));
        }
        let other = |points: &[f64], home: &[f64]| (points != home).then(|| points.to_vec());
        let (x, z) = (other(table.x(), home[1]), other(table.z(), home[0]));
        Ok(Family { x, z, nodes, stride: 2 * table.x().len() })
    }

    /// Weighted nodes of curve `row` in the interval of `along`.
    #[inline]
    fn blend(&self, row: usize, along: &Place, w: &[f64; 4]) -> f64 {
        let first = row * self.stride + 2 * along.k;
        let nodes = &self.nodes[first..first + 4];
        (w[0] * nodes[0] + w[2] * nodes[2]) + (w[1] * nodes[1] + w[3] * nodes[3])
    }

    #[inline]
    fn mix(&self, along: &Place, w: &[f64; 4], across: &Place) -> f64 {
        let (low, high) = (self.blend(across.k, along, w), self.blend(across.k + 1, along, w));
        (1.0 - across.s) * low + across.s * high
    }

    /// The same and its derivative along z; at a station the mean of both sides.
    #[inline]
    fn line(&self, home: &[f64], along: &Place, w: &[f64; 4], across: &Place) -> (f64, f64) {
        let Place { k, s, h } = *across;
        let (low, high) = (self.blend(k, along, w), self.blend(k + 1, along, w));
        let mut slope = (high - low) / h;
        if s == 0.0 && k > 0 {
            let z = self.z.as_deref().unwrap_or(home);
            slope = 0.5 * (slope + (low - self.blend(k - 1, along, w)) / (z[k] - z[k - 1]));
        }
        ((1.0 - s) * low + s * high, slope)
    }
}
