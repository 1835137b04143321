//! Static equilibrium of bodies without wheels that carry them: below their ropes or on their floors.

use nalgebra::DVector;

use crate::Error;
use crate::contact::solver::Solver;
use crate::instant::balance::{pressing, pull_of_springs, quadratic};
use crate::instant::equilibrium::{balance_wheels, balancing, has_settled};
use crate::instant::springs::{followed, hanging, regular, stiffness};
use crate::mechanics::point::Point;
use crate::mechanics::state::State;

/// Largest number of Newton iterations, and of alternations between hanging bodies and bodies on rails.
const ITERATIONS: usize = 200;
const SWEEPS: usize = 100;
/// Slope of the energy at the end of a step, relative to that at its beginning, at which it is least there, and the number of
/// times that the interval with the least energy is halved.
const SHALLOW: f64 = 0.1;
const HALVINGS: usize = 60;

/// Moves all bodies and structures to static equilibrium at `at.t`. Bodies on rails are balanced by
/// [`balance_wheels`], with the stiffness of ropes and stops by which hanging bodies hold them, and hanging bodies are moved
/// to the minimum of their potential energy, in alternation, until the tensions and the displacements no longer change.
/// Where ropes become slack or stops are met on the way to the balance, the bodies go only as far as the energy falls
/// ([`least_energy`]).
///
/// # Errors
/// [`Error::NoEquilibrium`] if the tensions do not converge, and any error of [`balance_wheels`].
pub(crate) fn equilibrate(solver: &mut Solver, at: &mut State) -> Result<(), Error> {
    let system = solver.system();
    if system.springs().is_empty() {
        return balance_wheels(solver, at);
    }
    let hanging = hanging(system);
    let mut before = vec![f64::INFINITY; system.springs().len()];
    let mut places = at.q.clone();
    at.v.fill(0.0);
    let mut is_whole = true;
    for sweep in 0..SWEEPS {
        // The carriers have moved, and a slack rope would not show where its load hangs, so the loads are placed
        // again.
        place_below_ropes(solver, at)?;
        rest_hanging(solver, &hanging, at)?;
        let tensions: Vec<f64> = system.springs().iter().map(|&i| at.force[i]).collect();
        let scale = tensions
            .iter()
            .fold(weight(solver), |max, force| max.max(force.abs()));
        let pairs = tensions.iter().zip(&before);
        let moved = pairs.fold(0.0_f64, |max, (now, then)| max.max((now - then).abs()));
        // A stiff stop holds its force no better than the positions are rounded from which it is found. The tension of a
        // rope does not change to first order when the rope inclines, so the displacements are checked as well.
        let local = solver.geometry().local();
        let noise = system
            .springs()
            .iter()
            .fold(0.0_f64, |most, &i| most.max(local[i].spring.noise));
        if is_whole && moved <= (1e-12 * scale).max(noise) && has_settled(&places, at) {
            return Ok(());
        }
        before.copy_from_slice(&tensions);
        places.copy_from(&at.q);
        let start = at.clone();
        balance_wheels(solver, at)?;
        // No forces of wheels belong to the first positions.
        is_whole =
            sweep == 0 || has_settled(&start.q, at) || least_energy(solver, &hanging, &start, at)?;
    }
    Err(Error::NoEquilibrium {
        time: at.t,
        fall: None,
    })
}

/// Ends the step from `start` to the balance `at` where the potential energy is least along it, with hanging bodies at rest
/// all along; returns whether that is the whole step.
///
/// With the change dq of the degrees of freedom, the forces c of the wheels on them and the pull s of ropes and stops, of
/// which the balance takes s(0) - K dq for s(1), the slope of the energy at part x of the step is
///
/// dq . ((1 - x) (c(0) - c(1)) + s(0) - K dq - s(x)),
///
/// where no wheel gains or loses contact. It increases with x.
fn least_energy(
    solver: &mut Solver,
    hanging: &[usize],
    start: &State,
    at: &mut State,
) -> Result<bool, Error> {
    solver.update(start)?;
    let moving = balancing(solver);
    let change: Vec<f64> = moving.iter().map(|&k| at.q[k] - start.q[k]).collect();
    let by_springs = followed(solver, &moving, start);
    let pull = |solver: &Solver, state: &State| -> f64 {
        let pairs = moving.iter().zip(&change);
        pairs
            .map(|(&k, change)| change * pull_of_springs(solver, k, state))
            .sum()
    };
    let stretched = quadratic(&by_springs, &change);
    let expected = pull(solver, start) - stretched;
    let pressed: f64 = pressing(solver.system())
        .into_iter()
        .map(|i| {
            let row = solver.geometry().rows().approach_row(i);
            let approach: f64 = moving.iter().zip(&change).map(|(&k, d)| row[k] * d).sum();
            approach * (start.force[i] - at.force[i])
        })
        .sum();
    let to = at.clone();
    let mut slope = |x: f64, at: &mut State| -> Result<f64, Error> {
        at.q = start.q.lerp(&to.q, x);
        for (own, (from, to)) in at.force.iter_mut().zip(start.force.iter().zip(&to.force)) {
            *own = from + x * (to - from);
        }
        place_below_ropes(solver, at)?;
        rest_hanging(solver, hanging, at)?;
        Ok((1.0 - x) * pressed + expected - pull(solver, at))
    };
    let flat = SHALLOW * (pressed - stretched).abs();
    if slope(1.0, at)? <= flat {
        at.copy_from(&to);
        return Ok(true);
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        let own = slope(middle, at)?;
        if own.abs() <= flat {
            break;
        }
        if own < 0.0 {
            low = middle
        } else {
            high = middle
        }
    }
    Ok(false)
}

fn weight(solver: &Solver) -> f64 {
    solver.system().mechanics.gravity.amax()
}

/// Newton's method with step halving on the potential of the `hanging` degrees of freedom, which is convex; sets the
/// forces of ropes and stops.
fn rest_hanging(solver: &mut Solver, hanging: &[usize], at: &mut State) -> Result<(), Error> {
    let mut potential = springs_at(solver, hanging, at)?;
    for _ in 0..ITERATIONS {
        let Some(step) = descent(solver, hanging, at) else {
            break;
        };
        let start = at.q.clone();
        let mut share = 1.0;
        loop {
            for (&number, d) in hanging.iter().zip(step.iter()) {
                at.q[number] = start[number] + share * d;
            }
            let now = springs_at(solver, hanging, at)?;
            if now <= potential || share < 1e-6 {
                potential = now;
                break;
            }
            share *= 0.5;
        }
        let size = hanging
            .iter()
            .fold(1.0_f64, |max, &k| max.max(at.q[k].abs()));
        if share * step.amax() <= 1e-15 * size {
            break;
        }
    }
    solver.settle_springs(at);
    Ok(())
}

/// Potential energy of weights, loads, ropes and stops at `at`; sets the forces of ropes and stops.
fn springs_at(solver: &mut Solver, hanging: &[usize], at: &mut State) -> Result<f64, Error> {
    let system = solver.system();
    solver.update(at)?;
    let mut potential = -hanging
        .iter()
        .map(|&k| static_load(solver, k, at.t) * at.q[k])
        .sum::<f64>();
    for &i in system.springs() {
        let hold = &solver.geometry().local()[i].spring;
        let p = solver.geometry().approach(i, &at.q).max(0.0);
        at.force[i] = hold.stiffness * p;
        potential += 0.5 * hold.stiffness * p * p;
    }
    Ok(potential)
}

fn static_load(solver: &Solver, number: usize, t: f64) -> f64 {
    let system = solver.system();
    let loads = system
        .scene
        .actuators
        .loads
        .iter()
        .filter(|load| system.mechanics.loaded(load) == Some(number));
    system.mechanics.gravity[number] + loads.map(|load| load.value.at(t)).sum::<f64>()
}

/// Newton step of the `hanging` degrees of freedom; `None` if they have no stiffness.
fn descent(solver: &Solver, hanging: &[usize], at: &State) -> Option<DVector<f64>> {
    let mut force = DVector::from_fn(hanging.len(), |r, _| static_load(solver, hanging[r], at.t));
    for &i in solver.system().springs() {
        let own = solver.geometry().rows().approach_row(i);
        for (force, &k) in force.iter_mut().zip(hanging) {
            *force -= own[k] * at.force[i];
        }
    }
    regular(stiffness(solver, hanging, at)).map(|factor| factor.solve(&force))
}

/// Places hanging bodies below the ends of their ropes, which are stretched by the weight of the bodies.
pub(crate) fn place_below_ropes(solver: &mut Solver, at: &mut State) -> Result<(), Error> {
    let system = solver.system();
    for &b in &system.scene.actuators.hanging {
        let ropes =
            (0..system.scene.actuators.ropes.len()).filter_map(|index| Some(system.rope(index)?.1));
        let mut ends = ropes.filter_map(|rope| {
            let [from, to] = rope.ends()?;
            let is_own = |end: &Point| end.body == Some(b);
            let at_from = is_own(from).then_some((rope.rope, to, from));
            if is_own(to) {
                Some((rope.rope, from, to))
            } else {
                at_from
            }
        });
        let Some((rope, other, own)) = ends.next() else {
            continue;
        };
        let place = other.position(&system.mechanics, at.t, &at.q);
        let weight = system.scene.bodies[b].mass * system.scene.gravity;
        let stretched = rope.length * (1.0 + weight / rope.stiffness);
        let wanted = [place[0], place[1] - stretched, place[2]];
        for (axis, number) in system.mechanics.kinematics.numbers[b]
            .iter()
            .take(3)
            .enumerate()
        {
            if let Some(number) = *number {
                at.q[number] = wanted[axis] - own.at[axis];
            }
        }
    }
    solver.update(at)
}
