//! Inertial coupling of bodies and the structures that they carry: B of M = [M_b, B^T; B, M_s], B the momentum of the
//! structure's degrees of freedom by the motion of its carrier.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::inertia::Block;
use super::kinematics::Kinematics;
use crate::Carrier;

/// B of one structure.
pub(crate) struct InertialCoupling {
    /// Degrees of freedom of the structure.
    pub range: Range<usize>,
    /// B, degrees of freedom of the structure x those of the bodies.
    pub between: DMatrix<f64>,
}

impl InertialCoupling {
    /// B of the structure with the degrees of freedom `range` on `mount`, `bodies` being the number of those of the
    /// bodies; `None` where nothing couples them.
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

    /// v_s^T B v_b.
    pub fn kinetic(&self, v: &DVector<f64>) -> f64 {
        let (own, bodies) = (v.rows(self.range.start, self.range.len()), v.rows(0, self.between.ncols()));
        own.dot(&(&self.between * bodies))
    }
}

/// 1/2 v^T M v of all degrees of freedom.
pub(crate) fn kinetic(blocks: &[Block], couplings: &[InertialCoupling], v: &DVector<f64>) -> f64 {
    let own: f64 = blocks.iter().map(|block| block.kinetic(v.as_slice())).sum();
    own + couplings.iter().map(|coupling| coupling.kinetic(v)).sum::<f64>()
}
