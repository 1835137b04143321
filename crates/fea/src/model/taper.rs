//! Tapered members, replaced by uniform parts.

use std::ops::Range;

use crate::model::cut::{cut_member, equal_cuts, flexible_ends};
use crate::model::section::CrossSection;
use crate::model::structure::{Member, MemberKind, Model};

/// How a tapered member differs from a uniform one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Taper {
    /// Index of the section at end 1; the member's own section is that at end 0.
    pub section: usize,
    /// Number of uniform parts of equal length, at least 1.
    pub parts: usize,
}

impl CrossSection {
    /// The uniform section that replaces the stretch `from`..`to` (fractions of the length, 0 to 1) of a
    /// member whose properties vary linearly from `self` to `other`.
    ///
    /// Each stiffness is the reciprocal of the mean reciprocal over the stretch, which is the logarithmic
    /// mean (q - p)/ln(q/p) of the values p and q at its ends. Elongation and twist under end loads are
    /// therefore exact, and deflections converge with the square of the number of parts. The mass is the
    /// arithmetic mean. A shear area that is absent at one end is absent.
    #[must_use]
    pub fn between(&self, other: &CrossSection, from: f64, to: f64) -> CrossSection {
        let at = |a: f64, b: f64, s: f64| a + (b - a) * s;
        let mean = |a: f64, b: f64| logarithmic_mean(at(a, b, from), at(a, b, to));
        let both = |a: Option<f64>, b: Option<f64>| a.zip(b).map(|(a, b)| mean(a, b));
        CrossSection {
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

/// (b - a)/ln(b/a): the reciprocal of the mean of 1/p where p varies linearly from a to b; neither is
/// negative. 0 if one of them is 0.
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
    /// The model with its tapered members replaced by uniform parts, and for each given member the range of
    /// members that replaces it.
    ///
    /// `tapers` has one entry for each member, `None` where the member is uniform. New points and sections
    /// are appended. Offsets and releases stay at the outer ends. A truss or a rod stays one member, with the
    /// section that gives the elongation and the twist of the tapered one. A member with an index that does not exist is
    /// copied unchanged; [`Model::check`] reports it.
    #[must_use]
    pub fn tapered(&self, tapers: &[Option<Taper>]) -> (Model, Vec<Range<usize>>) {
        self.tapered_by(tapers, |_, _| None)
    }

    /// [`Model::tapered`] for members of which some have properties that do not vary linearly.
    ///
    /// `section(member, [from, to])` is the uniform section that replaces the stretch `from`..`to` (fractions
    /// of the length, 0 to 1) of a tapered member; `None` where its properties vary linearly, see
    /// [`CrossSection::between`].
    #[must_use]
    pub fn tapered_by(
        &self,
        tapers: &[Option<Taper>],
        section: impl Fn(usize, [f64; 2]) -> Option<CrossSection>,
    ) -> (Model, Vec<Range<usize>>) {
        let mut out = Model {
            members: Vec::with_capacity(self.members.len()),
            ..self.clone()
        };
        let mut ranges = Vec::with_capacity(self.members.len());
        for (index, member) in self.members.iter().enumerate() {
            let first = out.members.len();
            match tapers.get(index).copied().flatten() {
                Some(taper) => {
                    self.cut_tapered(member, taper, |range| section(index, range), &mut out)
                }
                None => out.members.push(*member),
            }
            ranges.push(first..out.members.len());
        }
        (out, ranges)
    }

    fn cut_tapered(
        &self,
        member: &Member,
        taper: Taper,
        section: impl Fn([f64; 2]) -> Option<CrossSection>,
        out: &mut Model,
    ) {
        let sections = self
            .sections
            .get(member.section)
            .zip(self.sections.get(taper.section));
        let points = member.points.map(|point| self.points.get(point));
        let (Some((a, b)), [Some(p), Some(q)]) = (sections, points) else {
            out.members.push(*member);
            return;
        };
        let ends = flexible_ends([*p, *q], member.offsets);
        let parts = if member.kind == MemberKind::Beam {
            taper.parts.max(1)
        } else {
            1
        };
        cut_member(member, ends, &equal_cuts(parts), out, |part, out| {
            if taper.section == member.section {
                return member.section;
            }
            let [from, to] = [part, part + 1].map(|k| k as f64 / parts as f64);
            out.sections
                .push(section([from, to]).unwrap_or_else(|| a.between(b, from, to)));
            out.sections.len() - 1
        });
    }
}
