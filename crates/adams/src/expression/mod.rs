//! Function expressions: their text as a tree, the functions they call, and numbers with derivatives.
//!
//! [`parse`] turns text into an [`Expression`]. Names are not resolved here: the wing `model` determines which
//! marker or table an identifier refers to. Functions are written once for every [`Scalar`], so that the same
//! code gives values (`f64`) and values with derivatives ([`Dual`]).

pub mod functions;
mod parser;
mod scalar;
mod tree;

pub use parser::parse;
pub use scalar::{Dual, Scalar};
pub use tree::{Expression, ExpressionName, FactorOperator, TermOperator};
