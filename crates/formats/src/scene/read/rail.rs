//! References to rails by name, among all rails of a scene or among those of one structure.

use crate::check::Check;
use crate::scene::values::scene::SceneRail;
use crate::spec::RailOutline;
use crate::text::fault::Faults;
use crate::text::names::{names, resolve};
use crate::text::place::Place;

/// Index of the rail with the name `structure.rail`.
pub(super) fn rail_named(
    name: &str,
    rails: &[SceneRail],
    place: &Place<'_>,
    faults: &mut Faults,
) -> Option<usize> {
    let known = names(rails, |rail| &rail.name);
    if known.is_empty() {
        // the faults of the structures have already been reported
        return None;
    }
    resolve(name, &known, "rail, \"structure.rail\"", place, faults)
}

/// Index of the rail named at `at` among the rails of its structure; the only rail if none is named.
pub(super) fn rail_among(
    given: Option<&String>,
    rails: &[RailOutline],
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<usize> {
    let words: Vec<(&str, usize)> = rails
        .iter()
        .enumerate()
        .map(|(index, rail)| (rail.name.as_str(), index))
        .collect();
    match (given, rails.len()) {
        (Some(rail), _) => check.faults.one_of(rail, &at.key("rail"), &words),
        (None, 1) => Some(0),
        (None, _) => check.faults.require(&given, at, "rail").map(|_| 0),
    }
}
