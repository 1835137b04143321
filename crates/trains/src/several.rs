//! Extremes of internal forces over all sections of a member under several trains.
//!
//! At a fixed section the best arrangement of several trains is exact (`plan`). Normal, shear and torsional forces change
//! along the member by steps of one sign at wheels and monotonely between them, so that their extremes are those at the
//! ends of the window; only moments are sought over it. Their envelope is enclosed by bisection (`search`) and its
//! largest value polished by golden sections.

use crate::collect::standings;
use crate::error::Error;
use crate::extremes::Governing;
use crate::follow::{SectionSide, Target};
use crate::overrun::Overrun;
use crate::plan::CasePlan;
use crate::search::{Bend, Search};
use crate::section::slope_index;
use crate::structure::{Carrier, GirderResponse};

/// Most evaluations of a bisection before the largest value is polished.
const MOST: usize = 120;

/// The largest value of a target under several trains, with the bound of sign times all values; `None` for a quantity
/// whose extremes are those at the ends of the window.
pub(crate) fn enclosed(
    plan: &CasePlan,
    over: &Overrun,
    carrier: &Carrier,
    target: &Target<'_>,
) -> Result<Option<(Governing, f64)>, Error> {
    let Some(shear) = slope_index(target.k) else { return Ok(None) };
    let quantity = GirderResponse::ALL[target.k];
    let rate = carrier.rate();
    let wheels = plan.trains.iter().flat_map(|stances| &stances[0].wheels);
    let forces: f64 = wheels.map(|wheel| wheel.load[..3].iter().map(|f| f * f).sum::<f64>().sqrt()).sum();
    let distributed = target.dead.quadratic(shear)[1].abs();
    let bend = Bend { curvature: distributed * rate * rate, kinks: forces * rate };
    let window = target.window.map(|s| carrier.coordinate(s));
    let mut search = Search::new(target.sign, bend, window, |x| {
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
    search.most = MOST;
    search.run()?;
    search.polish((window[1] - window[0]) / 40.0)?;
    let bound = search.bound;
    Ok(search.best.map(|best| {
        let value = target.sign * best.value;
        (best, bound.max(value))
    }))
}
