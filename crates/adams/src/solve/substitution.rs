//! What the expressions of a model give when some of its quantities are given.

use super::solution::Load;
use crate::model::{AdamsModel, Block, Evaluation, Owner, order};
use crate::{Error, ModelState, Scalar, StatementId};
use std::collections::{BTreeMap, BTreeSet};

/// Values of VARIABLEs and rates to put into the expressions of a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GivenValues {
    /// Values VARVAL, by identifier of the VARIABLE.
    pub variables: BTreeMap<u32, f64>,
    /// Values DIF1, by identifier of the DIFF; zero where there is none.
    pub rates: BTreeMap<u32, f64>,
    /// Freedoms of parts that statics leaves where they are, by identifier of the PART: 0 to 2 translations along x, y
    /// and z of ground, 3 to 5 rotations about them.
    pub held: BTreeSet<(u32, usize)>,
}

/// What the expressions give after given values were put into them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SubstitutedValues {
    /// The value of the expression of every VARIABLE, by identifier. Where it equals the given value, the equation of
    /// the VARIABLE holds.
    pub variables: BTreeMap<u32, f64>,
    /// The value of the expression of every DIFF, by identifier: zero for an implicit one whose equation holds, DIF1
    /// for an explicit one.
    pub differentials: BTreeMap<u32, f64>,
    /// Every SFORCE, VFORCE, GFORCE and BEAM, by keyword and identifier.
    pub loads: BTreeMap<(&'static str, u32), Load>,
}

/// The order in which the expressions of a model follow from given VARIABLEs.
pub struct Substitution<'a> {
    model: &'a AdamsModel,
    /// The slots whose values are given: VARIABLEs and rates.
    given: Vec<bool>,
    /// The other slots, in order.
    rest: Vec<usize>,
}

impl AdamsModel {
    /// The order in which the expressions follow from the VARIABLEs `given`, by identifier, and from all rates DIF1.
    ///
    /// Algebraic loops need not be solved if their VARIABLEs are given: an equation v = f(v, ...) holds if f of the
    /// given values is the given v. A loop of equations in which every equation holds is solved.
    ///
    /// # Errors
    /// [`Error::Loop`] if the expressions that are not given depend on each other in a loop.
    ///
    /// ```
    /// use adams::{AdamsModel, DataSet, GivenValues};
    ///
    /// let set = DataSet::read("loop\nVARIABLE/1, FUNCTION=1-10.9*VARVAL(1)\nEND")?;
    /// let model = AdamsModel::new(&set)?;
    /// let mut given = GivenValues::default();
    /// given.variables.insert(1, 1.0 / 11.9);
    /// let found = model.substitution(|id| id == 1)?.at(&model.initial(), &given)?;
    /// assert!((found.variables[&1] - 1.0 / 11.9).abs() < 1e-15);
    /// # Ok::<(), adams::Error>(())
    /// ```
    pub fn substitution(&self, given: impl Fn(u32) -> bool) -> Result<Substitution<'_>, Error> {
        let given: Vec<bool> = self
            .slots
            .iter()
            .map(|slot| match slot.owner {
                Owner::Variable => given(slot.id),
                Owner::Rate(_) => true,
                Owner::Load(..) => false,
            })
            .collect();
        let needs: Vec<BTreeSet<usize>> = self
            .needs
            .iter()
            .zip(&given)
            .map(|(needs, is_given)| {
                let open = |k: &usize| !is_given && !given[*k];
                needs.iter().copied().filter(open).collect()
            })
            .collect();
        let none = vec![false; self.slots.len()];
        let mut rest = Vec::new();
        for block in order(&needs, &none, &none) {
            match block {
                Block::Direct(slot) if given[slot] => {}
                Block::Direct(slot) => rest.push(slot),
                Block::Loop { torn, .. } => {
                    let slot = &self.slots[torn.first().copied().unwrap_or_default()];
                    return Err(Error::Loop {
                        statement: StatementId::new(self.label(slot).0, slot.id),
                        iterations: 0,
                    });
                }
            }
        }
        Ok(Substitution {
            model: self,
            given,
            rest,
        })
    }
}

impl Substitution<'_> {
    /// The values of all expressions at a state with the given values; a VARIABLE without one is zero.
    ///
    /// # Errors
    /// [`Error::State`] for a state without one of the parts or DIFFs; [`Error::In`] for an expression without a
    /// finite value.
    pub fn at(&self, state: &ModelState, given: &GivenValues) -> Result<SubstitutedValues, Error> {
        let model = self.model;
        let mut on = model.evaluation::<f64>(state)?;
        self.fill(&mut on, given)?;
        let mut out = SubstitutedValues::default();
        for (k, slot) in model.slots.iter().enumerate() {
            let value = match slot.owner {
                Owner::Load(..) => continue,
                _ if self.given[k] => model.slot_value(k, &on)?,
                _ => on.at.values[k],
            };
            match slot.owner {
                Owner::Variable => out.variables.insert(slot.id, value),
                _ => out.differentials.insert(slot.id, value),
            };
        }
        for load in &model.loads {
            let [force, torque] = load.wrench(&on.at);
            let all = Load {
                components: load.components(&on.at),
                force: force.into(),
                torque: torque.into(),
            };
            out.loads.insert((load.kind.keyword(), load.id), all);
        }
        Ok(out)
    }

    /// Sets the values of all slots: given ones, and the others by their expressions.
    pub(super) fn fill<T: Scalar>(
        &self,
        on: &mut Evaluation<'_, T>,
        given: &GivenValues,
    ) -> Result<(), Error> {
        for (k, slot) in self
            .model
            .slots
            .iter()
            .enumerate()
            .filter(|(k, _)| self.given[*k])
        {
            let values = match slot.owner {
                Owner::Rate(_) => &given.rates,
                _ => &given.variables,
            };
            on.at.values[k] = T::constant(values.get(&slot.id).copied().unwrap_or(0.0));
        }
        for k in &self.rest {
            let value = self.model.slot_value(*k, on)?;
            on.at.values[*k] = value;
        }
        Ok(())
    }
}
