//! Spans of rails: where the members under a rail are supported.

use fea::{Model, Rail};
use nalgebra::Vector3;

use super::structure::{Form, RailOutline, Spec};

impl Spec {
    /// Rail coordinates of the ends of the spans of rail `index`, increasing; empty where fewer than two are known. `model`
    /// and `rails` are those of [`Spec::model`].
    ///
    /// The spans of a girder end at its supports. The spans of a frame end at those points of the members under the rail
    /// that are connected to a support, a spring, a link, or a member that is not under a rail, such as a column.
    #[must_use]
    pub fn spans(&self, model: &Model, rails: &[Rail], index: usize) -> Vec<f64> {
        let Some(rail) = rails.get(index) else {
            return Vec::new();
        };
        let mut ends = match &self.form {
            Form::Girder(_) => model
                .supports
                .iter()
                .map(|support| model.points[support.point][0])
                .collect(),
            Form::Frame(_) => supported_points(model, rails, rail),
        };
        ends.sort_by(f64::total_cmp);
        let slack = 1e-9 * ends.iter().fold(0.0_f64, |far, x| far.max(x.abs()));
        ends.dedup_by(|b, a| *b - *a <= slack);
        if ends.len() < 2 { Vec::new() } else { ends }
    }

    /// Coordinates of the ends of the spans of all rails, on the parts of the rails that carry loads; the ends of that part
    /// where fewer than two are known.
    #[must_use]
    pub fn rail_spans(&self, model: &Model, rails: &[Rail]) -> Vec<Vec<f64>> {
        let of_rail = |(index, outline): (usize, RailOutline)| {
            let [low, high] = outline.range;
            let mut ends = self.spans(model, rails, index);
            // The first and the last support may lie beyond the part of the rail that carries loads.
            ends.iter_mut().for_each(|x| *x = x.clamp(low, high));
            ends.dedup_by(|b, a| *b - *a <= 1e-9 * (high - low));
            if ends.len() < 2 {
                vec![low, high]
            } else {
                ends
            }
        };
        self.rails().into_iter().enumerate().map(of_rail).collect()
    }
}

/// Rail coordinates of those points of the members under `rail` that are connected to a support, spring, link or
/// other member.
fn supported_points(model: &Model, rails: &[Rail], rail: &Rail) -> Vec<f64> {
    let mut carries = vec![false; model.members.len()];
    for segment in rails.iter().flat_map(|rail| &rail.segments) {
        carries[segment.member] = true;
    }
    let mut is_supported = vec![false; model.points.len()];
    model
        .supports
        .iter()
        .for_each(|support| is_supported[support.point] = true);
    model
        .springs
        .iter()
        .for_each(|spring| is_supported[spring.point] = true);
    model
        .links
        .iter()
        .flat_map(|link| [link.from, link.to])
        .for_each(|point| is_supported[point] = true);
    let others = model
        .members
        .iter()
        .zip(&carries)
        .filter(|(_, carries)| !**carries);
    others
        .flat_map(|(member, _)| member.points)
        .for_each(|point| is_supported[point] = true);
    let axis = Vector3::from(rail.axis).normalize();
    let place =
        |point: usize| (Vector3::from(model.points[point]) - Vector3::from(rail.origin)).dot(&axis);
    let points = rail
        .segments
        .iter()
        .flat_map(|segment| model.members[segment.member].points);
    points
        .filter(|point| is_supported[*point])
        .map(place)
        .collect()
}
