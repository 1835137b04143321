//! Reactions, internal forces and stresses over a run: sums of force times influence line and of inertia.
//!
//! In a cell of a rail an influence line is one cubic; where an axial force bends members it is nearly one. So such a quantity is a
//! polynomial in each piece of the run, which has its largest and smallest values and its turning points. How much it may change in
//! a piece from its middle follows from the changes of the loads; a piece that cannot have a larger or smaller value than those that
//! are known is left out.

use piecewise::Lobatto;
use smallvec::SmallVec;
use splines::{Axis, InfluenceLines, Probe};

use super::bounds::Bounds;
use super::cells::{Cell, RailCells};
use super::load_pieces::{LoadPieces, LoadState, Stay};
use super::peak::{Peak, known, offer_piece};
use crate::steps::ColumnInstant;

/// Degree of the polynomials of influence lines in a cell.
pub(crate) const LINE_DEGREE: usize = 4;

/// A quantity that follows from the loads on a structure and from its accelerations.
#[derive(Clone, Debug, Default)]
pub(crate) struct Functional {
    /// Its influence lines, by number, with their factors.
    pub terms: Vec<(usize, f64)>,
    /// Its value per unit acceleration of each degree of freedom.
    pub inertia: Vec<f64>,
}

/// Quantities of a structure in the pieces of a run. Loads that the structure does not resist are neglected.
pub(crate) struct Functionals<'a> {
    all: &'a [Functional],
    pieces: &'a LoadPieces<'a>,
    /// By cell that is visited.
    cells: Vec<CellLines>,
}

/// The influence lines of all quantities in a cell of a rail: polynomials in the share of the cell.
struct CellLines {
    /// Coordinates just inside of the cell, and its ends.
    inside: [f64; 2],
    ends: [f64; 2],
    /// By quantity and direction of the load: coefficients of increasing powers.
    coefficients: Vec<[[f64; LINE_DEGREE + 1]; 3]>,
    /// Bounds of their values.
    bounds: Vec<[Bounds; 3]>,
    /// Largest magnitudes of their slopes by the coordinate.
    slopes: Vec<[f64; 3]>,
}

/// A load in a state: powers of its place in its cell, its components, and the number of the cell.
type PlacedLoad = ([f64; LINE_DEGREE], [f64; 3], usize);

impl<'a> Functionals<'a> {
    /// The quantities `all`, whose terms are those of `lines`.
    pub fn new(
        lines: &InfluenceLines,
        all: &'a [Functional],
        pieces: &'a LoadPieces<'a>,
    ) -> Functionals<'a> {
        let of_cell = |cell: &Cell| CellLines::new(lines, all, (pieces.cells(), *cell));
        Functionals {
            cells: pieces.visited().iter().map(of_cell).collect(),
            all,
            pieces,
        }
    }

    /// Bounds of all quantities during a stay.
    fn bounds(&self, stay: &Stay) -> Vec<Bounds> {
        let of = |(r, own): (usize, &Functional)| {
            let mut sum = Bounds::ZERO;
            for (cell, force) in &stay.loads {
                for (force, line) in force.iter().zip(&self.cells[*cell].bounds[r]) {
                    sum.add_product(*force, *line);
                }
            }
            for (per, a) in own.inertia.iter().zip(&stay.accelerations) {
                sum.add_product(Bounds::at(*per), *a);
            }
            sum
        };
        self.all.iter().enumerate().map(of).collect()
    }

    /// Appends some of the quantities in a state.
    fn put(&self, state: &LoadState<'_>, chosen: &[usize], to: &mut Vec<f64>) {
        let placed: SmallVec<[PlacedLoad; 8]> = state
            .loads
            .iter()
            .zip(state.cells)
            .filter(|(load, _)| load.force != [0.0; 3])
            .map(|(load, (cell, _))| (self.cells[*cell].powers(load.x), load.force, *cell))
            .collect();
        let accelerations = state.accelerations();
        to.extend(chosen.iter().map(|r| {
            let inertia = self.all[*r].inertia.iter().zip(accelerations);
            let mut sum: f64 = inertia.map(|(per, a)| per * a).sum();
            for (powers, force, cell) in &placed {
                sum += self.cells[*cell].value(*r, powers, force);
            }
            sum
        }));
    }

    /// Bounds of how much some of the quantities change in a piece from its middle node.
    fn changes(&self, stay: &Stay, index: usize, chosen: &[usize]) -> Vec<f64> {
        let [_, accelerations] = self.pieces.changes_of_motion(index);
        let loads = self.pieces.changes(index);
        let of = |r: &usize| {
            let inertia = self.all[*r].inertia.iter().zip(accelerations);
            let mut sum: f64 = inertia.map(|(per, a)| per.abs() * a).sum();
            for (change, (cell, _)) in loads.iter().zip(&stay.loads) {
                let lines = &self.cells[*cell];
                for k in (0..3).filter(|k| change.size(*k) > 0.0) {
                    sum += change.force[k] * lines.bounds[*r][k].size()
                        + change.size(k) * change.place * lines.slopes[*r][k];
                }
            }
            sum
        };
        chosen.iter().map(of).collect()
    }

    fn search(&self, stay: &Stay, chosen: &[usize], peaks: &mut [[Peak; 2]]) {
        let (mut values, mut near): (Vec<f64>, Vec<usize>) = (Vec::new(), Vec::new());
        for index in stay.pieces() {
            let piece = &self.pieces.pieces[index];
            values.clear();
            self.put(&self.pieces.at_middle(index), chosen, &mut values);
            let changes = self.changes(stay, index, chosen);
            let exceeds = |(n, r): (usize, &usize)| {
                let bounds = Bounds::at(values[n]).widened(changes[n]);
                (!bounds.is_within(known(&peaks[*r]), 0.0)).then_some(*r)
            };
            near.clear();
            near.extend(chosen.iter().enumerate().filter_map(exceeds));
            if near.is_empty() {
                continue;
            }
            let chosen = &near[..];
            values.clear();
            for k in 0..=piece.degree {
                self.put(&self.pieces.at_node(piece, k), chosen, &mut values);
            }
            let bounds = Bounds::of_columns(&values, chosen.len());
            for (n, r) in chosen.iter().enumerate() {
                if !bounds[n].is_within(known(&peaks[*r]), 0.0) {
                    let own = values.iter().skip(n).step_by(chosen.len());
                    let own: SmallVec<[f64; 17]> = own.copied().collect();
                    offer_piece(&mut peaks[*r], (index, piece.nodes()), &own);
                }
            }
        }
    }

    /// The largest and the smallest value of each quantity. First each is evaluated in the stay that has its largest bound, then in
    /// all others whose bounds exceed what is known. Those of all stays would fill the memory in a large hall. Where `is_stopped`
    /// says so, they are incomplete.
    pub fn peaks(&self, is_stopped: &dyn Fn() -> bool) -> Vec<[Peak; 2]> {
        let stays = &self.pieces.stays;
        let mut largest = vec![(0, f64::NEG_INFINITY); self.all.len()];
        for (number, stay) in stays.iter().enumerate() {
            for (known, bound) in largest.iter_mut().zip(self.bounds(stay)) {
                if bound.size() > known.1 {
                    *known = (number, bound.size());
                }
            }
        }
        let mut first: Vec<(usize, usize)> = largest
            .iter()
            .enumerate()
            .map(|(r, (stay, _))| (*stay, r))
            .collect();
        first.sort_unstable();
        let mut peaks = vec![[Peak::NONE; 2]; self.all.len()];
        for own in first
            .chunk_by(|a, b| a.0 == b.0)
            .filter(|_| !stays.is_empty())
        {
            let chosen: Vec<usize> = own.iter().map(|(_, r)| *r).collect();
            self.search(&stays[own[0].0], &chosen, &mut peaks);
        }
        for stay in stays {
            if is_stopped() {
                break;
            }
            let bounds = self.bounds(stay);
            let exceeds = |r: &usize| {
                let known = known(&peaks[*r]);
                !bounds[*r].is_within(known, known.into_iter().fold(0.0, f64::max))
            };
            let chosen: Vec<usize> = (0..self.all.len()).filter(exceeds).collect();
            if !chosen.is_empty() {
                self.search(stay, &chosen, &mut peaks);
            }
        }
        peaks
    }

    /// Values of a quantity in their order: those at the ends of pieces, and those at which it turns between them.
    pub fn turns(&self, r: usize) -> Vec<ColumnInstant> {
        let mut out: Vec<ColumnInstant> = Vec::new();
        let mut values: Vec<f64> = Vec::new();
        for piece in &self.pieces.pieces {
            values.clear();
            for k in 0..=piece.degree {
                let state = self.pieces.at_node(piece, k);
                self.put(&state, &[r], &mut values);
            }
            let polynomial = piece.nodes().polynomial(&values);
            let slope = polynomial.derivative();
            let at = |value: f64, share: f64| ColumnInstant {
                value,
                time: piece.time(share),
            };
            out.push(at(values[0], 0.0));
            if slope.bounds()[0] < 0.0 && slope.bounds()[1] > 0.0 {
                out.extend(
                    slope
                        .roots()
                        .into_iter()
                        .map(|s| at(polynomial.value(s), s)),
                );
            }
            out.push(at(values[piece.degree], 1.0));
        }
        out
    }
}

impl CellLines {
    fn new(
        lines: &InfluenceLines,
        all: &[Functional],
        (cells, cell): (&RailCells, Cell),
    ) -> CellLines {
        let (rail, [low, high]) = (cell.0, cells.inside(cell));
        let nodes = Lobatto::of(LINE_DEGREE);
        let mut out = CellLines {
            inside: [low, high],
            ends: cells.ends(cell),
            coefficients: vec![[[0.0; LINE_DEGREE + 1]; 3]; all.len()],
            bounds: vec![[Bounds::ZERO; 3]; all.len()],
            slopes: vec![[0.0; 3]; all.len()],
        };
        let mut ordinates = vec![0.0; lines.len()];
        for (direction, axis) in Axis::ALL.into_iter().enumerate() {
            let mut values = vec![[0.0; LINE_DEGREE + 1]; all.len()];
            for (n, share) in nodes.nodes().iter().enumerate() {
                let x = low + share * (high - low);
                if lines.fill(Probe { rail, x, axis }, &mut ordinates).is_ok() {
                    for (values, own) in values.iter_mut().zip(all) {
                        let terms = own
                            .terms
                            .iter()
                            .map(|(line, factor)| factor * ordinates[*line]);
                        values[n] = terms.sum();
                    }
                }
            }
            for (r, values) in values.iter().enumerate() {
                let polynomial = nodes.polynomial(values);
                out.bounds[r][direction] = Bounds::of(&polynomial);
                let slope = Bounds::of(&polynomial.derivative()).size();
                out.slopes[r][direction] = slope / (high - low);
                let coefficients = out.coefficients[r][direction].iter_mut();
                coefficients
                    .zip(polynomial.powers())
                    .for_each(|(own, c)| *own = c);
            }
        }
        out
    }

    /// Powers of the share of the cell at the coordinate of a load, from the first. A load that is held just inside of the cell is
    /// at its end.
    fn powers(&self, x: f64) -> [f64; LINE_DEGREE] {
        let [low, high] = self.inside;
        let x = match x {
            _ if x == low => self.ends[0],
            _ if x == high => self.ends[1],
            x => x,
        };
        let s = (x - low) / (high - low);
        [s, s * s, s * s * s, s * s * s * s]
    }

    /// A quantity under a load.
    fn value(&self, r: usize, powers: &[f64; LINE_DEGREE], force: &[f64; 3]) -> f64 {
        let of = |(force, c): (&f64, &[f64; LINE_DEGREE + 1])| {
            if *force == 0.0 {
                return 0.0;
            }
            let higher: f64 = c[1..].iter().zip(powers).map(|(c, power)| c * power).sum();
            force * (c[0] + higher)
        };
        force.iter().zip(&self.coefficients[r]).map(of).sum()
    }
}
