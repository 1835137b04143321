//! The unknowns of the motion: numbered degrees of freedom, kinematics, carried bodies, mass, and the state of a
//! scene at one time.
//!
//! [`assembly`] numbers the degrees of freedom and assembles M, C and K; [`mobility`] inverts them for a step. This
//! module does not depend on contact forces. It depends on `scene` and `numerics` only.

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
