//! SPLINE statements of ADAMS data sets, as text.
//!
//! [`write()`] makes a data set that [`read()`] turns into the same numbers, bit for bit. [`read()`] takes data sets
//! of any content and keeps their SPLINE and UNITS statements.

mod reader;
mod statement;
mod writer;

use crate::{Curves, Units};

pub use reader::read;
pub use statement::of_statement;
pub use writer::write;

/// The tables of a data set.
#[derive(Clone, Debug, PartialEq)]
pub struct Tables {
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
    pub curves: Curves,
}
