//! Deflections of rails: extremes over spans with a proof, absolute and from the chords of spans.
//!
//! At a fixed place x the deflection is piecewise cubic in the position, so that its envelope D(x) is exact. The largest
//! D over a span is found and enclosed by bisection, with bounds of what any state can do between two places: those of
//! `alone` for one train and of `blocked` for several.

use nalgebra::Vector3;

use crate::alone::Alone;
use crate::bicubic::SecondDerivatives;
use crate::blocked::Blocked;
use crate::collect::{Accumulated, entry, offer, sign_of, spans_of, standings};
use crate::dead::DeadLoad;
use crate::error::Error;
use crate::extremes::{Governing, Request, SpanDeflection};
use crate::follow::SectionSide;
use crate::hints::Hints;
use crate::kernel::RailPoint;
use crate::overrun::Overrun;
use crate::plan::CasePlan;
use crate::rail_deflection::CarrierLines;
use crate::search::{Bend, Margin, Search};
use crate::section::Passage;
use crate::structure::{Carrier, DEFLECTIONS, GirderResponse, Structure};
use crate::train::{COMPONENTS, PlacedTrain};
use crate::under_wheels::UnderWheels;

/// Most evaluations for one extreme under one train, and under several, whose slope jumps under wheels.
pub(crate) const MOST: usize = 3000;
const MOST_OF_SEVERAL: usize = 2000;
/// Most evaluations for the largest deflection of a span from its chord.
const MOST_OF_CHORDS: usize = 120;
/// Relative gap of extremes. A ratio of span to deflection is printed with three digits.
pub(crate) const GAP: f64 = 5e-10;
const GAP_OF_CHORDS: f64 = 1e-5;

/// The deflections of one carrier in one case.
pub(crate) struct Deflections<'a> {
    pub structure: &'a Structure,
    pub request: &'a Request,
    pub used: [bool; COMPONENTS],
    pub plan: &'a CasePlan,
    pub carrier: &'a Carrier,
    pub lines: &'a CarrierLines,
    /// Dead load with the factor of the case.
    pub dead: &'a DeadLoad,
    pub over: &'a Overrun,
}

impl Deflections<'_> {
    /// Extremes over all spans, added to those of the internal forces, which bound the curvature.
    pub fn extremes(&self, all: &mut Accumulated) -> Result<(), Error> {
        for (span, window) in spans_of(&self.request.spans, self.structure, self.carrier) {
            for (direction, quantity) in DEFLECTIONS.into_iter().enumerate() {
                if self.lines.deflections[direction].is_none() {
                    continue;
                }
                let bend = self.bend(&[span], all, direction)?;
                let several = bend.kinks > 0.0 && self.plan.trains.len() > 1;
                let mut largest = 0.0;
                for is_max in [true, false] {
                    let sign = sign_of(is_max);
                    let blocked = if several {
                        Some(self.blocked(direction, sign, bend)?)
                    } else {
                        None
                    };
                    let entry = entry(all, self.carrier.rail, span, quantity, is_max);
                    let (best, bound) = if self.plan.trains.len() == 1 {
                        let size = largest;
                        let known = entry
                            .governing
                            .as_ref()
                            .map_or(f64::NEG_INFINITY, |g| sign * g.value);
                        self.alone(direction, sign, window, bend.kinks, (known, size))
                    } else {
                        let margin: Margin<'_> = match &blocked {
                            Some(blocked) => Box::new(|x| blocked.margin(x)),
                            None => Box::new(move |x| bend.margin(x)),
                        };
                        let mut hints = Hints::default();
                        let value = |x| {
                            Ok(self.best(
                                self.over,
                                Some(self.dead),
                                direction,
                                sign,
                                x,
                                &mut hints,
                            ))
                        };
                        let mut search = Search::new(sign, margin, window, value);
                        if several {
                            search.most = MOST_OF_SEVERAL;
                        }
                        search.run()?;
                        if !search.is_closed() {
                            search.polish((window[1] - window[0]) / 40.0)?;
                        }
                        (search.best, search.bound)
                    };
                    offer(&mut entry.governing, best, sign);
                    largest = entry
                        .governing
                        .as_ref()
                        .map_or(largest, |g| largest.max(g.value.abs()));
                    entry.bound = Some(bound.max(entry.bound.unwrap_or(f64::NEG_INFINITY)));
                }
            }
        }
        Ok(())
    }

    /// The largest value of sign times a deflection in a window under a single train, with its bound.
    fn alone(
        &self,
        direction: usize,
        sign: f64,
        window: [f64; 2],
        kinks: f64,
        (known, size): (f64, f64),
    ) -> (Option<Governing>, f64) {
        let under = if kinks > 0.0 {
            let window = window.map(|x| self.carrier.place(x));
            let under = UnderWheels {
                direction,
                sign,
                window,
                dead: Some(self.dead),
            };
            under.largest(self.plan, self.over, self.carrier)
        } else {
            None
        };
        let search = Alone {
            plan: self.plan,
            over: self.over,
            carrier: self.carrier,
            quantity: DEFLECTIONS[direction],
            sign,
            window,
            dead: Some(self.dead),
            kinks,
            gap: GAP,
            size,
            most: MOST,
        };
        search.enclosed(under, known)
    }

    /// The governing state for a deflection at x. `hints` has those of other places, and receives this one.
    fn best(
        &self,
        over: &Overrun,
        dead: Option<&DeadLoad>,
        direction: usize,
        sign: f64,
        x: f64,
        hints: &mut Hints,
    ) -> Option<Governing> {
        let quantity = DEFLECTIONS[direction];
        let s = self.carrier.place(x);
        let found = over.best(self.plan, quantity as usize, sign, s, &hints.beside(x))?;
        let dead = dead.map_or(0.0, |dead| dead.at(quantity, s));
        let governing = Governing {
            value: sign * found.signed + dead,
            dead,
            x,
            side: SectionSide::At,
            trains: standings(self.plan, &found),
            coincident: [0.0; 3],
        };
        hints.add(x, found);
        Some(governing)
    }

    /// What bounds a deflection under several trains between two places.
    fn blocked(&self, direction: usize, sign: f64, bend: Bend) -> Result<Blocked, Error> {
        let Some(lines) = &self.lines.deflections[direction] else {
            return Ok(Blocked::default());
        };
        let bounds = SecondDerivatives::new(self.structure, self.carrier, direction, lines)?;
        let of_train = |stances: &Vec<PlacedTrain>| {
            stances
                .iter()
                .map(|train| bounds.of_train(train, sign))
                .fold(0.0, f64::max)
        };
        let rate = self.carrier.rate();
        let dead = self.dead.bend(DEFLECTIONS[direction], self.carrier.length) * rate * rate;
        let curvature = self.plan.trains.iter().map(of_train).sum::<f64>() + dead;
        let bend = Bend { curvature, ..bend };
        Ok(Blocked::of_deflection(
            self.structure,
            self.plan,
            self.over,
            self.carrier,
            bend,
        ))
    }

    /// Largest deflections of spans from their chords, without dead load, added to those of other carriers.
    pub fn beside_chords(
        &self,
        all: &mut Accumulated,
        out: &mut Vec<SpanDeflection>,
    ) -> Result<(), Error> {
        for (direction, quantity) in DEFLECTIONS.into_iter().enumerate() {
            if self.lines.deflections[direction].is_none() {
                continue;
            }
            let spans = self.request.chords(direction);
            for (span, window) in spans_of(spans, self.structure, self.carrier) {
                let ends = &spans[self.carrier.rail];
                if span == 0 || span >= ends.len() {
                    continue;
                }
                let ends = [ends[span - 1], ends[span]];
                for governing in self.beside_chord(direction, ends, window, all)? {
                    let rail = self.carrier.rail;
                    let known = out.iter_mut().rev().find(|known| {
                        (known.rail, known.span, known.quantity) == (rail, span, quantity)
                    });
                    match known {
                        Some(known) if governing.value.abs() > known.governing.value.abs() => {
                            known.governing = governing;
                        }
                        Some(_) => {}
                        None => out.push(SpanDeflection {
                            rail,
                            span,
                            ends,
                            quantity,
                            governing,
                        }),
                    }
                }
            }
        }
        Ok(())
    }

    /// The largest and the smallest deflection in a window from the chord between two ends.
    fn beside_chord(
        &self,
        direction: usize,
        ends: [f64; 2],
        window: [f64; 2],
        all: &mut Accumulated,
    ) -> Result<Vec<Governing>, Error> {
        let (structure, carrier, plan) = (self.structure, self.carrier, self.plan);
        let mut lines = [None, None];
        lines[direction] = structure.deflection_lines(carrier, direction, Some(ends), self.used)?;
        let Some(over) = Overrun::of_deflections(structure, plan, carrier, lines)? else {
            return Ok(Vec::new());
        };
        let slack = structure.slack();
        let inside = |part: &(usize, [f64; 2])| {
            part.1[0] < window[1] - slack && part.1[1] > window[0] + slack
        };
        let spans = spans_of(&self.request.spans, structure, carrier);
        let spans: Vec<usize> = spans
            .into_iter()
            .filter(inside)
            .map(|part| part.0)
            .collect();
        let bend = self.bend(&spans, all, direction)?;
        let mut out = Vec::new();
        for sign in [1.0, -1.0] {
            let found = if plan.trains.len() == 1 {
                let search = Alone {
                    plan,
                    over: &over,
                    carrier,
                    quantity: DEFLECTIONS[direction],
                    sign,
                    window,
                    dead: None,
                    kinks: bend.kinks,
                    gap: GAP_OF_CHORDS,
                    size: 0.0,
                    most: MOST_OF_CHORDS,
                };
                search.enclosed(None, f64::NEG_INFINITY).0
            } else {
                let mut hints = Hints::default();
                let value = |x| Ok(self.best(&over, None, direction, sign, x, &mut hints));
                let margin: Margin<'_> = if bend.kinks > 0.0 {
                    let blocked = self.blocked(direction, sign, bend)?;
                    Box::new(move |x| blocked.margin(x))
                } else {
                    Box::new(move |x| bend.margin(x))
                };
                let mut search = Search::new(sign, margin, window, value);
                search.gap = GAP_OF_CHORDS;
                search.most = MOST_OF_CHORDS;
                search.run()?;
                search.best
            };
            out.extend(found);
        }
        Ok(out)
    }

    /// How a deflection can bend within spans: bounds from the extremes of the internal forces.
    fn bend(
        &self,
        spans: &[usize],
        all: &mut Accumulated,
        direction: usize,
    ) -> Result<Bend, Error> {
        let mut most = |quantity: GirderResponse| -> f64 {
            let mut of = |span, is_max| {
                let entry = entry(all, self.carrier.rail, span, quantity, is_max);
                entry
                    .governing
                    .as_ref()
                    .map_or(0.0, |g| g.value.abs() + g.dead.abs())
            };
            spans.iter().fold(0.0, |most: f64, &span| {
                most.max(of(span, true)).max(of(span, false))
            })
        };
        let point = RailPoint::new(self.structure, self.carrier)?;
        let [t, u, z] = self.carrier.triad;
        let [_, y_axis, z_axis] = point.axes;
        let along = |v: &Vector3<f64>| negligible(v.dot(&point.directions[direction]));
        // Moments and shear forces about and along the axes of the section are at most the sums of their projections.
        let mut project =
            |plane: [GirderResponse; 2], axis: &Vector3<f64>, other: [&Vector3<f64>; 2]| {
                most(plane[0]) * negligible(axis.dot(other[0]))
                    + most(plane[1]) * negligible(axis.dot(other[1]))
            };
        let moments = [
            GirderResponse::VerticalMoment,
            GirderResponse::LateralMoment,
        ];
        let shears = [GirderResponse::VerticalShear, GirderResponse::LateralShear];
        let (moment_z, moment_y) = (
            project(moments, &z_axis, [&z, &u]),
            project(moments, &y_axis, [&z, &u]),
        );
        // By how much the rates of moments under dead load exceed the shear forces: couples of loads beside the axis.
        let couples: f64 = moments
            .into_iter()
            .zip(shears)
            .map(|(moment, shear)| {
                let [_, a, b, c] = self.dead.cubic(moment as usize);
                let rate = [a, 2.0 * b, 3.0 * c, 0.0];
                let beyond = rate.iter().zip(self.dead.cubic(shear as usize));
                let add = |sum: f64, (m, v): (&f64, f64)| sum * self.carrier.length + (m - v).abs();
                beyond.rev().fold(0.0, add)
            })
            .sum();
        let (shear_y, shear_z) = (
            project(shears, &y_axis, [&u, &z]) + couples,
            project(shears, &z_axis, [&u, &z]) + couples,
        );
        let rate = |k: GirderResponse| self.dead.cubic(k as usize)[1].abs();
        let distributed = rate(GirderResponse::VerticalShear) + rate(GirderResponse::LateralShear);
        let [twisted, bending_y, bending_z] = point.bending;
        let [stretched, sheared_y, sheared_z] = point.shear;
        let [_, mu_y, mu_z] = point.stiffening;
        let curvature = along(&y_axis) * (moment_z * bending_z + distributed * sheared_y) / mu_y
            + along(&z_axis) * (moment_y * bending_y + distributed * sheared_z) / mu_z
            + along(&z_axis.cross(&point.arm)) * shear_y * bending_z
            + along(&y_axis.cross(&point.arm)) * shear_z * bending_y
            + along(&t.cross(&point.arm)) * twisted * rate(GirderResponse::Torsion)
            + along(&t) * stretched * rate(GirderResponse::Normal);
        let scale = self.carrier.rate();
        let of_train = |stances: &Vec<Passage>| {
            stances
                .iter()
                .map(|passage| passage.on.kinks(direction))
                .fold(0.0, f64::max)
        };
        let kinks: f64 = self.over.passages.iter().map(of_train).sum();
        Ok(Bend {
            curvature: curvature * scale * scale,
            kinks: kinks * scale,
        })
    }
}

/// Size of a component of a unit vector, 0 where it is only rounding.
fn negligible(component: f64) -> f64 {
    if component.abs() < 1e-12 {
        0.0
    } else {
        component.abs()
    }
}
