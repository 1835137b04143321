//! Natural modes of a structure under the wheel forces of a run that has left them out.
//!
//! A run with the lowest m modes of a structure and the residual flexibility of the others (m = 0: influence functions)
//! gives the wheel forces F and their positions x. Each mode r is an oscillator under these forces,
//!
//! ```text
//! q'' + 2 zeta omega q' + omega^2 q = Q,    Q = sum of phi(x) F over the wheels - L a
//! ```
//!
//! with L a the inertia force of the body that carries the structure. The solution is exact for forces that are linear
//! between the samples, but where a wheel passes a step of its rail or meets it with a damper: there they jump. What the
//! run lacks is the difference of the modes from their static deflection, which the residual flexibility contains:
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

use std::collections::BTreeMap;

use splines::{Axis, Influence, Probe};

use super::measure::{Record, RecordedQuantity};
use crate::mechanics::wheels::Wheels;
use crate::{BodyDof, Channel, Damper, Dynamics, Error, Foundation, History, Irregularity, Scene, Structure};

/// Numbers of modes that a foundation may have.
pub(super) const COUNTS: [usize; 20] =
    [0, 1, 2, 3, 4, 5, 6, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40, 48, 64, 96];
/// Largest damping ratio that is distinguished from others; the formulas are those of an oscillation.
const MOST_DAMPED: f64 = 0.999;

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
}

impl Loaded<'_> {
    /// The wheels on the structure that the samples contain.
    fn wheels(&self, basis: &ModalBasis) -> Result<Vec<Wheel>, Error> {
        let frequencies = basis.structure.dynamics.frequencies();
        let mut wheels = Vec::new();
        for (index, point) in Wheels::new(self.scene, self.foundations, || 0)?.points.iter().enumerate() {
            let contact = &self.scene.contacts[point.contact];
            let Some(first) = self.history.position(Channel::Position(index)) else { continue };
            if contact.structure != self.structure {
                continue;
            }
            let law = &self.scene.wheels[contact.wheel].normal;
            let rest = self.history.sample(0)[first + 1].max(0.0);
            let at = law.at(law.penetration(rest), 0.0);
            let (k, c) = (at.by_penetration, if law.damper == Damper::Rail { at.by_rate } else { 0.0 });
            let at_modes = frequencies.iter().map(|omega| k.hypot(omega * c)).collect();
            let (body, rail) = (contact.body, contact.rail);
            let shape = self.foundations[self.structure].irregularities.get(rail);
            let steps = shape.into_iter().flat_map(Irregularity::steps).collect();
            let is_damped = law.damping > 0.0;
            wheels.push(Wheel { steps, is_damped, index, body, rail, first, contact: [k, c], at_modes });
        }
        Ok(wheels)
    }
}

/// A wheel on the structure, with the positions of its values in a sample.
struct Wheel {
    /// Places at which the height of its rail steps: there its force jumps.
    steps: Vec<f64>,
    /// Whether its force jumps where it meets the rail.
    is_damped: bool,
    /// Its number in the scene.
    index: usize,
    body: usize,
    rail: usize,
    /// First of four consecutive channels: position, vertical, lateral, traction.
    first: usize,
    /// Stiffness and damping of its contact at rest, the damping only of a damper between wheel and rail.
    contact: [f64; 2],
    /// |k + i omega c| for the frequency omega of each mode.
    at_modes: Vec<f64>,
}

/// One oscillator and the coefficients of its step.
#[derive(Clone, Default)]
struct Oscillator {
    omega: f64,
    ratio: f64,
    /// Displacement, velocity and acceleration.
    state: [f64; 3],
    load: f64,
    /// Rate of the load in the last step.
    rate: f64,
    /// Values of the free oscillation after a step of this length: by displacement and velocity at its start.
    step: [[f64; 2]; 2],
    length: f64,
}

impl Oscillator {
    /// Starts at rest in the static deflection under `load`.
    fn begin(&mut self, load: f64) {
        self.load = load;
        self.state = [load / (self.omega * self.omega), 0.0, 0.0];
    }

    /// Coefficients of a step of length `h`.
    fn set_step(&mut self, h: f64) {
        self.length = h;
        let (omega, ratio) = (self.omega, self.ratio);
        let free = omega * (1.0 - ratio * ratio).sqrt();
        let (sin, cos) = (free * h).sin_cos();
        let decay = (-ratio * omega * h).exp();
        let slow = ratio * omega / free;
        self.step = [
            [decay * (cos + slow * sin), decay * sin / free],
            [-decay * omega * omega / free * sin, decay * (cos - slow * sin)],
        ];
    }

    /// Takes a step of length `h`, in which the load jumps to `load` at the fraction `share`; before and after that it changes
    /// with the rate of the step before.
    fn jump(&mut self, h: f64, share: f64, load: f64) {
        let steady = self.rate * h;
        self.advance(share * h, self.load + share * steady);
        self.load = load - (1.0 - share) * steady;
        self.advance((1.0 - share) * h, load);
    }

    /// Takes a step of length `h`, in which the load changes linearly to `load`.
    fn advance(&mut self, h: f64, load: f64) {
        if (h - self.length).abs() > 1e-9 * h {
            self.set_step(h);
        }
        let (stiffness, rate) = (self.omega * self.omega, (load - self.load) / h);
        self.rate = rate;
        let lag = 2.0 * self.ratio / self.omega * rate;
        let steady = |load: f64| (load - lag) / stiffness;
        let (x, v) = (self.state[0] - steady(self.load), self.state[1] - rate / stiffness);
        let [a, b] = self.step;
        let (x, v) = (a[0] * x + a[1] * v + steady(load), b[0] * x + b[1] * v + rate / stiffness);
        self.state = [x, v, load - 2.0 * self.ratio * self.omega * v - stiffness * x];
        self.load = load;
    }
}

/// Largest absolute values of one quantity without the lowest modes, one for each of the numbers of modes kept.
struct Slot {
    quantity: usize,
    largest: Vec<f64>,
}

/// Estimates the errors of leaving out all modes but the lowest 0, 1, 2, 3, 4, 6, ... of `basis`.
///
/// # Errors
/// A wheel beyond its rail.
pub(super) fn tail_errors(loaded: &Loaded<'_>, basis: &ModalBasis) -> Result<Vec<TailError>, Error> {
    let Dynamics::Modes { omega, ratio } = &basis.structure.dynamics else { return Ok(Vec::new()) };
    let counts: Vec<usize> = COUNTS.into_iter().filter(|count| *count < omega.len()).collect();
    let mut replay = Replay::new(loaded, basis, counts)?;
    for (oscillator, (omega, ratio)) in replay.oscillators.iter_mut().zip(omega.iter().zip(ratio)) {
        (oscillator.omega, oscillator.ratio) = (*omega, ratio.min(MOST_DAMPED));
    }
    for i in 0..loaded.history.len() {
        replay.sample(i)?;
    }
    Ok(replay.errors())
}

struct Replay<'a> {
    loaded: &'a Loaded<'a>,
    basis: &'a ModalBasis,
    /// Numbers of modes kept, ascending.
    counts: Vec<usize>,
    wheels: Vec<Wheel>,
    oscillators: Vec<Oscillator>,
    /// Slots of the deflection and the force of each wheel, then those of gauges and effects.
    by_wheel: Vec<[Slot; 2]>,
    gauges: Vec<(Vec<f64>, Slot)>,
    /// Driving forces of prescribed motions on the slopes of the rails, with the wheels of their bodies.
    drives: Vec<(Vec<usize>, Slot)>,
    effects: Vec<(&'a [f64], Slot)>,
    /// First channels of the speeds of the carrying body.
    carrier: Option<usize>,
    /// Loads on the modes by the wheels at the last sample.
    by_wheels: Vec<f64>,
    /// Vertical shapes of the modes under the wheels and their slopes, wheel by wheel.
    shapes: Vec<f64>,
    slopes: Vec<f64>,
    /// Forces that a wheel lacks by each mode.
    gains: Vec<f64>,
}

impl<'a> Replay<'a> {
    fn new(loaded: &'a Loaded<'a>, basis: &'a ModalBasis, counts: Vec<usize>) -> Result<Self, Error> {
        let Loaded { scene, structure, foundations, history, record } = *loaded;
        let n = basis.structure.dynamics.dofs();
        let slot = |quantity: usize| Slot { quantity, largest: vec![0.0; counts.len()] };
        let of_channel = |channel: Channel| {
            let has = |quantity: &RecordedQuantity| quantity.channel == Some(channel);
            record.quantities.iter().position(has).map(slot)
        };
        let mut wheels = loaded.wheels(basis)?;
        let mut by_wheel = Vec::new();
        wheels.retain(|wheel| {
            let slots = (Channel::Deflection(wheel.index), Channel::Vertical(wheel.index));
            let (Some(deflection), Some(force)) = (of_channel(slots.0), of_channel(slots.1)) else {
                return false;
            };
            by_wheel.push([deflection, force]);
            true
        });
        let (mut shape, mut slope) = (vec![0.0; n], vec![0.0; n]);
        let mut gauges = Vec::new();
        for (g, gauge) in scene.gauges.iter().enumerate().filter(|(_, gauge)| gauge.structure == structure) {
            let row = basis.structure.shapes.row(gauge.probe, &mut shape, &mut slope);
            if let (Some(slot), Ok(())) = (of_channel(Channel::Gauge(g)), row) {
                gauges.push((shape.clone(), slot));
            }
        }
        let drives = (0..scene.bodies.len()).filter_map(|b| {
            let own: Vec<usize> = (0..wheels.len()).filter(|w| wheels[*w].body == b).collect();
            of_channel(Channel::Drive(b)).filter(|_| !own.is_empty()).map(|slot| (own, slot))
        });
        let drives = drives.collect();
        let names: BTreeMap<&str, usize> =
            record.quantities.iter().enumerate().map(|(i, quantity)| (quantity.name.as_str(), i)).collect();
        let known =
            basis.effects.iter().filter_map(|(name, by_mode)| Some((by_mode, names.get(name.as_str())?)));
        let effects = known.map(|(by_mode, at)| (by_mode.as_slice(), slot(*at))).collect();
        let carrier = foundations[structure].carrier.as_ref().filter(|_| !basis.coupling.is_empty());
        let carrier = carrier.and_then(|carrier| history.position(Channel::Speed(carrier.body, BodyDof::X)));
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
            by_wheels: Vec::new(),
            shapes: Vec::new(),
            slopes: Vec::new(),
            gains: Vec::new(),
            counts,
        })
    }

    /// Moves the modes to sample `i` and notes what is lacking there.
    fn sample(&mut self, i: usize) -> Result<(), Error> {
        let (history, n) = (self.loaded.history, self.oscillators.len());
        let sample = history.sample(i);
        // the rate of the loads at the first sample is that of the first interval
        let beside = if i == 0 { 1.min(history.len() - 1) } else { i - 1 };
        let other = if i == 0 { self.loads(beside)? } else { std::mem::take(&mut self.by_wheels) };
        let span = sample[0] - history.sample(beside)[0];
        let by_wheels = self.loads(i)?;
        let per_time = if span == 0.0 { 0.0 } else { span.recip() };
        let mut total = by_wheels.clone();
        if let Some(first) = self.carrier {
            let acceleration = acceleration(history, i, first);
            for (load, coupling) in total.iter_mut().zip(&self.basis.coupling) {
                *load -= coupling.iter().zip(acceleration).map(|(l, a)| l * a).sum::<f64>();
            }
        }
        let h = if i == 0 { 0.0 } else { sample[0] - history.sample(i - 1)[0] };
        let jump = self.jump_between(history.sample(beside), sample);
        if i == 0 {
            self.oscillators.iter_mut().zip(&total).for_each(|(mode, load)| mode.begin(*load));
        } else if let Some(share) = jump.filter(|_| h > 0.0) {
            self.oscillators.iter_mut().zip(&total).for_each(|(mode, load)| mode.jump(h, share, *load));
        } else if h > 0.0 {
            self.oscillators.iter_mut().zip(&total).for_each(|(mode, load)| mode.advance(h, *load));
        }
        let modes = || self.oscillators.iter().zip(&by_wheels).zip(&other);
        let flexibility = |mode: &Oscillator| (mode.omega * mode.omega).recip();
        let lag: Vec<f64> =
            modes().map(|((mode, load), _)| mode.state[0] - load * flexibility(mode)).collect();
        let rate = |mode: &Oscillator, load: f64, other: f64| {
            let of_load = if jump.is_some() { mode.rate } else { (load - other) * per_time };
            mode.state[1] - of_load * flexibility(mode)
        };
        let rates: Vec<f64> = modes().map(|((mode, load), other)| rate(mode, *load, *other)).collect();
        for w in 0..self.wheels.len() {
            let x = self.wheels[w].first;
            let speed = (sample[x] - history.sample(beside)[x]) * per_time;
            self.note_wheel(w, sample, speed, [&lag, &rates])?;
        }
        self.by_wheels = by_wheels;
        for (wheels, slot) in &mut self.drives {
            let resistance = |r: usize| {
                let of = |w: &usize| self.slopes[n * w + r] * sample[self.wheels[*w].first + 1];
                wheels.iter().map(of).sum::<f64>() * lag[r]
            };
            note(&self.counts, &mut slot.largest, resistance, n);
        }
        for (shape, slot) in &mut self.gauges {
            note(&self.counts, &mut slot.largest, |r| shape[r] * lag[r], n);
        }
        for (by_mode, slot) in &mut self.effects {
            note(&self.counts, &mut slot.largest, |r| by_mode[r] * self.oscillators[r].state[2], n);
        }
        Ok(())
    }

    /// The fraction of the interval between two samples at which the first force jumps: that of a wheel that passes a step of
    /// its rail, or of one that meets its rail with a damper, of which the instant is not known.
    fn jump_between(&self, before: &[f64], after: &[f64]) -> Option<f64> {
        let of_wheel = |wheel: &Wheel| {
            let [from, to] = [before, after].map(|sample| sample[wheel.first]);
            let passed = wheel.steps.iter().filter(move |x| (**x - from) * (**x - to) < 0.0);
            let [force, later] = [before, after].map(|sample| sample[wheel.first + 1]);
            let landing = (wheel.is_damped && force == 0.0 && later > 0.0).then_some(0.5);
            passed.map(|x| (x - from) / (to - from)).chain(landing).min_by(f64::total_cmp)
        };
        self.wheels
            .iter()
            .filter_map(of_wheel)
            .min_by(f64::total_cmp)
            .map(|share| share.clamp(1e-6, 1.0 - 1e-6))
    }

    /// Loads on the modes by the wheels in sample `i`. Keeps the vertical shapes under them.
    fn loads(&mut self, i: usize) -> Result<Vec<f64>, Error> {
        let (n, sample) = (self.oscillators.len(), self.loaded.history.sample(i));
        self.shapes.resize(n * self.wheels.len(), 0.0);
        self.slopes.resize(n * self.wheels.len(), 0.0);
        let mut loads = vec![0.0; n];
        for w in 0..self.wheels.len() {
            self.add_loads(w, sample, &mut loads)?;
        }
        Ok(loads)
    }

    /// Adds the forces of wheel `w` to the loads on the modes, and keeps the vertical shapes under it.
    fn add_loads(&mut self, w: usize, sample: &[f64], loads: &mut [f64]) -> Result<(), Error> {
        let (n, s) = (loads.len(), self.loaded.structure);
        let Wheel { rail, first, .. } = self.wheels[w];
        let [x, vertical, lateral, traction] = std::array::from_fn(|k| sample[first + k]);
        let along = if self.loaded.foundations[s].is_loaded_along { traction } else { 0.0 };
        for (axis, force) in
            [(Axis::Longitudinal, along), (Axis::Lateral, lateral), (Axis::Vertical, -vertical)]
        {
            if force == 0.0 && axis != Axis::Vertical {
                continue;
            }
            let own = &mut self.shapes[n * w..n * (w + 1)];
            let slopes = &mut self.slopes[n * w..n * (w + 1)];
            let row = self.basis.structure.shapes.row(Probe { rail, x, axis }, own, slopes);
            row.map_err(|source| Error::Compliance { structure: s, source })?;
            loads.iter_mut().zip(own).for_each(|(load, shape)| *load += *shape * force);
        }
        Ok(())
    }

    /// Notes the deflection and the force that wheel `w` lacks, which moves with `speed`. `lag` is the difference of each
    /// mode from its static deflection, and the rate of this difference.
    fn note_wheel(
        &mut self,
        w: usize,
        sample: &[f64],
        speed: f64,
        [lag, rates]: [&[f64]; 2],
    ) -> Result<(), Error> {
        let (n, s) = (lag.len(), self.loaded.structure);
        let Wheel { rail, first, contact: [k, c], ref at_modes, .. } = self.wheels[w];
        let [shape, slope] = [&self.shapes, &self.slopes].map(|all| &all[n * w..n * (w + 1)]);
        let [deflection, force] = &mut self.by_wheel[w];
        note(&self.counts, &mut deflection.largest, |r| shape[r] * lag[r], n);
        if sample[first + 1] == 0.0 {
            return Ok(());
        }
        let mut flexibility = 0.0;
        if let Some(compliance) = &self.loaded.foundations[s].compliance {
            let mut influence = Influence::zeros(1);
            let probe = Probe { rail, x: sample[first], axis: Axis::Vertical };
            let filled = compliance.fill(&[probe], &mut influence);
            filled.map_err(|source| Error::Compliance { structure: s, source })?;
            flexibility = influence.value[(0, 0)];
        }
        self.gains.resize(n, 0.0);
        for (r, gain) in self.gains.iter_mut().enumerate() {
            let mode = &self.oscillators[r];
            flexibility -= (shape[r] / mode.omega).powi(2);
            let (lacking, rate) = (shape[r] * lag[r], shape[r] * rates[r] + slope[r] * speed * lag[r]);
            *gain = (k * lacking + c * rate) / (1.0 + at_modes[r] * flexibility.max(0.0));
        }
        note(&self.counts, &mut force.largest, |r| self.gains[r], n);
        Ok(())
    }

    /// The largest relative error for each number of modes kept.
    fn errors(self) -> Vec<TailError> {
        let record = self.loaded.record;
        let scales = record.scales();
        let slots: Vec<Slot> = (self.by_wheel.into_iter().flatten())
            .chain(self.drives.into_iter().map(|(_, slot)| slot))
            .chain(self.gauges.into_iter().map(|(_, slot)| slot))
            .chain(self.effects.into_iter().map(|(_, slot)| slot))
            .collect();
        let of_count = |(index, &kept): (usize, &usize)| {
            let mut found = TailError { kept, error: 0.0, quantity: String::new() };
            for slot in &slots {
                let (largest, scale) = (slot.largest[index], scales[slot.quantity]);
                let error = if largest == 0.0 { 0.0 } else { largest / scale };
                if error > found.error || error.is_nan() {
                    found.error = if error.is_nan() { f64::INFINITY } else { error };
                    found.quantity.clone_from(&record.quantities[slot.quantity].name);
                }
            }
            found
        };
        self.counts.iter().enumerate().map(of_count).collect()
    }
}

/// Raises `largest` to the absolute sums of `term` over the modes that are not kept, for each number of modes kept.
fn note(counts: &[usize], largest: &mut [f64], term: impl Fn(usize) -> f64, modes: usize) {
    let (mut sum, mut above) = (0.0_f64, modes);
    for (count, largest) in counts.iter().zip(largest).rev() {
        while above > *count {
            above -= 1;
            sum += term(above);
        }
        *largest = largest.max(sum.abs());
    }
}

/// Acceleration of a body at sample `i`, from its six speeds at the samples beside it.
fn acceleration(history: &History, i: usize, first: usize) -> [f64; 6] {
    let (before, after) = (i.saturating_sub(1), (i + 1).min(history.len() - 1));
    let [a, b] = [history.sample(before), history.sample(after)];
    let span = b[0] - a[0];
    std::array::from_fn(|k| if span > 0.0 { (b[first + k] - a[first + k]) / span } else { 0.0 })
}

#[cfg(test)]
mod tests;
