//! Extremes of internal forces over all sections of a member under several trains.
//!
//! At a fixed section the best arrangement of several trains is exact (`plan`). Along the member the internal force of every
//! state changes by steps at wheels. Where these steps and the dead load all lower a normal, shear or torsional force, or
//! all bend a moment downwards, the envelope has its extremes at the ends of the window. Another force is extreme beside a
//! wheel. All trains before it have been passed and all others have not, so that the response to each is a function of its
//! own position, and the best arrangement is exact again. Moments, and trains on several rails of a member, are enclosed by
//! bisection (`search`), with the bounds of `blocked`, and then polished by golden sections.

use crate::blocked::Blocked;
use crate::collect::{offer, standings};
use crate::error::Error;
use crate::extremes::Governing;
use crate::follow::{SectionSide, Target};
use crate::hints::Hints;
use crate::overrun::Overrun;
use crate::plan::{CasePlan, Way};
use crate::running::PiecewiseFunction;
use crate::search::Search;
use crate::section::{Passage, slope_index};
use crate::structure::{Carrier, GirderResponse};

/// Size of a force, relative to all wheels together, or of a moment, relative to them and the length of the member, below
/// which it counts as zero.
const ZERO: f64 = 1e-4;

/// The largest value of a target under several trains, with the bound of sign times all values; `None` where the extremes
/// are those at the ends of the window. Values that do not exceed `known`, sign times a value, are not sought.
pub(crate) fn enclosed(
    plan: &CasePlan,
    over: &Overrun,
    carrier: &Carrier,
    target: &Target<'_>,
    known: f64,
) -> Result<Option<(Option<Governing>, f64)>, Error> {
    if is_extreme_at_ends(over, target) {
        return Ok(None);
    }
    if slope_index(target.k).is_none()
        && !is_bent(over, target.k)
        && plan.is_one_queue()
        && has_one_rail(over)
    {
        let found = beside_wheels(plan, over, carrier, target);
        let value = found
            .as_ref()
            .map_or(f64::NEG_INFINITY, |best| target.sign * best.value);
        return Ok(Some((found, value)));
    }
    let quantity = GirderResponse::ALL[target.k];
    let window = target.window.map(|s| carrier.coordinate(s));
    let bounds = Blocked::new(plan, over, carrier, target);
    let margin = Box::new(|x| bounds.margin(x));
    let mut hints = Hints::default();
    let mut search = Search::new(target.sign, margin, window, |x| {
        let s = carrier.place(x);
        let found = over.best(plan, target.k, target.sign, s, &hints.beside(x));
        if let Some(found) = &found {
            hints.add(x, found.clone());
        }
        Ok(found.map(|found| {
            let dead = target.dead.at(quantity, s);
            Governing {
                value: target.sign * found.signed + dead,
                dead,
                x,
                side: SectionSide::At,
                trains: standings(plan, &found),
                coincident: [0.0; 3],
            }
        }))
    });
    let lever = if slope_index(target.k).is_some() {
        carrier.length
    } else {
        1.0
    };
    search.size = ZERO * forces(plan) * lever;
    search.known = known;
    search.run()?;
    let is_larger = search
        .best
        .as_ref()
        .is_some_and(|best| target.sign * best.value > known);
    if is_larger && !search.is_closed() {
        search.polish((window[1] - window[0]) / 40.0)?;
    }
    let bound = search.bound;
    let value = search
        .best
        .as_ref()
        .map_or(f64::NEG_INFINITY, |best| target.sign * best.value);
    Ok(Some((search.best, bound.max(value))))
}

/// Whether all wheels that can stand on the member stand on one rail.
fn has_one_rail(over: &Overrun) -> bool {
    let mut rails = over.all().flat_map(|passage| passage.on.reached_rails());
    let first = rails.next();
    rails.all(|rail| Some(rail) == first)
        && !over.all().any(|passage| passage.on.has_opposed_wheels())
}

/// The largest value of a force beside any wheel within the window.
fn beside_wheels(
    plan: &CasePlan,
    over: &Overrun,
    carrier: &Carrier,
    target: &Target<'_>,
) -> Option<Governing> {
    let all = |s: f64| -> Vec<Vec<Way>> {
        let of = |(train, stances): (usize, &Vec<Passage>)| {
            let own = stances.iter().enumerate().map(|(stance, passage)| {
                (
                    stance,
                    PiecewiseFunction::of(
                        &passage.response(target.k, s),
                        target.sign,
                        stance,
                        f64::NEG_INFINITY,
                    ),
                )
            });
            plan.ways(train, own)
        };
        over.passages.iter().enumerate().map(of).collect()
    };
    let (ahead, passed) = (all(0.0), all(carrier.length));
    let mut best: Option<Governing> = None;
    for (train, stances) in plan.trains.iter().enumerate() {
        for wheel in 0..stances[0].wheels.len() {
            for side in [SectionSide::Before, SectionSide::Behind] {
                let beside = |stance: usize| {
                    (
                        stance,
                        over.passages[train][stance].beside(target, wheel, side, stance),
                    )
                };
                let within = (0..stances.len())
                    .map(beside)
                    .filter(|(_, function)| !function.is_empty());
                let following = plan.ways(train, within);
                let Some(found) = plan.best_around(train, &following, &passed, &ahead) else {
                    continue;
                };
                let standing = found.trains[train];
                let mut at = Vec::new();
                let on = &over.passages[train][standing.stance].on;
                on.coordinate_of(carrier, standing.position, wheel, &mut at);
                let Some(x) = at.first().copied() else {
                    continue;
                };
                let dead = target
                    .dead
                    .at(GirderResponse::ALL[target.k], carrier.place(x));
                let value = target.sign * found.signed;
                let trains = standings(plan, &found);
                let governing = Governing {
                    value,
                    dead,
                    x,
                    side,
                    trains,
                    coincident: [0.0; 3],
                };
                offer(&mut best, Some(governing), target.sign);
            }
        }
    }
    best
}

/// Whether an axial force bends quantity `k` between wheels.
fn is_bent(over: &Overrun, k: usize) -> bool {
    over.all().any(|passage| passage.on.bent_row(k).is_some())
}

/// Sum of the forces of all wheels.
fn forces(plan: &CasePlan) -> f64 {
    let wheels = plan.trains.iter().flat_map(|stances| &stances[0].wheels);
    wheels
        .map(|wheel| wheel.load[..3].iter().map(|f| f * f).sum::<f64>().sqrt())
        .sum()
}

/// Whether sign times the quantity changes along the member in one direction only or, for a moment, is convex.
fn is_extreme_at_ends(over: &Overrun, target: &Target<'_>) -> bool {
    if is_bent(over, target.k) {
        return false;
    }
    let steps = |k: usize| {
        over.all()
            .flat_map(move |passage| passage.on.jumps(k))
            .map(|jump| target.sign * jump)
    };
    let [_, slope, bend, _] = target.dead.cubic(target.k).map(|c| target.sign * c);
    match slope_index(target.k) {
        Some(shear) => {
            steps(shear).all(|jump| jump >= 0.0)
                && steps(target.k).all(|jump| jump == 0.0)
                && bend >= 0.0
        }
        None => {
            let all_of = |sign: f64| {
                steps(target.k).all(|jump| sign * jump >= 0.0) && sign * slope >= 0.0 && bend == 0.0
            };
            all_of(1.0) || all_of(-1.0)
        }
    }
}
