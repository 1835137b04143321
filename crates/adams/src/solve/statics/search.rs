//! Newton's method for static equilibrium, with pseudo-transient continuation where it fails.
//!
//! The unknowns and equations are those of `iterate` and `balance`. Every iteration evaluates the residual r
//! and its Jacobian J, scales both, and solves J s = -r, in the least-squares sense where J is singular. The
//! step s is halved until the simplified correction after it is smaller than s (natural monotonicity).
//! Rotations are limited to half a radian. The iteration ends when steps are at the level of rounding and the
//! scaled residual is below 1e-9 or at the level of rounding.
//!
//! After every step the algebraic loops and the differentials are solved again where the parts stand. The forces of
//! wheels are then always those of the compressed contacts. Without this, the forces of one iterate belong to rails
//! deflected as at the iterate before, and a stiff wheel that is in contact appears to be far above its rail: its force
//! and its derivatives are zero there, and the Jacobian is singular.
//!
//! If no fraction of a step passes the test, or if nothing holds a part, the parts continue against a viscous
//! resistance: J s - D s = -r, where D resists translations and rotations. The resistance decreases with the residual.
//! Once it is negligible, Newton's method starts again.

use super::balance::balance;
use super::equilibrium::{ConstraintReaction, Equilibrium};
use super::iterate::{Iterate, RotationMeasure, Unknown, seed, unknowns};
use crate::kinematics::Frame;
use crate::model::{AdamsModel, Configuration, Equation, Evaluation, Owner};
use crate::solve::linear::FactoredMatrix;
use crate::{Dual, Error, ModelState, Scalar, StatementId};
use nalgebra::{DMatrix, Vector3};
use std::collections::BTreeMap;

/// Largest number of iterations.
const MOST: usize = 400;
/// Steps of at most this size, relative to their scale, are at the level of rounding.
pub(super) const ROUNDING: f64 = 1e-15;
/// Steps that no longer decrease count as rounding if they are below this size.
pub(super) const STALLED: f64 = 1e-10;
/// Largest scaled residual of an equilibrium.
const RESIDUAL: f64 = 1e-9;

/// Finds the equilibrium near a guess. Another equilibrium, if given, supplies the initial values of loops.
pub(super) fn search(
    model: &AdamsModel,
    guess: &ModelState,
    before: Option<&Equilibrium>,
) -> Result<Equilibrium, Error> {
    let mut start = Iterate::new(model, guess, RotationMeasure::Finite)?;
    if let Some(before) = before.filter(|one| one.solution.values.len() == model.slots.len()) {
        start.values.clone_from(&before.solution.values);
    } else if let Ok(closed) = model.solve(guess) {
        // An IC of zero does not give the size of a variable; loops that are closed at the guess do.
        start.values.clone_from(&closed.values);
    }
    let search = Search::new(model, &start);
    if search.unknowns.is_empty() {
        return search.report(&start, 0, 0);
    }
    let start = search.assembled(start);
    search.run(search.closed(start))
}

/// The equations at an iterate, linearised by the unknowns.
pub(super) struct Linearized {
    pub residual: Vec<f64>,
    pub matrix: DMatrix<f64>,
    /// The scale of each residual.
    pub rows: Vec<f64>,
    /// What rounding of the unknowns, and of the freedoms of parts that are held, makes of each equation.
    rounding: Vec<f64>,
}

impl Linearized {
    /// The largest residual of each equation that holds: `fraction` of its scale, or what rounding makes of it, whichever is
    /// larger, since the force of a stiff wheel changes by its stiffness times the rounding of a coordinate.
    pub fn allowed(&self, fraction: f64) -> Vec<f64> {
        let pairs = self.rows.iter().zip(&self.rounding);
        pairs
            .map(|(row, rounding)| (fraction * row).max(*rounding))
            .collect()
    }

    /// Whether every equation holds, to 1e-9 of its scale or to its rounding.
    pub fn holds(&self) -> bool {
        let allowed = self.allowed(RESIDUAL);
        let mut all = self.residual.iter().zip(&allowed);
        all.all(|(r, allowed)| r.abs() <= *allowed)
    }
}

/// Largest scaled residual of linear equations that have a solution.
const SOLVED: f64 = 1e-6;
/// A search and the scales of its quantities.
pub(super) struct Search<'a> {
    pub model: &'a AdamsModel,
    pub unknowns: Vec<Unknown>,
    /// Freedoms of parts that stay where they are. Expressions read them, with their rounding.
    pub held: Vec<Unknown>,
    /// The unknowns of algebraic loops and of differential equations.
    pub inner: Vec<Unknown>,
    /// Typical length of the model.
    length: f64,
    /// Typical force: its largest weight.
    force: f64,
}

impl<'a> Search<'a> {
    /// A search whose scales are those of the parts where they are at the start.
    pub fn new(model: &'a AdamsModel, start: &Iterate) -> Search<'a> {
        let unknowns = unknowns(model);
        let inner =
            |unknown: &&Unknown| matches!(unknown, Unknown::Slot(_) | Unknown::Differential(_));
        Search {
            model,
            inner: unknowns.iter().filter(inner).copied().collect(),
            unknowns,
            held: Vec::new(),
            length: model_length(model, start),
            force: model_force(model),
        }
    }
}

impl Search<'_> {
    /// Iterates from `at` to equilibrium.
    pub fn run(&self, mut at: Iterate) -> Result<Equilibrium, Error> {
        // The viscous resistance, force over length; zero in Newton's method.
        let mut resistance = 0.0;
        let mut before = f64::INFINITY;
        let mut worst = (0, f64::INFINITY);
        let mut iterations = 0;
        while iterations < MOST {
            iterations += 1;
            let all = self.linearize_all(&at)?;
            let balances = all.holds();
            let Linearized {
                residual,
                matrix,
                rows,
                ..
            } = all;
            let left = scaled_size(&residual, &rows);
            worst = largest(&residual, &rows);
            let Some(factored) = self.factor(&at, matrix.clone(), resistance) else {
                break;
            };
            let Some(step) = factored.correction(&residual) else {
                break;
            };
            let is_held =
                factored.rank_deficiency() == 0 || solves(&matrix, &step, &residual, &rows);
            if resistance == 0.0 && !is_held {
                (resistance, before) = (self.force / (0.01 * self.length), f64::INFINITY);
                continue;
            }
            if resistance > 0.0 {
                (at, resistance) = self.resisted_step(at, &step, left, resistance);
                continue;
            }
            let scales = self.step_scales(&at, &step);
            let length = scaled_size(&step, &scales);
            let stalled = length <= STALLED && length >= 0.1 * before;
            if (length <= ROUNDING || stalled) && balances {
                let end = if stalled {
                    at
                } else {
                    at.after(&self.unknowns, &step, 1.0)
                };
                return self.report(&end, iterations, factored.rank_deficiency());
            }
            before = length;
            match self
                .damped_step(&at, &factored, &step, &scales)
                .filter(|_| length > ROUNDING)
            {
                Some(next) => at = next,
                None if length <= STALLED && balances => {
                    return self.report(&at, iterations, factored.rank_deficiency());
                }
                None => (resistance, before) = (self.force / (0.01 * self.length), f64::INFINITY),
            }
        }
        let (keyword, id) = self.statement_of(worst.0);
        let statement = StatementId::new(keyword, id);
        Err(Error::Equilibrium {
            statement,
            residual: worst.1,
            iterations,
        })
    }

    /// The matrix with viscous resistance, factored in scales in which the stiffness that supports a part
    /// counts and rounding does not.
    pub fn factor(
        &self,
        at: &Iterate,
        mut matrix: DMatrix<f64>,
        resistance: f64,
    ) -> Option<FactoredMatrix> {
        self.add_resistance(&mut matrix, resistance);
        let zero = vec![0.0; self.unknowns.len()];
        let (mut rows, mut columns) = (self.residual_scales(at), self.step_scales(at, &zero));
        for (k, unknown) in self.unknowns.iter().enumerate() {
            if let Unknown::Slot(slot) = unknown
                && self.model.slots[*slot].owner == Owner::Variable
            {
                let large = at.values[*slot].abs().max(0.01 * self.length);
                (rows[k], columns[k]) = (large, large);
            }
        }
        FactoredMatrix::scaled(&matrix, &rows, &columns)
    }

    /// The iterate after the largest fraction of a step that passes the test of natural monotonicity.
    fn damped_step(
        &self,
        at: &Iterate,
        factored: &FactoredMatrix,
        step: &[f64],
        scales: &[f64],
    ) -> Option<Iterate> {
        let length = scaled_size(step, scales);
        // The linearization is not used for rotations beyond half a radian.
        let mut fraction = 0.5 / self.largest_angle(step).max(0.5);
        while fraction > 1e-6 {
            let next = self.closed(at.after(&self.unknowns, step, fraction));
            let after = self
                .residual(&next)
                .ok()
                .and_then(|residual| factored.correction(&residual));
            if after.is_some_and(|after| {
                scaled_size(&after, scales) <= (1.0 - 0.25 * fraction) * length
            }) {
                return Some(next);
            }
            fraction *= 0.5;
        }
        None
    }

    /// A step against the viscous resistance, limited to a twentieth of the size of the model and 0.2 rad,
    /// and the resistance of the next step. A step that increases the residual too much is rejected.
    fn resisted_step(
        &self,
        at: Iterate,
        step: &[f64],
        left: f64,
        resistance: f64,
    ) -> (Iterate, f64) {
        let limit = |unknown: &Unknown| match unknown {
            Unknown::Translation(..) => 0.05 * self.length,
            Unknown::Rotation(..) => 0.2,
            _ => f64::INFINITY,
        };
        let most = self
            .unknowns
            .iter()
            .zip(step)
            .map(|(unknown, d)| d.abs() / limit(unknown));
        let fraction = 1.0 / most.fold(1.0, f64::max);
        let next = self.closed(at.after(&self.unknowns, step, fraction));
        let after = self.residual(&next).ok();
        let after = after.map(|residual| scaled_size(&residual, &self.residual_scales(&next)));
        match after {
            Some(after) if after <= 3.0 * left || after <= RESIDUAL => {
                let reduced = resistance * (after / left).clamp(0.05, 0.6);
                let negligible = reduced * self.length < 1e-6 * self.force || after < 1e-6;
                (next, if negligible { 0.0 } else { reduced })
            }
            _ => (at, 8.0 * resistance),
        }
    }

    /// The largest rotation of a step.
    pub fn largest_angle(&self, step: &[f64]) -> f64 {
        let rotations = self
            .unknowns
            .iter()
            .zip(step)
            .filter(|(unknown, _)| matches!(unknown, Unknown::Rotation(..)));
        rotations.fold(0.0_f64, |top, (_, d)| top.max(d.abs()))
    }

    /// Adds the viscous resistance to the derivatives of forces and torques.
    fn add_resistance(&self, matrix: &mut DMatrix<f64>, resistance: f64) {
        for (k, unknown) in self.unknowns.iter().enumerate() {
            match unknown {
                Unknown::Translation(..) => matrix[(k, k)] -= resistance,
                Unknown::Rotation(..) => matrix[(k, k)] -= resistance * self.length * self.length,
                _ => {}
            }
        }
    }

    /// Everything that expressions read, for parts in the given frames.
    pub fn evaluation<T: Scalar>(
        &self,
        time: f64,
        frames: &[Frame<T>],
        differentials: Vec<T>,
        values: Vec<T>,
    ) -> Evaluation<'_, T> {
        let at = Configuration::new(&self.model.markers, frames, 0);
        let mode = Configuration::<T>::STATIC;
        self.model.evaluation_on(Configuration {
            time,
            mode,
            differentials,
            values,
            ..at
        })
    }

    /// The residuals of `unknowns` and all values at an iterate.
    pub fn balanced(
        &self,
        at: &Iterate,
        unknowns: &[Unknown],
    ) -> Result<(Vec<f64>, Evaluation<'_, f64>), Error> {
        let frames = at.frames();
        let mut on = self.evaluation(
            at.time,
            &frames,
            at.differentials.clone(),
            at.values.clone(),
        );
        let residual = balance(
            self.model,
            &frames,
            &mut on,
            unknowns,
            &at.reactions,
            at.measure,
        )?;
        Ok((residual, on))
    }

    /// The residuals.
    fn residual(&self, at: &Iterate) -> Result<Vec<f64>, Error> {
        Ok(self.balanced(at, &self.unknowns)?.0)
    }

    /// The residuals of `unknowns` and their Jacobian.
    pub fn linearize(
        &self,
        at: &Iterate,
        unknowns: &[Unknown],
    ) -> Result<(Vec<f64>, DMatrix<f64>), Error> {
        let count = unknowns.len();
        let index = |wanted: Unknown| unknowns.iter().position(|unknown| *unknown == wanted);
        let frames = at.dual_frames(unknowns);
        let differential =
            |(k, value): (usize, &f64)| seed(*value, index(Unknown::Differential(k)), count);
        let differentials = at
            .differentials
            .iter()
            .enumerate()
            .map(differential)
            .collect();
        let slot = |(k, value): (usize, &f64)| seed(*value, index(Unknown::Slot(k)), count);
        let values = at.values.iter().enumerate().map(slot).collect();
        let reactions: Vec<Vec<Dual>> = at
            .reactions
            .iter()
            .enumerate()
            .map(|(k, list)| {
                let one =
                    |(e, value): (usize, &f64)| seed(*value, index(Unknown::Reaction(k, e)), count);
                list.iter().enumerate().map(one).collect()
            })
            .collect();
        let mut on = self.evaluation(at.time, &frames, differentials, values);
        let all = balance(
            self.model, &frames, &mut on, unknowns, &reactions, at.measure,
        )?;
        let matrix = DMatrix::from_fn(count, count, |i, j| all[i].derivative(j));
        Ok((all.iter().map(Scalar::value).collect(), matrix))
    }

    /// The equations at an iterate, with their scales and rounding.
    pub fn linearize_all(&self, at: &Iterate) -> Result<Linearized, Error> {
        let (count, held) = (self.unknowns.len(), self.held.len());
        let every = [&self.unknowns[..], &self.held[..]].concat();
        let (mut residual, matrix) = self.linearize(at, &every)?;
        residual.truncate(count);
        let by_held = matrix.view((0, count), (count, held)).into_owned();
        let matrix = matrix.resize(count, count, 0.0);
        Ok(Linearized {
            residual,
            rows: self.residual_scales(at),
            rounding: self.rounding(at, [&matrix, &by_held]),
            matrix,
        })
    }

    /// The scale of each unknown, relative to which its steps are measured.
    pub fn step_scales(&self, at: &Iterate, step: &[f64]) -> Vec<f64> {
        let reaction = at
            .reactions
            .iter()
            .flatten()
            .fold(self.force, |top, value| top.max(value.abs()));
        let scale = |(unknown, d): (&Unknown, &f64)| match *unknown {
            Unknown::Translation(..) => self.length,
            Unknown::Rotation(..) => 1.0,
            Unknown::Slot(slot) => {
                let floor = match self.model.slots[slot].owner {
                    Owner::Load(..) => self.force,
                    _ => self.length,
                };
                let value = at.values[slot];
                value.abs().max((value + d).abs()).max(1e-6 * floor)
            }
            Unknown::Differential(k) => {
                let value = at.differentials[k];
                value.abs().max((value + d).abs()).max(1e-6 * self.length)
            }
            Unknown::Reaction(constraint, equation) => {
                match self.model.constraints[constraint].equations[equation] {
                    Equation::Along(_) => reaction,
                    _ => reaction * self.length.max(1.0),
                }
            }
        };
        self.unknowns.iter().zip(step).map(scale).collect()
    }

    /// What rounding of the unknowns and of the freedoms that are held makes of each equation, by its derivatives.
    fn rounding(&self, at: &Iterate, [matrix, by_held]: [&DMatrix<f64>; 2]) -> Vec<f64> {
        let sizes = self.step_scales(at, &vec![0.0; self.unknowns.len()]);
        let held = self.held.iter().map(|unknown| match unknown {
            Unknown::Rotation(..) => 1.0,
            _ => self.length,
        });
        let held: Vec<f64> = held.collect();
        let terms = |of: &DMatrix<f64>, sizes: &[f64], i: usize| -> f64 {
            let terms = sizes.iter().enumerate();
            terms.map(|(j, size)| (of[(i, j)] * size).abs()).sum()
        };
        (0..self.unknowns.len())
            .map(|i| (terms(matrix, &sizes, i) + terms(by_held, &held, i)) * 8.0 * f64::EPSILON)
            .collect()
    }

    /// The scale of each residual.
    pub fn residual_scales(&self, at: &Iterate) -> Vec<f64> {
        let scale = |unknown: &Unknown| match *unknown {
            Unknown::Translation(..) => self.force,
            Unknown::Rotation(..) => self.force * self.length,
            Unknown::Slot(slot) => match self.model.slots[slot].owner {
                Owner::Load(_, component) if component < 3 => self.force,
                Owner::Load(..) => self.force * self.length,
                _ => at.values[slot].abs().max(1e-6 * self.length),
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

    /// The keyword and identifier of the statement that an equation belongs to.
    pub fn statement_of(&self, equation: usize) -> (&'static str, u32) {
        match self.unknowns.get(equation) {
            Some(Unknown::Translation(part, _) | Unknown::Rotation(part, _)) => {
                ("PART", self.model.parts[*part].id)
            }
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

    /// The equilibrium at an iterate.
    pub fn report(
        &self,
        at: &Iterate,
        iterations: usize,
        undetermined: usize,
    ) -> Result<Equilibrium, Error> {
        let (_, on) = self.balanced(at, &self.unknowns)?;
        on.beyond.borrow_mut().clear();
        let solution = self.model.report(&on, iterations)?;
        let mut reactions = BTreeMap::new();
        for (constraint, reaction) in self.model.constraints.iter().zip(&solution.reactions) {
            if let Some([force, torque]) = reaction {
                let reaction = ConstraintReaction {
                    force: (*force).into(),
                    torque: (*torque).into(),
                };
                reactions.insert((constraint.keyword, constraint.id), reaction);
            }
        }
        Ok(Equilibrium {
            state: at.state(self.model),
            solution,
            reactions,
            iterations,
            rank_deficiency: undetermined,
        })
    }
}

/// Whether a step satisfies J s + r = 0 to 1e-6 of the scales of the residuals. Where J is singular because nothing
/// holds a part, it does not.
fn solves(matrix: &DMatrix<f64>, step: &[f64], residual: &[f64], rows: &[f64]) -> bool {
    let left = |i: usize| {
        step.iter()
            .enumerate()
            .map(|(j, d)| matrix[(i, j)] * d)
            .sum::<f64>()
            + residual[i]
    };
    (0..residual.len()).all(|i| left(i).abs() <= SOLVED * rows[i])
}

/// The largest ratio of a number to its scale; NaN counts as infinite.
pub(super) fn scaled_size(all: &[f64], scales: &[f64]) -> f64 {
    let ratio = |(value, scale): (&f64, &f64)| {
        if *value == 0.0 {
            0.0
        } else {
            value.abs() / scale
        }
    };
    all.iter().zip(scales).map(ratio).fold(0.0, |top, one| {
        if one.is_nan() {
            f64::INFINITY
        } else {
            top.max(one)
        }
    })
}

/// The index and value of the number with the largest ratio to its scale.
fn largest(all: &[f64], scales: &[f64]) -> (usize, f64) {
    let ratio = |k: usize| all[k].abs() / scales[k];
    let worst = (0..all.len())
        .max_by(|a, b| ratio(*a).total_cmp(&ratio(*b)))
        .unwrap_or(0);
    (worst, all.get(worst).copied().unwrap_or(0.0))
}

/// The size of the model: the largest distance of a marker from its part, or of a part from the first one.
fn model_length(model: &AdamsModel, at: &Iterate) -> f64 {
    let arms = model
        .markers
        .iter()
        .map(|marker| Vector3::from(marker.position).norm());
    let first = at.origins.first().copied().unwrap_or_default();
    let parts = at.origins.iter().map(|origin| (origin - first).norm());
    let top = arms.chain(parts).fold(0.0, f64::max);
    if top > 0.0 { top } else { 1.0 }
}

/// The largest weight of a part.
fn model_force(model: &AdamsModel) -> f64 {
    let g = Vector3::from(model.gravity).norm();
    let top = model
        .parts
        .iter()
        .map(|part| part.mass.abs() * g)
        .fold(0.0, f64::max);
    if top > 0.0 { top } else { 1.0 }
}
