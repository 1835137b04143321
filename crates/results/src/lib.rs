//! One scene, from checked files to named columns.
//!
//! [`cases::simulate`] runs every case of a [`formats::scene::Document`]; an [`outcome::Outcome`] has the run, its columns
//! ([`record`]), what the structures answered ([`response`]), fatigue ([`fatigue`]), code values ([`codes`]), warnings
//! ([`warning`]) and the numbers of `summary.json` ([`summary`]). Nothing here knows a command line, a progress bar, a
//! picture or an exit status.
//!
//! Wings, lowest first: error, threads, record, layout, response, codes, fatigue, outcome, run_error, warning, summary, cases

pub mod cases;
pub mod codes;
mod error;
pub mod fatigue;
pub mod layout;
pub mod outcome;
pub mod record;
pub mod response;
pub mod run_error;
pub mod summary;
pub mod threads;
pub mod warning;

pub use error::Error;
