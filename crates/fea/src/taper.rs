//! Tapered members: uniform parts in their place.

use std::ops::Range;

use crate::model::{Kind, Member, Model};
use crate::section::Section;

/// How a member differs from a uniform one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Taper {
    /// Index of the section at end 1; the member's own is that at end 0.
    pub section: usize,
    /// Number of uniform parts of equal length, at least 1.
    pub parts: usize,
}

impl Section {
    /// The uniform section of the stretch `from`..`to` (0..=1) of a member whose properties vary linearly
    /// from `self` to `other`.
    ///
    /// Stiffnesses take the reciprocal of the mean reciprocal over the stretch, the logarithmic mean
    /// (q - p)/ln(q/p) of their values p, q at its ends: its elongation and twist under end loads are exact, and
    /// deflections converge with the square of the number of parts. The mass takes the mean. A shear area
    /// that one end lacks is absent.
    #[must_use]
    pub fn between(&self, other: &Section, from: f64, to: f64) -> Section {
        let at = |a: f64, b: f64, s: f64| a + (b - a) * s;
        let mean = |a: f64, b: f64| logarithmic_mean(at(a, b, from), at(a, b, to));
        let both = |a: Option<f64>, b: Option<f64>| a.zip(b).map(|(a, b)| mean(a, b));
        Section {
            e: mean(self.e, other.e),
            g: mean(self.g, other.g),
            area: mean(self.area, other.area),
            iy: mean(self.iy, other.iy),
            iz: mean(self.iz, other.iz),
            j: mean(self.j, other.j),
            shear_y: both(self.shear_y, other.shear_y),
            shear_z: both(self.shear_z, other.shear_z),
            mass: at(self.mass, other.mass, 0.5 * (from + to)),
        }
    }
}

/// (b - a)/ln(b/a): the reciprocal of the mean of 1/p where p runs linearly from a to b, both not negative.
fn logarithmic_mean(a: f64, b: f64) -> f64 {
    let (low, high) = (a.min(b), a.max(b));
    let step = (high - low) / low;
    match step {
        0.0 => a,
        step if step.is_finite() => (high - low) / step.ln_1p(),
        _ => 0.0,
    }
}

impl Model {
    /// The model with tapered members in uniform parts, and the members that stand for each of the old.
    ///
    /// `tapers`: one a member, `None` where it stays as it is. New points follow the old ones, new sections
    /// the old. Arms and releases stay at the outer ends. A truss stays one member, of the section that is
    /// as long under load as the tapered one. Indices that do not exist leave a member as it is, for
    /// [`Model::check`] to find.
    #[must_use]
    pub fn tapered(&self, tapers: &[Option<Taper>]) -> (Model, Vec<Range<usize>>) {
        let mut out = Model { members: Vec::with_capacity(self.members.len()), ..self.clone() };
        let mut ranges = Vec::with_capacity(self.members.len());
        for (index, member) in self.members.iter().enumerate() {
            let first = out.members.len();
            match tapers.get(index).copied().flatten() {
                Some(taper) => self.divide(member, taper, &mut out),
                None => out.members.push(*member),
            }
            ranges.push(first..out.members.len());
        }
        (out, ranges)
    }

    fn divide(&self, member: &Member, taper: Taper, out: &mut Model) {
        let sections = self.sections.get(member.section).zip(self.sections.get(taper.section));
        let points = member.points.map(|point| self.points.get(point));
        let (Some((a, b)), [Some(p), Some(q)]) = (sections, points) else {
            out.members.push(*member);
            return;
        };
        let ends: [[f64; 3]; 2] =
            [(p, 0), (q, 1)].map(|(point, end)| [0, 1, 2].map(|k| point[k] + member.offsets[end][k]));
        let parts = if member.kind == Kind::Truss { 1 } else { taper.parts.max(1) };
        let mut rest = *member;
        for part in 0..parts {
            let [from, to] = [part, part + 1].map(|k| k as f64 / parts as f64);
            rest.section = member.section;
            if taper.section != member.section {
                rest.section = out.sections.len();
                out.sections.push(a.between(b, from, to));
            }
            if part + 1 == parts {
                break;
            }
            let cut = out.points.len();
            out.points.push([0, 1, 2].map(|k| ends[0][k] + (ends[1][k] - ends[0][k]) * to));
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
}
