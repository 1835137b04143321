//! Functions of time with several columns that are polynomials in intervals.

use smallvec::SmallVec;

use crate::lobatto::Lobatto;
use crate::polynomial::{MAX_DEGREE, Polynomial};

/// Arguments that differ by less, relative to them, are the same.
const SAME: f64 = 1e-14;

/// The argument at a share of an interval from its start; at 1 exactly its end.
#[must_use]
pub fn between([from, to]: [f64; 2], share: f64) -> f64 {
    if share == 1.0 {
        to
    } else {
        from + share * (to - from)
    }
}

/// The side from which a value is taken where a function may jump.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The limit from smaller arguments.
    Before,
    /// The limit from larger ones.
    After,
}

/// A function with a number of columns. In each of its intervals every column is the polynomial through its values at the
/// [`Lobatto`] nodes. An interval begins where the one before it ends, and the values of both at that place may differ.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Piecewise {
    width: usize,
    /// Ends of the intervals: the start of the first, then the end of each.
    ends: Vec<f64>,
    /// Number of the first node of each interval, and its degree.
    first: Vec<usize>,
    degrees: Vec<usize>,
    /// Values of all columns, node by node.
    values: Vec<f64>,
}

/// One interval of a [`Piecewise`].
#[derive(Clone, Copy, Debug)]
pub struct Piece<'a> {
    /// Its ends.
    pub interval: [f64; 2],
    width: usize,
    nodes: &'static Lobatto,
    values: &'a [f64],
}

impl Piecewise {
    /// A function of `width` columns without intervals.
    #[must_use]
    pub fn new(width: usize) -> Piecewise {
        Piecewise {
            width,
            ends: Vec::new(),
            first: Vec::new(),
            degrees: Vec::new(),
            values: Vec::new(),
        }
    }

    /// Appends an interval: the polynomials of the `degree` with these values of all columns, node by node. It must begin where the
    /// last one ends.
    ///
    /// # Panics
    /// If the interval or the number of values does not fit.
    pub fn push<'r>(
        &mut self,
        [from, to]: [f64; 2],
        degree: usize,
        rows: impl IntoIterator<Item = &'r [f64]>,
    ) {
        match self.ends.last() {
            Some(last) => assert!(*last == from, "intervals follow each other"),
            None => self.ends.push(from),
        }
        assert!(to > from, "an interval has a length");
        let mut rows = rows.into_iter().peekable();
        let known = self.values.len() / self.width.max(1);
        let last = &self.values[self.values.len().saturating_sub(self.width)..];
        // where nothing jumps the node at the start is that at the end of the last interval
        let is_shared = known > 0 && rows.next_if(|row| *row == last).is_some();
        self.ends.push(to);
        self.first.push(known - usize::from(is_shared));
        self.degrees.push(degree);
        rows.for_each(|row| self.values.extend_from_slice(row));
        let nodes = self.first[self.first.len() - 1] + degree + 1;
        assert_eq!(self.values.len(), nodes * self.width, "values at the nodes");
    }

    /// Number of values stored: those of all columns at all nodes.
    #[must_use]
    pub fn stored(&self) -> usize {
        self.values.len()
    }

    /// Number of columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of intervals.
    #[must_use]
    pub fn len(&self) -> usize {
        self.first.len()
    }

    /// Whether there are no intervals.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// First and last argument; `None` without intervals.
    #[must_use]
    pub fn range(&self) -> Option<[f64; 2]> {
        Some([*self.ends.first()?, *self.ends.last()?])
    }

    /// An interval by its number.
    #[must_use]
    pub fn piece(&self, k: usize) -> Piece<'_> {
        let (from, degree) = (self.first[k], self.degrees[k]);
        Piece {
            interval: [self.ends[k], self.ends[k + 1]],
            width: self.width,
            nodes: Lobatto::of(degree),
            values: &self.values[from * self.width..(from + degree + 1) * self.width],
        }
    }

    /// The intervals, by increasing arguments.
    pub fn pieces(&self) -> impl ExactSizeIterator<Item = Piece<'_>> + Clone {
        (0..self.len()).map(|k| self.piece(k))
    }

    /// Number of the interval in which `t` lies, or the next one where it lies beyond all. At an end common to two intervals,
    /// within rounding, it is that of the side.
    #[must_use]
    pub fn find(&self, t: f64, side: Side) -> usize {
        let inner = self.ends.get(1..self.len()).unwrap_or_default();
        match side {
            Side::Before => inner.partition_point(|end| *end < t - SAME * t.abs()),
            Side::After => inner.partition_point(|end| *end <= t + SAME * t.abs()),
        }
    }

    /// Value of a column.
    #[must_use]
    pub fn value(&self, t: f64, side: Side, column: usize) -> f64 {
        let piece = self.piece(self.find(t, side));
        piece.value(piece.share(t), column)
    }

    /// Writes the values of all columns into `out`.
    pub fn row(&self, t: f64, side: Side, out: &mut [f64]) {
        let piece = self.piece(self.find(t, side));
        piece.row(piece.share(t), out);
    }

    /// Releases the memory that is reserved for more intervals.
    pub fn shrink(&mut self) {
        self.values.shrink_to_fit();
    }
}

impl<'a> Piece<'a> {
    /// Its degree.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.nodes.degree()
    }

    /// Its length.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.interval[1] - self.interval[0]
    }

    /// The place of `t` in the interval, 0 to 1.
    #[must_use]
    pub fn share(&self, t: f64) -> f64 {
        ((t - self.interval[0]) / self.length()).clamp(0.0, 1.0)
    }

    /// The argument at a place of the interval.
    #[must_use]
    pub fn time(&self, share: f64) -> f64 {
        between(self.interval, share)
    }

    /// The nodes at which its values are given.
    #[must_use]
    pub fn nodes(&self) -> &'static Lobatto {
        self.nodes
    }

    /// Values of all columns at the nodes, node by node.
    pub fn rows(&self) -> std::slice::ChunksExact<'a, f64> {
        self.values.chunks_exact(self.width)
    }

    /// A column as a polynomial of the share.
    #[must_use]
    pub fn column(&self, column: usize) -> Polynomial {
        self.combination(&[(column, 1.0)])
    }

    /// The sum of columns with factors as a polynomial of the share.
    #[must_use]
    pub fn combination(&self, terms: &[(usize, f64)]) -> Polynomial {
        let sum = |row: &[f64]| {
            terms
                .iter()
                .map(|(column, factor)| factor * row[*column])
                .sum()
        };
        let values: SmallVec<[f64; MAX_DEGREE + 1]> = self.rows().map(sum).collect();
        self.nodes.polynomial(&values)
    }

    /// Value of a column at a place of the interval.
    #[must_use]
    pub fn value(&self, share: f64, column: usize) -> f64 {
        let weights = self.nodes.weights(share);
        weights
            .iter()
            .zip(self.rows())
            .map(|(weight, row)| weight * row[column])
            .sum()
    }

    /// Writes the values of all columns at a place of the interval into `out`.
    pub fn row(&self, share: f64, out: &mut [f64]) {
        out.fill(0.0);
        for (weight, row) in self.nodes.weights(share).iter().zip(self.rows()) {
            if *weight != 0.0 {
                out.iter_mut()
                    .zip(row)
                    .for_each(|(out, value)| *out += weight * value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two columns over three intervals: values from both sides, and the intervals that arguments belong to.
    #[test]
    fn values_from_both_sides() {
        let mut own = Piecewise::new(2);
        own.push([0.0, 1.0], 1, [&[0.0, 5.0][..], &[2.0, 5.0]]);
        own.push([1.0, 3.0], 2, [&[7.0, 5.0][..], &[8.0, 5.0], &[7.0, 6.0]]);
        own.push([3.0, 4.0], 1, [&[7.0, 6.0][..], &[0.0, 0.0]]);
        assert_eq!(
            (own.len(), own.width(), own.range()),
            (3, 2, Some([0.0, 4.0]))
        );
        assert_eq!(own.value(0.5, Side::After, 0), 1.0);
        assert_eq!(
            [Side::Before, Side::After].map(|side| own.value(1.0, side, 0)),
            [2.0, 7.0]
        );
        assert_eq!(own.value(2.0, Side::Before, 0), 8.0);
        assert_eq!(
            [-1.0, 0.0, 1.0, 3.0, 4.0, 9.0].map(|t| own.find(t, Side::Before)),
            [0, 0, 0, 1, 2, 2]
        );
        assert_eq!(
            [-1.0, 0.0, 1.0, 3.0, 4.0, 9.0].map(|t| own.find(t, Side::After)),
            [0, 0, 1, 2, 2, 2]
        );
        let mut row = [0.0; 2];
        own.row(3.5, Side::After, &mut row);
        assert_eq!(row, [3.5, 3.0]);
        let sum = own.piece(1).combination(&[(0, 1.0), (1, -2.0)]);
        assert_eq!(sum.coefficients()[0], -3.0);
        assert!((sum.value(0.5) + 2.0).abs() < 1e-14);
    }
}
