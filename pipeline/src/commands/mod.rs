//! The commands, one file each.

pub mod crosscheck;
pub mod fea;
pub mod run;
pub mod splines;
