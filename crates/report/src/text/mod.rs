//! The content of the report of a run, section by section.

pub(crate) mod codes;
pub(crate) mod fatigue;
pub(crate) mod responses;
pub mod run_report;
