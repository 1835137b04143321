//! Tables of values as sums of products of curves along the rail.

use nalgebra::{DMatrix, SymmetricEigen};

use super::block::{Directions, InfluenceBlock, Pairs, common_stations};
use super::values::SplineTable;
use crate::compliance::{Compliance, Differentiable, Influence, Partials};
use crate::curve::{Interval, check_increasing, natural_spline};
use crate::error::Error;
use crate::probe::{Axis, Probe};
use crate::vector::{dot, dot4};

/// Eigenvalues below this fraction of the largest, times the size of the table, count as rounding.
const ROUNDING: f64 = 1e-15;

/// How many products of a factored table are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rank {
    /// One for every eigenvalue that is positive by more than rounding.
    Full,
    /// At most this many, those of the largest eigenvalues.
    Count(usize),
    /// Those whose eigenvalue exceeds this fraction of the table's largest entry. No value at a station
    /// changes by more.
    Tolerance(f64),
}

/// The curves of one direction, by their values at its stations.
#[derive(Clone, Debug, PartialEq)]
pub struct FactorCurves {
    /// Rail and axis of the direction.
    pub direction: (usize, Axis),
    /// Stations, increasing, length.
    pub stations: Vec<f64>,
    /// phi, stations x rank: row i belongs to station i, column k to curve k; square root of length/force.
    pub values: DMatrix<f64>,
}

impl FactorCurves {
    /// Every curve as a table without z, which is what a SPLINE of one curve holds.
    ///
    /// # Errors
    /// As [`SplineTable::curve`].
    pub fn tables(&self) -> Result<Vec<SplineTable>, Error> {
        let one = |column: nalgebra::DVectorView<'_, f64>| {
            SplineTable::curve(self.stations.clone(), column.iter().copied().collect())
        };
        self.values.column_iter().map(one).collect()
    }
}

/// A set of directions that couple, and their curves: G(p, q) = sum_k phi_k(p) phi_k(q), p and q each along
/// any of these directions.
#[derive(Clone, Debug, PartialEq)]
pub struct TableFactor {
    /// The curves of every direction, all of the same rank.
    pub curves: Vec<FactorCurves>,
    /// Eigenvalues of the products kept, decreasing, length/force.
    pub kept: Vec<f64>,
    /// The other eigenvalues, decreasing. One that is negative by more than rounding shows a table that no
    /// structure can have.
    pub dropped: Vec<f64>,
}

impl TableFactor {
    /// Number of products kept.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.kept.len()
    }

    /// Bound of |T - Phi Phi^T| at any pair of stations, length/force: the largest absolute value of the
    /// eigenvalues dropped.
    #[must_use]
    pub fn error_bound(&self) -> f64 {
        self.dropped
            .iter()
            .fold(0.0, |largest, value| value.abs().max(largest))
    }
}

/// Compliance from tables of values as a sum of products of natural splines.
///
/// The table of all stations of all directions that couple has the eigenvalues lambda_k and eigenvectors v_k,
/// T = sum_k lambda_k v_k v_k^T. With phi_k = sqrt(lambda_k) v_k at the stations and natural cubic splines
/// between them,
///
/// G(p, q) = sum_k phi_k(p) phi_k(q),
///
/// which ADAMS can evaluate by CUBSPL of one curve for each place: n r evaluations for n wheels and r
/// products.
///
/// Guarantee: symmetric to the last bit; positive semi-definite, being a Gram matrix; twice continuously
/// differentiable. With every eigenvalue of a positive semi-definite table it equals
/// [`crate::ReadingMethod::Natural`]: an error of 8.8e-3 of the largest entry on the paper's girder at seven stations,
/// which decreases with the third power of their distance.
///
/// ```
/// use nalgebra::DMatrix;
/// use splines::{Axis, FactoredTable, Rank, InfluenceBlock, SplineTable};
///
/// // A table of rank one: x z.
/// let x = vec![0.0, 1.0, 2.0, 3.0];
/// let table = SplineTable::new(x.clone(), x, DMatrix::from_fn(4, 4, |i, j| (i * j) as f64))?;
/// let vertical = (0, Axis::Vertical);
/// let blocks = [InfluenceBlock { deflection: vertical, load: vertical, table }];
/// let factored = FactoredTable::new(&blocks, Rank::Full)?;
/// let [factor] = factored.factors() else { panic!("one direction") };
/// assert_eq!(factor.rank(), 1);
/// assert!((factor.kept[0] - 14.0).abs() < 1e-13);
/// assert!(factor.error_bound() < 1e-13);
/// # Ok::<(), splines::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct FactoredTable {
    directions: Directions,
    factors: Vec<TableFactor>,
    /// Index of the factor of each direction.
    owner: Vec<usize>,
    splines: Vec<FactorSplines>,
}

/// The natural splines through the curves of one direction.
#[derive(Clone, Debug)]
struct FactorSplines {
    stations: Vec<f64>,
    /// At each station the values of all curves, then their slopes.
    nodes: Vec<f64>,
    rank: usize,
}

impl FactoredTable {
    /// Decomposes tables. `rank` applies to each set of coupled directions by itself.
    ///
    /// # Errors
    /// As [`crate::TableReading::new`] for [`crate::ReadingMethod::Natural`]; a tolerance that is negative or not a number.
    pub fn new(blocks: &[InfluenceBlock], rank: Rank) -> Result<FactoredTable, Error> {
        if let Rank::Tolerance(tolerance) = rank
            && !(tolerance >= 0.0 && tolerance.is_finite())
        {
            return Err(Error::Tolerance { tolerance });
        }
        let (directions, pairs) = Directions::new(blocks)?;
        let stations = common_stations(&pairs, blocks)?;
        let factors = coupled_sets(&pairs)
            .into_iter()
            .map(|set| decompose(&set, &directions, &stations, &pairs, blocks, rank));
        FactoredTable::from_factors(factors.collect())
    }

    /// Takes curves that exist already, as read from a file; `kept` and `dropped` are taken over unchecked.
    ///
    /// # Errors
    /// No curves; a direction that occurs twice; stations that do not increase or are fewer than four; values
    /// that are not finite or do not fit the stations and the rank.
    pub fn from_factors(factors: Vec<TableFactor>) -> Result<FactoredTable, Error> {
        let mut all: Vec<(usize, &FactorCurves)> = Vec::new();
        for (index, factor) in factors.iter().enumerate() {
            all.extend(factor.curves.iter().map(|curves| (index, curves)));
        }
        all.sort_by_key(|(_, curves)| curves.direction);
        if all.is_empty() {
            return Err(Error::NoBlocks);
        }
        if let Some(k) = all
            .windows(2)
            .position(|pair| pair[0].1.direction == pair[1].1.direction)
        {
            return Err(Error::BlockTwice { sheet: k + 1 });
        }
        let mut splines = Vec::new();
        for (index, curves) in &all {
            splines.push(FactorSplines::new(curves, factors[*index].rank())?);
        }
        let ends = |x: &[f64]| [x[0], x[x.len() - 1]];
        let directions = Directions {
            names: all.iter().map(|(_, curves)| curves.direction).collect(),
            ranges: all
                .iter()
                .map(|(_, curves)| ends(&curves.stations))
                .collect(),
            stations: all
                .iter()
                .map(|(_, curves)| curves.stations.clone())
                .collect(),
        };
        let owner = all.iter().map(|(index, _)| *index).collect();
        Ok(FactoredTable {
            directions,
            factors,
            owner,
            splines,
        })
    }

    /// One factor for each set of coupled directions.
    #[must_use]
    pub fn factors(&self) -> &[TableFactor] {
        &self.factors
    }

    /// Evaluates all curves at the probes, then takes the scalar products. `rows` holds the values of the
    /// curves at each probe, then their slopes, `width` entries a probe.
    fn assemble(
        &self,
        at: &[Probe],
        width: usize,
        rows: &mut [f64],
        owners: &mut [usize],
        out: &mut Influence,
    ) -> Result<(), Error> {
        let n = at.len();
        let (phi, slopes) = rows.split_at_mut(n * width);
        for (i, p) in at.iter().enumerate() {
            let (direction, x) = self.directions.find(*p)?;
            owners[i] = self.owner[direction];
            let splines = &self.splines[direction];
            let at = Interval::find(&splines.stations, x);
            splines.all(&at, &at.weights(), &mut phi[i * width..]);
            splines.all(&at, &at.slope_weights(), &mut slopes[i * width..]);
        }
        let (value, slope) = (out.value.as_mut_slice(), out.slope.as_mut_slice());
        for j in 0..n {
            let rank = self.factors[owners[j]].rank();
            let load = &phi[j * width..j * width + rank];
            for i in j..n {
                let (there, back) = (i + n * j, j + n * i);
                let mut one = [0.0; 3];
                if owners[i] == owners[j] {
                    let own = i * width..i * width + rank;
                    one = [
                        dot(&phi[own.clone()], load),
                        dot(&slopes[own.clone()], load),
                        dot(&phi[own], &slopes[j * width..]),
                    ];
                }
                (value[there], value[back]) = (one[0], one[0]);
                (slope[there], slope[back]) = (one[1], one[2]);
            }
        }
        Ok(())
    }
}

impl FactorSplines {
    fn new(curves: &FactorCurves, rank: usize) -> Result<FactorSplines, Error> {
        let x = &curves.stations;
        if x.len() < SplineTable::FEWEST_X {
            return Err(Error::TooFewPoints {
                found: x.len(),
                least: SplineTable::FEWEST_X,
            });
        }
        check_increasing(x)?;
        let (rows, columns) = curves.values.shape();
        if [rows, columns] != [x.len(), rank] {
            return Err(Error::TableShape {
                rows,
                columns,
                expected: [x.len(), rank],
            });
        }
        let mut nodes = vec![0.0; 2 * rows * rank];
        for (k, column) in curves.values.column_iter().enumerate() {
            let y: Vec<f64> = column.iter().copied().collect();
            let curve = natural_spline(x, &y)?;
            for (i, (y, t)) in y.iter().zip(curve.slopes()).enumerate() {
                nodes[2 * i * rank + k] = *y;
                nodes[(2 * i + 1) * rank + k] = *t;
            }
        }
        Ok(FactorSplines {
            stations: x.clone(),
            nodes,
            rank,
        })
    }

    /// Curve k with the Hermite weights `w` of value, slope or curvature.
    #[inline]
    fn one(&self, at: &Interval, w: &[f64; 4], k: usize) -> f64 {
        dot4(
            w,
            &std::array::from_fn(|i| self.nodes[(2 * at.k + i) * self.rank + k]),
        )
    }

    /// The same for all curves, into `out`.
    #[inline]
    fn all(&self, at: &Interval, w: &[f64; 4], out: &mut [f64]) {
        let r = self.rank;
        let four = &self.nodes[2 * at.k * r..(2 * at.k + 4) * r];
        let (first, last) = four.split_at(2 * r);
        let ((y0, t0), (y1, t1)) = (first.split_at(r), last.split_at(r));
        for (k, out) in out[..r].iter_mut().enumerate() {
            *out = dot4(w, &[y0[k], t0[k], y1[k], t1[k]]);
        }
    }
}

/// Sets of directions that couple, directly or through others; each increasing.
fn coupled_sets(pairs: &Pairs) -> Vec<Vec<usize>> {
    // Two directions that couple receive the smaller of their labels, as does every direction labelled alike.
    let mut label: Vec<usize> = (0..pairs.len()).collect();
    for (i, row) in pairs.iter().enumerate() {
        for j in (0..row.len()).filter(|&j| row[j].is_some()) {
            let (keep, drop) = (label[i].min(label[j]), label[i].max(label[j]));
            label
                .iter_mut()
                .filter(|of| **of == drop)
                .for_each(|of| *of = keep);
        }
    }
    let of = |set: usize| {
        (0..label.len())
            .filter(|&i| label[i] == set)
            .collect::<Vec<_>>()
    };
    (0..label.len())
        .map(of)
        .filter(|set| !set.is_empty())
        .collect()
}

/// The table of all stations of a set of coupled directions, and the index of each direction's first station
/// in it.
fn coupled_table(
    set: &[usize],
    stations: &[&[f64]],
    pairs: &Pairs,
    blocks: &[InfluenceBlock],
) -> (DMatrix<f64>, Vec<usize>) {
    let mut first = Vec::new();
    let mut size = 0;
    for &direction in set {
        first.push(size);
        size += stations[direction].len();
    }
    let mut table = DMatrix::zeros(size, size);
    for (a, &i) in set.iter().enumerate() {
        for (b, &j) in set.iter().enumerate() {
            let Some(values) = pairs[i][j].map(|index| blocks[index].table.values()) else {
                continue;
            };
            let mut put = |first: [usize; 2], block: &DMatrix<f64>| {
                table
                    .view_mut((first[0], first[1]), block.shape())
                    .copy_from(block);
            };
            if a == b {
                put([first[a], first[a]], &(0.5 * (values + values.transpose())));
            } else {
                put([first[a], first[b]], values);
                put([first[b], first[a]], &values.transpose());
            }
        }
    }
    (table, first)
}

/// Eigenvalues and curves of the table of one set of coupled directions.
fn decompose(
    set: &[usize],
    directions: &Directions,
    stations: &[&[f64]],
    pairs: &Pairs,
    blocks: &[InfluenceBlock],
    rank: Rank,
) -> TableFactor {
    let (table, first) = coupled_table(set, stations, pairs, blocks);
    let size = table.nrows();
    let largest = table.amax();
    let eigen = SymmetricEigen::new(table);
    let mut order: Vec<usize> = (0..size).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let values: Vec<f64> = order.iter().map(|&k| eigen.eigenvalues[k]).collect();
    let least = ROUNDING * size as f64 * eigen.eigenvalues.amax();
    let positive = values.iter().take_while(|&&value| value > least).count();
    let count = match rank {
        Rank::Full => positive,
        Rank::Count(count) => positive.min(count),
        Rank::Tolerance(tolerance) => values[..positive]
            .iter()
            .take_while(|&&value| value > tolerance * largest)
            .count(),
    };
    let curve = |k: usize| {
        let column = eigen.eigenvectors.column(order[k]);
        // The sign of an eigenvector is arbitrary: the first entry of about the largest size is made
        // positive.
        let peak = column
            .iter()
            .find(|entry| entry.abs() > 0.999 * column.amax());
        let sign = if peak.is_some_and(|entry| *entry < 0.0) {
            -1.0
        } else {
            1.0
        };
        column * (sign * values[k].sqrt())
    };
    let columns: Vec<_> = (0..count).map(curve).collect();
    let one = |(&direction, &first): (&usize, &usize)| {
        let stations = stations[direction].to_vec();
        let values = DMatrix::from_fn(stations.len(), count, |i, k| columns[k][first + i]);
        FactorCurves {
            direction: directions.names[direction],
            stations,
            values,
        }
    };
    let curves = set.iter().zip(&first).map(one).collect();
    TableFactor {
        curves,
        kept: values[..count].to_vec(),
        dropped: values[count..].to_vec(),
    }
}

impl Compliance for FactoredTable {
    /// `value` is symmetric to the last bit. Up to 16 probes with 128 curve values in all need no allocation.
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        let n = at.len();
        out.expect(n)?;
        let width = self
            .factors
            .iter()
            .map(TableFactor::rank)
            .max()
            .unwrap_or(0);
        let size = 2 * n * width;
        match size {
            0..=32 if n <= 4 => {
                self.assemble(at, width, &mut [0.0; 32][..size], &mut [0; 4][..n], out)
            }
            0..=256 if n <= 16 => {
                self.assemble(at, width, &mut [0.0; 256][..size], &mut [0; 16][..n], out)
            }
            _ => self.assemble(at, width, &mut vec![0.0; size], &mut vec![0; n], out),
        }
    }

    fn breaks(&self, rail: usize) -> Vec<f64> {
        self.directions.breaks(rail)
    }

    fn range(&self, rail: usize) -> Option<[f64; 2]> {
        self.directions.range(rail)
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

impl Differentiable for FactoredTable {
    /// All derivatives up to the second are continuous.
    fn partials(&self, p: Probe, q: Probe) -> Result<Partials, Error> {
        let ((a, x), (b, z)) = (self.directions.find(p)?, self.directions.find(q)?);
        if self.owner[a] != self.owner[b] {
            return Ok(Partials::default());
        }
        let three = |direction: usize, x| {
            let at = Interval::find(&self.splines[direction].stations, x);
            (
                at,
                [at.weights(), at.slope_weights(), at.curvature_weights()],
            )
        };
        let ((at, own), (to, load)) = (three(a, x), three(b, z));
        let mut out = Partials::default();
        for k in 0..self.splines[a].rank {
            let [p0, p1, p2] = own.map(|w| self.splines[a].one(&at, &w, k));
            let [q0, q1, q2] = load.map(|w| self.splines[b].one(&to, &w, k));
            out.value += p0 * q0;
            out.p += p1 * q0;
            out.q += p0 * q1;
            out.pp += p2 * q0;
            out.pq += p1 * q1;
            out.qq += p0 * q2;
        }
        Ok(out)
    }
}
