//! A station table as a sum of products of curves along the rail.

use nalgebra::{DMatrix, SymmetricEigen};

use crate::curve::{Place, increasing};
use crate::sheet::{Pairs, Sheet, Ways, square};
use crate::{Axis, Compliance, Error, Influence, Jet2, Jets, Probe, Table, natural};

/// Eigenvalues below this share of the largest are rounding.
const ROUNDING: f64 = 1e-15;

/// How many products are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rank {
    /// Every positive eigenvalue that is more than rounding.
    Full,
    /// At most that many, the largest.
    Count(usize),
    /// Those above this share of the largest entry of the table: no station's value changes by more.
    Tolerance(f64),
}

/// The curves of one direction at its stations.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    /// Rail and axis.
    pub way: (usize, Axis),
    /// Stations, increasing.
    pub stations: Vec<f64>,
    /// phi, stations x rank: row i at station i, column k is curve k. Square root of length per force.
    pub values: DMatrix<f64>,
}

impl Curves {
    /// Every curve as a table of one curve: what a SPLINE without z holds.
    ///
    /// # Errors
    /// As [`Table::curve`].
    pub fn tables(&self) -> Result<Vec<Table>, Error> {
        let one = |column: nalgebra::DVectorView<'_, f64>| {
            Table::curve(self.stations.clone(), column.iter().copied().collect())
        };
        self.values.column_iter().map(one).collect()
    }
}

/// Directions that couple with each other, and the curves that they share: G = sum over k of
/// phi_k(p) phi_k(q), p and q each along any of the directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Factor {
    /// One set of curves for every direction, all of the same rank.
    pub curves: Vec<Curves>,
    /// Eigenvalues of the kept products, decreasing: length per force.
    pub kept: Vec<f64>,
    /// The others, decreasing. Those below zero by more than rounding show a table that no structure has.
    pub dropped: Vec<f64>,
}

impl Factor {
    /// Number of products.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.kept.len()
    }

    /// Bound of |T - Phi Phi^T| at any pair of stations, length per force: the largest dropped eigenvalue.
    #[must_use]
    pub fn error_bound(&self) -> f64 {
        self.dropped.iter().fold(0.0, |largest, value| value.abs().max(largest))
    }
}

/// Tables of values as sums of products of natural splines.
///
/// The table T of all stations of all directions that couple is T = sum lambda_k v_k v_k^T;
/// with phi_k = sqrt(lambda_k) v_k at the stations and natural cubic splines between them,
///
/// G(p, q) = sum_k phi_k(p) phi_k(q),
///
/// which ADAMS can be given as CUBSPL of one curve, twice: n r look-ups for n wheels and r products.
///
/// Symmetric to the last bit; positive semi-definite, being a Gram matrix; twice continuously
/// differentiable. With every eigenvalue it equals [`crate::Kind::Natural`] of a positive table: error 8.8e-3 of the
/// largest entry on the paper's girder at seven stations, order 3 in their distance.
#[derive(Clone, Debug)]
pub struct Factored {
    ways: Ways,
    factors: Vec<Factor>,
    /// Factor of each direction.
    owner: Vec<usize>,
    ready: Vec<Ready>,
}

/// One direction's curves: at each station all values, then all slopes.
#[derive(Clone, Debug)]
struct Ready {
    stations: Vec<f64>,
    nodes: Vec<f64>,
    rank: usize,
}

impl Factored {
    /// Decomposes tables. The rank counts for each set of coupled directions on its own.
    ///
    /// # Errors
    /// As [`crate::Reading::new`] for [`crate::Kind::Natural`]; a tolerance that is negative or not a number.
    pub fn new(sheets: &[Sheet], rank: Rank) -> Result<Factored, Error> {
        if let Rank::Tolerance(tolerance) = rank
            && !(tolerance >= 0.0 && tolerance.is_finite())
        {
            return Err(Error::Tolerance { tolerance });
        }
        let (ways, pairs) = Ways::new(sheets)?;
        let stations = square(&pairs, sheets)?;
        let factors =
            sets(&pairs).into_iter().map(|set| decompose(&set, &ways, &stations, &pairs, sheets, rank));
        Factored::of(factors.collect())
    }

    /// Takes curves that stand already, as read from a file; `kept` and `dropped` are taken as they are.
    ///
    /// # Errors
    /// No curves; a direction that stands twice; stations that do not increase or are fewer than four; values
    /// that are not finite or do not fit the stations and the rank.
    pub fn of(factors: Vec<Factor>) -> Result<Factored, Error> {
        let mut all: Vec<(usize, &Curves)> = Vec::new();
        for (index, factor) in factors.iter().enumerate() {
            all.extend(factor.curves.iter().map(|curves| (index, curves)));
        }
        all.sort_by_key(|(_, curves)| curves.way);
        if all.is_empty() {
            return Err(Error::NoSheets);
        }
        if let Some(k) = all.windows(2).position(|pair| pair[0].1.way == pair[1].1.way) {
            return Err(Error::SheetTwice { sheet: k + 1 });
        }
        let mut ready = Vec::new();
        for (index, curves) in &all {
            ready.push(Ready::new(curves, factors[*index].rank())?);
        }
        let ends = |x: &[f64]| [x[0], x[x.len() - 1]];
        let ways = Ways {
            names: all.iter().map(|(_, curves)| curves.way).collect(),
            ranges: all.iter().map(|(_, curves)| ends(&curves.stations)).collect(),
            stations: all.iter().map(|(_, curves)| curves.stations.clone()).collect(),
        };
        let owner = all.iter().map(|(index, _)| *index).collect();
        Ok(Factored { ways, factors, owner, ready })
    }

    /// One factor for each set of coupled directions.
    #[must_use]
    pub fn factors(&self) -> &[Factor] {
        &self.factors
    }

    /// `rows`: values of all curves at the probes, then their slopes, `width` apart.
    fn assemble(
        &self,
        at: &[Probe],
        width: usize,
        rows: &mut [f64],
        owners: &mut [usize],
        out: &mut Influence,
    ) -> Result<(), Error> {
        let n = at.len();
        let (phi, rates) = rows.split_at_mut(n * width);
        for (i, p) in at.iter().enumerate() {
            let way = self.ways.find(*p)?;
            owners[i] = self.owner[way];
            let ready = &self.ready[way];
            let place = Place::find(&ready.stations, p.x);
            ready.blend(&place, &place.weights(), &mut phi[i * width..]);
            ready.blend(&place, &place.rates(), &mut rates[i * width..]);
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
                        dot(&rates[own.clone()], load),
                        dot(&phi[own], &rates[j * width..]),
                    ];
                }
                (value[there], value[back]) = (one[0], one[0]);
                (slope[there], slope[back]) = (one[1], one[2]);
            }
        }
        Ok(())
    }
}

impl Ready {
    fn new(curves: &Curves, rank: usize) -> Result<Ready, Error> {
        let x = &curves.stations;
        if x.len() < Table::LEAST {
            return Err(Error::Points { found: x.len(), least: Table::LEAST });
        }
        increasing(x)?;
        let (rows, columns) = curves.values.shape();
        if [rows, columns] != [x.len(), rank] {
            return Err(Error::TableShape { rows, columns, expected: [x.len(), rank] });
        }
        let mut nodes = vec![0.0; 2 * rows * rank];
        for (k, column) in curves.values.column_iter().enumerate() {
            let y: Vec<f64> = column.iter().copied().collect();
            let curve = natural(x, &y)?;
            for (i, (y, t)) in y.iter().zip(curve.slopes()).enumerate() {
                nodes[2 * i * rank + k] = *y;
                nodes[(2 * i + 1) * rank + k] = *t;
            }
        }
        Ok(Ready { stations: x.clone(), nodes, rank })
    }

    /// Curve k with the weights of an interval's ends.
    #[inline]
    fn curve(&self, place: &Place, w: &[f64; 4], k: usize) -> f64 {
        let node = |i: usize| self.nodes[(2 * place.k + i) * self.rank + k];
        (w[0] * node(0) + w[2] * node(2)) + (w[1] * node(1) + w[3] * node(3))
    }

    #[inline]
    fn blend(&self, place: &Place, w: &[f64; 4], out: &mut [f64]) {
        let r = self.rank;
        let four = &self.nodes[2 * place.k * r..(2 * place.k + 4) * r];
        let (first, last) = four.split_at(2 * r);
        let ((y0, t0), (y1, t1)) = (first.split_at(r), last.split_at(r));
        for (k, out) in out[..r].iter_mut().enumerate() {
            *out = (w[0] * y0[k] + w[2] * y1[k]) + (w[1] * t0[k] + w[3] * t1[k]);
        }
    }
}

/// Sets of directions that couple, each increasing.
fn sets(pairs: &Pairs) -> Vec<Vec<usize>> {
    let mut label: Vec<usize> = (0..pairs.len()).collect();
    for (i, row) in pairs.iter().enumerate() {
        for j in (0..row.len()).filter(|&j| row[j].is_some()) {
            let (keep, drop) = (label[i].min(label[j]), label[i].max(label[j]));
            label.iter_mut().filter(|of| **of == drop).for_each(|of| *of = keep);
        }
    }
    let of = |set: usize| (0..label.len()).filter(|&i| label[i] == set).collect::<Vec<_>>();
    (0..label.len()).map(of).filter(|set| !set.is_empty()).collect()
}

fn decompose(
    set: &[usize],
    ways: &Ways,
    stations: &[&[f64]],
    pairs: &Pairs,
    sheets: &[Sheet],
    rank: Rank,
) -> Factor {
    let mut first = Vec::new();
    let mut size = 0;
    for &way in set {
        first.push(size);
        size += stations[way].len();
    }
    let mut table = DMatrix::zeros(size, size);
    for (a, &i) in set.iter().enumerate() {
        for (b, &j) in set.iter().enumerate() {
            let Some(values) = pairs[i][j].map(|index| sheets[index].table.values()) else { continue };
            let mut at = |first: [usize; 2], block: &DMatrix<f64>| {
                table.view_mut((first[0], first[1]), block.shape()).copy_from(block);
            };
            if a == b {
                at([first[a], first[a]], &(0.5 * (values + values.transpose())));
            } else {
                at([first[a], first[b]], values);
                at([first[b], first[a]], &values.transpose());
            }
        }
    }
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
        Rank::Tolerance(tolerance) => {
            values[..positive].iter().take_while(|&&value| value > tolerance * largest).count()
        }
    };
    let curve = |k: usize| {
        let column = eigen.eigenvectors.column(order[k]);
        // Eigenvectors have no sign of their own: the first entry that is about the largest is positive.
        let peak = column.iter().find(|entry| entry.abs() > 0.999 * column.amax());
        let sign = if peak.is_some_and(|entry| *entry < 0.0) { -1.0 } else { 1.0 };
        column * (sign * values[k].sqrt())
    };
    let columns: Vec<_> = (0..count).map(curve).collect();
    let one = |(&way, &first): (&usize, &usize)| {
        let n = stations[way].len();
        let values = DMatrix::from_fn(n, count, |i, k| columns[k][first + i]);
        Curves { way: ways.names[way], stations: stations[way].to_vec(), values }
    };
    let curves = set.iter().zip(&first).map(one).collect();
    Factor { curves, kept: values[..count].to_vec(), dropped: values[count..].to_vec() }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl Compliance for Factored {
    /// `value` is symmetric to the last bit. Up to 16 probes of 128 curve values together take no
    /// memory from the heap.
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        let n = at.len();
        out.expect(n)?;
        let width = self.factors.iter().map(Factor::rank).max().unwrap_or(0);
        let size = 2 * n * width;
        match size {
            0..=32 if n <= 4 => self.assemble(at, width, &mut [0.0; 32][..size], &mut [0; 4][..n], out),
            0..=256 if n <= 16 => self.assemble(at, width, &mut [0.0; 256][..size], &mut [0; 16][..n], out),
            _ => self.assemble(at, width, &mut vec![0.0; size], &mut vec![0; n], out),
        }
    }

    fn breaks(&self, rail: usize) -> Vec<f64> {
        self.ways.breaks(rail)
    }

    fn range(&self, rail: usize) -> Option<[f64; 2]> {
        self.ways.range(rail)
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

impl Jets for Factored {
    /// Continuous everywhere.
    fn jet(&self, p: Probe, q: Probe) -> Result<Jet2, Error> {
        let (a, b) = (self.ways.find(p)?, self.ways.find(q)?);
        if self.owner[a] != self.owner[b] {
            return Ok(Jet2::default());
        }
        let three = |way: usize, x| {
            let place = Place::find(&self.ready[way].stations, x);
            (place, [place.weights(), place.rates(), place.bends()])
        };
        let ((at, own), (to, load)) = (three(a, p.x), three(b, q.x));
        let mut out = Jet2::default();
        for k in 0..self.ready[a].rank {
            let [p0, p1, p2] = own.map(|w| self.ready[a].curve(&at, &w, k));
            let [q0, q1, q2] = load.map(|w| self.ready[b].curve(&to, &w, k));
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
