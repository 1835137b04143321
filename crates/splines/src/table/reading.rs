//! Influence coefficients read from tables of values.

use super::adams::Families;
use super::block::{Directions, InfluenceBlock};
use super::tensor::tensor;
use crate::compliance::{Compliance, Differentiable, Influence, Partials};
use crate::curve::{akima, natural_spline};
use crate::error::Error;
use crate::probe::{Axis, Probe};
use crate::surface::ExactSurface;

/// Method by which values between the stations of a table are read.
///
/// The errors given are the largest on the paper's girder with its overhangs at seven stations, relative to
/// the largest entry. The order is the power of the distance between stations with which the error decreases.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ReadingMethod {
    /// Tensor spline W T W^T with cardinal natural cubic splines W along both directions: symmetric to the
    /// last bit, positive semi-definite where the table is, twice continuously differentiable. Error 8.8e-3,
    /// order 3.
    Natural,
    /// As ADAMS reads a SPLINE by AKISPL: Akima's curve along x (load), linear along z (deflection). Neither
    /// symmetric nor positive semi-definite between stations; slopes jump at stations. Error 6.6e-2,
    /// asymmetry as large, order 2.
    Akispl,
    /// The mean of AKISPL and AKISPL with deflection and load exchanged, (A(x, z) + A(z, x))/2, which can be
    /// written as an ADAMS expression. Symmetric to the last bit, but not positive semi-definite between
    /// stations; slopes jump at stations. Error 5.3e-2, order 2.
    Symmetrised,
    /// As ADAMS reads a SPLINE by CUBSPL: natural cubic spline along x, linear along z. Neither symmetric nor
    /// positive semi-definite between stations; slopes along z jump at stations. Error 6.6e-2, asymmetry as
    /// large, order 2.
    Cubspl,
}

/// The compliance that tables of values describe, read by one [`ReadingMethod`] of method.
///
/// A probe along a direction without a table of its own is refused. Two directions without a common table do
/// not couple. A coupling is given once; the opposite one is its transpose.
///
/// ```
/// use nalgebra::DMatrix;
/// use splines::{Axis, Compliance, Influence, ReadingMethod, Probe, TableReading, InfluenceBlock, SplineTable};
///
/// // The table of G(x, z) = x z.
/// let x = vec![0.0, 1.0, 2.0, 3.0];
/// let table = SplineTable::new(x.clone(), x, DMatrix::from_fn(4, 4, |i, j| (i * j) as f64))?;
/// let vertical = (0, Axis::Vertical);
/// let blocks = [InfluenceBlock { deflection: vertical, load: vertical, table }];
/// let akispl = TableReading::new(ReadingMethod::Akispl, &blocks)?;
///
/// let at = [0.5, 2.5].map(|x| Probe { rail: 0, x, axis: Axis::Vertical });
/// let mut out = Influence::zeros(2);
/// akispl.fill(&at, &mut out)?;
/// assert_eq!(out.value[(0, 1)], 1.25);
/// assert_eq!(out.slope[(0, 1)], 2.5);
/// # Ok::<(), splines::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct TableReading {
    kind: ReadingMethod,
    directions: Directions,
    tables: Prepared,
}

/// Tables prepared for a method; every direction is a rail of its own.
#[derive(Clone, Debug)]
enum Prepared {
    Tensor(ExactSurface),
    Families(Families),
}

impl TableReading {
    /// `blocks` holds one table for every direction, and those of couplings between directions.
    ///
    /// # Errors
    /// No table; two tables for one pair; a coupling between directions of which one has no table of its own;
    /// a table with fewer than two curves; for [`ReadingMethod::Natural`] also stations along z that differ from those
    /// along x.
    pub fn new(kind: ReadingMethod, blocks: &[InfluenceBlock]) -> Result<TableReading, Error> {
        let (directions, pairs) = Directions::new(blocks)?;
        let tables = match kind {
            ReadingMethod::Natural => Prepared::Tensor(tensor(&pairs, blocks)?),
            ReadingMethod::Akispl => {
                Prepared::Families(Families::new(pairs, blocks, akima, false)?)
            }
            ReadingMethod::Symmetrised => {
                Prepared::Families(Families::new(pairs, blocks, akima, true)?)
            }
            ReadingMethod::Cubspl => {
                Prepared::Families(Families::new(pairs, blocks, natural_spline, false)?)
            }
        };
        Ok(TableReading {
            kind,
            directions,
            tables,
        })
    }

    /// The method of reading.
    #[must_use]
    pub fn method(&self) -> ReadingMethod {
        self.kind
    }

    /// The probe with the number of its direction in place of the rail.
    #[inline]
    fn numbered(&self, p: Probe) -> Result<Probe, Error> {
        let (rail, x) = self.directions.find(p)?;
        Ok(Probe {
            rail,
            x,
            axis: Axis::Vertical,
        })
    }
}

impl Compliance for TableReading {
    /// Where the slope along z jumps (at a station), `slope` is the mean of both sides.
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        out.expect(at.len())?;
        // Few probes are kept on the stack.
        let mut few = [Probe {
            rail: 0,
            x: 0.0,
            axis: Axis::Vertical,
        }; 16];
        let mut many = Vec::new();
        let numbered = if at.len() <= few.len() {
            &mut few[..at.len()]
        } else {
            many.resize(at.len(), few[0]);
            &mut many[..]
        };
        for (own, p) in numbered.iter_mut().zip(at) {
            *own = self.numbered(*p)?;
        }
        match &self.tables {
            Prepared::Tensor(surface) => surface.fill(numbered, out),
            Prepared::Families(families) => {
                families.fill(numbered, out);
                Ok(())
            }
        }
    }

    fn breaks(&self, rail: usize) -> Vec<f64> {
        self.directions.breaks(rail)
    }

    fn range(&self, rail: usize) -> Option<[f64; 2]> {
        self.directions.range(rail)
    }

    fn is_symmetric(&self) -> bool {
        match &self.tables {
            Prepared::Tensor(surface) => surface.is_symmetric(),
            Prepared::Families(families) => families.is_symmetric(),
        }
    }
}

impl Differentiable for TableReading {
    /// Where the method is linear along z, `pp` is zero and `p` at a station is the mean of both sides.
    /// Akima's curvature along x jumps at a station, where `qq` is the mean of both sides.
    fn partials(&self, p: Probe, q: Probe) -> Result<Partials, Error> {
        let [p, q] = [self.numbered(p)?, self.numbered(q)?];
        match &self.tables {
            Prepared::Tensor(surface) => surface.partials(p, q),
            Prepared::Families(families) => Ok(families.jet(p, q)),
        }
    }
}
