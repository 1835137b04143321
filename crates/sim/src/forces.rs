//! Contact forces of one instant or one stage of a step: F = law(e - W F, r - Y F).
//!
//! Every component presses with a law of its approach p = e - W F and rate r - Y F: W holds the rail's give
//! G and, inside a step, the bodies' mobility; Y the mobility that the rates feel. Which vertical contacts
//! act is given; the caller checks that they push and that the others stay open.

use crate::dense::{along, solve_general, solve_spd};
use crate::geometry::Geometry;
use crate::system::System;
use crate::wheel::LawPoint;

/// Relative change of the forces at which Newton's method ends.
const TOLERANCE: f64 = 1e-13;
const ITERATIONS: usize = 60;
/// Share of Newton's change below which a smaller one is not tried. A brake on a rail that gives grips within 1e-6 of the
/// forces on either side, and less in short steps.
const SHORTEST: f64 = 1e-12;
/// A rate at which every law along the rail gives all it can.
const SATURATED: f64 = 1e150;

/// Matrices and free motion of one solution, over components, row-major.
pub(crate) struct Problem {
    pub w: Vec<f64>,
    pub y: Vec<f64>,
    pub approach: Vec<f64>,
    pub rate: Vec<f64>,
    /// Components whose force is known already.
    pub known: Vec<bool>,
    /// Ratio of a row of `y` to the row of `w`, where the rate is that of the penetration.
    pub memory: Vec<Option<f64>>,
    /// Flanges taken as free, whatever their overlap: the columns of the bodies' mobility are not filled for them.
    pub asleep: Vec<bool>,
    /// Components whose force keeps the give of their rail at a value, as far as their law lets it.
    pub pinned: Vec<Option<f64>>,
    /// Relative residual of the forces that may be left; rounding alone where it is zero.
    pub slack: f64,
    matrix: Vec<f64>,
    residual: Vec<f64>,
    start: Vec<f64>,
    newton: Vec<f64>,
    /// Rows of the Jacobian that are not the identity's, and whether each is.
    index: Vec<usize>,
    listed: Vec<bool>,
    /// Those rows and columns alone, and their change.
    compact: Vec<f64>,
    change: Vec<f64>,
}

impl Problem {
    pub fn new(system: &System) -> Self {
        let m = system.components();
        Problem {
            w: vec![0.0; m * m],
            y: vec![0.0; m * m],
            approach: vec![0.0; m],
            rate: vec![0.0; m],
            known: vec![false; m],
            memory: vec![None; m],
            asleep: vec![false; m],
            pinned: vec![None; m],
            slack: 0.0,
            matrix: vec![0.0; m * m],
            residual: vec![0.0; m],
            start: vec![0.0; m],
            newton: vec![0.0; m],
            index: Vec::with_capacity(m),
            listed: vec![false; m],
            compact: vec![0.0; m * m],
            change: vec![0.0; m],
        }
    }

    /// Approach of component `i` under `force`: e - W F.
    pub fn penetration(&self, i: usize, force: &[f64]) -> f64 {
        self.approach[i] - along(&self.w, i, force)
    }

    fn rate(&self, i: usize, force: &[f64]) -> f64 {
        self.rate[i] - along(&self.y, i, force)
    }

    /// Solves for the forces of the `active` vertical contacts and of everything that depends on them;
    /// `force` holds a first guess. Returns false where Newton's method does not converge.
    pub fn solve(
        &mut self,
        system: &System,
        geometry: &Geometry,
        active: &[bool],
        force: &mut [f64],
    ) -> bool {
        if system.linear_normals && force.len() == system.normals.len() {
            return self.solve_linear(system, geometry, active, force);
        }
        self.solve_newton(system, geometry, active, force)
    }

    /// One linear system: F/k + W F + (c/k) Y F = e + (c/k) r, k and c times wheels and share.
    fn solve_linear(
        &mut self,
        system: &System,
        geometry: &Geometry,
        active: &[bool],
        force: &mut [f64],
    ) -> bool {
        let m = force.len();
        self.index.clear();
        self.index.extend((0..m).filter(|&i| active[i] && !self.known[i]));
        let count = self.index.len();
        for (row, &i) in self.index.iter().enumerate() {
            let normal = &system.normals[i];
            let law = system.law(i);
            let ratio = law.damping / law.stiffness;
            // A damper between wheel and rail has Y = W/step: divide its row by 1 + ratio/step.
            let (scale, by_rate) = match self.memory[i] {
                Some(per_step) => (1.0 / (1.0 + ratio * per_step), 0.0),
                None => (1.0, ratio),
            };
            let mut rhs = (self.approach[i] + ratio * self.rate[i]) * scale;
            for (column, &j) in self.index.iter().enumerate() {
                self.matrix[row * count + column] = self.w[i * m + j] + by_rate * self.y[i * m + j];
            }
            for j in (0..m).filter(|&j| self.known[j]) {
                rhs -= (self.w[i * m + j] + by_rate * self.y[i * m + j]) * force[j];
            }
            self.matrix[row * count + row] += scale / (law.stiffness * normal.count() * geometry.share[i][0]);
            self.residual[row] = rhs;
        }
        let (matrix, rhs) = (&mut self.matrix[..count * count], &mut self.residual[..count]);
        let solved = if system.symmetric { solve_spd(matrix, rhs) } else { solve_general(matrix, rhs) };
        for i in (0..m).filter(|&i| !self.known[i]) {
            force[i] = 0.0;
        }
        for (row, &i) in self.index.iter().enumerate() {
            force[i] = self.residual[row];
        }
        solved
    }

    /// Newton's method with step halving on F - law(F) = 0.
    fn solve_newton(
        &mut self,
        system: &System,
        geometry: &Geometry,
        active: &[bool],
        force: &mut [f64],
    ) -> bool {
        for (i, normal_active) in active.iter().enumerate() {
            if !normal_active {
                force[i] = 0.0;
            }
        }
        let mut size = self.evaluate(system, geometry, active, force);
        for _ in 0..ITERATIONS {
            if !self.solve_acting() {
                return false;
            }
            let scale = largest(force);
            let change = largest(&self.residual);
            self.start.copy_from_slice(force);
            self.newton.copy_from_slice(&self.residual);
            let mut damping = 1.0;
            loop {
                for (f, (start, newton)) in force.iter_mut().zip(self.start.iter().zip(&self.newton)) {
                    *f = start - damping * newton;
                }
                let now = self.evaluate(system, geometry, active, force);
                if now <= size || now <= TOLERANCE * scale || damping < SHORTEST {
                    size = now;
                    break;
                }
                damping *= 0.5;
            }
            let done = TOLERANCE * scale.max(f64::MIN_POSITIVE);
            if change <= done || size <= (0.1 * done).max(self.slack * scale) {
                return true;
            }
        }
        // The residual may stall at rounding; accept it where it is small beside the forces.
        size <= 1e-9 * largest(force)
    }

    /// Newton's change, in `residual`, from the rows that [`Problem::evaluate`] listed; the others are those of the
    /// identity and are eliminated beforehand.
    fn solve_acting(&mut self) -> bool {
        let (m, count) = (self.residual.len(), self.index.len());
        for (row, &i) in self.index.iter().enumerate() {
            let line = &self.matrix[i * m..(i + 1) * m];
            self.change[row] = self.residual[i];
            for (j, entry) in line.iter().enumerate().filter(|(j, _)| !self.listed[*j]) {
                self.change[row] -= entry * self.residual[j];
            }
            for (entry, &j) in self.compact[row * count..(row + 1) * count].iter_mut().zip(&self.index) {
                *entry = line[j];
            }
        }
        let solved = solve_general(&mut self.compact[..count * count], &mut self.change[..count]);
        for (row, &i) in self.index.iter().enumerate() {
            self.residual[i] = self.change[row];
        }
        solved
    }

    /// Row `i` of the Jacobian is to be filled: the identity's to begin with.
    fn list(&mut self, i: usize) {
        let m = self.residual.len();
        self.index.push(i);
        self.listed[i] = true;
        self.matrix[i * m..(i + 1) * m].fill(0.0);
        self.matrix[i * m + i] = 1.0;
    }

    /// Fills the residual F - law(F) and its Jacobian; returns the residual's largest entry.
    fn evaluate(&mut self, system: &System, geometry: &Geometry, active: &[bool], force: &[f64]) -> f64 {
        let m = force.len();
        self.index.clear();
        self.listed.fill(false);
        self.residual.fill(0.0);
        for (i, normal) in system.normals.iter().enumerate() {
            if self.known[i] || !active[i] {
                continue;
            }
            self.list(i);
            let LawPoint { force: law, by_penetration, by_rate } =
                system.law(i).at(self.penetration(i, force), self.rate(i, force));
            let scale = normal.count() * geometry.share[i][0];
            self.residual[i] = force[i] - scale * law;
            for j in 0..m {
                self.matrix[i * m + j] +=
                    scale * (by_penetration * self.w[i * m + j] + by_rate * self.y[i * m + j]);
            }
        }
        for (index, &w) in system.laterals.iter().enumerate() {
            let i = system.lateral(index);
            let kind = &system.scene.wheels[system.wheels[w].kind];
            let Some(flange) = &kind.flange else { continue };
            let overlap = if self.asleep[i] { 0.0 } else { flange.overlap(self.penetration(i, force)) };
            if overlap == 0.0 {
                self.residual[i] = force[i];
                continue;
            }
            self.list(i);
            let normal = system.normals_of(w).next().unwrap_or(0);
            let (share, by_height) = flange.share(kind.radius - self.penetration(normal, force));
            self.residual[i] = force[i] - flange.stiffness * share * overlap;
            for j in 0..m {
                self.matrix[i * m + j] += flange.stiffness
                    * (share * self.w[i * m + j] - by_height * overlap * self.w[normal * m + j]);
            }
        }
        for (index, &w) in system.tractions.iter().enumerate() {
            let i = system.traction(index);
            let Some(friction) = &system.scene.wheels[system.wheels[w].kind].friction else { continue };
            self.list(i);
            let (share, by_slip) = friction.share(self.rate(i, force));
            let load: f64 = system.normals_of(w).map(|n| force[n] / system.normals[n].count()).sum();
            let bound = friction.coefficient * load;
            if self.pin(i, bound, force) {
                continue;
            }
            let (share, by_slip) = if let Some(wanted) = self.wanted(i, force) {
                (wanted.signum(), 0.0)
            } else {
                (share, by_slip)
            };
            self.residual[i] = force[i] - friction.coefficient * load * share;
            for j in 0..m {
                self.matrix[i * m + j] += friction.coefficient * load * by_slip * self.y[i * m + j];
            }
            for n in system.normals_of(w) {
                self.matrix[i * m + n] -= friction.coefficient * share / system.normals[n].count();
            }
        }
        for (index, pull) in system.pulls.iter().enumerate() {
            let i = system.pull(index);
            if !geometry.pulls[index] {
                self.residual[i] = force[i];
                continue;
            }
            self.list(i);
            let (own, traction) = (self.y[i * m + i], pull.traction(force));
            let by_traction = if let Some(wanted) = self.wanted(i, force) {
                let (law, _, by_traction) = pull.at(SATURATED.copysign(wanted), traction);
                if self.pin(i, law.abs(), force) {
                    continue;
                }
                self.residual[i] = force[i] - law;
                by_traction
            } else if let Some(driven) = pull.drive(force[i], self.rate(i, force), own, traction) {
                self.residual[i] = force[i] - driven.force;
                self.matrix[i * m + i] -= driven.by_force;
                for j in 0..m {
                    self.matrix[i * m + j] += driven.by_rate * self.y[i * m + j];
                }
                driven.by_traction
            } else {
                let (law, by_rate, by_traction) = pull.at(self.rate(i, force), traction);
                self.residual[i] = force[i] - law;
                for j in 0..m {
                    self.matrix[i * m + j] += by_rate * self.y[i * m + j];
                }
                by_traction
            };
            for grip in pull.grips.iter().filter(|grip| force[grip.normal] > 0.0) {
                self.matrix[i * m + grip.normal] -= by_traction * grip.mu;
            }
        }
        for (index, hold) in geometry.links.iter().enumerate() {
            let i = system.link(index);
            if !hold.taut {
                self.residual[i] = force[i];
                continue;
            }
            self.list(i);
            self.residual[i] = force[i] - hold.law(self.penetration(i, force), self.rate(i, force));
            for j in 0..m {
                self.matrix[i * m + j] +=
                    hold.stiffness * self.w[i * m + j] + hold.damping * self.y[i * m + j];
            }
        }
        largest(&self.residual)
    }
}

impl Problem {
    /// Force of a pinned component that keeps the give of its rail, beside the others of `force`.
    fn wanted(&self, i: usize, force: &[f64]) -> Option<f64> {
        let give = self.pinned[i]?;
        let own = self.w[i * force.len() + i];
        Some(force[i] + (give - along(&self.w, i, force)) / own)
    }

    /// The row of a pinned component whose force is within `bound`; false for others.
    fn pin(&mut self, i: usize, bound: f64, force: &[f64]) -> bool {
        let Some(wanted) = self.wanted(i, force).filter(|wanted| wanted.abs() <= bound) else { return false };
        let m = force.len();
        let own = self.w[i * m + i];
        self.residual[i] = force[i] - wanted;
        for j in (0..m).filter(|&j| j != i) {
            self.matrix[i * m + j] += self.w[i * m + j] / own;
        }
        true
    }
}

/// Largest absolute entry.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0_f64, |max, value| max.max(value.abs()))
}
