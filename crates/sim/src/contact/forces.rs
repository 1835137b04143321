//! Contact forces of one instant or one stage of a step: F = law(e - W F, r - Y F).
//!
//! Every component presses with a law of its approach p = e - W F and rate r - Y F: W holds the rail's give
//! G and, inside a step, the bodies' mobility; Y the mobility that the rates feel. Which vertical contacts
//! act is given; the caller checks that they push and that the others stay open.

use crate::contact::geometry::Geometry;
use crate::contact::system::System;
use crate::numerics::dense::{along, factor_general, solve_factored, solve_general, solve_spd};

/// Relative change of the forces at which Newton's method ends.
const TOLERANCE: f64 = 1e-13;
const ITERATIONS: usize = 60;
/// Share of Newton's change below which a smaller one is not tried. A brake on a rail that gives grips within 1e-6 of the
/// forces on either side, and less in short steps.
const SHORTEST: f64 = 1e-12;

/// Slopes of the law of a component.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Slope {
    pub by_penetration: f64,
    pub by_rate: f64,
    /// Another component, and the slope by its penetration.
    pub by_other: Option<(usize, f64)>,
}

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
    /// Penetration and rate of each component under the forces at hand; not kept of those asleep.
    pub reach: Vec<[f64; 2]>,
    /// Largest force of what does not act.
    pub idles: f64,
    /// Of every component, F - law(F); then Newton's change.
    pub residual: Vec<f64>,
    /// Components whose law acts, the slopes of these laws, and what forces do to the laws of others.
    pub acting: Vec<usize>,
    pub slopes: Vec<Slope>,
    pub grips: Vec<(usize, usize, f64)>,
    /// Factors of the Jacobian over the components that acted when it was formed.
    pub factored: Vec<usize>,
    jacobian: Vec<f64>,
    pivots: Vec<usize>,
    matrix: Vec<f64>,
    start: Vec<f64>,
    newton: Vec<f64>,
    change: Vec<f64>,
    /// Unknowns of the linear problem.
    index: Vec<usize>,
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
            reach: vec![[0.0; 2]; m],
            idles: 0.0,
            residual: vec![0.0; m],
            acting: Vec::with_capacity(m),
            slopes: Vec::with_capacity(m),
            grips: Vec::new(),
            factored: Vec::with_capacity(m),
            jacobian: vec![0.0; m * m],
            pivots: vec![0; m],
            matrix: vec![0.0; m * m],
            start: vec![0.0; m],
            newton: vec![0.0; m],
            change: vec![0.0; m],
            index: Vec::with_capacity(m),
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
        if system.linear_normals && force.len() == system.mechanics.groups.len() {
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
        self.factored.clear();
        self.index.clear();
        self.index.extend((0..m).filter(|&i| active[i] && !self.known[i]));
        let count = self.index.len();
        for (row, &i) in self.index.iter().enumerate() {
            let normal = &system.mechanics.groups[i];
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
            if !self.factor() {
                return false;
            }
            self.step_back();
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

    /// Residual of the laws under `force`, by W and Y; returns its largest entry.
    fn evaluate(&mut self, system: &System, geometry: &Geometry, active: &[bool], force: &[f64]) -> f64 {
        for i in 0..force.len() {
            if i < system.mechanics.groups.len() || !self.asleep[i] {
                self.reach[i] = [self.penetration(i, force), self.rate(i, force)];
            }
        }
        self.answer(system, geometry, active, force);
        largest(&self.residual)
    }

    /// Factors the Jacobian of the laws that [`Problem::answer`] found to act: I + F_p W + F_r Y, less what the laws take
    /// from other forces. Returns false where it is singular.
    fn factor(&mut self) -> bool {
        let (m, count) = (self.residual.len(), self.acting.len());
        for (row, &i) in self.acting.iter().enumerate() {
            let line = &mut self.jacobian[row * count..(row + 1) * count];
            let (w, y) = (&self.w[i * m..(i + 1) * m], &self.y[i * m..(i + 1) * m]);
            let Slope { by_penetration, by_rate, by_other } = self.slopes[row];
            for (entry, &j) in line.iter_mut().zip(&self.acting) {
                *entry = by_penetration * w[j] + by_rate * y[j];
            }
            if let Some((other, slope)) = by_other {
                let w = &self.w[other * m..(other + 1) * m];
                line.iter_mut().zip(&self.acting).for_each(|(entry, &j)| *entry += slope * w[j]);
            }
            line[row] += 1.0;
        }
        self.factored.clear();
        self.factored.extend_from_slice(&self.acting);
        for &(i, j, slope) in &self.grips {
            let place = |of| self.acting.iter().position(|own| *own == of);
            if let (Some(row), Some(column)) = (place(i), place(j)) {
                self.jacobian[row * count + column] -= slope;
            }
        }
        factor_general(&mut self.jacobian[..count * count], &mut self.pivots[..count])
    }

    /// Newton's change of the forces in place of their residual, by the factors of the Jacobian. What does not act has the
    /// rows of the identity.
    pub fn step_back(&mut self) {
        let (m, count) = (self.residual.len(), self.factored.len());
        let idle = self.idles > 0.0;
        for (row, &i) in self.factored.iter().enumerate() {
            self.change[row] = self.residual[i];
            if idle {
                let Slope { by_penetration, by_rate, .. } = self.slopes[row];
                for j in (0..m).filter(|j| !self.factored.contains(j)) {
                    let entry = by_penetration * self.w[i * m + j] + by_rate * self.y[i * m + j];
                    self.change[row] -= entry * self.residual[j];
                }
            }
        }
        solve_factored(&self.jacobian[..count * count], &self.pivots[..count], &mut self.change[..count]);
        for (row, &i) in self.factored.iter().enumerate() {
            self.residual[i] = self.change[row];
        }
    }
}

/// Largest absolute entry.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0_f64, |max, value| max.max(value.abs()))
}
