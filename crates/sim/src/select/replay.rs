//! Natural modes of a structure under the wheel forces of a run that has left them out.
//!
//! A run with the lowest m modes of a structure and the residual flexibility of the others (m = 0: influence functions)
//! gives the wheel forces F and their positions x. Each mode r is an oscillator under these forces,
//!
//! ```text
//! q'' + 2 zeta omega q' + omega^2 q = Q,    Q = sum of phi(x) F over the wheels - L a
//! ```
//!
//! with L a the inertia force of the body that carries the structure. Q is taken as a cubic polynomial between the samples,
//! for which the solution is exact ([`wheels`]): straight pieces would shake the high modes at every sample. What the run
//! lacks is the difference of the modes from their static deflection, which the residual flexibility contains:
//!
//! ```text
//! delta = sum over r > m of phi_r (q_r - sum of phi_r F / omega_r^2)       at wheels and gauges,
//! delta = sum over r > m of s_r q_r''                                      for reactions and internal forces,
//! dF = sum over r > m of (k delta_r + c delta_r') / (1 + |k + i omega_r c| G_r)   for a wheel force,
//! ```
//!
//! where s_r is the effect of a unit acceleration of the mode, delta_r the term of mode r under the wheel, delta_r' its
//! rate as the wheel moves, G_r the residual flexibility of the modes above r under the wheel, and k and c are stiffness
//! and damping of its contact, c = 0 where the damper acts between wheel and ground. The last line neglects the motion of
//! the body. It is the first iterate of a staggered solution: sharp where delta hardly changes the forces, and too large
//! where it would. The rate counts at the start of a motion, where the mode is at rest, but not its static deflection.

mod oscillator;
mod wheels;

use std::collections::BTreeMap;
use std::f64::consts::PI;

use splines::{Axis, Influence, Probe};

use self::oscillator::{LoadAtEnds, Oscillator};
use self::wheels::{CORNER, Interval, LoadedWheel, WheelInstant, loaded_wheels};
use super::measure::{
    Bounces, Difference, Measure, Outlined, Record, RecordedQuantity, difference,
};
use crate::{BodyDof, Channel, Dynamics, Error, Foundation, History, Scene, Structure};

/// Numbers of modes that a foundation may have.
pub(super) const COUNTS: [usize; 20] = [
    0, 1, 2, 3, 4, 5, 6, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40, 48, 64, 96,
];

/// Natural modes of a structure and their effects.
pub struct ModalBasis {
    /// The lowest modes, with [`Dynamics::Modes`].
    pub structure: Structure,
    /// Momentum of each mode per unit velocity of the six motions of the body that carries the structure; empty for a
    /// structure on the ground.
    pub coupling: Vec<[f64; 6]>,
    /// Quantities of a record by name that inertia forces of the structure change, with minus their value per unit
    /// acceleration of each mode.
    pub effects: Vec<(String, Vec<f64>)>,
    /// Whether there are no other modes that wheels excite.
    pub is_whole: bool,
}

/// Estimated error of leaving modes out.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TailError {
    /// Number of the lowest modes that are kept.
    pub kept: usize,
    /// Largest relative error of a quantity, in the scales of [`Record::scales`].
    pub error: f64,
    /// Name of that quantity.
    pub quantity: String,
    /// Largest relative error of a motion, a wheel force or a gauge.
    pub of_motion: f64,
    /// The error as far as the phase of what is lacking is known.
    pub in_phase: f64,
}

impl TailError {
    /// No error without all but the lowest `kept` modes.
    pub fn none(kept: usize) -> Self {
        TailError {
            kept,
            error: 0.0,
            quantity: String::new(),
            of_motion: 0.0,
            in_phase: 0.0,
        }
    }
}

/// A run whose wheel forces act on the modes.
pub(super) struct Loaded<'a> {
    pub scene: &'a Scene,
    /// Index of the structure.
    pub structure: usize,
    /// All foundations; that of the structure has the exact compliance, without modes.
    pub foundations: &'a [Foundation],
    /// The samples of the run.
    pub history: &'a History,
    /// The quantities of the run.
    pub record: &'a Record,
    /// The measure of the errors, and what it takes from the bounces of the wheels.
    pub measure: Measure,
    pub bounces: Bounces,
}

/// What one quantity lacks without the lowest modes, for each of the numbers of modes kept.
struct Slot {
    quantity: usize,
    /// Largest absolute value at the times of the record; not a number where one of the values is none.
    largest: Vec<f64>,
    /// For the measure of extremes the values at these times, by time and number of modes.
    series: Vec<f32>,
}

impl Slot {
    /// Notes, at this row of the record, the sum of `term` over the modes that are not kept, for each number of
    /// modes kept.
    fn note(&mut self, counts: &[usize], row: usize, term: impl Fn(usize) -> f64, modes: usize) {
        let (mut sum, mut above) = (0.0_f64, modes);
        let mut at_row = self
            .series
            .get_mut(row * counts.len()..(row + 1) * counts.len());
        for (k, count) in counts.iter().enumerate().rev() {
            while above > *count {
                above -= 1;
                sum += term(above);
            }
            let largest = &mut self.largest[k];
            let is_known = sum.abs() <= *largest || largest.is_nan();
            *largest = if is_known { *largest } else { sum.abs() };
            if let Some(own) = &mut at_row {
                own[k] = sum as f32;
            }
        }
    }
}

/// Estimates the errors of leaving out all modes but the lowest 0, 1, 2, 3, 4, 6, ... of `basis`.
///
/// # Errors
/// A wheel beyond its rail.
pub(super) fn tail_errors(
    loaded: &Loaded<'_>,
    basis: &ModalBasis,
) -> Result<Vec<TailError>, Error> {
    let Dynamics::Modes { omega, ratio } = &basis.structure.dynamics else {
        return Ok(Vec::new());
    };
    let counts: Vec<usize> = COUNTS
        .into_iter()
        .filter(|count| *count < omega.len())
        .collect();
    let mut replay = Replay::new(loaded, basis, counts)?;
    for (oscillator, (omega, ratio)) in replay.oscillators.iter_mut().zip(omega.iter().zip(ratio)) {
        *oscillator = Oscillator::new(*omega, *ratio);
    }
    for i in 0..loaded.history.len() {
        replay.sample(i)?;
    }
    Ok(replay.errors())
}

/// Loads on all modes at an instant, and their rates.
#[derive(Clone, Default)]
struct Loads {
    value: Vec<f64>,
    rate: Vec<f64>,
}

impl Loads {
    /// No load on `n` modes.
    fn zeros(n: usize) -> Self {
        Loads {
            value: vec![0.0; n],
            rate: vec![0.0; n],
        }
    }
}

struct Replay<'a> {
    loaded: &'a Loaded<'a>,
    basis: &'a ModalBasis,
    /// Numbers of modes kept, ascending.
    counts: Vec<usize>,
    wheels: Vec<LoadedWheel>,
    oscillators: Vec<Oscillator>,
    /// Slots of the deflection and the force of each wheel, then those of gauges and effects.
    by_wheel: Vec<[Slot; 2]>,
    gauges: Vec<(Vec<f64>, Slot)>,
    /// Driving forces of prescribed motions on the slopes of the rails, with the wheels of their bodies.
    drives: Vec<(Vec<usize>, Slot)>,
    effects: Vec<(&'a [f64], Slot)>,
    /// First channels of the speeds of the carrying body.
    carrier: Option<usize>,
    /// Motions of the wheels from the last sample to the next one.
    intervals: Vec<Interval>,
    /// All loads on the modes at the last sample, with their rates after it.
    last: Loads,
    /// Vertical shapes of the modes under the wheels and their slopes, wheel by wheel.
    shapes: Vec<f64>,
    slopes: Vec<f64>,
    /// Forces that a wheel lacks by each mode.
    gains: Vec<f64>,
    /// Number of rows of the record before the next sample.
    row: usize,
}

impl<'a> Replay<'a> {
    fn new(
        loaded: &'a Loaded<'a>,
        basis: &'a ModalBasis,
        counts: Vec<usize>,
    ) -> Result<Self, Error> {
        let Loaded {
            scene,
            structure,
            foundations,
            history,
            record,
            ..
        } = *loaded;
        let n = basis.structure.dynamics.dofs();
        let times = if loaded.measure == Measure::Extremes {
            record.time.len()
        } else {
            0
        };
        let slot = |quantity: usize| Slot {
            quantity,
            largest: vec![0.0; counts.len()],
            series: vec![0.0; times * counts.len()],
        };
        let of_channel = |channel: Channel| {
            let has = |quantity: &RecordedQuantity| quantity.channel == Some(channel);
            record.quantities.iter().position(has).map(slot)
        };
        let frequencies = basis.structure.dynamics.frequencies();
        let mut wheels = loaded_wheels(scene, foundations, structure, history, frequencies)?;
        let mut by_wheel = Vec::new();
        wheels.retain(|wheel| {
            let slots = (
                Channel::Deflection(wheel.index),
                Channel::Vertical(wheel.index),
            );
            let (Some(deflection), Some(force)) = (of_channel(slots.0), of_channel(slots.1)) else {
                return false;
            };
            by_wheel.push([deflection, force]);
            true
        });
        let (mut shape, mut slope) = (vec![0.0; n], vec![0.0; n]);
        let mut gauges = Vec::new();
        for (g, gauge) in scene
            .gauges
            .iter()
            .enumerate()
            .filter(|(_, gauge)| gauge.structure == structure)
        {
            let row = basis
                .structure
                .shapes
                .row(gauge.probe, &mut shape, &mut slope);
            if let (Some(slot), Ok(())) = (of_channel(Channel::Gauge(g)), row) {
                gauges.push((shape.clone(), slot));
            }
        }
        let drives = (0..scene.bodies.len()).filter_map(|b| {
            let own: Vec<usize> = (0..wheels.len()).filter(|w| wheels[*w].body == b).collect();
            of_channel(Channel::Drive(b))
                .filter(|_| !own.is_empty())
                .map(|slot| (own, slot))
        });
        let drives = drives.collect();
        let names: BTreeMap<&str, usize> = record
            .quantities
            .iter()
            .enumerate()
            .map(|(i, quantity)| (quantity.name.as_str(), i))
            .collect();
        let known = basis
            .effects
            .iter()
            .filter_map(|(name, by_mode)| Some((by_mode, names.get(name.as_str())?)));
        let effects = known
            .map(|(by_mode, at)| (by_mode.as_slice(), slot(*at)))
            .collect();
        let carrier = foundations[structure]
            .carrier
            .as_ref()
            .filter(|_| !basis.coupling.is_empty());
        let carrier =
            carrier.and_then(|carrier| history.position(Channel::Speed(carrier.body, BodyDof::X)));
        Ok(Replay {
            loaded,
            basis,
            wheels,
            oscillators: vec![Oscillator::default(); n],
            by_wheel,
            gauges,
            drives,
            effects,
            carrier,
            intervals: Vec::new(),
            last: Loads::default(),
            shapes: Vec::new(),
            slopes: Vec::new(),
            gains: Vec::new(),
            row: 0,
            counts,
        })
    }

    /// Moves the modes to sample `i` and notes what is lacking there if it is a row of the record.
    fn sample(&mut self, i: usize) -> Result<(), Error> {
        let (history, n) = (self.loaded.history, self.oscillators.len());
        let sample = history.sample(i);
        let after = self
            .wheels
            .iter()
            .map(|wheel| wheel.interval(history, i))
            .collect();
        let before = std::mem::replace(&mut self.intervals, after);
        // before the first sample the forces change as they do after it
        let begins = instants(&self.intervals, 0.0, 1.0);
        let ends = if i == 0 {
            begins.clone()
        } else {
            instants(&before, 1.0, -1.0)
        };
        let (mut ending, mut beginning) = (Loads::zeros(n), Loads::zeros(n));
        self.add_loads(&ends, Some(&begins), &mut ending, &mut beginning.rate)?;
        beginning.value.clone_from(&ending.value);
        let is_row = self.loaded.record.time.get(self.row) == Some(&sample[0]);
        let of_wheels = if is_row {
            ending.clone()
        } else {
            Loads::default()
        };
        if i == 0 {
            self.add_carrier(i, 0.0, &mut beginning);
            self.oscillators
                .iter_mut()
                .zip(&beginning.value)
                .for_each(|(mode, load)| mode.begin(*load));
        } else {
            self.add_carrier(i - 1, 1.0, &mut ending);
            self.add_carrier(i, 0.0, &mut beginning);
            self.advance(i, &before, &ending)?;
        }
        self.last = beginning;
        if !is_row {
            return Ok(());
        }
        let row = self.row;
        self.row += 1;
        let modes = || {
            self.oscillators
                .iter()
                .map(|mode| (mode, mode.flexibility()))
        };
        let lag: Vec<f64> = modes()
            .zip(&of_wheels.value)
            .map(|((mode, by), load)| mode.state[0] - load * by)
            .collect();
        let rates: Vec<f64> = modes()
            .zip(&of_wheels.rate)
            .map(|((mode, by), rate)| mode.state[1] - rate * by)
            .collect();
        for (w, end) in ends.iter().enumerate() {
            self.note_wheel(w, sample, row, end.speed, [&lag, &rates])?;
        }
        for (wheels, slot) in &mut self.drives {
            let resistance = |r: usize| {
                let of = |w: &usize| self.slopes[n * w + r] * sample[self.wheels[*w].first + 1];
                wheels.iter().map(of).sum::<f64>() * lag[r]
            };
            slot.note(&self.counts, row, resistance, n);
        }
        for (shape, slot) in &mut self.gauges {
            slot.note(&self.counts, row, |r| shape[r] * lag[r], n);
        }
        for (by_mode, slot) in &mut self.effects {
            slot.note(
                &self.counts,
                row,
                |r| by_mode[r] * self.oscillators[r].state[2],
                n,
            );
        }
        Ok(())
    }

    /// Moves the modes from sample `i` - 1, of the loads [`Replay::last`], to sample `i`, where the loads are `end`. The
    /// interval is divided where the load of a wheel is not smooth.
    fn advance(&mut self, i: usize, intervals: &[Interval], end: &Loads) -> Result<(), Error> {
        let history = self.loaded.history;
        let h = history.sample(i)[0] - history.sample(i - 1)[0];
        if h <= 0.0 {
            return Ok(());
        }
        let mut shares: Vec<f64> = intervals.iter().flat_map(Interval::corners).collect();
        shares.sort_by(f64::total_cmp);
        shares.dedup_by(|b, a| *b - *a < CORNER);
        let (mut begin, mut from) = (std::mem::take(&mut self.last), 0.0);
        // the shapes under the wheels at the sample are needed once more
        let kept = if shares.is_empty() {
            None
        } else {
            Some((self.shapes.clone(), self.slopes.clone()))
        };
        for share in shares {
            let mut beside = [-1.0, 1.0].map(|_| Loads::zeros(end.value.len()));
            for (side, loads) in [-1.0, 1.0].into_iter().zip(&mut beside) {
                self.add_loads(&instants(intervals, share, side), None, loads, &mut [])?;
                self.add_carrier(i - 1, share, loads);
            }
            let [left, right] = beside;
            self.step((share - from) * h, &begin, &left);
            // the shapes are those under the wheels at this instant
            for (interval, shapes) in intervals.iter().zip(self.shapes.chunks(end.value.len())) {
                let impulse = interval.impulse(share);
                self.oscillators
                    .iter_mut()
                    .zip(shapes)
                    .for_each(|(mode, shape)| mode.push(shape * impulse));
            }
            (begin, from) = (right, share);
        }
        self.step((1.0 - from) * h, &begin, end);
        if let Some(kept) = kept {
            (self.shapes, self.slopes) = kept;
        }
        Ok(())
    }

    /// Moves the modes by `h` between these loads.
    fn step(&mut self, h: f64, begin: &Loads, end: &Loads) {
        for (r, mode) in self.oscillators.iter_mut().enumerate() {
            mode.advance(
                h,
                LoadAtEnds {
                    value: [begin.value[r], end.value[r]],
                    rate: [begin.rate[r], end.rate[r]],
                },
            );
        }
    }

    /// Adds the loads by the wheels to `loads`, and the rates for the motion of the wheels after the instant, if `after`
    /// gives it, to `rates_after`. Keeps the vertical shapes under the wheels.
    fn add_loads(
        &mut self,
        at: &[WheelInstant],
        after: Option<&[WheelInstant]>,
        loads: &mut Loads,
        rates_after: &mut [f64],
    ) -> Result<(), Error> {
        let (n, s) = (loads.value.len(), self.loaded.structure);
        self.shapes.resize(n * self.wheels.len(), 0.0);
        self.slopes.resize(n * self.wheels.len(), 0.0);
        let is_loaded_along = self.loaded.foundations[s].is_loaded_along;
        for (w, wheel) in self.wheels.iter().enumerate() {
            let own = &at[w];
            let other = after.map_or(own, |after| &after[w]);
            for (k, axis) in [Axis::Longitudinal, Axis::Lateral, Axis::Vertical]
                .into_iter()
                .enumerate()
            {
                let is_idle = own.forces[k] == 0.0 && own.rates[k] == 0.0 && other.rates[k] == 0.0;
                if (axis == Axis::Longitudinal && !is_loaded_along)
                    || (axis != Axis::Vertical && is_idle)
                {
                    continue;
                }
                let shapes = &mut self.shapes[n * w..n * (w + 1)];
                let slopes = &mut self.slopes[n * w..n * (w + 1)];
                let row = self.basis.structure.shapes.row(
                    Probe {
                        rail: wheel.rail,
                        x: own.x,
                        axis,
                    },
                    shapes,
                    slopes,
                );
                row.map_err(|source| Error::Compliance {
                    structure: s,
                    source,
                })?;
                let (force, moving) = (own.forces[k], own.speed * own.forces[k]);
                for (r, (shape, slope)) in shapes.iter().zip(slopes.iter()).enumerate() {
                    loads.value[r] += shape * force;
                    loads.rate[r] += slope * moving + shape * own.rates[k];
                }
                let moving = other.speed * other.forces[k];
                for (rate, (shape, slope)) in
                    rates_after.iter_mut().zip(shapes.iter().zip(slopes.iter()))
                {
                    *rate += slope * moving + shape * other.rates[k];
                }
            }
        }
        Ok(())
    }

    /// Adds the inertia force of the carrying body to the loads, at a share of the interval after sample `i`, in which its
    /// acceleration is linear.
    fn add_carrier(&self, i: usize, share: f64, loads: &mut Loads) {
        let Some(first) = self.carrier else { return };
        let history = self.loaded.history;
        let next = (i + 1).min(history.len() - 1);
        let h = history.sample(next)[0] - history.sample(i)[0];
        let [a, b] = [i, next].map(|at| acceleration(history, at, first));
        let coupling = self.basis.coupling.iter();
        for ((value, rate), coupling) in loads.value.iter_mut().zip(&mut loads.rate).zip(coupling) {
            for ((l, a), b) in coupling.iter().zip(a).zip(b) {
                *value -= l * (a + share * (b - a));
                *rate -= if h > 0.0 { l * (b - a) / h } else { 0.0 };
            }
        }
    }

    /// Notes the deflection and the force that wheel `w` lacks, which moves with `speed`. `lag` is the difference of each
    /// mode from its static deflection, and the rate of this difference.
    fn note_wheel(
        &mut self,
        w: usize,
        sample: &[f64],
        row: usize,
        speed: f64,
        [lag, rates]: [&[f64]; 2],
    ) -> Result<(), Error> {
        let (n, s) = (lag.len(), self.loaded.structure);
        let LoadedWheel {
            rail,
            first,
            contact: [k, c],
            ref at_modes,
            ..
        } = self.wheels[w];
        let [shape, slope] = [&self.shapes, &self.slopes].map(|all| &all[n * w..n * (w + 1)]);
        let [deflection, force] = &mut self.by_wheel[w];
        deflection.note(&self.counts, row, |r| shape[r] * lag[r], n);
        if sample[first + 1] == 0.0 {
            return Ok(());
        }
        let mut flexibility = 0.0;
        if let Some(compliance) = &self.loaded.foundations[s].compliance {
            let mut influence = Influence::zeros(1);
            let probe = Probe {
                rail,
                x: sample[first],
                axis: Axis::Vertical,
            };
            let filled = compliance.fill(&[probe], &mut influence);
            filled.map_err(|source| Error::Compliance {
                structure: s,
                source,
            })?;
            flexibility = influence.value[(0, 0)];
        }
        self.gains.resize(n, 0.0);
        for (r, gain) in self.gains.iter_mut().enumerate() {
            let mode = &self.oscillators[r];
            flexibility -= (shape[r] / mode.omega).powi(2);
            let (lacking, rate) = (
                shape[r] * lag[r],
                shape[r] * rates[r] + slope[r] * speed * lag[r],
            );
            *gain = (k * lacking + c * rate) / (1.0 + at_modes[r] * flexibility.max(0.0));
        }
        force.note(&self.counts, row, |r| self.gains[r], n);
        Ok(())
    }

    /// The largest relative error for each number of modes kept: the difference of the record from itself with what it
    /// lacks added. Where modes are kept, extremes are those with the amplitude of what is lacking: after some periods the phase
    /// of a high mode is not that of a run that contains it.
    ///
    /// Reactions and internal forces also lack those above all known modes ([`sum_beyond`], [`root_beyond`]).
    fn errors(self) -> Vec<TailError> {
        let Loaded {
            record,
            measure,
            bounces,
            ..
        } = *self.loaded;
        let known = self.oscillators.len();
        let oscillators = self.oscillators;
        let slots: Vec<Slot> = (self.by_wheel.into_iter().flatten())
            .chain(self.drives.into_iter().map(|(_, slot)| slot))
            .chain(self.gauges.into_iter().map(|(_, slot)| slot))
            .chain(self.effects.into_iter().map(|(_, slot)| slot))
            .collect();
        let is_motion = |slot: &Slot| record.quantities[slot.quantity].channel.is_some();
        let is_cut_off = |slot: &Slot| !is_motion(slot) && !self.basis.is_whole;
        let in_phase_beyond = |slot: &Slot, kept: usize| {
            if is_cut_off(slot) {
                sum_beyond(kept, known)
            } else {
                1.0
            }
        };
        let beyond = |slot: &Slot, kept: usize| {
            if is_cut_off(slot) {
                root_beyond(kept, known)
            } else {
                1.0
            }
        };
        // adds the error of a quantity to those of others
        let add = |found: &mut TailError, slot: &Slot, error: f64| {
            let error = if error.is_nan() { f64::INFINITY } else { error };
            if error > found.error {
                found.error = error;
                found
                    .quantity
                    .clone_from(&record.quantities[slot.quantity].name);
            }
            if is_motion(slot) {
                found.of_motion = found.of_motion.max(error);
            }
        };
        // differences at equal times, and of what is read from many bounces, have phases as they are
        let as_they_are = |found: TailError| TailError {
            in_phase: found.error,
            ..found
        };
        // what a quantity lacks, at the times of the record
        let numbers = self.counts.len();
        let lacking = |slot: &Slot, index: usize, share: f64| -> Vec<f64> {
            slot.series
                .iter()
                .skip(index)
                .step_by(numbers)
                .map(|own| share * f64::from(*own))
                .collect()
        };
        let counts = self.counts.iter().copied().enumerate();
        if measure == Measure::History {
            let scales = record.scales();
            let pointwise = |(index, kept): (usize, usize)| {
                let mut found = TailError::none(kept);
                for slot in slots.iter().filter(|slot| slot.largest[index] != 0.0) {
                    let error = slot.largest[index] / scales[slot.quantity];
                    add(&mut found, slot, in_phase_beyond(slot, kept) * error);
                }
                as_they_are(found)
            };
            return counts.map(pointwise).collect();
        }
        let Some(outlined) = Outlined::new(record, bounces) else {
            let together = |(index, kept): (usize, usize)| {
                let mut completed = record.clone();
                for slot in &slots {
                    let values = completed.quantities[slot.quantity].values.iter_mut();
                    values
                        .zip(lacking(slot, index, in_phase_beyond(slot, kept)))
                        .for_each(|(value, own)| *value += own);
                }
                let apart = difference(&completed, record, measure, bounces);
                let Difference {
                    largest: error,
                    quantity,
                    of_motion,
                } = apart;
                as_they_are(TailError {
                    error,
                    quantity,
                    of_motion,
                    ..TailError::none(kept)
                })
            };
            return counts.map(together).collect();
        };
        let duration = record.time.last().map_or(0.0, |end| end - record.time[0]);
        let each = |(index, kept): (usize, usize)| {
            // extremes change by no more than the values: quantities that lack little need no comparison
            let most = |slot: &Slot| {
                in_phase_beyond(slot, kept) * slot.largest[index] / outlined.scale(slot.quantity)
            };
            let mut bounds: Vec<(f64, &Slot)> =
                slots.iter().map(|slot| (most(slot), slot)).collect();
            bounds.sort_by(|a, b| b.0.total_cmp(&a.0));
            // half a period of the lowest mode that is lacking contains a peak of any oscillation of these modes
            let quarter = 0.5 * PI / oscillators[kept].omega;
            let reach = (quarter / duration * record.time.len() as f64).ceil() as usize;
            let mut found = TailError::none(kept);
            let mut in_phase = 0.0;
            for (bound, slot) in bounds {
                let is_open = bound
                    > if is_motion(slot) {
                        found.of_motion
                    } else {
                        found.error
                    };
                if bound <= in_phase && !is_open {
                    continue;
                }
                let quantity = slot.quantity;
                let error = outlined
                    .difference(quantity, &lacking(slot, index, in_phase_beyond(slot, kept)));
                add(&mut found, slot, error);
                in_phase = f64::max(in_phase, if error.is_nan() { f64::INFINITY } else { error });
                if kept > 0 && is_open {
                    let lacking = lacking(slot, index, beyond(slot, kept));
                    add(
                        &mut found,
                        slot,
                        outlined.difference_by_amplitude(quantity, &lacking, reach),
                    );
                }
            }
            TailError { in_phase, ..found }
        };
        counts.map(each).collect()
    }
}

/// What all modes above the lowest `kept` contribute to reactions and internal forces, relative to what those from there to the
/// `known` ones do, where all are in phase. Mode n contributes in proportion to 1/n^2, so that it is N/(N - k).
fn sum_beyond(kept: usize, known: usize) -> f64 {
    1.0 / (1.0 - kept as f64 / known as f64)
}

/// The same where phases are not known and squares add up: the root of their sum, (1 - (k/N)^3)^(-1/2).
fn root_beyond(kept: usize, known: usize) -> f64 {
    (1.0 - (kept as f64 / known as f64).powi(3)).powf(-0.5)
}

/// All wheels after a share of an interval, see [`Interval::at`].
fn instants(intervals: &[Interval], share: f64, side: f64) -> Vec<WheelInstant> {
    intervals.iter().map(|own| own.at(share, side)).collect()
}

/// Acceleration of a body at sample `i`, from its six speeds at the samples beside it.
fn acceleration(history: &History, i: usize, first: usize) -> [f64; 6] {
    let (before, after) = (i.saturating_sub(1), (i + 1).min(history.len() - 1));
    let [a, b] = [history.sample(before), history.sample(after)];
    let span = b[0] - a[0];
    std::array::from_fn(|k| {
        if span > 0.0 {
            (b[first + k] - a[first + k]) / span
        } else {
            0.0
        }
    })
}

#[cfg(test)]
mod tests;
