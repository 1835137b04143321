//! Positions at which the trains of a case cannot all move on together, and what then bounds an envelope between two places.
//!
//! Let D(x) be the envelope of an internal force at the section x, and S a state that attains it. If every train can be
//! moved along by up to h either way together with the section, its response changes smoothly: no wheel passes the section,
//! and the second derivative is at least -C. So between two places that are h apart
//!
//! D(x) <= max(D at both ends) + C h^2/8.
//!
//! A train is blocked where it stands within h of the end of its positions or of a position at which one of its influence
//! lines has a kink or a jump, or, in turn, within h of touching a blocked train. Blocked trains are held while the others
//! move. The section then passes their wheels, which adds K h/4 to a moment, K being the sum of the jumps of its slope, and
//! G h to what jumps at wheels, G being its largest slope elsewhere. As blocked wheels are near few known places
//! only, this term is absent from all other intervals.

use crate::follow::Target;
use crate::overrun::Overrun;
use crate::pieces::{Piece, Pieces, ResponsePiece};
use crate::plan::CasePlan;
use crate::search::Bend;
use crate::section::{Passage, slope_index};
use crate::structure::{Carrier, QUANTITIES, Structure};
use crate::train::PlacedWheel;

/// Changes of an influence line at a position that are not taken for kinks or jumps, relative to its size.
const SMOOTH: f64 = 1e-9;

/// What bounds a quantity of a carrier between two places.
#[derive(Debug, Default)]
pub(crate) struct Blocked {
    /// Bounds of the second derivative, the slope, the jumps of the slope and the jumps of the value, all by rail
    /// coordinate.
    curvature: f64,
    slope: f64,
    kinks: f64,
    jumps: f64,
    /// Rail coordinates of the carrier near which a blocked wheel may stand, increasing.
    places: Vec<f64>,
    /// Whether wheels on opposed rails of the member move against each other, so that nothing moves along together.
    opposed: bool,
    /// Number of trains.
    trains: f64,
    /// Whether held wheels change the slope alone, as forces without couples do with a moment.
    only_kinks: bool,
}

impl Blocked {
    /// Collects the bounds for a target on a carrier.
    pub fn new(plan: &CasePlan, over: &Overrun, carrier: &Carrier, target: &Target<'_>) -> Blocked {
        let rate = carrier.rate();
        let shear = slope_index(target.k);
        let (mut curvature, mut slope, mut kinks, mut jumps) = (0.0, 0.0, 0.0, 0.0);
        for stances in &over.passages {
            let bends = stances.iter().map(|passage| {
                let [bend, slope] = bends(&passage.pieces, target, rate);
                let more = bent_bends(passage, target, rate);
                [bend + more[0], slope + more[1]]
            });
            let [bend, steep] =
                bends.fold([0.0; 2], |a: [f64; 2], b| [a[0].max(b[0]), a[1].max(b[1])]);
            curvature += bend;
            slope += steep;
            let most = |k: usize| {
                stances
                    .iter()
                    .map(|p| p.on.jumps(k).map(f64::abs).sum::<f64>())
                    .fold(0.0, f64::max)
            };
            jumps += most(target.k);
            if let Some(shear) = shear {
                kinks += most(shear) * rate;
                // A section that moves past held wheels changes its moment by the shear force.
                let largest = stances
                    .iter()
                    .map(|p| largest(&p.pieces, shear))
                    .fold(0.0, f64::max);
                slope += (largest + most(shear)) * rate;
            }
        }
        let [_, b, c, d] = target.dead.cubic(target.k);
        let ends =
            [0.0, carrier.length].map(|s| -target.sign * (2.0 * c + 6.0 * d * s) * rate * rate);
        curvature += ends[0].max(ends[1]).max(0.0);
        slope +=
            (b.abs() + carrier.length * (2.0 * c.abs() + 3.0 * d.abs() * carrier.length)) * rate;
        let places = places(plan, over, carrier, &|train, stance| {
            sharp_positions(&over.passages[train][stance], target)
        });
        let trains = plan.trains.len() as f64;
        let opposed = over.all().any(|passage| passage.on.has_opposed_wheels());
        let only_kinks = shear.is_some() && jumps == 0.0;
        Blocked {
            curvature,
            slope,
            kinks,
            jumps,
            places,
            opposed,
            trains,
            only_kinks,
        }
    }

    /// The bounds for a deflection of a carrier with a bound of the second derivative of every state that is moved along, and
    /// of the sum of the jumps of its slope at wheels. Its influence lines may have kinks wherever members meet.
    pub fn of_deflection(
        structure: &Structure,
        plan: &CasePlan,
        over: &Overrun,
        carrier: &Carrier,
        bend: Bend,
    ) -> Blocked {
        let places = places(plan, over, carrier, &|train, stance| {
            let of_wheel = |wheel: &PlacedWheel| {
                let stretches = structure.rails[wheel.rail].stretches.iter();
                let ends = stretches.flat_map(|stretch| stretch.ends_of_element());
                ends.map(|x| x - wheel.offset).collect::<Vec<f64>>()
            };
            let [first, last] = plan.trains[train][stance].range;
            let all = plan.trains[train][stance].wheels.iter().flat_map(of_wheel);
            all.filter(|p| *p > first && *p < last).collect()
        });
        let trains = plan.trains.len() as f64;
        let opposed = over.all().any(|passage| passage.on.has_opposed_wheels());
        let Bend { curvature, kinks } = bend;
        Blocked {
            curvature,
            slope: 0.0,
            kinks,
            jumps: 0.0,
            places,
            opposed,
            trains,
            only_kinks: true,
        }
    }

    /// By how much the envelope may exceed its values at the ends of an interval.
    pub fn margin(&self, [from, to]: [f64; 2]) -> f64 {
        let h = to - from;
        let reach = self.trains * h;
        let first = self.places.partition_point(|x| *x < from - reach);
        let near = self.places[first..]
            .iter()
            .take_while(|x| **x <= to + reach)
            .take(2)
            .count();
        let near = if self.opposed { 2 } else { near };
        let smooth = self.curvature * h * h / 8.0;
        match (near, self.only_kinks) {
            (0, _) => smooth,
            (_, true) => smooth + self.kinks * h / 4.0,
            (1, false) => smooth + self.slope * h,
            (_, false) => smooth + self.slope * h + self.jumps,
        }
    }
}

/// Bounds of minus the second derivative and of the slope of sign times a response while train and section move along
/// together, by rail coordinate: the response at place s is B(p) + s V(p), V being the shear at the end of the member.
fn bends(pieces: &Pieces<QUANTITIES>, target: &Target<'_>, rate: f64) -> [f64; 2] {
    let mut out = [0.0_f64; 2];
    for piece in &pieces.list {
        let h = piece.length();
        let [_, b, c, d] = piece.cubics[target.k].map(|c| target.sign * c);
        let [_, e, f, g] = slope_index(target.k).map_or([0.0; 4], |shear| {
            piece.cubics[shear].map(|c| target.sign * c)
        });
        // Bernstein coefficients of the slope of a cubic on 0..=h enclose it.
        let slopes = |b: f64, c: f64, d: f64| [b, b + c * h, b + 2.0 * c * h + 3.0 * d * h * h];
        let turning = slopes(e, f, g).into_iter().fold(f64::INFINITY, f64::min);
        for s in target.window {
            for t in [0.0, h] {
                let second = 2.0 * (c + s * f) + 6.0 * (d + s * g) * t;
                out[0] = out[0].max(-(second + 2.0 * rate * turning));
            }
            for (own, shear) in slopes(b, c, d).into_iter().zip(slopes(e, f, g)) {
                out[1] = out[1].max((own + s * shear).abs());
            }
        }
    }
    out
}

/// What an axial force adds to both bounds of [`bends`], wherever train and section move: all that differs from B(p) + s V(p),
/// and the curvature of what wheels that have been passed add.
fn bent_bends(passage: &Passage, target: &Target<'_>, rate: f64) -> [f64; 2] {
    let Some(row) = passage.on.bent_row(target.k) else {
        return [0.0; 2];
    };
    let shear = slope_index(target.k);
    let length = passage.on.length();
    let mut out = [0.0_f64; 2];
    let factors: Vec<([f64; 3], usize)> = row
        .map(|(cubic, of)| {
            let [a, b, c, d] = *cubic;
            let more = [
                a - f64::from(u8::from(of == target.k)),
                b - f64::from(u8::from(Some(of) == shear)),
                c,
                d,
            ];
            (sizes(&more, length), of)
        })
        .collect();
    for (index, piece) in passage.pieces.list.iter().enumerate() {
        let mut own = [0.0; 2];
        for ([value, slope, bend], of) in &factors {
            let [still, moving, turning] = sizes(&piece.cubics[*of], piece.length());
            own[0] += value * turning + 2.0 * rate * slope * moving + rate * rate * bend * still;
            own[1] += value * moving + rate * slope * still;
        }
        for wheel in passage.wheels(index) {
            let [_, b, c, d] = *wheel.behind(target.k);
            let jump = shear.map_or(0.0, |shear| wheel.jump(shear));
            let [_, slope, bend] = sizes(&[0.0, b - jump, c, d], length);
            own[0] += rate * rate * bend;
            own[1] += rate * slope;
        }
        out = [out[0].max(own[0]), out[1].max(own[1])];
    }
    out
}

/// Bounds of the sizes of a cubic, its first and its second derivative on 0..=h.
fn sizes(cubic: &[f64; 4], h: f64) -> [f64; 3] {
    let [a, b, c, d] = cubic.map(f64::abs);
    [
        a + h * (b + h * (c + h * d)),
        b + h * (2.0 * c + 3.0 * d * h),
        2.0 * c + 6.0 * d * h,
    ]
}

/// Bound of the size of response k.
fn largest(pieces: &Pieces<QUANTITIES>, k: usize) -> f64 {
    let size = |piece: &Piece<QUANTITIES>| {
        let h = piece.length();
        let [a, b, c, d] = piece.cubics[k].map(f64::abs);
        a + h * (b + h * (c + h * d))
    };
    pieces.list.iter().map(size).fold(0.0, f64::max)
}

/// Rail coordinates of the carrier near which a wheel of a blocked train may stand, increasing; `sharp` gives the positions of a train in a stance at which an influence line has a kink or a jump.
fn places(
    plan: &CasePlan,
    over: &Overrun,
    carrier: &Carrier,
    sharp: &dyn Fn(usize, usize) -> Vec<f64>,
) -> Vec<f64> {
    // Signs of forces do not move wheels: one stance each way round, with the barriers of all.
    let mut ways = Vec::new();
    let mut all: Vec<Vec<Vec<f64>>> = Vec::new();
    for (train, stances) in plan.trains.iter().enumerate() {
        let mut own: Vec<usize> = Vec::new();
        let mut barriers = vec![Vec::new(); stances.len()];
        for (stance, placed) in stances.iter().enumerate() {
            let known = own
                .iter()
                .copied()
                .find(|&k| stances[k].stance.turned == placed.stance.turned);
            let way = known.unwrap_or(stance);
            if known.is_none() {
                own.push(stance);
                barriers[way].extend(placed.range);
            }
            barriers[way].extend(sharp(train, stance));
        }
        for list in &mut barriers {
            list.sort_by(f64::total_cmp);
            list.dedup();
        }
        ways.push(own);
        all.push(barriers);
    }
    let mut out = Vec::new();
    plan.for_each_arrangement(&ways, &mut |order, stances| {
        let mut add = |k: usize, position: f64| {
            over.passages[order[k]][stances[k]]
                .on
                .coordinates(carrier, position, &mut out);
        };
        let step =
            |j: usize, k: usize| plan.distance((order[j], stances[j]), (order[k], stances[k]));
        for k in 0..order.len() {
            for &barrier in &all[order[k]][stances[k]] {
                add(k, barrier);
                // Trains that touch it, and those that touch them, on either side.
                let mut reached = vec![Vec::new(); order.len()];
                reached[k].push(barrier);
                for next in k + 1..order.len() {
                    let from = (k..next).flat_map(|j| reached[j].iter().map(move |p| (j, *p)));
                    let touching: Vec<f64> = from
                        .map(|(j, p)| p + step(j, next))
                        .filter(|p| p.is_finite())
                        .collect();
                    touching.iter().for_each(|p| add(next, *p));
                    reached[next] = touching;
                }
                for next in (0..k).rev() {
                    let from = (next + 1..=k).flat_map(|j| reached[j].iter().map(move |p| (j, *p)));
                    let touching: Vec<f64> = from
                        .map(|(j, p)| p - step(next, j))
                        .filter(|p| p.is_finite())
                        .collect();
                    touching.iter().for_each(|p| add(next, *p));
                    reached[next] = touching;
                }
            }
        }
    });
    out.sort_by(f64::total_cmp);
    out.dedup_by(|b, a| *b - *a <= 1e-12 * carrier.x[1].abs().max(carrier.x[0].abs()));
    out
}

/// Positions at which the response of a section to a train has a kink or a jump although no wheel passes the section.
fn sharp_positions(passage: &Passage, target: &Target<'_>) -> Vec<f64> {
    let mut out = Vec::new();
    let [from, to] = target.window;
    let shear = slope_index(target.k);
    // The response is linear in the place: two sections tell for all.
    for third in [1.0, 2.0] {
        let s = from + (to - from) * third / 3.0;
        let list = passage.response(target.k, s);
        let shears = shear.map(|shear| passage.response(shear, s));
        let size = |list: &[ResponsePiece]| {
            list.iter()
                .map(|piece| start(piece)[0].abs().max(end(piece)[0].abs()))
                .fold(0.0, f64::max)
        };
        let length = list.last().map_or(0.0, |last| last.position[1]) - list[0].position[0];
        let breaks = passage
            .pieces
            .list
            .iter()
            .skip(1)
            .filter(|piece| !piece.begins_inside);
        let breaks = breaks.map(|piece| piece.position[0]);
        for position in breaks {
            let after = list.partition_point(|piece| piece.position[0] < position);
            let change = |list: &[ResponsePiece]| {
                let [before, behind] = after
                    .checked_sub(1)
                    .and_then(|k| list.get(k..k + 2))
                    .map(|pair| [pair[0], pair[1]])?;
                let ([a, b], [c, d]) = (end(&before), start(&behind));
                Some([c - a, d - b])
            };
            let Some([jump, kink]) = change(&list) else {
                continue;
            };
            let sharp = jump.abs() > SMOOTH * size(&list)
                || kink.abs() * length > 10.0 * SMOOTH * size(&list)
                || shears.as_ref().is_some_and(|list| {
                    change(list).is_some_and(|[jump, _]| jump.abs() > SMOOTH * size(list))
                });
            if sharp {
                out.push(position);
            }
        }
    }
    out
}

/// Value and slope of a response where a piece begins.
fn start(piece: &ResponsePiece) -> [f64; 2] {
    let [a, b, ..] = piece.cubic;
    [a, b]
}

/// Value and slope of a response where a piece ends.
fn end(piece: &ResponsePiece) -> [f64; 2] {
    let h = piece.length();
    let [a, b, c, d] = piece.cubic;
    [
        a + h * (b + h * (c + h * d)),
        b + h * (2.0 * c + 3.0 * d * h),
    ]
}
