//! What can prevent envelopes from being computed.

use splines::Axis;

/// An error of a calculation of envelopes.
#[derive(Clone, Debug, thiserror::Error)]
pub enum Error {
    /// The structure cannot be solved.
    #[error(transparent)]
    Frame(#[from] fea::Error),
    /// A function along a rail cannot be evaluated.
    #[error(transparent)]
    Function(#[from] splines::Error),
    /// A train does not fit on its rails.
    #[error(
        "the train is longer than its rails: its position would have to be at least {lowest} and at most {highest}"
    )]
    TooLong {
        /// Index of the train.
        train: usize,
        /// Smallest position at which every wheel is beyond the start of its rail.
        lowest: f64,
        /// Largest position at which every wheel is before the end of its rail.
        highest: f64,
    },
    /// Trains of a case do not fit on the rails beside each other in any order.
    #[error("the trains of the case do not fit on the rails together")]
    NoRoom {
        /// Index of the case.
        case: usize,
    },
    /// Trains of a case hinder each other in a ring.
    #[error(
        "the order of the trains of the case on shared rails is cyclic: each shares a rail with two others that do not share it with each other"
    )]
    Ring {
        /// Index of the case.
        case: usize,
    },
    /// A wheel has a force in a direction that the structure does not resist.
    #[error("the structure has no stiffness against {axis:?} forces on the rail")]
    NoStiffness {
        /// Index of the train.
        train: usize,
        /// Index of the wheel.
        wheel: usize,
        /// Direction of the force.
        axis: Axis,
    },
    /// A wheel stands on a rail that does not exist, or a number is not finite.
    #[error("wheel {wheel} of train {train} is on no rail or has a number that is not finite")]
    Wheel {
        /// Index of the train.
        train: usize,
        /// Index of the wheel.
        wheel: usize,
    },
}
