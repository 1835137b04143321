//! Tests of the crate `foundations` through its public interface, one executable.

mod build;
mod select;
