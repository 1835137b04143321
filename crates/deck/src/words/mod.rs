//! What statements are written with: identifiers, names, expressions, remarks.

pub(crate) mod expression;
pub(crate) mod form;
pub mod ids;
pub(crate) mod name;
pub(crate) mod remark;
