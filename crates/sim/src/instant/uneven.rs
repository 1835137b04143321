//! Corners and steps of uneven rails: what happens where a wheel passes one.
//!
//! At a step the approach e jumps. On a rail that gives, the penetration under a damper between wheel and rail
//! goes on, p + G F = e, and the force jumps by way of its rate. On a rigid rail the penetration jumps with e: the
//! damper pushes with the impulse c (Q(p1) - Q(p0)), Q the integral of its ramp; it does not pull.

use crate::Error;
use crate::contact::solver::Solver;
use crate::mechanics::state::State;
use crate::numerics::dense::along;
use crate::numerics::step::step_integral;

impl Solver<'_> {
    /// Puts every wheel on the piece of its rail where it is at (t, q), moving at the speeds v; where it rests, where
    /// its prescribed acceleration takes it, or ahead.
    pub fn locate(&mut self, at: &State) -> Result<(), Error> {
        let system = self.system;
        if !system.is_uneven {
            return Ok(());
        }
        self.geometry.update(system, at.t, &at.q, &at.force)?;
        for w in 0..system.mechanics.wheels.len() {
            let Some(shape) = system.mechanics.irregularity(w) else { continue };
            let acceleration =
                self.geometry.travel[system.mechanics.kinematics.root(system.mechanics.wheels[w].body)].a;
            let speed = self.system.mechanics.speed_along(w, at);
            let direction = [speed, acceleration].into_iter().find(|d| *d != 0.0).unwrap_or(1.0);
            self.geometry.piece[w] = shape.piece(self.geometry.x[w], direction, 0);
        }
        Ok(())
    }

    /// Moves wheels that have reached the end of their piece to the next one; returns whether some have.
    pub fn cross(&mut self, at: &mut State) -> Result<bool, Error> {
        let system = self.system;
        let mut jump = vec![0.0; system.mechanics.groups.len()];
        let mut crosses = false;
        for w in 0..system.mechanics.wheels.len() {
            let Some(shape) = system.mechanics.irregularity(w) else { continue };
            let x = self.geometry.place(system, w, &at.q);
            let current = self.geometry.piece[w];
            let next = shape.piece(x, self.system.mechanics.speed_along(w, at), current);
            if next == current {
                continue;
            }
            crosses = true;
            self.geometry.piece[w] = next;
            for i in system.mechanics.groups_of(w) {
                jump[i] += (shape.vertical(next, x)[0] - shape.vertical(current, x)[0])
                    / system.mechanics.groups[i].count();
            }
        }
        if crosses {
            self.geometry.update(system, at.t, &at.q, &at.force)?;
            self.push(&jump, at);
            let felt: Vec<usize> = (0..system.mechanics.groups.len())
                .filter(|&i| self.remembers(i) && !self.stands_on_rigid(i))
                .collect();
            // Rates only: a guess is enough.
            self.solve_rates_of(&felt, at)?;
        }
        Ok(crosses)
    }

    /// Penetrations, impulses and rates of dampers on rigid rails whose approach has jumped.
    fn push(&mut self, jump: &[f64], at: &mut State) {
        let system = self.system;
        let (n, mut spread) = (system.mechanics.dofs, vec![0.0; system.mechanics.dofs]);
        for (i, _) in jump.iter().enumerate().filter(|(_, jump)| **jump != 0.0) {
            if !self.is_rigid(i) {
                continue;
            }
            let law = system.law(i);
            let (from, to) = (at.p[i], self.geometry.approach(i, &at.q));
            at.p[i] = to;
            let grown = if law.bilateral {
                step_integral(law.depth, to) - step_integral(law.depth, from)
            } else {
                (step_integral(law.depth, to.max(0.0)) - step_integral(law.depth, from.max(0.0))).max(0.0)
            };
            let impulse =
                system.mechanics.groups[i].count() * self.geometry.share[i][0] * law.damping * grown;
            self.spread_row(&self.geometry.force_rows[i * n..(i + 1) * n], &mut spread);
            at.v.iter_mut().zip(&spread).for_each(|(v, by)| *v -= by * impulse);
        }
        self.follow(at);
    }

    /// Rates of penetration under dampers on rigid rails: those of the approach.
    pub fn follow(&self, at: &mut State) {
        for i in (0..self.system.mechanics.groups.len()).filter(|&i| self.is_rigid(i)) {
            at.p_rate[i] = self.approach_rate(i, at);
        }
    }

    fn is_rigid(&self, i: usize) -> bool {
        self.system.law(i).has_memory() && self.stands_on_rigid(i)
    }

    /// Rate at which wheel and unloaded rail approach each other at vertical contact `i`.
    pub fn approach_rate(&self, i: usize, at: &State) -> f64 {
        let own = along(&self.geometry.rows, i, at.v.as_slice());
        if !self.system.is_uneven {
            return own;
        }
        own + self.geometry.rise[i] * self.system.contact_speed(i, at)
    }
}
