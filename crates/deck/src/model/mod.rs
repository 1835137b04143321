//! Intermediate model between a scene and its statements: bodies, wheels and rails with identifiers, and the
//! compliance of the rails.

pub mod compliance;
pub mod plan;
pub mod refuse;
pub mod start;
