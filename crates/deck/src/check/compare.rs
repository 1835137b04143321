//! Comparison of the components of every GFORCE of the deck with those of the simulator.

use adams::{AdamsModel, ArgumentValue, DataSet, ModelState, SolvedModelState, StatementArgument};
use nalgebra::DMatrix;
use sim::Foundation;
use splines::{Axis, Influence, Probe};

use super::states::CheckCase;
use super::step;
use crate::Error;
use crate::words::ids::{VariableSlot, number, variable};
use crate::{DeckForm, DeckPlan};

/// Components of a wheel's force, in the order of GFORCE.
pub const COMPONENTS: [&str; 6] = ["FX", "FY", "FZ", "TX", "TY", "TZ"];

/// Differences of forces over many states.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckDifference {
    /// Description of the comparison.
    pub what: &'static str,
    /// Number of states.
    pub states: usize,
    /// Limit of the difference, relative to the largest force of all states (moments are divided by the radius of the
    /// largest wheel); `None` if the difference is reported without a limit.
    pub limit: Option<f64>,
    /// Largest difference of each component, relative to the same force.
    pub worst: [f64; 6],
    /// Largest force of all states.
    pub largest: f64,
    /// Number of states at which the deck could not be solved, with the error at the first of them.
    pub failed: Option<(String, usize)>,
}

impl CheckDifference {
    /// Largest of the components.
    #[must_use]
    pub fn largest_of_all(&self) -> f64 {
        self.worst.iter().fold(0.0, |most, value| most.max(*value))
    }

    /// Whether the difference is within its limit and the deck was solved at every state.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.limit
            .is_none_or(|asked| self.failed.is_none() && self.largest_of_all() <= asked)
    }
}

/// Expected forces of the deck at one state, computed by the simulator.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpectedForces {
    /// GFORCE of each wheel: components on the wheel, in the frame of its rail.
    pub forces: Vec<[f64; 6]>,
    /// Values of VARIABLEs by identifier, used as a first guess where the initial values of the deck do not lead to a
    /// solution.
    pub variables: Vec<(u32, f64)>,
}

/// The expected forces of the deck at `case`.
///
/// Contact forces are those of the simulator. Displacements of rails, and the forces F du/dx along them, are computed
/// from values and derivatives of the tables.
///
/// # Errors
/// [`Error::Compliance`] for a wheel beyond its rail.
pub fn expected_forces(
    plan: &DeckPlan<'_>,
    foundations: &[Foundation],
    case: &CheckCase,
) -> Result<ExpectedForces, Error> {
    let forces = &case.forces;
    let (mut out, mut variables) = (Vec::with_capacity(plan.wheels.len()), Vec::new());
    for (w, wheel) in plan.wheels.iter().enumerate() {
        let penetration = forces.penetration[wheel.contact];
        let arm = plan.kind(w).radius - penetration;
        let (down, side, along) = (forces.vertical[w], forces.lateral[w], forces.traction[w]);
        out.push([-along, down, -side, arm * side, 0.0, -arm * along]);
        variables.push((variable(w, VariableSlot::Penetration), penetration));
        variables.push((variable(w, VariableSlot::Press), down));
        variables.push((variable(w, VariableSlot::Flange), side));
        variables.push((variable(w, VariableSlot::Traction), along));
        if let Some(id) = plan.contacts[wheel.contact].diff {
            variables.push((step::variable(id), penetration));
        }
    }
    for (s, foundation) in foundations.iter().enumerate() {
        let Some(compliance) = &foundation.compliance else {
            continue;
        };
        let (mut probes, mut loads) = (Vec::new(), Vec::new());
        for (w, wheel) in plan
            .wheels
            .iter()
            .enumerate()
            .filter(|(_, wheel)| wheel.structure == s)
        {
            let x = position(case, wheel.body, wheel.hub);
            let mut add = |axis: Axis, load: f64, slot: VariableSlot| {
                probes.push(Probe {
                    rail: wheel.rail,
                    x,
                    axis,
                });
                loads.push((w, load, slot));
            };
            add(Axis::Vertical, -forces.vertical[w], VariableSlot::Rise);
            if plan.kind(w).flange.is_some() {
                add(Axis::Lateral, forces.lateral[w], VariableSlot::Shift);
            }
        }
        let mut influence = Influence::zeros(probes.len());
        compliance.fill(&probes, &mut influence)?;
        for (i, &(w, own, slot)) in loads.iter().enumerate() {
            let of = |matrix: &DMatrix<f64>| -> f64 {
                loads
                    .iter()
                    .enumerate()
                    .map(|(j, (_, load, _))| matrix[(i, j)] * load)
                    .sum()
            };
            let moved = of(&influence.value);
            variables.push((variable(w, slot), moved));
            if slot == VariableSlot::Shift {
                variables.push((
                    variable(w, VariableSlot::Sideways),
                    side(plan, case, w) - moved,
                ));
            }
            if plan.form == DeckForm::Factored {
                out[w][0] += own * of(&influence.slope);
            }
        }
    }
    Ok(ExpectedForces {
        forces: out,
        variables,
    })
}

/// Rail coordinate of a wheel.
fn position(case: &CheckCase, body: usize, hub: [f64; 3]) -> f64 {
    let [x, _, _, _, yaw, pitch] = case.instant.displacement[body];
    x + hub[0] + yaw * hub[2] - pitch * hub[1]
}

/// Lateral displacement of a wheel at its contact with the rail.
fn side(plan: &DeckPlan<'_>, case: &CheckCase, w: usize) -> f64 {
    let wheel = &plan.wheels[w];
    let [_, _, z, roll, yaw, _] = case.instant.displacement[wheel.body];
    let arm = plan.kind(w).radius - case.forces.penetration[wheel.contact];
    z + roll * (wheel.hub[1] - arm) - yaw * wheel.hub[0]
}

/// Solves the data set at `state` from its own initial values or, if that fails, from the values of the simulator.
///
/// The initial values affect only the convergence of Newton's method and not the equations, so that a wrong deck
/// still has a different solution.
fn solve(
    set: &DataSet,
    model: &AdamsModel,
    state: &ModelState,
    expected: &ExpectedForces,
) -> Result<SolvedModelState, adams::Error> {
    model.solve(state).or_else(|error| {
        let mut set = set.clone();
        for statement in set
            .statements
            .iter_mut()
            .filter(|one| one.keyword == "VARIABLE")
        {
            let known = expected
                .variables
                .iter()
                .find(|(id, _)| statement.id == Some(*id));
            let Some((_, value)) = known else { continue };
            statement.arguments.retain(|argument| argument.name != "IC");
            let argument = StatementArgument {
                name: "IC".to_owned(),
                value: ArgumentValue::Numbers(vec![*value]),
            };
            statement.arguments.push(argument);
        }
        AdamsModel::new(&set)
            .and_then(|model| model.solve(state))
            .map_err(|_| error)
    })
}

/// Compares the forces of the data set at `states` with the expected ones.
///
/// # Errors
/// A data set that cannot be executed.
pub fn compare(
    plan: &DeckPlan<'_>,
    set: &DataSet,
    (what, asked): (&'static str, Option<f64>),
    expected: &[ExpectedForces],
    states: impl Iterator<Item = ModelState>,
) -> Result<CheckDifference, Error> {
    let model = AdamsModel::new(set)?;
    let mut out = CheckDifference {
        what,
        states: 0,
        limit: asked,
        worst: [0.0; 6],
        largest: 0.0,
        failed: None,
    };
    let radius = (0..plan.wheels.len())
        .map(|w| plan.kind(w).radius)
        .fold(f64::MIN_POSITIVE, f64::max);
    let scaled = |k: usize, value: f64| if k < 3 { value } else { value / radius };
    for (state, expected) in states.zip(expected) {
        out.states += 1;
        let solution = match solve(set, &model, &state, expected) {
            Ok(solution) => solution,
            Err(error) => {
                let (_, count) = out.failed.get_or_insert_with(|| (error.to_string(), 0));
                *count += 1;
                continue;
            }
        };
        for (w, expected) in expected.forces.iter().enumerate() {
            let found = solution
                .loads
                .get(&("GFORCE", number(w)))
                .map(|load| load.components);
            for (k, expected) in expected.iter().enumerate() {
                let found = found.map_or(f64::MAX, |components| components[k]);
                out.worst[k] = out.worst[k].max(scaled(k, (found - expected).abs()));
                out.largest = out.largest.max(scaled(k, expected.abs()));
            }
        }
    }
    let scale = out.largest.max(f64::MIN_POSITIVE);
    out.worst = out.worst.map(|worst| worst / scale);
    Ok(out)
}
