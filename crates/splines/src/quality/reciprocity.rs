//! Deviations from Maxwell's reciprocal theorem, G(x, z) = G(z, x), and the work that follows from them.

use super::block::{Extreme, Strip};
use super::search::refine_maximum;
use crate::error::Error;
use crate::table::Table;

/// Largest |T_ij - T_ji| of a table, with the first pair of stations that has it; `None` where the stations
/// along z differ from those along x. A symmetric table gives exactly 0, at its first station.
#[must_use]
pub fn station_asymmetry(table: &Table) -> Option<Extreme> {
    let x = table.x();
    if table.z() != x {
        return None;
    }
    let mut worst = Extreme { value: 0.0, x: x[0], z: x[0] };
    for i in 0..x.len() {
        for j in 0..i {
            let value = (table.values()[(i, j)] - table.values()[(j, i)]).abs();
            if value > worst.value {
                worst = Extreme { value, x: x[j], z: x[i] };
            }
        }
    }
    Some(worst)
}

/// Largest |G(x, z) - G(z, x)| of a direct block over all pairs of `places` (increasing), refined from there.
///
/// # Errors
/// Those of the compliance.
pub fn asymmetry(block: &Strip<'_>, places: &[f64]) -> Result<Extreme, Error> {
    let (Some(&first), Some(&last)) = (places.first(), places.last()) else {
        return Ok(Extreme::default());
    };
    let g = block.block(places, places)?;
    let mut worst = Extreme { value: 0.0, x: first, z: first };
    for i in 0..places.len() {
        for j in 0..i {
            let value = (g[(i, j)] - g[(j, i)]).abs();
            if value > worst.value {
                worst = Extreme { value, x: places[j], z: places[i] };
            }
        }
    }
    if worst.value == 0.0 {
        return Ok(worst);
    }
    let mut at = [worst.x, worst.z];
    let skew = |p: &[f64]| Ok((block.at(p[0], p[1])? - block.at(p[1], p[0])?).abs());
    let step = (last - first) / places.len() as f64;
    let value = refine_maximum(skew, &mut at, step, [first, last])?;
    Ok(Extreme { value, x: at[0], z: at[1] })
}

/// Work of two wheels whose forces go round the closed loop (0, 0), (P, 0), (P, P), (0, P) and back.
///
/// It is P^2 |G12 - G21|, which is zero for a structure by the theorem of Betti and Maxwell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Work {
    /// Coordinates of the two wheels, increasing.
    pub at: [f64; 2],
    /// Work of one loop divided by P^2, length/force.
    pub work: f64,
    /// Energy stored under both loads P divided by P^2, which is half the sum of G, length/force.
    pub stored: f64,
}

/// The loop with the largest work of two wheels at the distance `spacing`, searched over `places`
/// (increasing) of the first wheel and of the second, and refined from there.
///
/// # Errors
/// Those of the compliance.
pub fn work(block: &Strip<'_>, spacing: f64, places: &[f64]) -> Result<Work, Error> {
    let (Some(&first), Some(&last)) = (places.first(), places.last()) else { return Ok(Work::default()) };
    let top = last - spacing;
    if spacing <= 0.0 || top < first {
        return Ok(Work::default());
    }
    let pair = |x: f64| block.block(&[x, (x + spacing).min(last)], &[x, (x + spacing).min(last)]);
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
    let work = refine_maximum(|p| skew(p[0]), &mut at, step, [first, top])?;
    let stored = 0.5 * pair(at[0])?.sum();
    Ok(Work { at: [at[0], at[0] + spacing], work, stored })
}
