//! The rows of a long history that are needed for extremes: where loads change evenly a few of them tell as much as all.

use sim::{Channel, History};

use crate::response::WheelLoadReader;

/// Factor by which the tolerance is raised.
const RAISED: f64 = 2.0;

/// Channels of one kind, compared with the largest magnitude of any of them.
struct Kind {
    channels: Vec<usize>,
    size: f64,
}

/// Indices of the `rows` of a history, the first and the last included, between which the loads on structure `s` and the
/// motions of its `dofs` degrees of freedom differ from straight lines by no more than `tolerance` times the largest force,
/// displacement or acceleration. The tolerance is raised until there are no more than `most`.
///
/// From each row that is kept the cone of straight lines that pass near all rows behind it is narrowed row by row; the last
/// row whose values lie in the cone is kept next.
///
/// # Source
/// Williams, Bounded straight-line approximation of digitized planar curves and lines, Computer Graphics and Image
/// Processing 16 (1981), 370.
pub(super) fn kept_rows(
    (history, rows): (&History, &[usize]),
    loads: &WheelLoadReader,
    (s, dofs): (usize, usize),
    mut tolerance: f64,
    most: usize,
) -> Vec<usize> {
    let kinds = kinds(history, loads, (s, dofs));
    let samples: Vec<&[f64]> = rows.iter().map(|row| history.sample(*row)).collect();
    loop {
        let kept = within(&samples, &kinds, tolerance);
        if kept.len() <= most || tolerance >= 1.0 {
            return kept;
        }
        tolerance *= RAISED;
    }
}

/// The rows that a tolerance keeps.
fn within(samples: &[&[f64]], kinds: &[Kind], tolerance: f64) -> Vec<usize> {
    let mut kept = vec![0];
    let mut cone = Cone::new(kinds);
    let mut row = 1;
    while row < samples.len() {
        let first = kept[kept.len() - 1];
        if row == first + 1 || cone.contains(kinds, samples[first], samples[row]) {
            cone.narrow(kinds, tolerance, samples[first], samples[row]);
            row += 1;
        } else {
            kept.push(row - 1);
            cone = Cone::new(kinds);
        }
    }
    if samples.len() > 1 {
        kept.push(samples.len() - 1);
    }
    kept
}

fn kinds(history: &History, loads: &WheelLoadReader, (s, dofs): (usize, usize)) -> Vec<Kind> {
    let channels = |k: usize| loads.on(s).flat_map(|source| source.channels()[k].clone()).collect();
    let mut groups: Vec<Vec<usize>> = vec![channels(0), channels(1)];
    for first in [Channel::Coordinate(s, 0), Channel::Acceleration(s, 0)] {
        groups.extend(history.position(first).map(|first| (first..first + dofs).collect()));
    }
    let kind = |channels: Vec<usize>| {
        let size = |row: &[f64]| channels.iter().fold(0.0, |most: f64, c| most.max(row[*c].abs()));
        let size = history.samples().map(size).fold(0.0, f64::max);
        Kind { channels, size }
    };
    groups.into_iter().map(kind).collect()
}

/// Least and largest slope by channel of the lines from a row that pass near all rows behind it.
struct Cone {
    slopes: Vec<[f64; 2]>,
}

impl Cone {
    fn new(kinds: &[Kind]) -> Cone {
        let count = kinds.iter().map(|kind| kind.channels.len()).sum();
        Cone { slopes: vec![[f64::NEG_INFINITY, f64::INFINITY]; count] }
    }

    /// Whether the line from row `a` to row `b` is in the cone.
    fn contains(&self, kinds: &[Kind], a: &[f64], b: &[f64]) -> bool {
        let channels = kinds.iter().flat_map(|kind| &kind.channels);
        channels.zip(&self.slopes).all(|(&c, [least, most])| {
            let slope = (b[c] - a[c]) / (b[0] - a[0]);
            *least <= slope && slope <= *most
        })
    }

    /// Leaves out the lines from row `a` that pass too far from row `b`.
    fn narrow(&mut self, kinds: &[Kind], tolerance: f64, a: &[f64], b: &[f64]) {
        let channels =
            kinds.iter().flat_map(|kind| kind.channels.iter().map(|c| (*c, tolerance * kind.size)));
        for ((c, allowed), [least, most]) in channels.zip(&mut self.slopes) {
            let duration = b[0] - a[0];
            *least = least.max((b[c] - a[c] - allowed) / duration);
            *most = most.min((b[c] - a[c] + allowed) / duration);
        }
    }
}
