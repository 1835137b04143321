//! Forces at a given state.

use crate::code::View;
use crate::frame::Frame;
use crate::model::{Block, Marker, Model, Owner, Slot};
use crate::newton;
use crate::space::Vector;
use crate::{Dual, Error, Fault, Scalar, State, expression};
use nalgebra::{DMatrix, Vector3};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

/// What a data set's expressions give at a state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solution {
    /// VARVAL of every VARIABLE.
    pub variables: BTreeMap<u32, f64>,
    /// DIF1 of every DIFF.
    pub rates: BTreeMap<u32, f64>,
    /// Every SFORCE, VFORCE, GFORCE and BEAM, by keyword and identifier.
    pub loads: BTreeMap<(&'static str, u32), Load>,
    /// Columns of every REQUEST with function expressions, F1 as 1 to F8 as 8. Reactions of joints are known
    /// at equilibrium alone; elsewhere such columns are left out.
    pub requests: BTreeMap<u32, BTreeMap<usize, f64>>,
    /// SPLINEs that were read beyond their values.
    pub beyond: BTreeSet<u32>,
    /// Newton iterations of all loops.
    pub iterations: usize,
    pub(crate) values: Vec<f64>,
    pub(crate) reactions: Vec<Option<[Vector<f64>; 2]>>,
}

/// The force and torque of one statement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// FX to TZ as the expressions give them, along the axes of RM; of an SFORCE its value and zeros; of a BEAM
    /// along the axes of J.
    pub components: [f64; 6],
    /// Force on I, along ground axes. J has the opposite, unless it acts on I alone.
    pub force: Vector3<f64>,
    /// Torque on I about I, along ground axes. J has the opposite about the same place.
    pub torque: Vector3<f64>,
}

impl Model {
    /// VARIABLEs, forces and rates at a state.
    ///
    /// Expressions are evaluated in the order of what they need. Those that need each other are solved by
    /// Newton's method with exact derivatives and step halving, from the IC of VARIABLEs, until corrections are
    /// rounding: about 1e-15 of each VARIABLE. An implicit DIFF is solved for DIF1; where its expression does
    /// not contain DIF1 but holds, DIF1 stays at its initial value.
    ///
    /// # Errors
    /// [`Error::State`] for a state without one of the parts or DIFFs; [`Error::In`] for an expression that
    /// has no finite value; [`Error::Loop`] where no solution is found.
    pub fn solve(&self, state: &State) -> Result<Solution, Error> {
        let mut view = self.view::<f64>(state, 4.0)?;
        view.values = self.slots.iter().map(|slot| slot.guess).collect();
        let mut dual: Option<View<'_, Dual>> = None;
        let mut iterations = 0;
        for block in &self.order {
            match block {
                Block::Direct(slot) => {
                    let value = self.slot_value(*slot, &view)?;
                    view.values[*slot] = value;
                }
                Block::Loop { torn, rest } => {
                    let mut other = match dual.take() {
                        Some(dual) => dual,
                        None => self.view::<Dual>(state, 4.0)?,
                    };
                    other.values = view.values.iter().map(|value| Dual::constant(*value)).collect();
                    iterations += self.close(&mut view, &mut other, torn, rest)?;
                    dual = Some(other);
                }
            }
        }
        view.beyond.borrow_mut().clear();
        self.report(&view, iterations)
    }

    /// Solves one loop.
    fn close(
        &self,
        view: &mut View<'_, f64>,
        dual: &mut View<'_, Dual>,
        torn: &[usize],
        rest: &[usize],
    ) -> Result<usize, Error> {
        let count = torn.len();
        let start: Vec<f64> = torn.iter().map(|slot| view.values[*slot]).collect();
        let slope = |x: &[f64]| {
            for (k, (slot, x)) in torn.iter().zip(x).enumerate() {
                dual.values[*slot] = Dual::unknown(*x, k, count);
            }
            let all = self.residuals(dual, torn, rest)?;
            let matrix = DMatrix::from_fn(count, count, |i, j| all[i].slope(j));
            Ok((all.iter().map(Scalar::value).collect(), matrix))
        };
        let value = |x: &[f64]| {
            for (slot, x) in torn.iter().zip(x) {
                view.values[*slot] = *x;
            }
            self.residuals(view, torn, rest)
        };
        let flows: Vec<bool> = torn.iter().map(|slot| !self.slots[*slot].implicit).collect();
        match newton::solve(start, &flows, slope, value)? {
            Ok((x, iterations)) => {
                for (slot, x) in torn.iter().zip(&x) {
                    view.values[*slot] = *x;
                }
                for slot in rest {
                    let found = self.slot_value(*slot, view)?;
                    view.values[*slot] = found;
                }
                Ok(iterations)
            }
            Err(stuck) => {
                let slot = &self.slots[torn[stuck.worst.min(count - 1)]];
                let keyword = self.label(slot).0.to_owned();
                Err(Error::Loop { keyword, id: slot.id, iterations: stuck.iterations })
            }
        }
    }

    /// What a loop's torn values are off by.
    pub(crate) fn residuals<T: Scalar>(
        &self,
        view: &mut View<'_, T>,
        torn: &[usize],
        rest: &[usize],
    ) -> Result<Vec<T>, Error> {
        for slot in rest {
            let value = self.slot_value(*slot, view)?;
            view.values[*slot] = value;
        }
        let off = |slot: &usize| {
            let value = self.slot_value(*slot, view)?;
            Ok(if self.slots[*slot].implicit { value } else { view.values[*slot].minus(&value) })
        };
        torn.iter().map(off).collect()
    }

    pub(crate) fn slot_value<T: Scalar>(&self, slot: usize, view: &View<'_, T>) -> Result<T, Error> {
        let slot = &self.slots[slot];
        slot.code.value(view).map_err(|fault| self.broken(slot, fault))
    }

    fn broken(&self, slot: &Slot, fault: Fault) -> Error {
        let (keyword, argument) = self.label(slot);
        Error::In {
            keyword: keyword.to_owned(),
            id: slot.id,
            argument: argument.to_owned(),
            offset: 0,
            fault: Box::new(fault),
        }
    }

    /// Everything that expressions read, values still at zero.
    pub(crate) fn view<T: Scalar>(&self, state: &State, mode: f64) -> Result<View<'_, T>, Error> {
        let mut frames: Vec<Frame<T>> = Vec::with_capacity(self.parts.len());
        for part in &self.parts {
            frames.push(if part.ground {
                Frame::ground()
            } else {
                let pose = state.parts.get(&part.id);
                let pose = pose.ok_or_else(|| Error::State { keyword: "PART".to_owned(), id: part.id })?;
                Frame::of(pose)
            });
        }
        let mut differentials = Vec::with_capacity(self.diffs.len());
        for diff in &self.diffs {
            let value = state.differentials.get(&diff.id);
            let value = value.ok_or_else(|| Error::State { keyword: "DIFF".to_owned(), id: diff.id })?;
            differentials.push(T::constant(*value));
        }
        Ok(self.view_of(&frames, state.time, mode, differentials))
    }

    pub(crate) fn view_of<T: Scalar>(
        &self,
        parts: &[Frame<T>],
        time: f64,
        mode: f64,
        differentials: Vec<T>,
    ) -> View<'_, T> {
        let fixed = |marker: &Marker| parts[marker.part].marker(marker.position, marker.axes);
        let place = |marker: &Marker| match marker.follows.and_then(|k| self.markers.get(k)) {
            Some(leader) if marker.floating => parts[marker.part].carried(&fixed(leader).origin),
            _ => fixed(marker),
        };
        View {
            model: self,
            time,
            mode,
            frames: self.markers.iter().map(place).collect(),
            ground: Frame::ground(),
            values: vec![T::constant(0.0); self.slots.len()],
            differentials,
            reactions: vec![None; self.constraints.len()],
            beyond: RefCell::new(BTreeSet::new()),
        }
    }

    /// Values to a solution, once all slots are known.
    pub(crate) fn report(&self, view: &View<'_, f64>, iterations: usize) -> Result<Solution, Error> {
        let mut out = Solution { iterations, ..Solution::default() };
        for (slot, value) in self.slots.iter().zip(&view.values) {
            // Read once more, so that every table read beyond its values is noted.
            slot.code.value(view).map_err(|fault| self.broken(slot, fault))?;
            match slot.owner {
                Owner::Variable => out.variables.insert(slot.id, *value),
                Owner::Rate(_) => out.rates.insert(slot.id, *value),
                Owner::Load(..) => None,
            };
        }
        for load in &self.loads {
            let [force, torque] = load.wrench(view);
            let components = load.components(view);
            let all = Load { components, force: force.into(), torque: torque.into() };
            out.loads.insert((load.kind.keyword(), load.id), all);
        }
        for request in &self.requests {
            let mut columns = BTreeMap::new();
            for (column, code) in &request.columns {
                match code.value(view) {
                    Ok(value) => {
                        columns.insert(column + 1, value);
                    }
                    Err(Fault::Reaction) => {}
                    Err(fault) => {
                        return Err(Error::In {
                            keyword: "REQUEST".to_owned(),
                            id: request.id,
                            argument: format!("F{}", column + 1),
                            offset: 0,
                            fault: Box::new(fault),
                        });
                    }
                }
            }
            out.requests.insert(request.id, columns);
        }
        let beyond = view.beyond.borrow();
        out.beyond = beyond.iter().filter_map(|family| self.splines.get(*family)).copied().collect();
        out.values.clone_from(&view.values);
        out.reactions.clone_from(&view.reactions);
        Ok(out)
    }

    /// Any expression of the data set's language at a state that has been solved, such as `GFORCE(17,0,3,49)`.
    ///
    /// # Errors
    /// [`Error::In`] with the keyword REQUEST and identifier zero: text that is no expression, names or
    /// identifiers that are not there, no finite value.
    pub fn evaluate(&self, state: &State, solution: &Solution, text: &str) -> Result<f64, Error> {
        let refuse = |(offset, fault): (usize, Fault)| Error::In {
            keyword: "REQUEST".to_owned(),
            id: 0,
            argument: "F1".to_owned(),
            offset,
            fault: Box::new(fault),
        };
        let tree = expression::parse(text).map_err(refuse)?;
        let code = self.compiled(&tree).map_err(refuse)?;
        let mut view = self.view::<f64>(state, 4.0)?;
        view.values.clone_from(&solution.values);
        view.values.resize(self.slots.len(), 0.0);
        view.reactions.clone_from(&solution.reactions);
        code.value(&view).map_err(|fault| refuse((0, fault)))
    }
}
