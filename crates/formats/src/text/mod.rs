//! Input files: their bytes, their text as a located tree, and what is wrong with them.
//!
//! A text is read into a tree of values that know their bytes (`tree`, by the grammar in `json`), and the types of a
//! format are converted from the tree (`convert`). What is wrong is a [`fault::Fault`] by its path, and a
//! [`diagnostic::Diagnostic`] with line and column once it has been found in the text ([`source`]).

pub(crate) mod convert;
pub mod diagnostic;
pub mod entries;
pub mod fault;
pub mod inputs;
mod json;
pub mod names;
pub mod number;
pub mod object;
pub mod place;
pub mod source;
pub mod tree;
mod wording;
