//! Wheels where a reading is at its weakest.

use nalgebra::DMatrix;

use super::{Spectrum, Strip, climb};
use crate::Error;

/// Eigenvalues above minus this, of the largest coefficient, are rounding.
const ROUNDING: f64 = 1e-13;
/// Rounds of exchanges before a layout counts as settled.
const ROUNDS: usize = 4;
/// Random layouts tried beside: those that [`indefinite_share`] counts first.
const RANDOM: usize = 1000;
/// How many of them are climbed from.
const CLIMBED: usize = 3;

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

/// For each number of `wheels` (increasing) the layout with the smallest eigenvalue that a search finds.
///
/// Starts from the worst pair of `places` (increasing), adds the wheel that makes most of it and exchanges
/// wheels until no exchange gains; then climbs between the places, from there, from the worst few of 1000 random layouts and
/// from the layout of fewer wheels. G + I/k is positive definite up to k = -1/smallest, and for every
/// k where no eigenvalue is negative (beyond 1e-13 of the largest coefficient).
///
/// Guarantee: no layout is told as less weak than one of fewer wheels, nor than any that [`indefinite_share`] looks
/// at up to 1000.
///
/// # Errors
/// What the compliance refuses.
pub fn weakest_layouts(strip: &Strip<'_>, wheels: &[usize], places: &[f64]) -> Result<Vec<Layout>, Error> {
    let mut out: Vec<Layout> = Vec::with_capacity(wheels.len());
    let (Some(&first), Some(&last)) = (places.first(), places.last()) else { return Ok(out) };
    let g = strip.block(places, places)?;
    let depth = |at: &[f64]| Ok(-Spectrum::of(&strip.block(at, at)?).smallest);
    let step = (last - first) / places.len() as f64;
    for &wheels in wheels {
        let mut starts = vec![settled(&g, wheels).iter().map(|&k| places[k]).collect()];
        starts.extend(random(depth, wheels, [first, last])?);
        if let Some(fewer) = out.last() {
            // One eigenvalue more lies below, wherever the wheels are added.
            let mut at = fewer.places.clone();
            at.extend((at.len()..wheels).map(|k| first + (last - first) * (k as f64 + 0.5) / wheels as f64));
            at.truncate(wheels);
            starts.push(at);
        }
        let mut best = (f64::NEG_INFINITY, Vec::new());
        for mut at in starts {
            let value = climb(depth, &mut at, step, [first, last])?;
            if value > best.0 {
                best = (value, at);
            }
        }
        let (smallest, mut at) = (-best.0, best.1);
        at.sort_by(f64::total_cmp);
        let stiffness = (smallest < -ROUNDING * g.amax()).then(|| -1.0 / smallest);
        out.push(Layout { places: at, smallest, stiffness });
    }
    Ok(out)
}

/// The worst of random layouts.
fn random(
    depth: impl Fn(&[f64]) -> Result<f64, Error>,
    wheels: usize,
    range: [f64; 2],
) -> Result<Vec<Vec<f64>>, Error> {
    let mut layouts = Random::new();
    let mut all = Vec::with_capacity(RANDOM);
    for _ in 0..RANDOM {
        let at = layouts.layout(wheels, range);
        all.push((depth(&at)?, at));
    }
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    Ok(all.into_iter().take(CLIMBED).map(|(_, at)| at).collect())
}

/// Indices of a layout that no exchange of one wheel makes weaker.
fn settled(g: &DMatrix<f64>, wheels: usize) -> Vec<usize> {
    let smallest = |chosen: &[usize]| {
        let part = DMatrix::from_fn(chosen.len(), chosen.len(), |i, j| g[(chosen[i], chosen[j])]);
        Spectrum::of(&part).smallest
    };
    let mut chosen = worst_pair(g);
    chosen.truncate(wheels);
    while chosen.len() < wheels {
        chosen.push(chosen[0]);
        let end = chosen.len() - 1;
        exchange(&mut chosen, end, g.nrows(), smallest);
    }
    for _ in 0..ROUNDS {
        let mut better = false;
        for k in 0..wheels {
            better |= exchange(&mut chosen, k, g.nrows(), smallest);
        }
        if !better {
            break;
        }
    }
    chosen
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
    range: [f64; 2],
) -> Result<f64, Error> {
    let mut layouts = Random::new();
    let mut indefinite = 0;
    for _ in 0..count {
        let at = layouts.layout(wheels, range);
        let g = strip.block(&at, &at)?;
        indefinite += usize::from(Spectrum::of(&g).smallest < -ROUNDING * g.amax());
    }
    Ok(if count == 0 { 0.0 } else { indefinite as f64 / count as f64 })
}

/// Layouts that look random: xorshift64*, the same every time.
struct Random(u64);

impl Random {
    fn new() -> Random {
        Random(0x9E37_79B9_7F4A_7C15)
    }

    fn layout(&mut self, wheels: usize, [first, last]: [f64; 2]) -> Vec<f64> {
        (0..wheels).map(|_| first + (last - first) * self.unit()).collect()
    }

    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
