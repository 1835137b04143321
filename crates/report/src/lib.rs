//! What people look at: charts, pictures, the moving crane, and the page of a report.
//!
//! [`chart`] draws plain data; [`pictures`] and its siblings choose what to draw of a run; [`story`] tells of it; [`Report`]
//! is one self-contained page of HTML.

pub mod animation;
pub mod chart;
mod code;
mod codes_story;
pub mod error;
mod fatigue_story;
pub mod number;
pub mod page;
pub mod pictures;
mod rail_picture;
mod response_picture;
mod response_story;
pub mod section;
pub mod story;

pub(crate) use code::coded;
pub use error::Error;
pub use number::number;
pub use page::Report;
pub use rail_picture::rails;
pub use response_picture::pictures as responses;
pub use section::{Cell, Column, Fact, Figure, Picture, Section, Table};

#[cfg(test)]
mod tests;
