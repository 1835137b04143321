//! What codes need of the crane of a design.

use formats::design::Design;
use practice::factor::phi2;

/// phi2 of the hoisting class at the rated speed; `None` where the design does not give both.
pub(crate) fn phi2_of(design: &Design) -> Option<f64> {
    phi2(design.practice.hoisting?, design.practice.hoist_speed?).ok()
}
