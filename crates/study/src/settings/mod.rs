//! What is run: settings on ladders, and how much of them a study may do.

pub(crate) mod budget;
pub(crate) mod detail;
pub(crate) mod ladder;
pub(crate) mod setting;
