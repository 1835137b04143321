//! What people look at: charts, pictures, the moving crane, and the page of a report.
//!
//! [`chart`] draws plain data; [`figures`] chooses what to draw of a run, [`text`] what to say of it; [`Report`] is one
//! self-contained page of HTML.
//!
//! Wings, lowest first: error, chart, document, figures, text

pub mod chart;
pub mod document;
pub mod error;
pub mod figures;
pub mod text;

pub(crate) use document::code::coded;
pub use document::number::number;
pub use document::page::Report;
pub use document::section::{Fact, Figure, Picture, ReportSection, ReportTable, TableCell, TableColumn};
pub use error::Error;

#[cfg(test)]
mod tests;
