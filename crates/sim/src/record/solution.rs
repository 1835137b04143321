//! The solution of a run: every channel as a function of time.
//!
//! In each interval between two times a channel is the polynomial through values that the method of integration gives inside its
//! step ([`piecewise::fit()`]); at breaks and events it may jump. Values at any time, output rows and extremes are those of the
//! polynomials, so that they do not depend on output times.

use piecewise::{Piecewise, Polynomial, Side};
use smallvec::SmallVec;

use super::history::History;
use super::modal_motion::ModalMotion;
use super::recorder::Recorder;
use crate::{BodyDof, Channel};

/// Largest error of a polynomial where it is tested, relative to the largest value of its kind, per unit of the accuracy of the
/// scene.
const FOLLOWED: f64 = 0.1;

/// The same for positions along rails, relative to their size: forces depend on them by the shape of the rail.
const FOLLOWED_POSITION: f64 = 1e-4;

/// Finest accuracy with which a run is followed: beyond it, what is seen between the times of a step is rounding.
const FINEST: f64 = 1e-11;

/// Differences, relative to the largest value of their kind, that are rounding.
const ROUNDING: f64 = 1e-12;

/// The same for accelerations of structures, which are differences of larger forces.
const ROUNDING_ACCELERATION: f64 = 1e-9;

/// Length, relative to a step, below which an interval is not halved.
const SHORTEST: f64 = 0.015;

/// Every channel of a run as a function of time.
///
/// ```
/// # use std::ops::ControlFlow;
/// # use sim::{Body, Channel, Contact, Damper, Foundation, NormalLaw, Scene, Wheel};
/// use sim::Side;
///
/// # let mut scene = Scene {
/// #     bodies: vec![Body { start: [0.0, 0.1, 0.0, 0.0, 0.0, 0.0], ..Body::new(1000.0, [1.0; 3]) }],
/// #     wheels: vec![Wheel::new(0.5, NormalLaw::linear(1e7, 0.0, Damper::Rail))],
/// #     contacts: vec![Contact::new(0, [0.0; 3])],
/// #     ..Scene::default()
/// # };
/// # scene.bodies[0].free = [false, true, false, false, false, false];
/// // A wheel dropped from 0.1 m onto a rigid rail: m g + sqrt((m g)^2 + 2 k m g h)
/// let run = sim::run(&scene, &[Foundation::rigid()], &mut |_| ControlFlow::Continue(()))?;
/// let largest = run.solution.largest(&[(Channel::Vertical(0), 1.0)]).expect("there is a wheel");
/// let weight: f64 = 9810.0;
/// let exact = weight + (weight * (weight + 2.0 * 1e7 * 0.1)).sqrt();
/// assert!((largest.value / exact - 1.0).abs() < 1e-6);
/// let there = run.solution.value(Channel::Vertical(0), largest.time, Side::Before);
/// assert!((there / exact - 1.0).abs() < 1e-6);
/// # Ok::<(), sim::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solution {
    channels: Vec<Channel>,
    sources: Vec<Source>,
    function: Piecewise,
    /// The motion of natural modes by their propagators, if there is one.
    modes: ModalMotion,
    /// The values at the start.
    start: Vec<f64>,
    /// Times inside the run at which values may jump.
    breaks: Vec<f64>,
}

/// Where the values of a channel come from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Source {
    Time,
    Fixed(f64),
    Column(usize),
    /// A column of a force that only presses, or only pulls.
    OneSided(usize),
    /// The displacement of a mode, or its acceleration behind them.
    Mode(usize),
}

/// The largest or smallest value of a quantity over a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeExtreme {
    /// The time, the first of equal values.
    pub time: f64,
    /// The value.
    pub value: f64,
}

impl Solution {
    /// The channels, in the order of the rows.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The columns that change over time as functions of it, without names.
    #[must_use]
    pub fn function(&self) -> &Piecewise {
        &self.function
    }

    /// Times inside the run at which values may jump: breaks of rails, motions and loads, and events.
    #[must_use]
    pub fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    /// Whether the run has no length.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.function.is_empty()
    }

    /// Position of a channel in every row; `None` if the scene does not have it.
    #[must_use]
    pub fn position(&self, channel: Channel) -> Option<usize> {
        self.channels.iter().position(|&known| known == channel)
    }

    /// Value of a channel; 0 if the scene does not have it.
    #[must_use]
    pub fn value(&self, channel: Channel, t: f64, side: Side) -> f64 {
        let at_start = self.is_empty() || t <= 0.0;
        let column = |column: usize| match at_start {
            true => self.start[column],
            false => self.function.value(t, side, column),
        };
        match self.position(channel).map(|at| self.sources[at]) {
            None => 0.0,
            Some(Source::Time) => t,
            Some(Source::Fixed(value)) => value,
            Some(Source::Column(at)) => column(at),
            Some(Source::OneSided(at)) => column(at).max(0.0),
            Some(Source::Mode(mode)) => {
                let mut modes = vec![0.0; 2 * self.modes.len()];
                self.modes.fill(t, side == Side::After, &mut modes);
                modes[mode]
            }
        }
    }

    /// Appends the values of all channels at a time.
    pub fn row(&self, t: f64, side: Side, to: &mut Vec<f64>) {
        let mut columns = SmallVec::<[f64; 64]>::from_slice(&self.start);
        if t > 0.0 && !self.is_empty() {
            self.function.row(t, side, &mut columns);
        }
        self.put(t, side, &columns, to);
    }

    fn put(&self, t: f64, side: Side, columns: &[f64], to: &mut Vec<f64>) {
        let mut modes = SmallVec::<[f64; 32]>::from_elem(0.0, 2 * self.modes.len());
        self.modes.fill(t, side == Side::After, &mut modes);
        to.extend(self.sources.iter().map(|source| match source {
            Source::Time => t,
            Source::Fixed(value) => *value,
            Source::Column(column) => columns[*column],
            Source::OneSided(column) => columns[*column].max(0.0),
            Source::Mode(mode) => modes[*mode],
        }));
    }

    /// Rows at increasing times. At a break a row has the values before it.
    #[must_use]
    pub fn history(&self, times: impl IntoIterator<Item = f64>) -> History {
        let mut values = Vec::new();
        for t in times {
            self.row(t, Side::Before, &mut values);
        }
        History::of(self.channels.clone(), values)
    }

    /// Rows at the nodes of all intervals, of which each has one at either end: where values jump there are two of one time.
    #[must_use]
    pub fn intervals(&self) -> SolutionNodes {
        let (mut values, mut intervals, mut count) = (Vec::new(), Vec::new(), 1);
        self.put(0.0, Side::After, &self.start, &mut values);
        let mut last: &[f64] = &self.start;
        for piece in self.function.pieces() {
            let mut each = piece.nodes().nodes().iter().zip(piece.rows()).peekable();
            if let Some((_, row)) = each.next_if(|(_, row)| *row == last) {
                last = row;
            } else if let Some((_, row)) = each.next() {
                self.put(piece.interval[0], Side::After, row, &mut values);
                (last, count) = (row, count + 1);
            }
            intervals.push(NodeInterval {
                first: count - 1,
                degree: piece.degree(),
            });
            for (node, row) in each {
                self.put(piece.time(*node), Side::Before, row, &mut values);
                (last, count) = (row, count + 1);
            }
        }
        SolutionNodes {
            rows: History::of(self.channels.clone(), values),
            intervals,
        }
    }

    /// A sum of columns and a constant in interval `k` as a polynomial of the share of the interval.
    fn in_piece(&self, k: usize, columns: &[(usize, f64)], fixed: f64) -> Polynomial {
        let own = self.function.piece(k).combination(columns);
        if fixed == 0.0 {
            own
        } else {
            Polynomial::new(own.coefficients().iter().map(|c| c + fixed))
        }
    }

    /// The columns of a sum of channels, and the sum of those that are constant. Time and natural modes do not count.
    fn columns(&self, terms: &[(Channel, f64)]) -> (SmallVec<[(usize, f64); 8]>, f64) {
        let (mut columns, mut fixed) = (SmallVec::new(), 0.0);
        for (channel, factor) in terms {
            match self.position(*channel).map(|at| self.sources[at]) {
                Some(Source::Column(column) | Source::OneSided(column)) => {
                    columns.push((column, *factor));
                }
                Some(Source::Fixed(value)) => fixed += factor * value,
                Some(Source::Time | Source::Mode(_)) | None => {}
            }
        }
        (columns, fixed)
    }

    /// The largest value of a sum of channels with factors; `None` for a run without length.
    #[must_use]
    pub fn largest(&self, terms: &[(Channel, f64)]) -> Option<TimeExtreme> {
        let (columns, fixed) = self.columns(terms);
        let start: f64 = columns
            .iter()
            .map(|(at, factor)| factor * self.start[*at])
            .sum();
        let [first, _] = self.function.range()?;
        let mut best = TimeExtreme {
            time: first,
            value: start + fixed,
        };
        for (k, piece) in self.function.pieces().enumerate() {
            if let Some(found) = self.in_piece(k, &columns, fixed).largest_above(best.value) {
                best = TimeExtreme {
                    time: piece.time(found.share),
                    value: found.value,
                };
            }
        }
        Some(best)
    }

    /// The smallest value of a sum of channels with factors; `None` for a run without length.
    #[must_use]
    pub fn smallest(&self, terms: &[(Channel, f64)]) -> Option<TimeExtreme> {
        let negative: SmallVec<[(Channel, f64); 8]> = terms
            .iter()
            .map(|(channel, factor)| (*channel, 0.0 - factor))
            .collect();
        let TimeExtreme { time, value } = self.largest(&negative)?;
        Some(TimeExtreme {
            time,
            value: 0.0 - value,
        })
    }
}

/// Rows at the nodes of the intervals of a solution.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SolutionNodes {
    /// The rows, by increasing time.
    pub rows: History,
    /// The intervals.
    pub intervals: Vec<NodeInterval>,
}

/// An interval of a solution in which every quantity is nearly the polynomial through its values at the nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeInterval {
    /// Number of the row at its start; those of the other nodes follow.
    pub first: usize,
    /// Degree of the polynomials, one less than the number of nodes.
    pub degree: usize,
}

/// Kinds of channels, whose values are of one size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Position,
    Displacement,
    Rotation,
    Speed,
    Turning,
    Spin,
    Force,
    Moment,
    Coordinate,
    Acceleration,
}

const KINDS: usize = Kind::Acceleration as usize + 1;

const fn kind(channel: Channel) -> Kind {
    match channel {
        Channel::Time | Channel::Position(_) | Channel::Displacement(_, BodyDof::X) => {
            Kind::Position
        }
        Channel::Displacement(_, BodyDof::Roll | BodyDof::Yaw | BodyDof::Pitch) => Kind::Rotation,
        Channel::Displacement(..)
        | Channel::Penetration(_)
        | Channel::Deflection(_)
        | Channel::Gauge(_)
        | Channel::Length(_) => Kind::Displacement,
        Channel::Speed(_, BodyDof::Roll | BodyDof::Yaw | BodyDof::Pitch) => Kind::Turning,
        Channel::Speed(..) => Kind::Speed,
        Channel::SpinAngle(_) | Channel::SpinSpeed(_) => Kind::Spin,
        Channel::SpinMoment(_) => Kind::Moment,
        Channel::Drive(_)
        | Channel::Brake(_)
        | Channel::Vertical(_)
        | Channel::Lateral(_)
        | Channel::Traction(_)
        | Channel::Tension(_)
        | Channel::Stop(_) => Kind::Force,
        Channel::Coordinate(..) => Kind::Coordinate,
        Channel::Acceleration(..) => Kind::Acceleration,
    }
}

/// Makes a solution of the intervals of a run, one after the other.
pub(crate) struct SolutionBuilder {
    recorder: Recorder,
    solution: Solution,
    /// Positions in a row of the channels that change.
    live: Vec<usize>,
    kinds: Vec<Kind>,
    /// Largest magnitude of each kind so far, and of each channel that changes.
    sizes: [f64; KINDS],
    own_sizes: Vec<f64>,
    /// Numbers of the degrees of freedom that move by propagators.
    modes: Vec<usize>,
    accuracy: f64,
    /// The values at the end of the last interval.
    last: Vec<f64>,
    row: Vec<f64>,
}

/// What evaluates a row of all channels at a share of an interval; returns whether its values are more than estimates.
pub(crate) type Evaluate<'a, E> =
    dyn FnMut(f64, &mut Recorder, &mut Vec<f64>) -> Result<bool, E> + 'a;

impl SolutionBuilder {
    /// Begins with the row of all channels at the start, which `recorder` has made.
    pub fn new(
        recorder: Recorder,
        accuracy: f64,
        start: &[f64],
        modes: Option<(Vec<usize>, ModalMotion)>,
    ) -> SolutionBuilder {
        let channels = recorder.channels().to_vec();
        let mut live = recorder.live();
        let is_propagated = modes.is_some();
        let (modes, motion) = modes.unwrap_or_default();
        let is_mode = |at: &usize| {
            let of_mode = matches!(
                channels[*at],
                Channel::Coordinate(..) | Channel::Acceleration(..)
            );
            is_propagated && of_mode
        };
        live.retain(|at| !is_mode(at));
        let mut sources: Vec<Source> = start.iter().map(|value| Source::Fixed(*value)).collect();
        for (column, at) in live.iter().enumerate() {
            sources[*at] = if recorder.one_sided().contains(at) {
                Source::OneSided(column)
            } else {
                Source::Column(column)
            };
        }
        if is_propagated {
            let (mut displaced, mut accelerated) = (0, modes.len());
            for at in (0..channels.len()).filter(is_mode) {
                let next = match channels[at] {
                    Channel::Coordinate(..) => &mut displaced,
                    _ => &mut accelerated,
                };
                sources[at] = Source::Mode(*next);
                *next += 1;
            }
        }
        if let Some(time) = channels.iter().position(|own| *own == Channel::Time) {
            sources[time] = Source::Time;
        }
        let last: Vec<f64> = live.iter().map(|at| start[*at]).collect();
        let kinds = live.iter().map(|at| kind(channels[*at])).collect();
        let live_count = live.len();
        SolutionBuilder {
            solution: Solution {
                channels,
                sources,
                function: Piecewise::new(live.len()),
                modes: motion,
                start: last.clone(),
                breaks: Vec::new(),
            },
            recorder,
            live,
            kinds,
            sizes: [0.0; KINDS],
            own_sizes: vec![0.0; live_count],
            modes,
            accuracy: accuracy.max(FINEST),
            last,
            row: start.to_vec(),
        }
    }

    /// Number of values stored so far.
    pub fn stored(&self) -> usize {
        self.solution.function.stored()
    }

    /// Adds the interval from the end of the last one to `to`, which starts smoothly or with a jump.
    ///
    /// # Errors
    /// Those of `evaluate`.
    pub fn follow<E>(
        &mut self,
        [from, to]: [f64; 2],
        is_smooth: bool,
        evaluate: &mut Evaluate<'_, E>,
    ) -> Result<(), E> {
        let SolutionBuilder {
            recorder,
            solution,
            live,
            kinds,
            sizes,
            own_sizes,
            accuracy,
            last,
            row,
            ..
        } = self;
        let mut live_row = |share: f64, out: &mut Vec<f64>| -> Result<bool, E> {
            row.clear();
            let is_known = evaluate(share, recorder, row)?;
            out.extend(live.iter().map(|at| row[*at]));
            Ok(is_known)
        };
        let mut ends = [last.clone(), Vec::with_capacity(live.len())];
        live_row(1.0, &mut ends[1])?;
        if !is_smooth {
            ends[0].clear();
            live_row(0.0, &mut ends[0])?;
            solution.breaks.push(from);
        }
        let each = kinds.iter().zip(own_sizes.iter_mut()).enumerate();
        for (column, (kind, own)) in each {
            let size = ends
                .iter()
                .fold(*own, |most, row| most.max(row[column].abs()));
            *own = size;
            sizes[*kind as usize] = sizes[*kind as usize].max(size);
        }
        let allowed: Vec<f64> = kinds
            .iter()
            .zip(own_sizes.iter())
            .map(|(kind, own)| {
                let [followed, rounding] = match kind {
                    Kind::Position => [FOLLOWED_POSITION, ROUNDING],
                    Kind::Acceleration => [FOLLOWED, ROUNDING_ACCELERATION],
                    _ => [FOLLOWED, ROUNDING],
                };
                (followed * *accuracy * own).max(rounding * sizes[*kind as usize])
            })
            .collect();
        let differs = |polynomial: &[f64], value: &[f64]| {
            let each = polynomial.iter().zip(value).zip(&allowed);
            each.into_iter()
                .any(|((a, b), allowed)| (a - b).abs() > *allowed)
        };
        let rows = ends.each_ref().map(Vec::as_slice);
        piecewise::fit(
            &mut solution.function,
            [from, to],
            SHORTEST,
            rows,
            &mut live_row,
            &differs,
        )?;
        *last = std::mem::take(&mut ends[1]);
        Ok(())
    }

    /// Numbers of the degrees of freedom that move by propagators, and their motion; `None` if there are none.
    pub fn modes(&mut self) -> Option<(&[usize], &mut ModalMotion)> {
        let SolutionBuilder {
            solution, modes, ..
        } = self;
        (!modes.is_empty()).then_some((modes.as_slice(), &mut solution.modes))
    }

    /// The recorder.
    pub fn recorder(&mut self) -> &mut Recorder {
        &mut self.recorder
    }

    /// The solution.
    pub fn finish(mut self) -> Solution {
        self.solution.function.shrink();
        self.solution
    }
}
