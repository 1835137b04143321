//! The girderway program.
fn main() {}
