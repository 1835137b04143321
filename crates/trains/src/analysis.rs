//! The calculation: for each member its influence lines, for each case the extremes over it and the envelopes at places.

use crate::collect::{Accumulated, Entry, entry, is_better, offer, sign_of, spans_of, standings};
use crate::dead::{DeadLoad, DeadLoads};
use crate::deflection::Deflections;
use crate::effect::{extremes_of_effects, plans};
use crate::error::Error;
use crate::extremes::{CaseEnvelopes, EnvelopeValue, Governing, Request, SpanExtreme, TrainPosition};
use crate::follow::{SectionSide, Target};
use crate::line::Lines;
use crate::overrun::Overrun;
use crate::pieces::Piece;
use crate::plan::{Arrangement, CasePlan, TIE};
use crate::several;
use crate::structure::{Carrier, GirderResponse, QUANTITIES, Structure};
use crate::train::TrainCase;

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
    let analysis = Analysis { structure, plans: &plans, request };
    let mut extremes: Vec<Accumulated> = cases.iter().map(|_| Accumulated::default()).collect();
    let mut kept = Vec::new();
    for carriers in structure.carriers.chunks(BATCH) {
        let lines = structure.end_lines(carriers, used)?;
        let loads = structure.dead_loads(dead, carriers, &lines)?;
        for ((carrier, lines), load) in carriers.iter().zip(lines).zip(loads) {
            analysis.extremes_on(carrier, &lines, &load, &mut extremes)?;
            kept.push((carrier, lines, load));
        }
    }
    let deflections = Deflections::new(structure, &plans, request, used, &kept);
    deflections.extremes(&mut extremes)?;
    let mut out = vec![CaseEnvelopes::default(); cases.len()];
    for (carrier, lines, load) in &kept {
        analysis.envelopes_on(carrier, lines, load, &deflections, (&mut extremes, &mut out))?;
    }
    for (case, out) in out.iter_mut().enumerate() {
        out.envelopes.sort_by(|a, b| {
            let key = |e: &EnvelopeValue| (e.quantity, !e.is_max);
            let place = a.rail.cmp(&b.rail).then(a.governing.x.total_cmp(&b.governing.x));
            place.then(key(a).cmp(&key(b)))
        });
        out.extremes = finished(&extremes[case], &out.envelopes, structure.slack());
        out.deflections = deflections.beside_chords(case, &extremes[case])?;
    }
    for (out, effects) in
        out.iter_mut().zip(extremes_of_effects(structure, dead, &plans, &request.effects, used)?)
    {
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
            let same = envelopes.iter().find(|e| {
                (e.rail, e.quantity, e.is_max) == (entry.rail, entry.quantity, entry.is_max)
                    && (e.governing.x - governing.x).abs() <= slack
            });
            governing.coincident = same.map_or([0.0; 3], |e| e.governing.coincident);
            let sign = sign_of(entry.is_max);
            let bound = entry.bound.map_or(governing.value, |bound| sign * bound.max(sign * governing.value));
            let Entry { rail, span, quantity, is_max, .. } = *entry;
            Some(SpanExtreme { rail, span, quantity, is_max, governing, bound })
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
}

impl Analysis<'_> {
    /// Extremes of the internal forces over a carrier, span by span.
    fn extremes_on(
        &self,
        carrier: &Carrier,
        lines: &Lines<QUANTITIES>,
        load: &DeadLoad,
        out: &mut [Accumulated],
    ) -> Result<(), Error> {
        for (plan, out) in self.plans.iter().zip(out) {
            let dead = load.times(plan.dead);
            let over = Overrun::new(self.structure, plan, carrier, lines)?;
            for (span, ends) in spans_of(self.request, self.structure, carrier) {
                let window = ends.map(|x| carrier.place(x));
                let sections = [0, 1].map(|end| Section {
                    plan,
                    dead: &dead,
                    pieces: over.section(window[end]),
                    s: window[end],
                    x: ends[end],
                    side: self.side_of_end(carrier, ends[end], end),
                });
                for quantity in &GirderResponse::ALL[..QUANTITIES] {
                    for is_max in [true, false] {
                        let sign = sign_of(is_max);
                        let entry = entry(out, carrier.rail, span, *quantity, is_max);
                        for section in &sections {
                            let found = section.best(*quantity, sign).map(|(governing, _)| governing);
                            offer(&mut entry.governing, found, sign);
                        }
                        let target = Target { k: *quantity as usize, sign, window, dead: &dead };
                        if plan.trains.len() == 1 {
                            let found = follow_one(plan, &over, carrier, &target, entry.governing.as_ref());
                            offer(&mut entry.governing, found, sign);
                            continue;
                        }
                        let known = entry.governing.as_ref().map_or(f64::NEG_INFINITY, |g| sign * g.value);
                        if let Some((found, bound)) = several::enclosed(plan, &over, carrier, &target, known)?
                        {
                            offer(&mut entry.governing, found, sign);
                            entry.bound = Some(bound.max(entry.bound.unwrap_or(f64::NEG_INFINITY)));
                        }
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
        carrier: &Carrier,
        lines: &Lines<QUANTITIES>,
        load: &DeadLoad,
        deflections: &Deflections<'_>,
        (extremes, out): (&mut [Accumulated], &mut [CaseEnvelopes]),
    ) -> Result<(), Error> {
        let slack = self.structure.slack();
        for (case, (plan, out)) in self.plans.iter().zip(out).enumerate() {
            let dead = load.times(plan.dead);
            let over = Overrun::new(self.structure, plan, carrier, lines)?;
            for x in self.places_on(carrier, &extremes[case]) {
                let end = usize::from((x - carrier.x[1]).abs() <= slack);
                let s = carrier.place(x);
                let side = self.side_of_end(carrier, x, end);
                let section = Section { plan, dead: &dead, pieces: over.section(s), s, x, side };
                let at = (case, carrier.rail, x);
                for quantity in GirderResponse::ALL {
                    for is_max in [true, false] {
                        let sign = sign_of(is_max);
                        let Some(governing) = section.envelope(quantity, sign, at, deflections)? else {
                            continue;
                        };
                        let known = out.envelopes.iter_mut().rev().take(4 * GirderResponse::ALL.len()).find(
                            |known| {
                                known.rail == carrier.rail
                                    && (known.governing.x - x).abs() <= slack
                                    && known.quantity == quantity
                                    && known.is_max == is_max
                            },
                        );
                        match known {
                            Some(known) if is_better(&governing, &known.governing, sign) => {
                                known.governing = governing
                            }
                            Some(_) => {}
                            None => out.envelopes.push(EnvelopeValue {
                                rail: carrier.rail,
                                quantity,
                                is_max,
                                governing,
                            }),
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// Places of the request and of the extremes of a case on a carrier, increasing.
    fn places_on(&self, carrier: &Carrier, extremes: &Accumulated) -> Vec<f64> {
        let slack = self.structure.slack();
        let own = extremes.list.iter().filter(|entry| entry.rail == carrier.rail);
        let of_extremes = own.filter_map(|entry| entry.governing.as_ref()).map(|governing| governing.x);
        let asked = self.request.places.get(carrier.rail).into_iter().flatten().copied();
        let inside = |x: &f64| *x >= carrier.x[0] - slack && *x <= carrier.x[1] + slack;
        let mut places: Vec<f64> = asked.chain(of_extremes).filter(inside).collect();
        places.sort_by(f64::total_cmp);
        places.dedup_by(|b, a| *b - *a <= slack);
        places
    }
}

/// A section of a carrier under the trains of a case.
struct Section<'a> {
    plan: &'a CasePlan,
    dead: &'a DeadLoad,
    pieces: Vec<Vec<Vec<Piece<QUANTITIES>>>>,
    s: f64,
    x: f64,
    side: SectionSide,
}

impl Section<'_> {
    /// The governing state of an internal force, without coincident values.
    fn best(&self, quantity: GirderResponse, sign: f64) -> Option<(Governing, Arrangement)> {
        let found = self.plan.best(&self.pieces, quantity as usize, sign, f64::NEG_INFINITY)?;
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

    /// The governing state of any quantity with the moment, shear and deflection of the same state.
    fn envelope(
        &self,
        quantity: GirderResponse,
        sign: f64,
        (case, rail, x): (usize, usize, f64),
        deflections: &Deflections<'_>,
    ) -> Result<Option<Governing>, Error> {
        let is_force = (quantity as usize) < QUANTITIES;
        let found = if is_force {
            self.best(quantity, sign)
        } else {
            deflections.best(case, rail, x, quantity, sign)?
        };
        let Some((mut governing, mut arrangement)) = found else { return Ok(None) };
        if !is_force {
            self.locate(&mut arrangement);
            governing.side = self.side;
        }
        let [moment, shear, deflection] = quantity.coincident();
        let dead = self.dead.at(deflection, self.s);
        let bent = if quantity == deflection {
            governing.value
        } else {
            dead + deflections.value(case, rail, x, deflection, &arrangement)?
        };
        let force = |k: GirderResponse| {
            if k == quantity { governing.value } else { self.value(k, &arrangement) }
        };
        governing.coincident = [force(moment), force(shear), bent];
        Ok(Some(governing))
    }

    /// Finds the pieces in which the trains of an arrangement stand.
    fn locate(&self, arrangement: &mut Arrangement) {
        for (standing, stances) in arrangement.trains.iter_mut().zip(&self.pieces) {
            let list = &stances[standing.stance];
            let found = list.partition_point(|piece| piece.position[1] < standing.position);
            standing.piece = found.min(list.len() - 1);
        }
    }

    /// An internal force in an arrangement, dead load included.
    fn value(&self, quantity: GirderResponse, arrangement: &Arrangement) -> f64 {
        let live: f64 = arrangement
            .trains
            .iter()
            .zip(&self.pieces)
            .map(|(standing, stances)| {
                let piece = &stances[standing.stance][standing.piece];
                piece.polynomial(quantity as usize).at(standing.position - piece.position[0])
            })
            .sum();
        live + self.dead.at(quantity, self.s)
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
    for (stance, placed) in plan.trains[0].iter().enumerate() {
        let so_far = best.as_ref().or(known).map_or(f64::NEG_INFINITY, |g| target.sign * g.value);
        let floor = so_far - TIE * so_far.abs();
        let Some(peak) = over.on[0][stance].follow(&over.pieces[0][stance], target, floor) else { continue };
        let dead = target.dead.at(GirderResponse::ALL[target.k], peak.place);
        let found = Governing {
            value: target.sign * peak.signed,
            dead,
            x: carrier.coordinate(peak.place),
            side: peak.side,
            trains: vec![TrainPosition { position: peak.position, stance: placed.stance }],
            coincident: [0.0; 3],
        };
        offer(&mut best, Some(found), target.sign);
    }
    best
}
