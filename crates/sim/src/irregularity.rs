//! The shape of a rail that nothing loads: height and lateral place along it, with steps.

use crate::Error;

/// Distance to a corner, relative to 1 + |x|, within which a wheel is at it.
const SLACK: f64 = 2e-9;

/// Track irregularity: height y0(x) above and place z0(x) beside the straight rail, linear between the rows of
/// their tables and constant before the first and after the last; two rows at one x are a step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Irregularity {
    /// Where the pieces after the first one start.
    starts: Vec<f64>,
    /// One more than `starts`, or none where the rail is straight.
    pieces: Vec<Piece>,
}

/// One piece: value and slope, vertical and lateral, about x.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    x: f64,
    vertical: [f64; 2],
    lateral: [f64; 2],
}

impl Irregularity {
    /// From rows (x, y0) and (x, z0); an empty table is zero.
    ///
    /// # Errors
    /// Numbers that are not finite, x that falls, or three rows at one x.
    pub fn new(vertical: &[[f64; 2]], lateral: &[[f64; 2]]) -> Result<Self, Error> {
        let what = "x of an irregularity";
        for table in [vertical, lateral] {
            if let Some(&found) = table.iter().flatten().find(|number| !number.is_finite()) {
                return Err(Error::Number { what: "irregularity", wanted: "finite", found });
            }
            if let Some(pair) = table.windows(2).find(|pair| pair[1][0] < pair[0][0]) {
                return Err(Error::Number { what, wanted: "not falling", found: pair[1][0] });
            }
            if let Some(row) = table.windows(3).find(|row| row[2][0] == row[0][0]) {
                return Err(Error::Number { what, wanted: "in two rows at most", found: row[0][0] });
            }
        }
        let mut starts: Vec<f64> = vertical.iter().chain(lateral).map(|row| row[0]).collect();
        starts.sort_by(f64::total_cmp);
        starts.dedup();
        let before = starts.first().map(|&x| {
            let first = |table: &[[f64; 2]]| [table.first().map_or(0.0, |row| row[1]), 0.0];
            Piece { x, vertical: first(vertical), lateral: first(lateral) }
        });
        let after =
            starts.iter().map(|&x| Piece { x, vertical: linear(vertical, x), lateral: linear(lateral, x) });
        Ok(Irregularity { pieces: before.into_iter().chain(after).collect(), starts })
    }

    /// Corners and steps.
    #[must_use]
    pub fn breaks(&self) -> &[f64] {
        &self.starts
    }

    /// Number of the piece at `x` for a wheel that moves in `direction` (its sign); at a corner, the piece it moves
    /// into, and `current` where it rests.
    pub(crate) fn piece(&self, x: f64, direction: f64, current: usize) -> usize {
        let slack = SLACK * (1.0 + x.abs());
        let [low, high] = [x - slack, x + slack].map(|x| self.starts.partition_point(|start| *start <= x));
        if direction > 0.0 {
            high
        } else if direction < 0.0 {
            low
        } else {
            current.clamp(low, high)
        }
    }

    /// y0 and its slope at `x` by `piece`, which goes on beyond its ends.
    pub(crate) fn vertical(&self, piece: usize, x: f64) -> [f64; 2] {
        self.pieces
            .get(piece)
            .map_or([0.0; 2], |p| [p.vertical[0] + p.vertical[1] * (x - p.x), p.vertical[1]])
    }

    /// z0 and its slope at `x` by `piece`, which goes on beyond its ends.
    pub(crate) fn lateral(&self, piece: usize, x: f64) -> [f64; 2] {
        self.pieces.get(piece).map_or([0.0; 2], |p| [p.lateral[0] + p.lateral[1] * (x - p.x), p.lateral[1]])
    }
}

/// Value and slope of a table just after `x`.
fn linear(table: &[[f64; 2]], x: f64) -> [f64; 2] {
    let next = table.partition_point(|row| row[0] <= x);
    match (next.checked_sub(1).and_then(|before| table.get(before)), table.get(next)) {
        (Some(&[x0, y0]), Some(&[x1, y1])) => {
            let slope = (y1 - y0) / (x1 - x0);
            [y0 + slope * (x - x0), slope]
        }
        (Some(&[_, value]), None) | (None, Some(&[_, value])) => [value, 0.0],
        (None, None) => [0.0, 0.0],
    }
}

#[cfg(test)]
mod tests {
    use super::Irregularity;

    #[test]
    fn pieces_are_linear_between_rows_and_constant_beyond() {
        let shape = Irregularity::new(&[[1.0, 0.0], [3.0, 4.0], [3.0, 1.0]], &[[2.0, 5.0]]).expect("rows");
        assert_eq!(shape.breaks(), [1.0, 2.0, 3.0]);
        let at = |x: f64, direction: f64| shape.vertical(shape.piece(x, direction, 0), x);
        assert_eq!(at(-7.0, 1.0), [0.0, 0.0]);
        assert_eq!(at(1.5, 1.0), [1.0, 2.0]);
        assert_eq!(at(2.5, -1.0), [3.0, 2.0]);
        assert_eq!((at(3.0, -1.0), at(3.0, 1.0)), ([4.0, 2.0], [1.0, 0.0]));
        assert_eq!(at(9.0, 1.0), [1.0, 0.0]);
        assert_eq!(shape.lateral(0, 0.0), [5.0, 0.0]);
    }

    #[test]
    fn a_wheel_at_rest_at_a_corner_stays_on_its_piece() {
        let shape = Irregularity::new(&[[1.0, 0.0], [2.0, 1.0]], &[]).expect("rows");
        assert_eq!([0, 1, 2].map(|current| shape.piece(1.0, 0.0, current)), [0, 1, 1]);
        assert_eq!(shape.piece(1.5, 0.0, 0), 1);
    }

    #[test]
    fn tables_that_fall_back_or_step_twice_are_refused() {
        assert!(Irregularity::new(&[[1.0, 0.0], [0.5, 0.0]], &[]).is_err());
        assert!(Irregularity::new(&[], &[[1.0, 0.0], [1.0, 1.0], [1.0, 2.0]]).is_err());
        assert!(Irregularity::new(&[[1.0, f64::NAN]], &[]).is_err());
        assert_eq!(Irregularity::new(&[], &[]).expect("nothing"), Irregularity::default());
    }
}
