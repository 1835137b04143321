//! Limits of codes against the results of a design.

use formats::design::Design;

use crate::outcome::{LimitCheck, SolvedCase};

/// Checks the limits of the design's code.
pub(crate) fn check_limits(_design: &Design, _cases: &[SolvedCase]) -> Vec<LimitCheck> {
    Vec::new()
}
