//! The command line of girderway: arguments, output folders, progress, exit statuses, and the comparison with other codes.
//!
//! The work itself is done by the libraries: `formats` reads, `foundations` and `results` compute, `deck`, `report` and
//! `study` show.
//!
//! Wings, lowest first: cli, clock, exit, progress, manifest, output, crosscheck, commands

pub mod cli;
pub mod clock;
pub mod commands;
pub mod crosscheck;
pub mod exit;
pub mod manifest;
pub mod output;
pub mod progress;
