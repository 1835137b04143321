//! Signals: what a history says in a few numbers, and the extremes of many histories.
//!
//! `series` has means, even samples and excursions; `filter`, `spectrum` and `decay` work on even samples;
//! `response` has the mean, the extremes and the excursions of one history; `envelope` finds extremes over several
//! runs with coincident values.

mod decay;
mod envelope;
mod filter;
mod response;
mod series;
mod spectrum;

pub use decay::{Decay, decay};
pub use envelope::{ExtremeInstant, Extremes, RunHistories, envelope};
pub use filter::low_pass;
pub use response::{ResponseCharacteristics, ResponseSettings, TimedValue, response};
pub use series::{Excursions, excursions, mean, resample};
pub use spectrum::{HistorySpectrum, SineComponent};
