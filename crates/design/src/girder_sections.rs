//! The sections under each rail as stresses need them, and what they lack.

use fea::{Model, Rail};
use formats::design::Design;

use crate::fibres::Fibres;
use crate::placed::RailLines;

/// Fibres of the members under the rails.
pub(crate) struct GirderSections {
    /// By rail: the members with their fibres, or what they lack.
    rails: Vec<Vec<(usize, Result<Fibres, String>)>>,
}

impl GirderSections {
    /// The sections of all rails of a design.
    pub fn new(design: &Design, model: &Model, rails: &[Rail], lines: &RailLines) -> GirderSections {
        let spec = &design.spec;
        let composite =
            |rail: usize| spec.crane_rails.get(rail).copied().flatten().is_some_and(|own| own.is_composite);
        let holds = |rail: &Rail, member: usize| rail.segments.iter().any(|segment| segment.member == member);
        let fibres = |rail: usize, member: usize| {
            let combined =
                rails.iter().enumerate().any(|(other, own)| composite(other) && holds(own, member));
            let lateral = design.practice.lateral_section;
            Fibres::new(spec, model, member, lines.axes(rail), lateral, combined)
        };
        let of_rail = |(index, rail): (usize, &Rail)| {
            let mut members: Vec<usize> = rail.segments.iter().map(|segment| segment.member).collect();
            members.sort_unstable();
            members.dedup();
            members.into_iter().map(|member| (member, fibres(index, member))).collect()
        };
        GirderSections { rails: rails.iter().enumerate().map(of_rail).collect() }
    }

    /// The fibres of a member under a rail.
    pub fn of(&self, rail: usize, member: usize) -> Option<&Fibres> {
        let found = self.rails[rail].iter().find(|(known, _)| *known == member)?;
        found.1.as_ref().ok()
    }

    /// The fibres of all members of a rail, each section once.
    pub fn distinct(&self, rail: usize) -> Vec<&Fibres> {
        let mut out: Vec<&Fibres> = Vec::new();
        for fibres in self.rails[rail].iter().filter_map(|(_, found)| found.as_ref().ok()) {
            if !out.contains(&fibres) {
                out.push(fibres);
            }
        }
        out
    }

    /// Whether any member of any rail has fibres with a strength.
    pub fn have_strength(&self) -> bool {
        (0..self.rails.len()).any(|rail| {
            self.distinct(rail).iter().any(|own| own.yield_strength.is_some() && !own.is_composite)
        })
    }

    /// What keeps sections of a rail from having stresses, each reason once; `needs_strength` for utilisations.
    pub fn lacks(&self, rail: usize, needs_strength: bool) -> Vec<String> {
        let mut out: Vec<String> = Vec::new();
        for (_, found) in &self.rails[rail] {
            let why = match found {
                Err(why) => why.clone(),
                Ok(own) if needs_strength && own.is_composite => {
                    format!("the crane rail is a part of section {} (`composite`)", own.name)
                }
                Ok(own) if needs_strength && own.yield_strength.is_none() => {
                    format!("the material of section {} has no yield strength `fy`", own.name)
                }
                Ok(_) => continue,
            };
            if !out.contains(&why) {
                out.push(why);
            }
        }
        out
    }
}

/// Lines of what is left out, where several rails lack the same: `what on rails a, b: why`.
pub(crate) fn by_reason(what: &str, lacks: &[(String, String)]) -> Vec<String> {
    let mut reasons: Vec<(&str, Vec<&str>)> = Vec::new();
    for (rail, why) in lacks {
        match reasons.iter_mut().find(|(known, _)| known == why) {
            Some((_, rails)) if rails.contains(&rail.as_str()) => {}
            Some((_, rails)) => rails.push(rail),
            None => reasons.push((why, vec![rail])),
        }
    }
    let word = |count: usize| if count == 1 { "rail" } else { "rails" };
    reasons
        .iter()
        .map(|(why, rails)| format!("{what} on {} {}: {why}", word(rails.len()), rails.join(", ")))
        .collect()
}
