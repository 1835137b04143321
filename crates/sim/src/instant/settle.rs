//! Determination of the active contacts: the complementarity problem of one instant.

use crate::Error;
use crate::contact::active::ROUNDING;
use crate::contact::solver::{RIGID, Solver};
use crate::instant::rates::solve_rates_of;
use crate::mechanics::state::State;
use crate::numerics::complementarity::complementarity;

/// Finds the active elements at (t, q, v), and the forces.
///
/// Ropes are active where they would pull and stops where they would push. For the vertical contacts this is a
/// complementarity problem in the forces and the active set. It is solved by sweeps: the forces of the active
/// contacts are solved, and the contact with the largest pull is opened. If none pulls, the open contact with the
/// largest penetration that should push is closed. The solution is found if there is none either. Returns whether
/// this happened within a number of sweeps that grows with the number of contacts.
///
/// # Errors
/// Any error from evaluating the rails.
pub(crate) fn settle(solver: &mut Solver, at: &mut State) -> Result<bool, Error> {
    settle_within(solver, at, 0.0)
}

/// As [`settle`], where the forces may err by the `slack` relative to the largest, and the heights by as much.
///
/// # Errors
/// Any error from evaluating the rails.
pub(crate) fn settle_within(
    solver: &mut Solver,
    at: &mut State,
    slack: f64,
) -> Result<bool, Error> {
    let count = solver.system().verticals();
    solver.update(at)?;
    solver.settle_springs(at);
    guess_active(solver, at);
    for sweep in 0..4 * count + 8 {
        if sweep > 0 {
            // the forces, and with them the slopes of the rails, are others
            solver.update(at)?;
        }
        if !solver.instant_here(at, [slack; 2])? {
            return Ok(false);
        }
        let weakest = (0..count)
            .filter(|&i| solver.active().has(i) && solver.opens(i, at))
            .min_by(|&i, &j| at.force[i].total_cmp(&at.force[j]));
        if let Some(i) = weakest {
            solver.open(i, at);
            continue;
        }
        let deepest = (0..count)
            .filter(|&i| !solver.active().has(i) && solver.closing(i, at) > 0.0)
            .max_by(|&i, &j| at.p[i].total_cmp(&at.p[j]));
        let Some(i) = deepest else { return Ok(true) };
        solver.set_active(i, true);
        at.p_rate[i] = closing_rate(solver, i, at);
    }
    Ok(false)
}

/// Finds the active elements and the forces after a jump of the approach e, as at a step of the rail.
///
/// The penetrations p under dampers on compliant rails are continuous, and p + G F = e holds for those of the active
/// contacts. With e the forces jump, and wheels near to each other on a rail without mass may be thrown off it. Each
/// change of the active set changes the forces of all other contacts by amounts that are not small. Their rates of
/// penetration are therefore solved again for every set, other than in [`settle`], where contacts change without a
/// force. Returns whether a set was found.
///
/// # Errors
/// Any error from evaluating the rails.
pub(crate) fn settle_jump(solver: &mut Solver, at: &mut State) -> Result<bool, Error> {
    let count = solver.system().verticals();
    for _ in 0..4 * count + 8 {
        let is_felt = |i: &usize| {
            let point = solver.system().law(*i).at(at.p[*i], at.p_rate[*i]);
            solver.remembers(*i) && !solver.is_on_rigid_rail(*i) && point.by_rate > 0.0
        };
        let felt: Vec<usize> = (0..count).filter(is_felt).collect();
        if !solve_rates_of(solver, &felt, at)? {
            return Ok(false);
        }
        let weakest = felt
            .into_iter()
            .filter(|&i| solver.opens(i, at))
            .min_by(|&i, &j| at.force[i].total_cmp(&at.force[j]));
        let Some(i) = weakest else {
            return settle(solver, at);
        };
        solver.open(i, at);
    }
    Ok(false)
}

/// Largest number of solutions for the rates of penetration at the start of a run.
const ROUNDS: usize = 12;

/// Finds the active elements and the forces at the start of a run at (t, q, v), as the limit of the motion for t -> 0+.
/// A wheel on a rail with mass approaches its deflected rail from the start, and the force of a damper between them
/// contains this rate. The rates depend on the forces, and both are found in turn. A rail without mass keeps its
/// deflection for an instant, and the forces are those at rest. Returns whether a solution was found.
///
/// # Errors
/// Any error from evaluating the rails.
pub(crate) fn settle_start(solver: &mut Solver, at: &mut State) -> Result<bool, Error> {
    if !settle(solver, at)? {
        return Ok(false);
    }
    let scale = at
        .force
        .iter()
        .fold(0.0_f64, |max, force| max.max(force.abs()));
    let mut last = at.force.clone();
    for _ in 0..ROUNDS {
        if !solver.follow_rails(at) {
            return Ok(true);
        }
        at.is_between = true;
        let is_settled = settle(solver, at)?;
        at.is_between = false;
        if !is_settled {
            return Ok(false);
        }
        let change = last
            .iter()
            .zip(&at.force)
            .fold(0.0_f64, |max, (a, b)| max.max((a - b).abs()));
        if change <= 1e-13 * scale {
            break;
        }
        last.copy_from_slice(&at.force);
    }
    Ok(true)
}

/// Initial rate of penetration of a contact that closes. If the rail complies, penetration and force are continuous:
/// the force starts at zero, on the side where the contact presses. On a rigid rail the rate is that of the wheel.
fn closing_rate(solver: &Solver, i: usize, at: &State) -> f64 {
    let system = solver.system();
    let law = system.law(i);
    if solver.geometry().own_compliance(i) * law.stiffness > RIGID {
        let point = law.at(at.p[i], 0.0);
        if point.by_rate > 0.0 {
            (ROUNDING - 1.0) * point.force / point.by_rate
        } else {
            0.0
        }
    } else {
        solver.approach_rate(i, at)
    }
}

/// Estimates the active contacts from the complementarity problem (G + 1/k) F - e >= 0, F >= 0, if every law is
/// linear and undamped. The sweeps of [`settle`] start from its solution.
/// The geometry must belong to `at`.
fn guess_active(solver: &mut Solver, at: &State) {
    let system = solver.system();
    let (m, count) = (system.elements.len(), system.verticals());
    if !system.traits.has_linear_laws
        || !system.traits.is_symmetric
        || (0..count).any(|i| system.law(i).damping > 0.0 || system.law(i).bilateral)
    {
        return;
    }
    let share = |i: usize| solver.geometry().fraction(i);
    let felt: Vec<usize> = (0..count).filter(|&i| share(i) > 0.0).collect();
    let mut matrix: Vec<f64> = felt
        .iter()
        .flat_map(|&i| felt.iter().map(move |&j| i * m + j))
        .map(|at| solver.geometry().rails().value[at])
        .collect();
    let mut reach = vec![0.0; felt.len()];
    for (r, &i) in felt.iter().enumerate() {
        let per_wheel = system.law(i).stiffness * system.mechanics.groups[i].count() * share(i);
        matrix[r * felt.len() + r] += 1.0 / per_wheel;
        reach[r] = solver.geometry().approach(i, &at.q);
    }
    let mut force: Vec<f64> = felt.iter().map(|&i| at.force[i]).collect();
    if complementarity(&matrix, &reach, &mut force).is_some() {
        (0..count).for_each(|i| solver.set_active(i, false));
        for (&i, f) in felt.iter().zip(force) {
            solver.set_active(i, f > 0.0);
        }
    }
}
