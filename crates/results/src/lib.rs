//! One scene, from checked files to named columns.
//!
//! [`cases::simulate`] runs every case of a [`formats::scene::Document`]. A [`case_result::CaseResult`] contains the
//! run, its columns ([`columns`]), the response of the structures ([`response`]), extremes of
//! girders ([`girders`]), fatigue ([`fatigue`]) and values of
//! codes ([`codes`]). Warnings ([`warning`]) and the numbers of `summary.json` ([`summary`]) are derived from it. The
//! crate does not depend on a command line, a progress bar, figures or exit statuses.
//!
//! ```
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use formats::scene::Document;
//! use foundations::{distinct_specs, solve_specs};
//!
//! let document = Document::open("../../examples/bogie/scene.json".as_ref()).expect("a scene without faults");
//! let solved = solve_specs(&document, &distinct_specs(&document)).expect("a girder that stands");
//! let cases = results::cases::simulate(&document, &solved, None, &|_| ())?;
//!
//! let bogie = cases[0].columns.values("bogie.deflection");
//! let (sample, deepest) = results::columns::peak(bogie).expect("a history with rows");
//! assert!((deepest - 0.5473).abs() < 1e-4, "in ft, at row {sample}");
//! let summary = results::summary::run(document.scene(), &cases[0], 1);
//! assert_eq!(summary["status"], "done");
//! # Ok(())
//! # }
//! ```
//!
//! Wings, lowest first: error, threads, columns, loads, steps, pieces, layout, plane_spans, response, undetermined, girders, codes, fatigue, case_result, run_error, preflight, warning,
//! verdict, summary, observe, cases, scene_run, many

pub mod case_result;
pub mod cases;
pub mod codes;
pub mod columns;
mod error;
pub mod fatigue;
pub mod girders;
pub mod layout;
mod loads;
pub mod many;
pub mod observe;
mod pieces;
mod plane_spans;
pub mod preflight;
pub mod response;
pub mod run_error;
pub mod scene_run;
pub mod steps;
pub mod summary;
pub mod threads;
pub mod undetermined;
pub mod verdict;
pub mod warning;

pub use error::Error;

/// The examples of the page on the libraries.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/library.md")]
pub struct LibraryPage;
