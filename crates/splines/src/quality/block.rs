//! One coupling block of a compliance: what a single table of influence coefficients relates.

use nalgebra::DMatrix;

use crate::compliance::{Compliance, Influence};
use crate::error::Error;
use crate::probe::{Axis, Probe};

/// A rail and an axis on it.
pub type RailDirection = (usize, Axis);

/// A number and the place of a block where it was found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BlockExtreme {
    /// The number.
    pub value: f64,
    /// Coordinate of the load.
    pub x: f64,
    /// Coordinate at which the deflection is taken.
    pub z: f64,
}

/// The coupling block of a compliance between one direction of deflections and one of loads.
///
/// ```
/// use nalgebra::DMatrix;
/// use splines::quality::CouplingBlock;
/// use splines::{Axis, ReadingMethod, TableReading, InfluenceBlock, SplineTable};
///
/// let x = vec![0.0, 1.0, 2.0, 3.0];
/// let vertical = (0, Axis::Vertical);
/// let table = SplineTable::new(x.clone(), x, DMatrix::from_fn(4, 4, |i, j| (i * j) as f64))?;
/// let reading = TableReading::new(ReadingMethod::Natural, &[InfluenceBlock { deflection: vertical, load: vertical, table }])?;
/// let block = CouplingBlock::direct(&reading, vertical);
/// assert!((block.at(0.5, 2.0)? - 1.0).abs() < 1e-15);
/// assert_eq!(block.range(), Some([[0.0, 3.0]; 2]));
/// # Ok::<(), splines::Error>(())
/// ```
#[derive(Clone, Copy)]
pub struct CouplingBlock<'a> {
    /// The compliance that is examined.
    pub compliance: &'a dyn Compliance,
    /// Rail and axis of the deflection; its coordinate is z.
    pub deflection: RailDirection,
    /// Rail and axis of the load; its coordinate is x.
    pub load: RailDirection,
}

impl<'a> CouplingBlock<'a> {
    /// The block of deflections and loads along the same direction.
    #[must_use]
    pub fn direct(compliance: &'a dyn Compliance, way: RailDirection) -> CouplingBlock<'a> {
        CouplingBlock {
            compliance,
            deflection: way,
            load: way,
        }
    }

    /// Whether deflections and loads have the same direction.
    #[must_use]
    pub fn is_direct(&self) -> bool {
        self.deflection == self.load
    }

    /// Deflection at z per unit load at x, length/force.
    ///
    /// # Errors
    /// Those of the compliance; a coefficient that is not finite.
    pub fn at(&self, x: f64, z: f64) -> Result<f64, Error> {
        let mut out = Influence::zeros(2);
        self.compliance
            .fill(&[probe(self.deflection, z), probe(self.load, x)], &mut out)?;
        let value = out.value[(0, 1)];
        if value.is_finite() {
            Ok(value)
        } else {
            Err(Error::Coefficient { x, z })
        }
    }

    /// Matrix z.len() x x.len() of the deflections at `z` per unit load at `x`, length/force.
    ///
    /// # Errors
    /// Those of the compliance; a coefficient that is not finite.
    pub fn matrix(&self, z: &[f64], x: &[f64]) -> Result<DMatrix<f64>, Error> {
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
        finite(
            out.value
                .view((0, z.len()), (z.len(), x.len()))
                .into_owned(),
            z,
            x,
        )
    }

    /// First and last coordinate of loads, then of deflections; `None` where a rail does not exist or has no
    /// end.
    #[must_use]
    pub fn range(&self) -> Option<[[f64; 2]; 2]> {
        Some([
            self.compliance.range(self.load.0)?,
            self.compliance.range(self.deflection.0)?,
        ])
    }
}

fn probe((rail, axis): RailDirection, x: f64) -> Probe {
    Probe { rail, x, axis }
}

/// Checks that every coefficient is finite.
fn finite(block: DMatrix<f64>, z: &[f64], x: &[f64]) -> Result<DMatrix<f64>, Error> {
    let wrong = block.iter().position(|value| !value.is_finite());
    match wrong.filter(|_| !block.is_empty()) {
        Some(k) => Err(Error::Coefficient {
            x: x[k / z.len()],
            z: z[k % z.len()],
        }),
        None => Ok(block),
    }
}
