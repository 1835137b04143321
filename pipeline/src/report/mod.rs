//! The report: one self-contained HTML page made of plain data.

mod code;
pub mod error;
pub mod number;
pub mod page;
pub mod section;

pub(crate) use code::coded;
pub use error::Error;
pub use number::{number, rounded};
pub use page::Report;
pub use section::{Cell, Column, Fact, Figure, Picture, Section, Table};

#[cfg(test)]
mod tests;
