//! Static equilibrium near a state whose VARIABLEs are known, such as an equilibrium of another program.
//!
//! The VARIABLEs are put into the expressions, and the equations are linearised there: one Newton step is the distance to
//! the equilibrium, and the residuals with the best reactions say which equations do not hold. Further full
//! steps find it. Since forces and displacements are both given, no loop has to be closed first: a stiff wheel is as
//! deep in its rail at the start as its force says. Where full steps do not converge, as where a wheel opens and closes
//! by turns, there is no answer: the equilibrium is not near.

use super::equilibrium::Equilibrium;
use super::iterate::{Iterate, RotationMeasure, Unknown};
use super::search::{Linearized, ROUNDING, STALLED, Search, scaled_size};
use crate::solve::substitution::GivenValues;
use crate::{AdamsModel, Error, ModelState, StatementId};
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeSet;

/// Largest number of full Newton steps.
const STEPS: usize = 25;
/// Singular values of the reactions' matrix below this fraction of the largest one count as zero.
const SINGULAR: f64 = 1e-11;

/// An equation of statics at a state.
#[derive(Clone, Debug, PartialEq)]
pub struct EquationResidual {
    /// The statement: the PART whose forces are not in balance, the VARIABLE, DIFF or load whose expression has
    /// another value, or the JOINT, JPRIM or MOTION that is not satisfied.
    pub statement: StatementId,
    /// The quantity of the residual.
    pub quantity: &'static str,
    /// The residual, in the units of the data set; what the expressions give above what is given.
    pub residual: f64,
    /// The residual relative to its scale: weights, and the size of the model.
    pub scaled: f64,
    /// Whether the equation holds: to a fraction of its scale, or to what rounding of the unknowns makes of it.
    pub holds: bool,
}

/// One Newton step from a state to equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct NewtonStep {
    /// The state after the step, whose length is the distance from equilibrium to first order.
    pub after: Equilibrium,
    /// Whether the step satisfies all of the linearised equations, as far as they must hold. Where they are singular, it may
    /// leave some.
    pub is_solved: bool,
}

impl AdamsModel {
    /// One Newton step from a state with given VARIABLEs to static equilibrium; `None` where the linearised equations have no
    /// solution. They must hold to `fraction` of their scales, or to what rounding makes of them.
    ///
    /// # Errors
    /// [`Error::State`] for a state without one of the parts or DIFFs; [`Error::In`] for an expression without a
    /// finite value.
    pub fn newton_step(
        &self,
        guess: &ModelState,
        given: &GivenValues,
        measure: RotationMeasure,
        fraction: f64,
    ) -> Result<Option<NewtonStep>, Error> {
        let at = self.iterate_near(guess, given, measure)?;
        let search = Search::new(self, &at).holding(&given.held);
        let all = search.linearize_all(&at)?;
        let Some(factored) = search.factor(&at, all.matrix.clone(), 0.0) else {
            return Ok(None);
        };
        let Some(step) = factored.correction(&all.residual) else {
            return Ok(None);
        };
        let left = &all.matrix * DVector::from_column_slice(&step);
        let sums = left.iter().zip(&all.residual).map(|(left, own)| left + own);
        let is_solved = sums
            .zip(all.allowed(fraction))
            .all(|(sum, most)| sum.abs() <= most);
        let after = at.after(&search.unknowns, &step, 1.0);
        let after = search.report(&after, 1, factored.rank_deficiency())?;
        Ok(Some(NewtonStep { after, is_solved }))
    }

    /// The equations of statics with their residuals at a state with given VARIABLEs, largest scaled residual first, with the
    /// reactions that leave the least sum of squares of residuals relative to what is allowed. An equation holds to `fraction` of
    /// its scale, or to what rounding makes of it; balances of parts, between which reactions distribute what is left, to the root
    /// of their number times that.
    ///
    /// # Errors
    /// Those of [`AdamsModel::newton_step`].
    pub fn imbalance(
        &self,
        guess: &ModelState,
        given: &GivenValues,
        measure: RotationMeasure,
        fraction: f64,
    ) -> Result<Vec<EquationResidual>, Error> {
        let at = self.iterate_near(guess, given, measure)?;
        let search = Search::new(self, &at).holding(&given.held);
        let all = search.linearize_all(&at)?;
        let allowed = all.allowed(fraction);
        let left = without_reactions(&search, &all, &allowed);
        let is_balance =
            |unknown: &Unknown| matches!(unknown, Unknown::Translation(..) | Unknown::Rotation(..));
        let balances = search.unknowns.iter().filter(|own| is_balance(own)).count();
        let own = |k: usize| {
            let (keyword, id) = search.statement_of(k);
            let share = match is_balance(&search.unknowns[k]) {
                true => (balances as f64).sqrt(),
                false => 1.0,
            };
            EquationResidual {
                statement: StatementId::new(keyword, id),
                quantity: quantity(&search.unknowns[k]),
                residual: left[k],
                scaled: left[k].abs() / all.rows[k],
                holds: left[k].abs() <= share * allowed[k],
            }
        };
        let mut equations: Vec<EquationResidual> = (0..left.len()).map(own).collect();
        equations.sort_by(|a, b| b.scaled.total_cmp(&a.scaled));
        Ok(equations)
    }

    /// The static equilibrium near a state with given VARIABLEs, by Newton's method from there; `None` if its steps do not
    /// converge. Freedoms that are held stay where they are.
    ///
    /// # Errors
    /// [`Error::State`] for a state without one of the parts or DIFFs; [`Error::In`] for an expression without a
    /// finite value.
    pub fn equilibrium_near(
        &self,
        guess: &ModelState,
        given: &GivenValues,
        measure: RotationMeasure,
    ) -> Result<Option<Equilibrium>, Error> {
        let start = self.iterate_near(guess, given, measure)?;
        let search = Search::new(self, &start).holding(&given.held);
        if search.unknowns.is_empty() {
            return search.report(&start, 0, 0).map(Some);
        }
        search.full_steps(start)
    }

    /// The unknowns at a state with given VARIABLEs; reactions are zero.
    fn iterate_near(
        &self,
        guess: &ModelState,
        given: &GivenValues,
        measure: RotationMeasure,
    ) -> Result<Iterate, Error> {
        let mut at = Iterate::new(self, guess, measure)?;
        let search = Search::new(self, &at);
        let frames = at.frames();
        let zeros = vec![0.0; self.slots.len()];
        let mut on = search.evaluation(at.time, &frames, at.differentials.clone(), zeros);
        self.substitution(|id| given.variables.contains_key(&id))?
            .fill(&mut on, given)?;
        at.values = on.at.values;
        Ok(at)
    }
}

impl Search<'_> {
    /// The search without some freedoms of parts, by identifier, and without their equations.
    fn holding(mut self, held: &BTreeSet<(u32, usize)>) -> Self {
        let id = |part: usize| self.model.parts[part].id;
        let is_held = |unknown: &Unknown| match *unknown {
            Unknown::Translation(part, axis) => held.contains(&(id(part), axis)),
            Unknown::Rotation(part, axis) => held.contains(&(id(part), 3 + axis)),
            _ => false,
        };
        (self.held, self.unknowns) = self.unknowns.iter().partition(|one| is_held(one));
        self
    }

    /// The equilibrium by full Newton steps; `None` if they do not converge.
    fn full_steps(&self, mut at: Iterate) -> Result<Option<Equilibrium>, Error> {
        let (mut before, mut first) = (f64::INFINITY, f64::INFINITY);
        for iterations in 1..=STEPS {
            let Ok(all) = self.linearize_all(&at) else {
                return Ok(None);
            };
            let balances = all.holds();
            let Linearized {
                residual, matrix, ..
            } = all;
            let Some(factored) = self.factor(&at, matrix, 0.0) else {
                return Ok(None);
            };
            let Some(step) = factored.correction(&residual) else {
                return Ok(None);
            };
            let length = scaled_size(&step, &self.step_scales(&at, &step));
            let stalled = length <= STALLED && length >= 0.1 * before;
            if balances && (length <= ROUNDING || stalled) {
                return self
                    .report(&at, iterations, factored.rank_deficiency())
                    .map(Some);
            }
            // Reactions start from zero, so that the first step is not a measure.
            if iterations == 2 {
                first = length;
            }
            if self.largest_angle(&step) > 0.5 || length > 1e3 * first {
                return Ok(None);
            }
            before = length;
            at = at.after(&self.unknowns, &step, 1.0);
        }
        Ok(None)
    }
}

/// The residuals with the reactions that leave the least sum of squares of residuals relative to what is allowed.
fn without_reactions(
    search: &Search<'_>,
    Linearized {
        residual, matrix, ..
    }: &Linearized,
    allowed: &[f64],
) -> Vec<f64> {
    let columns: Vec<usize> = (0..search.unknowns.len())
        .filter(|k| matches!(search.unknowns[*k], Unknown::Reaction(..)))
        .collect();
    if columns.is_empty() {
        return residual.clone();
    }
    let mut scaled = DMatrix::from_fn(residual.len(), columns.len(), |i, j| {
        matrix[(i, columns[j])] / allowed[i]
    });
    // Forces and torques differ by orders of magnitude; what is left does not depend on the units of reactions.
    for mut column in scaled.column_iter_mut() {
        column.try_normalize_mut(0.0);
    }
    let mut left = DVector::from_fn(residual.len(), |i, _| residual[i] / allowed[i]);
    if let Some(svd) = scaled.clone().try_svd(true, true, f64::EPSILON, 10_000) {
        let least = SINGULAR * svd.singular_values.max();
        // The second time it removes what rounding left.
        for _ in 0..2 {
            if let Ok(reactions) = svd.solve(&left, least) {
                left -= &scaled * reactions;
            }
        }
    }
    left.iter()
        .zip(allowed)
        .map(|(left, row)| left * row)
        .collect()
}

/// What the residual of an unknown's equation measures.
fn quantity(unknown: &Unknown) -> &'static str {
    match unknown {
        Unknown::Translation(_, axis) => ["force along x", "force along y", "force along z"][*axis],
        Unknown::Rotation(_, axis) => ["torque about x", "torque about y", "torque about z"][*axis],
        Unknown::Slot(_) => "value",
        Unknown::Differential(_) => "rate",
        Unknown::Reaction(..) => "gap",
    }
}
