//! Tests of the crate `formats` through its public interface, one executable.

mod consequences;
