//! A scene as a deck sees it: the bodies, wheels and rails that become statements, and how their rails are read.

pub mod compliance;
pub mod mass;
pub mod plan;
pub mod start;
pub(crate) mod travel;
