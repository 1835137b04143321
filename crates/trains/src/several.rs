//! Extremes of internal forces over all sections of a member under several trains.
//!
//! At a fixed section the best arrangement of several trains is exact (`plan`). Along the member the internal force of every
//! state changes by steps at wheels. Where these steps and the dead load all lower a normal, shear or torsional force, or
//! all bend a moment downwards, the envelope has its extremes at the ends of the window. Otherwise its largest value is
//! enclosed by bisection (`search`), with the bounds of `blocked`, and then polished by golden sections.

use crate::blocked::Blocked;
use crate::collect::standings;
use crate::error::Error;
use crate::extremes::Governing;
use crate::follow::{SectionSide, Target};
use crate::overrun::Overrun;
use crate::plan::CasePlan;
use crate::search::Search;
use crate::section::slope_index;
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
    let quantity = GirderResponse::ALL[target.k];
    let window = target.window.map(|s| carrier.coordinate(s));
    let bounds = Blocked::new(plan, over, carrier, target);
    let margin = Box::new(|x| bounds.margin(x));
    let mut search = Search::new(target.sign, margin, window, |x| {
        let s = carrier.place(x);
        let found = plan.best(&over.section(s), target.k, target.sign, f64::NEG_INFINITY);
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
    let lever = if slope_index(target.k).is_some() { carrier.length } else { 1.0 };
    search.size = ZERO * forces(plan) * lever;
    search.known = known;
    search.run()?;
    if search.best.as_ref().is_some_and(|best| target.sign * best.value > known) {
        search.polish((window[1] - window[0]) / 40.0)?;
    }
    let bound = search.bound;
    let value = search.best.as_ref().map_or(f64::NEG_INFINITY, |best| target.sign * best.value);
    Ok(Some((search.best, bound.max(value))))
}

/// Sum of the forces of all wheels.
fn forces(plan: &CasePlan) -> f64 {
    let wheels = plan.trains.iter().flat_map(|stances| &stances[0].wheels);
    wheels.map(|wheel| wheel.load[..3].iter().map(|f| f * f).sum::<f64>().sqrt()).sum()
}

/// Whether sign times the quantity changes along the member in one direction only or, for a moment, is convex.
fn is_extreme_at_ends(over: &Overrun, target: &Target<'_>) -> bool {
    let all = || over.on.iter().flatten();
    let steps = |k: usize| all().flat_map(move |on| on.jumps(k)).map(|jump| target.sign * jump);
    let [_, slope, bend] = target.dead.quadratic(target.k).map(|c| target.sign * c);
    match slope_index(target.k) {
        Some(shear) => {
            steps(shear).all(|jump| jump >= 0.0) && steps(target.k).all(|jump| jump == 0.0) && bend >= 0.0
        }
        None => {
            let all_of = |sign: f64| {
                steps(target.k).all(|jump| sign * jump >= 0.0) && sign * slope >= 0.0 && bend == 0.0
            };
            all_of(1.0) || all_of(-1.0)
        }
    }
}
