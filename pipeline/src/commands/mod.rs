//! The commands, one file each.

pub mod check_tables;
pub mod crosscheck;
pub mod deck;
pub mod design;
mod factored;
pub mod fea;
mod fewest;
pub mod import;
pub mod init;
pub mod run;
pub mod schema;
pub mod sections;
pub mod shell;
pub mod sim;
pub mod splines;
pub mod study;
pub mod sweep;
