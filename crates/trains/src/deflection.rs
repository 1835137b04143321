//! Deflections of rails: envelopes at places, and extremes over spans with a proof.
//!
//! At a fixed place x the deflection is piecewise cubic in the position, so that its envelope D(x) is exact. The largest
//! D over a span is found and enclosed by bisection. Between two places with no wheel between them the deflection of any
//! state differs from its chord by at most h^2/8 times the largest curvature k, and with a wheel between them the same
//! holds on each side of the wheel. So on an interval of length h
//!
//! D <= max(D at both ends, W) + k h^2/8,
//!
//! W being the deflections under the wheels, which are polynomials of degree six in the position, and whose maximum is
//! exact. The slope of the rail is continuous at a wheel where the members do not shear or twist under it; then W is not
//! needed. For several trains W is not known exactly, and the bounds are those of `blocked`.

use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

use fea::CrossSection;
use nalgebra::Vector3;
use splines::{Compliance, Influence, Probe};

use crate::bicubic::SecondDerivatives;
use crate::blocked::Blocked;
use crate::collect::{Accumulated, entry, offer, sign_of, spans_of, standings};
use crate::dead::DeadLoad;
use crate::error::Error;
use crate::extremes::{Governing, Request, SpanDeflection};
use crate::follow::SectionSide;
use crate::line::Lines;
use crate::overrun::Overrun;
use crate::pieces::{Piece, Pieces};
use crate::plan::{Arrangement, CasePlan};
use crate::polynomial::Polynomial;
use crate::search::{Bend, Margin, Search};
use crate::structure::{Carrier, GirderResponse, OnMember, QUANTITIES, Structure, deflection_axis};
use crate::train::{COMPONENTS, PlacedTrain, axis};

/// Most evaluations for one extreme under several trains, whose slope jumps under wheels.
const MOST_OF_SEVERAL: usize = 2000;
/// Most evaluations for the largest deflection of a span from its chord.
const MOST_OF_CHORDS: usize = 120;
/// Most cells of influence lines that are kept.
const KEPT_CELLS: usize = 200_000;

/// A carrier with its influence lines and its dead load.
pub(crate) type Prepared<'a> = (&'a Carrier, Lines<QUANTITIES>, DeadLoad);

/// Deflections of the rails of a structure in all cases.
pub(crate) struct Deflections<'a> {
    structure: &'a Structure,
    plans: &'a [CasePlan],
    request: &'a Request,
    used: [bool; COMPONENTS],
    carriers: &'a [Prepared<'a>],
    lines: RefCell<LineCache>,
    pieces: RefCell<PieceCache>,
}

/// Influence lines of deflections that were needed lately.
#[derive(Default)]
struct LineCache {
    by_place: HashMap<LineKey, Rc<Lines<1>>>,
    cells: usize,
}

/// Rail, quantity, and the places with their weights, as bits.
type LineKey = (usize, usize, Vec<[u64; 2]>);

/// Responses to the trains of a case, by train and stance.
type CasePieces = Vec<Vec<Vec<Piece<1>>>>;

/// Responses that were needed lately, by case; the largest and the smallest value of a place need the same.
#[derive(Default)]
struct PieceCache {
    by_place: HashMap<(usize, LineKey), Rc<CasePieces>>,
    count: usize,
}

impl<'a> Deflections<'a> {
    pub fn new(
        structure: &'a Structure,
        plans: &'a [CasePlan],
        request: &'a Request,
        used: [bool; COMPONENTS],
        carriers: &'a [Prepared<'a>],
    ) -> Deflections<'a> {
        let (lines, pieces) = (RefCell::default(), RefCell::default());
        Deflections { structure, plans, request, used, carriers, lines, pieces }
    }

    /// Whether the structure resists a deflection, so that there is one.
    fn exists(&self, rail: usize, quantity: GirderResponse) -> bool {
        self.structure.rails[rail].resists[deflection_axis(quantity).0.component()]
    }

    /// Influence line of a weighted sum of deflections of a rail at several places.
    fn line(
        &self,
        rail: usize,
        places: &[[f64; 2]],
        quantity: GirderResponse,
    ) -> Result<Rc<Lines<1>>, Error> {
        let key = line_key(rail, places, quantity);
        if let Some(known) = self.lines.borrow().by_place.get(&key) {
            return Ok(Rc::clone(known));
        }
        let made = Rc::new(self.structure.deflection_line(rail, places, quantity, self.used)?);
        let mut cache = self.lines.borrow_mut();
        cache.cells += made.rails.iter().map(Vec::len).sum::<usize>();
        if cache.cells > KEPT_CELLS {
            *cache = LineCache::default();
        }
        cache.by_place.insert(key, Rc::clone(&made));
        Ok(made)
    }

    /// The best arrangement of a case for a weighted sum of deflections.
    fn arrangement(
        &self,
        case: usize,
        rail: usize,
        places: &[[f64; 2]],
        quantity: GirderResponse,
        sign: f64,
    ) -> Result<Option<Arrangement>, Error> {
        let pieces = self.pieces(case, rail, places, quantity)?;
        Ok(self.plans[case].best(&pieces, 0, sign, f64::NEG_INFINITY))
    }

    /// The responses of a weighted sum of deflections to the trains of a case.
    fn pieces(
        &self,
        case: usize,
        rail: usize,
        places: &[[f64; 2]],
        quantity: GirderResponse,
    ) -> Result<Rc<CasePieces>, Error> {
        let key = (case, line_key(rail, places, quantity));
        if let Some(known) = self.pieces.borrow().by_place.get(&key) {
            return Ok(Rc::clone(known));
        }
        let line = self.line(rail, places, quantity)?;
        let sum = |train: &PlacedTrain| Pieces::sum(&line, train, self.structure.slack()).list;
        let all = self.plans[case].trains.iter().map(|stances| stances.iter().map(sum).collect());
        let made: Rc<CasePieces> = Rc::new(all.collect());
        let mut cache = self.pieces.borrow_mut();
        cache.count += made.iter().flatten().map(Vec::len).sum::<usize>();
        if cache.count > KEPT_CELLS {
            *cache = PieceCache::default();
        }
        cache.by_place.insert(key, Rc::clone(&made));
        Ok(made)
    }

    /// The governing state for the deflection of a rail at x; `None` where the structure does not resist it.
    pub fn best(
        &self,
        case: usize,
        rail: usize,
        x: f64,
        quantity: GirderResponse,
        sign: f64,
    ) -> Result<Option<(Governing, Arrangement)>, Error> {
        if !self.exists(rail, quantity) {
            return Ok(None);
        }
        let Some(found) = self.arrangement(case, rail, &[[x, 1.0]], quantity, sign)? else { return Ok(None) };
        let plan = &self.plans[case];
        let dead = plan.dead * self.dead(rail, x, quantity);
        let governing = Governing {
            value: sign * found.signed + dead,
            dead,
            x,
            side: SectionSide::At,
            trains: standings(plan, &found),
            coincident: [0.0; 3],
        };
        Ok(Some((governing, found)))
    }

    /// Deflection by the dead load, with factor 1.
    fn dead(&self, rail: usize, x: f64, quantity: GirderResponse) -> f64 {
        let slack = self.structure.slack();
        let here = |c: &Carrier| c.rail == rail && x >= c.x[0] - slack && x <= c.x[1] + slack;
        let found = self.carriers.iter().find(|(carrier, ..)| here(carrier));
        found.map_or(0.0, |(carrier, _, load)| load.at(quantity, carrier.place(x)))
    }

    /// Deflection of a rail at x in an arrangement, without dead load; 0 where the structure does not resist it.
    pub fn value(
        &self,
        case: usize,
        rail: usize,
        x: f64,
        quantity: GirderResponse,
        arrangement: &Arrangement,
    ) -> Result<f64, Error> {
        if !self.exists(rail, quantity) {
            return Ok(0.0);
        }
        let line = self.line(rail, &[[x, 1.0]], quantity)?;
        let each = arrangement.trains.iter().zip(&self.plans[case].trains);
        let under = |train: &PlacedTrain, position: f64| -> f64 {
            let wheels = train.wheels.iter();
            wheels.map(|wheel| line.value(wheel.rail, position + wheel.offset, &wheel.load)).sum()
        };
        Ok(each.map(|(standing, stances)| under(&stances[standing.stance], standing.position)).sum())
    }

    /// Extremes of deflections over all spans, added to those of the internal forces, which bound the curvature.
    pub fn extremes(&self, all: &mut [Accumulated]) -> Result<(), Error> {
        for (case, all) in all.iter_mut().enumerate() {
            for (carrier, lines, load) in self.carriers {
                let over = Overrun::new(self.structure, &self.plans[case], carrier, lines)?;
                for (span, window) in spans_of(self.request, self.structure, carrier) {
                    for quantity in [GirderResponse::VerticalDeflection, GirderResponse::LateralDeflection] {
                        if !self.exists(carrier.rail, quantity) {
                            continue;
                        }
                        let bend = self.bend(case, carrier, span, all, quantity, load);
                        let several = bend.kinks > 0.0 && self.plans[case].trains.len() > 1;
                        let blocked = match several {
                            true => Some(self.blocked(case, (carrier, load), &over, quantity, bend)?),
                            false => None,
                        };
                        for is_max in [true, false] {
                            let sign = sign_of(is_max);
                            let follows = bend.kinks > 0.0 && self.plans[case].trains.len() == 1;
                            let bend = Bend { kinks: if follows { 0.0 } else { bend.kinks }, ..bend };
                            let margin: Margin<'_> = match &blocked {
                                Some(blocked) => Box::new(|x| blocked.margin(x)),
                                None => Box::new(move |x| bend.margin(x)),
                            };
                            let mut search = Search::new(sign, margin, window, |x| {
                                Ok(self.best(case, carrier.rail, x, quantity, sign)?.map(|(found, _)| found))
                            });
                            if follows {
                                let under =
                                    self.under_wheels(case, carrier, &over, window, quantity, sign, load)?;
                                search.offer(under);
                            }
                            if several {
                                search.most = MOST_OF_SEVERAL;
                            }
                            search.run()?;
                            if several {
                                search.polish((window[1] - window[0]) / 40.0)?;
                            }
                            let entry = entry(all, carrier.rail, span, quantity, is_max);
                            let bound = search.bound.max(entry.bound.unwrap_or(f64::NEG_INFINITY));
                            offer(&mut entry.governing, search.best, sign);
                            entry.bound = Some(bound);
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// What bounds a deflection of a carrier under several trains between two places.
    fn blocked(
        &self,
        case: usize,
        (carrier, load): (&Carrier, &DeadLoad),
        over: &Overrun,
        quantity: GirderResponse,
        bend: Bend,
    ) -> Result<Blocked, Error> {
        let plan = &self.plans[case];
        let bounds = SecondDerivatives::new(self.structure, carrier, quantity, self.used)?;
        let of_train = |stances: &Vec<PlacedTrain>| {
            stances.iter().map(|train| bounds.of_train(train)).fold(0.0, f64::max)
        };
        let rate = carrier.rate();
        let dead = plan.dead.abs() * load.bend(quantity, carrier.length) * rate * rate;
        let curvature = plan.trains.iter().map(of_train).sum::<f64>() + dead;
        let bend = Bend { curvature, ..bend };
        Ok(Blocked::of_deflection(self.structure, plan, over, carrier, bend))
    }

    /// Largest deflections of spans from their chords, without dead load.
    pub fn beside_chords(&self, case: usize, all: &Accumulated) -> Result<Vec<SpanDeflection>, Error> {
        let mut out: Vec<SpanDeflection> = Vec::new();
        for (carrier, _, load) in self.carriers {
            for (span, window) in spans_of(self.request, self.structure, carrier) {
                let spans = &self.request.spans[carrier.rail];
                if span == 0 || span >= spans.len() {
                    continue;
                }
                let ends = [spans[span - 1], spans[span]];
                for quantity in [GirderResponse::VerticalDeflection, GirderResponse::LateralDeflection] {
                    if !self.exists(carrier.rail, quantity) {
                        continue;
                    }
                    let bend = self.bend(case, carrier, span, all, quantity, load);
                    for sign in [1.0, -1.0] {
                        let margin = Box::new(move |x| bend.margin(x));
                        let mut search = Search::new(sign, margin, window, |x| {
                            let r = (x - ends[0]) / (ends[1] - ends[0]);
                            let places = [[x, 1.0], [ends[0], r - 1.0], [ends[1], -r]];
                            let found = self.arrangement(case, carrier.rail, &places, quantity, sign)?;
                            Ok(found.map(|found| Governing {
                                value: sign * found.signed,
                                dead: 0.0,
                                x,
                                side: SectionSide::At,
                                trains: standings(&self.plans[case], &found),
                                coincident: [0.0; 3],
                            }))
                        });
                        // A ratio of span to deflection is printed with three digits.
                        search.gap = 1e-5;
                        search.most = MOST_OF_CHORDS;
                        search.run()?;
                        let Some(governing) = search.best else { continue };
                        let known = out.iter_mut().find(|known| {
                            (known.rail, known.span, known.quantity) == (carrier.rail, span, quantity)
                        });
                        match known {
                            Some(known) if governing.value.abs() > known.governing.value.abs() => {
                                known.governing = governing;
                            }
                            Some(_) => {}
                            None => out.push(SpanDeflection {
                                rail: carrier.rail,
                                span,
                                ends,
                                quantity,
                                governing,
                            }),
                        }
                    }
                }
            }
        }
        out.sort_by_key(|d| (d.rail, d.span, d.quantity));
        Ok(out)
    }

    /// How a deflection of a carrier can bend within a span: bounds from the extremes of its internal forces.
    fn bend(
        &self,
        case: usize,
        carrier: &Carrier,
        span: usize,
        all: &Accumulated,
        quantity: GirderResponse,
        load: &DeadLoad,
    ) -> Bend {
        let most = |quantity: GirderResponse| -> f64 {
            let own =
                all.list.iter().filter(|e| (e.rail, e.span, e.quantity) == (carrier.rail, span, quantity));
            own.filter_map(|e| e.governing.as_ref()).map(|g| g.value.abs() + g.dead.abs()).fold(0.0, f64::max)
        };
        let section: &CrossSection =
            &self.structure.model.sections[self.structure.model.members[carrier.member].section];
        let flexibility = section.flexibility(self.structure.model.theory);
        let frame = &self.structure.rails[carrier.rail];
        let (axis, _) = deflection_axis(quantity);
        let direction = frame.axes[axis.component()];
        let [t, u, z] = carrier.triad;
        let (y_axis, z_axis) = (carrier.local[1], t.cross(&carrier.local[1]));
        let offset =
            self.structure.frame.line().map_or([0.0; 3], |line| line.elements()[carrier.element].offset);
        let arm = frame.axes[0] * offset[0] + frame.axes[1] * offset[1] + frame.axes[2] * offset[2];
        let finite = |x: f64| if x.is_finite() { x } else { 0.0 };
        let along = |v: &Vector3<f64>| negligible(v.dot(&direction));
        // Moments and shear forces about and along the axes of the section are at most the sums of their projections.
        let project = |plane: [GirderResponse; 2], axis: &Vector3<f64>, other: [&Vector3<f64>; 2]| {
            most(plane[0]) * negligible(axis.dot(other[0])) + most(plane[1]) * negligible(axis.dot(other[1]))
        };
        let moments = [GirderResponse::VerticalMoment, GirderResponse::LateralMoment];
        let shears = [GirderResponse::VerticalShear, GirderResponse::LateralShear];
        let (moment_z, moment_y) = (project(moments, &z_axis, [&z, &u]), project(moments, &y_axis, [&z, &u]));
        let (shear_y, shear_z) = (project(shears, &y_axis, [&u, &z]), project(shears, &z_axis, [&u, &z]));
        let [bending_z, bending_y] = [flexibility.bending_z, flexibility.bending_y].map(finite);
        let rate = |k: GirderResponse| load.quadratic(k as usize)[1].abs() * self.plans[case].dead.abs();
        let distributed = rate(GirderResponse::VerticalShear) + rate(GirderResponse::LateralShear);
        let [sheared_y, sheared_z, twisted, stretched] =
            [flexibility.shear_y, flexibility.shear_z, flexibility.torsion, flexibility.axial].map(finite);
        let turned = along(&t.cross(&arm));
        let curvature = along(&y_axis) * (moment_z * bending_z + distributed * sheared_y)
            + along(&z_axis) * (moment_y * bending_y + distributed * sheared_z)
            + along(&z_axis.cross(&arm)) * shear_y * bending_z
            + along(&y_axis.cross(&arm)) * shear_z * bending_y
            + turned * twisted * rate(GirderResponse::Torsion)
            + along(&t) * stretched * rate(GirderResponse::Normal);
        // Jumps of the slope at all wheels together. A couple in a plane of bending makes the moment jump, and with it
        // only the curvature.
        let jump = |[force, couple]: &[Vector3<f64>; 2]| {
            let sheared = force.dot(&y_axis) * y_axis * sheared_y + force.dot(&z_axis) * z_axis * sheared_z;
            let turned = couple.dot(&t) * twisted * t
                + couple.dot(&z_axis) * bending_z * z_axis
                + couple.dot(&y_axis) * bending_y * y_axis;
            let size = force.norm() * (sheared_y + sheared_z + stretched) + turned.norm() * arm.norm();
            let slope = (sheared + force.dot(&t) * stretched * t + turned.cross(&arm)).dot(&direction);
            if slope.abs() > 1e-12 * size { slope.abs() } else { 0.0 }
        };
        let mut kinks = 0.0;
        for stances in &self.plans[case].trains {
            let sum = |train: &PlacedTrain| -> f64 { self.loads_on(carrier, train).iter().map(jump).sum() };
            kinks += stances.iter().map(sum).fold(0.0, f64::max);
        }
        Bend { curvature, kinks }
    }

    /// Force and couple about the axis of the member of a carrier from each wheel that can stand on it, global.
    fn loads_on(&self, carrier: &Carrier, train: &PlacedTrain) -> Vec<[Vector3<f64>; 2]> {
        let mut out = Vec::new();
        for OnMember { stretch, .. } in self.structure.on_member(carrier) {
            for wheel in train.wheels.iter().filter(|wheel| wheel.rail == stretch.rail) {
                let mut total = [Vector3::zeros(); 2];
                for (component, load) in wheel.load.iter().enumerate().filter(|(_, load)| **load != 0.0) {
                    if let Ok(unit) = self.structure.load(stretch, component) {
                        total.iter_mut().zip(unit).for_each(|(sum, unit)| *sum += unit * *load);
                    }
                }
                out.push(total);
            }
        }
        out
    }

    /// The largest deflection under the wheels of a single train.
    #[expect(clippy::too_many_arguments, reason = "a quantity of a case over one window of a carrier")]
    fn under_wheels(
        &self,
        case: usize,
        carrier: &Carrier,
        over: &Overrun,
        window: [f64; 2],
        quantity: GirderResponse,
        sign: f64,
        load: &DeadLoad,
    ) -> Result<Option<Governing>, Error> {
        let surface = self.structure.surface()?;
        let plan = &self.plans[case];
        let (axis_of_response, direction) = deflection_axis(quantity);
        let rails = self.structure.rail_count();
        let mut best: Option<Governing> = None;
        let mut on = Vec::new();
        let mut influence = Influence::zeros(2);
        for (stance, train) in plan.trains[0].iter().enumerate() {
            let (pieces, over) = (&over.pieces[0][stance], &over.on[0][stance]);
            // Deflection at x with the train at a position.
            let mut deflection = |x: f64, position: f64| -> Result<f64, Error> {
                let at = Probe { rail: carrier.rail, x, axis: axis_of_response };
                let mut sum = 0.0;
                for wheel in &train.wheels {
                    let place = position + wheel.offset;
                    for (component, force) in
                        wheel.load.iter().enumerate().filter(|(_, force)| **force != 0.0)
                    {
                        let own = Probe { rail: wheel.rail, x: place, axis: axis(component) };
                        let mut read = |probe: Probe| -> Result<f64, Error> {
                            match surface.fill(&[at, probe], &mut influence) {
                                Ok(()) => Ok(influence.value[(0, 1)]),
                                Err(splines::Error::OffRail { .. }) => Ok(0.0),
                                Err(error) => Err(error.into()),
                            }
                        };
                        let mut value = read(own)?;
                        if component >= 3 {
                            value = read(Probe { rail: wheel.rail + rails, ..own })? - value;
                        }
                        sum += direction * force * value;
                    }
                }
                Ok(sum)
            };
            for (index, piece) in pieces.list.iter().enumerate() {
                over.wheels(pieces, index, &mut on);
                for wheel in &on {
                    let limits = window.map(|x| (carrier.place(x) - wheel.start) / wheel.rate);
                    let from = limits[0].min(limits[1]).max(0.0);
                    let to = limits[0].max(limits[1]).min(piece.length());
                    if from > to {
                        continue;
                    }
                    let first = piece.position[0] + from;
                    let place = |t: f64| wheel.start + wheel.rate * (from + t);
                    let live = sampled(to - from, |t| {
                        deflection(carrier.coordinate(place(t).clamp(0.0, carrier.length)), first + t)
                    })?;
                    let dead = sampled(to - from, |t| Ok(plan.dead * load.at(quantity, place(t))))?;
                    let total = Polynomial::default().plus(&live, sign).plus(&dead, sign);
                    let floor = best.as_ref().map_or(f64::NEG_INFINITY, |g| sign * g.value);
                    let Some((t, signed)) = total.largest_above(to - from, floor) else { continue };
                    let found = Governing {
                        value: sign * signed,
                        dead: dead.at(t),
                        x: carrier.coordinate(place(t).clamp(0.0, carrier.length)),
                        side: SectionSide::At,
                        trains: vec![crate::extremes::TrainPosition {
                            position: first + t,
                            stance: train.stance,
                        }],
                        coincident: [0.0; 3],
                    };
                    offer(&mut best, Some(found), sign);
                }
            }
        }
        Ok(best)
    }
}

fn line_key(rail: usize, places: &[[f64; 2]], quantity: GirderResponse) -> LineKey {
    (rail, quantity as usize, places.iter().map(|place| place.map(f64::to_bits)).collect())
}

/// Size of a component of a unit vector, 0 where it is only rounding.
fn negligible(component: f64) -> f64 {
    if component.abs() < 1e-12 { 0.0 } else { component.abs() }
}

/// The polynomial of degree six with given values at seven nodes of Chebyshev on 0..=h.
fn sampled(h: f64, mut value: impl FnMut(f64) -> Result<f64, Error>) -> Result<Polynomial, Error> {
    const COUNT: usize = 7;
    if h <= 0.0 {
        return Ok(Polynomial::new(&[value(0.0)?]));
    }
    let node = |k: usize| 0.5 - 0.5 * ((2 * k + 1) as f64 * std::f64::consts::PI / (2 * COUNT) as f64).cos();
    let nodes: [f64; COUNT] = std::array::from_fn(node);
    let mut differences = [0.0; COUNT];
    for (difference, node) in differences.iter_mut().zip(nodes) {
        *difference = value(node * h)?;
    }
    for order in 1..COUNT {
        for k in (order..COUNT).rev() {
            differences[k] = (differences[k] - differences[k - 1]) / (nodes[k] - nodes[k - order]);
        }
    }
    let mut sum = Polynomial::new(&[differences[COUNT - 1]]);
    for k in (0..COUNT - 1).rev() {
        sum = sum.times(&Polynomial::new(&[-nodes[k], 1.0])).plus(&Polynomial::new(&[differences[k]]), 1.0);
    }
    Ok(sum.stretched(h))
}
