//! Utilisation of the yield strength by direct stress and by shear stress in webs.
//!
//! The direct stress sigma = N/A + M_v z/I_v + M_l y/I_l of a fibre has no envelope of its own here: it is evaluated with the
//! coincident forces of the states that govern normal force and moments over spans and at the places of envelopes, with all
//! signs of their horizontal forces and eccentricities. The largest
//! is therefore a lower bound of the largest of all states; the sum of the extremes of the three forces over a span, whether
//! or not they occur at once, is an upper bound; there is none over spans with tapered members, whose sections are those of the
//! place.

use formats::design::Design;
use formats::verdict::OmittedCheck;
use trains::{EnvelopeValue, Error, GirderResponse, Governing, SpanExtreme, TrainCase};

use crate::fibres::Fibres;
use crate::girder_sections::{GirderSections, by_reason};
use crate::outcome::{SolvedCase, StressCheck};
use crate::placed::RailLines;
use crate::state_forces::{CarriedForces, StateForces, index};

/// Forces that cause direct stress.
const DIRECT: [GirderResponse; 3] = [
    GirderResponse::Normal,
    GirderResponse::VerticalMoment,
    GirderResponse::LateralMoment,
];

/// Relative difference of utilisations that counts as rounding.
const EQUAL: f64 = 1e-9;

/// What the stresses of a design follow from.
pub(crate) struct StressBasis<'a> {
    pub design: &'a Design,
    pub lines: &'a RailLines,
    pub sections: &'a GirderSections,
    /// The cases with their factors.
    pub trains: &'a [TrainCase],
    pub cases: &'a [SolvedCase],
}

impl StressBasis<'_> {
    /// The largest direct stress and the largest shear stress of each rail in each case, by utilisation.
    pub fn check(&self, forces: &mut StateForces) -> Result<Vec<StressCheck>, Error> {
        let mut out = Vec::new();
        for case in 0..self.cases.len() {
            for rail in 0..self.lines.count() {
                out.extend(self.direct(case, rail, forces)?);
                out.extend(self.shear(case, rail, forces));
            }
        }
        Ok(out)
    }

    /// What is left out for want of data.
    pub fn left_out(&self) -> Vec<OmittedCheck> {
        let rails = self.design.spec.rails();
        let (mut lacks, mut no_web, mut in_rail) = (Vec::new(), Vec::new(), Vec::new());
        for (rail, outline) in rails.iter().enumerate() {
            let name = || outline.name.clone();
            lacks.extend(
                self.sections
                    .lacks(rail, true)
                    .into_iter()
                    .map(|why| (name(), why)),
            );
            let all = self.sections.distinct(rail);
            let open = all
                .iter()
                .filter(|own| own.yield_strength.is_some() && own.plates().is_none());
            no_web.extend(open.map(|own| {
                (
                    name(),
                    format!("section {} is not an upright I section", own.name),
                )
            }));
            let has_rail = |own: &&Fibres| own.yield_strength.is_some() && own.is_composite;
            if all.into_iter().any(|own| has_rail(&own)) {
                in_rail.push((name(), "the spec does not specify its strength".to_owned()));
            }
        }
        let mut out = by_reason("stress utilisation", &lacks);
        out.extend(by_reason("shear stress in the web", &no_web));
        out.extend(by_reason(
            "direct stress of a crane rail that is a part of the section,",
            &in_rail,
        ));
        out
    }

    /// States that govern some quantities of a rail: over spans, and at the places of envelopes.
    pub fn states<'s>(
        &'s self,
        case: usize,
        rail: usize,
        wanted: &'s [GirderResponse],
    ) -> impl Iterator<Item = (GirderResponse, &'s Governing)> + 's {
        let found = &self.cases[case].envelopes;
        let spans = found
            .extremes
            .iter()
            .map(|e: &SpanExtreme| (e.rail, e.quantity, &e.governing));
        let places = found
            .envelopes
            .iter()
            .map(|e: &EnvelopeValue| (e.rail, e.quantity, &e.governing));
        let own = spans
            .chain(places)
            .filter(move |(own, quantity, _)| *own == rail && wanted.contains(quantity));
        own.map(|(_, quantity, governing)| (quantity, governing))
    }

    fn direct(
        &self,
        case: usize,
        rail: usize,
        forces: &mut StateForces,
    ) -> Result<Option<StressCheck>, Error> {
        let mut best: Option<StressCheck> = None;
        for (_, governing) in self.states(case, rail, &DIRECT) {
            let alike = forces.alike(self.lines, &self.trains[case], rail, governing)?;
            for (
                state,
                CarriedForces {
                    carrier,
                    forces: all,
                    ..
                },
            ) in alike
            {
                let member = forces.carrying()[carrier].member;
                let Some((fibres, strength)) = self.strong(rail, member) else {
                    continue;
                };
                let three = DIRECT.map(|quantity| all[index(quantity)]);
                let place = place_on(forces.carrying()[carrier].x, governing.x);
                let Some(worst) = fibres
                    .worst_at(place, three)
                    .filter(|worst| worst.value().is_finite())
                else {
                    continue;
                };
                if !is_more(&best, worst.value().abs() / strength) {
                    continue;
                }
                let [normal, vertical, lateral] = three;
                best = Some(StressCheck {
                    value: worst.value(),
                    fibre: Some(worst.fibre),
                    parts: ["normal", "vertical", "lateral"]
                        .into_iter()
                        .zip(worst.parts)
                        .collect(),
                    forces: vec![
                        ("normal", normal),
                        ("moment", vertical),
                        ("lateral moment", lateral),
                    ],
                    lateral_section: Some(self.design.practice.lateral_section),
                    ..self.row("direct stress", (case, rail), fibres, strength, &state)
                });
            }
        }
        if let Some(best) = &mut best {
            best.bound = self.bound(case, rail, forces);
        }
        Ok(best)
    }

    /// A utilisation by direct stress that no state exceeds.
    fn bound(&self, case: usize, rail: usize, forces: &StateForces) -> Option<f64> {
        let all = &self.cases[case].envelopes.extremes;
        let of = |span: usize, quantity: GirderResponse, is_max: bool| {
            let own = |e: &&SpanExtreme| {
                (e.rail, e.span, e.quantity, e.is_max) == (rail, span, quantity, is_max)
            };
            all.iter().find(own).map(|e| e.bound)
        };
        let last = all
            .iter()
            .filter(|e| e.rail == rail)
            .map(|e| e.span)
            .max()?;
        let mut most: Option<f64> = None;
        for span in 0..=last {
            let [Some(normal), Some(vertical), Some(lateral)] = DIRECT
                .map(|quantity| Some([of(span, quantity, true)?, of(span, quantity, false)?]))
            else {
                continue;
            };
            let window = self.window(rail, span);
            let here = forces
                .carrying()
                .iter()
                .filter(|c| c.rail == rail && c.x[0] < window[1] && c.x[1] > window[0]);
            let strong: Vec<(&Fibres, f64)> =
                here.filter_map(|c| self.strong(rail, c.member)).collect();
            if strong.iter().any(|(fibres, _)| fibres.is_tapered()) {
                return None;
            }
            for corner in 0..8 {
                let three = [
                    normal[corner & 1],
                    vertical[corner >> 1 & 1],
                    lateral[corner >> 2],
                ];
                for (fibres, strength) in &strong {
                    let stress = fibres
                        .worst(three)
                        .map(|worst| worst.value().abs() / strength);
                    most = most
                        .into_iter()
                        .chain(stress.filter(|ratio| ratio.is_finite()))
                        .reduce(f64::max);
                }
            }
        }
        most
    }

    /// The largest shear stress V/(h t_w) of upright I sections against f_y/sqrt(3).
    fn shear(&self, case: usize, rail: usize, forces: &StateForces) -> Option<StressCheck> {
        let mut best: Option<StressCheck> = None;
        for (_, governing) in self.states(case, rail, &[GirderResponse::VerticalShear]) {
            let Some(carrier) = forces.carrier_at(rail, governing.x, governing.side) else {
                continue;
            };
            let Some((fibres, fy)) = self.strong(rail, forces.carrying()[carrier].member) else {
                continue;
            };
            let place = place_on(forces.carrying()[carrier].x, governing.x);
            let Some(area) = fibres.web_area_at(place) else {
                continue;
            };
            let (stress, strength) = (governing.value / area, fy / 3f64.sqrt());
            if !is_more(&best, stress.abs() / strength) {
                continue;
            }
            best = Some(StressCheck {
                value: stress,
                forces: vec![("shear", governing.value)],
                ..self.row(
                    "shear stress in the web",
                    (case, rail),
                    fibres,
                    strength,
                    governing,
                )
            });
        }
        best
    }

    fn strong(&self, rail: usize, member: usize) -> Option<(&Fibres, f64)> {
        let fibres = self.sections.of(rail, member)?;
        Some((fibres, fibres.yield_strength?))
    }

    /// A row without its stress.
    fn row(
        &self,
        quantity: &'static str,
        (case, rail): (usize, usize),
        fibres: &Fibres,
        strength: f64,
        governing: &Governing,
    ) -> StressCheck {
        StressCheck {
            quantity,
            case: case + 1,
            rail: self.design.spec.rails()[rail].name.clone(),
            span: span_of(&self.design.spans[rail], governing.x),
            section: fibres.name.clone(),
            value: 0.0,
            strength,
            bound: None,
            fibre: None,
            parts: Vec::new(),
            forces: Vec::new(),
            lateral_section: None,
            governing: governing.clone(),
        }
    }

    /// Coordinates between which a span lies; overhangs have no outer end.
    fn window(&self, rail: usize, span: usize) -> [f64; 2] {
        let ends = &self.design.spans[rail];
        let end =
            |k: Option<usize>, beyond: f64| k.and_then(|k| ends.get(k)).copied().unwrap_or(beyond);
        [
            end(span.checked_sub(1), f64::NEG_INFINITY),
            end(Some(span), f64::INFINITY),
        ]
    }
}

/// Whether a utilisation exceeds the best by more than rounding: of equal ones the first counts.
fn is_more(best: &Option<StressCheck>, utilisation: f64) -> bool {
    let exceeds = |best: &StressCheck| utilisation > best.utilisation() * (1.0 + EQUAL);
    best.as_ref().is_none_or(exceeds)
}

/// A place between the ends of a member as a fraction of its length.
fn place_on([from, to]: [f64; 2], x: f64) -> f64 {
    ((x - from) / (to - from)).clamp(0.0, 1.0)
}

/// Number of the span in which a coordinate lies: 0 before the first, from 1 on, and one more behind the last. An end belongs to
/// the span before it, the first end to the first span.
pub(crate) fn span_of(ends: &[f64], x: f64) -> usize {
    let (first, last) = (
        ends.first().copied().unwrap_or(x),
        ends.last().copied().unwrap_or(x),
    );
    let slack = 1e-9 * (last - first);
    if x < first - slack {
        return 0;
    }
    ends.iter().filter(|end| **end < x - slack).count().max(1)
}
