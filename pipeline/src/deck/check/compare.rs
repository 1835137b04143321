//! Components of every GFORCE against the simulator's.

use adams::{Model, Solution, State};
use sim::Foundation;
use splines::{Axis, Influence, Probe};

use super::states::Case;
use crate::deck::ids::{Slot, number, variable};
use crate::deck::{Form, Plan};
use crate::exit::Failure;

/// Components of a wheel's force, in the order of GFORCE.
pub const COMPONENTS: [&str; 6] = ["FX", "FY", "FZ", "TX", "TY", "TZ"];

/// Differences over many states.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// What was compared.
    pub what: &'static str,
    /// States.
    pub states: usize,
    /// Largest difference asked for, of the largest force of all states (moments by the largest wheel's radius);
    /// `None`: it is told, not judged.
    pub asked: Option<f64>,
    /// Largest difference of each component, of the same.
    pub worst: [f64; 6],
    /// Largest force of all states.
    pub largest: f64,
    /// Why the deck gave no forces, the first of such states; the number of them.
    pub failed: Option<(String, usize)>,
}

impl Difference {
    /// Largest of the components.
    #[must_use]
    pub fn largest_of_all(&self) -> f64 {
        self.worst.iter().fold(0.0, |most, value| most.max(*value))
    }

    /// Whether it is as small as asked, with forces at every state.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.asked.is_none_or(|asked| self.failed.is_none() && self.largest_of_all() <= asked)
    }
}

/// What the simulator has each wheel's GFORCE be: on the wheel, in the frame of its rail.
///
/// The force along the rail from its slope is that of the tables' own derivative.
///
/// # Errors
/// What the tables refuse.
pub fn expected(plan: &Plan<'_>, foundations: &[Foundation], case: &Case) -> Result<Vec<[f64; 6]>, Failure> {
    let forces = &case.forces;
    let mut out = Vec::with_capacity(plan.wheels.len());
    for (w, wheel) in plan.wheels.iter().enumerate() {
        let arm = plan.kind(w).radius - forces.penetration[wheel.contact];
        let (down, side, along) = (forces.vertical[w], forces.lateral[w], forces.traction[w]);
        out.push([-along, down, -side, arm * side, 0.0, -arm * along]);
    }
    if plan.form == Form::Factored {
        for (s, foundation) in foundations.iter().enumerate() {
            let Some(compliance) = &foundation.compliance else { continue };
            let (mut probes, mut loads) = (Vec::new(), Vec::new());
            for (w, wheel) in plan.wheels.iter().enumerate().filter(|(_, wheel)| wheel.structure == s) {
                let x = place(case, wheel.body, wheel.hub);
                let mut add = |axis: Axis, load: f64| {
                    probes.push(Probe { rail: wheel.rail, x, axis });
                    loads.push((w, load));
                };
                add(Axis::Vertical, -forces.vertical[w]);
                if plan.kind(w).flange.is_some() {
                    add(Axis::Lateral, forces.lateral[w]);
                }
            }
            let mut influence = Influence::zeros(probes.len());
            compliance.fill(&probes, &mut influence).map_err(Failure::untrusted)?;
            for (i, &(w, own)) in loads.iter().enumerate() {
                let slope: f64 =
                    loads.iter().enumerate().map(|(j, (_, load))| influence.slope[(i, j)] * load).sum();
                out[w][0] += own * slope;
            }
        }
    }
    Ok(out)
}

/// Rail coordinate of a wheel.
fn place(case: &Case, body: usize, hub: [f64; 3]) -> f64 {
    let [x, _, _, _, yaw, pitch] = case.instant.displacement[body];
    x + hub[0] + yaw * hub[2] - pitch * hub[1]
}

/// Solutions of earlier states from which loops are tried again.
const EARLIER: usize = 12;

/// Solves the deck at `state` from the initial values it gives; where that fails from earlier solutions, as an
/// integrator's steps start from the step before.
fn solve(model: &Model, state: &State, earlier: &[Solution]) -> Result<Solution, adams::Error> {
    model.solve(state).or_else(|error| {
        earlier.iter().rev().find_map(|guess| model.solve_from(state, guess).ok()).ok_or(error)
    })
}

/// Compares the deck's forces at `states` with the `expected` ones.
pub fn compare(
    plan: &Plan<'_>,
    model: &Model,
    what: &'static str,
    asked: Option<f64>,
    expected: &[Vec<[f64; 6]>],
    states: impl Iterator<Item = State>,
) -> Difference {
    let mut out = Difference { what, states: 0, asked, worst: [0.0; 6], largest: 0.0, failed: None };
    let radius = (0..plan.wheels.len()).map(|w| plan.kind(w).radius).fold(f64::MIN_POSITIVE, f64::max);
    let scaled = |k: usize, value: f64| if k < 3 { value } else { value / radius };
    let mut earlier: Vec<Solution> = Vec::new();
    for (state, wanted) in states.zip(expected) {
        out.states += 1;
        let solution = match solve(model, &state, &earlier) {
            Ok(solution) => solution,
            Err(error) => {
                let (_, count) = out.failed.get_or_insert_with(|| (error.to_string(), 0));
                *count += 1;
                continue;
            }
        };
        for (w, wanted) in wanted.iter().enumerate() {
            let found = solution.loads.get(&("GFORCE", number(w))).map(|load| load.components);
            for (k, wanted) in wanted.iter().enumerate() {
                let found = found.map_or(f64::MAX, |components| components[k]);
                out.worst[k] = out.worst[k].max(scaled(k, (found - wanted).abs()));
                out.largest = out.largest.max(scaled(k, wanted.abs()));
            }
        }
        if earlier.len() < EARLIER {
            earlier.push(solution);
        }
    }
    let scale = out.largest.max(f64::MIN_POSITIVE);
    out.worst = out.worst.map(|worst| worst / scale);
    out
}
