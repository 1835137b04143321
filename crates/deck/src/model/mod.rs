//! A scene as a deck sees it: the bodies, wheels and rails that become statements, and the compliance of its rails.

pub mod compliance;
pub mod plan;
pub mod start;
