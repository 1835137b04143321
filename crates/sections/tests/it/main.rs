//! Tests of the crate `sections` through its public interface, one executable.

mod published;
