//! What the laws of all components answer to penetrations and rates: residuals F - law, and the slopes of the laws.

use crate::contact::forces::{Problem, Slope};
use crate::contact::geometry::Geometry;
use crate::contact::system::System;
use crate::numerics::dense::along;
use crate::scene::wheel::LawPoint;

/// A rate at which every law along the rail gives all it can.
const SATURATED: f64 = 1e150;

impl Problem {
    /// Fills the residuals F - law(p, r) under `force` at the penetrations and rates in `reach`, the components that act,
    /// and the slopes of their laws. What does not act has its force for a residual.
    pub fn answer(&mut self, system: &System, geometry: &Geometry, active: &[bool], force: &[f64]) {
        self.acting.clear();
        self.slopes.clear();
        self.grips.clear();
        self.residual.fill(0.0);
        self.idles = 0.0;
        self.press(system, geometry, active, force);
        self.guide(system, force);
        self.rub(system, force);
        self.pull(system, geometry, force);
        self.hold(system, geometry, force);
    }

    fn act(&mut self, i: usize, residual: f64, slope: Slope) {
        self.residual[i] = residual;
        self.acting.push(i);
        self.slopes.push(slope);
    }

    fn idle(&mut self, i: usize, force: f64) {
        self.residual[i] = force;
        self.idles = self.idles.max(force.abs());
    }

    /// Vertical contacts.
    fn press(&mut self, system: &System, geometry: &Geometry, active: &[bool], force: &[f64]) {
        for (i, normal) in system.mechanics.groups.iter().enumerate() {
            if self.known[i] || !active[i] {
                continue;
            }
            let [penetration, rate] = self.reach[i];
            let LawPoint { force: law, by_penetration, by_rate } = system.law(i).at(penetration, rate);
            let scale = normal.count() * geometry.share[i][0];
            let slope = Slope {
                by_penetration: scale * by_penetration,
                by_rate: scale * by_rate,
                ..Slope::default()
            };
            self.act(i, force[i] - scale * law, slope);
        }
    }

    /// Flanges.
    fn guide(&mut self, system: &System, force: &[f64]) {
        for (index, &w) in system.laterals.iter().enumerate() {
            let i = system.lateral(index);
            let Some(flange) = system.flange(index) else { continue };
            let overlap = if self.asleep[i] { 0.0 } else { flange.overlap(self.reach[i][0]) };
            if overlap == 0.0 {
                self.idle(i, force[i]);
                continue;
            }
            let normal = system.mechanics.groups_of(w).next().unwrap_or(0);
            let radius = system.scene.wheels[system.mechanics.wheels[w].kind].radius;
            let (share, by_height) = flange.share(radius - self.reach[normal][0]);
            let slope = Slope {
                by_penetration: flange.stiffness * share,
                by_rate: 0.0,
                by_other: Some((normal, -flange.stiffness * by_height * overlap)),
            };
            self.act(i, force[i] - flange.stiffness * share * overlap, slope);
        }
    }

    /// Friction of wheels that spin.
    fn rub(&mut self, system: &System, force: &[f64]) {
        for (index, &w) in system.tractions.iter().enumerate() {
            let i = system.traction(index);
            let Some(friction) = &system.scene.wheels[system.mechanics.wheels[w].kind].friction else {
                continue;
            };
            let load: f64 =
                system.mechanics.groups_of(w).map(|n| force[n] / system.mechanics.groups[n].count()).sum();
            if self.pin(i, friction.coefficient * load, force) {
                continue;
            }
            let (share, by_slip) = match self.wanted(i, force) {
                Some(wanted) => (wanted.signum(), 0.0),
                None => friction.share(self.reach[i][1]),
            };
            let slope = Slope { by_rate: friction.coefficient * load * by_slip, ..Slope::default() };
            self.act(i, force[i] - friction.coefficient * load * share, slope);
            for n in system.mechanics.groups_of(w) {
                self.grips.push((i, n, friction.coefficient * share / system.mechanics.groups[n].count()));
            }
        }
    }

    /// Drives and brakes.
    fn pull(&mut self, system: &System, geometry: &Geometry, force: &[f64]) {
        for (index, pull) in system.pulls.iter().enumerate() {
            let i = system.pull(index);
            if !geometry.pulls[index] {
                self.idle(i, force[i]);
                continue;
            }
            let (own, traction) = (self.y[i * force.len() + i], pull.traction(force));
            let by_traction = if let Some(wanted) = self.wanted(i, force) {
                let (law, _, by_traction) = pull.at(SATURATED.copysign(wanted), traction);
                if self.pin(i, law.abs(), force) {
                    continue;
                }
                self.act(i, force[i] - law, Slope::default());
                by_traction
            } else {
                let given = pull.give(force[i], self.reach[i][1], own, traction);
                self.grips.push((i, i, given.by_force));
                self.act(i, force[i] - given.force, Slope { by_rate: given.by_rate, ..Slope::default() });
                given.by_traction
            };
            for grip in pull.grips.iter().filter(|grip| force[grip.normal] > 0.0) {
                self.grips.push((i, grip.normal, by_traction * grip.mu));
            }
        }
    }

    /// Ropes and stops.
    fn hold(&mut self, system: &System, geometry: &Geometry, force: &[f64]) {
        for (index, hold) in geometry.links.iter().enumerate() {
            let i = system.link(index);
            if !hold.taut {
                self.idle(i, force[i]);
                continue;
            }
            let [penetration, rate] = self.reach[i];
            let slope = Slope { by_penetration: hold.stiffness, by_rate: hold.damping, ..Slope::default() };
            self.act(i, force[i] - hold.law(penetration, rate), slope);
        }
    }

    /// Force of a pinned component that keeps the give of its rail, beside the others of `force`.
    fn wanted(&self, i: usize, force: &[f64]) -> Option<f64> {
        let give = self.pinned[i]?;
        let own = self.w[i * force.len() + i];
        Some(force[i] + (give - along(&self.w, i, force)) / own)
    }

    /// The row of a pinned component whose force is within `bound`, W F/W_ii = its give/W_ii; false for others.
    fn pin(&mut self, i: usize, bound: f64, force: &[f64]) -> bool {
        let Some(wanted) = self.wanted(i, force).filter(|wanted| wanted.abs() <= bound) else { return false };
        let own = self.w[i * force.len() + i];
        // The identity of the Jacobian and the diagonal of W/W_ii are one.
        self.grips.push((i, i, 1.0));
        self.act(i, force[i] - wanted, Slope { by_penetration: 1.0 / own, ..Slope::default() });
        true
    }
}
