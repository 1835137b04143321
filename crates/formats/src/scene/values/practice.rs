//! What the codes of crane engineers need beside the scene itself.

use practice::aist::CraneKind;
use practice::factor::{HoistingClass, DriveOnset, Release};
use practice::skew::Guide;

/// Properties of a crane that codes need and its scene does not give.
#[derive(Clone, Debug, PartialEq)]
pub struct Practice {
    /// Index of the body that runs on two rails.
    pub crane: usize,
    /// Its rails, as indices into the scene's.
    pub rails: [usize; 2],
    /// The body that runs on it, if there is one.
    pub trolley: Option<usize>,
    /// Bodies that hang from either.
    pub loads: Vec<usize>,
    /// Row of TR-13's table.
    pub kind: CraneKind,
    /// HoistingClass class; none: not given.
    pub hoisting: Option<HoistingClass>,
    /// How its drive forces set in.
    pub drives: DriveOnset,
    /// How fast a payload is released.
    pub release: Release,
    /// What guides it.
    pub guide: Guide,
    /// Least distance of the hook from a rail, length; none: that of the run.
    pub approach: Option<f64>,
    /// Width of the rail head, length.
    pub rail_head: Option<f64>,
    /// Rated speeds of bridge, trolley and hoist, length / time; none: those that the scene prescribes.
    pub speeds: [Option<f64>; 3],
}
