//! Tables read as ADAMS reads a SPLINE: a curve along x in every row, straight lines along z between the
//! rows.

use super::block::{InfluenceBlock, Pairs};
use super::values::SplineTable;
use crate::compliance::{Influence, Partials};
use crate::curve::{Interval, PiecewiseCubic};
use crate::error::Error;
use crate::probe::Probe;
use crate::vector::dot4;

/// The rule by which a curve passes through the values of one row: [`crate::akima()`] or
/// [`crate::natural_spline()`].
pub(super) type Interpolant = fn(&[f64], &[f64]) -> Result<PiecewiseCubic, Error>;

/// Tables ready for AKISPL or CUBSPL. Probes carry the number of their direction in place of the rail.
#[derive(Clone, Debug)]
pub(super) struct Families {
    /// Index of a family, `[deflection][load]`.
    pairs: Pairs,
    families: Vec<Family>,
    /// Stations along x of each direction's own table.
    stations: Vec<Vec<f64>>,
    /// Whether the result is the mean of G(p, q) and G(q, p).
    symmetrised: bool,
}

/// The curves of one table.
#[derive(Clone, Debug)]
struct Family {
    /// Stations along x; `None` where they are those of the load's own table.
    x: Option<Vec<f64>>,
    /// Stations along z; `None` where they are those of the deflection's own table.
    z: Option<Vec<f64>>,
    /// Values and slopes of each curve at its points, interleaved; one curve after the other, `stride`
    /// entries apart.
    nodes: Vec<f64>,
    stride: usize,
}

/// A place among stations, with the Hermite weights of value and slope.
#[derive(Clone, Copy, Debug, Default)]
struct Weighted {
    interval: Interval,
    weights: [f64; 4],
    slope_weights: [f64; 4],
}

impl Weighted {
    #[inline]
    fn new(points: &[f64], x: f64) -> Weighted {
        let interval = Interval::find(points, x);
        Weighted {
            interval,
            weights: interval.weights(),
            slope_weights: interval.slope_weights(),
        }
    }
}

impl Families {
    /// Puts a curve through every row of every table. Of a coupling the transposed table serves the opposite
    /// pair.
    pub fn new(
        mut pairs: Pairs,
        blocks: &[InfluenceBlock],
        interpolant: Interpolant,
        symmetrised: bool,
    ) -> Result<Families, Error> {
        let own = |i: usize| pairs[i][i].map_or(Vec::new(), |k| blocks[k].table.x().to_vec());
        let stations: Vec<Vec<f64>> = (0..pairs.len()).map(own).collect();
        let mut families = Vec::new();
        for i in 0..stations.len() {
            for j in 0..stations.len() {
                // The opposite of a coupling that was met before already has its family.
                let Some(index) = pairs[i][j].filter(|_| i == j || pairs[j][i].is_none()) else {
                    continue;
                };
                let table = &blocks[index].table;
                pairs[i][j] = Some(families.len());
                families.push(Family::new(
                    table,
                    [&stations[i], &stations[j]],
                    interpolant,
                )?);
                if i != j {
                    pairs[j][i] = Some(families.len());
                    families.push(Family::new(
                        &table.transposed()?,
                        [&stations[j], &stations[i]],
                        interpolant,
                    )?);
                }
            }
        }
        Ok(Families {
            pairs,
            families,
            stations,
            symmetrised,
        })
    }

    pub fn is_symmetric(&self) -> bool {
        self.symmetrised
    }

    /// As [`crate::Compliance::fill`].
    pub fn fill(&self, at: &[Probe], out: &mut Influence) {
        let n = at.len();
        match n {
            0..=2 => self.assemble(at, &mut [Weighted::default(); 2][..n], out),
            3..=16 => self.assemble(at, &mut [Weighted::default(); 16][..n], out),
            _ => self.assemble(at, &mut vec![Weighted::default(); n], out),
        }
    }

    fn assemble(&self, at: &[Probe], places: &mut [Weighted], out: &mut Influence) {
        let n = at.len();
        for (place, p) in places.iter_mut().zip(at) {
            *place = Weighted::new(&self.stations[p.rail], p.x);
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
                let along = family
                    .x
                    .as_ref()
                    .map_or(places[j], |points| Weighted::new(points, q.x));
                let across = family
                    .z
                    .as_ref()
                    .map_or(places[i].interval, |points| Interval::find(points, p.x));
                let (own, rise) = family.value_and_slope(
                    &self.stations[p.rail],
                    &along.interval,
                    &along.weights,
                    &across,
                );
                value[i + n * j] = own;
                if self.symmetrised {
                    slope[i + n * j] += 0.5 * rise;
                    slope[j + n * i] +=
                        0.5 * family.value(&along.interval, &along.slope_weights, &across);
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

    /// As [`crate::Differentiable::partials`].
    pub fn jet(&self, p: Probe, q: Probe) -> Partials {
        let there = self.as_tabulated(p, q);
        if self.symmetrised {
            there.mean(self.as_tabulated(q, p).swapped())
        } else {
            there
        }
    }

    /// Derivatives of the table itself, without taking the mean.
    fn as_tabulated(&self, p: Probe, q: Probe) -> Partials {
        let Some(family) = self.pairs[p.rail][q.rail].and_then(|k| self.families.get(k)) else {
            return Partials::default();
        };
        let (x, z) = (family.x.as_ref(), family.z.as_ref());
        let (x, z) = (
            x.unwrap_or(&self.stations[q.rail]),
            z.unwrap_or(&self.stations[p.rail]),
        );
        let (along, across) = (Interval::find(x, q.x), Interval::find(z, p.x));
        let (value, by_p) = family.value_and_slope(z, &along, &along.weights(), &across);
        let (by_q, by_both) = family.value_and_slope(z, &along, &along.slope_weights(), &across);
        let mut curvature = family.value(&along, &along.curvature_weights(), &across);
        // Akima's curvature jumps at a station: the mean of both sides.
        if let Some(before) = along.before(x) {
            curvature =
                0.5 * (curvature + family.value(&before, &before.curvature_weights(), &across));
        }
        Partials {
            value,
            p: by_p,
            q: by_q,
            pp: 0.0,
            pq: by_both,
            qq: curvature,
        }
    }
}

impl Family {
    /// `own`: stations of the own tables of the deflection and of the load.
    fn new(
        table: &SplineTable,
        own: [&Vec<f64>; 2],
        interpolant: Interpolant,
    ) -> Result<Family, Error> {
        let mut nodes = Vec::with_capacity(2 * table.values().len());
        for row in table.values().row_iter() {
            let y: Vec<f64> = row.iter().copied().collect();
            let curve = interpolant(table.x(), &y)?;
            nodes.extend(y.iter().zip(curve.slopes()).flat_map(|(y, t)| [*y, *t]));
        }
        let other = |points: &[f64], own: &[f64]| (points != own).then(|| points.to_vec());
        let (x, z) = (other(table.x(), own[1]), other(table.z(), own[0]));
        Ok(Family {
            x,
            z,
            nodes,
            stride: 2 * table.x().len(),
        })
    }

    /// Curve number `row` in the interval `along`, with the Hermite weights `w` of value, slope or curvature.
    #[inline]
    fn curve(&self, row: usize, along: &Interval, w: &[f64; 4]) -> f64 {
        let first = row * self.stride + 2 * along.k;
        let nodes = self.nodes[first..first + 4]
            .first_chunk()
            .expect("four nodes");
        dot4(w, nodes)
    }

    /// Linear interpolation along z between two curves.
    #[inline]
    fn value(&self, along: &Interval, w: &[f64; 4], across: &Interval) -> f64 {
        let (low, high) = (
            self.curve(across.k, along, w),
            self.curve(across.k + 1, along, w),
        );
        (1.0 - across.s) * low + across.s * high
    }

    /// The same, and its derivative along z, which at a station is the mean of both sides. `own`: stations of
    /// the deflection's own table.
    #[inline]
    fn value_and_slope(
        &self,
        own: &[f64],
        along: &Interval,
        w: &[f64; 4],
        across: &Interval,
    ) -> (f64, f64) {
        let Interval { k, s, h } = *across;
        let (low, high) = (self.curve(k, along, w), self.curve(k + 1, along, w));
        let mut slope = (high - low) / h;
        if s == 0.0 && k > 0 {
            let z = self.z.as_deref().unwrap_or(own);
            slope = 0.5 * (slope + (low - self.curve(k - 1, along, w)) / (z[k] - z[k - 1]));
        }
        ((1.0 - s) * low + s * high, slope)
    }
}
