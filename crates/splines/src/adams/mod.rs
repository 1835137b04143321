//! SPLINE statements of ADAMS data sets, as text.
//!
//! [`write()`] makes a data set that [`read()`] turns into the same numbers, bit for bit. [`read()`] takes data sets
//! of any content and keeps their SPLINE and UNITS statements.

mod lexer;
mod reader;
mod units;
mod writer;

use crate::{Error, Table};

pub use reader::read;
pub use units::{Force, Length, Mass, Units};
pub use writer::write;

/// What this crate knows of a data set.
#[derive(Clone, Debug, PartialEq)]
pub struct DataSet {
    /// First line; `None` where it is blank or already a statement.
    pub title: Option<String>,
    /// UNITS statement, if there is one that says more than NONE.
    pub units: Option<Units>,
    /// In the order of the text.
    pub splines: Vec<Spline>,
}

/// One SPLINE statement.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    /// Identifier, unique among splines.
    pub id: u32,
    /// `adams_view_name` of the comment before it.
    pub name: Option<String>,
    /// `adams_view_units` of the comment before it, such as `no_units`.
    pub units: Option<String>,
    /// LINEAR_EXTRAPOLATE.
    pub linear: bool,
    /// The values: x, and one curve for every z or one alone.
    pub table: Table,
}

/// What is wrong with a data set, at a line and column.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// Something that cannot stand there.
    #[error("unexpected text")]
    Text,
    /// A number that is no finite real number.
    #[error("not a number")]
    Number,
    /// An identifier that is no positive integer.
    #[error("not an identifier")]
    Id,
    /// An identifier used before.
    #[error("SPLINE/{id} stands twice")]
    Twice {
        /// The identifier.
        id: u32,
    },
    /// An argument that the statement has not, or that is ambiguous.
    #[error("unknown argument")]
    Argument,
    /// An argument given before.
    #[error("argument given twice")]
    Repeated,
    /// Values kept in another file.
    #[error("SPLINE/{id} keeps its values in another file")]
    File {
        /// The identifier.
        id: u32,
    },
    /// No X.
    #[error("SPLINE/{id} has no X")]
    NoX {
        /// The identifier.
        id: u32,
    },
    /// No Y.
    #[error("SPLINE/{id} has no Y")]
    NoY {
        /// The identifier.
        id: u32,
    },
    /// A Y list of the wrong length: one value each x, with z before them in a family.
    #[error("SPLINE/{id}: {found} values, expected {expected}")]
    Count {
        /// The identifier.
        id: u32,
        /// Values found.
        found: usize,
        /// Values expected.
        expected: usize,
    },
    /// Values that make no table.
    #[error("SPLINE/{id}: {source}")]
    Table {
        /// The identifier.
        id: u32,
        /// Why not.
        source: Box<Error>,
    },
    /// A unit that is not known, or UNITS without force and length.
    #[error("unknown unit")]
    Unit,
}
