//! Work that a closed path of forces gives or takes.

use super::{Strip, climb};
use crate::Error;

/// Two wheels whose forces go round a loop: (0, 0), (P, 0), (P, P), (0, P) and back.
///
/// The work is P^2 |G12 - G21|: none in a structure, by Maxwell and Betti's law.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Work {
    /// Where the two stand, the first below the second.
    pub at: [f64; 2],
    /// Work of a loop by P^2, length/force.
    pub work: f64,
    /// Energy stored under both loads P, by P^2: half the sum of G, length/force.
    pub stored: f64,
}

/// The loop with the most work of two wheels `spacing` apart, over `places` (increasing) of the first, refined.
///
/// # Errors
/// What the compliance refuses.
pub fn work(strip: &Strip<'_>, spacing: f64, places: &[f64]) -> Result<Work, Error> {
    let (Some(&first), Some(&last)) = (places.first(), places.last()) else { return Ok(Work::default()) };
    let top = last - spacing;
    if spacing <= 0.0 || top < first {
        return Ok(Work::default());
    }
    let pair = |x: f64| strip.block(&[x, (x + spacing).min(last)], &[x, (x + spacing).min(last)]);
    let skew = |x: f64| {
        let g = pair(x)?;
        Ok((g[(0, 1)] - g[(1, 0)]).abs())
    };
    let mut best = (0.0, first);
    for &x in places.iter().filter(|x| **x <= top) {
        for x in [x, (x - spacing).max(first)] {
            let value = skew(x)?;
            if value > best.0 {
                best = (value, x);
            }
        }
    }
    let mut at = [best.1];
    let step = (last - first) / places.len() as f64;
    let work = climb(|p| skew(p[0]), &mut at, step, [first, top])?;
    let stored = 0.5 * pair(at[0])?.sum();
    Ok(Work { at: [at[0], at[0] + spacing], work, stored })
}
