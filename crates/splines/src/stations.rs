//! The fewest stations with which a reading of their table is as good as asked.

use nalgebra::DMatrix;

use crate::check::{Extreme, Strip, Way, deviation, places, restricted};
use crate::{Axis, Compliance, Error, Sheet, Table};

/// Rounds of equal distribution for one number of stations.
const ROUNDS: usize = 10;
/// Rounds without gain that end them sooner.
const IDLE: usize = 3;
/// Places looked at between two stations, stations included, while searching and in the end.
const PARTS: [usize; 2] = [4, 8];
/// Numbers of stations that must fail, one after the other, before the last that passed is called the fewest.
const FAILURES: usize = 3;
/// Least order believed: kinks along the diagonal make every reading first order.
const LEAST_ORDER: f64 = 0.7;
/// Least density of stations, of the mean.
const FLOOR: f64 = 0.03;
/// A coupling below this share of the direct coefficients is none.
const UNCOUPLED: f64 = 1e-9;
/// Beside every station errors are looked for at this share of the range.
const BESIDE: f64 = 1e-7;

/// Makes a reading of tables.
pub type Read<'a> = dyn Fn(&[Sheet]) -> Result<Box<dyn Compliance>, Error> + 'a;

/// What stations are wanted for.
#[derive(Clone, Copy)]
pub struct Search<'a> {
    /// The structure between the stations.
    pub exact: &'a dyn Compliance,
    /// The rail.
    pub rail: usize,
    /// Directions that are tabulated, with their couplings, all at the same stations.
    pub axes: &'a [Axis],
    /// First and last station.
    pub range: [f64; 2],
    /// Places that must be stations: breaks, supports, hinges. Those outside the range do not count.
    pub fixed: &'a [f64],
    /// Makes a reading of tables.
    pub read: &'a Read<'a>,
    /// Power of the distance of stations with which the reading's error falls, > 0: 2 for AKISPL and CUBSPL, 3 for
    /// the natural tensor and products of curves.
    pub order: f64,
    /// Error allowed, of the largest coefficient in the range; of a coupling, of the geometric mean of the two
    /// directions' largest.
    pub tolerance: f64,
    /// The most stations to be tried.
    pub most: usize,
}

/// Stations, and the error of the reading at them.
#[derive(Clone, Debug, PartialEq)]
pub struct Stations {
    /// Increasing.
    pub at: Vec<f64>,
    /// The largest error found, relative as in [`Search::tolerance`].
    pub error: f64,
    /// Whose it is: deflection and load.
    pub ways: [Way; 2],
    /// The error itself, reading less exact, length/force, and where it was found.
    pub worst: Extreme,
}

/// The fewest stations found with which the reading keeps the tolerance.
///
/// For every number of stations they are placed so that the errors of all intervals, to the power 1/order, are equal
/// (equidistribution), each stretch between fixed places having at least one interval; the number is
/// found by the order of the reading and then one by one. At last any station is taken away without which the
/// tolerance holds.
///
/// Guarantee: `error` is that of [`error_of`] at these stations, and within the tolerance. That no other set of
/// fewer stations would do is not proved.
///
/// # Errors
/// [`Error::Stations`] where the most stations allowed are not enough; what the compliance or `read` refuses.
///
/// # Source
/// de Boor, Good approximation by splines with variable knots II, Lecture Notes in Mathematics 363, 12-20 (1974).
pub fn stations(search: &Search<'_>) -> Result<Stations, Error> {
    let fixed = restricted(search.fixed, search.range);
    let least = fixed.len().max(Table::LEAST);
    let most = search.most.max(least);
    let mut density = Density { ends: fixed.clone(), value: vec![1.0; fixed.len() - 1] };
    let (mut count, mut failures) = (least, Vec::<(usize, f64)>::new());
    // Up by prediction, with the order seen where that is less than the reading's, then down one by one.
    let mut best = loop {
        let found = place(search, &fixed, count, &mut density)?;
        if found.error <= search.tolerance {
            break found;
        }
        if count == most {
            return Err(Error::Stations { most, error: found.error });
        }
        let seen = failures.last().map(|&(fewer, error): &(usize, f64)| {
            (error / found.error).ln() / (count as f64 / fewer as f64).ln()
        });
        let order = seen.map_or(search.order, |seen| seen.clamp(LEAST_ORDER, search.order));
        failures.push((count, found.error));
        let more = (found.error / search.tolerance).powf(1.0 / order).min(4.0);
        count = ((count as f64 * more).ceil() as usize).clamp(count + 1, most);
    };
    let mut row = 0;
    while count > least && row < FAILURES {
        count -= 1;
        if failures.iter().any(|(failed, _)| *failed == count) {
            break;
        }
        let found = place(search, &fixed, count, &mut density)?;
        if found.error <= search.tolerance {
            (best, row) = (found, 0);
        } else {
            row += 1;
        }
    }
    while let Some(fewer) = without_one(search, &fixed, &best)? {
        best = fewer;
    }
    Ok(best)
}

/// Error of the reading whose tables have the stations `at`: the largest over a set of places with eight parts an
/// interval and places just beside every station, refined from there.
///
/// # Errors
/// What the compliance or `read` refuses.
pub fn error_of(search: &Search<'_>, at: &[f64]) -> Result<Stations, Error> {
    let (sheets, scales) = sheets(search, at)?;
    let reading = (search.read)(&sheets)?;
    let mut found = Stations {
        at: at.to_vec(),
        error: 0.0,
        ways: [(search.rail, search.axes[0]); 2],
        worst: Extreme::default(),
    };
    let mut breaks = restricted(&[at, search.fixed].concat(), search.range);
    let beside = BESIDE * (search.range[1] - search.range[0]);
    breaks.extend(breaks.clone().iter().flat_map(|x| [x - beside, x + beside]));
    let parts = PARTS[1] * at.len();
    let inner = places(at, search.range, parts);
    let x = restricted(&[breaks, inner].concat(), search.range);
    for (a, deflection) in ways(search).enumerate() {
        for (b, load) in ways(search).enumerate() {
            let strips =
                [reading.as_ref(), search.exact].map(|compliance| Strip { compliance, deflection, load });
            let scale = (scales[a] * scales[b]).sqrt();
            let worst = deviation(&strips[0], &strips[1], &x, &x)?;
            let error = if scale > 0.0 { worst.largest.value.abs() / scale } else { 0.0 };
            if error > found.error {
                found = Stations { error, ways: [deflection, load], worst: worst.largest, ..found };
            }
        }
    }
    Ok(found)
}

fn ways<'a>(search: &'a Search<'_>) -> impl Iterator<Item = Way> + 'a {
    search.axes.iter().map(|axis| (search.rail, *axis))
}

/// Tables of the exact surface at stations, and the largest coefficient of each direction.
fn sheets(search: &Search<'_>, at: &[f64]) -> Result<(Vec<Sheet>, Vec<f64>), Error> {
    let mut sheets = Vec::new();
    let mut scales = Vec::new();
    let dense = places(&[at, search.fixed].concat(), search.range, 4 * at.len().max(16));
    for way in ways(search) {
        let strip = Strip::direct(search.exact, way);
        scales.push(strip.block(&dense, &dense)?.amax());
    }
    for (a, deflection) in ways(search).enumerate() {
        for (b, load) in ways(search).enumerate().skip(a) {
            let values = Strip { compliance: search.exact, deflection, load }.block(at, at)?;
            if a == b || values.amax() > UNCOUPLED * (scales[a] * scales[b]).sqrt() {
                let table = Table::new(at.to_vec(), at.to_vec(), values)?;
                sheets.push(Sheet { deflection, load, table });
            }
        }
    }
    Ok((sheets, scales))
}

/// Stations an interval of the rail wants: constant between its ends.
#[derive(Clone, Debug)]
struct Density {
    ends: Vec<f64>,
    value: Vec<f64>,
}

impl Density {
    /// Integral from the first end to x.
    fn total(&self, x: f64) -> f64 {
        let parts = self.ends.windows(2).zip(&self.value);
        parts.map(|(pair, value)| value * (x.min(pair[1]) - pair[0]).max(0.0)).sum()
    }

    /// Where the integral reaches `total`.
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

    /// `count` stations: the fixed ones, and between each two as many as keep the largest share of an interval
    /// smallest.
    fn stations(&self, fixed: &[f64], count: usize) -> Vec<f64> {
        let shares: Vec<f64> =
            fixed.windows(2).map(|pair| self.total(pair[1]) - self.total(pair[0])).collect();
        let mut parts = vec![1_usize; shares.len()];
        for _ in fixed.len()..count {
            let share = |k: &usize| shares[*k] / parts[*k] as f64;
            let widest = (0..shares.len()).max_by(|a, b| share(a).total_cmp(&share(b)));
            if let Some(k) = widest {
                parts[k] += 1;
            }
        }
        let mut out = Vec::with_capacity(count);
        for ((pair, share), parts) in fixed.windows(2).zip(&shares).zip(parts) {
            let start = self.total(pair[0]);
            out.push(pair[0]);
            out.extend((1..parts).map(|k| self.place(start + share * k as f64 / parts as f64)));
        }
        out.push(fixed[fixed.len() - 1]);
        out
    }
}

/// The best of some rounds of `count` stations; `density` is left for the next number.
fn place(search: &Search<'_>, fixed: &[f64], count: usize, density: &mut Density) -> Result<Stations, Error> {
    let mut best: Option<(f64, Vec<f64>, Density)> = None;
    let mut now = density.clone();
    let mut idle = 0;
    for _ in 0..ROUNDS {
        let at = now.stations(fixed, count);
        let (error, own) = intervals(search, &at)?;
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
        let mean = value.iter().zip(at.windows(2)).map(|(v, pair)| v * (pair[1] - pair[0])).sum::<f64>()
            / (at[at.len() - 1] - at[0]);
        if mean <= 0.0 {
            break;
        }
        now = Density { ends: at, value: value.iter().map(|v| v.max(FLOOR * mean)).collect() };
    }
    let Some((_, at, left)) = best else { return error_of(search, fixed) };
    *density = left;
    error_of(search, &at)
}

/// The largest relative error at a coarse set of places, and each interval's own: of reading along z alone, along
/// x alone, and of the pairs within it.
fn intervals(search: &Search<'_>, at: &[f64]) -> Result<(f64, Vec<f64>), Error> {
    let (sheets, scales) = sheets(search, at)?;
    let reading = (search.read)(&sheets)?;
    let parts = PARTS[0];
    let mut x = Vec::with_capacity(parts * at.len());
    for pair in at.windows(2) {
        x.extend((0..parts).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / parts as f64));
    }
    x.extend(at.last());
    let mut own = vec![0.0_f64; at.len() - 1];
    let mut largest = 0.0_f64;
    for (a, deflection) in ways(search).enumerate() {
        for (b, load) in ways(search).enumerate() {
            let strips =
                [reading.as_ref(), search.exact].map(|compliance| Strip { compliance, deflection, load });
            let error: DMatrix<f64> = strips[0].block(&x, &x)? - strips[1].block(&x, &x)?;
            let scale = (scales[a] * scales[b]).sqrt().max(f64::MIN_POSITIVE);
            largest = largest.max(error.amax() / scale);
            for (k, own) in own.iter_mut().enumerate() {
                let inside = parts * k..=parts * (k + 1);
                for i in inside.clone() {
                    for j in (0..x.len()).step_by(parts).chain(inside.clone()) {
                        *own = own.max(error[(i, j)].abs() / scale).max(error[(j, i)].abs() / scale);
                    }
                }
            }
        }
    }
    Ok((largest, own))
}

/// The stations less the first one without which the tolerance holds.
fn without_one(search: &Search<'_>, fixed: &[f64], stations: &Stations) -> Result<Option<Stations>, Error> {
    if stations.at.len() <= fixed.len().max(Table::LEAST) {
        return Ok(None);
    }
    for k in (0..stations.at.len()).filter(|&k| !fixed.contains(&stations.at[k])) {
        let mut at = stations.at.clone();
        at.remove(k);
        if intervals(search, &at)?.0 > search.tolerance {
            continue;
        }
        let found = error_of(search, &at)?;
        if found.error <= search.tolerance {
            return Ok(Some(found));
        }
    }
    Ok(None)
}
