//! What a study runs: the list of settings, and the budget that limits it.

pub(crate) mod budget;
pub(crate) mod detail;
pub(crate) mod list;
pub(crate) mod setting;
