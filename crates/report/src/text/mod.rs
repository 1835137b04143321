//! The content of the report of a run, section by section.

pub(crate) mod checks;
pub(crate) mod codes;
mod design_basis;
mod design_codes;
mod design_governing;
mod design_inputs;
pub mod design_report;
mod design_stresses;
pub(crate) mod fatigue;
mod girder_stresses;
pub(crate) mod girders;
pub(crate) mod responses;
mod run_basis;
mod run_governing;
pub mod run_report;
mod run_verdict;
mod structure_words;
pub mod sweep_report;
