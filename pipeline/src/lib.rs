//! The command line of girderway: arguments, output folders, progress, exit statuses, and the comparison with other
//! codes.
//!
//! The libraries perform the work itself: `formats` reads files, `foundations` and `results` compute, and `deck`,
//! `report` and `study` produce the output, which `outputs` writes.
//!
//! Wings, lowest first: cli, exit, verdict, progress, interrupt, output, crosscheck, commands

pub mod cli;
pub mod commands;
pub mod crosscheck;
pub mod exit;
pub mod interrupt;
pub mod output;
pub mod progress;
pub mod verdict;
