//! The runs of a study: settings made ready, references that are checked, the study itself.

pub(crate) mod investigate;
pub(crate) mod point;
pub(crate) mod reference;
pub(crate) mod setup;
