//! Prescribed motion along a rail: position, speed and acceleration as functions of time.

use super::error::Error;

/// One time interval, in which the position is a cubic polynomial of the time since its start.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    start: f64,
    x: f64,
    v: f64,
    a: f64,
    jerk: f64,
}

/// Quantity that a table contains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionKind {
    /// Position along the rail.
    Position,
    /// Speed.
    Speed,
    /// Acceleration.
    Acceleration,
}

/// Position of a body along its rail as a function of time from 0 on.
///
/// Between the rows of its table the given quantity is linear in time; before the first and after the last row it is
/// constant. The position is therefore piecewise linear, quadratic or cubic, and is integrated exactly.
/// ```
/// use sim::{MotionKind, Profile};
///
/// // From rest at x = 4 m to 2 m/s within 5 s, then at constant speed.
/// let motion = Profile::new(MotionKind::Speed, &[[0.0, 0.0], [5.0, 2.0]], 4.0, 0.0)?;
/// assert_eq!((motion.at(5.0).x, motion.at(5.0).v), (9.0, 2.0));
/// assert_eq!(motion.at(6.0).x, 11.0);
/// # Ok::<(), sim::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    pieces: Vec<Piece>,
    breaks: Vec<f64>,
}

/// Position, speed and acceleration at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Travel {
    /// Position along the rail.
    pub x: f64,
    /// Speed.
    pub v: f64,
    /// Acceleration.
    pub a: f64,
}

impl Profile {
    /// Builds the motion from the rows (time, value) of `table`. `x0` and `v0` are the position and speed at time 0
    /// where the table does not define them.
    ///
    /// # Errors
    /// An empty table, times that do not increase, or numbers that are not finite.
    pub fn new(given: MotionKind, table: &[[f64; 2]], x0: f64, v0: f64) -> Result<Profile, Error> {
        check_rows(table)?;
        if let Some(found) = [x0, v0].into_iter().find(|number| !number.is_finite()) {
            return Err(Error::Number {
                what: "start of a motion",
                wanted: "finite",
                found,
            });
        }
        let mut pieces: Vec<Piece> = Vec::new();
        for start in starts(table) {
            let before = match pieces.last() {
                Some(piece) => piece.at(start),
                None => Travel {
                    x: x0,
                    v: v0,
                    a: 0.0,
                },
            };
            let (value, rate) = linear(table, start);
            pieces.push(match given {
                MotionKind::Position => Piece {
                    start,
                    x: value,
                    v: rate,
                    a: 0.0,
                    jerk: 0.0,
                },
                MotionKind::Speed => Piece {
                    start,
                    x: before.x,
                    v: value,
                    a: rate,
                    jerk: 0.0,
                },
                MotionKind::Acceleration => Piece {
                    start,
                    x: before.x,
                    v: before.v,
                    a: value,
                    jerk: rate,
                },
            });
        }
        let breaks = pieces
            .iter()
            .map(|piece| piece.start)
            .filter(|start| *start > 0.0)
            .collect();
        Ok(Profile { pieces, breaks })
    }

    /// Position, speed and acceleration at `t` >= 0; at a jump, the values immediately after it.
    #[must_use]
    pub fn at(&self, t: f64) -> Travel {
        let next = self.pieces.partition_point(|piece| piece.start <= t);
        match self.pieces.get(next.saturating_sub(1)) {
            Some(piece) => piece.at(t),
            None => Travel::default(),
        }
    }

    /// Largest distance of x from x(`from`) at times from `from` to `to`.
    #[must_use]
    pub(crate) fn reach(&self, from: f64, to: f64) -> f64 {
        let start = self.at(from).x;
        let first = self
            .pieces
            .partition_point(|piece| piece.start <= from)
            .saturating_sub(1);
        let mut farthest = (self.at(to).x - start).abs();
        for piece in self.pieces[first..]
            .iter()
            .take_while(|piece| piece.start < to)
        {
            let turns = zeros(piece.jerk / 2.0, piece.a, piece.v).map(|s| piece.start + s);
            for t in turns
                .chain([piece.start])
                .filter(|t| (from..=to).contains(t))
            {
                farthest = farthest.max((self.at(t).x - start).abs());
            }
        }
        farthest
    }

    /// The speed, where it is constant until `end` and x does not jump; `None` otherwise.
    #[must_use]
    pub(crate) fn uniform(&self, end: f64) -> Option<f64> {
        let first = self.pieces.first()?;
        let goes_on = |piece: &Piece| {
            let x = first.at(piece.start).x;
            (piece.v, piece.a, piece.jerk) == (first.v, 0.0, 0.0)
                && (piece.x - x).abs() <= 4.0 * f64::EPSILON * x.abs()
        };
        self.pieces
            .iter()
            .filter(|piece| piece.start < end)
            .all(goes_on)
            .then_some(first.v)
    }

    /// Times at which position, speed, acceleration or jerk may jump, except 0.
    #[must_use]
    pub fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    /// The first time in [0, `end`] at which x is outside `range`, with the position at that time; `None` where x is
    /// always inside.
    ///
    /// Where x leaves the range within an interval, the time is that of the crossing and x is outside by rounding
    /// only.
    #[must_use]
    pub fn leaves(&self, range: [f64; 2], end: f64) -> Option<(f64, f64)> {
        let outside = |x: f64| x < range[0] || x > range[1];
        let mut last = 0.0;
        for t in self.turning_times(end) {
            let x = self.at(t).x;
            if outside(x) {
                let (mut inside, mut beyond) = (last, t);
                if outside(self.at(inside).x) {
                    return Some((inside, self.at(inside).x));
                }
                // x is monotone in between.
                for _ in 0..200 {
                    let middle = inside + (beyond - inside) / 2.0;
                    if middle <= inside || middle >= beyond {
                        break;
                    }
                    if outside(self.at(middle).x) {
                        beyond = middle
                    } else {
                        inside = middle
                    }
                }
                return Some((beyond, self.at(beyond).x));
            }
            last = t;
        }
        None
    }

    /// Times in [0, `end`] between which x is monotone: the ends of the intervals and the zeros of the speed.
    fn turning_times(&self, end: f64) -> Vec<f64> {
        let mut times = vec![0.0, end];
        for (index, piece) in self.pieces.iter().enumerate() {
            let stop = self.pieces.get(index + 1).map_or(end, |next| next.start);
            times.push(piece.start);
            times.extend(
                zeros(piece.jerk / 2.0, piece.a, piece.v)
                    .map(|s| piece.start + s)
                    .filter(|t| *t < stop),
            );
        }
        times.retain(|t| (0.0..=end).contains(t));
        times.sort_by(f64::total_cmp);
        times
    }
}

impl Piece {
    fn at(&self, t: f64) -> Travel {
        let s = t - self.start;
        Travel {
            x: self.x + s * (self.v + s * (self.a / 2.0 + s * self.jerk / 6.0)),
            v: self.v + s * (self.a + s * self.jerk / 2.0),
            a: self.a + s * self.jerk,
        }
    }
}

/// Starts of the intervals: 0 and the times of the rows after it.
fn starts(table: &[[f64; 2]]) -> Vec<f64> {
    let mut starts = vec![0.0];
    starts.extend(table.iter().map(|row| row[0]).filter(|t| *t > 0.0));
    starts
}

/// Checks that there is at least one row, that all numbers are finite and that the times increase.
pub(crate) fn check_rows(table: &[[f64; 2]]) -> Result<(), Error> {
    if table.is_empty() {
        return Err(Error::Number {
            what: "rows of a table over time",
            wanted: "at least one",
            found: 0.0,
        });
    }
    if let Some(&found) = table.iter().flatten().find(|number| !number.is_finite()) {
        return Err(Error::Number {
            what: "table over time",
            wanted: "finite",
            found,
        });
    }
    match table.windows(2).find(|pair| pair[1][0] <= pair[0][0]) {
        Some(pair) => Err(Error::Number {
            what: "time of a table over time",
            wanted: "increasing",
            found: pair[1][0],
        }),
        None => Ok(()),
    }
}

/// Value and rate of change of the table immediately after `t`.
pub(crate) fn linear(table: &[[f64; 2]], t: f64) -> (f64, f64) {
    let next = table.partition_point(|row| row[0] <= t);
    match (
        next.checked_sub(1).and_then(|before| table.get(before)),
        table.get(next),
    ) {
        (Some(&[t0, v0]), Some(&[t1, v1])) => {
            let rate = (v1 - v0) / (t1 - t0);
            (v0 + rate * (t - t0), rate)
        }
        (Some(&[_, value]), None) | (None, Some(&[_, value])) => (value, 0.0),
        (None, None) => (0.0, 0.0),
    }
}

/// Positive zeros of a s^2 + b s + c, computed without cancellation.
fn zeros(a: f64, b: f64, c: f64) -> impl Iterator<Item = f64> {
    let q = {
        let root = (b * b - 4.0 * a * c).sqrt();
        -0.5 * (b + root.copysign(b))
    };
    [q / a, c / q]
        .into_iter()
        .filter(|s| s.is_finite() && *s > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speed_table_is_integrated_exactly() {
        // 0 to 5 ft/s in 5 s, then constant: x = t^2/2, then 12.5 + 5 (t - 5)
        let travel = Profile::new(MotionKind::Speed, &[[0.0, 0.0], [5.0, 5.0]], 40.0, 0.0)
            .expect("a valid table");
        assert_eq!(
            travel.at(3.0),
            Travel {
                x: 44.5,
                v: 3.0,
                a: 1.0
            }
        );
        assert_eq!(
            travel.at(9.0),
            Travel {
                x: 72.5,
                v: 5.0,
                a: 0.0
            }
        );
        assert_eq!(travel.breaks(), vec![5.0]);
    }

    #[test]
    fn acceleration_table_is_integrated_exactly() {
        // a = 6 t: x = x0 + v0 t + t^3
        let travel = Profile::new(
            MotionKind::Acceleration,
            &[[0.0, 0.0], [2.0, 12.0]],
            1.0,
            0.5,
        )
        .expect("a valid table");
        assert_eq!(
            travel.at(2.0),
            Travel {
                x: 10.0,
                v: 12.5,
                a: 12.0
            }
        );
        assert_eq!(
            travel.at(1.0),
            Travel {
                x: 2.5,
                v: 3.5,
                a: 6.0
            }
        );
    }

    #[test]
    fn position_table_keeps_its_rows_and_its_ends() {
        let travel = Profile::new(MotionKind::Position, &[[1.0, 2.0], [3.0, 6.0]], 0.0, 0.0)
            .expect("a valid table");
        for (t, x) in [(0.0, 2.0), (1.0, 2.0), (2.0, 4.0), (3.0, 6.0), (9.0, 6.0)] {
            assert_eq!(travel.at(t).x, x, "t = {t}");
        }
    }

    #[test]
    fn reach_includes_turning_points() {
        // x = 10 t - t^2 up to t = 10, then -10 (t - 10): turns at t = 5 with x = 25
        let travel = Profile::new(MotionKind::Speed, &[[0.0, 10.0], [10.0, -10.0]], 0.0, 0.0)
            .expect("a valid table");
        for (from, to, expected) in [
            (0.0, 4.0, 24.0),
            (0.0, 9.0, 25.0),
            (4.0, 7.0, 3.0),
            (8.0, 12.0, 36.0),
            (1.0, 1.0, 0.0),
        ] {
            assert!(
                (travel.reach(from, to) - expected).abs() < 1e-12,
                "{from} to {to}"
            );
        }
    }

    #[test]
    fn leaving_is_found_between_rows_and_at_turning_points() {
        // x = 10 t - t^2 from a speed of 10 falling by 2 a second: turns at t = 5 with x = 25
        let travel = Profile::new(MotionKind::Speed, &[[0.0, 10.0], [10.0, -10.0]], 0.0, 0.0)
            .expect("a valid table");
        assert_eq!(travel.leaves([0.0, 25.0], 10.0), None);
        let (t, x) = travel.leaves([-1.0, 24.0], 10.0).expect("25 is beyond 24");
        assert!(
            (t - 4.0).abs() < 1e-12 && (x - 24.0).abs() < 1e-11,
            "{t} {x}"
        );
        let (t, _) = travel
            .leaves([0.0, 25.0], 12.0)
            .expect("x falls below 0 after t = 10");
        assert!((t - 10.0).abs() < 1e-9, "{t}");
        assert_eq!(travel.leaves([1.0, 25.0], 12.0), Some((0.0, 0.0)));
    }

    #[test]
    fn rejects_times_that_do_not_increase() {
        assert!(Profile::new(MotionKind::Speed, &[[0.0, 1.0], [0.0, 2.0]], 0.0, 0.0).is_err());
        assert!(Profile::new(MotionKind::Speed, &[], 0.0, 0.0).is_err());
    }
}
