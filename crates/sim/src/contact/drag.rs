//! Rails that give along x under friction, drives and brakes.
//!
//! A wheel slides on the rail's own material: s = x' + h omega - du/dt at a place of the rail. Where the rail gives without
//! mass, u = G F, so that s depends on how fast the forces change. u is a state, as a penetration is: in a stage
//! du/dt = (G F - u*)/g along the wheel's path, less x' dG/dx F for the path itself. Freedoms with mass give Phi v.

use crate::contact::geometry::Geometry;
use crate::contact::solver::RIGID;
use crate::contact::solver::Solver;
use crate::contact::system::{System, Tread};
use crate::mechanics::state::State;
use crate::numerics::dense::along;

impl Solver<'_> {
    /// Sets the displacements of massless rails along x to those under the forces of `at`, at rest.
    pub fn rest_rails(&mut self, at: &mut State) {
        let first = self.system.mechanics.groups.len();
        for (k, i) in self.system.drags().enumerate() {
            at.p[first + k] = along(&self.geometry.compliance, i, &at.force);
            at.p_rate[first + k] = 0.0;
        }
    }

    /// Adds to the rates of a stage, after its length `g`, what the massless rails move: rate - (G F - u*)/g + x' dG/dx F.
    pub fn drag_stage(&mut self, g: f64, known: &[f64], at: &State) {
        let (first, m) = (self.system.mechanics.groups.len(), self.system.components());
        for (k, i) in self.system.drags().enumerate() {
            self.problem.pinned[i] = None;
            self.problem.rate[i] += known[first + k] / g;
            for j in i * m..(i + 1) * m {
                self.problem.y[j] += self.geometry.compliance[j] / g;
            }
            self.pass_by(i, at);
        }
    }

    /// Lets the forces of an instant keep the displacements of massless rails, as far as their laws let them. A rail that
    /// hardly gives takes its rate from before.
    pub fn drag_instant(&mut self, at: &State) {
        let (first, m) = (self.system.mechanics.groups.len(), self.system.components());
        for (k, i) in self.system.drags().enumerate() {
            let stiffness = self.system.stiffest;
            let gives = self.geometry.compliance[i * m + i] * stiffness > RIGID;
            self.problem.pinned[i] = Some(at.p[first + k]).filter(|_| gives && self.keeps_rails);
            self.problem.rate[i] -= at.p_rate[first + k];
            self.problem.y[i * m..(i + 1) * m].fill(0.0);
            self.pass_by(i, at);
        }
    }

    /// Takes the wheels' own way over the deflected rail, x' dG/dx F, from the rate of component `i`.
    fn pass_by(&mut self, i: usize, at: &State) {
        let m = self.system.components();
        for (tread, speed) in own_treads(self.system, i, at) {
            let slopes = &self.geometry.by_tread[tread * m..(tread + 1) * m];
            for (y, slope) in self.problem.y[i * m..(i + 1) * m].iter_mut().zip(slopes) {
                *y -= speed * slope;
            }
        }
    }

    /// Displacements of massless rails along x at the end of a stage, and their rates.
    pub fn drag_end(&self, g: f64, known: &[f64], at: &mut State) {
        let first = self.system.mechanics.groups.len();
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
    let k = system.mechanics.groups.len() + i - system.traction(0);
    own - state.p_rate[k] + passing(system, geometry, state, i)
}

/// Rate of the rail under component `i` that its wheels pass over by their own way, x' dG/dx F.
pub(crate) fn passing(system: &System, geometry: &Geometry, state: &State, i: usize) -> f64 {
    let own = own_treads(system, i, state);
    own.map(|(tread, speed)| speed * along(&geometry.by_tread, tread, &state.force)).sum()
}

/// The treads of component `i` with their speeds along the rail.
fn own_treads<'s>(system: &'s System, i: usize, at: &'s State) -> impl Iterator<Item = (usize, f64)> + 's {
    let own = system.treads.iter().enumerate().filter(move |(_, tread)| tread.component == i);
    own.map(|(tread, Tread { wheel, .. })| (tread, system.mechanics.speed_along(*wheel, at)))
}
