//! The same girder in an independent finite element code, entry by entry.
//!
//! The other code is scikit-fem, run in a Python environment that is made on first use; `fea/` in the
//! repository holds the script and the pinned requirements.

pub mod environment;
pub mod error;
pub mod girder;
pub mod outcome;
pub mod run;

pub use environment::Environment;
pub use error::Error;
pub use girder::{Girder, Quantity};
pub use outcome::{Difference, Outcome};
pub use run::{crosscheck, influence};

#[cfg(test)]
mod tests;
