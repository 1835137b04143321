//! The sections under each rail as stresses need them, and what they lack.

use fea::{Model, Rail};
use formats::LateralSection;
use formats::spec::Spec;
use formats::units::Length;
use formats::vector::dot;
use formats::verdict::{OmittedCheck, rail_phrase};

use crate::fibres::{CompositeRail, Fibres};
use crate::placed::rail_axes;

/// Fibres of the members under the rails.
#[derive(Clone, Debug)]
pub struct GirderSections {
    /// By rail: the members with their fibres, or what they lack.
    rails: Vec<Vec<(usize, Result<Fibres, String>)>>,
}

impl GirderSections {
    /// The sections of all rails of a spec with its model; `lateral` is what resists lateral moments.
    #[must_use]
    pub fn new(
        spec: &Spec,
        lateral: LateralSection,
        model: &Model,
        rails: &[Rail],
    ) -> GirderSections {
        let fibres = |rail: usize, member: usize| {
            let part = (0..rails.len())
                .find_map(|own| composite_rail(spec, model, &rails[own], own, member));
            Fibres::new(
                spec,
                model,
                member,
                rail_axes(&rails[rail], model.up),
                lateral,
                part,
            )
        };
        let of_rail = |(index, rail): (usize, &Rail)| {
            let mut members: Vec<usize> =
                rail.segments.iter().map(|segment| segment.member).collect();
            members.sort_unstable();
            members.dedup();
            members
                .into_iter()
                .map(|member| (member, fibres(index, member)))
                .collect()
        };
        GirderSections {
            rails: rails.iter().enumerate().map(of_rail).collect(),
        }
    }

    /// The fibres of a member under a rail; `None` where they are not known.
    #[must_use]
    pub fn of(&self, rail: usize, member: usize) -> Option<&Fibres> {
        let found = self.rails[rail]
            .iter()
            .find(|(known, _)| *known == member)?;
        found.1.as_ref().ok()
    }

    /// The fibres of all members of a rail, each section once.
    pub(crate) fn distinct(&self, rail: usize) -> Vec<&Fibres> {
        let mut out: Vec<&Fibres> = Vec::new();
        for fibres in self.rails[rail]
            .iter()
            .filter_map(|(_, found)| found.as_ref().ok())
        {
            if !out.contains(&fibres) {
                out.push(fibres);
            }
        }
        out
    }

    /// Whether any member of any rail has fibres with a strength.
    pub(crate) fn have_strength(&self) -> bool {
        (0..self.rails.len()).any(|rail| {
            self.distinct(rail)
                .iter()
                .any(|own| own.yield_strength.is_some())
        })
    }

    /// What keeps sections of a rail from having direct stresses, each reason once.
    #[must_use]
    pub fn lacks_stress(&self, rail: usize) -> Vec<String> {
        self.reasons(rail, |_| None)
    }

    /// What keeps sections of a rail from having stresses, each reason once; `needs_strength` for utilisations.
    pub(crate) fn lacks(&self, rail: usize, needs_strength: bool) -> Vec<String> {
        let weak = |own: &Fibres| {
            let is_weak = own.yield_strength.is_none();
            is_weak.then(|| {
                format!(
                    "the material of section {} has no yield strength `fy`",
                    own.name
                )
            })
        };
        self.reasons(rail, |own| if needs_strength { weak(own) } else { None })
    }

    /// Why sections of a rail have no fibres, and what else `missing` finds, each reason once in the order of members.
    fn reasons(&self, rail: usize, missing: impl Fn(&Fibres) -> Option<String>) -> Vec<String> {
        let mut out: Vec<String> = Vec::new();
        for (_, found) in &self.rails[rail] {
            let why = match found {
                Err(why) => Some(why.clone()),
                Ok(own) => missing(own),
            };
            out.extend(why.filter(|why| !out.contains(why)));
        }
        out
    }
}

/// The crane rail of rail `index` where it is a part of the section of a member. Its segments lie at the height of the rail's top.
fn composite_rail(
    spec: &Spec,
    model: &Model,
    rail: &Rail,
    index: usize,
    member: usize,
) -> Option<CompositeRail> {
    let carried = spec
        .crane_rails
        .get(index)
        .copied()
        .flatten()
        .filter(|own| own.is_composite)?;
    let segment = rail
        .segments
        .iter()
        .find(|segment| segment.member == member)?;
    let (plane, centroid) = carried.profile.plane_section().ok()?;
    let one = Length::Millimetre.in_units_of(spec.units.length);
    let top = dot(segment.offset, rail_axes(rail, model.up)[1]);
    Some(CompositeRail {
        area: plane.area * one.powi(2),
        second: [plane.i_vertical, plane.i_lateral].map(|second| second * one.powi(4)),
        height: top + (centroid - carried.profile.height) * one,
    })
}

/// Lines of what is left out, where several rails lack the same: `what on rails a, b: why`.
#[must_use]
pub fn by_reason(what: &str, lacks: &[(String, String)]) -> Vec<OmittedCheck> {
    let mut reasons: Vec<(&str, Vec<&str>)> = Vec::new();
    for (rail, why) in lacks {
        match reasons.iter_mut().find(|(known, _)| known == why) {
            Some((_, rails)) if rails.contains(&rail.as_str()) => {}
            Some((_, rails)) => rails.push(rail),
            None => reasons.push((why, vec![rail])),
        }
    }
    reasons
        .iter()
        .map(|(why, rails)| {
            let place = match rails.as_slice() {
                [rail] => rail_phrase(rail),
                rails => format!("rails {}", rails.join(", ")),
            };
            OmittedCheck::new(format!("{what} on {place}"), *why)
        })
        .collect()
}
