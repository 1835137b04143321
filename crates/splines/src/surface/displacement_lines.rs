//! Influence lines of displacements: what unit loads anywhere on the rails do at a few fixed places.

use crate::error::Error;
use crate::probe::Probe;
use crate::rail::ShapeRow;

use super::exact::ExactSurface;

/// Displacements of n fixed places under a unit load at any probe q,
///
/// u_i(q) = (C N(p_i)^T)^T N(q)^T + g(p_i, q),
///
/// with the compliance C of the node states, the shape rows N and Green's function g of the member on which both stand,
/// its ends held. The products C N(p_i)^T are made once, so that a load costs n scalar products of twelve numbers, where
/// [`crate::Compliance::fill`] needs n quadratic forms.
///
/// Guarantee: equal to the values of [`crate::Compliance::fill`] up to rounding.
///
/// Made by [`ExactSurface::displacement_lines`].
#[derive(Clone, Debug)]
pub struct DisplacementLines<'s> {
    surface: &'s ExactSurface,
    places: Vec<ShapeRow>,
    /// C N(p)^T by degree of freedom and place: what a load needs of all places is contiguous.
    moved: Vec<f64>,
}

impl ExactSurface {
    /// The influence lines of the displacements at the probes `at`, along their axes.
    ///
    /// # Errors
    /// A probe beyond its rail, on a rail that does not exist, or in a direction in which the structure has no stiffness.
    ///
    /// ```
    /// use std::sync::Arc;
    ///
    /// use nalgebra::DMatrix;
    /// use splines::{Axis, ExactSurface, Flexibility, Probe, RailElement, Rails};
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
    /// // A rigid beam on springs of compliance 4 and 8.
    /// let mut nodal = DMatrix::zeros(12, 12);
    /// (nodal[(1, 1)], nodal[(7, 7)]) = (4.0, 8.0);
    /// let surface = ExactSurface::new(Arc::new(Rails::new(vec![element])?), nodal)?;
    /// let at = |x: f64| Probe { rail: 0, x, axis: Axis::Vertical };
    /// let lines = surface.displacement_lines(&[at(0.0), at(8.0)])?;
    /// let mut out = [0.0; 2];
    /// lines.fill(at(4.0), &mut out)?;
    /// assert_eq!(out, [2.0, 4.0]);
    /// # Ok::<(), splines::Error>(())
    /// ```
    pub fn displacement_lines(&self, at: &[Probe]) -> Result<DisplacementLines<'_>, Error> {
        let places = at
            .iter()
            .map(|probe| self.restrained_row(*probe))
            .collect::<Result<Vec<_>, _>>()?;
        let count = places.len();
        let mut moved = vec![0.0; count * self.nodal().nrows()];
        for (i, place) in places.iter().enumerate() {
            let entries = place.indices().iter().zip(place.values());
            for (&dof, shape) in entries.filter(|(_, shape)| **shape != 0.0) {
                let sums = moved.iter_mut().skip(i).step_by(count);
                sums.zip(&self.nodal().column(dof))
                    .for_each(|(sum, c)| *sum += shape * c);
            }
        }
        Ok(DisplacementLines {
            surface: self,
            places,
            moved,
        })
    }
}

impl DisplacementLines<'_> {
    /// Writes the displacement of each place per unit force at a probe, along its axis, into `out`, which has one entry
    /// for each place.
    ///
    /// # Errors
    /// A probe beyond its rail, on a rail that does not exist, or in a direction in which the structure has no stiffness;
    /// `out` of another length than there are places.
    pub fn fill(&self, load: Probe, out: &mut [f64]) -> Result<(), Error> {
        let count = self.places.len();
        if out.len() != count {
            return Err(Error::EffectShape {
                rows: out.len(),
                columns: 1,
                expected: [count, 1],
            });
        }
        let row = self.surface.restrained_row(load)?;
        out.fill(0.0);
        for (&dof, shape) in row.indices().iter().zip(row.values()) {
            let moved = &self.moved[dof * count..(dof + 1) * count];
            out.iter_mut()
                .zip(moved)
                .for_each(|(sum, moved)| *sum += shape * moved);
        }
        for (out, place) in out.iter_mut().zip(&self.places) {
            *out += self.surface.rails().clamped_between(place, &row);
        }
        Ok(())
    }
}
