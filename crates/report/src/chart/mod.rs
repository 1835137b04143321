//! Charts as plain data, drawn to SVG with plotters.
//!
//! One [`Chart`] serves both the SVG file and the report. [`SurfacePlot`] draws an influence grid,
//! [`GirderPlot`] the girder with its rail. Pictures are drawn in tenths of a pixel under a viewBox, so that
//! curves are smooth although plotters places everything on whole numbers.

pub mod axis;
#[allow(clippy::module_inception)]
pub mod chart;
pub mod contour;
pub mod error;
pub mod frame;
pub mod girder_plot;
pub mod legend;
pub mod path;
pub mod scale;
pub mod series;
pub mod stack;
pub mod surface_plot;
pub mod svg;
pub mod text;

pub use axis::Axis;
pub use chart::{Chart, Drawing};
pub use error::Error;
pub use frame::Frame;
pub use girder_plot::{Deflected, GirderPlot, Support};
pub use series::{Marker, Series, Style};
pub use stack::stack;
pub use surface_plot::SurfacePlot;

#[cfg(test)]
mod tests;
