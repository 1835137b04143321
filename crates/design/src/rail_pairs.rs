//! Change of gauge and difference in height of two rails under a train that stands on both.
//!
//! The responses have no envelopes of their own: they are evaluated in the states that govern the deflections of either rail,
//! at the place of that deflection and opposite to it, under the trains alone.

use formats::design::Design;
use formats::vector::dot;
use practice::limits::LimitedDisplacement;
use splines::{Axis, Compliance, ExactSurface, Probe};
use trains::{CaseEnvelopes, Error, GirderResponse, Governing, RailLoad, Structure, TrainCase};

use crate::limits::{ROUNDING, metre};
use crate::outcome::{LimitCheck, RailPairResponse, SolvedCase};
use crate::placed::RailLines;
use crate::service::{ServiceCase, ServiceLoad};
use crate::stresses::span_of;

/// Largest sine of the angle between rails that count as parallel.
const PARALLEL: f64 = 1e-9;

/// Of values that differ by no more than this fraction the first counts.
const TIE: f64 = 1e-12;

/// The displacements of pairs of rails, with the direction of each.
const DISPLACEMENTS: [(LimitedDisplacement, Axis); 2] = [
    (LimitedDisplacement::GaugeChange, Axis::Lateral),
    (LimitedDisplacement::HeightDifference, Axis::Vertical),
];

/// Pairs of parallel rails on both of which one of the trains stands.
fn pairs(design: &Design, trains: &[usize], lines: &RailLines) -> Vec<[usize; 2]> {
    let stands_on = |train: usize, rail: usize| {
        design.trains[train]
            .wheels
            .iter()
            .any(|wheel| wheel.rail == rail)
    };
    let mut out = Vec::new();
    for a in 0..lines.count() {
        for b in a + 1..lines.count() {
            let [x, _, z] = lines.axes(a);
            let aside = dot(x, lines.axes(b)[2]);
            let apart = dot(z, lines.axes(b)[0]);
            let is_parallel = aside.abs() < PARALLEL && apart.abs() < PARALLEL;
            let both = trains
                .iter()
                .any(|&train| stands_on(train, a) && stands_on(train, b));
            if both && is_parallel && lines.distance(a, b) != 0.0 {
                out.push([a, b]);
            }
        }
    }
    out
}

/// Whether any case without factors has a train on two rails.
pub(crate) fn has_any(design: &Design, lines: &RailLines) -> bool {
    design
        .cases
        .iter()
        .any(|case| case.factors.is_empty() && !pairs(design, &case.trains, lines).is_empty())
}

/// The responses of all pairs in the cases without factors.
pub(crate) fn pair_responses(
    design: &Design,
    lines: &RailLines,
    structure: &Structure,
    trains: &[TrainCase],
    cases: &[SolvedCase],
) -> Result<Vec<RailPairResponse>, Error> {
    let moved = Moved::new(design, lines, structure)?;
    let mut out = Vec::new();
    for (number, (case, solved)) in design.cases.iter().zip(cases).enumerate() {
        if case.factors.is_empty() {
            let found =
                moved.responses(number, &case.trains, &trains[number], &solved.envelopes)?;
            out.extend(found.into_iter().map(|(_, response)| response));
        }
    }
    Ok(out)
}

/// The limits on pairs of rails; `cases` are the trains of the service cases under their loads, `found` their responses.
pub(crate) fn pair_limits(
    design: &Design,
    lines: &RailLines,
    structure: &Structure,
    services: &[ServiceCase],
    cases: &[TrainCase],
    found: &[CaseEnvelopes],
) -> Result<Vec<LimitCheck>, Error> {
    let mut out = Vec::new();
    if !has_limit(design, lines) {
        return Ok(out);
    }
    let moved = Moved::new(design, lines, structure)?;
    let metre = metre(design);
    for ((service, case), found) in services.iter().zip(cases).zip(found) {
        let cranes = design.cases[service.case].trains.len();
        let sizes = found.deflections.iter().map(|d| d.governing.value.abs());
        let least = ROUNDING * sizes.fold(0.0, f64::max);
        for (displacement, response) in
            moved.responses(service.case, &service.trains, case, found)?
        {
            let is_side_effect = displacement == LimitedDisplacement::GaugeChange
                && service.load == ServiceLoad::Vertical;
            if is_side_effect && response.value.abs() <= least {
                continue;
            }
            for limit in &design.practice.limits {
                if limit.displacement != displacement
                    || !service.serves(limit.loads, displacement, cranes)
                {
                    continue;
                }
                let Ok(allowed) = limit.allowable(response.distance * metre) else {
                    continue;
                };
                let train = response.governing.trains.first();
                out.push(LimitCheck {
                    clause: limit.clause,
                    quantity: response.quantity,
                    formula: limit.formula(),
                    loads: service.words(limit.loads),
                    value: response.value.abs(),
                    limit: allowed / metre,
                    case: response.case,
                    rail: response.rails.join(", "),
                    span: response.span,
                    ends: None,
                    x: response.x,
                    position: train.map(|train| train.position),
                    is_sampled: true,
                });
            }
        }
    }
    Ok(out)
}

/// Whether a limit of the design bears on a pair of rails on which a train stands.
pub(crate) fn has_limit(design: &Design, lines: &RailLines) -> bool {
    let bears = |limited: LimitedDisplacement| DISPLACEMENTS.iter().any(|(own, _)| *own == limited);
    let mut limits = design.practice.limits.iter();
    let mut cases = design.cases.iter();
    limits.any(|limit| bears(limit.displacement))
        && cases.any(|case| !pairs(design, &case.trains, lines).is_empty())
}

/// Deflections of rails in given states.
struct Moved<'a> {
    design: &'a Design,
    lines: &'a RailLines,
    structure: &'a Structure,
    surface: ExactSurface,
}

impl<'a> Moved<'a> {
    fn new(
        design: &'a Design,
        lines: &'a RailLines,
        structure: &'a Structure,
    ) -> Result<Moved<'a>, Error> {
        Ok(Moved {
            design,
            lines,
            structure,
            surface: structure.frame().surface()?.surface,
        })
    }

    /// The responses of all pairs of rails in the case `number` (from 0), with what each of them is.
    fn responses(
        &self,
        number: usize,
        trains: &[usize],
        case: &TrainCase,
        found: &CaseEnvelopes,
    ) -> Result<Vec<(LimitedDisplacement, RailPairResponse)>, Error> {
        let rails = self.design.spec.rails();
        let mut out = Vec::new();
        for pair in pairs(self.design, trains, self.lines) {
            for (displacement, axis) in DISPLACEMENTS {
                let Some((value, x, governing)) = self.largest(pair, axis, found, case)? else {
                    continue;
                };
                let response = RailPairResponse {
                    case: number + 1,
                    rails: pair.map(|rail| rails[rail].name.clone()),
                    quantity: displacement.phrase(),
                    distance: self.lines.distance(pair[0], pair[1]).abs(),
                    value,
                    x,
                    span: span_of(&self.design.spans[pair[0]], x),
                    governing,
                };
                out.push((displacement, response));
            }
        }
        Ok(out)
    }

    /// The difference of largest size over the governing states of both rails, its coordinate on the first rail, and the state.
    /// `None` where a rail does not resist a force in this direction.
    fn largest(
        &self,
        pair: [usize; 2],
        axis: Axis,
        found: &CaseEnvelopes,
        case: &TrainCase,
    ) -> Result<Option<(f64, f64, Governing)>, Error> {
        if pair
            .iter()
            .any(|&rail| !self.structure.frame().resists(rail, axis))
        {
            return Ok(None);
        }
        let deflections = [
            GirderResponse::VerticalDeflection,
            GirderResponse::LateralDeflection,
        ];
        let spans = found
            .extremes
            .iter()
            .map(|e| (e.rail, e.quantity, &e.governing));
        let places = found
            .envelopes
            .iter()
            .map(|e| (e.rail, e.quantity, &e.governing));
        let chords = found
            .deflections
            .iter()
            .map(|e| (e.rail, e.quantity, &e.governing));
        let mut best: Option<(f64, f64, Governing)> = None;
        for (rail, quantity, governing) in spans.chain(places).chain(chords) {
            if !pair.contains(&rail) || !deflections.contains(&quantity) {
                continue;
            }
            let x = pair.map(|to| {
                self.lines
                    .on(to, self.lines.opposite(rail, to, governing.x))
            });
            let [Some(a), Some(b)] = x else { continue };
            let value = self.difference(
                pair,
                [a, b],
                axis,
                &self.lines.loads(case, &governing.trains),
            )?;
            if best
                .as_ref()
                .is_none_or(|(most, ..)| value.abs() > (1.0 + TIE) * most.abs())
            {
                best = Some((value, a, governing.clone()));
            }
        }
        Ok(best)
    }

    /// How far the rails move apart (lateral), or the second rail below the first (vertical).
    fn difference(
        &self,
        [a, b]: [usize; 2],
        x: [f64; 2],
        axis: Axis,
        loads: &[RailLoad],
    ) -> Result<f64, Error> {
        let at = [
            Probe {
                rail: a,
                x: x[0],
                axis,
            },
            Probe {
                rail: b,
                x: x[1],
                axis,
            },
        ];
        let mut forces = Vec::new();
        for load in loads {
            for (axis, force) in Axis::ALL.into_iter().zip(load.force) {
                if force != 0.0 && self.structure.frame().resists(load.rail, axis) {
                    forces.push((
                        Probe {
                            rail: load.rail,
                            x: load.x,
                            axis,
                        },
                        force,
                    ));
                }
            }
        }
        let mut moved = [0.0; 2];
        self.surface.displacements(&at, &forces, &mut moved)?;
        let apart = moved[1] - moved[0];
        Ok(match axis {
            Axis::Vertical => -apart,
            _ => apart * self.lines.distance(a, b).signum(),
        })
    }
}
