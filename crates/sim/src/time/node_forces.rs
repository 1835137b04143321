//! Contact forces at all nodes of a collocation step.
//!
//! With the forces F_a at node a, the approach e_a without forces, the compliance G_a of the rails, the rows R_a, the
//! accelerations S_b = M^-1 R_b^T by unit forces at node b, and the responses Q_ab and V_ab of displacements and speeds at
//! node a to accelerations at node b, linear contacts of stiffness k with dampers c to ground give
//!
//! F_a/k + G_a F_a + sum_b (R_a Q_ab + (c/k) R'_a V_ab) S_b F_b = e_a + (c/k) r_a.
//!
//! The system is solved in one of two ways. Either as one dense system in all forces, which takes (s m)^3 operations for m
//! contacts at s nodes. Or the forces are eliminated first: with K_a = 1/k + G_a and the accelerations u_b = S_b F_b
//!
//! F_a = K_a^-1 (e_a + (c/k) r_a - sum_b (R_a Q_ab + (c/k) R'_a V_ab) u_b),
//!
//! u_a + S_a K_a^-1 sum_b (R_a Q_ab + (c/k) R'_a V_ab) u_b = S_a K_a^-1 (e_a + (c/k) r_a),
//!
//! which takes s m^3/3 + (s n)^3 operations for n degrees of freedom: a train of many wheels has few of these. Dampers
//! between wheel and rail couple the compliance of all nodes; they and unsymmetric compliances take the first way. So do
//! laws that are not linear: Newton's method replaces each by its tangent at every node, and the influence of the forces on
//! the penetrations is the same in all iterations.

use super::nodes::Nodes;
use crate::contact::geometry::Geometry;
use crate::contact::solver::Solver;
use crate::contact::system::System;
use crate::mechanics::state::State;
use crate::numerics::dense::{along, dot, solve_general, solve_spd};
use crate::scene::wheel::LawValue;

/// Advantage in operations from which the forces are eliminated first.
const CHEAPER: f64 = 2.0;

/// Number of Newton iterations at most for laws that are not linear.
const ITERATIONS: usize = 12;

/// Change of the forces, relative to the largest of them, from which the next iterate, whose change would be about the square
/// of it, is not needed.
const CONVERGED: f64 = 1e-9;

/// The system of the forces at all nodes, and its solution.
pub(crate) struct NodeForces {
    /// Approach in the free motion and its rate as the damper feels it, for each (node, element).
    pub approach: Vec<f64>,
    pub rate: Vec<f64>,
    /// The forces, for each (node, element).
    pub force: Vec<f64>,
    /// Whether the compliance of every structure is symmetric.
    is_symmetric: bool,
    /// The active contacts.
    active: Vec<usize>,
    /// Influence of the unknown forces, node by node those of the active contacts, on approach and rate of each (node,
    /// element), and whether it has been used.
    has_effects: bool,
    effect: Vec<f64>,
    rate_effect: Vec<f64>,
    /// R S^T for approaches and rates, where it is the same for all nodes: elements x active contacts.
    constant: [Vec<f64>; 2],
    /// A row of the approach or of its rate by the loads at one node.
    by_load: Vec<f64>,
    matrix: Vec<f64>,
    /// Right sides and solutions: the unknown forces.
    right: Vec<f64>,
    /// The laws of the unknown forces near the last iterate.
    tangents: Vec<Tangent>,
    /// Positions of the unknown forces among all (node, element) pairs.
    index: Vec<usize>,
}

/// A law F = by_penetration p + by_rate r + rest for one wheel.
struct Tangent {
    by_penetration: f64,
    by_rate: f64,
    rest: f64,
}

/// The step in which the forces are sought.
pub(crate) struct NodeMotion<'s> {
    pub nodes: &'s Nodes,
    pub h: f64,
    pub from: &'s State,
    pub geometries: &'s [Geometry],
    /// S of every node, contacts x degrees of freedom.
    pub spread: &'s [f64],
    /// Q_ab and V_ab of every degree of freedom, (s + 1) x s x n.
    pub forced: &'s [[f64; 2]],
}

impl NodeMotion<'_> {
    /// Number of degrees of freedom.
    fn dofs(&self) -> usize {
        self.from.q.len()
    }

    /// Q_ab and V_ab.
    fn responses(&self, a: usize, b: usize) -> &[[f64; 2]] {
        let (s, n) = (self.nodes.count(), self.dofs());
        &self.forced[(a * s + b) * n..(a * s + b + 1) * n]
    }

    /// Accelerations of all degrees of freedom by a unit force of contact `j` at node `b`.
    fn spread(&self, b: usize, j: usize) -> &[f64] {
        let (n, m) = (self.dofs(), self.from.force.len());
        &self.spread[(b * m + j) * n..(b * m + j + 1) * n]
    }
}

impl NodeForces {
    /// The system of `count` nodes.
    pub fn new(system: &System, count: usize) -> Self {
        let size = count * system.elements.len();
        let mut compliances = system
            .foundations
            .iter()
            .filter_map(|own| own.compliance.as_ref());
        NodeForces {
            approach: vec![0.0; size],
            rate: vec![0.0; size],
            force: vec![0.0; size],
            is_symmetric: compliances.all(|compliance| compliance.is_symmetric()),
            active: Vec::new(),
            has_effects: false,
            effect: Vec::new(),
            rate_effect: Vec::new(),
            constant: Default::default(),
            by_load: Vec::new(),
            matrix: Vec::new(),
            right: Vec::new(),
            tangents: Vec::new(),
            index: Vec::with_capacity(size),
        }
    }

    /// Solves for the forces of the active contacts in `motion`. Returns false if none are found.
    pub fn solve(&mut self, solver: &Solver, motion: &NodeMotion) -> bool {
        let mut active = std::mem::take(&mut self.active);
        active.clear();
        active.extend(solver.active_contacts());
        let is_solved = self.solve_active(solver, motion, &active);
        self.active = active;
        is_solved
    }

    fn solve_active(&mut self, solver: &Solver, motion: &NodeMotion, active: &[usize]) -> bool {
        let (s, m, n) = (motion.nodes.count(), active.len(), motion.dofs());
        let [contacts, freedoms] = [m, n].map(|count| (s * count) as f64);
        let in_forces = 2.0 / 3.0 * contacts.powi(3) + contacts * contacts * n as f64;
        let columns = (2 * n + 1) as f64;
        let in_motion =
            contacts * (m as f64) * (m as f64 / 3.0 + 2.0 * columns) + 2.0 / 3.0 * freedoms.powi(3);
        let has_memory = active.iter().any(|&i| solver.remembers(i));
        self.force.fill(0.0);
        self.has_effects = !self.is_symmetric
            || has_memory
            || !solver.system().traits.has_linear_laws
            || CHEAPER * in_motion >= in_forces;
        if self.has_effects {
            self.fill_effects(solver.system(), motion, active);
            self.solve_for_forces(solver, motion, active)
        } else {
            self.eliminate_forces(solver, motion, active)
        }
    }

    /// Eliminates the forces of the `active` contacts first; see the head of this module.
    fn eliminate_forces(&mut self, solver: &Solver, motion: &NodeMotion, active: &[usize]) -> bool {
        let (system, s, n, m) = (
            solver.system(),
            motion.nodes.count(),
            motion.dofs(),
            active.len(),
        );
        let (all, width) = (system.elements.len(), (2 * n + 1) * m);
        self.right.clear();
        self.right.resize(s * width, 0.0);
        // u_a + sum_b E_ab u_b = d_a
        let (mut between, mut accelerations) = (vec![0.0; s * n * s * n], vec![0.0; s * n]);
        for a in 0..s {
            let geometry = &motion.geometries[a];
            let compliance = &geometry.rails().value;
            self.matrix.clear();
            for &i in active {
                let line = &compliance[i * all..(i + 1) * all];
                self.matrix.extend(active.iter().map(|&j| line[j]));
            }
            // the right side, then the columns of R and (c/k) R'
            let right = &mut self.right[a * width..(a + 1) * width];
            for (line, &i) in active.iter().enumerate() {
                let law = system.law(i);
                let ratio = law.damping / law.stiffness;
                self.matrix[line * m + line] +=
                    1.0 / (law.stiffness * system.mechanics.groups[i].count());
                right[line] = self.approach[a * all + i] + ratio * self.rate[a * all + i];
                let rows = geometry.rows();
                for (r, (by_q, by_v)) in rows
                    .approach_row(i)
                    .iter()
                    .zip(rows.rate_row(i))
                    .enumerate()
                {
                    right[(1 + r) * m + line] = *by_q;
                    right[(1 + n + r) * m + line] = ratio * by_v;
                }
            }
            if !solve_spd(&mut self.matrix, right) {
                return false;
            }
            for (line, &i) in active.iter().enumerate() {
                for (k, spread) in motion.spread(a, i).iter().enumerate() {
                    accelerations[a * n + k] += spread * right[line];
                    let own = &mut between[(a * n + k) * s * n..(a * n + k + 1) * s * n];
                    for b in 0..s {
                        for (r, [by_q, by_v]) in motion.responses(a, b).iter().enumerate() {
                            let by_unit = by_q * right[(1 + r) * m + line]
                                + by_v * right[(1 + n + r) * m + line];
                            own[b * n + r] += spread * by_unit;
                        }
                    }
                }
            }
        }
        (0..s * n).for_each(|k| between[k * s * n + k] += 1.0);
        if !solve_general(&mut between, &mut accelerations) {
            return false;
        }
        for a in 0..s {
            let right = &self.right[a * width..(a + 1) * width];
            for (line, &i) in active.iter().enumerate() {
                let mut force = right[line];
                for b in 0..s {
                    let own = &accelerations[b * n..(b + 1) * n];
                    for (r, ([by_q, by_v], u)) in motion.responses(a, b).iter().zip(own).enumerate()
                    {
                        let by_unit =
                            by_q * right[(1 + r) * m + line] + by_v * right[(1 + n + r) * m + line];
                        force -= by_unit * u;
                    }
                }
                self.force[a * all + i] = force;
            }
        }
        true
    }

    /// Fills the influence of the forces of the `active` contacts on the approaches of all, and on the rates of those with a
    /// damper to ground. Where rows are constant, no degree of freedom is a natural mode: all bodies respond alike, and one
    /// product R S^T serves for all pairs of nodes.
    fn fill_effects(&mut self, system: &System, motion: &NodeMotion, active: &[usize]) {
        let (s, m, n) = (motion.nodes.count(), motion.from.force.len(), motion.dofs());
        let is_constant = system.traits.has_constant_rows && n > 0;
        if is_constant {
            let rows = motion.geometries[0].rows();
            for (constant, own) in self.constant.iter_mut().zip([&rows.approach, &rows.rate]) {
                constant.clear();
                for i in 0..m {
                    constant.extend(active.iter().map(|&j| along(own, i, motion.spread(0, j))));
                }
            }
        }
        let (count, width) = (active.len(), s * active.len());
        for effects in [&mut self.effect, &mut self.rate_effect] {
            effects.clear();
            effects.resize(s * m * width, 0.0);
        }
        let mut lines = self
            .effect
            .chunks_exact_mut(width.max(1))
            .zip(self.rate_effect.chunks_exact_mut(width.max(1)));
        for (a, geometry) in motion.geometries.iter().enumerate() {
            let rows = geometry.rows();
            for (i, (effect, rate_effect)) in lines.by_ref().take(m).enumerate() {
                let feels_rates = system.fixed[i].feels_rates;
                for b in 0..s {
                    let own = b * count..(b + 1) * count;
                    let (effect, rate_effect) = (&mut effect[own.clone()], &mut rate_effect[own]);
                    if is_constant {
                        let [by_q, by_v] = motion.responses(a, b)[0];
                        let [approach, rate] = self
                            .constant
                            .each_ref()
                            .map(|own| &own[i * count..(i + 1) * count]);
                        effect
                            .iter_mut()
                            .zip(approach)
                            .for_each(|(effect, own)| *effect = by_q * own);
                        if feels_rates {
                            rate_effect
                                .iter_mut()
                                .zip(rate)
                                .for_each(|(effect, own)| *effect = by_v * own);
                        }
                        continue;
                    }
                    let mut fill = |out: &mut [f64], row: &[f64], part: usize| {
                        let responses = motion.responses(a, b).iter();
                        self.by_load.clear();
                        self.by_load
                            .extend(row.iter().zip(responses).map(|(row, own)| row * own[part]));
                        let sums = active
                            .iter()
                            .map(|&j| dot(&self.by_load, motion.spread(b, j)));
                        out.iter_mut().zip(sums).for_each(|(out, sum)| *out = sum);
                    };
                    fill(effect, rows.approach_row(i), 0);
                    if feels_rates {
                        fill(rate_effect, rows.rate_row(i), 1);
                    }
                }
                let compliance = &geometry.rails().value[i * m..(i + 1) * m];
                for (effect, &j) in effect[a * count..(a + 1) * count].iter_mut().zip(active) {
                    *effect += compliance[j];
                }
            }
        }
    }

    /// Solves the laws F = f(p, r) of the `active` contacts at every node, where p = approach - effect F, and r is the rate
    /// of p for a damper between wheel and rail and the rate of the wheel otherwise. Linear laws need one solution; for
    /// others Newton's method begins with the state at the start of the step at all nodes. Returns false if a matrix is
    /// singular, or if the forces do not converge.
    fn solve_for_forces(&mut self, solver: &Solver, motion: &NodeMotion, active: &[usize]) -> bool {
        let (s, all) = (motion.nodes.count(), motion.from.force.len());
        self.index.clear();
        self.index
            .extend((0..s).flat_map(|a| active.iter().map(move |i| a * all + i)));
        let is_linear = solver.system().traits.has_linear_laws;
        for round in 0..if is_linear { 1 } else { ITERATIONS } {
            self.set_tangents(solver, motion, round == 0);
            if !self.solve_tangents(solver, motion) {
                return false;
            }
            let (mut change, mut largest) = (0.0_f64, 0.0_f64);
            for (&at, &force) in self.index.iter().zip(&self.right) {
                change = change.max((force - self.force[at]).abs());
                largest = largest.max(force.abs());
                self.force[at] = force;
            }
            if !change.is_finite() {
                return false;
            }
            if is_linear || change <= CONVERGED * largest {
                return true;
            }
        }
        false
    }

    /// Sets the tangents of the laws at the present forces, or at the state at the start of the step if this `is_first`.
    fn set_tangents(&mut self, solver: &Solver, motion: &NodeMotion, is_first: bool) {
        let (system, from, m) = (solver.system(), motion.from, motion.from.force.len());
        let s = motion.nodes.count();
        let mut tangents = std::mem::take(&mut self.tangents);
        tangents.clear();
        let tangent = |&at: &usize| {
            let (a, i) = (at / m, at % m);
            let law = system.law(i);
            if law.is_linear() {
                return Tangent {
                    by_penetration: law.stiffness,
                    by_rate: law.damping,
                    rest: 0.0,
                };
            }
            let penetration = |l: usize| self.penetration(l * m + i);
            let [p, rate] = if is_first {
                [from.p[i], from.p_rate[i]]
            } else if solver.remembers(i) {
                let by = |l: usize| motion.nodes.rate[a * s + l] / motion.h;
                [
                    penetration(a),
                    (0..s).map(|l| by(l) * (penetration(l) - from.p[i])).sum(),
                ]
            } else {
                let feels_rates = system.fixed[i].feels_rates;
                let effects = feels_rates.then(|| along(&self.rate_effect, at, &self.right));
                [penetration(a), self.rate[at] - effects.unwrap_or(0.0)]
            };
            let LawValue {
                force,
                by_penetration,
                by_rate,
            } = law.at(p, rate);
            Tangent {
                by_penetration,
                by_rate,
                rest: force - by_penetration * p - by_rate * rate,
            }
        };
        tangents.extend(self.index.iter().map(tangent));
        self.tangents = tangents;
    }

    /// Solves for the forces at all nodes by the tangents of their laws; the solution replaces the right side.
    fn solve_tangents(&mut self, solver: &Solver, motion: &NodeMotion) -> bool {
        let (system, NodeMotion { nodes, h, from, .. }) = (solver.system(), motion);
        let (s, m, count) = (nodes.count(), system.elements.len(), self.index.len());
        self.matrix.clear();
        self.right.clear();
        for (line, (&at, tangent)) in self.index.iter().zip(&self.tangents).enumerate() {
            let (a, i) = (at / m, at % m);
            let Tangent {
                by_penetration,
                by_rate,
                rest,
            } = *tangent;
            let mut right = rest + by_penetration * self.approach[at];
            let effects = |at: usize| &self.effect[at * count..(at + 1) * count];
            let first = self.matrix.len();
            self.matrix
                .extend(effects(at).iter().map(|effect| by_penetration * effect));
            let row = &mut self.matrix[first..];
            if solver.remembers(i) {
                for (l, weight) in nodes.rate[a * s..(a + 1) * s].iter().enumerate() {
                    let (at, weight) = (l * m + i, weight * by_rate / h);
                    right += weight * (self.approach[at] - from.p[i]);
                    row.iter_mut()
                        .zip(effects(at))
                        .for_each(|(entry, effect)| *entry += weight * effect);
                }
            } else {
                right += by_rate * self.rate[at];
                if system.fixed[i].feels_rates {
                    let effects = &self.rate_effect[at * count..(at + 1) * count];
                    row.iter_mut()
                        .zip(effects)
                        .for_each(|(entry, effect)| *entry += by_rate * effect);
                }
            }
            row[line] += 1.0 / system.mechanics.groups[i].count();
            self.right.push(right);
        }
        solve_general(&mut self.matrix, &mut self.right)
    }

    /// Penetration at a (node, element) by the influence of the unknown forces.
    fn penetration(&self, place: usize) -> f64 {
        self.approach[place] - along(&self.effect, place, &self.right)
    }

    /// Sets the forces and penetrations of `at` at node `a`, p = e - (G + R Q S) F, where the influence of the forces is known,
    /// because it rounds least, and p = R q + offset - G F at its displacements q otherwise.
    pub fn penetrate(&self, a: usize, geometry: &Geometry, at: &mut State) {
        let m = at.force.len();
        at.force.copy_from_slice(&self.force[a * m..(a + 1) * m]);
        for i in 0..m {
            at.p[i] = if self.has_effects {
                self.penetration(a * m + i)
            } else {
                geometry.penetration(i, at)
            };
        }
    }
}
