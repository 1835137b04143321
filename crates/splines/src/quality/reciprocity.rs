//! Deviations from Maxwell's reciprocal theorem, G(x, z) = G(z, x), and the work that follows from them.

use super::block::{BlockExtreme, CouplingBlock};
use super::search::refine_maximum;
use crate::error::Error;
use crate::table::SplineTable;

/// Largest |T_ij - T_ji| of a table, with the first pair of stations that has it; `None` where the stations
/// along z differ from those along x. A symmetric table gives exactly 0, at its first station.
#[must_use]
pub fn station_asymmetry(table: &SplineTable) -> Option<BlockExtreme> {
    let x = table.x();
    if table.z() != x {
        return None;
    }
    let mut worst = BlockExtreme {
        value: 0.0,
        x: x[0],
        z: x[0],
    };
    for i in 0..x.len() {
        for j in 0..i {
            let value = (table.values()[(i, j)] - table.values()[(j, i)]).abs();
            if value > worst.value {
                worst = BlockExtreme {
                    value,
                    x: x[j],
                    z: x[i],
                };
            }
        }
    }
    Some(worst)
}

/// Largest |G(x, z) - G(z, x)| of a direct block over all pairs of `sample_places` (increasing), refined from there.
///
/// # Errors
/// Those of the compliance.
pub fn asymmetry(block: &CouplingBlock<'_>, places: &[f64]) -> Result<BlockExtreme, Error> {
    let (Some(&first), Some(&last)) = (places.first(), places.last()) else {
        return Ok(BlockExtreme::default());
    };
    let g = block.matrix(places, places)?;
    let mut worst = BlockExtreme {
        value: 0.0,
        x: first,
        z: first,
    };
    for i in 0..places.len() {
        for j in 0..i {
            let value = (g[(i, j)] - g[(j, i)]).abs();
            if value > worst.value {
                worst = BlockExtreme {
                    value,
                    x: places[j],
                    z: places[i],
                };
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
    Ok(BlockExtreme {
        value,
        x: at[0],
        z: at[1],
    })
}

/// Work of two wheels whose forces go round the closed loop (0, 0), (P, 0), (P, P), (0, P) and back.
///
/// It is P^2 |G12 - G21|, which is zero for a structure by the theorem of Betti and Maxwell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoopWork {
    /// Coordinates of the two wheels, increasing.
    pub at: [f64; 2],
    /// Work of one loop divided by P^2, length/force.
    pub work: f64,
    /// Energy stored under both loads P divided by P^2, which is half the sum of G, length/force.
    pub stored: f64,
}

/// The loop with the largest work of two wheels at the distance `spacing`, searched over `sample_places`
/// (increasing) of the first wheel and of the second, and refined from there.
///
/// # Errors
/// Those of the compliance.
pub fn loop_work(
    block: &CouplingBlock<'_>,
    spacing: f64,
    places: &[f64],
) -> Result<LoopWork, Error> {
    let (Some(&first), Some(&last)) = (places.first(), places.last()) else {
        return Ok(LoopWork::default());
    };
    let top = last - spacing;
    if spacing <= 0.0 || top < first {
        return Ok(LoopWork::default());
    }
    let pair = |x: f64| block.matrix(&[x, (x + spacing).min(last)], &[x, (x + spacing).min(last)]);
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
    Ok(LoopWork {
        at: [at[0], at[0] + spacing],
        work,
        stored,
    })
}
