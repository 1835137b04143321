//! Figures of a run: charts, girder plots, the animation of the crane.
//!
//! `rail_sketch` draws a rail with supports and wheels, `design` the envelopes of a design, `influence_lines` the
//! influence lines of its governing values with the wheels above them.
//! `sweep` draws the distributions of the results of many runs.
//! `run_figure` is a figure with its name, `run_name` the name of a run; `motion`, `rails`, `responses`, `structures`
//! and `animation` make figures,
//! and `run` collects those of a run in the order of the report.

pub mod animation;
pub(crate) mod design;
pub mod error;
pub(crate) mod influence_lines;
pub(crate) mod motion;
pub(crate) mod rail_sketch;
pub(crate) mod rails;
pub(crate) mod responses;
pub mod run;
pub mod run_figure;
pub(crate) mod run_name;
pub(crate) mod structures;
pub mod sweep;
