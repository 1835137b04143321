//! Sparse linear combinations of the columns of the bodies.

use nalgebra::SVector;

use crate::assembly::precision::Real;

/// Size of a term, in roundings of the magnitudes it was added up from, at which it counts as zero.
const CANCELLED: f64 = 16.0 * f64::EPSILON;

/// A linear combination sum of value_k * column_k, six columns for each body.
///
/// As a row it is a displacement, as a column a load: a unit force along a displacement acts on the bodies
/// by the same coefficients.
#[derive(Clone, Debug)]
pub(crate) struct Combination<T: Real = f64> {
    terms: Vec<Term<T>>,
}

/// A term of a combination.
#[derive(Clone, Copy, Debug)]
struct Term<T> {
    column: usize,
    value: T,
    /// Sum of the magnitudes that were added up for the value.
    size: f64,
}

impl<T: Real> Default for Combination<T> {
    fn default() -> Self {
        Combination { terms: Vec::new() }
    }
}

impl<T: Real> Combination<T> {
    /// An empty combination with room for some terms.
    pub fn with_capacity(terms: usize) -> Combination<T> {
        Combination {
            terms: Vec::with_capacity(terms),
        }
    }

    /// The combination of different columns: column, value, and the sum of the magnitudes that it was added up from.
    pub fn of_columns(columns: impl Iterator<Item = (usize, T, f64)> + Clone) -> Combination<T> {
        let terms = columns.filter(|term| term.1 != T::zero());
        let mut out = Combination::with_capacity(terms.clone().count());
        out.terms.extend(terms.map(|(column, value, size)| Term {
            column,
            value,
            size,
        }));
        out
    }

    /// Adds `value` times a column.
    #[inline]
    pub fn add(&mut self, column: usize, value: T) {
        self.add_sized(column, value, value.double().abs());
    }

    /// Adds `value` times a column; `size` is the sum of the magnitudes that `value` was added up from.
    #[inline]
    pub fn add_sized(&mut self, column: usize, value: T, size: f64) {
        if value == T::zero() {
            return;
        }
        // A combination has few terms, so that a linear search suffices.
        if let Some(term) = self.terms.iter_mut().find(|term| term.column == column) {
            term.value += value;
            term.size += size;
        } else {
            self.terms.push(Term {
                column,
                value,
                size,
            });
        }
    }

    /// Adds `factor` times another combination.
    pub fn add_scaled(&mut self, other: &Combination<T>, factor: T) {
        for (column, value) in other.terms() {
            self.add(column, factor * value);
        }
    }

    /// Column and value of each term.
    pub fn terms(&self) -> impl ExactSizeIterator<Item = (usize, T)> + '_ {
        self.terms.iter().map(|term| (term.column, term.value))
    }

    /// Column of each term, and the sum of the magnitudes that were added up for it.
    pub fn magnitudes(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.terms.iter().map(|term| (term.column, term.size))
    }
}

impl Combination {
    /// Terms that are more than the rounding of what cancelled.
    pub fn significant(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let more = |term: &&Term<f64>| term.value.abs() > CANCELLED * term.size;
        self.terms
            .iter()
            .filter(more)
            .map(|term| (term.column, term.value))
    }

    /// Value for given motions of the bodies, or forces on them, six for each body.
    pub fn evaluate(&self, bodies: &[SVector<f64, 6>]) -> f64 {
        self.terms()
            .map(|(column, value)| value * bodies[column / 6][column % 6])
            .sum()
    }

    /// Sum of the products of equal terms.
    pub fn dot(&self, other: &Combination) -> f64 {
        let factor = |column: usize| {
            other
                .terms()
                .find(|term| term.0 == column)
                .map_or(0.0, |term| term.1)
        };
        self.terms()
            .map(|(column, value)| value * factor(column))
            .sum()
    }
}
