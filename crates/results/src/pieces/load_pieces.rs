//! Loads on a structure and its motion over a run, in pieces of time in which both are polynomials.
//!
//! The intervals of a solution are divided where a load passes an end of a member or of a span, so that in a piece every load
//! stays in one cell of its rail. There the influence line of any force, reaction or deflection is one cubic, and what the loads
//! cause is smooth. At the ends of a piece loads are held just inside their cells.
//!
//! All pieces that have the loads in the same cells, such as those of repeated trips, are a stay. Bounds of what the loads of a stay can cause at
//! a place far from them show which stays need not be looked at.

use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;

use piecewise::{Lobatto, between};
use sim::{Channel, NodeInterval, Side, Solution, SolutionNodes};
use smallvec::SmallVec;
use trains::RailLoad;

use super::bounds::Bounds;
use super::cells::{Cell, RailCells};
use crate::loads::{LoadSource, WheelLoadReader};

/// Of how many pieces of a stay the first one is looked at before the others.
const FIRST: usize = 16;

/// A time within a piece: its number, and the share of its length from its start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Instant {
    pub piece: usize,
    pub share: f64,
}

/// Loads on the structure and its motion at one time.
pub(crate) struct LoadState<'a> {
    /// Loads on its rails, always in the same order.
    pub loads: SmallVec<[RailLoad; 8]>,
    /// Of each load the number of its cell among those that are visited, and bounds of its components.
    pub cells: &'a [(usize, [Bounds; 3])],
    row: Cow<'a, [f64]>,
    motion: [Range<usize>; 2],
}

impl LoadState<'_> {
    /// Displacements of the degrees of freedom of the structure.
    pub fn dofs(&self) -> &[f64] {
        &self.row[self.motion[0].clone()]
    }

    /// Accelerations of the degrees of freedom.
    pub fn accelerations(&self) -> &[f64] {
        &self.row[self.motion[1].clone()]
    }
}

/// A piece of time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub interval: [f64; 2],
    pub degree: usize,
    /// Number of the row at its start; those of the other nodes follow. Rows beyond those of the solution are of cut intervals.
    row: usize,
    /// Number of its stay.
    pub stay: usize,
}

/// How much a load changes in a piece.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Change {
    /// Largest differences of its components from those at the middle node.
    pub force: [f64; 3],
    /// Largest difference of its place from that at the middle node.
    pub place: f64,
    /// Bounds of its components.
    pub bounds: [Bounds; 3],
}

impl Change {
    /// Largest magnitude of a component.
    pub fn size(&self, direction: usize) -> f64 {
        self.bounds[direction].size()
    }
}

impl Piece {
    pub fn nodes(&self) -> &'static Lobatto {
        Lobatto::of(self.degree)
    }

    /// The time at a share of it.
    pub fn time(&self, share: f64) -> f64 {
        between(self.interval, share)
    }
}

/// All pieces in which the loads are in the same cells.
#[derive(Clone, Debug)]
pub(crate) struct Stay {
    /// Their numbers, in order.
    pieces: Vec<Range<usize>>,
    /// By load: the number of its cell among those that are visited, and bounds of its components.
    pub loads: Vec<(usize, [Bounds; 3])>,
    /// Bounds of displacements and accelerations of the degrees of freedom.
    pub dofs: Vec<Bounds>,
    pub accelerations: Vec<Bounds>,
}

impl Stay {
    /// The numbers of its pieces: first one of several, so that large values are known early, then the others.
    pub fn pieces(&self) -> impl Iterator<Item = usize> + '_ {
        [true, false].into_iter().flat_map(|is_early| {
            let all = self.pieces.iter().flat_map(Range::clone);
            all.filter(move |number| number.is_multiple_of(FIRST) == is_early)
        })
    }
}

/// The pieces of a run for one structure.
pub(crate) struct LoadPieces<'a> {
    solution: &'a Solution,
    nodes: &'a SolutionNodes,
    sources: Vec<LoadSource>,
    /// Channels of the displacements and of the accelerations.
    motion: [Range<usize>; 2],
    cells: RailCells,
    /// The cells in which loads stand during the run, each once.
    visited: Vec<Cell>,
    /// Rows of cut intervals.
    cut: Vec<f64>,
    /// The changes of all loads in all pieces.
    changes: Vec<Change>,
    /// Those of the displacements and of the accelerations in all pieces.
    motion_changes: Vec<f64>,
    pub pieces: Vec<Piece>,
    pub stays: Vec<Stay>,
}

impl<'a> LoadPieces<'a> {
    /// The pieces of a run for structure `s` with `dofs` recorded degrees of freedom.
    pub fn new(
        (solution, nodes): (&'a Solution, &'a SolutionNodes),
        loads: &WheelLoadReader,
        (s, dofs): (usize, usize),
        cells: RailCells,
    ) -> LoadPieces<'a> {
        let channels = |first: Channel| {
            let first = solution.position(first);
            first.map_or(0..0, |first| first..first + dofs)
        };
        let motion = [Channel::Coordinate(s, 0), Channel::Acceleration(s, 0)].map(channels);
        let mut out = LoadPieces {
            solution,
            nodes,
            sources: loads.on(s).cloned().collect(),
            motion,
            cells,
            visited: Vec::new(),
            cut: Vec::new(),
            changes: Vec::new(),
            motion_changes: Vec::new(),
            pieces: Vec::new(),
            stays: Vec::new(),
        };
        let mut known = HashMap::new();
        for interval in &nodes.intervals {
            out.add(*interval, &mut known);
        }
        let of_piece = |piece: &Piece| out.changes_in(piece);
        out.changes = out.pieces.iter().flat_map(of_piece).collect();
        let of_motion = |piece: &Piece| out.motion_changes_in(piece);
        out.motion_changes = out.pieces.iter().flat_map(of_motion).collect();
        for stay in 0..out.stays.len() {
            out.bound(stay);
        }
        out
    }

    /// Adds an interval of the solution, divided where loads pass ends of cells.
    fn add(
        &mut self,
        NodeInterval { first, degree }: NodeInterval,
        known: &mut HashMap<Vec<usize>, usize>,
    ) {
        let nodes = Lobatto::of(degree);
        let rows = &self.nodes.rows;
        let [from, to] = [first, first + degree].map(|row| rows.sample(row)[0]);
        let mut shares = SmallVec::<[f64; 8]>::new();
        for source in &self.sources {
            let places = |row: usize| source.load_in(rows.sample(row)).x;
            let x: SmallVec<[f64; 16]> = (first..=first + degree).map(places).collect();
            let rail = source.load_in(rows.sample(first)).rail;
            let passed = self.cells.between(rail, Bounds::through(x.iter().copied()));
            for end in passed {
                let distances: SmallVec<[f64; 16]> = x.iter().map(|x| x - end).collect();
                shares.extend(nodes.polynomial(&distances).roots());
            }
        }
        shares.retain(|share| *share > 1e-9 && *share < 1.0 - 1e-9);
        shares.sort_by(f64::total_cmp);
        shares.dedup_by(|b, a| *b - *a < 1e-9);
        if shares.is_empty() {
            return self.push(
                Piece {
                    interval: [from, to],
                    degree,
                    row: first,
                    stay: 0,
                },
                known,
            );
        }
        shares.push(1.0);
        let mut begin = 0.0;
        for end in shares {
            let time = |share: f64| between([from, to], share);
            let interval = [begin, end].map(time);
            let row = rows.len() + self.cut.len() / rows.channels().len();
            for node in nodes.nodes() {
                let share = begin + node * (end - begin);
                let side = if share > 0.0 {
                    Side::Before
                } else {
                    Side::After
                };
                self.solution.row(time(share), side, &mut self.cut);
            }
            self.push(
                Piece {
                    interval,
                    degree,
                    row,
                    stay: 0,
                },
                known,
            );
            begin = end;
        }
    }

    /// Adds a piece to the stay with its cells, or to a new one.
    fn push(&mut self, piece: Piece, known: &mut HashMap<Vec<usize>, usize>) {
        let middle = self.row(&piece, piece.degree / 2);
        let cells: SmallVec<[Cell; 8]> = self
            .sources
            .iter()
            .map(|source| {
                let load = source.load_in(middle);
                self.cells.of(load.rail, load.x)
            })
            .collect();
        let number = |cell: Cell| {
            let known = self.visited.iter().position(|own| *own == cell);
            known.unwrap_or_else(|| {
                self.visited.push(cell);
                self.visited.len() - 1
            })
        };
        let cells: Vec<usize> = cells.into_iter().map(number).collect();
        let (number, stays) = (self.pieces.len(), &mut self.stays);
        let stay = *known.entry(cells).or_insert_with_key(|cells| {
            stays.push(Stay {
                pieces: Vec::new(),
                loads: cells
                    .iter()
                    .map(|cell| (*cell, [Bounds::ZERO; 3]))
                    .collect(),
                dofs: Vec::new(),
                accelerations: Vec::new(),
            });
            stays.len() - 1
        });
        match stays[stay]
            .pieces
            .last_mut()
            .filter(|last| last.end == number)
        {
            Some(last) => last.end += 1,
            None => stays[stay].pieces.push(number..number + 1),
        }
        self.pieces.push(Piece { stay, ..piece });
    }

    /// The changes of all loads in a piece.
    fn changes_in(&self, piece: &Piece) -> SmallVec<[Change; 8]> {
        let of_load = |source: &LoadSource| {
            let all: SmallVec<[RailLoad; 17]> = (0..=piece.degree)
                .map(|k| source.load_in(self.row(piece, k)))
                .collect();
            let middle = all[piece.degree / 2];
            let place = Bounds::through(all.iter().map(|load| load.x - middle.x));
            let bounds: [Bounds; 3] =
                std::array::from_fn(|k| Bounds::through(all.iter().map(|load| load.force[k])));
            Change {
                force: std::array::from_fn(|k| bounds[k].distance(middle.force[k])),
                place: place.size(),
                bounds,
            }
        };
        self.sources.iter().map(of_load).collect()
    }

    /// The changes of all loads in a piece.
    pub fn changes(&self, piece: usize) -> &[Change] {
        let count = self.sources.len();
        &self.changes[piece * count..(piece + 1) * count]
    }

    /// The changes of displacements, and behind them of accelerations, in a piece.
    fn motion_changes_in(&self, piece: &Piece) -> Vec<f64> {
        let middle = self.row(piece, piece.degree / 2);
        let of = |c: usize| {
            let rows = (0..=piece.degree).map(|k| self.row(piece, k)[c] - middle[c]);
            Bounds::through(rows).size()
        };
        self.motion.iter().cloned().flatten().map(of).collect()
    }

    /// Largest differences of displacements and of accelerations from those at the middle node of a piece.
    pub fn changes_of_motion(&self, piece: usize) -> [&[f64]; 2] {
        let [displaced, accelerated] = self.motion.each_ref().map(ExactSizeIterator::len);
        let count = displaced + accelerated;
        let own = &self.motion_changes[piece * count..(piece + 1) * count];
        own.split_at(displaced).into()
    }

    /// The state at the middle node of a piece.
    pub fn at_middle(&self, piece: usize) -> LoadState<'_> {
        let piece = &self.pieces[piece];
        self.at_node(piece, piece.degree / 2)
    }

    /// Computes the bounds of a stay.
    fn bound(&mut self, stay: usize) {
        let pieces: Vec<usize> = self.stays[stay].pieces().collect();
        let all = |of: &dyn Fn(usize) -> Bounds| {
            let each = pieces.iter().map(|piece| of(*piece));
            each.reduce(Bounds::with).unwrap_or(Bounds::ZERO)
        };
        let of_load = |load: usize, k: usize| all(&|piece| self.changes(piece)[load].bounds[k]);
        let forces: Vec<[Bounds; 3]> = (0..self.sources.len())
            .map(|load| std::array::from_fn(|k| of_load(load, k)))
            .collect();
        let of_channel = |c: usize| {
            all(&|piece| {
                let piece = &self.pieces[piece];
                Bounds::through((0..=piece.degree).map(|k| self.row(piece, k)[c]))
            })
        };
        let [dofs, accelerations] = self
            .motion
            .clone()
            .map(|range| range.map(of_channel).collect());
        let own = &mut self.stays[stay];
        (own.dofs, own.accelerations) = (dofs, accelerations);
        own.loads
            .iter_mut()
            .zip(forces)
            .for_each(|(own, forces)| own.1 = forces);
    }

    /// The values of all channels at node `k` of a piece.
    fn row(&self, piece: &Piece, k: usize) -> &[f64] {
        let (row, known) = (piece.row + k, self.nodes.rows.len());
        match row.checked_sub(known) {
            None => self.nodes.rows.sample(row),
            Some(row) => {
                let width = self.nodes.rows.channels().len();
                &self.cut[row * width..(row + 1) * width]
            }
        }
    }

    /// The loads of a row, held in the cells of a stay.
    fn held(&self, stay: usize, row: &[f64]) -> impl Iterator<Item = RailLoad> {
        let cells = &self.stays[stay].loads;
        self.sources.iter().zip(cells).map(|(source, (cell, _))| {
            let mut load = source.load_in(row);
            load.x = self.cells.hold(self.visited[*cell], load.x);
            load
        })
    }

    /// The state at node `k` of a piece.
    pub fn at_node(&self, piece: &Piece, k: usize) -> LoadState<'_> {
        let row = self.row(piece, k);
        LoadState {
            loads: self.held(piece.stay, row).collect(),
            cells: &self.stays[piece.stay].loads,
            row: Cow::Borrowed(row),
            motion: self.motion.clone(),
        }
    }

    /// The state at an instant.
    pub fn at(&self, instant: Instant) -> LoadState<'_> {
        let piece = &self.pieces[instant.piece];
        match instant.share {
            0.0 => self.at_node(piece, 0),
            1.0 => self.at_node(piece, piece.degree),
            share => {
                let mut row = Vec::new();
                self.solution.row(piece.time(share), Side::Before, &mut row);
                LoadState {
                    loads: self.held(piece.stay, &row).collect(),
                    cells: &self.stays[piece.stay].loads,
                    row: Cow::Owned(row),
                    motion: self.motion.clone(),
                }
            }
        }
    }

    /// The time of an instant.
    pub fn time(&self, instant: Instant) -> f64 {
        self.pieces[instant.piece].time(instant.share)
    }

    /// The cells in which loads stand during the run, each once.
    pub fn visited(&self) -> &[Cell] {
        &self.visited
    }

    /// The cells of the rails.
    pub fn cells(&self) -> &RailCells {
        &self.cells
    }

    /// Whether any load has a force along +x, upwards and along +z of its rail at any time.
    pub fn directions(&self) -> [bool; 3] {
        let loads = || self.stays.iter().flat_map(|stay| &stay.loads);
        std::array::from_fn(|k| loads().any(|(_, force)| !force[k].is_zero()))
    }
}
