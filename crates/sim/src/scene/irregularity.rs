//! Irregularity of an unloaded rail: height and lateral offset along the rail, which may have steps.

use std::f64::consts::TAU;
use std::ops::Range;

use splines::Axis;

use super::error::Error;

/// Distance from a corner, relative to 1 + |x|, within which a wheel is considered to be at the corner.
const SLACK: f64 = 2e-9;

/// A sinusoid amplitude sin(2 pi (x - from) / length + phase) between `from` and `to`, and zero elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Amplitude, a length.
    pub amplitude: f64,
    /// Wavelength, > 0.
    pub length: f64,
    /// Phase at `from`, radian.
    pub phase: f64,
    /// First and last x. Where an end is not finite, the sinusoid is unlimited on that side; without a finite start,
    /// the phase is that at x = 0.
    pub range: [f64; 2],
}

/// Track irregularity: height y0(x) above, and lateral offset z0(x) from, the straight rail.
///
/// The irregularity is the sum of tables and sinusoids. A table is linear between its rows and constant before the
/// first and after the last row; two rows at the same x define a step. Time steps of a run end at the corners.
/// ```
/// use sim::{Irregularity, Wave};
/// use splines::Axis;
///
/// // A joint that is 1 mm low at 12 m, and waves of 2 mm from 20 m to 26 m.
/// let joint = Irregularity::new(&[[11.9, 0.0], [12.0, -1e-3], [12.1, 0.0]], &[])?;
/// let wave = Wave { amplitude: 2e-3, length: 1.5, phase: 0.0, range: [20.0, 26.0] };
/// let shape = joint.plus(&Irregularity::wave(Axis::Vertical, wave)?);
/// assert_eq!(shape.breaks(), [11.9, 12.0, 12.1, 20.0, 26.0]);
/// # Ok::<(), sim::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Irregularity {
    /// Starting coordinates of all pieces except the first one.
    starts: Vec<f64>,
    /// The pieces; there is one more than `starts`.
    pieces: Vec<Piece>,
    waves: Vec<Swell>,
}

/// One linear piece: value and slope at x, vertical and lateral.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Piece {
    x: f64,
    sides: [[f64; 2]; 2],
}

/// A sinusoid and the range of pieces that it covers.
#[derive(Clone, Debug, PartialEq)]
struct Swell {
    side: usize,
    wave: Wave,
    pieces: Range<usize>,
}

pub(crate) const VERTICAL: usize = 0;
pub(crate) const LATERAL: usize = 1;

/// Number of cells in the shortest wavelength. A polynomial of degree five errs by (pi/CELLS)^6/720 of the amplitude in a
/// cell, 3e-13.
const CELLS: f64 = 128.0;

/// The shape of a rail in one of the cells into which its shortest wavelength is divided, as a polynomial in the distance
/// from the centre of the cell: a function of the place alone, whichever places were asked for before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShapeCell {
    piece: usize,
    centre: f64,
    /// Half of its width, or -1 before its first use.
    half: f64,
    terms: [f64; 6],
}

impl Default for ShapeCell {
    fn default() -> Self {
        ShapeCell {
            piece: 0,
            centre: 0.0,
            half: -1.0,
            terms: [0.0; 6],
        }
    }
}

impl ShapeCell {
    /// Value and slope of one side of `shape` at `x` on `piece`, which is extrapolated beyond its ends.
    #[inline]
    pub(crate) fn at(
        &mut self,
        shape: &Irregularity,
        side: usize,
        piece: usize,
        x: f64,
    ) -> [f64; 2] {
        let is_inside =
            |cell: &ShapeCell| x > cell.centre - cell.half && x < cell.centre + cell.half;
        if !(is_inside(self) && piece == self.piece) {
            let width = shape.cell_width(side);
            let centre = if width.is_finite() {
                (x / width).round() * width
            } else {
                0.0
            };
            *self = ShapeCell {
                piece,
                centre,
                half: 0.5 * width,
                terms: shape.expansion(side, piece, centre),
            };
        }
        let (d, [a, b, c, d3, e, f]) = (x - self.centre, self.terms);
        let square = d * d;
        let value = (a + d * b) + square * ((c + d * d3) + square * (e + d * f));
        let slope =
            (b + d * (2.0 * c)) + square * ((3.0 * d3 + d * (4.0 * e)) + square * (5.0 * f));
        [value, slope]
    }
}

impl Irregularity {
    /// Builds the irregularity from rows (x, y0) and (x, z0); an empty table is zero.
    ///
    /// # Errors
    /// Numbers that are not finite, x that decreases, or three rows at the same x.
    pub fn new(vertical: &[[f64; 2]], lateral: &[[f64; 2]]) -> Result<Self, Error> {
        let what = "x of an irregularity";
        for table in [vertical, lateral] {
            if let Some(&found) = table.iter().flatten().find(|number| !number.is_finite()) {
                return Err(Error::Number {
                    what: "irregularity",
                    wanted: "finite",
                    found,
                });
            }
            if let Some(pair) = table.windows(2).find(|pair| pair[1][0] < pair[0][0]) {
                return Err(Error::Number {
                    what,
                    wanted: "not falling",
                    found: pair[1][0],
                });
            }
            if let Some(row) = table.windows(3).find(|row| row[2][0] == row[0][0]) {
                return Err(Error::Number {
                    what,
                    wanted: "in two rows at most",
                    found: row[0][0],
                });
            }
        }
        let mut starts: Vec<f64> = vertical.iter().chain(lateral).map(|row| row[0]).collect();
        starts.sort_by(f64::total_cmp);
        starts.dedup();
        let first = |table: &[[f64; 2]]| [table.first().map_or(0.0, |row| row[1]), 0.0];
        let x = starts.first().copied().unwrap_or(0.0);
        let before = Piece {
            x,
            sides: [vertical, lateral].map(first),
        };
        let after = starts.iter().map(|&x| Piece {
            x,
            sides: [vertical, lateral].map(|t| linear(t, x)),
        });
        Ok(Irregularity {
            pieces: std::iter::once(before).chain(after).collect(),
            starts,
            waves: Vec::new(),
        })
    }

    /// A single sinusoid, vertical or lateral.
    ///
    /// # Errors
    /// The longitudinal axis, numbers that are not finite, a wavelength that is not positive, or a range that is not
    /// increasing.
    pub fn wave(axis: Axis, wave: Wave) -> Result<Self, Error> {
        let what = "sinusoid of an irregularity";
        let side = match axis {
            Axis::Vertical => VERTICAL,
            Axis::Lateral => LATERAL,
            Axis::Longitudinal => {
                return Err(Error::NoSuch {
                    what: "irregularity along the rail",
                    index: 0,
                });
            }
        };
        let [from, to] = wave.range;
        for (wanted, found, holds) in [
            ("finite", wave.amplitude, wave.amplitude.is_finite()),
            (
                "of positive length",
                wave.length,
                wave.length > 0.0 && wave.length.is_finite(),
            ),
            ("finite", wave.phase, wave.phase.is_finite()),
            ("from low to high", to, from < to),
        ] {
            if !holds {
                return Err(Error::Number {
                    what,
                    wanted,
                    found,
                });
            }
        }
        let starts: Vec<f64> = wave.range.into_iter().filter(|x| x.is_finite()).collect();
        let first = usize::from(from.is_finite());
        Ok(Irregularity {
            pieces: vec![Piece::default(); starts.len() + 1],
            starts,
            waves: vec![Swell {
                side,
                wave,
                pieces: first..first + 1,
            }],
        })
    }

    /// The sum of two irregularities.
    #[must_use]
    pub fn plus(&self, other: &Irregularity) -> Self {
        if self.is_straight() || other.is_straight() {
            return if self.is_straight() {
                other.clone()
            } else {
                self.clone()
            };
        }
        let mut starts: Vec<f64> = self.starts.iter().chain(&other.starts).copied().collect();
        starts.sort_by(f64::total_cmp);
        starts.dedup();
        let first = starts.first().copied().unwrap_or(0.0);
        let at = |shape: &Irregularity, piece: usize, x: f64| {
            [VERTICAL, LATERAL].map(|s| shape.pieces[piece].at(s, x))
        };
        let mut pieces = Vec::with_capacity(starts.len() + 1);
        for x in std::iter::once(None).chain(starts.iter().copied().map(Some)) {
            let number = |shape: &Irregularity| {
                x.map_or(0, |x| shape.starts.partition_point(|start| *start <= x))
            };
            let x = x.unwrap_or(first);
            let [a, b] = [self, other].map(|shape| at(shape, number(shape), x));
            let sides = std::array::from_fn(|s| std::array::from_fn(|k| a[s][k] + b[s][k]));
            pieces.push(Piece { x, sides });
        }
        let moved = |swell: &Swell| {
            let mut swell = swell.clone();
            let [from, to] = swell
                .wave
                .range
                .map(|x| starts.partition_point(|start| *start <= x));
            // A range without a finite end extends to the last piece.
            swell.pieces = from..if swell.wave.range[1].is_finite() {
                to
            } else {
                starts.len() + 1
            };
            swell
        };
        let waves = self.waves.iter().chain(&other.waves).map(moved).collect();
        Irregularity {
            starts,
            pieces,
            waves,
        }
    }

    /// Whether the rail has no irregularity.
    #[must_use]
    pub fn is_straight(&self) -> bool {
        self.starts.is_empty() && self.waves.is_empty()
    }

    /// The vertical irregularity averaged over points `ahead` of a place x, as a function of x; `None` where it has corners
    /// or ends. The mean of sinusoids of one wavelength is a sinusoid of the same wavelength: with c and s the means of
    /// cos(2 pi d/length) and sin(2 pi d/length) over the distances d, its amplitude is (c^2 + s^2)^(1/2) times that of one,
    /// and its phase is ahead by atan2(s, c).
    pub(crate) fn averaged(&self, ahead: &[f64]) -> Option<Irregularity> {
        if !self.starts.is_empty() {
            return None;
        }
        let mean = |swell: &Swell| {
            let turns = ahead
                .iter()
                .map(|distance| (TAU * distance / swell.wave.length).sin_cos());
            let [s, c] = turns.fold([0.0; 2], |sum, (s, c)| [sum[0] + s, sum[1] + c]);
            let amplitude = swell.wave.amplitude * s.hypot(c) / ahead.len() as f64;
            let wave = Wave {
                amplitude,
                phase: swell.wave.phase + s.atan2(c),
                ..swell.wave
            };
            Swell {
                wave,
                ..swell.clone()
            }
        };
        let waves = self
            .waves
            .iter()
            .filter(|swell| swell.side == VERTICAL)
            .map(mean)
            .collect();
        Some(Irregularity {
            waves,
            ..self.clone()
        })
    }

    /// Coordinates of the corners and steps.
    #[must_use]
    pub fn breaks(&self) -> &[f64] {
        &self.starts
    }

    /// Coordinates of the steps, where the height changes, and by how much it is larger beyond them.
    pub(crate) fn steps(&self) -> impl Iterator<Item = [f64; 2]> {
        self.starts.iter().enumerate().filter_map(|(k, &x)| {
            let [before, after] = [k, k + 1].map(|piece| self.vertical(piece, x)[0]);
            let is_step = (after - before).abs() > 1e-9 * (before.abs() + after.abs());
            is_step.then_some([x, after - before])
        })
    }

    /// Index of the piece at `x` for a wheel that moves in `direction` (the sign counts). At a corner it is the piece
    /// that the wheel moves into, or `current` where the wheel is at rest.
    pub(crate) fn piece(&self, x: f64, direction: f64, current: usize) -> usize {
        let slack = SLACK * (1.0 + x.abs());
        let [low, high] =
            [x - slack, x + slack].map(|x| self.starts.partition_point(|start| *start <= x));
        if direction > 0.0 {
            high
        } else if direction < 0.0 {
            low
        } else {
            current.clamp(low, high)
        }
    }

    /// Width of the cells of a side; infinite where it has no sinusoids.
    fn cell_width(&self, side: usize) -> f64 {
        let own = self.waves.iter().filter(|swell| swell.side == side);
        own.fold(f64::INFINITY, |least, swell| least.min(swell.wave.length)) / CELLS
    }

    /// Taylor coefficients of a side about `x` on `piece`.
    fn expansion(&self, side: usize, piece: usize, x: f64) -> [f64; 6] {
        let [value, slope] = self
            .pieces
            .get(piece)
            .map_or([0.0; 2], |found| found.at(side, x));
        let mut terms = [value, slope, 0.0, 0.0, 0.0, 0.0];
        for swell in self
            .waves
            .iter()
            .filter(|swell| swell.side == side && swell.pieces.contains(&piece))
        {
            let [value, slope] = swell.wave.at(x);
            let square = (TAU / swell.wave.length).powi(2);
            let own = [value, slope, -square / 2.0 * value, -square / 6.0 * slope];
            let last = [
                square * square / 24.0 * value,
                square * square / 120.0 * slope,
            ];
            terms
                .iter_mut()
                .zip(own.iter().chain(&last))
                .for_each(|(sum, own)| *sum += own);
        }
        terms
    }

    /// y0 and its slope at `x` on `piece`, which is extrapolated beyond its ends.
    pub(crate) fn vertical(&self, piece: usize, x: f64) -> [f64; 2] {
        self.side(VERTICAL, piece, x)
    }

    fn side(&self, side: usize, piece: usize, x: f64) -> [f64; 2] {
        let [value, slope, ..] = self.expansion(side, piece, x);
        [value, slope]
    }
}

impl Piece {
    fn at(&self, side: usize, x: f64) -> [f64; 2] {
        let [value, slope] = self.sides[side];
        [value + slope * (x - self.x), slope]
    }
}

impl Wave {
    fn at(&self, x: f64) -> [f64; 2] {
        let origin = if self.range[0].is_finite() {
            self.range[0]
        } else {
            0.0
        };
        let (sin, cos) = (TAU * (x - origin) / self.length + self.phase).sin_cos();
        [
            self.amplitude * sin,
            self.amplitude * TAU / self.length * cos,
        ]
    }
}

/// Value and slope of a table immediately after `x`.
fn linear(table: &[[f64; 2]], x: f64) -> [f64; 2] {
    let next = table.partition_point(|row| row[0] <= x);
    match (
        next.checked_sub(1).and_then(|before| table.get(before)),
        table.get(next),
    ) {
        (Some(&[x0, y0]), Some(&[x1, y1])) => {
            let slope = (y1 - y0) / (x1 - x0);
            [y0 + slope * (x - x0), slope]
        }
        (Some(&[_, value]), None) | (None, Some(&[_, value])) => [value, 0.0],
        (None, None) => [0.0, 0.0],
    }
}

#[cfg(test)]
mod tests;
