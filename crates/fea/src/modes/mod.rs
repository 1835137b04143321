//! Natural modes of a frame, K phi = omega^2 M phi, and the effects of its inertia.
//!
//! M is the consistent mass of the members plus the rigid masses, assembled in the unknowns of the
//! stiffness. Block Lanczos with the factor of K finds the lowest modes; the number of negative pivots of
//! K - sigma^2 M proves that none is missing. `refined` cuts members until the mesh no longer shows in the
//! frequencies; `inertial` gives reactions and internal forces of weight and inertia. `decoupled` restricts the
//! search to the unknowns that given forces can move, and `interior` lets Timoshenko members deflect between nodes
//! under their own inertia.
//!
//! Order of the files: `shapes`, `interior`, `inertia_motions`, `mass`, `decoupled`, `block`, `lanczos`,
//! `mode`, `all`, `lowest`, `inertial`, `iterated`, `refined`.

mod all;
mod block;
mod decoupled;
mod inertia_motions;
mod inertial;
mod interior;
mod iterated;
mod lanczos;
mod lowest;
mod mass;
mod mode;
mod refined;
mod shapes;

pub use all::MOST_DENSE_UNKNOWNS;
pub use decoupled::ExcitingForces;
pub use inertial::{ModeInertia, Weight};
pub use lowest::modes;
pub use mass::rigid_mass;
pub use mode::{Mode, Modes};
pub use refined::{RefinedModes, check_full_modes, excited_modes, full_modes, refined_modes};
