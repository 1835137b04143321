//! Where the contacts are, how rails and bodies comply there, and the forces of one stage.

pub(crate) mod actuator;
pub(crate) mod chart;
pub(crate) mod charts;
pub(crate) mod correct;
pub(crate) mod drag;
pub(crate) mod forces;
pub(crate) mod geometry;
pub(crate) mod laws;
pub(crate) mod link;
pub(crate) mod overlaps;
pub(crate) mod path;
pub(crate) mod solver;
pub(crate) mod stretch;
pub(crate) mod switches;
pub(crate) mod system;
