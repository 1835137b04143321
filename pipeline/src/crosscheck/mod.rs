//! Comparison of influence grids with those of independent finite element codes, entry by entry.
//!
//! The other codes run in a Python environment that is created on first use. The directory `fea/` of the repository
//! contains the scripts and the pinned requirements.

pub mod environment;
pub mod error;
pub mod girder;
pub mod numbers;
pub mod outcome;
pub mod peer;
pub mod plot;
pub mod run;

pub use environment::Environment;
pub use error::Error;
pub use girder::PlainGirder;
pub use numbers::in_numbers;
pub use outcome::{BlockDifference, PeerComparison, PeerOutcome};
pub use peer::{Peer, PeerAnswer, PeerMeasure, PlainGrid, Station};
pub use run::{again, ask, crosscheck, influence};

#[cfg(test)]
mod tests;
