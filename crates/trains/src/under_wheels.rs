//! The largest deflection under the wheels of a single train.
//!
//! A section that follows a wheel has a place that is linear in the position. Its deflection, cubic in the place with
//! coefficients that are cubic in the position, is then of degree six, as long as no other wheel passes it.

use crate::collect::offer;
use crate::dead::DeadLoad;
use crate::extremes::{Governing, TrainPosition};
use crate::follow::SectionSide;
use crate::line::shifted;
use crate::overrun::Overrun;
use crate::plan::CasePlan;
use crate::polynomial::Polynomial;
use crate::section::{Passage, WheelOnMember};
use crate::structure::{Carrier, DEFLECTIONS};

/// A deflection within a window of places, counted from the first end of the carrier, with the dead load of the case.
pub(crate) struct UnderWheels<'a> {
    pub direction: usize,
    pub sign: f64,
    pub window: [f64; 2],
    pub dead: Option<&'a DeadLoad>,
}

impl UnderWheels<'_> {
    /// The governing state; `None` where no wheel stands within the window.
    pub fn largest(&self, plan: &CasePlan, over: &Overrun, carrier: &Carrier) -> Option<Governing> {
        let mut best: Option<Governing> = None;
        let k = DEFLECTIONS[self.direction] as usize;
        for &stance in over.distinct(k, 0) {
            let passage = &over.passages[0][stance];
            let more = self.dead.map_or(0.0, |dead| {
                dead.bound(DEFLECTIONS[self.direction], self.sign, self.window)
            });
            for (index, piece) in passage.pieces.list.iter().enumerate() {
                let floor = best
                    .as_ref()
                    .map_or(f64::NEG_INFINITY, |g| self.sign * g.value);
                if over.bounds(stance).over_all(k, self.sign, index) + more <= floor {
                    continue;
                }
                let wheels = passage.wheels(index);
                for (own, wheel) in wheels.iter().enumerate() {
                    let limits = self.window.map(|s| (s - wheel.start) / wheel.rate);
                    let from = limits[0].min(limits[1]).max(0.0);
                    let to = limits[0].max(limits[1]).min(piece.length());
                    if from > to {
                        continue;
                    }
                    for [from, to] in between_meetings(wheels, own, from, to) {
                        let place = Polynomial::new(&[wheel.start + wheel.rate * from, wheel.rate]);
                        let live = self.following(passage, index, own, [from, to], &place);
                        let dead = self.dead.map_or(Polynomial::default(), |dead| {
                            dead.deflection_along(self.direction, &place)
                        });
                        let total = Polynomial::default()
                            .plus(&live, self.sign)
                            .plus(&dead, self.sign);
                        let floor = best
                            .as_ref()
                            .map_or(f64::NEG_INFINITY, |g| self.sign * g.value);
                        let Some((t, signed)) = total.largest_above(to - from, floor) else {
                            continue;
                        };
                        let found = Governing {
                            value: self.sign * signed,
                            dead: dead.at(t),
                            x: carrier.coordinate(place.at(t).clamp(0.0, carrier.length)),
                            side: SectionSide::At,
                            trains: vec![TrainPosition {
                                position: piece.position[0] + from + t,
                                stance: plan.trains[0][stance].stance,
                            }],
                            coincident: [0.0; 3],
                        };
                        offer(&mut best, Some(found), self.sign);
                    }
                }
            }
        }
        best
    }

    /// The deflection at a place that moves with a wheel, between two distances from the first position of a piece.
    fn following(
        &self,
        passage: &Passage,
        piece: usize,
        own: usize,
        [from, to]: [f64; 2],
        place: &Polynomial,
    ) -> Polynomial {
        let Some(pieces) = &passage.deflections[self.direction] else {
            return Polynomial::default();
        };
        let length = passage.on.length();
        let u = Polynomial::default().plus(place, 1.0 / length);
        let mut sum = Polynomial::default();
        for cubic in pieces.list[piece].cubics.iter().rev() {
            sum = sum
                .times(&u)
                .plus(&Polynomial::new(&shifted(cubic, from)), 1.0);
        }
        let wheels = passage.wheels(piece);
        let at = |wheel: &WheelOnMember, t: f64| wheel.start + wheel.rate * t;
        let middle = 0.5 * (from + to);
        for (index, wheel) in wheels.iter().enumerate() {
            let distance = at(&wheels[own], middle) - at(wheel, middle);
            if index != own && distance > 0.0 {
                let first = at(&wheels[own], from) - at(wheel, from);
                let rate = wheel.rate - wheels[own].rate;
                sum = sum.plus(
                    &Polynomial::new(&wheel.kernel(self.direction).passing(first, rate)),
                    1.0,
                );
            }
        }
        sum
    }
}

/// The parts of a stretch of positions between the meetings of a wheel with others that move against it.
fn between_meetings(wheels: &[WheelOnMember], own: usize, from: f64, to: f64) -> Vec<[f64; 2]> {
    let wheel = &wheels[own];
    let meeting = |other: &WheelOnMember| {
        let rate = other.rate - wheel.rate;
        (rate != 0.0).then(|| (wheel.start - other.start) / rate)
    };
    let mut ends: Vec<f64> = wheels
        .iter()
        .filter_map(meeting)
        .filter(|t| *t > from && *t < to)
        .collect();
    ends.push(to);
    ends.sort_by(f64::total_cmp);
    let mut first = from;
    ends.into_iter()
        .map(|end| [std::mem::replace(&mut first, end), end])
        .collect()
}
