//! The calculation: for each member its influence lines, for each case the extremes over it and the envelopes at places.

use std::collections::VecDeque;

use crate::alone::Alone;
use crate::collect::{Accumulated, Entry, entry, is_better, offer, sign_of, spans_of, standings};
use crate::dead::{DeadLoad, DeadLoads};
use crate::deflection::{Deflections, GAP, MOST};
use crate::effect::{extremes_of_effects, plans};
use crate::error::Error;
use crate::extremes::{
    CaseEnvelopes, EnvelopeValue, Governing, Request, SpanExtreme, TrainPosition,
};
use crate::follow::{SectionSide, Target};
use crate::hints::Hint;
use crate::line::Lines;
use crate::overrun::Overrun;
use crate::plan::{Arrangement, CasePlan, TIE};
use crate::rail_deflection::CarrierLines;
use crate::several;
use crate::structure::{Carrier, GirderResponse, QUANTITIES, Structure};
use crate::train::{COMPONENTS, TrainCase};

/// Carriers whose influence lines are solved at once.
const BATCH: usize = 32;

/// Computes envelopes and extremes of all cases.
///
/// # Errors
/// A train or a case that does not fit on the rails, a load that the structure does not resist, an effect that does not
/// exist.
///
/// # Example
/// ```
/// use fea::Girder;
/// use trains::{DeadLoads, GirderResponse, Request, Structure, Train, TrainCase, TrainWheel, envelopes};
///
/// // Two wheels of 100 kN, 2 m apart, on a simple beam of 8 m: the largest moment is P (L - a/2)^2/(2 L) under a wheel
/// // at x = L/2 - a/4.
/// let girder = Girder { spans: vec![8.0], e: 2.1e8, i_vertical: 5e-4, ..Girder::default() };
/// let (model, rail) = girder.model_and_rail()?;
/// let structure = Structure::new(&model, &[rail], false)?;
/// let wheel = |x: f64| TrainWheel { rail: 0, x, vertical: 100.0, lateral: 0.0, longitudinal: 0.0, eccentricity: 0.0 };
/// let train = Train {
///     wheels: vec![wheel(0.0), wheel(2.0)], ends: [0.0; 2], turned: true, reverses: true, enters: false,
/// };
/// let case = TrainCase { trains: vec![train], ..TrainCase::default() };
/// let request = Request { spans: vec![vec![0.0, 8.0]], ..Request::default() };
/// let found = envelopes(&structure, &DeadLoads::default(), &[case], &request)?;
/// let largest = found[0].extremes.iter().find(|e| e.quantity == GirderResponse::VerticalMoment && e.is_max);
/// let largest = &largest.expect("there is one for each quantity").governing;
/// assert!((largest.value - 100.0 * 49.0 / 16.0).abs() < 1e-11);
/// assert!((largest.x - 3.5).abs() < 1e-12);
/// # Ok::<(), trains::Error>(())
/// ```
pub fn envelopes(
    structure: &Structure,
    dead: &DeadLoads,
    cases: &[TrainCase],
    request: &Request,
) -> Result<Vec<CaseEnvelopes>, Error> {
    let (plans, used) = plans(structure, dead, cases)?;
    let analysis = Analysis {
        structure,
        plans: &plans,
        request,
        used,
    };
    let mut extremes: Vec<Accumulated> = cases.iter().map(|_| Accumulated::default()).collect();
    let mut out = vec![CaseEnvelopes::default(); cases.len()];
    let mut waiting: VecDeque<Prepared<'_>> = VecDeque::new();
    for carriers in structure.carriers.chunks(BATCH) {
        let forces = structure.end_lines(carriers, used)?;
        let loads = structure.dead_loads(dead, carriers, &forces)?;
        for ((carrier, forces), load) in carriers.iter().zip(forces).zip(loads) {
            let prepared = analysis.prepared(carrier, forces, &load)?;
            analysis.extremes_on(&prepared, &mut extremes, &mut out)?;
            waiting.push_back(prepared);
            // Extremes of a span are final when all its members, and those of the next one, are done.
            let done = |first: &Prepared<'_>| {
                first.carrier.rail != carrier.rail
                    || analysis.spans(first.carrier)[1] + 1 < analysis.spans(carrier)[0]
            };
            while waiting.front().is_some_and(done) {
                let first = waiting.pop_front().expect("there is a first one");
                analysis.envelopes_on(&first, &mut extremes, &mut out);
            }
        }
    }
    for prepared in &waiting {
        analysis.envelopes_on(prepared, &mut extremes, &mut out);
    }
    for (case, out) in out.iter_mut().enumerate() {
        out.envelopes.sort_by(|a, b| {
            let key = |e: &EnvelopeValue| (e.quantity, !e.is_max);
            let place = a
                .rail
                .cmp(&b.rail)
                .then(a.governing.x.total_cmp(&b.governing.x));
            place.then(key(a).cmp(&key(b)))
        });
        out.extremes = finished(&extremes[case], &out.envelopes, structure.slack());
        out.deflections
            .sort_by_key(|d| (d.rail, d.span, d.quantity));
    }
    for (out, effects) in out.iter_mut().zip(extremes_of_effects(
        structure,
        dead,
        &plans,
        &request.effects,
        used,
    )?) {
        out.effects = effects;
    }
    Ok(out)
}

/// The extremes in order; coincident values are those of the envelope at the same coordinate.
fn finished(all: &Accumulated, envelopes: &[EnvelopeValue], slack: f64) -> Vec<SpanExtreme> {
    let mut out: Vec<SpanExtreme> = all
        .list
        .iter()
        .filter_map(|entry| {
            let mut governing = entry.governing.clone()?;
            let first = envelopes
                .partition_point(|e| (e.rail, e.governing.x) < (entry.rail, governing.x - slack));
            let same = envelopes[first..]
                .iter()
                .take_while(|e| e.rail == entry.rail && e.governing.x <= governing.x + slack)
                .find(|e| (e.quantity, e.is_max) == (entry.quantity, entry.is_max));
            governing.coincident = same.map_or([0.0; 3], |e| e.governing.coincident);
            let sign = sign_of(entry.is_max);
            let bound = entry.bound.map_or(governing.value, |bound| {
                sign * bound.max(sign * governing.value)
            });
            let Entry {
                rail,
                span,
                quantity,
                is_max,
                ..
            } = *entry;
            Some(SpanExtreme {
                rail,
                span,
                quantity,
                is_max,
                governing,
                bound,
            })
        })
        .collect();
    out.sort_by_key(|e| (e.rail, e.span, e.quantity, !e.is_max));
    out
}

/// What does not change during the calculation.
struct Analysis<'a> {
    structure: &'a Structure,
    plans: &'a [CasePlan],
    request: &'a Request,
    used: [bool; COMPONENTS],
}

/// A carrier with the trains of each case over it and the dead load with the factor of the case.
struct Prepared<'a> {
    carrier: &'a Carrier,
    lines: CarrierLines,
    cases: Vec<(Overrun, DeadLoad)>,
}

impl<'a> Analysis<'a> {
    /// Influence lines of a carrier, and the responses of its ends to all trains.
    fn prepared(
        &self,
        carrier: &'a Carrier,
        forces: Lines<QUANTITIES>,
        load: &DeadLoad,
    ) -> Result<Prepared<'a>, Error> {
        let deflections = |direction| {
            self.structure
                .deflection_lines(carrier, direction, None, self.used)
        };
        let lines = CarrierLines {
            forces,
            deflections: [deflections(0)?, deflections(1)?],
        };
        let lines = lines.joined(self.structure, carrier);
        let case = |plan: &CasePlan| {
            Ok((
                Overrun::new(self.structure, plan, carrier, &lines)?,
                load.times(plan.dead),
            ))
        };
        let cases = self.plans.iter().map(case).collect::<Result<_, Error>>()?;
        Ok(Prepared {
            carrier,
            lines,
            cases,
        })
    }

    /// Numbers of the first and the last span over a carrier.
    fn spans(&self, carrier: &Carrier) -> [usize; 2] {
        let spans = spans_of(&self.request.spans, self.structure, carrier);
        let number = |span: Option<&(usize, [f64; 2])>| span.map_or(0, |(number, _)| *number);
        [number(spans.first()), number(spans.last())]
    }

    /// Extremes over a carrier, span by span: of the internal forces, then of the deflections.
    fn extremes_on(
        &self,
        prepared: &Prepared<'_>,
        extremes: &mut [Accumulated],
        out: &mut [CaseEnvelopes],
    ) -> Result<(), Error> {
        let each = self
            .plans
            .iter()
            .zip(&prepared.cases)
            .zip(extremes.iter_mut().zip(out));
        for ((plan, (over, dead)), (extremes, out)) in each {
            self.forces_on(prepared.carrier, plan, over, dead, extremes)?;
            let deflections = Deflections {
                structure: self.structure,
                request: self.request,
                used: self.used,
                plan,
                carrier: prepared.carrier,
                lines: &prepared.lines,
                dead,
                over,
            };
            deflections.extremes(extremes)?;
            deflections.beside_chords(extremes, &mut out.deflections)?;
        }
        Ok(())
    }

    /// Extremes of the internal forces over a carrier in one case.
    fn forces_on(
        &self,
        carrier: &Carrier,
        plan: &CasePlan,
        over: &Overrun,
        dead: &DeadLoad,
        out: &mut Accumulated,
    ) -> Result<(), Error> {
        for (span, ends) in spans_of(&self.request.spans, self.structure, carrier) {
            let window = ends.map(|x| carrier.place(x));
            let sections = [0, 1].map(|end| Section {
                plan,
                dead,
                over,
                s: window[end],
                x: ends[end],
                side: self.side_of_end(carrier, ends[end], end),
            });
            for quantity in &GirderResponse::ALL[..QUANTITIES] {
                for is_max in [true, false] {
                    let sign = sign_of(is_max);
                    let entry = entry(out, carrier.rail, span, *quantity, is_max);
                    for section in &sections {
                        let found = section
                            .best(*quantity, sign, &[])
                            .map(|(governing, _)| governing);
                        offer(&mut entry.governing, found, sign);
                    }
                    let target = Target {
                        k: *quantity as usize,
                        sign,
                        window,
                        dead,
                    };
                    if plan.trains.len() == 1 {
                        let found =
                            follow_one(plan, over, carrier, &target, entry.governing.as_ref());
                        offer(&mut entry.governing, found, sign);
                        if over
                            .all()
                            .any(|passage| passage.on.bent_row(target.k).is_some())
                        {
                            let search = Alone {
                                plan,
                                over,
                                carrier,
                                quantity: *quantity,
                                sign,
                                window: ends,
                                dead: Some(dead),
                                kinks: 0.0,
                                gap: GAP,
                                size: 0.0,
                                most: MOST,
                            };
                            let known = entry
                                .governing
                                .as_ref()
                                .map_or(f64::NEG_INFINITY, |g| sign * g.value);
                            let (found, bound) = search.enclosed(None, known);
                            offer(&mut entry.governing, found, sign);
                            entry.bound = Some(bound.max(entry.bound.unwrap_or(f64::NEG_INFINITY)));
                        }
                        continue;
                    }
                    let known = entry
                        .governing
                        .as_ref()
                        .map_or(f64::NEG_INFINITY, |g| sign * g.value);
                    if let Some((found, bound)) =
                        several::enclosed(plan, over, carrier, &target, known)?
                    {
                        offer(&mut entry.governing, found, sign);
                        entry.bound = Some(bound.max(entry.bound.unwrap_or(f64::NEG_INFINITY)));
                    }
                }
            }
        }
        Ok(())
    }

    /// The side on which a carrier lies of a coordinate at its first (0) or last (1) end; within a member both sides
    /// are the same.
    fn side_of_end(&self, carrier: &Carrier, x: f64, end: usize) -> SectionSide {
        let slack = self.structure.slack();
        match end {
            0 if (x - carrier.x[0]).abs() <= slack => SectionSide::Behind,
            1 if (x - carrier.x[1]).abs() <= slack => SectionSide::Before,
            _ => SectionSide::At,
        }
    }

    /// Envelopes at the places of the request and of the extremes within a carrier.
    fn envelopes_on(
        &self,
        prepared: &Prepared<'_>,
        extremes: &mut [Accumulated],
        out: &mut [CaseEnvelopes],
    ) {
        let slack = self.structure.slack();
        let carrier = prepared.carrier;
        let each = self
            .plans
            .iter()
            .zip(&prepared.cases)
            .zip(extremes.iter().zip(out));
        for ((plan, (over, dead)), (extremes, out)) in each {
            let mut hints = vec![None; 2 * GirderResponse::ALL.len()];
            for x in self.places_on(carrier, extremes) {
                let end = usize::from((x - carrier.x[1]).abs() <= slack);
                let s = carrier.place(x);
                let side = self.side_of_end(carrier, x, end);
                let section = Section {
                    plan,
                    dead,
                    over,
                    s,
                    x,
                    side,
                };
                for quantity in GirderResponse::ALL {
                    let exists = (quantity as usize).checked_sub(QUANTITIES);
                    if exists
                        .is_some_and(|direction| prepared.lines.deflections[direction].is_none())
                    {
                        continue;
                    }
                    for is_max in [true, false] {
                        let hint = &mut hints[2 * quantity as usize + usize::from(is_max)];
                        let Some(governing) = section.envelope(quantity, sign_of(is_max), hint)
                        else {
                            continue;
                        };
                        let found = EnvelopeValue {
                            rail: carrier.rail,
                            quantity,
                            is_max,
                            governing,
                        };
                        offer_envelope(out, found, slack);
                    }
                }
            }
        }
    }

    /// Places of the request and of the extremes of a case on a carrier, increasing.
    fn places_on(&self, carrier: &Carrier, extremes: &Accumulated) -> Vec<f64> {
        let slack = self.structure.slack();
        let own = extremes
            .list
            .iter()
            .filter(|entry| entry.rail == carrier.rail);
        let of_extremes = own
            .filter_map(|entry| entry.governing.as_ref())
            .map(|governing| governing.x);
        let asked = self
            .request
            .places
            .get(carrier.rail)
            .into_iter()
            .flatten()
            .copied();
        let inside = |x: &f64| *x >= carrier.x[0] - slack && *x <= carrier.x[1] + slack;
        let mut places: Vec<f64> = asked.chain(of_extremes).filter(inside).collect();
        places.sort_by(f64::total_cmp);
        places.dedup_by(|b, a| *b - *a <= slack);
        places
    }
}

/// Adds a value of an envelope. Where the other side of the same place has one, the better of the two stays in the
/// envelope, and the other one is kept beside it. Places come in increasing order, so that those at the same place are
/// among the last.
fn offer_envelope(out: &mut CaseEnvelopes, found: EnvelopeValue, slack: f64) {
    let all = &mut out.envelopes;
    let from = all.len().saturating_sub(4 * GirderResponse::ALL.len());
    let known = (from..all.len()).rev().find(|&index| {
        let known = &all[index];
        known.rail == found.rail
            && (known.governing.x - found.governing.x).abs() <= slack
            && known.quantity == found.quantity
            && known.is_max == found.is_max
    });
    let Some(index) = known else {
        all.push(found);
        return;
    };
    let (known, mut other) = (&mut all[index].governing, found.governing);
    if is_better(&other, known, sign_of(found.is_max)) {
        std::mem::swap(known, &mut other);
    }
    out.other_sides.push((index, other));
}

/// A section of a carrier under the trains of a case.
struct Section<'a> {
    plan: &'a CasePlan,
    dead: &'a DeadLoad,
    over: &'a Overrun,
    s: f64,
    x: f64,
    side: SectionSide,
}

impl Section<'_> {
    /// The governing state of a quantity, without coincident values.
    fn best(
        &self,
        quantity: GirderResponse,
        sign: f64,
        hints: &[Hint<'_>],
    ) -> Option<(Governing, Arrangement)> {
        let found = self
            .over
            .best(self.plan, quantity as usize, sign, self.s, hints)?;
        let dead = self.dead.at(quantity, self.s);
        let governing = Governing {
            value: sign * found.signed + dead,
            dead,
            x: self.x,
            side: self.side,
            trains: standings(self.plan, &found),
            coincident: [0.0; 3],
        };
        Some((governing, found))
    }

    /// The governing state of a quantity with the moment, shear and deflection of the same state. `hint` is the state of
    /// the section before, and then that of this one.
    fn envelope(
        &self,
        quantity: GirderResponse,
        sign: f64,
        hint: &mut Option<(f64, Arrangement)>,
    ) -> Option<Governing> {
        let before = hint.as_ref().map(|(x, at)| Hint { at, by: self.x - x });
        let (mut governing, arrangement) = self.best(quantity, sign, before.as_slice())?;

        governing.coincident = quantity.coincident().map(|k| {
            if k == quantity {
                governing.value
            } else {
                self.over.value(k as usize, self.s, &arrangement) + self.dead.at(k, self.s)
            }
        });
        *hint = Some((self.x, arrangement));
        Some(governing)
    }
}

/// The largest value for a single train at sections beside its wheels and at vertices.
fn follow_one(
    plan: &CasePlan,
    over: &Overrun,
    carrier: &Carrier,
    target: &Target<'_>,
    known: Option<&Governing>,
) -> Option<Governing> {
    let mut best: Option<Governing> = None;
    for &stance in over.distinct(target.k, 0) {
        let placed = &plan.trains[0][stance];
        let so_far = best
            .as_ref()
            .or(known)
            .map_or(f64::NEG_INFINITY, |g| target.sign * g.value);
        let floor = so_far - TIE * so_far.abs();
        let Some(peak) = over.passages[0][stance].follow(over.bounds(stance), target, floor) else {
            continue;
        };
        let dead = target.dead.at(GirderResponse::ALL[target.k], peak.place);
        let found = Governing {
            value: target.sign * peak.signed,
            dead,
            x: carrier.coordinate(peak.place),
            side: peak.side,
            trains: vec![TrainPosition {
                position: peak.position,
                stance: placed.stance,
            }],
            coincident: [0.0; 3],
        };
        offer(&mut best, Some(found), target.sign);
    }
    best
}
