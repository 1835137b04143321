//! Members cut into equal parts, with the rails that run over them.

use crate::model::rail::{Rail, RailSegment};
use crate::model::structure::{Member, Model};

/// Ends of the flexible part of a member: its points plus its rigid offsets, global.
pub(crate) fn flexible_ends(points: [[f64; 3]; 2], offsets: [[f64; 3]; 2]) -> [[f64; 3]; 2] {
    [0, 1].map(|end| [0, 1, 2].map(|k| points[end][k] + offsets[end][k]))
}

/// Fractions of the length at which a member is cut into `parts` equal parts.
pub(crate) fn equal_cuts(parts: usize) -> Vec<f64> {
    (1..parts).map(|part| part as f64 / parts as f64).collect()
}

/// Appends `member` to `out`, cut at the given fractions of its length, which increase, with a new point at each.
///
/// `ends` are the ends of its flexible part, global. Offsets and releases stay at the outer ends.
/// `section_of(part, out)` gives the index of the section of a part; it may append sections to `out`.
pub(super) fn cut_member(
    member: &Member,
    ends: [[f64; 3]; 2],
    cuts: &[f64],
    out: &mut Model,
    mut section_of: impl FnMut(usize, &mut Model) -> usize,
) {
    let mut rest = *member;
    for part in 0..=cuts.len() {
        rest.section = section_of(part, out);
        let Some(&fraction) = cuts.get(part) else {
            break;
        };
        let cut = out.points.len();
        out.points
            .push([0, 1, 2].map(|k| ends[0][k] + (ends[1][k] - ends[0][k]) * fraction));
        let mut own = rest;
        own.points[1] = cut;
        own.offsets[1] = [0.0; 3];
        own.releases[1] = [false; 6];
        out.members.push(own);
        rest.points[0] = cut;
        rest.offsets[0] = [0.0; 3];
        rest.releases[0] = [false; 6];
    }
    out.members.push(rest);
}

/// The model with member k in `parts[k]` equal parts, and its rails over all parts; every count is at least 1. See [`cut_at`].
pub(crate) fn cut_members(m: &Model, rails: &[Rail], parts: &[usize]) -> (Model, Vec<Rail>) {
    let cuts: Vec<Vec<f64>> = parts.iter().map(|&count| equal_cuts(count)).collect();
    cut_at(m, rails, &cuts)
}

/// The model with member k cut at the fractions `cuts[k]` of its length, which increase between 0 and 1, and its rails over all
/// parts.
///
/// The points of the given model come first; members keep their order. The model and the rails must be valid.
pub(crate) fn cut_at(m: &Model, rails: &[Rail], cuts: &[Vec<f64>]) -> (Model, Vec<Rail>) {
    let mut model = Model {
        members: Vec::new(),
        ..m.clone()
    };
    let mut first = Vec::with_capacity(cuts.len());
    for (member, own) in m.members.iter().zip(cuts) {
        first.push(model.members.len());
        let ends = flexible_ends(member.points.map(|point| m.points[point]), member.offsets);
        cut_member(member, ends, own, &mut model, |_, _| member.section);
    }
    let rails = rails.iter().map(|rail| {
        let segments = rail.segments.iter().flat_map(|segment| {
            let from = first[segment.member];
            let offset = segment.offset;
            (from..=from + cuts[segment.member].len())
                .map(move |member| RailSegment { member, offset })
        });
        Rail {
            segments: segments.collect(),
            ..rail.clone()
        }
    });
    let rails = rails.collect();
    (model, rails)
}
