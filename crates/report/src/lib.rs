//! Charts, pictures, the animation of a crane, and the page of a report.
//!
//! [`chart`] draws plain data. [`figures`] selects the figures of a run, [`text`] the text and tables of its report.
//! [`Report`] is one self-contained page of HTML.
//!
//! # Example
//! ```
//! use report::chart::{Chart, ChartAxis, Series, Style};
//! use report::{Report, ReportSection, ReportTable, TableCell, TableColumn};
//!
//! let axes = [ChartAxis::new("place", "m"), ChartAxis::new("deflection", "mm")];
//! let [x, y] = axes;
//! let points = vec![[0.0, 0.0], [3.0, 4.2], [6.0, 0.0]];
//! let chart = Chart::new("Deflection of a girder", x, y).with(Series::new("loaded", Style::Line, points));
//! let table = ReportTable {
//!     caption: "Reactions".to_owned(),
//!     columns: vec![TableColumn::new("support", ""), TableColumn::new("force", "kN")],
//!     rows: vec![vec!["left".into(), TableCell::Number(12.5)]],
//! };
//! let section = ReportSection::new("Girder").fact("span", 6.0, "m").figure(chart, "Below the wheel.").table(table);
//! let report = Report { title: "A crane".to_owned(), subtitle: String::new(), sections: vec![section] };
//! let page = report.html(Some(1))?;
//! assert!(page.starts_with("<!DOCTYPE html>") && page.contains("12.5"));
//! # Ok::<(), report::Error>(())
//! ```
//!
//! Wings, lowest first: chart, error, document, figures, text

pub mod chart;
pub mod document;
pub mod error;
pub mod figures;
pub mod text;

pub(crate) use document::code::coded;
pub use document::number::{cleared, is_rounding, number};
pub use document::page::Report;
pub use document::section::{
    Banner, BannerTone, Fact, Figure, Picture, ReportSection, ReportTable, TableCell, TableColumn,
};
pub use error::Error;
pub use text::checks::verdict_lines;

#[cfg(test)]
mod tests;
