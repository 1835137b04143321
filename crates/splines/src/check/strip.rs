//! One block of a structure's give.

use nalgebra::DMatrix;

use crate::{Axis, Compliance, Error, Influence, Probe};

/// A rail and a direction on it.
pub type Way = (usize, Axis);

/// Deflections of one way under loads of another: what one table relates.
#[derive(Clone, Copy)]
pub struct Strip<'a> {
    /// What is asked.
    pub compliance: &'a dyn Compliance,
    /// Rail and axis of the deflection, along z.
    pub deflection: Way,
    /// Rail and axis of the load, along x.
    pub load: Way,
}

impl<'a> Strip<'a> {
    /// Deflections and loads of one way.
    #[must_use]
    pub fn direct(compliance: &'a dyn Compliance, way: Way) -> Strip<'a> {
        Strip { compliance, deflection: way, load: way }
    }

    /// Whether deflections and loads are of one way.
    #[must_use]
    pub fn is_direct(&self) -> bool {
        self.deflection == self.load
    }

    /// Deflection at z per unit load at x, length/force.
    ///
    /// # Errors
    /// What the compliance refuses; a number that is not finite.
    pub fn at(&self, x: f64, z: f64) -> Result<f64, Error> {
        let mut out = Influence::zeros(2);
        self.compliance.fill(&[probe(self.deflection, z), probe(self.load, x)], &mut out)?;
        let value = out.value[(0, 1)];
        if value.is_finite() { Ok(value) } else { Err(Error::Coefficient { x, z }) }
    }

    /// Deflections at `z` (rows) per unit loads at `x` (columns), length/force.
    ///
    /// # Errors
    /// What the compliance refuses; a number that is not finite.
    pub fn block(&self, z: &[f64], x: &[f64]) -> Result<DMatrix<f64>, Error> {
        let rows = z.iter().map(|&z| probe(self.deflection, z));
        if self.is_direct() && z == x {
            let at: Vec<Probe> = rows.collect();
            let mut out = Influence::zeros(at.len());
            self.compliance.fill(&at, &mut out)?;
            return finite(out.value, z, x);
        }
        let at: Vec<Probe> = rows.chain(x.iter().map(|&x| probe(self.load, x))).collect();
        let mut out = Influence::zeros(at.len());
        self.compliance.fill(&at, &mut out)?;
        finite(out.value.view((0, z.len()), (z.len(), x.len())).into_owned(), z, x)
    }

    /// The places both of deflections and of loads; `None` where a rail does not exist or has no end.
    #[must_use]
    pub fn range(&self) -> Option<[[f64; 2]; 2]> {
        Some([self.compliance.range(self.load.0)?, self.compliance.range(self.deflection.0)?])
    }
}

fn probe((rail, axis): Way, x: f64) -> Probe {
    Probe { rail, x, axis }
}

fn finite(block: DMatrix<f64>, z: &[f64], x: &[f64]) -> Result<DMatrix<f64>, Error> {
    let wrong = block.iter().position(|value| !value.is_finite());
    match wrong.filter(|_| !block.is_empty()) {
        Some(k) => Err(Error::Coefficient { x: x[k / z.len()], z: z[k % z.len()] }),
        None => Ok(block),
    }
}
