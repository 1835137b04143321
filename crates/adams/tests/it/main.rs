//! Tests of the crate `adams` through its public interface, one executable.

mod equilibrium;
mod execution;
mod expressions;
mod language;
mod listings;
mod tables;
mod view;
