//! A built foundation with the motions of its degrees of freedom.

use std::sync::OnceLock;

use nalgebra::DMatrix;
use sim::Foundation;

/// A foundation of the simulation, with the motions that its degrees of freedom represent in the FE model.
///
/// The motions are needed after a run: the inertia forces of the structure, which enter reactions and internal
/// forces, are computed from them and from the accelerations of the degrees of freedom.
///
/// ```
/// use foundations::BuiltFoundation;
///
/// let rigid = BuiltFoundation::from(sim::Foundation::rigid());
/// assert_eq!(rigid.foundation.dofs(), 0);
/// assert!(rigid.basis.is_none(), "nothing moves");
/// ```
pub struct BuiltFoundation {
    /// The foundation that carries the rails.
    pub foundation: Foundation,
    /// Motions of the degrees of freedom; `None` for a foundation without mass, which has no degrees of freedom.
    pub basis: Option<MotionBasis>,
}

impl From<Foundation> for BuiltFoundation {
    fn from(foundation: Foundation) -> BuiltFoundation {
        BuiltFoundation {
            foundation,
            basis: None,
        }
    }
}

/// Motions of a structure that are the degrees of freedom of a foundation, in their order.
pub enum MotionBasis {
    /// Natural modes of a frame with subdivided members, as far as wheels can excite them.
    Modes {
        /// The subdivided model, its frame and its modes.
        refined: Box<fea::RefinedModes>,
        /// The inertia of these modes, once effects of their accelerations have been asked for.
        inertia: OnceLock<fea::ModeInertia>,
    },
    /// Rigid parts of a straight girder.
    Parts(RigidParts),
}

/// Rigid parts with mass and their motion.
pub struct RigidParts {
    /// Ends of the parts along the girder, increasing.
    pub ends: Vec<f64>,
    /// Motion of the centres of the parts (three displacements and three rotations each) per unit of each degree of
    /// freedom: (6 x number of parts) rows, one column per degree of freedom.
    pub basis: DMatrix<f64>,
}
