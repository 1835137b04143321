//! SPLINE tables in the command language of Adams View (`.cmd`).
//!
//! [`write()`] makes a file of commands that [`read()`] turns into the same numbers, bit for bit. [`read()`]
//! takes files with any commands and uses only `data_element create spline` and `defaults units`.

mod lexer;
mod reader;
mod units;
mod writer;

pub use reader::{ModifiedSpline, read, read_with_modified};
pub use writer::write;
