//! Influence coefficients read from tables of values.

use crate::family::Families;
use crate::sheet::{Sheet, Ways};
use crate::tensor::tensor;
use crate::{Axis, Compliance, Error, Influence, Jet2, Jets, Probe, Surface, akima, natural};

/// How values between the stations are read.
///
/// Errors are those of the paper's girder with its overhangs at seven stations, of the largest entry; order is
/// the power of the distance between stations by which they fall.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// W T W^T with natural cubic cardinal splines W along both directions: symmetric to the last bit, positive
    /// semi-definite where the table is, twice continuously differentiable. Error 8.8e-3, order 3.
    Natural,
    /// As ADAMS reads a SPLINE by AKISPL: Akima's curve along x, where the load stands, linear along z, where
    /// the deflection is taken. Neither symmetric nor positive between stations; slopes jump at stations.
    /// Error 6.6e-2, as much asymmetry, order 2.
    Akispl,
    /// The mean of AKISPL as it stands and with deflection and load exchanged, (A(x, z) + A(z, x))/2, an
    /// expression that ADAMS can be given. Symmetric to the last bit, but not positive between stations;
    /// slopes jump at stations. Error 5.3e-2, order 2.
    Symmetrised,
    /// As ADAMS reads it by CUBSPL: the natural cubic spline along x, linear along z. Neither symmetric nor
    /// positive between stations; slopes along z jump at stations. Error 6.6e-2, as much asymmetry, order 2.
    Cubspl,
}

/// Tables of values as a structure's give.
///
/// A direction without a table of its own cannot be asked for; two directions without a common table do
/// not couple. A coupling is given once: the opposite one is its transpose.
#[derive(Clone, Debug)]
pub struct Reading {
    kind: Kind,
    ways: Ways,
    inner: Inner,
}

#[derive(Clone, Debug)]
enum Inner {
    /// Cells without flexibility; every direction is a rail of its own.
    Tensor(Surface),
    Families(Families),
}

impl Reading {
    /// `sheets`: for every direction its own table, and couplings between them as there are.
    ///
    /// # Errors
    /// No sheet; two sheets for one pair; a coupling between directions without tables of their own; a table
    /// with fewer than two curves; for [`Kind::Natural`] stations along z that differ from those along x.
    pub fn new(kind: Kind, sheets: &[Sheet]) -> Result<Reading, Error> {
        let (ways, pairs) = Ways::new(sheets)?;
        let inner = match kind {
            Kind::Natural => Inner::Tensor(tensor(&pairs, sheets)?),
            Kind::Akispl => Inner::Families(Families::new(pairs, sheets, akima, false)?),
            Kind::Symmetrised => Inner::Families(Families::new(pairs, sheets, akima, true)?),
            Kind::Cubspl => Inner::Families(Families::new(pairs, sheets, natural, false)?),
        };
        Ok(Reading { kind, ways, inner })
    }

    /// How it reads.
    #[must_use]
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// A probe by the number of its direction in place of the rail.
    #[inline]
    fn spot(&self, p: Probe) -> Result<Probe, Error> {
        Ok(Probe { rail: self.ways.find(p)?, x: p.x, axis: Axis::Vertical })
    }
}

impl Compliance for Reading {
    /// Where the slope along z jumps (at a station), `slope` is the mean of both sides.
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        out.expect(at.len())?;
        // Probes by the number of their direction in place of the rail; on the stack if few.
        let mut few = [Probe { rail: 0, x: 0.0, axis: Axis::Vertical }; 16];
        let mut many = Vec::new();
        let spots = if at.len() <= few.len() {
            &mut few[..at.len()]
        } else {
            many.resize(at.len(), few[0]);
            &mut many[..]
        };
        for (spot, p) in spots.iter_mut().zip(at) {
            *spot = self.spot(*p)?;
        }
        match &self.inner {
            Inner::Tensor(surface) => surface.fill(spots, out),
            Inner::Families(families) => {
                families.fill(spots, out);
                Ok(())
            }
        }
    }

    fn breaks(&self, rail: usize) -> Vec<f64> {
        self.ways.breaks(rail)
    }

    fn range(&self, rail: usize) -> Option<[f64; 2]> {
        self.ways.range(rail)
    }

    fn is_symmetric(&self) -> bool {
        match &self.inner {
            Inner::Tensor(surface) => surface.is_symmetric(),
            Inner::Families(families) => families.is_symmetric(),
        }
    }
}

impl Jets for Reading {
    /// Along z the tables are straight between stations: no curvature; at a station the mean of both slopes.
    /// Akima's curvature along x jumps at a station: the mean too.
    fn jet(&self, p: Probe, q: Probe) -> Result<Jet2, Error> {
        let [p, q] = [self.spot(p)?, self.spot(q)?];
        match &self.inner {
            Inner::Tensor(surface) => surface.jet(p, q),
            Inner::Families(families) => Ok(families.jet(p, q)),
        }
    }
}
