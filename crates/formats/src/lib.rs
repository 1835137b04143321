//! File formats and units: conversion of the bytes of files to checked values, and back.
//!
//! This crate reads beam specs ([`spec`]), scenes ([`scene`]), grids ([`grid`]) and tables ([`tables`]). Every number
//! of the result is finite, checked and in the requested units. Every fault of a file is reported as a
//! [`text::diagnostic::Diagnostic`] with its place.
//!
//! ```
//! use formats::text::source::Source;
//! use formats::spec::Spec;
//! use formats::units::{Force, Length, Units};
//!
//! let text = r#"{"format": "girderway-beam/1",
//!  "units": {"length": "ft", "force": "lbf", "time": "s"},
//!  "girder": {"spans": [60, 60], "E": 4.176e9, "I_vertical": 2.5}, "stations": [0, 60, 120]}"#;
//! let source = Source { name: "girder.json".to_owned(), text: text.to_owned() };
//! let metres = Units { length: Length::Metre, force: Force::Newton };
//! let spec = Spec::read(&source, Some(metres)).expect("a girder over two spans");
//! assert_eq!(spec.rails()[0].range, [0.0, 36.576]);
//!
//! let wrong = Source { text: text.replace("[60, 60]", "[60, -60]"), ..source };
//! let diagnostics = Spec::read(&wrong, None).expect_err("a span of negative length");
//! let first = diagnostics[0].to_string();
//! assert!(first.starts_with("girder.json:3:27: girder.spans[1]: must be positive, got -60"), "{first}");
//! ```
//!
//! The modules from low to high are [`limits`], [`text`], [`vector`], [`units`], [`check`], [`spec`], [`grid`], [`tables`],
//! [`scene`], [`design`], [`sweep`], [`schema`]; [`verdict`] is what summaries of designs and runs have in common,
//! [`plausible`] the values beyond which an input is doubted.
//!
//! Wings, lowest first: limits, kept, verdict, text, vector, units, check, plausible, own_limits, practice_words, spec, grid, tables, scene, design, sweep, schema

pub mod check;
pub mod design;
pub mod grid;
pub mod kept;
pub mod limits;
mod own_limits;
pub mod plausible;
mod practice_words;
pub mod scene;
pub mod schema;
pub mod spec;
pub mod sweep;
pub mod tables;
pub mod text;
pub mod units;
pub mod vector;
pub mod verdict;

pub use practice_words::LateralSection;
