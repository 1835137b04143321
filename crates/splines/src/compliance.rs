//! The one question that contact asks of a structure.

use nalgebra::DMatrix;

use crate::{Error, Probe};

/// Influence coefficients of a set of probes, and their slopes along the rail.
#[derive(Clone, Debug)]
pub struct Influence {
    /// `value[(i, j)]`: displacement at probe i along its axis per unit force at probe j along its axis.
    pub value: DMatrix<f64>,
    /// `slope[(i, j)]`: derivative of `value[(i, j)]` with respect to the coordinate of probe i.
    pub slope: DMatrix<f64>,
}

impl Influence {
    /// Zeros for n probes.
    #[must_use]
    pub fn zeros(n: usize) -> Self {
        Influence { value: DMatrix::zeros(n, n), slope: DMatrix::zeros(n, n) }
    }

    /// Refuses matrices of another size than `n` probes.
    pub(crate) fn expect(&self, n: usize) -> Result<(), Error> {
        for matrix in [&self.value, &self.slope] {
            let (rows, columns) = matrix.shape();
            if (rows, columns) != (n, n) {
                return Err(Error::OutputShape { rows, columns, expected: n });
            }
        }
        Ok(())
    }
}

/// A structure's give at its rails: displacements per unit force between any set of probes.
pub trait Compliance: Send + Sync {
    /// Fills the n x n `out` (already of that size) for the n probes `at`.
    ///
    /// # Errors
    /// A probe beyond its rail, on a rail that does not exist, or in a direction that nothing resists.
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error>;

    /// Coordinates along `rail` where slopes of the surface may jump: supports, hinges, stations.
    fn breaks(&self, rail: usize) -> Vec<f64>;

    /// First and last coordinate of `rail`; `None` where the rail has no end.
    fn range(&self, rail: usize) -> Option<[f64; 2]>;

    /// Whether `value[(i, j)]` = `value[(j, i)]` everywhere, Maxwell's law: a solver may then use half of it.
    fn is_symmetric(&self) -> bool;
}

/// Value, slopes and curvatures of G(p, q) at one pair of probes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet2 {
    /// G(p, q): displacement at p along its axis per unit force at q along its axis.
    pub value: f64,
    /// dG/dp, by the coordinate of p.
    pub p: f64,
    /// dG/dq, by the coordinate of q.
    pub q: f64,
    /// d2G/dp2.
    pub pp: f64,
    /// d2G/dp dq.
    pub pq: f64,
    /// d2G/dq2.
    pub qq: f64,
}

impl Jet2 {
    /// The two places exchanged.
    pub(crate) fn swapped(self) -> Jet2 {
        Jet2 { value: self.value, p: self.q, q: self.p, pp: self.qq, pq: self.pq, qq: self.pp }
    }

    pub(crate) fn mean(self, other: Jet2) -> Jet2 {
        Jet2 {
            value: 0.5 * (self.value + other.value),
            p: 0.5 * (self.p + other.p),
            q: 0.5 * (self.q + other.q),
            pp: 0.5 * (self.pp + other.pp),
            pq: 0.5 * (self.pq + other.pq),
            qq: 0.5 * (self.qq + other.qq),
        }
    }
}

/// A give that can be differentiated twice, one pair of probes at a time.
pub trait Jets: Compliance {
    /// Value and derivatives up to the second order.
    ///
    /// `value` and `p` are those of [`Compliance::fill`]. Where a derivative does not exist, the rule is that of
    /// `fill`: at a kink the mean of both sides, of every derivative; at the end of a cell that of the cell
    /// which carries the place. What a kink is worth as a pulse (in shear, `pq` under one's own load) is left out.
    ///
    /// # Errors
    /// As [`Compliance::fill`].
    fn jet(&self, p: Probe, q: Probe) -> Result<Jet2, Error>;
}
