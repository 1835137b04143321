//! Measures of the difference between two runs of a scene.
//!
//! Both runs are given as [`Record`]s: quantities sampled at the same times. The difference of a quantity y is relative
//! to its scale
//!
//! ```text
//! S = max( range of y with zero included, 1e-3 of the largest such range among quantities of its kind,
//!          least scale of y )
//! ```
//!
//! [`Measure::History`] is the largest |y_a - y_b| / S at equal times. [`Measure::Extremes`] compares what engineers
//! read from a run, and does not count a shift in time by less than a bounce of a wheel:
//!
//! 1. the largest and the smallest value over the whole run;
//! 2. the envelope. Windows have the length of three periods of the slowest bounce and overlap by half. The maximum of
//!    one run in a window must not exceed that of the other run in the window widened by one period at both ends, and
//!    vice versa; minima likewise;
//! 3. the mean over each window.
//!
//! Windows keep an error late in a run from hiding behind an early peak. In a run of more than [`MANY`] bounces that
//! dampers of the wheels do not reduce, their phases cannot be known: which wheel of a body is the more heavily loaded one at a
//! given time is then a matter of chance. There the window is the whole run, and the extremes of a quantity are taken
//! over all wheels of a body, with the largest scale of these wheels.

use std::cell::OnceCell;
use std::collections::VecDeque;

use crate::{Channel, History};

/// Scale of the smallest quantities, relative to the largest of their kind.
const FLOOR: f64 = 1e-3;
/// Length of a window, in periods of the slowest bounce.
const PERIODS: f64 = 3.0;
/// Number of bounces up to which their phases count.
pub(super) const MANY: f64 = 100.0;

/// Measure of the error of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Measure {
    /// Extremes over the run and envelopes over windows of time.
    #[default]
    Extremes,
    /// Values at equal times.
    History,
}

/// A quantity of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedQuantity {
    /// Name for messages.
    pub name: String,
    /// Quantities of equal kind have the same dimension and are of comparable size.
    pub kind: &'static str,
    /// The channel that it is read from, if it is one channel.
    pub channel: Option<Channel>,
    /// Whether its scale is its range without zero, as for positions, whose origin has no meaning.
    pub is_position: bool,
    /// Quantities of equal group are one quantity at several wheels of a body; empty: it belongs to no wheel.
    pub group: String,
    /// Least scale of the quantity, below which its values are rounding errors.
    pub least_scale: f64,
    /// One value for each time of the record.
    pub values: Vec<f64>,
}

/// The quantities of a run whose error matters, at increasing times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// Times.
    pub time: Vec<f64>,
    /// Quantities.
    pub quantities: Vec<RecordedQuantity>,
}

impl Record {
    /// The displacements of all bodies and the vertical, lateral and longitudinal forces and deflections at all wheels,
    /// the forces of ropes and stops, and the gauges.
    #[must_use]
    pub fn of(history: &History) -> Record {
        let quantity = |channel: &Channel| {
            let (kind, is_position) = match channel {
                Channel::Displacement(_, crate::BodyDof::X) => ("position", true),
                Channel::Displacement(_, dof) if (*dof as usize) < 3 => ("displacement", false),
                Channel::Displacement(..) => ("rotation", false),
                Channel::Vertical(_) | Channel::Lateral(_) | Channel::Traction(_) => {
                    ("force", false)
                }
                Channel::Tension(_) | Channel::Stop(_) => ("force", false),
                Channel::Deflection(_) | Channel::Gauge(_) => ("displacement", false),
                Channel::Drive(_) => ("force", false),
                _ => return None,
            };
            let (name, values) = (format!("{channel:?}"), history.column(*channel));
            Some(RecordedQuantity {
                name,
                kind,
                channel: Some(*channel),
                is_position,
                group: String::new(),
                least_scale: 0.0,
                values,
            })
        };
        let quantities = history.channels().iter().filter_map(quantity).collect();
        Record {
            time: history.column(Channel::Time),
            quantities,
        }
    }

    /// This record with the first `count` values of each quantity from `other`, as far as both reach.
    pub(super) fn with_start_of(&self, other: &Record, count: usize) -> Record {
        let mut mixed = self.clone();
        for (own, other) in mixed.quantities.iter_mut().zip(&other.quantities) {
            let count = count.min(own.values.len()).min(other.values.len());
            own.values[..count].copy_from_slice(&other.values[..count]);
        }
        mixed
    }

    /// The quantities that are channels of the run: motions, wheel forces and gauges, but neither reactions nor internal forces.
    pub(super) fn motion(&self) -> Record {
        let own = self
            .quantities
            .iter()
            .filter(|quantity| quantity.channel.is_some());
        Record {
            time: self.time.clone(),
            quantities: own.cloned().collect(),
        }
    }

    /// Scale of every quantity, see the head of this module; 0 for a quantity of a kind that is zero throughout.
    #[must_use]
    pub fn scales(&self) -> Vec<f64> {
        let range = |quantity: &RecordedQuantity| {
            let first = quantity.values.first().copied().unwrap_or_default();
            let start = if quantity.is_position { first } else { 0.0 };
            let [low, high] = extremes(&quantity.values, start);
            high - low
        };
        let ranges: Vec<f64> = self.quantities.iter().map(range).collect();
        let largest = |kind: &str| {
            let of_kind = self
                .quantities
                .iter()
                .zip(&ranges)
                .filter(|(other, _)| other.kind == kind);
            of_kind.fold(0.0_f64, |most, (_, range)| most.max(*range))
        };
        let own = self.quantities.iter().zip(&ranges);
        own.map(|(own, range)| range.max(FLOOR * largest(own.kind)).max(own.least_scale))
            .collect()
    }
}

/// Number of values that are compared side by side.
const LANES: usize = 8;

/// Smallest and largest of `values` and `start`; what is not a number does not count.
fn extremes(values: &[f64], start: f64) -> [f64; 2] {
    let (mut low, mut high) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
    let blocks = values.chunks_exact(LANES);
    let last = blocks.remainder();
    let mut add = |block: &[f64]| {
        for ((low, high), value) in low.iter_mut().zip(&mut high).zip(block) {
            *low = if *value < *low { *value } else { *low };
            *high = if *value > *high { *value } else { *high };
        }
    };
    blocks.for_each(&mut add);
    add(last);
    [
        low.into_iter().fold(start, f64::min),
        high.into_iter().fold(start, f64::max),
    ]
}

/// Smallest and largest of `values`; zeros where there are none.
fn own_extremes(values: &[f64]) -> [f64; 2] {
    extremes(values, values.first().copied().unwrap_or_default())
}

/// Difference of two runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The largest difference of a quantity; infinite where the runs cannot be compared.
    pub largest: f64,
    /// Name of that quantity; empty where all are equal.
    pub quantity: String,
    /// The largest difference of a motion, a wheel force or a gauge: of what is a channel of the run, as reactions and internal
    /// forces are not.
    pub of_motion: f64,
}

/// Bounces of bodies on their wheels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounces {
    /// Period of the slowest bounce, on flexible rails.
    pub slowest: f64,
    /// Number of bounces after which the run still depends on the phase of the first one.
    pub remembered: f64,
}

impl Bounces {
    /// Whether there are so many that their phases do not count.
    fn are_many(&self) -> bool {
        self.remembered > MANY
    }
}

/// Difference of record `a` from record `b` of the same scene. Where the runs were ended by a rule at different times,
/// the difference of these times, relative to the later one, counts as well, and values are compared as far as both
/// runs reach.
#[must_use]
pub fn difference(a: &Record, b: &Record, measure: Measure, bounces: Bounces) -> Difference {
    let unknown = Difference {
        largest: f64::INFINITY,
        quantity: String::new(),
        of_motion: f64::INFINITY,
    };
    if a.quantities.len() != b.quantities.len() || a.time.is_empty() || b.time.is_empty() {
        return unknown;
    }
    let last = |record: &Record| record.time[record.time.len() - 1];
    let (ends, count) = ([last(a), last(b)], a.time.len().min(b.time.len()));
    let duration = (ends[0] - ends[1]).abs() / ends[0].max(ends[1]).max(f64::MIN_POSITIVE);
    let mut found = Difference {
        largest: 0.0,
        quantity: String::new(),
        of_motion: 0.0,
    };
    if a.time.len() != b.time.len() && duration > 0.0 {
        found = Difference {
            largest: duration,
            quantity: "time of the end".to_owned(),
            of_motion: duration,
        };
    }
    let is_long = bounces.are_many();
    let windows = Windows::new(
        &b.time[..count],
        if is_long {
            f64::INFINITY
        } else {
            bounces.slowest
        },
    );
    let scales = b.scales();
    for (index, mut scale) in scales.iter().copied().enumerate() {
        let [one, other] = [a, b].map(|record| &record.quantities[index]);
        let values = [&one.values[..count], &other.values[..count]];
        if values[0] == values[1] {
            continue;
        }
        let largest = match measure {
            Measure::History => pointwise(values),
            Measure::Extremes if is_long && !other.group.is_empty() => {
                scale = group_scale(b, &scales, &other.group);
                let [a, b] = [a, b].map(|record| group_extremes(record, &other.group, count));
                (a[0] - b[0]).abs().max((a[1] - b[1]).abs())
            }
            Measure::Extremes => windows
                .outline(values[0])
                .difference(&windows.outline(values[1])),
        };
        let relative = if largest == 0.0 { 0.0 } else { largest / scale };
        if relative.is_nan() {
            return unknown;
        }
        if relative > found.largest {
            found.largest = relative;
            found.quantity.clone_from(&other.name);
        }
        if other.channel.is_some() {
            found.of_motion = found.of_motion.max(relative);
        }
    }
    found
}

/// Difference that two records with a difference D before the time `start` are expected to reach until the time `end`, and the
/// quantity with the largest one before `start`. A wheel that bounces a little too fast is ahead by more with every bounce,
/// so that differences of its motion and its forces grow linearly with time:
///
/// ```text
/// D(end) = D(start) + (D(start) - D(start/2)) / (start/2) * (end - start),    no less than D(start)
/// ```
///
/// Reactions and internal forces do not count: theirs are largest where a motion begins.
///
/// By extremes in a run of many bounces neither phases nor what they do to single bounces counts, but for the last one: D is then
/// the difference at equal times, and counts by the [`share_at_end`] of `b`.
pub(super) fn drift(
    a: &Record,
    b: &Record,
    measure: Measure,
    bounces: Bounces,
    [start, end]: [f64; 2],
) -> Difference {
    let (measure, share) = match measure {
        Measure::Extremes if bounces.are_many() => {
            (Measure::History, share_at_end(b, bounces.slowest))
        }
        _ => (measure, 1.0),
    };
    let (a, b) = (a.motion(), b.motion());
    let until = |time: f64| {
        let count = b.time.partition_point(|t| *t <= time);
        difference(&b.with_start_of(&a, count), &b, measure, bounces)
    };
    let [half, whole] = [0.5 * start, start].map(until);
    let growth = (whole.largest - half.largest).max(0.0) / (0.5 * start) * (end - start).max(0.0);
    let largest = share * (whole.largest + growth);
    Difference {
        largest,
        quantity: whole.quantity,
        of_motion: largest,
    }
}

/// Largest change of the extremes of a record that a shift of its motion in time may cause, relative to the largest change
/// of its motion at equal times. A shift by less than a bounce moves an extreme in time and leaves its value, but for those
/// that the end of the run cuts off: values that are reached within the last `period` change like all values there, in
/// proportion to how far they move within it.
fn share_at_end(record: &Record, period: f64) -> f64 {
    let Some(end) = record.time.last() else {
        return 0.0;
    };
    let last = record.time.partition_point(|t| *t < end - period);
    let scales = record.scales();
    let [mut cut_off, mut motion] = [0.0_f64; 2];
    for (quantity, scale) in record
        .quantities
        .iter()
        .zip(scales)
        .filter(|(_, scale)| *scale > 0.0)
    {
        let [whole, own] = [&quantity.values[..], &quantity.values[last..]].map(own_extremes);
        let swing = (own[1] - own[0]) / scale;
        if quantity.channel.is_some() && !quantity.is_position {
            motion = motion.max(swing);
        }
        if quantity.group.is_empty() && (own[0] == whole[0] || own[1] == whole[1]) {
            cut_off = cut_off.max(swing);
        }
    }
    if motion > 0.0 {
        (cut_off / motion).min(1.0)
    } else {
        0.0
    }
}

/// Smallest and largest value of the quantities of a group in the first `count` samples.
fn group_extremes(record: &Record, group: &str, count: usize) -> [f64; 2] {
    let own = record
        .quantities
        .iter()
        .filter(|quantity| quantity.group == group);
    let all = own.map(|quantity| own_extremes(&quantity.values[..count]));
    all.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
        .unwrap_or_default()
}

/// Scale of the extremes of a group: the largest one of its quantities.
fn group_scale(record: &Record, scales: &[f64], group: &str) -> f64 {
    let own = record
        .quantities
        .iter()
        .zip(scales)
        .filter(|(quantity, _)| quantity.group == group);
    own.fold(0.0, |most, (_, scale)| most.max(*scale))
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Largest difference at equal times.
fn pointwise([a, b]: [&[f64]; 2]) -> f64 {
    a.iter()
        .zip(b)
        .fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs()))
}

/// Largest magnitude within `reach` samples of each sample. A queue holds the samples whose magnitude no later sample within
/// reach exceeds, so that its first one has the largest.
fn largest_within(values: &[f64], reach: usize) -> Vec<f64> {
    let size = |at: usize| values[at].abs();
    let mut queue: VecDeque<usize> = VecDeque::new();
    let mut next = 0;
    let mut largest_at = |i: usize| {
        while next < values.len() && next <= i.saturating_add(reach) {
            while queue.back().is_some_and(|last| size(*last) <= size(next)) {
                queue.pop_back();
            }
            queue.push_back(next);
            next += 1;
        }
        while queue
            .front()
            .is_some_and(|first| first.saturating_add(reach) < i)
        {
            queue.pop_front();
        }
        size(queue.front().copied().unwrap_or(i))
    };
    (0..values.len()).map(&mut largest_at).collect()
}

/// Windows of a record: ranges of samples, and the same ranges widened by one period.
struct Windows {
    own: Vec<std::ops::Range<usize>>,
    wide: Vec<std::ops::Range<usize>>,
}

impl Windows {
    fn new(time: &[f64], period: f64) -> Windows {
        let (first, last) = (time[0], time[time.len() - 1]);
        let length = PERIODS * period;
        let count = ((last - first) / (0.5 * length)).floor();
        // also true where the period is zero or not a number
        if !(count >= 2.0 && count <= time.len() as f64) {
            let whole = 0..time.len();
            return Windows {
                own: vec![whole.clone()],
                wide: vec![whole],
            };
        }
        let between = |from: f64, to: f64| {
            let start = time.partition_point(|t| *t < from);
            start
                ..time
                    .partition_point(|t| *t <= to)
                    .max(start + 1)
                    .min(time.len())
        };
        let count = count as usize - 1;
        let spans = (0..count).map(|k| {
            let from = first + 0.5 * length * k as f64;
            [from, if k + 1 == count { last } else { from + length }]
        });
        let (own, wide) = spans
            .map(|[from, to]| (between(from, to), between(from - period, to + period)))
            .unzip();
        Windows { own, wide }
    }

    /// What is compared of the values of a quantity.
    fn outline(&self, values: &[f64]) -> Outline {
        let of = |range: &std::ops::Range<usize>| own_extremes(&values[range.clone()]);
        let windows = self.own.iter().zip(&self.wide).map(|(own, wide)| Window {
            own: of(own),
            wide: of(wide),
            mean: mean(&values[own.clone()]),
        });
        Outline {
            whole: own_extremes(values),
            windows: windows.collect(),
            is_finite: values.iter().all(|value| value.is_finite()),
        }
    }
}

/// What [`Measure::Extremes`] compares of one quantity.
struct Outline {
    /// Smallest and largest value over the run.
    whole: [f64; 2],
    windows: Vec<Window>,
    /// Whether all values are finite.
    is_finite: bool,
}

/// Extremes in a window and in the widened one, and the mean in it.
struct Window {
    own: [f64; 2],
    wide: [f64; 2],
    mean: f64,
}

impl Outline {
    /// Largest difference of extremes over the run, of the envelopes, and of the means; not a number where a value is none.
    fn difference(&self, other: &Outline) -> f64 {
        // maxima ignore what is not a number
        if !(self.is_finite && other.is_finite) {
            return f64::NAN;
        }
        let means = self
            .windows
            .iter()
            .zip(&other.windows)
            .map(|(a, b)| (a.mean - b.mean).abs());
        means.fold(self.difference_of_extremes(other), f64::max)
    }

    /// Largest difference of extremes over the run, and of the envelopes.
    fn difference_of_extremes(&self, other: &Outline) -> f64 {
        let [a, b] = [self.whole, other.whole];
        let mut most = (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
        for (a, b) in self.windows.iter().zip(&other.windows) {
            most = most.max(a.own[1] - b.wide[1]).max(b.own[1] - a.wide[1]);
            most = most.max(b.wide[0] - a.own[0]).max(a.wide[0] - b.own[0]);
        }
        most
    }
}

/// A record whose single quantities are compared with many others by [`Measure::Extremes`], in a run whose phases count.
pub(super) struct Outlined<'a> {
    record: &'a Record,
    windows: Windows,
    scales: Vec<f64>,
    /// By quantity, made when it is first compared.
    outlines: Vec<OnceCell<Outline>>,
}

impl<'a> Outlined<'a> {
    /// The record; `None` where bounces are so many that wheels are compared together, or where it is empty.
    pub fn new(record: &'a Record, bounces: Bounces) -> Option<Outlined<'a>> {
        if bounces.are_many() || record.time.is_empty() {
            return None;
        }
        let outlines = record.quantities.iter().map(|_| OnceCell::new()).collect();
        let (windows, scales) = (Windows::new(&record.time, bounces.slowest), record.scales());
        Some(Outlined {
            record,
            windows,
            scales,
            outlines,
        })
    }

    /// Scale of the differences of quantity `index`.
    pub fn scale(&self, index: usize) -> f64 {
        self.scales[index]
    }

    /// Difference of quantity `index` from itself with the values `lacking` added, relative to its scale: at most the largest
    /// of their magnitudes. Not a number where a value is none.
    pub fn difference(&self, index: usize, lacking: &[f64]) -> f64 {
        let sum: Vec<f64> = self.record.quantities[index]
            .values
            .iter()
            .zip(lacking)
            .map(|(value, by)| value + by)
            .collect();
        self.relative(
            index,
            self.windows.outline(&sum).difference(self.own(index)),
        )
    }

    /// The same where `lacking` is an oscillation whose phase is not known. With the amplitude A, the largest magnitude of the
    /// oscillation within `reach` samples of each, the extremes of y become those of y + A or of y - A, and the means those of
    /// y + `lacking`.
    pub fn difference_by_amplitude(&self, index: usize, lacking: &[f64], reach: usize) -> f64 {
        let own = self.own(index);
        // maxima ignore what is not a number
        if !own.is_finite || lacking.iter().any(|value| !value.is_finite()) {
            return f64::NAN;
        }
        let means = self
            .windows
            .own
            .iter()
            .map(|range| mean(&lacking[range.clone()]).abs());
        let mut largest = means.fold(0.0, f64::max);
        let values = &self.record.quantities[index].values;
        let amplitude = largest_within(lacking, reach);
        let mut sum = vec![0.0; values.len()];
        for sign in [-1.0, 1.0] {
            for (sum, (value, by)) in sum.iter_mut().zip(values.iter().zip(&amplitude)) {
                *sum = value + sign * by;
            }
            largest = largest.max(self.windows.outline(&sum).difference_of_extremes(own));
        }
        self.relative(index, largest)
    }

    /// The outline of quantity `index`.
    fn own(&self, index: usize) -> &Outline {
        self.outlines[index]
            .get_or_init(|| self.windows.outline(&self.record.quantities[index].values))
    }

    fn relative(&self, index: usize, largest: f64) -> f64 {
        if largest == 0.0 {
            0.0
        } else {
            largest / self.scales[index]
        }
    }
}

#[cfg(test)]
mod tests;
