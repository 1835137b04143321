//! Static equilibrium of bodies that ride on nothing, below their ropes or on their floors.

use nalgebra::{DMatrix, DVector};

use crate::Error;
use crate::contact::link::{Link, scalar};
use crate::contact::solver::Solver;
use crate::contact::system::System;
use crate::mechanics::state::State;

/// Newton iterations, and sweeps between hung bodies and those on rails.
const ITERATIONS: usize = 200;
const SWEEPS: usize = 100;

impl Solver<'_> {
    /// Moves everything that may settle to static equilibrium at `at.t`: bodies on rails by
    /// [`Solver::carry`], hung bodies below their ropes, until the tensions stay.
    ///
    /// # Errors
    /// [`Error::NoEquilibrium`] where the tensions do not come to rest, and what [`Solver::carry`] refuses.
    pub fn equilibrate(&mut self, at: &mut State) -> Result<(), Error> {
        let system = self.system;
        if system.links.is_empty() {
            return self.carry(at);
        }
        let hung = hung(system);
        let first = system.link(0);
        let mut before = vec![f64::INFINITY; system.links.len()];
        let mut places = at.q.clone();
        at.v.fill(0.0);
        for _ in 0..SWEEPS {
            // the carriers have moved: a rope that fell slack would say nothing
            self.drop_below(at)?;
            self.hang(&hung, at)?;
            let tensions = &at.force[first..];
            let scale = tensions.iter().fold(self.weight(), |max, force| max.max(force.abs()));
            let pairs = tensions.iter().zip(&before);
            let moved = pairs.fold(0.0_f64, |max, (now, then)| max.max((now - then).abs()));
            // A rope that leans with what it hangs from pulls as hard, to the first order, but not as it should.
            if moved <= 1e-12 * scale && self.is_settled(&places, at) {
                return Ok(());
            }
            before.copy_from_slice(tensions);
            places.copy_from(&at.q);
            self.carry(at)?;
        }
        Err(Error::NoEquilibrium { time: at.t })
    }

    fn weight(&self) -> f64 {
        self.system.mechanics.gravity.amax()
    }

    /// Newton's method with step halving on the potential of the `hung` freedoms, which is convex; sets the forces
    /// of the links.
    fn hang(&mut self, hung: &[usize], at: &mut State) -> Result<(), Error> {
        let system = self.system;
        let mut potential = self.links_at(hung, at)?;
        for _ in 0..ITERATIONS {
            let Some(step) = self.descent(hung, at) else { break };
            let start = at.q.clone();
            let mut share = 1.0;
            loop {
                for (&number, d) in hung.iter().zip(step.iter()) {
                    at.q[number] = start[number] + share * d;
                }
                let now = self.links_at(hung, at)?;
                if now <= potential || share < 1e-6 {
                    potential = now;
                    break;
                }
                share *= 0.5;
            }
            let size = hung.iter().fold(1.0_f64, |max, &k| max.max(at.q[k].abs()));
            if share * step.amax() <= 1e-15 * size {
                break;
            }
        }
        self.geometry.settle_links(system, at);
        Ok(())
    }

    /// Potential of weight, loads and links at `at`, whose link forces it sets.
    fn links_at(&mut self, hung: &[usize], at: &mut State) -> Result<f64, Error> {
        let system = self.system;
        self.geometry.update(system, at.t, &at.q, &at.force)?;
        let mut potential = -hung.iter().map(|&k| self.static_load(k, at.t) * at.q[k]).sum::<f64>();
        for index in 0..system.links.len() {
            let (i, hold) = (system.link(index), &self.geometry.links[index]);
            let p = self.geometry.approach(i, &at.q).max(0.0);
            at.force[i] = hold.stiffness * p;
            potential += 0.5 * hold.stiffness * p * p;
        }
        Ok(potential)
    }

    fn static_load(&self, number: usize, t: f64) -> f64 {
        let system = self.system;
        let loads =
            system.scene.actuators.loads.iter().filter(|load| system.mechanics.loaded(load) == Some(number));
        system.mechanics.gravity[number] + loads.map(|load| load.value.at(t)).sum::<f64>()
    }

    /// Newton's step of the `hung` freedoms; `None` where there is none to take.
    fn descent(&self, hung: &[usize], at: &State) -> Option<DVector<f64>> {
        let system = self.system;
        let n = system.mechanics.dofs;
        let size = hung.len();
        let mut force = DVector::from_fn(size, |r, _| self.static_load(hung[r], at.t));
        let mut matrix = DMatrix::zeros(size, size);
        let mut row = vec![0.0; n];
        for (index, link) in system.links.iter().enumerate() {
            let (i, hold) = (system.link(index), &self.geometry.links[index]);
            if at.force[i] <= 0.0 {
                continue;
            }
            let pull = DVector::from_fn(size, |r, _| self.geometry.rows[i * n + hung[r]]);
            force -= &pull * at.force[i];
            matrix += &pull * pull.transpose() * hold.stiffness;
            if let Link::Rope { .. } = link {
                for axis in 0..3 {
                    let mut unit = [0.0; 3];
                    unit[axis] = 1.0;
                    let lean = scalar(unit, hold.direction);
                    row.fill(0.0);
                    link.add_row(&system.mechanics, (at.t, &at.q), unit, &mut row);
                    let across = DVector::from_fn(size, |r, _| {
                        row[hung[r]] - lean * self.geometry.rows[i * n + hung[r]]
                    });
                    matrix += &across * across.transpose() * (at.force[i] / hold.length);
                }
            }
        }
        let stiffest = matrix.diagonal().amax();
        if size == 0 || stiffest <= 0.0 {
            return None;
        }
        for k in 0..size {
            matrix[(k, k)] += 1e-14 * stiffest;
        }
        matrix.cholesky().map(|factor| factor.solve(&force))
    }

    /// Puts hung bodies below the ends of their ropes, stretched by their weight.
    pub fn drop_below(&mut self, at: &mut State) -> Result<(), Error> {
        let system = self.system;
        for &b in &system.scene.actuators.hung {
            let ends = system.links.iter().filter_map(|link| match link {
                Link::Rope { rope, from, to } if to.body == Some(b) => Some((rope, from, to)),
                Link::Rope { rope, from, to } if from.body == Some(b) => Some((rope, to, from)),
                _ => None,
            });
            let Some((rope, other, own)) = ends.into_iter().next() else { continue };
            let place = other.position(&system.mechanics, at.t, &at.q);
            let weight = system.scene.bodies[b].mass * system.scene.gravity;
            let stretched = rope.length * (1.0 + weight / rope.stiffness);
            let wanted = [place[0], place[1] - stretched, place[2]];
            for (axis, number) in system.mechanics.kinematics.numbers[b].iter().take(3).enumerate() {
                if let Some(number) = *number {
                    at.q[number] = wanted[axis] - own.at[axis];
                }
            }
        }
        self.geometry.update(system, at.t, &at.q, &at.force)
    }

    /// Weight on freedom `number` that the links take, at the forces of `at`.
    pub fn pull_of_links(&self, number: usize, at: &State) -> f64 {
        let (system, n) = (self.system, self.system.mechanics.dofs);
        let links = (0..system.links.len()).map(|index| system.link(index));
        links.map(|i| -self.geometry.rows[i * n + number] * at.force[i]).sum()
    }
}

/// Freedoms of the hung bodies that links reach.
fn hung(system: &System) -> Vec<usize> {
    let bodies = system.scene.actuators.hung.iter();
    bodies
        .filter(|&&b| system.links.iter().any(|link| link.is_on(b)))
        .flat_map(|&b| system.mechanics.kinematics.numbers[b].iter().take(3).flatten().copied())
        .collect()
}
