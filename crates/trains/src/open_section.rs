//! Rails whose lateral deflections are upper bounds, because torsion of open sections has no warping here.

use fea::{Model, Rail};

/// Why such a lateral deflection is an upper bound.
///
/// # Source
/// Lateral influence coefficients of crane girders of usual spans with St. Venant torsion alone, over those with Vlasov torsion.
pub const WITHOUT_WARPING: &str = "torsion without warping: up to 2.6 times too large";

/// Largest ratio of the torsion constant to the sum of the second moments of area of an open section. It is 0.08 for the
/// thickest rolled sections, and about 0.5 for boxes.
const MAX_OPEN: f64 = 0.1;

/// Whether a rail stands on an arm on a member of open section, so that its lateral deflections have a part from torsion
/// that is too large.
#[must_use]
pub fn twists_without_warping(model: &Model, rail: &Rail) -> bool {
    rail.segments.iter().any(|segment| {
        let section = model
            .members
            .get(segment.member)
            .and_then(|member| model.sections.get(member.section));
        let is_open =
            section.is_some_and(|own| own.j > 0.0 && own.j < MAX_OPEN * (own.iy + own.iz));
        is_open && segment.offset.iter().any(|part| *part != 0.0)
    })
}
