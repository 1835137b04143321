//! Rails of a scene by their names.

use crate::scene::values::scene::SceneRail;
use crate::text::fault::Faults;
use crate::text::names::{names, resolve};
use crate::text::place::Place;

/// Finds a rail by `structure.rail`, or by its own name where only one structure has it.
pub(super) fn rail_named(
    name: &str,
    rails: &[SceneRail],
    place: &Place<'_>,
    faults: &mut Faults,
) -> Option<usize> {
    let known = names(rails, |rail| &rail.name);
    if known.is_empty() {
        // the structures have been faulted already
        return None;
    }
    resolve(name, &known, "rail, \"structure.rail\"", place, faults)
}
