//! The state of a structure under a preload, about which its motions are linear again.
//!
//! A preload gives every member an axial force N. With these forces the stiffness is K + K_g(N): exact functions of
//! stability for beams ([`splines::BeamColumn`]), N/L across trusses, rods and cables, and what forces on rigid arms add.
//! The model that [`preloaded`] returns holds N in its members; grids, surfaces, effects and modes of that model are those
//! about the state.
//!
//! Order of the files: `given` (the preload as given), `forces` (axial forces and forces on arms in a motion), `critical`
//! (the smallest factor on the preload at which the stiffness is singular), `caution` (what the state leaves out), `state`.

mod caution;
mod critical;
mod forces;
mod given;
mod state;

pub use caution::{Caution, CautionKind};
pub use critical::{BucklingMode, CriticalFactor, MOST_CRITICAL};
pub(crate) use given::{ArmForce, BodyLoads};
pub use given::{Preload, RailForce};
pub use state::{LoadedFrame, PreloadedState, loaded_frame, preloaded};
