//! The command line of girderway: arguments, output folders, progress, exit statuses, and the comparison with other
//! codes.
//!
//! The libraries perform the work itself: `formats` reads files, `foundations` and `results` compute, and `deck`,
//! `report` and `study` produce the output.
//!
//! Wings, lowest first: cli, clock, exit, progress, interrupt, manifest, journal, output, folder, sweep_rows, shard, crosscheck, commands

pub mod cli;
pub mod clock;
pub mod commands;
pub mod crosscheck;
pub mod exit;
pub mod folder;
pub mod interrupt;
pub mod journal;
pub mod manifest;
pub mod output;
pub mod progress;
mod shard;
mod sweep_rows;
