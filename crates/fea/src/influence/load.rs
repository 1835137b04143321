//! Loads of unit forces on the rails, over the unknowns of the stiffness.

use splines::{Probe, Rails, ShapeRow};

use crate::assembly::{Bodies, Combination, Numbering};
use crate::error::Error;
use crate::factor::SparseLoad;

/// Columns of the bodies at both ends of a rail element.
const MOST_COLUMNS: usize = 12;

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
        Ok((self.of_row(&row), row.element))
    }

    /// The displacement that a shape row gives, over the motions of the bodies.
    pub fn of_row(&self, row: &ShapeRow) -> Combination {
        let mut sum = Combination::with_capacity(MOST_COLUMNS);
        for (&index, &value) in row.indices().iter().zip(row.values()) {
            sum.add_scaled(&self.states[index / 6][index % 6], value);
        }
        sum
    }

    /// A combination as a load on the scaled unknowns; `None` if it acts on a degree of freedom that nothing
    /// stiffens.
    pub fn scaled(&self, row: &Combination) -> Option<SparseLoad> {
        let row = self.bodies.supported(row);
        let mut load = SparseLoad::with_capacity(row.terms().len());
        for (column, value) in row.significant() {
            load.push(self.term(column, value)?);
        }
        Some(load)
    }

    /// A combination as a load on the scaled unknowns, without what acts on degrees of freedom that nothing
    /// stiffens.
    pub fn scaled_where_stiffened(&self, row: &Combination) -> SparseLoad {
        let row = self.bodies.supported(row);
        row.significant()
            .filter_map(|(column, value)| self.term(column, value))
            .collect()
    }

    /// A term of a load; `None` on a degree of freedom that nothing stiffens.
    fn term(&self, column: usize, value: f64) -> Option<(usize, f64)> {
        let k = self.numbering.unknown[column]?;
        Some((k, value * self.numbering.scale[k]))
    }
}
