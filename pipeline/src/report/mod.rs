//! The report: one self-contained HTML page made of plain data.

pub mod error;
pub mod number;
pub mod page;
pub mod section;

pub use error::Error;
pub use number::{number, rounded};
pub use page::Report;
pub use section::{Cell, Column, Fact, Figure, Picture, Section, Table};

#[cfg(test)]
mod tests;
