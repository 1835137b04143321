//! Figures of a run: charts, girder plots, the animation of the crane.
//!
//! `design` draws the girders of a design with their governing positions and envelopes.
//! `run_figure` is a figure with its name; `motion`, `rails`, `responses`, `structures` and `animation` make figures,
//! and `run` collects those of a run in the order of the report.

pub mod animation;
pub(crate) mod design;
pub mod error;
pub(crate) mod motion;
pub(crate) mod rails;
pub(crate) mod responses;
pub mod run;
pub mod run_figure;
pub(crate) mod structures;
