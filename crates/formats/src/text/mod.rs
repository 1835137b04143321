//! Input files: their bytes, their text as a located tree, and their faults.
//!
//! A text is parsed into a tree of values with their byte ranges (`tree`, parsed by `json`), and the tree is
//! converted to the types of a format (`convert`) and checked (`examine`). An error is first a [`fault::Fault`], which
//! has a path. It becomes a [`diagnostic::Diagnostic`] with line and column when its place in the text is determined
//! ([`source`]).

pub(crate) mod convert;
pub mod diagnostic;
pub mod entries;
pub(crate) mod examine;
pub mod fault;
pub mod inputs;
mod json;
pub mod names;
pub mod number;
pub mod object;
#[cfg(unix)]
mod pipe;
pub mod place;
pub mod source;
pub mod tree;
mod wording;
