//! Assertions on values known from elsewhere: a closed form, a publication, another code or a prototype of the method.

#![allow(dead_code, reason = "not every test program uses both")]

use std::fmt::Display;

/// Asserts that `found` lies within the fraction `tolerance` of the value `known` from `source`; not a number never does.
#[track_caller]
pub fn assert_near(what: impl Display, source: &str, known: f64, found: f64, tolerance: f64) {
    let is_near = (found - known).abs() <= tolerance * known.abs();
    assert!(
        is_near,
        "{what}: {found:e}, {source}: {known:e} within {tolerance:e}"
    );
}

/// Asserts that `found` is at most the value `known` from `source`; not a number never is.
#[track_caller]
pub fn assert_at_most(what: impl Display, source: &str, known: f64, found: f64) {
    assert!(
        found <= known,
        "{what}: {found:e}, {source}: at most {known:e}"
    );
}
