//! Whether G is positive semi-definite: eigenvalues over given places, and the layouts of wheels with the
//! smallest.
//!
//! Wheels of stiffness k on the rail have a unique equilibrium while G + I/k is positive definite, that is
//! for every k where no eigenvalue of G is negative, and else up to k = -1/(smallest eigenvalue).

use nalgebra::DMatrix;

use super::block::CouplingBlock;
use super::search::refine_maximum;
use crate::error::Error;
use crate::table::SplineTable;

/// Eigenvalues above minus this fraction of the largest coefficient count as rounding.
const ROUNDING: f64 = 1e-13;
/// Largest number of rounds in which every wheel is exchanged once.
const ROUNDS: usize = 4;
/// Random layouts examined: the first of those that [`indefinite_fraction`] counts.
const RANDOM: usize = 1000;
/// How many of them, the worst, are refined.
const REFINED: usize = 3;

/// Smallest and largest eigenvalue of the symmetric part of G, length/force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spectrum {
    /// Smallest eigenvalue; negative where some set of loads does negative work.
    pub smallest: f64,
    /// Largest eigenvalue.
    pub largest: f64,
}

impl Spectrum {
    /// Of the symmetric part of a square matrix; zeros where it is empty.
    fn of(matrix: &DMatrix<f64>) -> Spectrum {
        if matrix.is_empty() || !matrix.is_square() {
            return Spectrum::default();
        }
        let values = (0.5 * (matrix + matrix.transpose())).symmetric_eigenvalues();
        Spectrum {
            smallest: values.min(),
            largest: values.max(),
        }
    }
}

/// Extreme eigenvalues of a table at its stations; `None` where the stations along z differ from those along
/// x.
#[must_use]
pub fn station_spectrum(table: &SplineTable) -> Option<Spectrum> {
    (table.z() == table.x()).then(|| Spectrum::of(table.values()))
}

/// Extreme eigenvalues of a direct block over `sample_places`, with one wheel at each of them.
///
/// # Errors
/// Those of the compliance.
pub fn spectrum(block: &CouplingBlock<'_>, places: &[f64]) -> Result<Spectrum, Error> {
    Ok(Spectrum::of(&block.matrix(places, places)?))
}

/// A layout of wheels, and its smallest eigenvalue.
#[derive(Clone, Debug, PartialEq)]
pub struct WheelLayout {
    /// Coordinates of the wheels, increasing.
    pub places: Vec<f64>,
    /// Smallest eigenvalue of the symmetric part of G over them, length/force.
    pub smallest: f64,
    /// Wheel stiffness k above which G + I/k is not positive definite, force/length; `None` where it always
    /// is.
    pub stiffness: Option<f64>,
}

/// For each number of `wheels` (increasing) the layout with the smallest eigenvalue of G that a search finds.
///
/// Algorithm. On the set of `sample_places` (increasing), take the pair with the smallest eigenvalue, add one wheel
/// after another where it lowers the eigenvalue most, and exchange single wheels until no exchange lowers it,
/// for at most four rounds. Then refine between the places by compass search, from this layout, from the
/// three worst of 1000 random layouts, and from the layout found for the previous number of wheels with
/// further wheels added. The lowest result counts. Eigenvalues above -1e-13 of the largest coefficient count
/// as zero.
///
/// Guarantee: no smallest eigenvalue is above that for fewer wheels, or above that of any of the first 1000
/// layouts that [`indefinite_fraction`] examines.
///
/// # Errors
/// Those of the compliance.
pub fn weakest_layouts(
    block: &CouplingBlock<'_>,
    wheels: &[usize],
    places: &[f64],
) -> Result<Vec<WheelLayout>, Error> {
    let mut out: Vec<WheelLayout> = Vec::with_capacity(wheels.len());
    let (Some(&first), Some(&last)) = (places.first(), places.last()) else {
        return Ok(out);
    };
    let g = block.matrix(places, places)?;
    let negative = |at: &[f64]| Ok(-Spectrum::of(&block.matrix(at, at)?).smallest);
    let step = (last - first) / places.len() as f64;
    for &wheels in wheels {
        let mut starts = vec![
            best_exchange(&g, wheels)
                .iter()
                .map(|&k| places[k])
                .collect(),
        ];
        starts.extend(worst_random(negative, wheels, [first, last])?);
        if let Some(fewer) = out.last() {
            // By Cauchy's interlacing theorem the smallest eigenvalue does not rise, wherever wheels are
            // added.
            let mut at = fewer.places.clone();
            at.extend(
                (at.len()..wheels)
                    .map(|k| first + (last - first) * (k as f64 + 0.5) / wheels as f64),
            );
            at.truncate(wheels);
            starts.push(at);
        }
        let mut best = (f64::NEG_INFINITY, Vec::new());
        for mut at in starts {
            let value = refine_maximum(negative, &mut at, step, [first, last])?;
            if value > best.0 {
                best = (value, at);
            }
        }
        let (smallest, mut at) = (-best.0, best.1);
        at.sort_by(f64::total_cmp);
        let stiffness = (smallest < -ROUNDING * g.amax()).then(|| -1.0 / smallest);
        out.push(WheelLayout {
            places: at,
            smallest,
            stiffness,
        });
    }
    Ok(out)
}

/// The random layouts with the smallest eigenvalues. `negative` is the smallest eigenvalue with its sign
/// changed.
fn worst_random(
    negative: impl Fn(&[f64]) -> Result<f64, Error>,
    wheels: usize,
    range: [f64; 2],
) -> Result<Vec<Vec<f64>>, Error> {
    let mut layouts = Random::new();
    let mut all = Vec::with_capacity(RANDOM);
    for _ in 0..RANDOM {
        let at = layouts.layout(wheels, range);
        all.push((negative(&at)?, at));
    }
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    Ok(all.into_iter().take(REFINED).map(|(_, at)| at).collect())
}

/// Indices of a layout whose smallest eigenvalue no exchange of one wheel lowers.
fn best_exchange(g: &DMatrix<f64>, wheels: usize) -> Vec<usize> {
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

/// Moves wheel k to the place that makes the smallest eigenvalue smallest, and returns whether it moved.
fn exchange(
    chosen: &mut [usize],
    k: usize,
    places: usize,
    smallest: impl Fn(&[usize]) -> f64,
) -> bool {
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

/// Fraction of `count` random layouts of `wheels` wheels, uniformly distributed over `range`, whose G has a
/// negative eigenvalue (below -1e-13 of its largest coefficient). The layouts are the same in every call.
///
/// # Errors
/// Those of the compliance.
pub fn indefinite_fraction(
    block: &CouplingBlock<'_>,
    wheels: usize,
    count: usize,
    range: [f64; 2],
) -> Result<f64, Error> {
    let mut layouts = Random::new();
    let mut indefinite = 0;
    for _ in 0..count {
        let at = layouts.layout(wheels, range);
        let g = block.matrix(&at, &at)?;
        indefinite += usize::from(Spectrum::of(&g).smallest < -ROUNDING * g.amax());
    }
    Ok(if count == 0 {
        0.0
    } else {
        indefinite as f64 / count as f64
    })
}

/// A sequence of pseudo-random layouts, always the same, by the generator xorshift64*.
struct Random(u64);

impl Random {
    fn new() -> Random {
        Random(0x9E37_79B9_7F4A_7C15)
    }

    fn layout(&mut self, wheels: usize, [first, last]: [f64; 2]) -> Vec<f64> {
        (0..wheels)
            .map(|_| first + (last - first) * self.unit())
            .collect()
    }

    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
