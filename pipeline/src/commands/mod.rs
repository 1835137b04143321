//! The commands, one file each.

pub mod check_tables;
pub mod crosscheck;
pub mod deck;
pub mod fea;
pub mod import;
pub mod run;
pub mod sim;
pub mod splines;
