//! Loads on a structure and motions of its degrees of freedom between the rows of a history.

use std::borrow::Cow;
use std::cell::OnceCell;
use std::ops::{Range, RangeInclusive};

use sim::{Channel, History};
use trains::{MemberForces, RailLoad, RailMember};

use crate::response::{LoadSource, WheelLoadReader};

/// Change of the slope from interval to interval, relative to the slopes beside it, above which values are interpolated
/// linearly: a force jumps there or has a corner.
const CORNER: f64 = 0.25;

/// How far a value between rows may lie beyond their range, relative to it: the vertex of a parabola through four even rows
/// is beyond it by at most an eighth, and values just beside the rows are extrapolated.
const OVERSHOOT: f64 = 0.5;

/// Distance from an end of a member, relative to its coordinate plus 1, within which a load is at it: the slack with which
/// the step of a rolling wheel ends there, for accuracies up to 1e-2.
const AT_END: f64 = 4e-6;

/// Distance from an end of a member, relative to the length of the member, within which a load is kept on its side of the
/// end: within 1e-9 of the length it would count on the members of both.
const BESIDE_END: f64 = 1.5e-9;

/// Least time of a passage behind a row, in rows: at the row itself a load that comes to an end is before it.
const AFTER_ROW: f64 = 1e-9;

/// Time from a corner, in rows, within which a passage is the corner: rows may be so near to each other that rounding of
/// coordinates is a part of the interval.
const AT_CORNER: f64 = 1e-3;

/// An end of one or two members on a rail.
#[derive(Clone, Copy, Debug)]
pub(super) struct MemberEnd {
    pub rail: usize,
    pub x: f64,
    /// Distance from it to which loads are kept on their side.
    gap: f64,
}

impl MemberEnd {
    /// The ends of all members, those at the same place once.
    pub fn all(members: &MemberForces) -> Vec<MemberEnd> {
        let of_member = |own: RailMember| {
            let gap = BESIDE_END * (own.x[1] - own.x[0]).abs();
            own.x.map(|x| MemberEnd {
                rail: own.rail,
                x,
                gap,
            })
        };
        let mut ends: Vec<MemberEnd> = members.members().flat_map(of_member).collect();
        ends.sort_by(|a, b| a.rail.cmp(&b.rail).then(a.x.total_cmp(&b.x)));
        ends.dedup_by(|next, kept| {
            let gap = kept.gap.max(next.gap);
            let is_same = next.rail == kept.rail && next.x - kept.x <= gap;
            if is_same {
                kept.gap = gap;
            }
            is_same
        });
        ends
    }

    /// Whether a load is at the end, within the slack with which the steps of a run end there.
    pub fn has(&self, load: &RailLoad) -> bool {
        self.rail == load.rail && (load.x - self.x).abs() <= self.slack()
    }

    /// The coordinate of a load, kept on one side of the end: that of larger coordinates where `side` is 1, otherwise -1.
    fn aside(&self, x: f64, side: f64) -> f64 {
        self.x + side * (side * (x - self.x)).max(self.gap)
    }

    fn slack(&self) -> f64 {
        (AT_END * (1.0 + self.x.abs())).max(self.gap)
    }
}

/// State of a structure at one time.
#[derive(Clone)]
pub(super) struct LoadState<'a> {
    pub time: f64,
    /// Loads on its rails, always in the same order.
    pub loads: Cow<'a, [RailLoad]>,
    values: StateValues<'a>,
    /// Range of the displacements of its degrees of freedom among the values; their accelerations follow.
    dofs: Range<usize>,
}

/// The values of a state, which are interpolated when they are needed.
#[derive(Clone)]
#[expect(
    clippy::large_enum_variant,
    reason = "a search makes thousands of states, one after the other"
)]
enum StateValues<'a> {
    Row(&'a [f64]),
    Between(Between<'a>),
    Limit(Vec<f64>),
}

impl LoadState<'_> {
    /// Displacements of the degrees of freedom of the structure.
    pub fn dofs(&self) -> Cow<'_, [f64]> {
        self.values(self.dofs.clone())
    }

    /// Accelerations of the degrees of freedom.
    pub fn accelerations(&self) -> Cow<'_, [f64]> {
        self.values(self.dofs.end..2 * self.dofs.end - self.dofs.start)
    }

    fn values(&self, range: Range<usize>) -> Cow<'_, [f64]> {
        match &self.values {
            StateValues::Row(values) => Cow::Borrowed(&values[range]),
            StateValues::Limit(values) => Cow::Borrowed(&values[range]),
            StateValues::Between(between) => Cow::Owned(between.values(range)),
        }
    }
}

/// The states of a structure over time: rows of a history, and between them cubic polynomials through
/// four rows, channel by channel.
///
/// Forces have corners, and with dampers jumps, where wheels pass the ends of members. No polynomial extends across these
/// times: beside them it is one through rows of the same side, extrapolated. At a row at which a wheel comes to an end of a
/// member the force is that before the end, and the wheel stands just before it. Where the four rows show another jump or
/// corner, for instance of a contact that opens, values are interpolated linearly; beside a passage those that jump there are
/// those of the row on their side.
pub(super) struct LoadStates {
    /// The loads, with the place of their first value in a row.
    sources: Vec<(LoadSource, usize)>,
    /// Place of the first displacement in a row.
    motions: usize,
    /// Values of a row: the time, those of the loads, displacements and accelerations of the degrees of freedom.
    width: usize,
    /// Row by row.
    values: Vec<f64>,
    /// The loads, row by row.
    loads: Vec<RailLoad>,
    /// Whether a value of a row may jump at a corner: forces and accelerations may, places and displacements may not.
    may_jump: Vec<bool>,
    /// Where loads pass ends of members, by increasing time.
    corners: Vec<Corner>,
}

/// A load that passes an end of a member.
#[derive(Clone, Copy, Debug)]
struct Corner {
    /// Time, counted in rows.
    position: f64,
    /// Index of the load.
    load: usize,
    end: MemberEnd,
    /// 1 where the load moves towards larger coordinates, otherwise -1.
    sense: f64,
}

impl LoadStates {
    /// The states of structure `s` with `dofs` recorded degrees of freedom, by increasing rows of a history. `ends` are the
    /// ends of members by rail.
    pub fn new(
        history: &History,
        loads: &WheelLoadReader,
        (s, dofs): (usize, usize),
        ends: &[MemberEnd],
        rows: &[usize],
    ) -> LoadStates {
        let (mut channels, mut may_jump) = (vec![0], vec![false]);
        let mut sources = Vec::new();
        for source in loads.on(s) {
            sources.push((source.clone(), channels.len()));
            let [place, forces] = source.channels();
            may_jump.extend(
                place
                    .clone()
                    .map(|_| false)
                    .chain(forces.clone().map(|_| true)),
            );
            channels.extend(place.chain(forces));
        }
        let motions = channels.len();
        let first = |wanted| history.position(wanted);
        let motion = first(Channel::Coordinate(s, 0)).zip(first(Channel::Acceleration(s, 0)));
        channels.extend(
            motion
                .iter()
                .flat_map(|(q, a)| (*q..q + dofs).chain(*a..a + dofs)),
        );
        let width = channels.len();
        may_jump.extend((motions..width).map(|c| c - motions >= (width - motions) / 2));
        let mut values = Vec::with_capacity(rows.len() * width);
        let mut loads = Vec::with_capacity(rows.len() * sources.len());
        for &row in rows {
            let sample = history.sample(row);
            let first = values.len();
            values.extend(channels.iter().map(|c| sample[*c]));
            let own = &values[first..];
            for source in &sources {
                let mut load = load(source, &|c| own[c]);
                if let Some(before) = row.checked_sub(1) {
                    stop_before(ends, source.0.load_in(history.sample(before)).x, &mut load);
                }
                loads.push(load);
            }
        }
        let mut out = LoadStates {
            sources,
            motions,
            width,
            values,
            loads,
            may_jump,
            corners: Vec::new(),
        };
        out.corners = out.all_corners(ends);
        out
    }

    /// The passages of ends of members by loads, by increasing time.
    fn all_corners(&self, ends: &[MemberEnd]) -> Vec<Corner> {
        let mut corners = Vec::new();
        for row in 1..self.len() {
            for (load, (a, b)) in self.loads(row - 1).iter().zip(self.loads(row)).enumerate() {
                let (low, high) = (a.x.min(b.x), a.x.max(b.x));
                if low < high {
                    let passed = ends
                        .iter()
                        .filter(|end| end.rail == a.rail && low <= end.x && end.x <= high);
                    for &end in passed {
                        let fraction = self
                            .passage(row - 1, load, end.x, [a.x, b.x])
                            .max(AFTER_ROW);
                        let (position, sense) = ((row - 1) as f64 + fraction, (b.x - a.x).signum());
                        corners.push(Corner {
                            position,
                            load,
                            end,
                            sense,
                        });
                    }
                }
            }
        }
        corners.sort_by(|a, b| a.position.total_cmp(&b.position));
        corners
    }

    /// Channels of the values of a row by kind: places and forces of the loads, displacements, and accelerations.
    pub fn kinds(&self) -> [Vec<usize>; 4] {
        let half = self.motions + (self.width - self.motions) / 2;
        let [places, forces] = [false, true].map(|wanted| {
            (1..self.motions)
                .filter(|c| self.may_jump[*c] == wanted)
                .collect()
        });
        [
            places,
            forces,
            (self.motions..half).collect(),
            (half..self.width).collect(),
        ]
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.values.len() / self.width
    }

    /// The values of a row: the time first.
    pub fn row(&self, row: usize) -> &[f64] {
        &self.values[row * self.width..(row + 1) * self.width]
    }

    /// The loads at a row.
    pub fn loads(&self, row: usize) -> &[RailLoad] {
        let count = self.sources.len();
        &self.loads[row * count..(row + 1) * count]
    }

    /// Whether any load has a force along +x, upwards and along +z of its rail at any row.
    pub fn directions(&self) -> [bool; 3] {
        std::array::from_fn(|k| self.loads.iter().any(|load| load.force[k] != 0.0))
    }

    /// The state at a row.
    pub fn at_row(&self, row: usize) -> LoadState<'_> {
        let loads = Cow::Borrowed(self.loads(row));
        self.state(loads, StateValues::Row(self.row(row)))
    }

    /// The state at a time that is counted in rows, between the first and the last.
    pub fn at(&self, position: f64) -> LoadState<'_> {
        match self.between(position) {
            (row, None) => self.at_row(row),
            (_, Some(between)) => {
                let mut loads = self.loads_by(&|c| between.value(c));
                // also a corner at the next row, which is just behind it
                for corner in
                    self.corners_in(position.floor()..=position.floor() + 1.0 + 2.0 * AFTER_ROW)
                {
                    let load = &mut loads.to_mut()[corner.load];
                    let side = if position > corner.position {
                        corner.sense
                    } else {
                        -corner.sense
                    };
                    load.x = corner.end.aside(load.x, side);
                }
                self.state(loads, StateValues::Between(between))
            }
        }
    }

    /// The corners between two times that are counted in rows.
    fn corners_in(&self, positions: RangeInclusive<f64>) -> &[Corner] {
        let first = self
            .corners
            .partition_point(|corner| corner.position < *positions.start());
        let end = self
            .corners
            .partition_point(|corner| corner.position <= *positions.end());
        &self.corners[first..end]
    }

    /// The coordinate of a load at a time that is counted in rows.
    fn coordinate(&self, index: usize, position: f64) -> f64 {
        match self.between(position) {
            (row, None) => self.loads(row)[index].x,
            (_, Some(between)) => load(&self.sources[index], &|c| between.value(c)).x,
        }
    }

    /// All loads by the values of a row.
    fn loads_by(&self, value: &dyn Fn(usize) -> f64) -> Cow<'_, [RailLoad]> {
        self.sources
            .iter()
            .map(|source| load(source, value))
            .collect()
    }

    /// The row at or before a time that is counted in rows, and what interpolates between it and the next.
    fn between(&self, position: f64) -> (usize, Option<Between<'_>>) {
        let last = self.len() - 1;
        let row = (position.max(0.0) as usize).min(last.saturating_sub(1));
        let fraction = position - row as f64;
        if fraction <= 0.0 || last == 0 {
            return (row, None);
        }
        if fraction >= 1.0 {
            return (row + 1, None);
        }
        let ends = [self.row(row), self.row(row + 1)];
        let time = ends[0][0] + fraction * (ends[1][0] - ends[0][0]);
        let corner = self
            .corner_from(row as f64)
            .filter(|corner| *corner <= (row + 1) as f64);
        let is_after = corner.map(|corner| position > corner);
        let starts = match is_after {
            Some(false) => [row.checked_sub(3), None, None],
            Some(true) => [Some(row + 1), None, None],
            None => [row.checked_sub(1), row.checked_sub(2), Some(row)],
        };
        let cubics = Default::default();
        (
            row,
            Some(Between {
                states: self,
                ends,
                fraction,
                time,
                is_after,
                starts,
                cubics,
            }),
        )
    }

    fn four(&self, start: usize) -> [&[f64]; 4] {
        std::array::from_fn(|k| self.row(start + k))
    }

    /// Whether there are four rows without a corner from `start`.
    fn is_clear(&self, start: usize) -> bool {
        let is_inside = |corner: f64| corner <= (start + 3) as f64;
        start + 3 < self.len() && !self.corner_from(start as f64).is_some_and(is_inside)
    }

    /// The first corner that is not before a position.
    fn corner_from(&self, position: f64) -> Option<f64> {
        self.corners
            .get(
                self.corners
                    .partition_point(|corner| corner.position < position),
            )
            .map(|corner| corner.position)
    }

    /// The state just before or just after a corner; the state at the time itself if it is none. Where another corner is too
    /// near for a polynomial, forces are those of the next row on this side, and loads stand where they are at the corner.
    pub fn limit(&self, position: f64, is_after: bool) -> LoadState<'_> {
        let corner = self
            .corner_from(position - AT_CORNER)
            .filter(|corner| corner - position < AT_CORNER);
        let Some(corner) = corner.filter(|_| self.len() > 1) else {
            return self.at(position);
        };
        let (row, start) = if is_after {
            let row = corner.floor() as usize + 1;
            (row, Some(row))
        } else {
            let row = (corner.ceil() as usize).checked_sub(1);
            (
                row.unwrap_or_default(),
                row.and_then(|row| row.checked_sub(3)),
            )
        };
        let row = row.min(self.len() - 1);
        let here = self.at(corner);
        let Some(start) = start.filter(|start| self.is_clear(*start)) else {
            return self.moved(row, here);
        };
        let between = here.time;
        let cubic = Cubic::new(self.four(start), between);
        let mut out = self.row(row).to_vec();
        out[0] = between;
        for (c, out) in out.iter_mut().enumerate().skip(1) {
            *out = cubic.value(c).unwrap_or(*out);
        }
        self.state(self.loads_by(&|c| out[c]), StateValues::Limit(out))
    }

    /// The forces and motions of a row with the places of all loads at another time.
    fn moved(&self, row: usize, at: LoadState<'_>) -> LoadState<'_> {
        let mut out = self.at_row(row);
        out.time = at.time;
        out.loads
            .to_mut()
            .iter_mut()
            .zip(at.loads.iter())
            .for_each(|(load, own)| load.x = own.x);
        out
    }

    /// Fraction of the interval behind `row` at which a load passes `x`, by regula falsi (Illinois). `ends` are its
    /// coordinates at both rows.
    pub fn passage(&self, row: usize, load: usize, x: f64, ends: [f64; 2]) -> f64 {
        let (mut a, mut b) = (0.0, 1.0);
        let [mut low, mut high] = ends.map(|end| end - x);
        if low == 0.0 || low == high {
            return 0.0;
        }
        if high == 0.0 {
            return 1.0;
        }
        let scale = low.abs().max(high.abs());
        for _ in 0..24 {
            let middle = (a * high - b * low) / (high - low);
            let value = self.coordinate(load, row as f64 + middle) - x;
            if value.abs() <= 1e-12 * scale {
                return middle;
            }
            if (value > 0.0) == (high > 0.0) {
                (b, high) = (middle, value);
                low *= 0.5;
            } else {
                (a, low) = (middle, value);
                high *= 0.5;
            }
        }
        0.5 * (a + b)
    }

    fn state<'s>(&self, loads: Cow<'s, [RailLoad]>, values: StateValues<'s>) -> LoadState<'s> {
        let time = match &values {
            StateValues::Row(values) => values[0],
            StateValues::Limit(values) => values[0],
            StateValues::Between(between) => between.time,
        };
        let dofs = self.motions..self.motions + (self.width - self.motions) / 2;
        LoadState {
            time,
            loads,
            values,
            dofs,
        }
    }
}

/// Sets a load that comes from the coordinate `from` to an end of a member to just before it: there it has the force of this
/// side.
fn stop_before(ends: &[MemberEnd], from: f64, load: &mut RailLoad) {
    let sense = (load.x - from).signum();
    let comes_to = |end: &&MemberEnd| {
        let [left, beyond] = [end.x - from, load.x - end.x].map(|distance| sense * distance);
        end.has(load) && left > end.gap && beyond >= -end.gap
    };
    if let Some(end) = ends.iter().find(comes_to) {
        load.x = end.aside(load.x, -sense);
    }
}

/// A load by the values of a row; `first` is the place of its first value.
fn load((source, first): &(LoadSource, usize), value: &dyn Fn(usize) -> f64) -> RailLoad {
    let count: usize = source.channels().into_iter().map(|range| range.len()).sum();
    let mut own = [0.0; 4];
    own[..count]
        .iter_mut()
        .enumerate()
        .for_each(|(k, own)| *own = value(first + k));
    source.load(&own)
}

/// A time between two rows.
#[derive(Clone)]
struct Between<'a> {
    states: &'a LoadStates,
    ends: [&'a [f64]; 2],
    fraction: f64,
    time: f64,
    /// Whether it is behind a corner between the rows; `None` where there is none.
    is_after: Option<bool>,
    /// First rows of the polynomials, best first, as far as there are four rows without a corner between them.
    starts: [Option<usize>; 3],
    /// The polynomials, made when the better ones have no value; `None` where a corner lies between their rows.
    cubics: [OnceCell<Option<Cubic<'a>>>; 3],
}

impl Between<'_> {
    /// Value `c` of a row.
    fn value(&self, c: usize) -> f64 {
        if c == 0 {
            self.time
        } else {
            self.value_by(c, 0)
        }
    }

    /// Value `c` of a row by the polynomials from number `first` on.
    fn value_by(&self, c: usize, first: usize) -> f64 {
        let [from, to] = self.ends.map(|row| row[c]);
        // all polynomials have one of both ends, and no value beside a zero
        if from != 0.0 || to != 0.0 {
            for number in first..self.starts.len() {
                if let Some(value) = self.cubic(number).and_then(|cubic| cubic.value(c)) {
                    return value;
                }
            }
        }
        match self.is_after.filter(|_| self.states.may_jump[c]) {
            Some(false) => from,
            Some(true) => to,
            None => from + self.fraction * (to - from),
        }
    }

    /// Values of a range of motions.
    fn values(&self, range: Range<usize>) -> Vec<f64> {
        let best = self.cubic(0);
        range
            .map(|c| {
                best.and_then(|best| best.value(c))
                    .unwrap_or_else(|| self.value_by(c, 1))
            })
            .collect()
    }

    fn cubic(&self, number: usize) -> Option<&Cubic<'_>> {
        let start = || self.starts[number].filter(|start| self.states.is_clear(*start));
        let make = || start().map(|start| Cubic::new(self.states.four(start), self.time));
        self.cubics[number].get_or_init(make).as_ref()
    }
}

/// The Lagrange polynomials through four rows at one time.
#[derive(Clone)]
struct Cubic<'a> {
    rows: [&'a [f64]; 4],
    weights: [f64; 4],
    /// Reciprocals of the three intervals.
    rates: [f64; 3],
}

impl<'a> Cubic<'a> {
    fn new(rows: [&'a [f64]; 4], time: f64) -> Cubic<'a> {
        let weight = |i: usize| {
            let others = rows.iter().enumerate().filter(|(j, _)| *j != i);
            others
                .map(|(_, other)| (time - other[0]) / (rows[i][0] - other[0]))
                .product()
        };
        let rates = std::array::from_fn(|i| 1.0 / (rows[i + 1][0] - rows[i][0]));
        Cubic {
            rows,
            weights: std::array::from_fn(weight),
            rates,
        }
    }

    /// The value of channel `c`; `None` where it has a jump or a corner, or where the rows are so uneven that the polynomial
    /// leaves their range. A value that is exactly zero is a force of a contact that is open, and there is a corner beside it.
    fn value(&self, c: usize) -> Option<f64> {
        let values = self.rows.map(|row| row[c]);
        if values.contains(&0.0) {
            return None;
        }
        let slope = |i: usize| (values[i + 1] - values[i]) * self.rates[i];
        let [a, b, d] = [slope(0), slope(1), slope(2)];
        if (d - 2.0 * b + a).abs() > CORNER * (a.abs() + d.abs()) {
            return None;
        }
        let value: f64 = values
            .iter()
            .zip(self.weights)
            .map(|(value, weight)| weight * value)
            .sum();
        let [low, high] = values[1..]
            .iter()
            .fold([values[0]; 2], |[low, high], &value| {
                [
                    if value < low { value } else { low },
                    if value > high { value } else { high },
                ]
            });
        let beyond = OVERSHOOT * (high - low);
        (low - beyond <= value && value <= high + beyond).then_some(value)
    }
}
