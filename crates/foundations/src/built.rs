//! A built foundation, with the model whose motions are its degrees of freedom.

use std::sync::Arc;

use fea::FactoredFrame;
use nalgebra::DMatrix;
use sim::Foundation;

/// A foundation of the simulation, with the model behind its degrees of freedom.
///
/// The model is needed after a run: the inertia of the structure, which enters reactions and internal forces, is computed
/// from the accelerations of the degrees of freedom and from this model.
///
/// ```
/// use foundations::BuiltFoundation;
///
/// let rigid = BuiltFoundation::from(sim::Foundation::rigid());
/// assert_eq!(rigid.foundation.dofs(), 0);
/// assert!(rigid.motion.is_none(), "nothing moves");
/// ```
pub struct BuiltFoundation {
    /// The foundation that carries the rails.
    pub foundation: Foundation,
    /// The model whose motions are the foundation's degrees of freedom; `None` where it has none, being without mass.
    pub basis: Option<MotionBasis>,
}

impl From<Foundation> for BuiltFoundation {
    fn from(foundation: Foundation) -> BuiltFoundation {
        BuiltFoundation { foundation, basis: None }
    }
}

/// The model whose motions are the degrees of freedom of a foundation, in their order.
pub enum MotionBasis {
    /// Those natural modes of a frame with subdivided members that wheels can excite.
    Modes {
        /// The frame.
        frame: Arc<FactoredFrame>,
        /// The subdivided model and its modes.
        refined: Box<fea::RefinedModes>,
    },
    /// Rigid parts of a straight girder.
    Parts(RigidParts),
}

/// Rigid parts with mass and their motion.
pub struct RigidParts {
    /// Ends of the parts along the girder, increasing.
    pub ends: Vec<f64>,
    /// Motion of the parts' centres (three displacements and three rotations each) by the degrees of freedom:
    /// 6 parts x degrees of freedom.
    pub basis: DMatrix<f64>,
}
