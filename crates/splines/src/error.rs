//! What can go wrong along a rail.

use crate::Axis;

/// Errors of this crate: ids and numbers; the caller knows the names and files.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A rail index that no cell has.
    #[error("rail {rail} does not exist")]
    NoRail {
        /// The index asked for.
        rail: usize,
    },
    /// A coordinate that no cell of the rail covers.
    #[error("rail {rail} has no cell at x = {x}")]
    OffRail {
        /// Which rail.
        rail: usize,
        /// The coordinate asked for.
        x: f64,
    },
    /// A direction in which the structure has no stiffness there.
    #[error("nothing resists a {axis:?} force on rail {rail} at x = {x}")]
    Unstiffened {
        /// Which rail.
        rail: usize,
        /// The coordinate asked for.
        x: f64,
        /// The direction asked for.
        axis: Axis,
    },
}
