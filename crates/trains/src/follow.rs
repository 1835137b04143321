//! Extremes of internal forces over all sections of a member.
//!
//! At a fixed position of the train a quantity changes along the member linearly between wheels, a moment quadratically
//! where the dead load is distributed. It is extreme at an end of the member, just before or behind a wheel, or where a
//! moment has a vertex. A section that follows a wheel has quantities of degree at most four in the position, and the
//! value at a vertex, a - b^2/(4 c) with a and b cubic, is of degree six. Ends of the member are fixed sections
//! (`section`); this file does the others. On a part of a member under axial force, moments and shear forces are cubic
//! between wheels: beside wheels they are of degree six, and `alone` encloses them elsewhere.

use crate::bounds::Bounds;
use crate::dead::DeadLoad;
use crate::line::shifted;
use crate::plan::TIE;
use crate::polynomial::Polynomial;
use crate::running::PiecewiseFunction;
use crate::section::{Passage, TrainOnCarrier, WheelOnMember, slope_index};
use crate::structure::{GirderResponse, QUANTITIES};

/// Which side of a wheel a section is on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SectionSide {
    /// Just before it, at the smaller coordinate.
    Before,
    /// At the coordinate itself.
    #[default]
    At,
    /// Just behind it.
    Behind,
}

/// An extreme on a member: the section and the position.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Peak {
    /// Sign times value, dead load included.
    pub signed: f64,
    pub place: f64,
    pub side: SectionSide,
    pub position: f64,
}

/// What is sought: the largest value of sign times quantity k with dead load, for places within a window.
pub(crate) struct Target<'a> {
    pub k: usize,
    pub sign: f64,
    pub window: [f64; 2],
    pub dead: &'a DeadLoad,
}

impl Passage {
    /// The largest value of a target at sections beside wheels and at vertices; `None` where there is none above
    /// `floor`.
    pub fn follow(&self, bounds: &Bounds, target: &Target<'_>, floor: f64) -> Option<Peak> {
        let mut best: Option<Peak> = None;
        let dead = target
            .dead
            .bound(GirderResponse::ALL[target.k], target.sign, target.window);
        for (index, piece) in self.pieces.list.iter().enumerate() {
            let limit = limit_of(&best, floor);
            if bounds.over_all(target.k, target.sign, index) + dead <= limit {
                continue;
            }
            let wheels = self.wheels(index);
            let state = State {
                base: &piece.cubics,
                wheels,
                on: &self.on,
            };
            let h = piece.length();
            for (j, wheel) in wheels.iter().enumerate() {
                // Positions at which the wheel is within the window.
                let times = target.window.map(|s| (s - wheel.start) / wheel.rate);
                let [from, to] = [
                    times[0].min(times[1]).max(0.0),
                    times[0].max(times[1]).min(h),
                ];
                if from > to {
                    continue;
                }
                for side in [SectionSide::Before, SectionSide::Behind] {
                    let count = if side == SectionSide::Before {
                        j
                    } else {
                        j + 1
                    };
                    let place = Polynomial::new(&[wheel.start + wheel.rate * from, wheel.rate]);
                    let of = |k: usize| state.quantity(k, &place, from, count);
                    let live = of(target.k);
                    let dead = target.dead.along(target.k, &place);
                    let total = Polynomial::default()
                        .plus(&live, target.sign)
                        .plus(&dead, target.sign);
                    let limit = limit_of(&best, floor);
                    if let Some((t, signed)) = total.largest_above(to - from, limit)
                        && signed > limit
                    {
                        best = Some(Peak {
                            signed,
                            place: place.at(t),
                            side,
                            position: piece.position[0] + from + t,
                        });
                    }
                }
            }
            self.vertices(&state, [piece.position[0], h], target, floor, &mut best);
        }
        best
    }

    /// Sign times the target, a force without dead load's curvature, at the section beside a wheel while it is within the
    /// window, as a function of the position.
    pub fn beside(
        &self,
        target: &Target<'_>,
        wheel: usize,
        side: SectionSide,
        stance: usize,
    ) -> PiecewiseFunction {
        let mut out = PiecewiseFunction::default();
        for (index, piece) in self.pieces.list.iter().enumerate() {
            let wheels = self.wheels(index);
            let Some(j) = wheels.iter().position(|on| on.wheel == wheel) else {
                continue;
            };
            let times = target
                .window
                .map(|s| (s - wheels[j].start) / wheels[j].rate);
            let from = times[0].min(times[1]).max(0.0);
            let to = times[0].max(times[1]).min(piece.length());
            if from > to {
                continue;
            }
            let state = State {
                base: &piece.cubics,
                wheels,
                on: &self.on,
            };
            let place = Polynomial::new(&[wheels[j].start + wheels[j].rate * from, wheels[j].rate]);
            let live = state.quantity(
                target.k,
                &place,
                from,
                j + usize::from(side == SectionSide::Behind),
            );
            let dead = target.dead.along(target.k, &place);
            let total = Polynomial::default()
                .plus(&live, target.sign)
                .plus(&dead, target.sign);
            let first = piece.position[0];
            let last = if to >= piece.length() {
                piece.position[1]
            } else {
                first + to
            };
            // At an end of the window the section is at the wheel on either side of it.
            let at_end = [from, to].map(|t| times.contains(&t));
            out.push([first + from, last], total, stance, at_end);
        }
        out
    }

    /// Vertices of a moment between neighbouring loads, where the dead load bends it.
    fn vertices(
        &self,
        state: &State<'_>,
        [position, h]: [f64; 2],
        target: &Target<'_>,
        floor: f64,
        best: &mut Option<Peak>,
    ) {
        let Some(shear) = slope_index(target.k) else {
            return;
        };
        let [a, b, c, _] = target.dead.cubic(target.k);
        if target.sign * c >= 0.0 || self.on.bent().is_some() {
            return;
        }
        for count in 0..=state.wheels.len() {
            // moment = value + slope s + c s^2 between wheel `count` and the next.
            let start = Polynomial::new(&[0.0]);
            let value = state
                .quantity(target.k, &start, 0.0, count)
                .plus(&Polynomial::new(&[a]), 1.0);
            let slope = state
                .quantity(shear, &start, 0.0, count)
                .plus(&Polynomial::new(&[b]), 1.0);
            let total = value.plus(&slope.times(&slope), -0.25 / c);
            let signed = Polynomial::default().plus(&total, target.sign);
            let limit = limit_of(best, floor);
            if signed.bound(h) <= limit {
                continue;
            }
            for &t in signed.candidates(h).list() {
                let place = -0.5 * slope.at(t) / c;
                let at = |wheel: Option<&WheelOnMember>, end: f64| {
                    wheel.map_or(end, |wheel| wheel.start + wheel.rate * t)
                };
                let from = at(count.checked_sub(1).and_then(|k| state.wheels.get(k)), 0.0);
                let to = at(state.wheels.get(count), self.on.length());
                let inside =
                    place >= from.max(target.window[0]) && place <= to.min(target.window[1]);
                let limit = limit_of(best, floor);
                if inside && signed.at(t) > limit {
                    *best = Some(Peak {
                        signed: signed.at(t),
                        place,
                        side: SectionSide::At,
                        position: position + t,
                    });
                }
            }
        }
    }
}

/// What a value must exceed to replace the best: of equal ones the first counts.
fn limit_of(best: &Option<Peak>, floor: f64) -> f64 {
    best.map_or(floor, |best| best.signed + TIE * best.signed.abs())
}

/// The quantities at the end of the member and the wheels on it, in one piece.
struct State<'a> {
    base: &'a [[f64; 4]; QUANTITIES],
    wheels: &'a [WheelOnMember],
    on: &'a TrainOnCarrier,
}

impl State<'_> {
    /// Response k at a place that is linear in the distance from position `from` of the piece, the first `count` wheels
    /// counted as before it.
    fn quantity(&self, k: usize, place: &Polynomial, from: f64, count: usize) -> Polynomial {
        let base = |k: usize| Polynomial::new(&shifted(&self.base[k], from));
        let own =
            |wheel: &WheelOnMember| Polynomial::new(&[wheel.start + wheel.rate * from, wheel.rate]);
        if let Some(row) = self.on.bent_row(k) {
            let of_ends = row.fold(Polynomial::default(), |sum, (cubic, of)| {
                sum.plus(&along(cubic, place).times(&base(of)), 1.0)
            });
            return self.wheels[..count].iter().fold(of_ends, |sum, wheel| {
                sum.plus(&along(wheel.behind(k), &place.plus(&own(wheel), -1.0)), 1.0)
            });
        }
        let mut out = base(k);
        if let Some(shear) = slope_index(k) {
            out = out.plus(&base(shear).times(place), 1.0);
        }
        for wheel in &self.wheels[..count] {
            out = out.plus(&Polynomial::new(&[wheel.jump(k)]), 1.0);
            if let Some(shear) = slope_index(k) {
                out = out
                    .plus(place, wheel.jump(shear))
                    .plus(&own(wheel), -wheel.jump(shear));
            }
        }
        out
    }
}

/// A cubic of a place that is linear in the position.
fn along([a, b, c, d]: &[f64; 4], place: &Polynomial) -> Polynomial {
    [c, b, a]
        .into_iter()
        .fold(Polynomial::new(&[*d]), |sum, next| {
            sum.times(place).plus(&Polynomial::new(&[*next]), 1.0)
        })
}
