//! Newton's method on places, with a viscous fluid to fall back on.

use super::balance::balance;
use super::place::{Place, Unknown, seed, unknowns};
use super::{Equilibrium, Reaction};
use crate::linear::Linear;
use crate::model::{Equation, Model, Owner};
use crate::{Dual, Error, Scalar, State};
use nalgebra::DMatrix;

/// Iterations before giving up.
const MOST: usize = 400;
/// Steps of this size, relative to their scale, are rounding.
const ROUNDING: f64 = 1e-15;
/// Steps that no longer shrink are rounding below this size.
const STALLED: f64 = 1e-10;
/// What may be left of forces, gaps and loops, relative to their scale.
const LEFT: f64 = 1e-9;

/// Equilibrium from a guess, with reactions and values of another one where there is one.
pub(super) fn search(
    model: &Model,
    guess: &State,
    before: Option<&Equilibrium>,
) -> Result<Equilibrium, Error> {
    let mut place = Place::new(model, guess)?;
    if let Some(before) = before.filter(|one| one.solution.values.len() == model.slots.len()) {
        place.values.clone_from(&before.solution.values);
    } else if let Ok(closed) = model.solve(guess) {
        // An IC of zero says nothing of a variable's size; loops that close at the guess do.
        place.values.clone_from(&closed.values);
    }
    let search =
        Search { model, unknowns: unknowns(model), length: length(model, &place), force: force(model) };
    if search.unknowns.is_empty() {
        return search.report(&place, 0, 0);
    }
    search.run(place)
}

struct Search<'a> {
    model: &'a Model,
    unknowns: Vec<Unknown>,
    /// Size of the model.
    length: f64,
    /// Size of its weights.
    force: f64,
}

impl Search<'_> {
    fn run(&self, mut place: Place) -> Result<Equilibrium, Error> {
        // Resistance of the fluid: force over length; none at first.
        let mut drag = 0.0;
        let mut before = f64::INFINITY;
        let mut worst = (0, f64::INFINITY);
        let mut iterations = 0;
        while iterations < MOST {
            iterations += 1;
            let (residual, matrix) = self.slope(&place)?;
            let rows = self.rows(&place);
            let left = size(&residual, &rows);
            worst = largest(&residual, &rows, &residual);
            let Some(linear) = self.factor(&place, matrix, drag) else { break };
            let Some(step) = self.correction(&linear, &residual) else { break };
            if drag > 0.0 {
                (place, drag) = self.sink(place, &step, left, drag);
                continue;
            }
            let scales = self.scales(&place, &step);
            let long = size(&step, &scales);
            let rounding = long <= STALLED && long >= 0.1 * before;
            if (long <= ROUNDING || rounding) && left <= LEFT {
                let place = if rounding { place } else { place.ahead(&self.unknowns, &step, 1.0) };
                return self.report(&place, iterations, linear.missing());
            }
            before = long;
            match self.descend(&place, &linear, &step, &scales).filter(|_| long > ROUNDING) {
                Some(next) => place = next,
                None if long <= STALLED && left <= LEFT => {
                    return self.report(&place, iterations, linear.missing());
                }
                None => (drag, before) = (self.force / (0.01 * self.length), f64::INFINITY),
            }
        }
        let (keyword, id) = self.name(worst.0);
        Err(Error::Equilibrium { keyword: keyword.to_owned(), id, residual: worst.1, iterations })
    }

    /// The matrix with drag, factored in scales in which what holds a part counts and rounding does not.
    fn factor(&self, place: &Place, mut matrix: DMatrix<f64>, drag: f64) -> Option<Linear> {
        self.thicken(&mut matrix, drag);
        let (mut rows, mut columns) = (self.rows(place), self.scales(place, &vec![0.0; self.unknowns.len()]));
        for (k, unknown) in self.unknowns.iter().enumerate() {
            if let Unknown::Slot(slot) = unknown
                && self.model.slots[*slot].owner == Owner::Variable
            {
                let large = place.values[*slot].abs().max(0.01 * self.length);
                (rows[k], columns[k]) = (large, large);
            }
        }
        Linear::scaled(&matrix, &rows, &columns)
    }

    fn correction(&self, linear: &Linear, residual: &[f64]) -> Option<Vec<f64>> {
        Some(linear.solve(residual)?.iter().map(|value| -value).collect())
    }

    /// The place after the largest share of a step after which the next is smaller.
    fn descend(&self, place: &Place, linear: &Linear, step: &[f64], scales: &[f64]) -> Option<Place> {
        let long = size(step, scales);
        // Rotations beyond half a radian leave the tangent too far behind.
        let turns =
            self.unknowns.iter().zip(step).filter(|(unknown, _)| matches!(unknown, Unknown::Turn(..)));
        let turn = turns.fold(0.0_f64, |top, (_, d)| top.max(d.abs()));
        let mut share = if turn > 0.5 { 0.5 / turn } else { 1.0 };
        while share > 1e-6 {
            let next = place.ahead(&self.unknowns, step, share);
            let after = self.value(&next).ok().and_then(|residual| self.correction(linear, &residual));
            if after.is_some_and(|after| size(&after, scales) <= (1.0 - 0.25 * share) * long) {
                return Some(next);
            }
            share *= 0.5;
        }
        None
    }

    /// A step against drag, and the drag of the next.
    fn sink(&self, place: Place, step: &[f64], left: f64, drag: f64) -> (Place, f64) {
        let reach = |unknown: &Unknown| match unknown {
            Unknown::Shift(..) => 0.05 * self.length,
            Unknown::Turn(..) => 0.2,
            _ => f64::INFINITY,
        };
        let most = self.unknowns.iter().zip(step).map(|(unknown, d)| d.abs() / reach(unknown));
        let share = 1.0 / most.fold(1.0, f64::max);
        let next = place.ahead(&self.unknowns, step, share);
        let after = self.value(&next).ok().map(|residual| size(&residual, &self.rows(&next)));
        match after {
            Some(after) if after <= 3.0 * left || after <= LEFT => {
                let thinner = drag * (after / left).clamp(0.05, 0.6);
                // Thin enough for Newton's own steps.
                let done = thinner * self.length < 1e-6 * self.force || after < 1e-6;
                (next, if done { 0.0 } else { thinner })
            }
            _ => (place, 8.0 * drag),
        }
    }

    /// Drag: forces and torques against steps of the parts.
    fn thicken(&self, matrix: &mut DMatrix<f64>, drag: f64) {
        for (k, unknown) in self.unknowns.iter().enumerate() {
            match unknown {
                Unknown::Shift(..) => matrix[(k, k)] -= drag,
                Unknown::Turn(..) => matrix[(k, k)] -= drag * self.length * self.length,
                _ => {}
            }
        }
    }

    fn value(&self, place: &Place) -> Result<Vec<f64>, Error> {
        let frames = place.frames();
        let mut view = self.model.view_of(&frames, place.time, 5.0, place.differentials.clone());
        view.values.clone_from(&place.values);
        balance(self.model, &frames, &mut view, &self.unknowns, &place.reactions)
    }

    fn slope(&self, place: &Place) -> Result<(Vec<f64>, DMatrix<f64>), Error> {
        let count = self.unknowns.len();
        let index = |wanted: Unknown| self.unknowns.iter().position(|unknown| *unknown == wanted);
        let frames = place.dual_frames(&self.unknowns);
        let states = place.differentials.iter().enumerate();
        let states = states.map(|(k, value)| seed(*value, index(Unknown::Differential(k)), count)).collect();
        let mut view = self.model.view_of(&frames, place.time, 5.0, states);
        for (k, value) in place.values.iter().enumerate() {
            view.values[k] = seed(*value, index(Unknown::Slot(k)), count);
        }
        let reactions: Vec<Vec<Dual>> = place
            .reactions
            .iter()
            .enumerate()
            .map(|(k, list)| {
                let one = |(e, value): (usize, &f64)| seed(*value, index(Unknown::Reaction(k, e)), count);
                list.iter().enumerate().map(one).collect()
            })
            .collect();
        let all = balance(self.model, &frames, &mut view, &self.unknowns, &reactions)?;
        let matrix = DMatrix::from_fn(count, count, |i, j| all[i].slope(j));
        Ok((all.iter().map(Scalar::value).collect(), matrix))
    }

    /// Sizes of steps that count as large.
    fn scales(&self, place: &Place, step: &[f64]) -> Vec<f64> {
        let all = place.reactions.iter().flatten().fold(self.force, |top, value| top.max(value.abs()));
        let scale = |(unknown, d): (&Unknown, &f64)| match *unknown {
            Unknown::Shift(..) => self.length,
            Unknown::Turn(..) => 1.0,
            Unknown::Slot(slot) => {
                let floor = match self.model.slots[slot].owner {
                    Owner::Load(..) => self.force,
                    _ => self.length,
                };
                let value = place.values[slot];
                value.abs().max((value + d).abs()).max(1e-6 * floor)
            }
            Unknown::Differential(k) => {
                let value = place.differentials[k];
                value.abs().max((value + d).abs()).max(1e-6 * self.length)
            }
            Unknown::Reaction(constraint, equation) => {
                match self.model.constraints[constraint].equations[equation] {
                    Equation::Along(_) => all,
                    _ => all * self.length.max(1.0),
                }
            }
        };
        self.unknowns.iter().zip(step).map(scale).collect()
    }

    /// Sizes of residuals that count as large.
    fn rows(&self, place: &Place) -> Vec<f64> {
        let scale = |unknown: &Unknown| match *unknown {
            Unknown::Shift(..) => self.force,
            Unknown::Turn(..) => self.force * self.length,
            Unknown::Slot(slot) => match self.model.slots[slot].owner {
                Owner::Load(_, component) if component < 3 => self.force,
                Owner::Load(..) => self.force * self.length,
                _ => place.values[slot].abs().max(1e-6 * self.length),
            },
            Unknown::Differential(_) => self.length,
            Unknown::Reaction(constraint, equation) => {
                match self.model.constraints[constraint].equations[equation] {
                    Equation::Along(_) => self.length,
                    _ => 1.0,
                }
            }
        };
        self.unknowns.iter().map(scale).collect()
    }

    /// The statement behind an equation.
    fn name(&self, equation: usize) -> (&'static str, u32) {
        match self.unknowns.get(equation) {
            Some(Unknown::Shift(part, _) | Unknown::Turn(part, _)) => ("PART", self.model.parts[*part].id),
            Some(Unknown::Slot(slot)) => {
                let slot = &self.model.slots[*slot];
                (self.model.label(slot).0, slot.id)
            }
            Some(Unknown::Differential(diff)) => ("DIFF", self.model.diffs[*diff].id),
            Some(Unknown::Reaction(constraint, _)) => {
                let constraint = &self.model.constraints[*constraint];
                (constraint.keyword, constraint.id)
            }
            None => ("PART", 0),
        }
    }

    fn report(&self, place: &Place, iterations: usize, undetermined: usize) -> Result<Equilibrium, Error> {
        let model = self.model;
        let frames = place.frames();
        let mut view = model.view_of(&frames, place.time, 5.0, place.differentials.clone());
        view.values.clone_from(&place.values);
        balance(model, &frames, &mut view, &self.unknowns, &place.reactions)?;
        view.beyond.borrow_mut().clear();
        let solution = model.report(&view, iterations)?;
        let mut reactions = std::collections::BTreeMap::new();
        for (constraint, reaction) in model.constraints.iter().zip(&solution.reactions) {
            if let Some([force, torque]) = reaction {
                let reaction = Reaction { force: (*force).into(), torque: (*torque).into() };
                reactions.insert((constraint.keyword, constraint.id), reaction);
            }
        }
        Ok(Equilibrium { state: place.state(model), solution, reactions, iterations, undetermined })
    }
}

/// The largest share of a scale; NaN counts as infinite.
fn size(all: &[f64], scales: &[f64]) -> f64 {
    let share = |(value, scale): (&f64, &f64)| if *value == 0.0 { 0.0 } else { value.abs() / scale };
    all.iter()
        .zip(scales)
        .map(share)
        .fold(0.0, |top, one| if one.is_nan() { f64::INFINITY } else { top.max(one) })
}

/// Where the largest share is, and what is there.
fn largest(all: &[f64], scales: &[f64], values: &[f64]) -> (usize, f64) {
    let share = |k: usize| all[k].abs() / scales[k];
    let worst = (0..all.len()).max_by(|a, b| share(*a).total_cmp(&share(*b))).unwrap_or(0);
    (worst, values.get(worst).copied().unwrap_or(0.0))
}

/// The largest distance of a marker or part from the first.
fn length(model: &Model, place: &Place) -> f64 {
    let arms = model.markers.iter().map(|marker| nalgebra::Vector3::from(marker.position).norm());
    let first = place.origins.first().copied().unwrap_or_default();
    let parts = place.origins.iter().map(|origin| (origin - first).norm());
    let top = arms.chain(parts).fold(0.0, f64::max);
    if top > 0.0 { top } else { 1.0 }
}

fn force(model: &Model) -> f64 {
    let g = nalgebra::Vector3::from(model.gravity).norm();
    let top = model.parts.iter().map(|part| part.mass.abs() * g).fold(0.0, f64::max);
    if top > 0.0 { top } else { 1.0 }
}
