//! SPLINE statements: their values as tables, and the functions AKISPL and CUBSPL that interpolate them.
//!
//! [`write()`] makes a data set that [`read()`] turns into the same numbers, bit for bit. [`read()`] takes
//! data sets of any content and keeps their SPLINE and UNITS statements. A [`Spline`] holds [`SplineValues`]; a
//! [`SplineFunction`] reads them as a function of x and z. The interpolation is written from its sources alone and
//! shares no code with other crates, so that it can check how they read tables.

mod cubic;
mod curves;
mod family;
mod reader;
mod spline;

pub use curves::SplineValues;
pub use family::{SplineFunction, SplineMethod, SplineReading};
pub use reader::read;
pub use spline::{Spline, Tables, of_statement, write};
