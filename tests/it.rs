//! The program as a whole: what a contributor runs before a commit. No network, interpreter, browser or clock.

mod book;
mod cli;
#[path = "../crates/sim/tests/it/common/mod.rs"]
mod common;
mod crane;
mod deck;
mod design;
mod equilibrium;
mod examples;
mod extremes;
mod history;
mod house;
mod import;
mod malformed;
mod outputs;
mod paper;
mod second_order;
mod selector;
mod study;
mod sweep;
mod tables;
mod ties;
mod verdict;
mod verification;
