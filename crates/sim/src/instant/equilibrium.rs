//! Static equilibrium: weights, loads, wheels and the rail's give in balance.

use nalgebra::{DMatrix, DVector};

use crate::contact::solver::Solver;
use crate::contact::system::System;
use crate::mechanics::state::State;
use crate::numerics::dense::dot;
use crate::{Error, Freedom};

/// Sweeps of the active set.
const SWEEPS: usize = 60;
/// Iterations on the forces of flanges.
const FLANGES: usize = 60;
/// Change of the freedoms, by the largest penetration, at which wheels are taken to be where they will stay.
const SETTLED: f64 = 1e-9;
/// Newton iterations on the laws of one active set.
const ITERATIONS: usize = 50;
/// Relative error of the balance beyond which the wheels cannot carry the weight.
const BALANCE: f64 = 1e-6;

impl Solver<'_> {
    /// Moves y, roll and pitch of every body (where they are free and wheels resist them) and the freedoms of
    /// the structures to static equilibrium at `at.t`, with the other freedoms where they are.
    ///
    /// Newton's method on p + (G + Phi K^-1 Phi^T) F = R q, F = law(p), R^T F = weight and loads over the active set, in
    /// sweeps that drop contacts that pull and add contacts that are pressed; again where wheels are at other places then, or
    /// their rails' slopes turn the bodies.
    ///
    /// # Errors
    /// [`Error::NoEquilibrium`] where the wheels cannot carry the bodies, and what the structures refuse.
    pub fn carry(&mut self, at: &mut State) -> Result<(), Error> {
        let system = self.system;
        let none = Error::NoEquilibrium { time: at.t };
        at.v.fill(0.0);
        at.force[..system.link(0)].fill(0.0);
        let flanges = system.lateral(0)..system.traction(0);
        let mut relaxation = Relaxation::default();
        // Ropes pull as they did where the bodies came from: an instant on the way would find them slack.
        let links = at.force[system.link(0)..].to_vec();
        for _ in 0..FLANGES {
            let before = at.q.clone();
            self.balance(at)?;
            let rests = !system.moves_freely || self.is_settled(&before, at);
            if flanges.is_empty() {
                if rests {
                    return Ok(());
                }
                continue;
            }
            let taken = at.force[flanges.clone()].to_vec();
            if !self.instant(at)? {
                return Err(none);
            }
            at.force[system.link(0)..].copy_from_slice(&links);
            let largest =
                at.force.iter().fold(self.system.mechanics.gravity.amax(), |max, force| max.max(force.abs()));
            if relaxation.step(&taken, &mut at.force[flanges.clone()]) <= 1e-12 * largest && rests {
                return Ok(());
            }
        }
        Err(none)
    }

    /// Whether the freedoms have stayed where they were `before`.
    pub fn is_settled(&self, before: &DVector<f64>, at: &State) -> bool {
        let depth = at.p.iter().fold(0.0_f64, |most, p| most.max(p.abs()));
        let pairs = before.iter().zip(at.q.iter());
        pairs.fold(0.0_f64, |most, (then, now)| most.max((now - then).abs())) <= SETTLED * depth
    }

    /// The balance under the flange forces of `at`.
    fn balance(&mut self, at: &mut State) -> Result<(), Error> {
        let system = self.system;
        let none = Error::NoEquilibrium { time: at.t };
        self.geometry.update(system, at.t, &at.q, &at.force)?;
        let moving = self.balancing();
        let mut balance = Balance::new(self, moving, at)?;
        if !balance.solve() {
            return Err(none);
        }
        for (&number, &q) in balance.moving.iter().zip(balance.q.iter()) {
            at.q[number] = q;
        }
        at.force[..system.mechanics.groups.len()].copy_from_slice(&balance.force);
        at.p[..balance.p.len()].copy_from_slice(&balance.p);
        at.p_rate.fill(0.0);
        self.rest_rails(at);
        self.active.fill(false);
        for &i in &balance.active {
            self.active[i] = true;
        }
        self.settle_structures(at)
    }

    /// Freedoms of the bodies that balance the weights: those of y, roll and pitch that some wheel resists.
    fn balancing(&self) -> Vec<usize> {
        let (n, count) = (self.system.mechanics.dofs, self.system.mechanics.groups.len());
        let numbers = self.system.mechanics.kinematics.numbers.iter();
        numbers
            .flat_map(|numbers| [Freedom::Y, Freedom::Roll, Freedom::Pitch].map(|f| numbers[f as usize]))
            .flatten()
            .filter(|&number| (0..count).any(|i| self.geometry.rows[i * n + number] != 0.0))
            .collect()
    }

    /// G + Phi K^-1 Phi^T over the vertical contacts, then the flanges.
    fn static_compliance(&self) -> Result<DMatrix<f64>, Error> {
        let system = self.system;
        let (n, m, count) = (system.mechanics.dofs, system.components(), system.traction(0));
        let mut compliance = DMatrix::from_fn(count, count, |i, j| self.geometry.compliance[i * m + j]);
        for block in &system.mechanics.blocks[1..] {
            let first = block.range.start;
            let phi =
                DMatrix::from_fn(block.range.len(), count, |k, i| self.geometry.rows[i * n + first + k]);
            compliance += phi.transpose() * block.rest(&phi)?;
        }
        Ok(compliance)
    }

    /// Structures' freedoms under the vertical and the flange forces of `at`.
    fn settle_structures(&mut self, at: &mut State) -> Result<(), Error> {
        let system = self.system;
        let n = system.mechanics.dofs;
        for block in &system.mechanics.blocks[1..] {
            let (first, size) = (block.range.start, block.range.len());
            let load = DMatrix::from_fn(size, 1, |k, _| {
                let forces = at.force[..system.traction(0)].iter().enumerate();
                -forces.map(|(i, force)| self.geometry.rows[i * n + first + k] * force).sum::<f64>()
            });
            at.q.rows_mut(first, size).copy_from(&block.rest(&load)?.column(0));
        }
        Ok(())
    }
}

/// Aitken's relaxation of forces that follow from themselves.
#[derive(Default)]
struct Relaxation {
    share: Option<f64>,
    residual: Vec<f64>,
}

impl Relaxation {
    /// From the forces `taken` and those that `followed`: the next ones to take, in place of these, and the change.
    fn step(&mut self, taken: &[f64], followed: &mut [f64]) -> f64 {
        let residual: Vec<f64> = followed.iter().zip(taken).map(|(new, old)| new - old).collect();
        let bend: Vec<f64> = residual.iter().zip(&self.residual).map(|(new, old)| new - old).collect();
        let square: f64 = bend.iter().map(|b| b * b).sum();
        let share = match self.share {
            Some(share) if square > 0.0 => -share * dot(&self.residual, &bend) / square,
            _ => 1.0,
        };
        for (next, (old, change)) in followed.iter_mut().zip(taken.iter().zip(&residual)) {
            *next = old + share * change;
        }
        let largest = residual.iter().fold(0.0_f64, |max, r| max.max(r.abs()));
        (self.share, self.residual) = (Some(share), residual);
        largest
    }
}

/// The balance of the vertical contacts at one place: p + A F = `held` + `rows` q, F = law(p), `rows`^T F = weight.
struct Balance<'a> {
    system: &'a System<'a>,
    /// Share of each contact's law that acts, times its wheels.
    share: Vec<f64>,
    /// Numbers of the freedoms q.
    moving: Vec<usize>,
    /// A, contacts x contacts.
    compliance: DMatrix<f64>,
    /// Contacts x freedoms.
    rows: DMatrix<f64>,
    held: Vec<f64>,
    weight: DVector<f64>,
    active: Vec<usize>,
    q: DVector<f64>,
    p: Vec<f64>,
    force: Vec<f64>,
}

impl<'a> Balance<'a> {
    /// The balance of `moving` where the solver's geometry is; every wheel that may act is taken to carry alike.
    /// Where nothing moves, the wheels that reach into their rails carry.
    fn new(solver: &Solver<'a>, moving: Vec<usize>, at: &State) -> Result<Self, Error> {
        let (system, geometry) = (solver.system, &solver.geometry);
        let (n, count) = (system.mechanics.dofs, system.mechanics.groups.len());
        let stays = |k: usize| {
            !moving.contains(&k) && !system.mechanics.structures.iter().any(|range| range.contains(&k))
        };
        let staying: Vec<usize> = (0..n).filter(|&k| stays(k)).collect();
        let all = solver.static_compliance()?;
        let flanges = || system.lateral(0)..system.traction(0);
        let held: Vec<f64> = (0..count)
            .map(|i| {
                let staid = staying.iter().map(|&k| geometry.rows[i * n + k] * at.q[k]).sum::<f64>();
                geometry.held[i] + staid - flanges().map(|l| all[(i, l)] * at.force[l]).sum::<f64>()
            })
            .collect();
        let share: Vec<f64> = system
            .mechanics
            .groups
            .iter()
            .zip(&geometry.share)
            .map(|(normal, s)| normal.count() * s[0])
            .collect();
        let reach = |i: usize| if moving.is_empty() { Some(held[i]) } else { None };
        let active: Vec<usize> =
            (0..count).filter(|&i| share[i] > 0.0 && reach(i).is_none_or(|p| p > 0.0)).collect();
        let mut gravity = system.mechanics.gravity.clone();
        system.mechanics.carried.weigh(&system.mechanics.kinematics, (at.t, &at.q), &mut gravity);
        let mut weight =
            DVector::from_fn(moving.len(), |j, _| gravity[moving[j]] + solver.pull_of_links(moving[j], at));
        for load in &system.scene.actuators.loads {
            if let Some(j) = moving.iter().position(|&k| system.mechanics.loaded(load) == Some(k)) {
                weight[j] += load.value.at(at.t);
            }
        }
        // A rail pushes along itself where it slopes: on the hub, so that a body is turned.
        let tilted =
            |i: usize, k: usize| (geometry.force_rows[i * n + k] - geometry.rows[i * n + k]) * at.force[i];
        for (j, &k) in moving.iter().enumerate() {
            weight[j] -= (0..count).map(|i| tilted(i, k)).sum::<f64>();
            weight[j] -= flanges().map(|l| geometry.force_rows[l * n + k] * at.force[l]).sum::<f64>();
        }
        let each = weight.amax() / active.len().max(1) as f64;
        Ok(Balance {
            compliance: all.view((0, 0), (count, count)).into_owned(),
            rows: DMatrix::from_fn(count, moving.len(), |i, j| geometry.rows[i * n + moving[j]]),
            p: (0..count).map(|i| reach(i).unwrap_or_else(|| system.law(i).penetration(each))).collect(),
            q: DVector::zeros(moving.len()),
            force: vec![0.0; count],
            system,
            share,
            moving,
            held,
            weight,
            active,
        })
    }

    /// Sweeps of the active set; false where no set balances the weights.
    fn solve(&mut self) -> bool {
        for _ in 0..SWEEPS {
            if self.active.is_empty() {
                return self.moving.is_empty();
            }
            let Some(converged) = self.iterate() else { return false };
            if !self.sweep() {
                return converged;
            }
        }
        false
    }

    /// Newton's method with the active contacts; `None` where they cannot carry the weight, else whether it
    /// converged.
    fn iterate(&mut self) -> Option<bool> {
        for _ in 0..ITERATIONS {
            let solved = self.linearised()?;
            let change = self.advance(&solved);
            let depth = self.p.iter().fold(0.0_f64, |max, p| max.max(p.abs()));
            if change <= 1e-14 * depth {
                return Some(true);
            }
        }
        Some(false)
    }

    /// Forces of the active contacts from (A + 1/k) F = R q + held - p + f/k, R^T F = weight, with f and k force
    /// and stiffness of the laws at p; sets q.
    fn linearised(&mut self) -> Option<DVector<f64>> {
        let size = self.active.len();
        let mut matrix =
            DMatrix::from_fn(size, size, |r, c| self.compliance[(self.active[r], self.active[c])]);
        let mut free = DVector::zeros(size);
        for (r, &i) in self.active.iter().enumerate() {
            let point = self.system.law(i).at(self.p[i], 0.0);
            matrix[(r, r)] += 1.0 / (self.share[i] * point.by_penetration);
            free[r] = self.held[i] - self.p[i] + point.force / point.by_penetration;
        }
        let lever = DMatrix::from_fn(size, self.moving.len(), |r, j| self.rows[(self.active[r], j)]);
        let lu = matrix.lu();
        if self.moving.is_empty() {
            return lu.solve(&free);
        }
        let (by_lever, by_free) = (lu.solve(&lever)?, lu.solve(&free)?);
        let stiffness = lever.transpose() * &by_lever;
        let balance = &self.weight - lever.transpose() * &by_free;
        let next = stiffness.clone().lu().solve(&balance)?;
        let scale = self.weight.amax().max(f64::MIN_POSITIVE);
        let balanced = (&stiffness * &next - &balance).amax() <= BALANCE * scale;
        if !(balanced && next.iter().all(|q| q.is_finite())) {
            return None;
        }
        let solved = by_lever * &next + by_free;
        self.q = next;
        Some(solved)
    }

    /// Moves the penetrations to the forces `solved`, kept positive for curved laws; returns the largest change.
    fn advance(&mut self, solved: &DVector<f64>) -> f64 {
        let mut change = 0.0_f64;
        self.force.fill(0.0);
        for (r, &i) in self.active.iter().enumerate() {
            let (law, share) = (self.system.law(i), self.share[i]);
            let point = law.at(self.p[i], 0.0);
            let wanted = self.p[i] + (solved[r] - share * point.force) / (share * point.by_penetration);
            let floor = 0.1 * self.p[i].abs();
            let bounded = if law.exponent == 1.0 { wanted } else { wanted.max(floor) };
            change = change.max((bounded - self.p[i]).abs());
            self.p[i] = bounded;
            self.force[i] = solved[r];
        }
        change
    }

    /// Drops the contacts that pull, adds those that are pressed; returns whether the active set changed.
    fn sweep(&mut self) -> bool {
        let deepest = self.p.iter().fold(0.0_f64, |max, p| max.max(p.abs()));
        let before = self.active.clone();
        let system = self.system;
        let force = &self.force;
        self.active.retain(|&i| force[i] >= 0.0 || system.law(i).bilateral);
        for i in (0..self.share.len()).filter(|i| !before.contains(i) && self.share[*i] > 0.0) {
            let reach: f64 = self.rows.row(i).iter().zip(self.q.iter()).map(|(r, q)| r * q).sum();
            let give: f64 = self.compliance.row(i).iter().zip(&self.force).map(|(g, f)| g * f).sum();
            self.p[i] = self.held[i] + reach - give;
            if self.p[i] > 1e-13 * deepest {
                self.active.push(i);
            }
        }
        self.active.sort_unstable();
        self.active != before
    }
}
