//! Residual flexibility: a surface less what given motions account for.

use crate::compliance::{Compliance, Influence, PlaceDisplacements};
use crate::error::Error;
use crate::probe::Probe;
use crate::vector::dot;

use super::exact::ExactSurface;
use super::shapes::RailShapes;

/// Residual flexibility of a surface beside shapes that are accounted for elsewhere:
///
/// G'(p, q) = G(p, q) - sum_r phi_r(p) phi_r(q).
///
/// The shapes may be those of a finer division of the same rails. The static compliance of a beam does not
/// depend on where it is divided, so that G needs the few node states of the coarse division, where the fine
/// one would need a matrix a thousand times as large.
///
/// Guarantee: where the shapes are mass-normalised natural modes of the same structure, divided by their
/// circular frequencies, G' is positive semi-definite up to the rounding of G.
///
/// ```
/// use std::sync::Arc;
///
/// use nalgebra::DMatrix;
/// use splines::{Axis, RailElement, Compliance, Flexibility, Influence, Rails, Probe, ResidualFlexibility, RailShapes, ExactSurface};
///
/// let element = RailElement {
///     rail: 0,
///     x: [0.0, 8.0],
///     ends: [0, 1],
///     length: 8.0,
///     frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
///     offset: [0.0; 3],
///     flexibility: Flexibility::default(),
///     member: None,
/// };
/// // A rigid beam on two springs of compliance 4; the shape accounts for the second spring.
/// let mut nodal = DMatrix::zeros(12, 12);
/// (nodal[(1, 1)], nodal[(7, 7)]) = (4.0, 4.0);
/// let mut states = DMatrix::zeros(12, 1);
/// states[(7, 0)] = 2.0;
/// let rails = Arc::new(Rails::new(vec![element])?);
/// let rest = ResidualFlexibility::new(ExactSurface::new(rails.clone(), nodal)?, RailShapes::new(rails, states)?);
/// let ends = [0.0, 8.0].map(|x| Probe { rail: 0, x, axis: Axis::Vertical });
/// let mut out = Influence::zeros(2);
/// rest.fill(&ends, &mut out)?;
/// assert_eq!(out.value.as_slice(), [4.0, 0.0, 0.0, 0.0]);
/// # Ok::<(), splines::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct ResidualFlexibility {
    whole: ExactSurface,
    taken: RailShapes,
}

impl ResidualFlexibility {
    /// The residual flexibility of `whole` beside the shapes `taken`.
    #[must_use]
    pub const fn new(whole: ExactSurface, taken: RailShapes) -> ResidualFlexibility {
        ResidualFlexibility { whole, taken }
    }
}

impl Compliance for ResidualFlexibility {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        self.whole.fill(at, out)?;
        let (n, count) = (at.len(), self.taken.count());
        if count == 0 {
            return Ok(());
        }
        let mut all = vec![0.0; 2 * count * n];
        let (values, slopes) = all.split_at_mut(count * n);
        let rows = values
            .chunks_exact_mut(count)
            .zip(slopes.chunks_exact_mut(count));
        for (probe, (value, slope)) in at.iter().zip(rows) {
            self.taken.row(*probe, value, slope)?;
        }
        for (j, other) in values.chunks_exact(count).enumerate() {
            let rows = values.chunks_exact(count).zip(slopes.chunks_exact(count));
            for (i, (value, slope)) in rows.enumerate() {
                out.slope[(i, j)] -= dot(slope, other);
                if i >= j {
                    out.value[(i, j)] -= dot(value, other);
                    out.value[(j, i)] = out.value[(i, j)];
                }
            }
        }
        Ok(())
    }

    fn displacements(
        &self,
        at: &[Probe],
        loads: &[(Probe, f64)],
        out: &mut [f64],
    ) -> Result<(), Error> {
        self.whole.displacements(at, loads, out)?;
        let taken = self.taken.under(loads)?;
        let (mut value, mut slope) = (vec![0.0; taken.len()], vec![0.0; taken.len()]);
        for (probe, out) in at.iter().zip(out) {
            self.taken.row(*probe, &mut value, &mut slope)?;
            *out -= dot(&value, &taken);
        }
        Ok(())
    }

    fn at_places<'a>(&'a self, at: &[Probe]) -> Result<Box<dyn PlaceDisplacements + 'a>, Error> {
        let count = self.taken.count();
        let mut slope = vec![0.0; count];
        let mut shapes = vec![0.0; count * at.len()];
        for (probe, value) in at.iter().zip(shapes.chunks_mut(count.max(1))) {
            self.taken.row(*probe, value, &mut slope)?;
        }
        Ok(Box::new(ResidualPlaces {
            whole: self.whole.at_places(at)?,
            taken: &self.taken,
            shapes,
        }))
    }

    fn breaks(&self, rail: usize) -> Vec<f64> {
        self.whole.breaks(rail)
    }

    fn range(&self, rail: usize) -> Option<[f64; 2]> {
        self.whole.range(rail)
    }

    fn is_symmetric(&self) -> bool {
        self.whole.is_symmetric()
    }
}

/// Fixed places with the values of the shapes there.
struct ResidualPlaces<'a> {
    whole: Box<dyn PlaceDisplacements + 'a>,
    taken: &'a RailShapes,
    /// Place by place.
    shapes: Vec<f64>,
}

impl PlaceDisplacements for ResidualPlaces<'_> {
    fn under(&self, loads: &[(Probe, f64)], also: &[Probe], out: &mut [f64]) -> Result<(), Error> {
        self.whole.under(loads, also, out)?;
        let taken = self.taken.under(loads)?;
        let (out, others) = out.split_at_mut(out.len() - also.len());
        for (own, out) in self.shapes.chunks(taken.len().max(1)).zip(out) {
            *out -= dot(own, &taken);
        }
        let (mut value, mut slope) = (vec![0.0; taken.len()], vec![0.0; taken.len()]);
        for (probe, out) in also.iter().zip(others) {
            self.taken.row(*probe, &mut value, &mut slope)?;
            *out -= dot(&value, &taken);
        }
        Ok(())
    }
}
