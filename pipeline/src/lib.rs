//! From a beam spec to influence tables, simulation, plots and report.

pub mod chart;
pub mod crosscheck;
pub mod report;
