//! The girderway program as a library: from a beam spec to influence tables, simulation, plots and report.
//!
//! [`spec`] and [`scene`] read and check input files; [`commands`] do the work; every number that reaches them is
//! finite, checked and in the units asked for.

pub mod animation;
pub mod appraisal;
pub mod cases;
pub mod chart;
pub mod check;
pub mod cli;
pub mod clock;
pub mod codes;
pub mod commands;
pub mod coupling;
pub mod crosscheck;
pub mod deck;
pub mod diagnostic;
pub mod effect;
mod effect_file;
pub mod entries;
pub mod exit;
pub mod fatigue;
pub mod fault;
pub mod grid;
pub mod grid_file;
pub mod import;
pub mod inputs;
pub mod layout;
pub mod link;
pub mod manifest;
pub mod modes_file;
pub mod motion;
mod object;
pub mod output;
pub mod pictures;
pub mod place;
pub mod plight;
pub mod progress;
pub mod quantity;
pub mod record;
pub mod report;
pub mod response;
pub mod scene;
pub mod schema;
pub mod source;
pub mod spec;
pub mod stations;
pub mod story;
pub mod study;
pub mod summary;
pub mod surface_file;
pub mod tables;
pub mod threads;
pub mod track;
pub mod units;
mod vector;
pub mod warning;
