//! What AKISPL and CUBSPL make of a SPLINE: cubics along x, straight lines along z.
//!
//! Written from the references alone and shared with no other crate, so that it can check the tables' readings.

mod akima;
mod family;
mod hermite;
mod natural;

pub use family::{Family, Method, Reading};
