//! What is drawn of a run: charts, plans, the moving crane.

pub mod animation;
pub mod error;
pub mod pictures;
pub(crate) mod rail_picture;
pub(crate) mod response_picture;
pub mod run;
