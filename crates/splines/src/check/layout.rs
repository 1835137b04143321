//! Wheels where a reading is at its weakest.

use nalgebra::DMatrix;

use super::{Spectrum, Strip, climb};
use crate::Error;

/// Eigenvalues above minus this, of the largest coefficient, are rounding.
const ROUNDING: f64 = 1e-13;
/// Rounds of exchanges before a layout counts as settled.
const ROUNDS: usize = 4;

/// A set of wheels, and how near it is to giving back more than was put in.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Where the wheels stand, increasing.
    pub places: Vec<f64>,
    /// Smallest eigenvalue of the symmetric part of G over them, length/force.
    pub smallest: f64,
    /// Wheel stiffness k beyond which G + I/k is no longer positive definite, force/length; `None`: never.
    pub stiffness: Option<f64>,
}

/// The layout of `wheels` wheels with the smallest eigenvalue that a search over `places` finds.
///
/// Starts from the worst pair of places, adds the wheel that makes most of it, exchanges wheels until no
/// exchange gains, and climbs from there between the places. G + I/k is positive definite up to
/// k = -1/smallest, and for every k where no eigenvalue is negative (beyond 1e-13 of the largest coefficient).
///
/// # Errors
/// What the compliance refuses.
pub fn weakest_layout(strip: &Strip<'_>, wheels: usize, places: &[f64]) -> Result<Layout, Error> {
    let empty = Layout { places: Vec::new(), smallest: 0.0, stiffness: None };
    let (Some(&first), Some(&last)) = (places.first(), places.last()) else { return Ok(empty) };
    if wheels == 0 {
        return Ok(empty);
    }
    let g = strip.block(places, places)?;
    let smallest = |chosen: &[usize]| {
        let part = DMatrix::from_fn(chosen.len(), chosen.len(), |i, j| g[(chosen[i], chosen[j])]);
        Spectrum::of(&part).smallest
    };
    let mut chosen = worst_pair(&g);
    chosen.truncate(wheels);
    while chosen.len() < wheels {
        chosen.push(chosen[0]);
        let end = chosen.len() - 1;
        exchange(&mut chosen, end, places.len(), smallest);
    }
    for _ in 0..ROUNDS {
        let mut better = false;
        for k in 0..wheels {
            better |= exchange(&mut chosen, k, places.len(), smallest);
        }
        if !better {
            break;
        }
    }
    let mut at: Vec<f64> = chosen.iter().map(|&k| places[k]).collect();
    let depth = |at: &[f64]| Ok(-Spectrum::of(&strip.block(at, at)?).smallest);
    let step = (last - first) / places.len() as f64;
    let smallest = -climb(depth, &mut at, step, [first, last])?;
    at.sort_by(f64::total_cmp);
    let stiffness = (smallest < -ROUNDING * g.amax()).then(|| -1.0 / smallest);
    Ok(Layout { places: at, smallest, stiffness })
}

/// Indices of the two places whose 2 x 2 matrix has the smallest eigenvalue.
fn worst_pair(g: &DMatrix<f64>) -> Vec<usize> {
    let mut worst = (f64::INFINITY, vec![0, 0]);
    for i in 0..g.nrows() {
        for j in 0..i {
            let (mean, half) = (0.5 * (g[(i, i)] + g[(j, j)]), 0.5 * (g[(i, i)] - g[(j, j)]));
            let smallest = mean - half.hypot(0.5 * (g[(i, j)] + g[(j, i)]));
            if smallest < worst.0 {
                worst = (smallest, vec![j, i]);
            }
        }
    }
    worst.1
}

/// Puts wheel k where it makes the smallest eigenvalue smallest; whether that gained anything.
fn exchange(chosen: &mut [usize], k: usize, places: usize, smallest: impl Fn(&[usize]) -> f64) -> bool {
    let (mut best, mut found) = (smallest(chosen), chosen[k]);
    let before = found;
    for place in 0..places {
        chosen[k] = place;
        let value = smallest(chosen);
        if value < best {
            (best, found) = (value, place);
        }
    }
    chosen[k] = found;
    found != before
}

/// Share of `count` random layouts of `wheels` wheels, uniform over `range`, whose G has a negative eigenvalue
/// (beyond 1e-13 of its largest coefficient). The same layouts every time.
///
/// # Errors
/// What the compliance refuses.
pub fn indefinite_share(
    strip: &Strip<'_>,
    wheels: usize,
    count: usize,
    [first, last]: [f64; 2],
) -> Result<f64, Error> {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut unit = || {
        // xorshift64*
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        (state.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut indefinite = 0;
    for _ in 0..count {
        let at: Vec<f64> = (0..wheels).map(|_| first + (last - first) * unit()).collect();
        let g = strip.block(&at, &at)?;
        indefinite += usize::from(Spectrum::of(&g).smallest < -ROUNDING * g.amax());
    }
    Ok(if count == 0 { 0.0 } else { indefinite as f64 / count as f64 })
}
