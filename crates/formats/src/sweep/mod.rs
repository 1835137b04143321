//! Sweep files: many runs of one scene or design, with axes over numbers of its files.
//!
//! `raw` is the file as written, `axis_value` a value of an axis, `values` the checked sweep, `target` the text of the
//! scene or design in which the values of a run take the place of those in the files, and `read` the reader.

mod axis_value;
mod raw;
mod read;
mod target;
mod values;

pub use axis_value::AxisValue;
pub(crate) use raw::{RawAxis, RawLaw, RawScalar, RawSweep};
pub use read::FORMAT;
pub use target::{AxisPlace, SweepTarget};
pub use values::{AxisValues, ResultKind, Sampling, Sweep, SweepAxis, SweepInput};
