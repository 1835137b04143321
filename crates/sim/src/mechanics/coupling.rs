//! Inertial coupling between bodies and the structures that they carry: the block B of M = [M_b, B^T; B, M_s]. B is
//! the momentum of the degrees of freedom of the structure per unit velocity of its carrier.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::inertia::Block;
use super::kinematics::Kinematics;
use crate::Carrier;
use crate::numerics::dense::dot;

/// Inertial coupling block B of one structure.
pub(crate) struct InertialCoupling {
    /// Degrees of freedom of the structure.
    pub range: Range<usize>,
    /// B, with one row per degree of freedom of the structure and one column per degree of freedom of the bodies.
    pub between: DMatrix<f64>,
}

impl InertialCoupling {
    /// Builds B for the structure with the degrees of freedom `range` on the carrier `mount`, where `bodies` is the
    /// number of degrees of freedom of the bodies. Returns `None` where B is zero.
    pub fn new(
        kinematics: &Kinematics,
        mount: &Carrier,
        range: Range<usize>,
        bodies: usize,
    ) -> Option<InertialCoupling> {
        let mut between = DMatrix::zeros(range.len(), bodies);
        for (k, shares) in mount.coupling.iter().enumerate() {
            for (number, inertia) in kinematics.combine(mount.body, shares) {
                between[(k, number)] += inertia;
            }
        }
        (between.amax() > 0.0).then_some(InertialCoupling { range, between })
    }

    /// Subtracts the inertia forces B^T a_s and B a_b of the accelerations `a` from `load`, both over all degrees of
    /// freedom.
    pub fn resist_acceleration(&self, a: &[f64], load: &mut [f64]) {
        for (j, column) in self.between.column_iter().enumerate() {
            let own = self.range.clone();
            load[j] -= dot(column.as_slice(), &a[own.clone()]);
            load[own]
                .iter_mut()
                .zip(column.iter())
                .for_each(|(load, inertia)| *load -= inertia * a[j]);
        }
    }

    /// Contribution v_s^T B v_b to the kinetic energy.
    pub fn kinetic(&self, v: &DVector<f64>) -> f64 {
        let (own, bodies) = (
            v.rows(self.range.start, self.range.len()),
            v.rows(0, self.between.ncols()),
        );
        own.dot(&(&self.between * bodies))
    }
}

/// Kinetic energy 1/2 v^T M v of all degrees of freedom.
pub(crate) fn kinetic(blocks: &[Block], couplings: &[InertialCoupling], v: &DVector<f64>) -> f64 {
    let own: f64 = blocks.iter().map(|block| block.kinetic(v.as_slice())).sum();
    own + couplings
        .iter()
        .map(|coupling| coupling.kinetic(v))
        .sum::<f64>()
}
