//! The ADAMS data-set language: statements, SPLINE tables, function expressions.
//!
//! Depends on no other crate of ours: what it finds is a second opinion on the simulator. Knows no file.

pub mod curves;
pub mod dataset;
pub mod error;
mod layout;
mod lexer;
pub mod number;
pub mod statement;
pub mod tables;
pub mod units;
pub mod view;

pub use curves::Curves;
pub use dataset::DataSet;
pub use error::{Error, Fault};
pub use statement::{Argument, Statement, Value};
pub use tables::{Spline, Tables};
pub use units::{Force, Length, Mass, Units};
