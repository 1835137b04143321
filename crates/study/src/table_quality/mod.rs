//! The quality of influence tables: the errors of each method of reading them, symmetry, definiteness, risks of
//! extrapolation.
//!
//! 1. [`TableSource`] reads the tables of a file, with the exact surface where the file has one.
//! 2. [`TableQuality::of`] evaluates one table. At its stations: the digits of its entries, its asymmetry and the
//!    ends of its spectrum. Between them: each of the [`TableReadingMethod`]s against the exact surface or, where
//!    there is none, against the beam in bending whose influence coefficients the table holds, if its values lie
//!    within 1 % of one.
//! 3. With a reading that is not symmetric, wheel forces do work in closed loops; with one that is not positive
//!    definite, some layouts of several stiff wheels are unstable. [`ReadingFindings`] holds both, as computed by
//!    [`splines::quality`].
//! 4. `text`, `json` and `figure` write the findings.

pub mod digits;
pub mod extrapolation_risk;
pub mod figure;
mod findings;
pub mod json;
pub mod reading_method;
pub mod readings;
pub mod subject;
pub mod text;

pub use extrapolation_risk::ExtrapolationRisk;
pub use findings::{TableQuality, TableQualitySettings, TableVerdict};
pub use reading_method::TableReadingMethod;
pub use readings::{Pair, ReadingFindings};
pub use subject::{TableItem, TableSource};
