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
use crate::numerics::dense::{dot, solve_general, solve_spd};
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
    /// Influence of the force at another (node, element) on approach and rate, and whether it has been used.
    has_effects: bool,
    effect: Vec<f64>,
    rate_effect: Vec<f64>,
    matrix: Vec<f64>,
    /// Right sides and solutions.
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
        let mut compliances = system.foundations.iter().filter_map(|own| own.compliance.as_ref());
        NodeForces {
            approach: vec![0.0; size],
            rate: vec![0.0; size],
            force: vec![0.0; size],
            is_symmetric: compliances.all(|compliance| compliance.is_symmetric()),
            has_effects: false,
            effect: Vec::new(),
            rate_effect: Vec::new(),
            matrix: Vec::new(),
            right: Vec::new(),
            tangents: Vec::new(),
            index: Vec::with_capacity(size),
        }
    }

    /// Solves for the forces of the active contacts in `motion`. Returns false if none are found.
    pub fn solve(&mut self, solver: &Solver, motion: &NodeMotion) -> bool {
        let active = solver.active_contacts().collect::<Vec<_>>();
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
            self.fill_effects(solver.system(), motion, &active);
            self.solve_for_forces(solver, motion, &active)
        } else {
            self.eliminate_forces(solver, motion, &active)
        }
    }

    /// Eliminates the forces of the `active` contacts first; see the head of this module.
    fn eliminate_forces(&mut self, solver: &Solver, motion: &NodeMotion, active: &[usize]) -> bool {
        let (system, s, n, m) = (solver.system(), motion.nodes.count(), motion.dofs(), active.len());
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
                self.matrix[line * m + line] += 1.0 / (law.stiffness * system.mechanics.groups[i].count());
                right[line] = self.approach[a * all + i] + ratio * self.rate[a * all + i];
                let rows = geometry.rows();
                for (r, (by_q, by_v)) in rows.approach_row(i).iter().zip(rows.rate_row(i)).enumerate() {
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
                            let by_unit =
                                by_q * right[(1 + r) * m + line] + by_v * right[(1 + n + r) * m + line];
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
                    for (r, ([by_q, by_v], u)) in motion.responses(a, b).iter().zip(own).enumerate() {
                        let by_unit = by_q * right[(1 + r) * m + line] + by_v * right[(1 + n + r) * m + line];
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
        let (s, m) = (motion.nodes.count(), motion.from.force.len());
        let size = s * m;
        self.effect.resize(size * size, 0.0);
        self.rate_effect.resize(size * size, 0.0);
        let n = motion.dofs();
        let is_constant = system.traits.has_constant_rows && n > 0;
        let mut constant = Vec::new();
        if is_constant {
            let rows = motion.geometries[0].rows();
            for i in 0..m {
                let along = |&j: &usize| {
                    [rows.approach_row(i), rows.rate_row(i)].map(|row| dot(row, motion.spread(0, j)))
                };
                constant.extend(active.iter().map(along));
            }
        }
        let (mut by_load, mut by_load_rate) = (vec![0.0; n], vec![0.0; n]);
        // Approach and rate of one contact by unit forces of the active ones, without the compliance.
        let mut by_force: Vec<[f64; 2]> = Vec::with_capacity(active.len());
        for a in 0..s {
            let geometry = &motion.geometries[a];
            for i in 0..m {
                let (row, rate_row) = (geometry.rows().approach_row(i), geometry.rows().rate_row(i));
                let feels_rates = system.fixed[i].feels_rates;
                for b in 0..s {
                    by_force.clear();
                    if is_constant {
                        let [by_q, by_v] = motion.responses(a, b)[0];
                        let own = constant[i * active.len()..].iter().take(active.len());
                        by_force.extend(own.map(|[approach, rate]| [by_q * approach, by_v * rate]));
                    } else {
                        let responses = row.iter().zip(rate_row).zip(motion.responses(a, b));
                        let own = by_load.iter_mut().zip(by_load_rate.iter_mut()).zip(responses);
                        for ((by_load, by_load_rate), ((row, rate_row), [by_q, by_v])) in own {
                            (*by_load, *by_load_rate) = (row * by_q, rate_row * by_v);
                        }
                        by_force.extend(active.iter().map(|&j| {
                            let spread = motion.spread(b, j);
                            [
                                dot(&by_load, spread),
                                if feels_rates { dot(&by_load_rate, spread) } else { 0.0 },
                            ]
                        }));
                    }
                    let place = (a * m + i) * size + b * m;
                    for (&j, [approach, rate]) in active.iter().zip(&by_force) {
                        let compliance_here = if a == b { geometry.rails().value[i * m + j] } else { 0.0 };
                        self.effect[place + j] = compliance_here + approach;
                        self.rate_effect[place + j] = *rate;
                    }
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
        self.index.extend((0..s).flat_map(|a| active.iter().map(move |i| a * all + i)));
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
        let (s, size) = (motion.nodes.count(), self.force.len());
        let mut tangents = std::mem::take(&mut self.tangents);
        tangents.clear();
        let tangent = |&at: &usize| {
            let (a, i) = (at / m, at % m);
            let law = system.law(i);
            if law.is_linear() {
                return Tangent { by_penetration: law.stiffness, by_rate: law.damping, rest: 0.0 };
            }
            let penetration = |l: usize| self.penetration(l * m + i);
            let [p, rate] = if is_first {
                [from.p[i], from.p_rate[i]]
            } else if solver.remembers(i) {
                let by = |l: usize| motion.nodes.rate[a * s + l] / motion.h;
                [penetration(a), (0..s).map(|l| by(l) * (penetration(l) - from.p[i])).sum()]
            } else {
                let feels_rates = system.fixed[i].feels_rates;
                let effects =
                    feels_rates.then(|| dot(&self.rate_effect[at * size..(at + 1) * size], &self.force));
                [penetration(a), self.rate[at] - effects.unwrap_or(0.0)]
            };
            let LawValue { force, by_penetration, by_rate } = law.at(p, rate);
            Tangent { by_penetration, by_rate, rest: force - by_penetration * p - by_rate * rate }
        };
        tangents.extend(self.index.iter().map(tangent));
        self.tangents = tangents;
    }

    /// Solves for the forces at all nodes by the tangents of their laws; the solution replaces the right side.
    fn solve_tangents(&mut self, solver: &Solver, motion: &NodeMotion) -> bool {
        let (system, NodeMotion { nodes, h, from, .. }) = (solver.system(), motion);
        let (s, m, size) = (nodes.count(), system.elements.len(), self.force.len());
        let count = self.index.len();
        self.matrix.resize(count * count, 0.0);
        self.right.resize(count, 0.0);
        for (line, (&at, tangent)) in self.index.iter().zip(&self.tangents).enumerate() {
            let (a, i) = (at / m, at % m);
            let Tangent { by_penetration, by_rate, rest } = *tangent;
            let memory = solver.remembers(i);
            let by = |l: usize| nodes.rate[a * s + l] * by_rate / h;
            let mut right = rest + by_penetration * self.approach[at];
            if memory {
                right += (0..s).map(|l| by(l) * (self.approach[l * m + i] - from.p[i])).sum::<f64>();
            } else {
                right += by_rate * self.rate[at];
            }
            for (column, &other) in self.index.iter().enumerate() {
                let mut entry = by_penetration * self.effect[at * size + other];
                if memory {
                    entry += (0..s).map(|l| by(l) * self.effect[(l * m + i) * size + other]).sum::<f64>();
                } else if system.fixed[i].feels_rates {
                    entry += by_rate * self.rate_effect[at * size + other];
                }
                self.matrix[line * count + column] = entry;
            }
            self.matrix[line * count + line] += 1.0 / system.mechanics.groups[i].count();
            self.right[line] = right;
        }
        solve_general(&mut self.matrix[..count * count], &mut self.right[..count])
    }

    /// Penetration at a (node, element) by the influence of all forces.
    fn penetration(&self, place: usize) -> f64 {
        let size = self.force.len();
        self.approach[place] - dot(&self.effect[place * size..(place + 1) * size], &self.force)
    }

    /// Sets the forces and penetrations of `at` at node `a`, p = e - (G + R Q S) F, where the influence of the forces is known,
    /// because it rounds least, and p = R q + offset - G F at its displacements q otherwise.
    pub fn penetrate(&self, a: usize, geometry: &Geometry, at: &mut State) {
        let m = at.force.len();
        at.force.copy_from_slice(&self.force[a * m..(a + 1) * m]);
        for i in 0..m {
            at.p[i] =
                if self.has_effects { self.penetration(a * m + i) } else { geometry.penetration(i, at) };
        }
    }
}
