//! Loads of unit forces on the rails, over the unknowns of the stiffness.

use splines::{Probe, Rails};

use crate::assembly::{Bodies, Combination, Numbering};
use crate::error::Error;
use crate::factor::SparseLoad;

/// What turns a force on a rail into a load: the rail elements, the states at their ends, and the unknowns.
#[derive(Clone, Copy)]
pub(crate) struct RailLoads<'a> {
    /// The rail elements; `None` for a frame without rails.
    pub line: Option<&'a Rails>,
    /// Displacements and rotations of all states over the motions of the bodies.
    pub states: &'a [[Combination; 6]],
    pub bodies: &'a Bodies,
    pub numbering: &'a Numbering,
}

impl RailLoads<'_> {
    /// Displacement at a probe over the motions of the bodies, and the rail element of the probe.
    pub fn row(&self, probe: Probe) -> Result<(Combination, usize), Error> {
        let row = self.line.ok_or(Error::NoRails)?.row(probe)?;
        let mut sum = Combination::default();
        for (&index, &value) in row.indices().iter().zip(row.values()) {
            sum.add_scaled(&self.states[index / 6][index % 6], value);
        }
        Ok((sum, row.element))
    }

    /// A combination as a load on the scaled unknowns; `None` if it acts on a degree of freedom that nothing
    /// stiffens.
    pub fn scaled(&self, row: &Combination) -> Option<SparseLoad> {
        self.terms(row).collect()
    }

    /// A combination as a load on the scaled unknowns, without what acts on degrees of freedom that nothing
    /// stiffens.
    pub fn scaled_where_stiffened(&self, row: &Combination) -> SparseLoad {
        self.terms(row).flatten().collect()
    }

    /// The terms of a load; `None` for one on a degree of freedom that nothing stiffens.
    fn terms(&self, row: &Combination) -> impl Iterator<Item = Option<(usize, f64)>> {
        let supported: Vec<(usize, f64)> = self.bodies.supported(row).significant().collect();
        supported.into_iter().map(|(column, value)| {
            let k = self.numbering.unknown[column]?;
            Some((k, value * self.numbering.scale[k]))
        })
    }
}
