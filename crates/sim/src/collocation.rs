//! A step of force-form collocation: the contact forces at all nodes at once, from one linear system.
//!
//! Bodies answer to the forces by the collocation's double integrals, modes by their exact propagators, so that a
//! step resolves the forces and not the modes: q(c_i h) = free motion - sum_j W_ij R_j^T F_j.

use nalgebra::DVector;

use crate::dense::{dot, solve_general};
use crate::energy::power;
use crate::nodes::Nodes;
use crate::propagator::Propagator;
use crate::solver::Solver;
use crate::state::State;
use crate::system::System;
use crate::{Dynamics, Error, Exchanged};

/// Everything a step needs; n freedoms, m components, s nodes.
pub(crate) struct Collocation {
    nodes: Nodes,
    /// omega and zeta of each freedom; omega 0: a body's.
    modes: Vec<[f64; 2]>,
    h: f64,
    /// Answers to the start: q by q0, q by v0, v by q0, v by v0; (s + 1) x n.
    free: Vec<[f64; 4]>,
    /// Answers q and v to the load at every node; (s + 1) x s x n.
    forced: Vec<[f64; 2]>,
    /// Rows at the nodes, s x m x n, and what a force there does: M^-1 R^T.
    rows: Vec<f64>,
    spread: Vec<f64>,
    /// Loads by M^-1 at the nodes, s x n: first without contacts, then with them; and at the start.
    load: Vec<DVector<f64>>,
    load_start: DVector<f64>,
    scratch: DVector<f64>,
    /// Free approach and its rate as the damper feels it at (node, component), and what a force at another takes.
    approach: Vec<f64>,
    rate: Vec<f64>,
    take: Vec<f64>,
    take_rate: Vec<f64>,
    matrix: Vec<f64>,
    force: Vec<f64>,
    index: Vec<usize>,
    states: Vec<State>,
    powers: Vec<Exchanged>,
}

impl Collocation {
    pub fn new(system: &System, nodes: Nodes, start: &State) -> Self {
        let (n, m, s) = (system.freedoms, system.components(), nodes.count());
        let mut modes = vec![[0.0; 2]; n];
        for (range, foundation) in system.structure.iter().zip(system.foundations) {
            if let Some(Dynamics::Modes { omega, ratio }) = foundation.structure.as_ref().map(|s| &s.dynamics)
            {
                for (k, number) in range.clone().enumerate() {
                    modes[number] = [omega[k], ratio[k]];
                }
            }
        }
        let size = s * m;
        Collocation {
            modes,
            h: 0.0,
            free: vec![[0.0; 4]; (s + 1) * n],
            forced: vec![[0.0; 2]; (s + 1) * s * n],
            rows: vec![0.0; size * n],
            spread: vec![0.0; size * n],
            load: vec![DVector::zeros(n); s],
            load_start: DVector::zeros(n),
            scratch: DVector::zeros(n),
            approach: vec![0.0; size],
            rate: vec![0.0; size],
            take: vec![0.0; size * size],
            take_rate: vec![0.0; size * size],
            matrix: vec![0.0; size * size],
            force: vec![0.0; size],
            index: Vec::with_capacity(size),
            states: vec![start.clone(); s],
            powers: vec![Exchanged::default(); s],
            nodes,
        }
    }

    /// Number of nodes.
    pub fn count(&self) -> usize {
        self.nodes.count()
    }

    /// Energy exchanged in the step, by the quadrature of the nodes.
    pub fn booked(&self) -> Exchanged {
        let s = self.count();
        let mut booked = Exchanged::default();
        for (power, weight) in self.powers.iter().zip(&self.nodes.a[s * s..]) {
            booked.add(power, self.h * weight);
        }
        booked
    }

    /// Takes a step of length `h` from `from` with the contacts that are active; false where it has no solution.
    pub fn attempt(
        &mut self,
        solver: &mut Solver,
        from: &State,
        h: f64,
        limit: f64,
        to: &mut State,
    ) -> Result<bool, Error> {
        self.set_step(h);
        let (s, n) = (self.count(), to.q.len());
        solver.geometry.update(solver.system, from.t, &from.q, &from.force)?;
        self.load_start.copy_from(solver.accelerate(from.t));
        self.add_forces(&solver.geometry.force_rows, &from.force, solver);
        for a in 0..s {
            let t = (from.t + self.nodes.c[a] * h).min(limit.next_down());
            self.states[a].t = t;
            solver.geometry.update(solver.system, t, &from.q, &from.force)?;
            self.load[a].copy_from(solver.accelerate(t));
            let (rows, span) =
                (&solver.geometry.rows, a * self.rows.len() / s..(a + 1) * self.rows.len() / s);
            self.rows[span.clone()].copy_from_slice(rows);
            for (row, spread) in rows.chunks_exact(n.max(1)).zip(self.spread[span].chunks_exact_mut(n.max(1)))
            {
                solver.spread_row(row, spread);
            }
            self.fill_give(solver, a);
        }
        self.fill_answers(solver, from);
        if !self.solve(solver, from) {
            return Ok(false);
        }
        self.book(solver, from, to, limit)
    }

    /// Answers of every freedom over a step of length `h`.
    fn set_step(&mut self, h: f64) {
        if h == self.h {
            return;
        }
        self.h = h;
        let (s, n) = (self.count(), self.modes.len());
        for (r, &[omega, zeta]) in self.modes.iter().enumerate() {
            let mode = (omega > 0.0).then(|| Propagator::new(omega, zeta, h));
            for i in 0..=s {
                let c = self.nodes.c[i];
                self.free[i * n + r] = mode.as_ref().map_or([1.0, c * h, 0.0, 1.0], |mode| mode.free(c));
                let powers = mode.as_ref().map(|mode| mode.forced(c));
                for b in 0..s {
                    self.forced[(i * s + b) * n + r] = match powers {
                        None => [h * h * self.nodes.a2[i * s + b], h * self.nodes.a[i * s + b]],
                        Some(powers) => [0, 1].map(|part| {
                            (0..s).map(|k| self.nodes.lagrange[b * s + k] * powers[k][part]).sum()
                        }),
                    };
                }
            }
        }
    }

    /// Adds what `force` does at the start.
    fn add_forces(&mut self, rows: &[f64], force: &[f64], solver: &Solver) {
        let n = self.modes.len();
        for (row, force) in rows.chunks_exact(n.max(1)).zip(force) {
            solver.spread_row(row, self.scratch.as_mut_slice());
            self.load_start.axpy(-force, &self.scratch, 1.0);
        }
    }

    /// The give of the compliance at node `a`, where the geometry is.
    fn fill_give(&mut self, solver: &Solver, a: usize) {
        let m = solver.system.components();
        let size = self.force.len();
        for i in 0..m {
            self.approach[a * m + i] = solver.geometry.held[i];
            self.rate[a * m + i] = solver.geometry.rate_held[i];
            let line = &mut self.take[(a * m + i) * size..(a * m + i + 1) * size];
            line.fill(0.0);
            line[a * m..(a + 1) * m].copy_from_slice(&solver.geometry.compliance[i * m..(i + 1) * m]);
        }
    }

    /// State of freedom `r` at target `i` under the loads at the nodes.
    fn answer(&self, from: &State, i: usize, r: usize) -> [f64; 2] {
        let (s, n) = (self.count(), self.modes.len());
        let [qq, qv, vq, vv] = self.free[i * n + r];
        let mut out = [qq * from.q[r] + qv * from.v[r], vq * from.q[r] + vv * from.v[r]];
        for b in 0..s {
            let [q, v] = self.forced[(i * s + b) * n + r];
            out[0] += q * self.load[b][r];
            out[1] += v * self.load[b][r];
        }
        out
    }

    fn fill_answers(&mut self, solver: &Solver, from: &State) {
        let (s, n, m) = (self.count(), self.modes.len(), solver.system.components());
        let size = s * m;
        for a in 0..s {
            for r in 0..n {
                let [q, v] = self.answer(from, a, r);
                (self.states[a].q[r], self.states[a].v[r]) = (q, v);
            }
            for i in 0..m {
                let row = &self.rows[(a * m + i) * n..(a * m + i + 1) * n];
                let rate_row = &solver.geometry.rate_rows[i * n..(i + 1) * n];
                self.approach[a * m + i] += dot(row, self.states[a].q.as_slice());
                self.rate[a * m + i] += dot(rate_row, self.states[a].v.as_slice());
                for b in 0..s {
                    let answers = &self.forced[(a * s + b) * n..(a * s + b + 1) * n];
                    for j in 0..m {
                        let spread = &self.spread[(b * m + j) * n..(b * m + j + 1) * n];
                        let (mut q, mut v) = (0.0, 0.0);
                        for (r, ([by_q, by_v], spread)) in answers.iter().zip(spread).enumerate() {
                            q += row[r] * by_q * spread;
                            v += rate_row[r] * by_v * spread;
                        }
                        self.take[(a * m + i) * size + b * m + j] += q;
                        self.take_rate[(a * m + i) * size + b * m + j] = v;
                    }
                }
            }
        }
    }

    /// F/k + p + (c/k) r = 0 at every node, p = approach - take F and r the rate of p or of the wheel.
    fn solve(&mut self, solver: &Solver, from: &State) -> bool {
        let system = solver.system;
        let (s, m, size) = (self.count(), system.components(), self.force.len());
        self.index.clear();
        self.index.extend((0..size).filter(|at| solver.active[at % m]));
        let count = self.index.len();
        self.force.fill(0.0);
        for (line, &at) in self.index.iter().enumerate() {
            let (a, i) = (at / m, at % m);
            let law = system.law(i);
            let ratio = law.damping / law.stiffness;
            let memory = solver.remembers(i);
            let by = |l: usize| self.nodes.rate[a * s + l] * ratio / self.h;
            let mut right = self.approach[at];
            if memory {
                right += (0..s).map(|l| by(l) * (self.approach[l * m + i] - from.p[i])).sum::<f64>();
            } else {
                right += ratio * self.rate[at];
            }
            for (column, &other) in self.index.iter().enumerate() {
                let mut entry = self.take[at * size + other];
                if memory {
                    entry += (0..s).map(|l| by(l) * self.take[(l * m + i) * size + other]).sum::<f64>();
                } else {
                    entry += ratio * self.take_rate[at * size + other];
                }
                self.matrix[line * count + column] = entry;
            }
            self.matrix[line * count + line] += 1.0 / (law.stiffness * system.normals[i].count());
            self.force[line] = right;
        }
        if !solve_general(&mut self.matrix[..count * count], &mut self.force[..count]) {
            return false;
        }
        // Spread over all components, from the last on: an index never lies before its line.
        for line in (0..count).rev() {
            let value = std::mem::take(&mut self.force[line]);
            self.force[self.index[line]] = value;
        }
        true
    }

    /// States at the nodes and at the end, and the powers exchanged.
    fn book(&mut self, solver: &mut Solver, from: &State, to: &mut State, limit: f64) -> Result<bool, Error> {
        let (s, n, m) = (self.count(), self.modes.len(), solver.system.components());
        let size = s * m;
        for (b, load) in self.load.iter_mut().enumerate() {
            for j in 0..m {
                let spread = &self.spread[(b * m + j) * n..(b * m + j + 1) * n];
                let force = self.force[b * m + j];
                load.iter_mut().zip(spread).for_each(|(load, spread)| *load -= spread * force);
            }
        }
        for at in 0..size {
            self.approach[at] -= dot(&self.take[at * size..(at + 1) * size], &self.force);
            self.states[at / m].p[at % m] = self.approach[at];
            self.states[at / m].force[at % m] = self.force[at];
        }
        for a in 0..s {
            for r in 0..n {
                let [q, v] = self.answer(from, a, r);
                (self.states[a].q[r], self.states[a].v[r]) = (q, v);
            }
            for i in 0..m {
                let rates =
                    (0..s).map(|l| self.nodes.rate[a * s + l] * (self.approach[l * m + i] - from.p[i]));
                self.states[a].p_rate[i] = rates.sum::<f64>() / self.h;
            }
            if !solver.instant(&mut self.states[a])? {
                return Ok(false);
            }
            self.powers[a] = power(solver.system, &solver.geometry, &self.states[a]);
        }
        to.copy_from(&self.states[s - 1]);
        to.t = from.t + self.h;
        for r in 0..n {
            let [q, v] = self.answer(from, s, r);
            (to.q[r], to.v[r]) = (q, v);
        }
        if self.nodes.c[s - 1] < 1.0 {
            to.t = to.t.min(limit.next_down());
            if !solver.instant(to)? {
                return Ok(false);
            }
        }
        Ok(to.q.iter().chain(to.v.iter()).all(|x| x.is_finite()))
    }

    /// Error of q and v of freedom `r`: what the loads of the last node add to those of a degree less.
    pub fn error(&self, r: usize) -> [f64; 2] {
        let (s, n) = (self.count(), self.modes.len());
        let mut jump = self.load[s - 1][r] - self.nodes.ahead[0] * self.load_start[r];
        for b in 1..s {
            jump -= self.nodes.ahead[b] * self.load[b - 1][r];
        }
        self.forced[(s * s + s - 1) * n + r].map(|answer| answer * jump)
    }
}
