//! Tests of the crate `results` through its public interface, one executable.

mod bounces;
mod girders;
mod loaded;
