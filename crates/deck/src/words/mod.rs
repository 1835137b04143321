//! The parts of a deck's text: identifiers, names, expressions, remarks, and the form in which tables are read.

pub(crate) mod form;
pub mod ids;
pub(crate) mod remark;
pub(crate) mod text;
