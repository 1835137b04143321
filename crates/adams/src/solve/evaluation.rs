//! The expressions of a model at a state.

use crate::kinematics::Frame;
use crate::model::{AdamsModel, Configuration, Evaluation};
use crate::{Error, ModelState, Scalar, StatementId};

impl AdamsModel {
    /// The value of the expression of a slot.
    pub(super) fn slot_value<T: Scalar>(
        &self,
        slot: usize,
        on: &Evaluation<'_, T>,
    ) -> Result<T, Error> {
        let slot = &self.slots[slot];
        slot.formula.value(on).map_err(|fault| {
            let (keyword, argument) = self.label(slot);
            let statement = StatementId::new(keyword, slot.id);
            Error::In {
                statement,
                argument,
                offset: 0,
                fault: Box::new(fault),
            }
        })
    }

    /// Everything that expressions read at a state. The values of slots are zero.
    pub(super) fn evaluation<T: Scalar>(
        &self,
        state: &ModelState,
    ) -> Result<Evaluation<'_, T>, Error> {
        let missing = |keyword: &str, id: u32| Error::State {
            statement: StatementId::new(keyword, id),
        };
        let mut frames: Vec<Frame<T>> = Vec::with_capacity(self.parts.len());
        for part in &self.parts {
            frames.push(if part.ground {
                Frame::ground()
            } else {
                Frame::of(
                    state
                        .parts
                        .get(&part.id)
                        .ok_or_else(|| missing("PART", part.id))?,
                )
            });
        }
        let mut differentials = Vec::with_capacity(self.diffs.len());
        for diff in &self.diffs {
            let value = state
                .differentials
                .get(&diff.id)
                .ok_or_else(|| missing("DIFF", diff.id))?;
            differentials.push(T::constant(*value));
        }
        let at = Configuration::new(&self.markers, &frames, self.slots.len());
        Ok(self.evaluation_on(Configuration {
            time: state.time,
            differentials,
            ..at
        }))
    }

    /// Everything that expressions read on a configuration. No reaction is known yet.
    pub(super) fn evaluation_on<T: Scalar>(&self, at: Configuration<T>) -> Evaluation<'_, T> {
        Evaluation::new(&self.loads, &self.families, at, self.constraints.len())
    }
}
