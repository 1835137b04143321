//! Contact forces at states that the caller gives: what another program's forces are compared with.

use nalgebra::{DMatrix, DVector};

use crate::contact::solver::{RIGID, Solver};
use crate::contact::system::System;
use crate::mechanics::state::State;
use crate::{Error, Foundation, Scene};

/// Newton iterations on the rates of penetration.
const ITERATIONS: usize = 30;

/// A state of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Instant {
    /// Time; it gives x and its rate where they are prescribed.
    pub time: f64,
    /// Six displacements a body; those that are not free are not read.
    pub displacement: Vec<[f64; 6]>,
    /// Their rates.
    pub speed: Vec<[f64; 6]>,
    /// Speed of spin a wheel; read where the wheel has a spin of its own.
    pub spin: Vec<f64>,
    /// Penetration a contact of the scene, where a damper between wheel and rail makes it a state: `Some` for a
    /// contact that acts, `None` for one that is open. Not read elsewhere.
    pub penetration: Vec<Option<f64>>,
}

/// What acts between wheels and rails at an instant.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactForces {
    /// Force on the rail, positive down, a wheel.
    pub vertical: Vec<f64>,
    /// Force of the flange on the rail, positive along +z, a wheel.
    pub lateral: Vec<f64>,
    /// Friction on the wheel along -x, a wheel.
    pub traction: Vec<f64>,
    /// Force that the slope of the deflected rail exerts on the wheel along +x, a wheel; of vertical forces alone.
    pub slope: Vec<f64>,
    /// Approach of wheel and rail before the rail gives, a contact of the scene.
    pub approach: Vec<f64>,
    /// Penetration, a contact of the scene; negative where it is open.
    pub penetration: Vec<f64>,
    /// Give of the rails, contacts x contacts: downwards at the row per unit force down at the column.
    pub compliance: DMatrix<f64>,
}

/// Contact forces of `scene` on `foundations` at each of `instants`.
///
/// Vertical forces solve p + G F = e over the contacts that act, F the law of p and its rate; where p is given,
/// its rate follows. Structures with freedoms of their own rest where they are unloaded.
///
/// # Errors
/// A scene that cannot be set up, foundations of parts with one force each, an instant of the wrong shape, and
/// [`Error::NoForces`] where the equations have no solution: a penetration given where the rail cannot give.
pub fn contact_forces(
    scene: &Scene,
    foundations: &[Foundation],
    instants: &[Instant],
) -> Result<Vec<ContactForces>, Error> {
    let system = System::new(scene, foundations)?;
    if let Some(index) = foundations.iter().position(|foundation| foundation.parts.is_some()) {
        return Err(Error::NoSuch { what: "one force a wheel on structure", index });
    }
    let mut solver = Solver::new(&system)?;
    solver.keeps_rails = false;
    let mut state = system.state();
    instants.iter().map(|instant| solver.forces_at(instant, &mut state)).collect()
}

impl Solver<'_> {
    fn forces_at(&mut self, instant: &Instant, at: &mut State) -> Result<ContactForces, Error> {
        self.place(instant, at)?;
        let count = self.system.mechanics.groups.len();
        let none = Error::NoForces { time: at.t };
        for i in 0..count {
            self.active[i] = self.given(instant, i).is_some() || self.bilateral(i);
        }
        for _ in 0..4 * count + 8 {
            if !self.solve_rates(instant, at)? {
                return Err(none);
            }
            let free = |i: usize| !self.system.law(i).has_memory() || self.stands_on_rigid(i);
            let weakest = (0..count)
                .filter(|&i| free(i) && self.active[i] && self.opens(i, at))
                .min_by(|&i, &j| at.force[i].total_cmp(&at.force[j]));
            let deepest = (0..count)
                .filter(|&i| free(i) && !self.active[i] && self.closing(i, at) > 0.0)
                .max_by(|&i, &j| at.p[i].total_cmp(&at.p[j]));
            match (weakest, deepest) {
                (Some(i), _) => self.active[i] = false,
                (None, Some(i)) => self.active[i] = true,
                (None, None) => return Ok(self.answer(at)),
            }
        }
        Err(none)
    }

    /// Puts the instant's numbers into the state.
    fn place(&mut self, instant: &Instant, at: &mut State) -> Result<(), Error> {
        let system = self.system;
        for (what, found, expected) in [
            ("displacements of an instant", instant.displacement.len(), system.scene.bodies.len()),
            ("speeds of an instant", instant.speed.len(), system.scene.bodies.len()),
            ("spins of an instant", instant.spin.len(), system.mechanics.wheels.len()),
            ("penetrations of an instant", instant.penetration.len(), system.scene.contacts.len()),
        ] {
            if found != expected {
                return Err(Error::Number { what, wanted: "one each", found: found as f64 });
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
        for i in 0..system.mechanics.groups.len() {
            (at.p[i], at.p_rate[i]) = (self.given(instant, i).unwrap_or(0.0), 0.0);
        }
        self.geometry.height.clear();
        self.geometry
            .height
            .extend(system.mechanics.wheels.iter().map(|wheel| system.scene.wheels[wheel.kind].radius));
        self.locate(at)?;
        self.geometry.update(system, at.t, &at.q, &at.force)
    }

    /// The penetration that the instant gives to vertical contact `i`.
    fn given(&self, instant: &Instant, i: usize) -> Option<f64> {
        let remembers = self.system.law(i).has_memory();
        instant.penetration[self.system.mechanics.groups[i].contact].filter(|_| remembers)
    }

    pub(crate) fn stands_on_rigid(&self, i: usize) -> bool {
        self.geometry.compliance[i * self.system.components() + i] * self.system.law(i).stiffness <= RIGID
    }

    /// Finds the rates of the penetrations that are given such that p + G F = e; a rigid rail takes the wheel's
    /// own penetration and rate. Returns whether it converged.
    fn solve_rates(&mut self, instant: &Instant, at: &mut State) -> Result<bool, Error> {
        let system = self.system;
        for i in (0..system.mechanics.groups.len())
            .filter(|&i| system.law(i).has_memory() && self.stands_on_rigid(i))
        {
            at.p[i] = self.geometry.approach(i, &at.q);
            at.p_rate[i] = self.approach_rate(i, at);
        }
        let unknown: Vec<usize> = (0..system.mechanics.groups.len())
            .filter(|&i| self.active[i] && self.given(instant, i).is_some() && !self.stands_on_rigid(i))
            .collect();
        self.solve_rates_of(&unknown, at)
    }

    /// Finds the rates of the penetrations of the contacts `unknown` such that p + G F = e. Returns whether it converged.
    pub(crate) fn solve_rates_of(&mut self, unknown: &[usize], at: &mut State) -> Result<bool, Error> {
        let system = self.system;
        let m = system.components();
        let slope = |solver: &Self, at: &State, i: usize| {
            let scale = system.mechanics.groups[i].count() * solver.geometry.share[i][0];
            scale * system.law(i).at(at.p[i], at.p_rate[i]).by_rate
        };
        let mut last = f64::INFINITY;
        for _ in 0..ITERATIONS {
            if !self.instant(at)? {
                return Ok(false);
            }
            let residual = DVector::from_iterator(
                unknown.len(),
                unknown.iter().map(|&i| at.p[i] - self.problem.penetration(i, &at.force)),
            );
            let size = residual.amax();
            let scale = unknown.iter().map(|&i| at.p[i].abs()).fold(0.0, f64::max);
            if size == 0.0 || (size >= 0.5 * last && size <= 1e-12 * scale) {
                return Ok(true);
            }
            last = last.min(size);
            let matrix = DMatrix::from_fn(unknown.len(), unknown.len(), |r, c| {
                let (i, j) = (unknown[r], unknown[c]);
                self.geometry.compliance[i * m + j] * slope(self, at, j)
            });
            let Some(change) = matrix.lu().solve(&residual) else { return Ok(false) };
            for (&i, change) in unknown.iter().zip(change.iter()) {
                at.p_rate[i] -= change;
            }
        }
        Ok(unknown.is_empty()
            || last
                <= 1e-9 * at.p[..system.mechanics.groups.len()].iter().fold(0.0, |max, p| p.abs().max(max)))
    }

    fn answer(&self, at: &State) -> ContactForces {
        let system = self.system;
        let (m, count) = (system.components(), system.mechanics.groups.len());
        let normal = |w: usize| system.mechanics.groups_of(w).next().unwrap_or(0);
        let vertical = |w: usize| at.force[normal(w)] / system.mechanics.groups[normal(w)].count();
        let of = |list: &[usize], w: usize| list.iter().position(|&one| one == w);
        let wheels = 0..system.mechanics.wheels.len();
        ContactForces {
            vertical: wheels.clone().map(vertical).collect(),
            lateral: wheels
                .clone()
                .map(|w| of(&system.laterals, w).map_or(0.0, |i| at.force[system.lateral(i)]))
                .collect(),
            traction: wheels
                .clone()
                .map(|w| of(&system.tractions, w).map_or(0.0, |i| at.force[system.traction(i)]))
                .collect(),
            slope: wheels.map(|w| self.geometry.rail_slope[normal(w)] * vertical(w)).collect(),
            approach: (0..count).map(|i| self.geometry.approach(i, &at.q)).collect(),
            penetration: at.p[..count].to_vec(),
            compliance: DMatrix::from_fn(count, count, |i, j| self.geometry.compliance[i * m + j]),
        }
    }
}
