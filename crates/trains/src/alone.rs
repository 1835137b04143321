//! The largest deflection of a carrier under a single train, or the largest moment or shear force under axial force, enclosed
//! by bisection of the places.
//!
//! Between two places the deflection w of one state bulges: minus its second derivative is at most k, except for kinks
//! under wheels. The largest deflection W under the wheels is exact (`under_wheels`); what exceeds it is smooth where it
//! is largest. So no state exceeds, on an interval of length h that is shorter than the distance between wheels,
//!
//! max(W, w at both ends + k h^2/2),    without kinks    w at both ends + k h^2/8.
//!
//! With n kinks in the interval, s being the sum of the jumps of the slope, w at both ends + k h^2/8 + s h/4 holds as well.
//! A force under axial force jumps at wheels. With W, its largest value on either side of all wheels, known, no state exceeds
//!
//! max(W, both ends) + k h^2/8,    and on an interval shorter than the distance between wheels    max(W, ends + k h^2/2).
//!
//! This is true of each piece of the positions by itself, so that an interval keeps only those pieces that can hold more
//! than the best value, and the deeper the bisection is, the fewer are evaluated.

use std::rc::Rc;

use crate::collect::offer;
use crate::dead::DeadLoad;
use crate::extremes::{Governing, TrainPosition};
use crate::follow::SectionSide;
use crate::overrun::Overrun;
use crate::plan::{CasePlan, Standing};
use crate::structure::{Carrier, GirderResponse, QUANTITIES};

/// Parts of a window from which the bisection starts.
const PARTS: usize = 4;

/// What is sought: the largest value of sign times a deflection, or a force, within a window of places.
pub(crate) struct Alone<'a> {
    pub plan: &'a CasePlan,
    pub over: &'a Overrun,
    pub carrier: &'a Carrier,
    pub quantity: GirderResponse,
    pub sign: f64,
    pub window: [f64; 2],
    /// Dead load with the factor of the case; `None` where it does not count.
    pub dead: Option<&'a DeadLoad>,
    /// The sum of the jumps of its slope at all wheels, by rail coordinate.
    pub kinks: f64,
    /// Distance between the largest value found and the bound of all others, relative to it or to `size`.
    pub gap: f64,
    pub size: f64,
    /// Most evaluations.
    pub most: usize,
}

/// Pieces that can hold the largest value: stance and piece.
type Active = Rc<Vec<[usize; 2]>>;

/// An interval of places with bounds of each of its pieces at both ends.
struct Interval {
    x: [f64; 2],
    active: Active,
    values: [Vec<f64>; 2],
    /// Bound of all its pieces.
    bound: f64,
}

/// The best state so far, and the largest size of a value.
#[derive(Default)]
struct Found {
    best: Option<Governing>,
    largest: f64,
}

impl Alone<'_> {
    /// The governing state, and what sign times the deflection nowhere exceeds. `under_wheels` is the largest value under
    /// the wheels, where the slope has kinks; `known` is sign times a value below which nothing is sought.
    pub fn enclosed(
        &self,
        under_wheels: Option<Governing>,
        known: f64,
    ) -> (Option<Governing>, f64) {
        let is_force = (self.quantity as usize) < QUANTITIES;
        let follows = under_wheels.is_some() || is_force;
        let mut found = Found {
            largest: self.size,
            best: under_wheels,
        };
        let [from, to] = self.window;
        let all: Active = Rc::new(self.active(&mut found, known));
        let place = |k: usize| {
            if k == PARTS {
                to
            } else {
                from + (to - from) * k as f64 / PARTS as f64
            }
        };
        let ends: Vec<Vec<f64>> = (0..=PARTS)
            .map(|k| self.evaluate(place(k), &all, f64::NEG_INFINITY, &mut found))
            .collect();
        let spacing = self
            .over
            .all()
            .map(|p| p.on.least_distance())
            .fold(f64::INFINITY, f64::min);
        let spacing = spacing / self.carrier.rate();
        let bulge = self.bulges();
        let margin = |x: [f64; 2], at: &[usize; 2]| {
            let h = x[1] - x[0];
            let own = bulge(at) * h * h;
            let all = if is_force {
                f64::INFINITY
            } else {
                own / 8.0 + self.kinks * h / 4.0
            };
            if follows && h < spacing {
                all.min(own / 2.0)
            } else {
                all
            }
        };
        // What is known under wheels, for forces: sign times their values there are no larger.
        let beside = found
            .best
            .as_ref()
            .map_or(known, |g| known.max(self.sign * g.value));
        let most_within = |x: [f64; 2], at: &[usize; 2], ends: f64| {
            if !is_force {
                return ends + margin(x, at);
            }
            let h = x[1] - x[0];
            (ends + margin(x, at)).min(ends.max(beside) + bulge(at) * h * h / 8.0)
        };
        let limit = |found: &Found| {
            let best = found
                .best
                .as_ref()
                .map_or(known, |g| known.max(self.sign * g.value));
            best + self.gap * found.largest
        };
        let mut open: Vec<Interval> = Vec::new();
        for k in 0..PARTS {
            let [a, b] = [&ends[k], &ends[k + 1]];
            open.extend(interval(
                [place(k), place(k + 1)],
                &all,
                [a, b],
                &most_within,
                limit(&found),
            ));
        }
        let mut evaluations = PARTS + 1;
        loop {
            let most = limit(&found);
            open.retain(|interval| interval.bound > most);
            let widest = (0..open.len()).max_by(|&a, &b| open[a].bound.total_cmp(&open[b].bound));
            let Some(widest) = widest else {
                return (found.best, most);
            };
            if evaluations >= self.most {
                return (found.best, open[widest].bound);
            }
            let Interval {
                x, active, values, ..
            } = open.swap_remove(widest);
            let middle = 0.5 * (x[0] + x[1]);
            let halves = [[x[0], middle], [middle, x[1]]];
            // Pieces that stay below this are left out of both halves, whatever their value is.
            let largest = active
                .iter()
                .map(|at| margin(halves[0], at).max(margin(halves[1], at)));
            let floor = most - largest.fold(0.0, f64::max);
            let at_middle = self.evaluate(middle, &active, floor, &mut found);
            evaluations += 1;
            let most = limit(&found);
            let [a, b] = &values;
            open.extend(interval(
                halves[0],
                &active,
                [a, &at_middle],
                &most_within,
                most,
            ));
            open.extend(interval(
                halves[1],
                &active,
                [&at_middle, b],
                &most_within,
                most,
            ));
        }
    }

    /// By how much a state of a piece can bulge, dead load included, by rail coordinate.
    fn bulges(&self) -> impl Fn(&[usize; 2]) -> f64 {
        let rate = self.carrier.rate();
        let k = self.quantity as usize;
        let dead = self
            .dead
            .map_or(0.0, |dead| dead.bend(self.quantity, self.carrier.length));
        move |&[stance, piece]| {
            (self.over.bounds(stance).bulge(k, self.sign, piece) + dead) * rate * rate
        }
    }

    /// The pieces that can exceed the value at the middle of the window, and what is known.
    fn active(&self, found: &mut Found, known: f64) -> Vec<[usize; 2]> {
        let k = self.quantity as usize;
        let middle = 0.5 * (self.window[0] + self.window[1]);
        let hint = self
            .over
            .best(self.plan, k, self.sign, self.carrier.place(middle), &[]);
        if let Some(Standing {
            stance,
            origin: [piece, _],
            ..
        }) = hint.map(|hint| hint.trains[0])
        {
            self.evaluate(
                middle,
                &Rc::new(vec![[stance, piece]]),
                f64::NEG_INFINITY,
                found,
            );
        }
        let best = found
            .best
            .as_ref()
            .map_or(known, |g| known.max(self.sign * g.value));
        let places = self.window.map(|x| self.carrier.place(x));
        let dead = self
            .dead
            .map_or(0.0, |dead| dead.bound(self.quantity, self.sign, places));
        self.over.pieces_above(k, self.sign, best - dead)
    }

    /// Sign times the largest deflection at x in each of some pieces; for pieces that do not reach `floor` a bound below
    /// it. The best is offered.
    fn evaluate(&self, x: f64, active: &Active, floor: f64, found: &mut Found) -> Vec<f64> {
        let s = self.carrier.place(x);
        let k = self.quantity as usize;
        let dead = self.dead.map_or(0.0, |dead| dead.at(self.quantity, s));
        let below = self.sign * dead;
        let mut out = Vec::with_capacity(active.len());
        for &[stance, piece] in active.iter() {
            let mut most = f64::NEG_INFINITY;
            self.over.passages[0][stance].parts(piece, k, s, |part| {
                let bound = part.bound(self.sign) + below;
                if bound < floor {
                    most = most.max(bound);
                    return;
                }
                let (position, signed) = part.largest(self.sign);
                let signed = signed + below;
                most = most.max(signed);
                found.largest = found.largest.max(signed.abs());
                if found
                    .best
                    .as_ref()
                    .is_some_and(|best| signed < self.sign * best.value - 1e-9 * signed.abs())
                {
                    return;
                }
                let standing = TrainPosition {
                    position,
                    stance: self.plan.trains[0][stance].stance,
                };
                let governing = Governing {
                    value: self.sign * signed,
                    dead,
                    x,
                    side: SectionSide::At,
                    trains: vec![standing],
                    coincident: [0.0; 3],
                };
                offer(&mut found.best, Some(governing), self.sign);
            });
            out.push(most);
        }
        out
    }
}

/// An interval with those of its pieces that can exceed the limit; `None` where there is none.
fn interval(
    x: [f64; 2],
    active: &Active,
    values: [&Vec<f64>; 2],
    most_within: &impl Fn([f64; 2], &[usize; 2], f64) -> f64,
    limit: f64,
) -> Option<Interval> {
    let [a, b] = values;
    let most = |k: usize| most_within(x, &active[k], a[k].max(b[k]));
    let keeps: Vec<usize> = (0..active.len()).filter(|&k| most(k) > limit).collect();
    let bound = keeps.iter().map(|&k| most(k)).reduce(f64::max)?;
    let take = |values: &Vec<f64>| keeps.iter().map(|&k| values[k]).collect();
    let active = if keeps.len() == active.len() {
        Rc::clone(active)
    } else {
        Rc::new(keeps.iter().map(|&k| active[k]).collect())
    };
    Some(Interval {
        x,
        active,
        values: [take(a), take(b)],
        bound,
    })
}
