//! What crane engineers set beside a simulation: values of codes, fatigue, envelopes, stresses, signals.
//!
//! Pure numbers: knows no file, no name, no scene and no other crate of ours. Formulas without constants that
//! carry units take any consistent system; the others say which (SI, unless told).
//!
//! Where a comment says *not confirmed*, the value is from memory: it could not be compared with the text of its
//! standard, or with a source that quotes or uses it. `docs/theory/practice.md` has the list.

pub mod aisc;
pub mod aist;
pub mod buffer;
pub mod cmaa;
pub mod crane;
pub mod decay;
pub mod drive;
pub mod duty;
pub mod envelope;
pub mod error;
pub mod factor;
pub mod fatigue;
pub mod filter;
pub mod osha;
pub mod rainflow;
pub mod response;
pub mod series;
pub mod skew;
pub mod spectrum;
pub mod stress;

pub use crane::{Crane, WheelLoads};
pub use decay::{Decay, decay};
pub use envelope::{Extremes, Instant, Run, envelope};
pub use error::{Argument, Error};
pub use fatigue::{Damage, Strength};
pub use filter::low_pass;
pub use rainflow::{Cycle, History, rainflow};
pub use response::{Mark, Response, View, response};
pub use series::{Excursions, excursions, mean, resample};
pub use spectrum::{Tone, dominant};
pub use stress::{Point, Section};
