//! The second tier: other codes and numpy in Python, reports in a browser, fuzzing.
//!
//! `cargo test -p girderway --features ci --test ci`. Needs `python3` with PyPI and Chromium; what is missing fails.

mod browser;
mod crosscheck;
mod fuzz;
mod numpy;
mod peers;
