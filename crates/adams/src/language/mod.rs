//! Data sets as text: lines, statements with their arguments, units.
//!
//! `lexer` joins lines to statements, `reader` turns each into a [`Statement`] by the table of its arguments,
//! and `layout` writes statements back. A [`DataSet`] that has been written reads back to the same numbers,
//! bit for bit. References between statements are not resolved here.

mod data_set;
mod layout;
pub(crate) mod lexer;
mod reader;
mod statement;
mod units;

pub use data_set::DataSet;
pub use statement::{ArgumentValue, Statement, StatementArgument};
pub(crate) use units::UnitWords;
pub use units::{AdamsForceUnit, AdamsLengthUnit, AdamsMassUnit, AdamsUnits};
