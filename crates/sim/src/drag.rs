//! Rails that give along x under friction, drives and brakes.
//!
//! A wheel slides on the rail's own material: s = x' + h omega - du/dt at a place of the rail. Where the rail gives without
//! mass, u = G F, so that s depends on how fast the forces change. u is a state, as a penetration is: in a stage
//! du/dt = (G F - u*)/g along the wheel's path, less x' dG/dx F for the path itself. Freedoms with mass give Phi v.

use crate::dense::along;
use crate::geometry::Geometry;
use crate::scene::arm_rows;
use crate::settle::RIGID;
use crate::solver::Solver;
use crate::state::State;
use crate::system::System;

impl Solver<'_> {
    /// Sets the displacements of massless rails along x to those under the forces of `at`, at rest.
    pub fn rest_rails(&mut self, at: &mut State) {
        let first = self.system.normals.len();
        for (k, i) in self.system.drags().enumerate() {
            at.p[first + k] = along(&self.geometry.compliance, i, &at.force);
            at.p_rate[first + k] = 0.0;
        }
    }

    /// Adds to the rates of a stage, after its length `g`, what the massless rails move: rate - (G F - u*)/g + x' dG/dx F.
    pub fn drag_stage(&mut self, g: f64, known: &[f64], at: &State) {
        let (first, m) = (self.system.normals.len(), self.system.components());
        for (k, i) in self.system.drags().enumerate() {
            self.problem.pinned[i] = None;
            let speed = path_speed(self.system, k, at);
            self.problem.rate[i] += known[first + k] / g;
            for j in i * m..(i + 1) * m {
                self.problem.y[j] += self.geometry.compliance[j] / g - speed * self.geometry.slope[j];
            }
        }
    }

    /// Lets the forces of an instant keep the displacements of massless rails, as far as their laws let them. A rail that
    /// hardly gives takes its rate from before.
    pub fn drag_instant(&mut self, at: &State) {
        let (first, m) = (self.system.normals.len(), self.system.components());
        for (k, i) in self.system.drags().enumerate() {
            let stiffness = self.system.stiffest;
            let gives = self.geometry.compliance[i * m + i] * stiffness > RIGID;
            self.problem.pinned[i] = Some(at.p[first + k]).filter(|_| gives && self.keeps_rails);
            let speed = path_speed(self.system, k, at);
            self.problem.rate[i] -= at.p_rate[first + k];
            for j in i * m..(i + 1) * m {
                self.problem.y[j] = -speed * self.geometry.slope[j];
            }
        }
    }

    /// Displacements of massless rails along x at the end of a stage, and their rates.
    pub fn drag_end(&self, g: f64, known: &[f64], at: &mut State) {
        let first = self.system.normals.len();
        for (k, i) in self.system.drags().enumerate() {
            let moved = along(&self.geometry.compliance, i, &at.force);
            at.p_rate[first + k] = (moved - known[first + k]) / g;
            at.p[first + k] = moved;
        }
    }
}

/// Rate that the law of component `i` along a rail feels: that of its wheels less that of the rail.
pub(crate) fn slip(system: &System, geometry: &Geometry, state: &State, i: usize) -> f64 {
    let own = geometry.rate(i, &state.v);
    if !system.is_dragged {
        return own;
    }
    let k = system.normals.len() + i - system.traction(0);
    own - state.p_rate[k]
        + path_speed(system, i - system.traction(0), state) * along(&geometry.slope, i, &state.force)
}

/// Speed along the rail of the first wheel of drag `k`.
fn path_speed(system: &System, k: usize, at: &State) -> f64 {
    let Some(w) = system.leads[k] else { return 0.0 };
    let wheel = &system.wheels[w];
    let (_, speed) = system.body(wheel.body, at.t, &at.q, &at.v);
    arm_rows(wheel.hub)[0].iter().zip(&speed).map(|(arm, speed)| arm * speed).sum()
}
