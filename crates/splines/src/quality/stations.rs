//! The fewest stations with which a reading of their table is within a tolerance.

use nalgebra::DMatrix;

use super::block::{BlockExtreme, CouplingBlock, RailDirection};
use super::deviation::reading_error;
use super::search::{breaks_within, sample_places};
use crate::compliance::Compliance;
use crate::error::Error;
use crate::probe::Axis;
use crate::table::{InfluenceBlock, SplineTable};

/// Largest number of iterations of the equidistribution for one number of stations.
const ITERATIONS: usize = 10;
/// Iterations without improvement after which it ends.
const IDLE: usize = 3;
/// Parts of each interval at whose ends errors are evaluated: during the search, and for the result.
const PARTS: [usize; 2] = [4, 8];
/// How many numbers of stations must fail in succession before the last that passed counts as the fewest.
const FAILURES: usize = 3;
/// Ratio of the predicted number of stations to the largest allowed, and of the error to the tolerance, above
/// which the search gives up.
const HOPELESS: f64 = 1.5;
/// Smallest order of convergence assumed. Jumps of slope along the diagonal reduce every reading to first
/// order.
const SMALLEST_ORDER: f64 = 0.7;
/// Smallest density of stations, relative to the mean.
const SMALLEST_DENSITY: f64 = 0.03;
/// A coupling below this fraction of the direct coefficients is not tabulated.
const UNCOUPLED: f64 = 1e-9;
/// Distance from every station, as a fraction of the range, at which errors beside it are evaluated.
const BESIDE: f64 = 1e-7;

/// Constructs a reading from the tables of all directions and their couplings.
pub type MakeReading<'a> = dyn Fn(&[InfluenceBlock]) -> Result<Box<dyn Compliance>, Error> + 'a;

/// A search for stations: the structure, the reading, and the tolerance.
#[derive(Clone, Copy)]
pub struct StationSearch<'a> {
    /// The exact compliance of the structure.
    pub exact: &'a dyn Compliance,
    /// Index of the rail.
    pub rail: usize,
    /// Directions that are tabulated, with their couplings, all at the same stations.
    pub axes: &'a [Axis],
    /// First and last station.
    pub range: [f64; 2],
    /// Places that must be stations, such as breaks, supports and hinges. Those outside the range are
    /// ignored.
    pub fixed: &'a [f64],
    /// Constructs the reading.
    pub read: &'a MakeReading<'a>,
    /// Order of convergence of the reading, > 0: the power of the distance between stations with which its
    /// error decreases. 2 for AKISPL and CUBSPL, 3 for natural splines in both directions and for factored
    /// tables.
    pub order: f64,
    /// Largest relative error allowed: relative to the largest coefficient in the range, for a coupling to
    /// the geometric mean of the largest of its two directions.
    pub tolerance: f64,
    /// Largest number of stations to be tried.
    pub max_stations: usize,
}

/// A set of stations, and the error of the reading with them.
#[derive(Clone, Debug, PartialEq)]
pub struct StationSet {
    /// Coordinates of the stations, increasing.
    pub at: Vec<f64>,
    /// The largest error found, relative as [`StationSearch::tolerance`].
    pub error: f64,
    /// Deflection and load of the block that has it.
    pub directions: [RailDirection; 2],
    /// The error itself (reading less exact), length/force, and where it was found.
    pub worst: BlockExtreme,
}

/// The smallest set of stations found with which the reading is within the tolerance.
///
/// Algorithm. The unknowns are the number of stations and their coordinates. For a given number the stations
/// equidistribute the error: the density of stations is iterated until the errors of all intervals, to the
/// power 1/order, are about equal, with at least one interval between neighbouring fixed places; of at most
/// ten iterations the one with the smallest error counts. The number starts at the smallest possible, is
/// raised by the prediction error ~ number^-order (with the order observed, where that is smaller) until the
/// tolerance holds, then lowered by one until three numbers in succession fail. Finally every station is
/// removed without which the tolerance still holds.
///
/// Guarantee: `error` is that of [`station_error`] for these stations, and within the tolerance. It is not proved
/// that no smaller set exists.
///
/// # Errors
/// [`Error::TooFewStations`] where the largest number of stations allowed is not enough; those of the compliance
/// and of `read`.
///
/// # Source
/// de Boor, Good approximation by splines with variable knots II, Lecture Notes in Mathematics 363, 12-20
/// (1974).
pub fn fewest_stations(search: &StationSearch<'_>) -> Result<StationSet, Error> {
    let fixed = breaks_within(search.fixed, search.range);
    let least = fixed.len().max(SplineTable::FEWEST_X);
    let most = search.max_stations.max(least);
    let mut density = Density {
        ends: fixed.clone(),
        value: vec![1.0; fixed.len() - 1],
    };
    let (mut count, mut failures) = (least, Vec::<(usize, f64)>::new());
    // Raise the number by prediction until the tolerance holds.
    let mut best = loop {
        let found = equidistribute(search, &fixed, count, &mut density)?;
        if found.error <= search.tolerance {
            break found;
        }
        if count == most {
            return Err(Error::TooFewStations {
                most,
                error: found.error,
            });
        }
        let observed = failures.last().map(|&(fewer, error): &(usize, f64)| {
            (error / found.error).ln() / (count as f64 / fewer as f64).ln()
        });
        let order = observed.map_or(search.order, |observed| {
            observed.clamp(SMALLEST_ORDER, search.order)
        });
        failures.push((count, found.error));
        let wanted = count as f64 * (found.error / search.tolerance).powf(1.0 / order);
        if wanted > HOPELESS * most as f64 && failures.len() > 1 {
            // Evaluated once at the largest number, without iteration: give up if it is far from enough.
            let found = station_error(search, &density.stations(&fixed, most))?;
            if found.error > HOPELESS * search.tolerance {
                return Err(Error::TooFewStations {
                    most,
                    error: found.error,
                });
            }
        }
        count = (wanted.min(4.0 * count as f64).ceil() as usize).clamp(count + 1, most);
    };
    // Lower it by one until several in succession fail.
    let mut failed = 0;
    while count > least && failed < FAILURES {
        count -= 1;
        if failures.iter().any(|(known, _)| *known == count) {
            break;
        }
        let found = equidistribute(search, &fixed, count, &mut density)?;
        if found.error <= search.tolerance {
            (best, failed) = (found, 0);
        } else {
            failed += 1;
        }
    }
    while let Some(fewer) = without_one(search, &fixed, &best)? {
        best = fewer;
    }
    Ok(best)
}

/// Error of the reading whose tables have the stations `at`.
///
/// It is the largest over all pairs of a set of places, eight to an interval and two just beside every
/// station, refined from there as in [`reading_error`].
///
/// # Errors
/// Those of the compliance and of `read`.
pub fn station_error(search: &StationSearch<'_>, at: &[f64]) -> Result<StationSet, Error> {
    let (blocks, scales) = tabulate(search, at)?;
    let reading = (search.read)(&blocks)?;
    let mut found = StationSet {
        at: at.to_vec(),
        error: 0.0,
        directions: [(search.rail, search.axes[0]); 2],
        worst: BlockExtreme::default(),
    };
    let mut breaks = breaks_within(&[at, search.fixed].concat(), search.range);
    let beside = BESIDE * (search.range[1] - search.range[0]);
    breaks.extend(breaks.clone().iter().flat_map(|x| [x - beside, x + beside]));
    let parts = PARTS[1] * at.len();
    let inner = sample_places(at, search.range, parts);
    let x = breaks_within(&[breaks, inner].concat(), search.range);
    for (a, deflection) in directions(search).enumerate() {
        for (b, load) in directions(search).enumerate() {
            let both = [reading.as_ref(), search.exact].map(|compliance| CouplingBlock {
                compliance,
                deflection,
                load,
            });
            let scale = (scales[a] * scales[b]).sqrt();
            let worst = reading_error(&both[0], &both[1], &x, &x)?;
            let error = if scale > 0.0 {
                worst.largest.value.abs() / scale
            } else {
                0.0
            };
            if error > found.error {
                found = StationSet {
                    error,
                    directions: [deflection, load],
                    worst: worst.largest,
                    ..found
                };
            }
        }
    }
    Ok(found)
}

/// The directions that are tabulated.
fn directions<'a>(search: &'a StationSearch<'_>) -> impl Iterator<Item = RailDirection> + 'a {
    search.axes.iter().map(|axis| (search.rail, *axis))
}

/// Tables of the exact compliance at the stations `at`, and the largest coefficient of each direction.
fn tabulate(
    search: &StationSearch<'_>,
    at: &[f64],
) -> Result<(Vec<InfluenceBlock>, Vec<f64>), Error> {
    let mut blocks = Vec::new();
    let mut scales = Vec::new();
    let dense = sample_places(
        &[at, search.fixed].concat(),
        search.range,
        4 * at.len().max(16),
    );
    for direction in directions(search) {
        let block = CouplingBlock::direct(search.exact, direction);
        scales.push(block.matrix(&dense, &dense)?.amax());
    }
    for (a, deflection) in directions(search).enumerate() {
        for (b, load) in directions(search).enumerate().skip(a) {
            let values = CouplingBlock {
                compliance: search.exact,
                deflection,
                load,
            }
            .matrix(at, at)?;
            if a == b || values.amax() > UNCOUPLED * (scales[a] * scales[b]).sqrt() {
                let table = SplineTable::new(at.to_vec(), at.to_vec(), values)?;
                blocks.push(InfluenceBlock {
                    deflection,
                    load,
                    table,
                });
            }
        }
    }
    Ok((blocks, scales))
}

/// Density of stations along the rail, constant on each interval.
#[derive(Clone, Debug)]
struct Density {
    ends: Vec<f64>,
    value: Vec<f64>,
}

impl Density {
    /// Integral from the first end to x.
    fn total(&self, x: f64) -> f64 {
        let parts = self.ends.windows(2).zip(&self.value);
        parts
            .map(|(pair, value)| value * (x.min(pair[1]) - pair[0]).max(0.0))
            .sum()
    }

    /// The coordinate at which the integral reaches `total`.
    fn place(&self, total: f64) -> f64 {
        let mut left = total;
        for (pair, value) in self.ends.windows(2).zip(&self.value) {
            let own = value * (pair[1] - pair[0]);
            if left <= own {
                return pair[0] + left / value;
            }
            left -= own;
        }
        self.ends[self.ends.len() - 1]
    }

    /// `count` stations: the fixed ones, and between them so many that the largest integral of the density
    /// over an interval is as small as possible; within each stretch between fixed stations the integrals are
    /// equal.
    fn stations(&self, fixed: &[f64], count: usize) -> Vec<f64> {
        let integrals: Vec<f64> = fixed
            .windows(2)
            .map(|pair| self.total(pair[1]) - self.total(pair[0]))
            .collect();
        let mut parts = vec![1_usize; integrals.len()];
        for _ in fixed.len()..count {
            let own = |k: &usize| integrals[*k] / parts[*k] as f64;
            let largest = (0..integrals.len()).max_by(|a, b| own(a).total_cmp(&own(b)));
            if let Some(k) = largest {
                parts[k] += 1;
            }
        }
        let mut out = Vec::with_capacity(count);
        for ((pair, integral), parts) in fixed.windows(2).zip(&integrals).zip(parts) {
            let start = self.total(pair[0]);
            out.push(pair[0]);
            out.extend((1..parts).map(|k| self.place(start + integral * k as f64 / parts as f64)));
        }
        out.push(fixed[fixed.len() - 1]);
        out
    }
}

/// The best placement of `count` stations that the iteration finds. `density` is where it starts, and is
/// replaced by that of the best placement for the next call.
fn equidistribute(
    search: &StationSearch<'_>,
    fixed: &[f64],
    count: usize,
    density: &mut Density,
) -> Result<StationSet, Error> {
    let mut best: Option<(f64, Vec<f64>, Density)> = None;
    let mut now = density.clone();
    let mut idle = 0;
    for _ in 0..ITERATIONS {
        let at = now.stations(fixed, count);
        let (error, own) = interval_errors(search, &at)?;
        idle += 1;
        if best.as_ref().is_none_or(|(least, ..)| error < *least) {
            best = Some((error, at.clone(), now.clone()));
            idle = 0;
        }
        if idle == IDLE {
            break;
        }
        let value: Vec<f64> = own
            .iter()
            .zip(at.windows(2))
            .map(|(e, pair)| e.powf(1.0 / search.order) / (pair[1] - pair[0]))
            .collect();
        let mean = value
            .iter()
            .zip(at.windows(2))
            .map(|(v, pair)| v * (pair[1] - pair[0]))
            .sum::<f64>()
            / (at[at.len() - 1] - at[0]);
        if mean <= 0.0 {
            break;
        }
        now = Density {
            ends: at,
            value: value
                .iter()
                .map(|v| v.max(SMALLEST_DENSITY * mean))
                .collect(),
        };
    }
    let Some((_, at, left)) = best else {
        return station_error(search, fixed);
    };
    *density = left;
    station_error(search, &at)
}

/// The largest relative error over a coarse set of places, and the error of each interval: the largest with
/// the load or the deflection in it and the other at a station, and with both in it.
fn interval_errors(search: &StationSearch<'_>, at: &[f64]) -> Result<(f64, Vec<f64>), Error> {
    let (blocks, scales) = tabulate(search, at)?;
    let reading = (search.read)(&blocks)?;
    let parts = PARTS[0];
    let mut x = Vec::with_capacity(parts * at.len());
    for pair in at.windows(2) {
        x.extend((0..parts).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / parts as f64));
    }
    x.extend(at.last());
    let mut own = vec![0.0_f64; at.len() - 1];
    let mut largest = 0.0_f64;
    for (a, deflection) in directions(search).enumerate() {
        for (b, load) in directions(search).enumerate() {
            let both = [reading.as_ref(), search.exact].map(|compliance| CouplingBlock {
                compliance,
                deflection,
                load,
            });
            let error: DMatrix<f64> = both[0].matrix(&x, &x)? - both[1].matrix(&x, &x)?;
            let scale = (scales[a] * scales[b]).sqrt().max(f64::MIN_POSITIVE);
            largest = largest.max(error.amax() / scale);
            for (k, own) in own.iter_mut().enumerate() {
                let inside = parts * k..=parts * (k + 1);
                for i in inside.clone() {
                    for j in (0..x.len()).step_by(parts).chain(inside.clone()) {
                        *own = own
                            .max(error[(i, j)].abs() / scale)
                            .max(error[(j, i)].abs() / scale);
                    }
                }
            }
        }
    }
    Ok((largest, own))
}

/// The stations without the first one that the tolerance does not need; `None` where it needs all.
fn without_one(
    search: &StationSearch<'_>,
    fixed: &[f64],
    stations: &StationSet,
) -> Result<Option<StationSet>, Error> {
    if stations.at.len() <= fixed.len().max(SplineTable::FEWEST_X) {
        return Ok(None);
    }
    for k in (0..stations.at.len()).filter(|&k| !fixed.contains(&stations.at[k])) {
        let mut at = stations.at.clone();
        at.remove(k);
        if interval_errors(search, &at)?.0 > search.tolerance {
            continue;
        }
        let found = station_error(search, &at)?;
        if found.error <= search.tolerance {
            return Ok(Some(found));
        }
    }
    Ok(None)
}
