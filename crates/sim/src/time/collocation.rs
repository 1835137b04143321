//! A step of collocation in force form: the contact forces at all nodes are found from one system.
//!
//! The unknowns are the forces F of the active contacts at the s nodes. The response of bodies to the forces is given
//! by the double integrals of the collocation polynomials, and that of natural modes by their exact propagators, so
//! that a step has to resolve the forces but not the modes: q(c_i h) = free motion - sum_j W_ij M^-1 R_j^T F_j. The
//! displacements and the compliance of the rails give the penetrations p as a linear function of F, and the
//! contact laws F = f(p, r) close the system, where r is the rate of the penetration or of the wheel. Linear laws are
//! solved by elimination, others by Newton's method.

use nalgebra::DVector;
use smallvec::SmallVec;

use crate::contact::geometry::Geometry;
use crate::contact::solver::Solver;
use crate::contact::system::System;
use crate::mechanics::state::State;
use crate::numerics::propagator::Propagator;
use crate::record::energy::power;
use crate::time::node_forces::{NodeForces, NodeMotion};
use crate::time::nodes::Nodes;
use crate::{Dynamics, Error, Exchanged};

/// Data of a collocation step; n degrees of freedom, m elements, s nodes.
pub(crate) struct Collocation {
    nodes: Nodes,
    /// omega and zeta of each degree of freedom; omega is 0 for a degree of freedom of a body.
    modes: Vec<[f64; 2]>,
    /// Responses for the most recent step lengths; the first entry is that of the current step.
    responses: Vec<Responses>,
    /// The contact geometry at the nodes.
    geometries: Vec<Geometry>,
    projection: NodeProjection,
    loads: NodeLoads,
    forces: NodeForces,
    states: Vec<State>,
    powers: Vec<Exchanged>,
}

/// Accelerations by unit contact forces.
struct NodeProjection {
    /// M^-1 R^T, s x m x n.
    spread: Vec<f64>,
    is_filled: bool,
}

/// Accelerations M^-1 f by the loads, n values each.
struct NodeLoads {
    /// At the nodes, without the contact forces and with them.
    free: Vec<DVector<f64>>,
    whole: Vec<DVector<f64>>,
    /// At the start of the step, with the contact forces.
    start: DVector<f64>,
    /// Whether the loads without contact forces are constant.
    is_steady: bool,
}

/// Responses of all degrees of freedom over a step of length `h`.
struct Responses {
    h: f64,
    /// Responses to the initial state: q per q0, q per v0, v per q0, v per v0; (s + 1) x n.
    free: Vec<[f64; 4]>,
    /// Responses of q and v to the load at every node; (s + 1) x s x n.
    forced: Vec<[f64; 2]>,
}

/// Number of step lengths whose responses are stored if there are modes.
const STORED: usize = 12;

/// Number of nodes up to which the polynomials through displacement, speed and acceleration at both ends of a step are of
/// a higher order than the motion by the polynomials of the accelerations at the nodes.
const FEW: usize = 3;

/// Places of a step, and contacts at all of its nodes, for which no memory is allocated.
const FEW_PLACES: usize = 12;
const FEW_CONTACTS: usize = 32;

/// Error of a penetration rate at the end of a step, per unit of the difference from its extrapolation.
const RATE_SHARE: f64 = 0.05;

impl Responses {
    fn new(nodes: &Nodes, n: usize) -> Self {
        let s = nodes.count();
        Responses {
            h: 0.0,
            free: vec![[0.0; 4]; (s + 1) * n],
            forced: vec![[0.0; 2]; (s + 1) * s * n],
        }
    }

    fn fill(&mut self, nodes: &Nodes, modes: &[[f64; 2]], h: f64) {
        self.h = h;
        let (s, n) = (nodes.count(), modes.len());
        for (r, &[omega, zeta]) in modes.iter().enumerate() {
            let mode = (omega > 0.0).then(|| Propagator::new(omega, zeta, h));
            for i in 0..=s {
                let c = nodes.c[i];
                self.free[i * n + r] = mode
                    .as_ref()
                    .map_or([1.0, c * h, 0.0, 1.0], |mode| mode.free(c));
                let powers = mode.as_ref().map(|mode| mode.forced(c));
                for b in 0..s {
                    self.forced[(i * s + b) * n + r] = match powers {
                        None => [h * h * nodes.a2[i * s + b], h * nodes.a[i * s + b]],
                        Some(powers) => [0, 1].map(|part| nodes.load(b, &powers, part)),
                    };
                }
            }
        }
    }

    /// Displacements and speeds of all degrees of freedom at node `i` (the end for i = s) under the loads at the s nodes.
    fn motion(&self, load: &[DVector<f64>], from: &State, i: usize, q: &mut [f64], v: &mut [f64]) {
        let (s, n) = (load.len(), q.len());
        let free = self.free[i * n..(i + 1) * n]
            .iter()
            .zip(from.q.iter().zip(from.v.iter()));
        for ((q, v), ([qq, qv, vq, vv], (q0, v0))) in q.iter_mut().zip(v.iter_mut()).zip(free) {
            (*q, *v) = (qq * q0 + qv * v0, vq * q0 + vv * v0);
        }
        for (forced, load) in self.forced[i * s * n..(i + 1) * s * n]
            .chunks_exact(n.max(1))
            .zip(load)
        {
            let terms = forced.iter().zip(load.iter());
            for ((q, v), ([by_q, by_v], load)) in q.iter_mut().zip(v.iter_mut()).zip(terms) {
                *q += by_q * load;
                *v += by_v * load;
            }
        }
    }
}

impl Collocation {
    pub fn new(system: &System, nodes: Nodes, start: &State) -> Self {
        let (n, m, s) = (system.mechanics.dofs, system.elements.len(), nodes.count());
        let mut modes = vec![[0.0; 2]; n];
        for (range, foundation) in system.mechanics.structures.iter().zip(system.foundations) {
            if let Some(Dynamics::Modes { omega, ratio }) =
                foundation.structure.as_ref().map(|s| &s.dynamics)
            {
                for (k, number) in range.clone().enumerate() {
                    modes[number] = [omega[k], ratio[k]];
                }
            }
        }
        let size = s * m;
        let moves = system
            .scene
            .bodies
            .iter()
            .enumerate()
            .filter(|(_, body)| body.motion.is_some());
        let drags = moves
            .into_iter()
            .any(|(b, _)| !system.mechanics.kinematics.travel_inertia(b).is_empty());
        Collocation {
            modes,
            responses: vec![Responses::new(&nodes, n)],
            geometries: vec![Geometry::new(system); s],
            projection: NodeProjection {
                spread: vec![0.0; size * n],
                is_filled: false,
            },
            loads: NodeLoads {
                free: vec![DVector::zeros(n); s],
                whole: vec![DVector::zeros(n); s],
                start: DVector::zeros(n),
                is_steady: system.scene.actuators.loads.is_empty() && !drags,
            },
            forces: NodeForces::new(system, s),
            states: vec![start.clone(); s],
            powers: vec![Exchanged::default(); s],
            nodes,
        }
    }

    /// Whether any degree of freedom is a natural mode.
    pub fn is_modal(&self) -> bool {
        self.modes.iter().any(|mode| mode[0] > 0.0)
    }

    /// Number of nodes.
    pub fn count(&self) -> usize {
        self.nodes.count()
    }

    /// Energy exchanged in the step, by the quadrature of the collocation method.
    pub fn exchanged(&self) -> Exchanged {
        let s = self.count();
        let mut sum = Exchanged::default();
        for (power, weight) in self.powers.iter().zip(&self.nodes.a[s * s..]) {
            sum.add(power, self.responses[0].h * weight);
        }
        sum
    }

    /// Takes a step of length `h` from `from` with the active contacts; returns false if no forces are found.
    pub fn attempt(
        &mut self,
        solver: &mut Solver,
        from: &State,
        h: f64,
        limit: f64,
        to: &mut State,
    ) -> Result<bool, Error> {
        self.set_step(h);
        let (s, n, m) = (self.count(), to.q.len(), solver.system().elements.len());
        for (r, &[omega, zeta]) in self.modes.iter().enumerate() {
            self.loads.start[r] = from.a[r] + omega * (2.0 * zeta * from.v[r] + omega * from.q[r]);
        }
        for a in 0..s {
            let t = (from.t + self.nodes.c[a] * h).min(limit.next_down());
            self.states[a].t = t;
            let (before, own) = self.geometries.split_at_mut(a);
            own[0].set_pieces(&solver.geometry().places().piece);
            own[0].take_paths(before.last().unwrap_or(solver.geometry()));
            self.geometries[a].update(solver.system(), t, &from.q, &from.force)?;
            if !(self.projection.is_filled && self.loads.is_steady) {
                self.loads.free[a].copy_from(solver.free_accelerations(t));
            }
            if !(self.projection.is_filled && solver.system().traits.has_constant_rows) {
                let rows = self.geometries[a].rows().approach.chunks_exact(n.max(1));
                for (row, spread) in
                    rows.zip(self.projection.spread[a * m * n..].chunks_exact_mut(n.max(1)))
                {
                    solver.apply_inverse(row, spread);
                }
            }
        }
        self.fill_approaches(solver.system(), from);
        self.projection.is_filled = true;
        let motion = NodeMotion {
            nodes: &self.nodes,
            h,
            from,
            geometries: &self.geometries,
            spread: &self.projection.spread,
            forced: &self.responses[0].forced,
        };
        if !self.forces.solve(solver, &motion) {
            return Ok(false);
        }
        self.finish(solver, from, to, limit)
    }

    /// Moves the responses for a step of length `h` to the front; computes them if they are not stored.
    fn set_step(&mut self, h: f64) {
        if let Some(known) = self.responses.iter().position(|responses| responses.h == h) {
            self.responses[..=known].rotate_right(1);
            return;
        }
        if self.is_modal() && self.responses.len() < STORED {
            self.responses
                .push(Responses::new(&self.nodes, self.modes.len()));
        }
        self.responses.rotate_right(1);
        self.responses[0].fill(&self.nodes, &self.modes, h);
    }

    /// Fills the approaches at the nodes and their rates in the motion without contact forces.
    fn fill_approaches(&mut self, system: &System, from: &State) {
        let (s, m) = (self.count(), system.elements.len());
        for a in 0..s {
            let State { q, v, .. } = &mut self.states[a];
            self.responses[0].motion(
                &self.loads.free,
                from,
                a,
                q.as_mut_slice(),
                v.as_mut_slice(),
            );
            let (geometry, state) = (&self.geometries[a], &self.states[a]);
            for i in 0..m {
                self.forces.approach[a * m + i] = geometry.approach(i, &state.q);
                self.forces.rate[a * m + i] = geometry.rate(i, &state.v);
            }
        }
    }

    /// Computes the states at the nodes and at the end, and the powers exchanged.
    fn finish(
        &mut self,
        solver: &mut Solver,
        from: &State,
        to: &mut State,
        limit: f64,
    ) -> Result<bool, Error> {
        let (s, n, m) = (
            self.count(),
            self.modes.len(),
            solver.system().elements.len(),
        );
        for (b, (load, weight)) in self
            .loads
            .whole
            .iter_mut()
            .zip(&self.loads.free)
            .enumerate()
        {
            load.copy_from(weight);
            for j in 0..m {
                let spread = &self.projection.spread[(b * m + j) * n..(b * m + j + 1) * n];
                let force = self.forces.force[b * m + j];
                load.iter_mut()
                    .zip(spread)
                    .for_each(|(load, spread)| *load -= spread * force);
            }
        }
        let h = self.responses[0].h;
        for a in 0..s {
            let State {
                q,
                v,
                a: accelerations,
                ..
            } = &mut self.states[a];
            self.responses[0].motion(
                &self.loads.whole,
                from,
                a,
                q.as_mut_slice(),
                v.as_mut_slice(),
            );
            for (r, &[omega, zeta]) in self.modes.iter().enumerate() {
                accelerations[r] =
                    self.loads.whole[a][r] - omega * (2.0 * zeta * v[r] + omega * q[r]);
            }
            self.forces
                .penetrate(a, &self.geometries[a], &mut self.states[a]);
        }
        for a in 0..s {
            for i in 0..m {
                let rates =
                    (0..s).map(|l| self.nodes.rate[a * s + l] * (self.states[l].p[i] - from.p[i]));
                self.states[a].p_rate[i] = rates.sum::<f64>() / h;
            }
            let state = &mut self.states[a];
            self.geometries[a].update_rail_slope(solver.system(), &state.q, &state.force);
            self.powers[a] = power(solver.system(), &self.geometries[a], state);
        }
        to.copy_from(&self.states[s - 1]);
        if self.nodes.c[s - 1] < 1.0 {
            to.t = (from.t + h).min(limit.next_down());
            let State { q, v, .. } = &mut *to;
            self.responses[0].motion(
                &self.loads.whole,
                from,
                s,
                q.as_mut_slice(),
                v.as_mut_slice(),
            );
            if !solver.instant(to)? {
                return Ok(false);
            }
        } else {
            solver.exchange_geometry(&mut self.geometries[s - 1]);
        }
        Ok(to.q.iter().chain(to.v.iter()).all(|x| x.is_finite()))
    }

    /// Places in the step just taken, as fractions of it, with the largest force by which a vertical contact has exceeded its
    /// limit of opening or closing there: the nodes and, by the polynomials through these, the middles between them.
    pub fn excesses(&self, solver: &Solver) -> SmallVec<[(f64, f64); FEW_PLACES]> {
        let (s, count) = (self.count(), solver.system().verticals());
        // The solver has that of the last node, if this is the end of the step.
        let last = if self.nodes.c[s - 1] < 1.0 {
            &self.geometries[s - 1]
        } else {
            solver.geometry()
        };
        let geometries = self.geometries[..s - 1].iter().chain([last]);
        let mut excess = SmallVec::<[f64; FEW_CONTACTS]>::with_capacity(s * count);
        for (geometry, state) in geometries.zip(&self.states) {
            let frame = geometry.frame(solver.system(), state);
            excess.extend((0..count).map(|i| solver.excess(i, &frame)));
        }
        let largest = |largest: f64, own: f64| {
            if own.is_finite() {
                largest.max(own)
            } else {
                largest
            }
        };
        let nodes = self.nodes.c.iter().zip(excess.chunks_exact(count.max(1)));
        let at_nodes = nodes.map(|(share, excess)| {
            (
                *share,
                excess.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            )
        });
        let at_middles = self.nodes.middles.iter().map(|(share, weights)| {
            let of = |i: usize| {
                let nodes = excess.iter().skip(i).step_by(count).zip(weights);
                nodes.map(|(excess, weight)| weight * excess).sum()
            };
            (*share, (0..count).map(of).fold(f64::NEG_INFINITY, largest))
        });
        at_nodes.chain(at_middles).collect()
    }

    /// Sets the modes of `at` to their values at the fraction `share` of the step just taken from `from`. They are
    /// exact for the load polynomials of the step, because no interpolating polynomial can follow a mode with many
    /// periods in a step. With more than [`FEW`] nodes the bodies move by these polynomials as well.
    pub fn interpolate(&self, from: &State, share: f64, at: &mut State) {
        if self.count() > FEW {
            self.interpolate_bodies(from, share, at);
        }
        let h = self.responses[0].h;
        for (r, &[omega, zeta]) in self
            .modes
            .iter()
            .enumerate()
            .filter(|(_, mode)| mode[0] > 0.0)
        {
            let mode = Propagator::new(omega, zeta, h);
            let [qq, qv, vq, vv] = mode.free(share);
            let powers = mode.forced(share);
            let (q0, v0) = (from.q[r], from.v[r]);
            let [mut q, mut v, mut now] = [qq * q0 + qv * v0, vq * q0 + vv * v0, 0.0];
            for (b, load) in self.loads.whole.iter().enumerate() {
                q += load[r] * self.nodes.load(b, &powers, 0);
                v += load[r] * self.nodes.load(b, &powers, 1);
                now += load[r] * self.nodes.value(b, share);
            }
            (at.q[r], at.v[r]) = (q, v);
            at.a[r] = now - omega * (2.0 * zeta * v + omega * q);
        }
    }

    /// The motion of the modes with the given `numbers` in the step just taken from `from`: of each, displacement and speed at
    /// the start and the coefficients of its load by powers of the share of the step.
    pub fn modal_motion(&self, from: &State, numbers: &[usize], out: &mut Vec<f64>) {
        let s = self.count();
        for &r in numbers {
            out.extend([from.q[r], from.v[r]]);
            out.extend((0..s).map(|k| {
                let loads = self.loads.whole.iter().enumerate();
                let terms = loads.map(|(b, load)| load[r] * self.nodes.lagrange[b * s + k]);
                terms.sum::<f64>()
            }));
        }
    }

    /// Frequency and damping of the modes with the given `numbers`, and the number of coefficients of a load.
    pub fn modes(&self, numbers: &[usize]) -> (Vec<[f64; 2]>, usize) {
        (
            numbers.iter().map(|r| self.modes[*r]).collect(),
            self.count(),
        )
    }

    /// Sets the degrees of freedom of bodies in `at` to the motion by the polynomials of their accelerations.
    fn interpolate_bodies(&self, from: &State, share: f64, at: &mut State) {
        let h = self.responses[0].h;
        let bodies = || (0..self.modes.len()).filter(|&r| self.modes[r][0] == 0.0);
        for r in bodies() {
            [at.q[r], at.v[r], at.a[r]] = [from.q[r] + share * h * from.v[r], from.v[r], 0.0];
        }
        for (b, load) in self.loads.whole.iter().enumerate() {
            let [by_q, by_v, by_a] = self.nodes.motion(b, share, h);
            for r in bodies() {
                at.q[r] += load[r] * by_q;
                at.v[r] += load[r] * by_v;
                at.a[r] += load[r] * by_a;
            }
        }
    }

    /// Error of the penetration rate of vertical contact `i`: the difference between the rate at the last node and its
    /// extrapolation from the start and the other nodes, by the share that remains at the end.
    pub fn rate_error(&self, from: &State, i: usize) -> f64 {
        let s = self.count();
        let mut jump = self.states[s - 1].p_rate[i] - self.nodes.ahead[0] * from.p_rate[i];
        for b in 1..s {
            jump -= self.nodes.ahead[b] * self.states[b - 1].p_rate[i];
        }
        RATE_SHARE * jump
    }

    /// Error of q and v of degree of freedom `r`: the response to the difference between the load of the last node
    /// and its extrapolation from the start and the other nodes.
    pub fn error(&self, r: usize) -> [f64; 2] {
        let (s, n) = (self.count(), self.modes.len());
        let mut jump = self.loads.whole[s - 1][r] - self.nodes.ahead[0] * self.loads.start[r];
        for b in 1..s {
            jump -= self.nodes.ahead[b] * self.loads.whole[b - 1][r];
        }
        self.responses[0].forced[(s * s + s - 1) * n + r].map(|response| response * jump)
    }
}
