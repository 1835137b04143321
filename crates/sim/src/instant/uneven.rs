//! Corners and steps of uneven rails: changes of the state when a wheel passes one.
//!
//! At a step the approach e jumps. If the rail complies, the penetration under a damper between wheel and rail is
//! continuous and p + G F = e holds, so the force jumps through the rate of penetration. On a rigid rail the
//! penetration jumps with e, and the damper exerts the impulse c (Q(p1) - Q(p0)), where Q is the integral of its
//! ramp; the damper does not pull.

use crate::Error;
use crate::contact::solver::Solver;
use crate::instant::rates::solve_rates_of;
use crate::mechanics::state::State;
use crate::numerics::step::step_integral;

/// Assigns every wheel to the piece of its rail at (t, q). At a corner the direction is that of the speed v, else
/// that of the prescribed acceleration, else forwards.
pub(crate) fn locate_wheels(solver: &mut Solver, at: &State) -> Result<(), Error> {
    let system = solver.system();
    if !system.traits.is_uneven {
        return Ok(());
    }
    solver.update(at)?;
    for w in 0..system.mechanics.wheels.len() {
        let Some(shape) = system.mechanics.irregularity(w) else {
            continue;
        };
        let acceleration = solver.geometry().places().travel[system
            .mechanics
            .kinematics
            .root(system.mechanics.wheels[w].body)]
        .a;
        let speed = system.mechanics.speed_along(w, at);
        let direction = [speed, acceleration]
            .into_iter()
            .find(|d| *d != 0.0)
            .unwrap_or(1.0);
        let piece = shape.piece(solver.geometry().places().x[w], direction, 0);
        solver.set_piece(w, piece);
    }
    Ok(())
}

/// Moves wheels that have reached the end of their piece to the next piece; returns whether any wheel has.
pub(crate) fn pass_corners(solver: &mut Solver, at: &mut State) -> Result<bool, Error> {
    let system = solver.system();
    let mut jump = vec![0.0; system.verticals()];
    let mut crosses = false;
    for w in 0..system.mechanics.wheels.len() {
        let Some(shape) = system.mechanics.irregularity(w) else {
            continue;
        };
        let places = solver.geometry().places();
        let (x, current) = (
            places.of_wheel(&system.mechanics, w, &at.q),
            places.piece[w],
        );
        let next = shape.piece(x, system.mechanics.speed_along(w, at), current);
        if next == current {
            continue;
        }
        crosses = true;
        solver.set_piece(w, next);
        for i in system.mechanics.groups_of(w) {
            jump[i] += (shape.vertical(next, x)[0] - shape.vertical(current, x)[0])
                / system.mechanics.groups[i].count();
        }
    }
    if crosses {
        solver.update(at)?;
        strike(solver, &jump, at);
        let felt: Vec<usize> = (0..system.verticals())
            .filter(|&i| solver.remembers(i) && !solver.is_on_rigid_rail(i))
            .collect();
        // Only the rates are affected, so an approximate result is sufficient and the return value is not checked.
        solve_rates_of(solver, &felt, at)?;
    }
    Ok(crosses)
}

/// Applies penetrations, impulses and rates of dampers on rigid rails whose approach has jumped.
fn strike(solver: &Solver, jump: &[f64], at: &mut State) {
    let system = solver.system();
    let mut response = vec![0.0; system.mechanics.dofs];
    for (i, _) in jump.iter().enumerate().filter(|(_, jump)| **jump != 0.0) {
        if !is_rigid(solver, i) {
            continue;
        }
        let law = system.law(i);
        let (from, to) = (at.p[i], solver.geometry().approach(i, &at.q));
        at.p[i] = to;
        let grown = if law.bilateral {
            step_integral(law.depth, to) - step_integral(law.depth, from)
        } else {
            (step_integral(law.depth, to.max(0.0)) - step_integral(law.depth, from.max(0.0)))
                .max(0.0)
        };
        let impulse = system.mechanics.groups[i].count()
            * solver.geometry().fraction(i)
            * law.damping
            * grown;
        solver.apply_inverse(solver.geometry().rows().force_row(i), &mut response);
        at.v.iter_mut()
            .zip(&response)
            .for_each(|(v, by)| *v -= by * impulse);
    }
    follow_rigid_rails(solver, at);
}

/// Sets the rates of penetration under dampers on rigid rails to those of the approach.
pub(crate) fn follow_rigid_rails(solver: &Solver, at: &mut State) {
    for i in (0..solver.system().verticals()).filter(|&i| is_rigid(solver, i)) {
        at.p_rate[i] = solver.approach_rate(i, at);
    }
}

fn is_rigid(solver: &Solver, i: usize) -> bool {
    solver.system().law(i).has_memory() && solver.is_on_rigid_rail(i)
}
