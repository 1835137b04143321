//! The numbered unknowns of the motion: degrees of freedom, kinematics, carried bodies, mass, and the state of a scene
//! at one time.
//!
//! [`assembly`] numbers a scene and adds up M, C and K; [`mobility`] inverts them for a step. Nothing here knows of
//! contact forces. The wing stands on `scene` and `numerics`.

pub(crate) mod assembly;
pub(crate) mod carried;
pub(crate) mod carried_point;
pub(crate) mod coupling;
pub(crate) mod inertia;
pub(crate) mod kinematics;
pub(crate) mod mobility;
pub(crate) mod point;
pub(crate) mod state;
pub(crate) mod wheels;
