//! The ADAMS data-set language: statements, SPLINE tables, function expressions, their execution.
//!
//! Depends on no other crate of ours: what it finds is a second opinion on the simulator. Knows no file.

mod code;
pub mod curves;
pub mod dataset;
pub mod error;
pub mod expression;
mod frame;
pub mod functions;
pub mod interpolation;
mod layout;
mod lexer;
mod linear;
pub mod model;
mod newton;
pub mod number;
mod reader;
pub mod scalar;
mod solve;
mod space;
pub mod state;
pub mod statement;
pub mod statics;
pub mod tables;
pub mod units;
pub mod view;

pub use curves::Curves;
pub use dataset::DataSet;
pub use error::{Error, Fault};
pub use expression::Expression;
pub use interpolation::{Family, Method, Reading};
pub use model::Model;
pub use scalar::{Dual, Scalar};
pub use solve::{Load, Solution};
pub use state::{Pose, State};
pub use statement::{Argument, Statement, Value};
pub use statics::{Equilibrium, Reaction};
pub use tables::{Spline, Tables};
pub use units::{Force, Length, Mass, Units};
