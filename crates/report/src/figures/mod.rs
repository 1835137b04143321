//! Figures of a run: charts, girder plots, the animation of the crane.

pub mod animation;
pub mod error;
pub mod pictures;
pub(crate) mod rail_picture;
pub(crate) mod response_picture;
pub mod run;
