//! Elements of the text of a deck: identifiers, names, expressions, remarks, and the form in which tables are
//! evaluated.

pub(crate) mod form;
pub mod ids;
pub(crate) mod remark;
pub(crate) mod text;
