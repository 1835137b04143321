//! What each reading of tables will cost an ADAMS user.
//!
//! [`Subject`] is what a file says of its tables, [`Findings`] the numbers of one of them; `text`, `json` and
//! `picture` show them. The numbers themselves come from [`splines::check`].

pub mod digits;
pub mod extrapolation_risk;
mod findings;
pub mod json;
pub mod picture;
pub mod reading_method;
pub mod readings;
pub mod subject;
pub mod text;

pub use extrapolation_risk::ExtrapolationRisk;
pub use findings::{Settings, TableQuality, TableVerdict};
pub use reading_method::TableReadingMethod;
pub use readings::{Pair, ReadingFindings};
pub use subject::{TableItem, TableSource};
