//! Contact forces at given states, for comparison with the forces of another program.

use nalgebra::DMatrix;

use crate::contact::solver::{RailMemory, Solver};
use crate::contact::system::System;
use crate::instant::rates::solve_rates_of;
use crate::instant::uneven::locate_wheels;
use crate::mechanics::state::State;
use crate::{Channel, Error, Foundation, Scene};

/// A state of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Instant {
    /// Time; it determines x and its rate if they are prescribed.
    pub time: f64,
    /// Six displacements for each body; those that are not free are not used.
    pub displacement: Vec<[f64; 6]>,
    /// Rates of the displacements.
    pub speed: Vec<[f64; 6]>,
    /// Spin speed of each wheel; used if the spin of the wheel is a degree of freedom.
    pub spin: Vec<f64>,
    /// Penetration of each contact of the scene, for contacts with a damper between wheel and rail, whose penetration
    /// is a state: `Some` for an active contact, `None` for an open one. Not used for other contacts.
    pub penetration: Vec<Option<f64>>,
}

/// Contact forces between wheels and rails at an instant.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactForces {
    /// Vertical force of each wheel on the rail, positive down.
    pub vertical: Vec<f64>,
    /// Force of the flange of each wheel on the rail, positive along +z.
    pub lateral: Vec<f64>,
    /// Friction force on each wheel along -x.
    pub traction: Vec<f64>,
    /// Force along +x on each wheel due to the slope of the deflected rail, from vertical forces only.
    pub slope_force: Vec<f64>,
    /// Approach of wheel and rail before the rail deflects, for each contact of the scene.
    pub approach: Vec<f64>,
    /// Penetration of each contact of the scene; negative if it is open.
    pub penetration: Vec<f64>,
    /// Compliance of the rails, contacts x contacts: deflection down at the row per unit force down at the column.
    pub compliance: DMatrix<f64>,
}

/// Contact forces of `scene` on `foundations` at each of `instants`.
///
/// The vertical forces satisfy p + G F = e for the active contacts, where F follows from the law of p and its rate.
/// If p is given, its rate is the unknown. Structures with their own degrees of freedom are at their unloaded
/// position.
///
/// # Errors
/// A scene that cannot be set up, foundations of parts, which have more than one force per wheel, an instant with the
/// wrong number of values, and [`Error::NoForces`] if the equations have no solution, for example if a penetration is
/// given where the rail cannot comply.
pub fn contact_forces(
    scene: &Scene,
    foundations: &[Foundation],
    instants: &[Instant],
) -> Result<Vec<ContactForces>, Error> {
    let system = System::new(scene, foundations)?;
    if let Some(index) = foundations
        .iter()
        .position(|foundation| foundation.parts.is_some())
    {
        return Err(Error::NoSuch {
            what: "one force a wheel on structure",
            index,
        });
    }
    let mut solver = Solver::new(&system, RailMemory::Unknown)?;
    let mut state = system.state();
    instants
        .iter()
        .map(|instant| forces_at(&mut solver, instant, &mut state))
        .collect()
}

fn forces_at(
    solver: &mut Solver,
    instant: &Instant,
    at: &mut State,
) -> Result<ContactForces, Error> {
    place(solver, instant, at)?;
    let system = solver.system();
    let count = system.verticals();
    let none = Error::NoForces { time: at.t };
    for i in 0..count {
        let is_given = given(solver, instant, i).is_some();
        let touches = !system.law(i).has_memory() && solver.geometry().approach(i, &at.q) > 0.0;
        solver.set_active(i, is_given || touches || system.law(i).bilateral);
    }
    let (mut fewest, mut patience) = (usize::MAX, PATIENCE);
    for _ in 0..MOST + 4 * count {
        if !solve_rates(solver, instant, at)? {
            return Err(none);
        }
        let free = |i: usize| !system.law(i).has_memory() || solver.is_on_rigid_rail(i);
        let mut opening: Vec<usize> = (0..count)
            .filter(|&i| free(i) && solver.active().has(i) && solver.opens(i, at))
            .collect();
        let mut closing: Vec<usize> = (0..count)
            .filter(|&i| free(i) && !solver.active().has(i) && solver.closing(i, at) > 0.0)
            .collect();
        if opening.is_empty() && closing.is_empty() {
            return Ok(answer(solver, at));
        }
        let wrong = opening.len() + closing.len();
        if wrong < fewest {
            (fewest, patience) = (wrong, PATIENCE);
        } else if patience > 0 {
            patience -= 1;
        } else {
            // one at a time: the weakest, or else the deepest
            opening.sort_by(|&i, &j| at.force[i].total_cmp(&at.force[j]));
            closing.sort_by(|&i, &j| at.p[j].total_cmp(&at.p[i]));
            opening.truncate(1);
            closing.truncate(usize::from(opening.is_empty()));
        }
        for i in opening {
            solver.set_active(i, false);
        }
        for i in closing {
            solver.set_active(i, true);
        }
    }
    Err(none)
}

/// Number of rounds in which all contacts that open or close do so together although they do not become fewer (block principal
/// pivoting: Judice and Pires, Computers and Operations Research 21, 1994).
const PATIENCE: usize = 6;
/// Largest number of rounds, with four more for each contact.
const MOST: usize = 40;

/// Copies the values of the instant to the state.
fn place(solver: &mut Solver, instant: &Instant, at: &mut State) -> Result<(), Error> {
    let system = solver.system();
    for (what, found, expected) in [
        (
            "displacements of an instant",
            instant.displacement.len(),
            system.scene.bodies.len(),
        ),
        (
            "speeds of an instant",
            instant.speed.len(),
            system.scene.bodies.len(),
        ),
        (
            "spins of an instant",
            instant.spin.len(),
            system.mechanics.wheels.len(),
        ),
        (
            "penetrations of an instant",
            instant.penetration.len(),
            system.scene.contacts.len(),
        ),
    ] {
        if found != expected {
            return Err(Error::Number {
                what,
                wanted: "one each",
                found: found as f64,
            });
        }
    }
    at.t = instant.time;
    at.force.fill(0.0);
    for (b, numbers) in system.mechanics.kinematics.numbers.iter().enumerate() {
        for (i, number) in numbers.iter().enumerate() {
            if let Some(number) = *number {
                (at.q[number], at.v[number]) = (instant.displacement[b][i], instant.speed[b][i]);
            }
        }
    }
    for (wheel, speed) in system.mechanics.wheels.iter().zip(&instant.spin) {
        if let Some(number) = wheel.spin {
            at.v[number] = *speed;
        }
    }
    for i in 0..system.verticals() {
        (at.p[i], at.p_rate[i]) = (given(solver, instant, i).unwrap_or(0.0), 0.0);
    }
    solver.reset_heights();
    locate_wheels(solver, at)?;
    solver.update(at)
}

/// The penetration of vertical contact `i` in the instant, if its penetration is a state.
fn given(solver: &Solver, instant: &Instant, i: usize) -> Option<f64> {
    let remembers = solver.system().law(i).has_memory();
    instant.penetration[solver.system().mechanics.groups[i].contact].filter(|_| remembers)
}

/// Largest number of solutions for the penetrations on rigid rails.
const ROUNDS: usize = 12;
/// Change of the penetrations on rigid rails, relative to their approach, at which they have converged.
const CONVERGED: f64 = 4.0 * f64::EPSILON;

/// Finds the rates of the given penetrations for which p + G F = e. Returns whether the iteration converged.
///
/// On a rigid rail the force does not follow from a given penetration. There the rate is that at which the wheel
/// approaches the deflected rail, and the penetration is p = e - G F. The own compliance of such a contact is at most
/// 1e-9 of that of its wheel, but the forces of other wheels deflect the rail below it by up to the square root of this
/// fraction of what they deflect it below themselves, so that G F is not negligible. It hardly changes when p is
/// replaced in the law, so that two or three solutions suffice.
fn solve_rates(solver: &mut Solver, instant: &Instant, at: &mut State) -> Result<bool, Error> {
    let system = solver.system();
    let on_rigid =
        |solver: &Solver, i: usize| system.law(i).has_memory() && solver.is_on_rigid_rail(i);
    let rigid: Vec<usize> = (0..system.verticals())
        .filter(|&i| on_rigid(solver, i))
        .collect();
    let unknown: Vec<usize> = (0..system.verticals())
        .filter(|&i| {
            solver.active().has(i) && given(solver, instant, i).is_some() && !rigid.contains(&i)
        })
        .collect();
    for &i in &rigid {
        at.p[i] = solver.geometry().approach(i, &at.q);
        at.p_rate[i] = solver.approach_rate(i, at);
    }
    for _ in 0..ROUNDS {
        if !solve_rates_of(solver, &unknown, at)? {
            return Ok(false);
        }
        let mut moved = 0.0_f64;
        for &i in &rigid {
            let approach = solver.geometry().approach(i, &at.q);
            let (p, rate) = (
                solver.solved_penetration(i, &at.force),
                solver.approach_rate(i, at),
            );
            let (law, scale) = (system.law(i), approach.abs().max(f64::MIN_POSITIVE));
            let by_rate = (rate - at.p_rate[i]).abs() * law.damping / law.stiffness;
            moved = moved.max((p - at.p[i]).abs().max(by_rate) / scale);
            (at.p[i], at.p_rate[i]) = (p, rate);
        }
        if moved <= CONVERGED {
            return Ok(true);
        }
    }
    Ok(false)
}

fn answer(solver: &Solver, at: &State) -> ContactForces {
    let system = solver.system();
    let (m, count) = (system.elements.len(), system.verticals());
    let normal = |w: usize| system.mechanics.groups_of(w).next().unwrap_or(0);
    let vertical = |w: usize| at.force[normal(w)] / system.mechanics.groups[normal(w)].count();
    let wheels = 0..system.mechanics.wheels.len();
    let mut lateral = vec![0.0; wheels.len()];
    for (element, force) in system.elements.iter().zip(&at.force) {
        for (channel, divisor) in element.channels(&system.mechanics) {
            if let Channel::Lateral(w) = channel {
                lateral[w] += force / divisor;
            }
        }
    }
    ContactForces {
        vertical: wheels.clone().map(vertical).collect(),
        lateral,
        traction: wheels.clone().map(|w| system.friction_of(w, at)).collect(),
        slope_force: wheels
            .map(|w| solver.geometry().rail_slope(normal(w)) * vertical(w))
            .collect(),
        approach: (0..count)
            .map(|i| solver.geometry().approach(i, &at.q))
            .collect(),
        penetration: at.p[..count].to_vec(),
        compliance: DMatrix::from_fn(count, count, |i, j| {
            solver.geometry().rails().value[i * m + j]
        }),
    }
}
