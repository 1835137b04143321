//! The values of a model at a solved state.

use crate::kinematics::vector::Vector;
use crate::model::{AdamsModel, Evaluation, Owner};
use crate::{AdamsFault, Error, ModelState, StatementId, expression};
use nalgebra::Vector3;
use std::collections::{BTreeMap, BTreeSet};

/// The values that the expressions of a data set have at a state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SolvedModelState {
    /// The value VARVAL of every VARIABLE, by identifier.
    pub variables: BTreeMap<u32, f64>,
    /// The rate DIF1 of every DIFF, by identifier.
    pub rates: BTreeMap<u32, f64>,
    /// Every SFORCE, VFORCE, GFORCE and BEAM, by keyword and identifier.
    pub loads: BTreeMap<(&'static str, u32), Load>,
    /// The columns of every REQUEST with function expressions, by identifier; F1 to F8 are numbered 1 to 8.
    /// Reactions of joints are known at equilibrium only; at other states the columns that read them are left
    /// out.
    pub requests: BTreeMap<u32, BTreeMap<usize, f64>>,
    /// The identifiers of SPLINEs that were read beyond their values.
    pub extrapolated: BTreeSet<u32>,
    /// Newton iterations of all loops.
    pub iterations: usize,
    /// The values of all slots.
    pub(super) values: Vec<f64>,
    /// Force and torque on I of every constraint, in ground axes, where they are known.
    pub(super) reactions: Vec<Option<[Vector<f64>; 2]>>,
}

/// The force and torque of one statement, in the units of the data set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// FX to TZ as the expressions give them, in the axes of RM. An SFORCE has its value and zeros; a BEAM
    /// has its components in the axes of J.
    pub components: [f64; 6],
    /// Force on I, in ground axes. The opposite force acts on J, unless the load acts on I only.
    pub force: Vector3<f64>,
    /// Torque on I about I, in ground axes. The opposite torque acts on J about the same point.
    pub torque: Vector3<f64>,
}

impl AdamsModel {
    /// The solution, once the values of all slots are known.
    pub(super) fn report(
        &self,
        on: &Evaluation<'_, f64>,
        iterations: usize,
    ) -> Result<SolvedModelState, Error> {
        const COLUMNS: [&str; 8] = ["F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8"];
        let mut out = SolvedModelState {
            iterations,
            ..SolvedModelState::default()
        };
        for (k, (slot, value)) in self.slots.iter().zip(&on.at.values).enumerate() {
            // Every expression is evaluated once more, so that every table read beyond its values is
            // recorded.
            self.slot_value(k, on)?;
            match slot.owner {
                Owner::Variable => out.variables.insert(slot.id, *value),
                Owner::Rate(_) => out.rates.insert(slot.id, *value),
                Owner::Load(..) => None,
            };
        }
        for load in &self.loads {
            let [force, torque] = load.wrench(&on.at);
            let components = load.components(&on.at);
            let all = Load {
                components,
                force: force.into(),
                torque: torque.into(),
            };
            out.loads.insert((load.kind.keyword(), load.id), all);
        }
        for request in &self.requests {
            let mut columns = BTreeMap::new();
            for (column, formula) in &request.columns {
                match formula.value(on) {
                    Ok(value) => {
                        columns.insert(column + 1, value);
                    }
                    Err(AdamsFault::Reaction) => {}
                    Err(fault) => {
                        let statement = StatementId::new("REQUEST", request.id);
                        let fault = Box::new(fault);
                        return Err(Error::In {
                            statement,
                            argument: COLUMNS[*column],
                            offset: 0,
                            fault,
                        });
                    }
                }
            }
            out.requests.insert(request.id, columns);
        }
        let beyond = on.beyond.borrow();
        out.extrapolated = beyond
            .iter()
            .filter_map(|family| self.splines.get(*family))
            .copied()
            .collect();
        out.values.clone_from(&on.at.values);
        out.reactions.clone_from(&on.reactions);
        Ok(out)
    }

    /// The value of any expression, such as `GFORCE(17,0,3,49)`, at a state that has been solved.
    ///
    /// # Errors
    /// [`Error::In`] with the keyword REQUEST and identifier zero for text that is not an expression, for
    /// unknown names or identifiers, and for a value that is not finite.
    ///
    /// ```
    /// use adams::{DataSet, AdamsModel};
    ///
    /// let set = DataSet::read("a wheel\nPART/1,GROUND\nPART/2,QG=0,1.25,0\nMARKER/216,PART=2\nEND")?;
    /// let model = AdamsModel::new(&set)?;
    /// let state = model.initial();
    /// let solution = model.solve(&state)?;
    /// assert_eq!(model.evaluate(&state, &solution, "2*DY(216)")?, 2.5);
    /// # Ok::<(), adams::Error>(())
    /// ```
    pub fn evaluate(
        &self,
        state: &ModelState,
        solution: &SolvedModelState,
        text: &str,
    ) -> Result<f64, Error> {
        let refuse = |(offset, fault): (usize, AdamsFault)| Error::In {
            statement: StatementId::new("REQUEST", 0),
            argument: "F1",
            offset,
            fault: Box::new(fault),
        };
        let tree = expression::parse(text).map_err(refuse)?;
        let formula = self.compile(&tree).map_err(refuse)?;
        let mut on = self.evaluation::<f64>(state)?;
        on.at.values.clone_from(&solution.values);
        on.at.values.resize(self.slots.len(), 0.0);
        on.reactions.clone_from(&solution.reactions);
        formula.value(&on).map_err(|fault| refuse((0, fault)))
    }
}
