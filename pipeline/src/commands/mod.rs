//! The commands, one file each.

pub mod fea;
pub mod run;
