//! Tests of the crate `practice` through its public interface, one executable.

mod codes;
mod fatigue;
mod limits;
mod runway;
mod signals;
