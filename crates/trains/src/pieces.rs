//! Responses to a train as piecewise cubics in its position.

use crate::line::{LineCell, Lines, bound_of_cubic, cell_at, shifted, value_of_cubic};
use crate::polynomial::{Polynomial, largest_of_cubic};
use crate::train::{COMPONENTS, PlacedTrain};

/// N responses to a train between two of its positions.
#[derive(Clone, Debug)]
pub(crate) struct Piece<const N: usize> {
    /// First and last position. Values at the ends are the limits from inside.
    pub position: [f64; 2],
    /// Cubics in the distance from the first position.
    pub cubics: [[f64; 4]; N],
    /// Whether every wheel that passes from a cell to the next at the first position does so within a member.
    pub begins_inside: bool,
}

impl<const N: usize> Piece<N> {
    pub fn length(&self) -> f64 {
        self.position[1] - self.position[0]
    }
}

/// One response to a train between two of its positions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ResponsePiece {
    /// First and last position. Values at the ends are the limits from inside.
    pub position: [f64; 2],
    /// Cubic in the distance from the first position.
    pub cubic: [f64; 4],
    /// The piece of the train's positions, and the part of it between passages of the section.
    pub origin: [usize; 2],
    /// Whether a wheel is at the section at the first and at the last position.
    pub at_section: [bool; 2],
}

impl ResponsePiece {
    pub fn length(&self) -> f64 {
        self.position[1] - self.position[0]
    }

    /// Value at a position.
    pub fn at(&self, position: f64) -> f64 {
        value_of_cubic(&self.cubic, position - self.position[0])
    }

    /// A factor times the response.
    pub fn times(&self, factor: f64) -> Polynomial {
        Polynomial::new(&self.cubic.map(|c| factor * c))
    }

    /// Largest value of sign times the response, with its position.
    pub fn largest(&self, sign: f64) -> (f64, f64) {
        let (t, value) = largest_of_cubic(&self.cubic.map(|c| sign * c), self.length());
        (self.position[0] + t, value)
    }

    /// A bound of sign times the response: the largest of its Bernstein coefficients.
    pub fn bound(&self, sign: f64) -> f64 {
        bound_of_cubic(&self.cubic.map(|c| sign * c), self.length())
    }
}

impl Pieces<1> {
    /// The pieces as responses of an effect that no wheel passes.
    pub fn responses(&self) -> Vec<ResponsePiece> {
        let of = |(index, piece): (usize, &Piece<1>)| ResponsePiece {
            position: piece.position,
            cubic: piece.cubics[0],
            origin: [index, 0],
            at_section: [false; 2],
        };
        self.list.iter().enumerate().map(of).collect()
    }
}

/// The pieces of a train, with the cell in which each of its wheels stands.
#[derive(Clone, Debug)]
pub(crate) struct Pieces<const N: usize> {
    pub list: Vec<Piece<N>>,
    /// Stretch of rail under each wheel, wheels of the first piece first; `None` beyond the rail.
    stretches: Vec<Option<usize>>,
    wheels: usize,
}

impl<const N: usize> Pieces<N> {
    /// Stretches of rail under the wheels in a piece.
    pub fn stretches(&self, piece: usize) -> &[Option<usize>] {
        &self.stretches[piece * self.wheels..(piece + 1) * self.wheels]
    }

    /// Sums the influence lines of all wheels. Between two positions at which a wheel passes from a cell to the next,
    /// the sum is one cubic; each piece is summed anew, so that no rounding accumulates. Passages closer together than
    /// `slack` count as one.
    pub fn sum(lines: &Lines<N>, train: &PlacedTrain, slack: f64) -> Pieces<N> {
        let [first, last] = train.range;
        let mut breaks = vec![(first, false), (last, false)];
        for wheel in &train.wheels {
            let cells = &lines.rails[wheel.rail];
            let starts = cells.iter().map(|cell| (cell.x[0], cell.begins_inside));
            let ends = starts.chain(cells.last().map(|cell| (cell.x[1], false)));
            let all = ends.map(|(x, is_inside)| (x - wheel.offset, is_inside));
            breaks.extend(all.filter(|(p, _)| *p > first + slack && *p < last - slack));
        }
        breaks.sort_by(|a, b| a.0.total_cmp(&b.0));
        breaks.dedup_by(|b, a| {
            let is_one = b.0 - a.0 <= slack && b.0 != last;
            a.1 &= b.1 || !is_one;
            is_one
        });
        if last - first <= slack {
            breaks = vec![(first, false), (last, false)];
        }
        // Cubics of one wheel: wheels with equal loads on one rail share them.
        let mut kinds: Vec<(usize, [f64; COMPONENTS])> = Vec::new();
        let kind_of: Vec<usize> = train
            .wheels
            .iter()
            .map(|wheel| {
                let kind = (wheel.rail, wheel.load);
                kinds
                    .iter()
                    .position(|known| *known == kind)
                    .unwrap_or_else(|| {
                        kinds.push(kind);
                        kinds.len() - 1
                    })
            })
            .collect();
        let loaded: Vec<Vec<[[f64; 4]; N]>> = kinds
            .iter()
            .map(|(rail, load)| {
                lines.rails[*rail]
                    .iter()
                    .map(|cell| under(cell, load))
                    .collect()
            })
            .collect();
        let mut list = Vec::with_capacity(breaks.len() - 1);
        let mut stretches = Vec::with_capacity((breaks.len() - 1) * train.wheels.len());
        for pair in breaks.windows(2) {
            let ends = [pair[0].0, pair[1].0];
            let middle = 0.5 * (ends[0] + ends[1]);
            let mut cubics = [[0.0; 4]; N];
            for (wheel, kind) in train.wheels.iter().zip(&kind_of) {
                let cells = &lines.rails[wheel.rail];
                let found = cell_at(cells, middle + wheel.offset);
                stretches.push(found.and_then(|k| cells[k].stretch));
                if let Some(k) = found {
                    let t = ends[0] + wheel.offset - cells[k].x[0];
                    for (sum, cubic) in cubics.iter_mut().zip(&loaded[*kind][k]) {
                        add_shifted(sum, cubic, t);
                    }
                }
            }
            list.push(Piece {
                position: ends,
                cubics,
                begins_inside: pair[0].1,
            });
        }
        Pieces {
            list,
            stretches,
            wheels: train.wheels.len(),
        }
    }
}

/// The cubics of a cell under a load.
fn under<const N: usize>(cell: &LineCell<N>, load: &[f64; COMPONENTS]) -> [[f64; 4]; N] {
    let mut out = [[0.0; 4]; N];
    for (force, cubics) in load
        .iter()
        .zip(&cell.cubics)
        .filter(|(force, _)| **force != 0.0)
    {
        for (out, cubic) in out.iter_mut().zip(cubics) {
            out.iter_mut()
                .zip(cubic)
                .for_each(|(out, c)| *out += force * c);
        }
    }
    out
}

/// Adds the cubic c(x + t) to a cubic in x.
fn add_shifted(sum: &mut [f64; 4], cubic: &[f64; 4], t: f64) {
    sum.iter_mut()
        .zip(shifted(cubic, t))
        .for_each(|(sum, c)| *sum += c);
}
