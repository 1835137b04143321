//! Between which places a rail spans.

use fea::{Model, Rail};
use nalgebra::Vector3;

use formats::spec::{Form, Spec};

/// Ends of the spans of a rail, increasing; empty where fewer than two are known.
///
/// Of a girder, its supports. Of a frame, the ends of members under the rail where something other than members under
/// a rail meets them: a support, a spring, a link, a column.
#[must_use]
pub fn spans(spec: &Spec, model: &Model, rails: &[Rail], index: usize) -> Vec<f64> {
    let Some(rail) = rails.get(index) else { return Vec::new() };
    let mut ends = match &spec.form {
        Form::Girder(_) => model.supports.iter().map(|support| model.points[support.point][0]).collect(),
        Form::Frame(_) => held(model, rails, rail),
    };
    ends.sort_by(f64::total_cmp);
    let slack = 1e-9 * ends.iter().fold(0.0_f64, |far, x| far.max(x.abs()));
    ends.dedup_by(|b, a| *b - *a <= slack);
    if ends.len() < 2 { Vec::new() } else { ends }
}

fn held(model: &Model, rails: &[Rail], rail: &Rail) -> Vec<f64> {
    let mut carries = vec![false; model.members.len()];
    for segment in rails.iter().flat_map(|rail| &rail.segments) {
        carries[segment.member] = true;
    }
    let mut is_held = vec![false; model.points.len()];
    model.supports.iter().for_each(|support| is_held[support.point] = true);
    model.springs.iter().for_each(|spring| is_held[spring.point] = true);
    model.links.iter().flat_map(|link| [link.from, link.to]).for_each(|point| is_held[point] = true);
    let others = model.members.iter().zip(&carries).filter(|(_, carries)| !**carries);
    others.flat_map(|(member, _)| member.points).for_each(|point| is_held[point] = true);
    let axis = Vector3::from(rail.axis).normalize();
    let place = |point: usize| (Vector3::from(model.points[point]) - Vector3::from(rail.origin)).dot(&axis);
    let points = rail.segments.iter().flat_map(|segment| model.members[segment.member].points);
    points.filter(|point| is_held[*point]).map(place).collect()
}
