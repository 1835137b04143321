//! A foundation that is made, with the model whose motions are its degrees of freedom.

use std::sync::Arc;

use fea::Frame;
use nalgebra::DMatrix;
use sim::Foundation;

/// A foundation, with the model behind its freedoms.
pub struct BuiltFoundation {
    /// What carries the rails.
    pub foundation: Foundation,
    /// What moves; `None`: nothing that has mass.
    pub motion: Option<MotionBasis>,
}

impl From<Foundation> for BuiltFoundation {
    fn from(foundation: Foundation) -> BuiltFoundation {
        BuiltFoundation { foundation, motion: None }
    }
}

/// The model whose motions are the freedoms of a foundation, in their order.
pub enum MotionBasis {
    /// Natural modes of a frame, with its members cut, as far as wheels can excite them.
    Modes {
        /// The frame.
        frame: Arc<Frame>,
        /// Its modes.
        refined: Box<fea::Refined>,
    },
    /// Rigid parts of a straight girder.
    Parts(RigidParts),
}

/// Rigid parts with mass, and how they move.
pub struct RigidParts {
    /// Ends of the parts along the girder, increasing.
    pub ends: Vec<f64>,
    /// Motion of the parts' centres, six each (displacements, rotations), by the structure's freedoms.
    pub basis: DMatrix<f64>,
}
