//! Change of gauge and difference in height of two rails under a train that stands on both.
//!
//! The responses have no envelopes of their own: they are evaluated in the states that govern the deflections of either rail,
//! at the place of that deflection and opposite to it, under the trains alone.

use formats::design::{Design, DesignCase};
use formats::units::{Dimension, Scale, Units};
use formats::vector::dot;
use practice::limits::LimitedDisplacement;
use splines::{Axis, Compliance, ExactSurface, Probe};
use trains::{Error, GirderResponse, Governing, RailLoad, Structure, TrainCase};

use crate::outcome::{LimitCheck, RailPairResponse, SolvedCase};
use crate::placed::RailLines;
use crate::stresses::span_of;

/// Largest sine of the angle between rails that count as parallel.
const PARALLEL: f64 = 1e-9;

/// Of values that differ by no more than this fraction the first counts.
const TIE: f64 = 1e-12;

/// Pairs of rails on which a train of the case stands.
fn pairs(design: &Design, case: &DesignCase, lines: &RailLines) -> Vec<[usize; 2]> {
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
            let both = case
                .trains
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
        .any(|case| case.factors.is_empty() && !pairs(design, case, lines).is_empty())
}

/// The responses of all pairs in the cases without factors.
pub(crate) fn pair_responses(
    design: &Design,
    lines: &RailLines,
    structure: &Structure,
    trains: &[TrainCase],
    cases: &[SolvedCase],
) -> Result<Vec<RailPairResponse>, Error> {
    let surface = structure.frame().surface()?.surface;
    let moved = Moved {
        lines,
        structure,
        surface: &surface,
    };
    let mut out = Vec::new();
    for (number, (case, solved)) in design.cases.iter().zip(cases).enumerate() {
        if !case.factors.is_empty() {
            continue;
        }
        for pair in pairs(design, case, lines) {
            for (quantity, axis) in [
                ("change of gauge", Axis::Lateral),
                ("difference in height", Axis::Vertical),
            ] {
                let found = moved.largest(pair, axis, solved, &trains[number])?;
                let Some((value, x, governing)) = found else {
                    continue;
                };
                let rails = design.spec.rails();
                out.push(RailPairResponse {
                    case: number + 1,
                    rails: pair.map(|rail| rails[rail].name.clone()),
                    quantity,
                    distance: lines.distance(pair[0], pair[1]).abs(),
                    value,
                    x,
                    span: span_of(&design.spans[pair[0]], x),
                    governing,
                });
            }
        }
    }
    Ok(out)
}

/// The limits of the code for pairs of rails.
pub(crate) fn pair_limits(design: &Design, responses: &[RailPairResponse]) -> Vec<LimitCheck> {
    let metric = Scale {
        from: design.units,
        to: Units::SI,
    }
    .factor(Dimension::LENGTH);
    let mut out = Vec::new();
    for found in responses {
        let wanted = match found.quantity {
            "change of gauge" => LimitedDisplacement::GaugeChange,
            _ => LimitedDisplacement::HeightDifference,
        };
        for limit in design
            .practice
            .limits
            .iter()
            .filter(|limit| limit.displacement == wanted)
        {
            let Ok(allowed) = limit.allowable(found.distance * metric) else {
                continue;
            };
            out.push(LimitCheck {
                clause: limit.clause,
                quantity: found.quantity,
                formula: limit.formula(),
                loads: limit.loads.words(),
                value: found.value.abs(),
                limit: allowed / metric,
                case: found.case,
                rail: found.rails.join(", "),
                span: found.span,
                ends: None,
                x: found.x,
                position: found.governing.trains.first().map(|train| train.position),
                is_sampled: true,
            });
        }
    }
    out
}

/// Deflections of rails in given states.
struct Moved<'a> {
    lines: &'a RailLines,
    structure: &'a Structure,
    surface: &'a ExactSurface,
}

impl Moved<'_> {
    /// The difference of largest size over the governing states of both rails, its coordinate on the first rail, and the state.
    /// `None` where a rail does not resist a force in this direction.
    fn largest(
        &self,
        pair: [usize; 2],
        axis: Axis,
        solved: &SolvedCase,
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
        let found = &solved.envelopes;
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
            for (axis, force) in [Axis::Longitudinal, Axis::Vertical, Axis::Lateral]
                .into_iter()
                .zip(load.force)
            {
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
