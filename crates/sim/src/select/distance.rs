//! Relative difference between two runs.

use crate::{BodyDof, Channel, Run, Scene, Status};

/// Relative difference of `a` from `b`, two runs of `scene`: the larger of max |y_a - y_b| / max |y_b| over the
/// height of each body and max |F_a - F_b| / max |F_b| over the vertical wheel forces, at the output times. It is
/// infinite where one run did not reach its end.
#[must_use]
pub fn distance(a: &Run, b: &Run, scene: &Scene) -> f64 {
    let by_rule = matches!((&a.status, &b.status), (Status::Ended(_), Status::Ended(_)));
    let reached = a.status.is_complete() && b.status.is_complete();
    if !reached || (a.history.len() != b.history.len() && !by_rule) {
        return f64::INFINITY;
    }
    let part = |channels: &[Channel]| {
        let (mut apart, mut peak) = (0.0_f64, 0.0_f64);
        for channel in channels {
            for (a, b) in a.history.column(*channel).iter().zip(b.history.column(*channel)) {
                apart = apart.max((a - b).abs());
                peak = peak.max(b.abs());
            }
        }
        if apart == 0.0 { 0.0 } else { apart / peak }
    };
    let forces: Vec<Channel> =
        b.history.channels().iter().copied().filter(|c| matches!(c, Channel::Vertical(_))).collect();
    (0..scene.bodies.len())
        .map(|body| part(&[Channel::Displacement(body, BodyDof::Y)]))
        .fold(part(&forces), f64::max)
}
