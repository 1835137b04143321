//! The slots of a model at a given state, and its algebraic loops.

use super::newton;
use super::solution::SolvedModelState;
use crate::model::{AdamsModel, Block, Evaluation};
use crate::{Dual, Error, ModelState, Scalar, StatementId};
use nalgebra::DMatrix;

impl AdamsModel {
    /// VARIABLEs, forces and rates at a state.
    ///
    /// Expressions are evaluated in the order in which they depend on each other. Expressions that depend on
    /// each other in a loop are solved by Newton's method with exact derivatives and step halving, starting
    /// from the IC of the VARIABLEs, until corrections are at the level of rounding, about 1e-15 of each
    /// VARIABLE. An implicit DIFF is solved for DIF1. If its expression does not contain DIF1 and is zero,
    /// DIF1 keeps its initial value.
    ///
    /// # Errors
    /// [`Error::State`] for a state without one of the parts or DIFFs; [`Error::In`] for an expression
    /// without a finite value; [`Error::Loop`] if the iteration does not converge.
    ///
    /// ```
    /// use adams::{DataSet, AdamsModel};
    ///
    /// // v = 1 - 10.9 v, as for a wheel on a flexible girder: substitution would diverge.
    /// let set = DataSet::read("loop\nVARIABLE/1, FUNCTION=1-10.9*VARVAL(1)\nEND")?;
    /// let model = AdamsModel::new(&set)?;
    /// let solution = model.solve(&model.initial())?;
    /// assert!((solution.variables[&1] - 1.0 / 11.9).abs() < 1e-16);
    /// # Ok::<(), adams::Error>(())
    /// ```
    pub fn solve(&self, state: &ModelState) -> Result<SolvedModelState, Error> {
        let mut on = self.evaluation::<f64>(state)?;
        on.at.values = self.slots.iter().map(|slot| slot.guess).collect();
        let mut dual: Option<Evaluation<'_, Dual>> = None;
        let mut iterations = 0;
        for block in &self.order {
            match block {
                Block::Direct(slot) => {
                    let value = self.slot_value(*slot, &on)?;
                    on.at.values[*slot] = value;
                }
                Block::Loop { torn, rest } => {
                    let mut other = match dual.take() {
                        Some(dual) => dual,
                        None => self.evaluation::<Dual>(state)?,
                    };
                    other.at.values = on
                        .at
                        .values
                        .iter()
                        .map(|value| Dual::constant(*value))
                        .collect();
                    iterations += self.close(&mut on, &mut other, torn, rest)?;
                    dual = Some(other);
                }
            }
        }
        // The iterations may have read tables beyond their values where the solution does not.
        on.beyond.borrow_mut().clear();
        self.report(&on, iterations)
    }

    /// Solves one loop, and returns the number of iterations.
    ///
    /// Unknowns are the values of the torn slots. Given them, the other slots follow in order; the residual
    /// of a torn slot is its value minus the value of its expression, or the expression itself if the slot is
    /// implicit.
    fn close(
        &self,
        on: &mut Evaluation<'_, f64>,
        dual: &mut Evaluation<'_, Dual>,
        torn: &[usize],
        rest: &[usize],
    ) -> Result<usize, Error> {
        let count = torn.len();
        let start: Vec<f64> = torn.iter().map(|slot| on.at.values[*slot]).collect();
        let linearize = |x: &[f64]| {
            for (k, (slot, x)) in torn.iter().zip(x).enumerate() {
                dual.at.values[*slot] = Dual::unknown(*x, k, count);
            }
            let all = self.loop_residuals(dual, torn, rest)?;
            let matrix = DMatrix::from_fn(count, count, |i, j| all[i].derivative(j));
            Ok((all.iter().map(Scalar::value).collect(), matrix))
        };
        let residual = |x: &[f64]| {
            for (slot, x) in torn.iter().zip(x) {
                on.at.values[*slot] = *x;
            }
            self.loop_residuals(on, torn, rest)
        };
        let continued: Vec<bool> = torn
            .iter()
            .map(|slot| !self.slots[*slot].implicit)
            .collect();
        match newton::solve(start, &continued, linearize, residual)? {
            Ok((x, iterations)) => {
                for (slot, x) in torn.iter().zip(&x) {
                    on.at.values[*slot] = *x;
                }
                for slot in rest {
                    let found = self.slot_value(*slot, on)?;
                    on.at.values[*slot] = found;
                }
                Ok(iterations)
            }
            Err(failure) => {
                let slot = &self.slots[torn[failure.worst.min(count - 1)]];
                let statement = StatementId::new(self.label(slot).0, slot.id);
                Err(Error::Loop {
                    statement,
                    iterations: failure.iterations,
                })
            }
        }
    }

    /// The residuals of the torn slots of a loop. The values of its other slots are set on the way.
    fn loop_residuals<T: Scalar>(
        &self,
        on: &mut Evaluation<'_, T>,
        torn: &[usize],
        rest: &[usize],
    ) -> Result<Vec<T>, Error> {
        for slot in rest {
            let value = self.slot_value(*slot, on)?;
            on.at.values[*slot] = value;
        }
        let residual = |slot: &usize| {
            let value = self.slot_value(*slot, on)?;
            Ok(if self.slots[*slot].implicit {
                value
            } else {
                on.at.values[*slot].minus(&value)
            })
        };
        torn.iter().map(residual).collect()
    }
}
