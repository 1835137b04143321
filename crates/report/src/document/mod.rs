//! The page of a report as plain data and as HTML: sections, tables, figures, animations.

pub mod animated;
pub(crate) mod code;
pub mod number;
pub mod page;
pub mod section;
