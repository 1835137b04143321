//! Charts as plain data, drawn to SVG with plotters.
//!
//! A [`Chart`] has curves over two axes, for SVG files and for the report; a [`SurfacePlot`] is an influence grid, a
//! [`GirderPlot`] the side view of a girder. plotters draws them: its chart builder places the frame, its coordinates
//! place the data, its mesh draws grid, ticks and labels, its series and elements the rest. This module adds a
//! drawing backend that writes small SVG with groups, a coordinate with ticks of its own, and a few elements.
//!
//! Files in their order, each of which imports from earlier ones only: `error`, `label`, `text`, `svg`; `backend`,
//! `series`, `palette`, `elements`, `sheet`; `axis`, `scale`, `ticks`, `coordinate`, `frame`, `legend`; `thinning`,
//! `contour`; `line_chart`, `surface_plot`, `girder_plot`.
//!
//! ```
//! use report::chart::{ChartAxis, Chart, Series, Style};
//!
//! let points = (0..100).map(|i| [f64::from(i), f64::from(i * i)]).collect();
//! let chart = Chart::new("Squares", ChartAxis::new("number", ""), ChartAxis::new("square", ""))
//!     .with(Series::new("squares", Style::Line, points));
//! let svg = chart.svg()?.file();
//! assert!(svg.starts_with("<svg ") && svg.contains("Squares"));
//! # Ok::<(), report::chart::Error>(())
//! ```

mod axis;
mod backend;
mod contour;
mod coordinate;
mod elements;
mod error;
mod frame;
mod girder_plot;
pub(crate) mod label;
mod legend;
mod line_chart;
mod palette;
mod scale;
mod series;
mod sheet;
mod surface_plot;
mod svg;
mod text;
mod thinning;
mod ticks;

pub use axis::ChartAxis;
pub use error::Error;
pub use frame::PlotArea;
pub use girder_plot::{Deflected, GirderPlot, SupportMark};
pub use line_chart::{Chart, Drawing};
pub use series::{Series, SeriesMarker, Style};
pub use surface_plot::SurfacePlot;
pub use svg::{Svg, stack};
pub(crate) use text::text_width;

#[cfg(test)]
mod tests;
