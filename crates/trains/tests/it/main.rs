//! Tests of the crate `trains` through its public interface, one executable.

mod common;
mod joints;
mod loaded;
mod long;
mod random;
mod supports;
mod worked;
