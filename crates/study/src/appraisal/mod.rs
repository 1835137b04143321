//! What each reading of tables will cost an ADAMS user.
//!
//! [`Subject`] is what a file says of its tables, [`Findings`] the numbers of one of them; `text`, `json` and
//! `picture` show them. The numbers themselves come from [`splines::check`].

pub mod findings;
pub mod hazard;
pub mod json;
pub mod manner;
pub mod picture;
pub mod readings;
pub mod subject;
pub mod text;

pub use findings::{Findings, Settings, Verdict};
pub use hazard::Hazard;
pub use manner::Manner;
pub use readings::{Pair, ReadingFindings};
pub use subject::{Item, Subject};
