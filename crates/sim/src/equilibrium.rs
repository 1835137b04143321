//! Static equilibrium: weights, wheels and the rail's give in balance.

use nalgebra::{DMatrix, DVector};

use crate::solver::Solver;
use crate::state::State;
use crate::{Error, Freedom};

const SWEEPS: usize = 60;
const ITERATIONS: usize = 50;

impl Solver<'_> {
    /// Moves y, roll and pitch of every body (where they are free and wheels resist them) and the freedoms of
    /// the structures to static equilibrium at `at.t`, with the other freedoms where they are.
    ///
    /// Newton's method on p + (G + Phi K^-1 Phi^T) F = R q, F = law(p), R^T F = weight over the active set, in
    /// sweeps that drop contacts that pull and add contacts that are pressed.
    ///
    /// # Errors
    /// [`Error::NoEquilibrium`] where the wheels cannot carry the bodies, and what the structures refuse.
    pub fn equilibrate(&mut self, at: &mut State) -> Result<(), Error> {
        let system = self.system;
        let none = Error::NoEquilibrium { time: at.t };
        let (n, m, count) = (system.freedoms, system.components(), system.normals.len());
        at.v.fill(0.0);
        at.force.fill(0.0);
        self.geometry.update(system, at.t, &at.q, &at.force)?;

        // Freedoms of the bodies that balance the weights.
        let moving: Vec<usize> = system
            .freedom
            .iter()
            .flat_map(|numbers| [Freedom::Y, Freedom::Roll, Freedom::Pitch].map(|f| numbers[f as usize]))
            .flatten()
            .filter(|&number| (0..count).any(|i| self.geometry.rows[i * n + number] != 0.0))
            .collect();
        if moving.is_empty() {
            return self.settle_all(at, none);
        }
        let compliance = self.static_compliance()?;
        let rows = DMatrix::from_fn(count, moving.len(), |i, j| self.geometry.rows[i * n + moving[j]]);
        let held: Vec<f64> = (0..count)
            .map(|i| {
                self.geometry.held[i]
                    + (0..n)
                        .filter(|k| {
                            !moving.contains(k) && !system.structure.iter().any(|range| range.contains(k))
                        })
                        .map(|k| self.geometry.rows[i * n + k] * at.q[k])
                        .sum::<f64>()
            })
            .collect();
        let weight = DVector::from_fn(moving.len(), |j, _| system.gravity[moving[j]]);
        let share = |i: usize| system.normals[i].count() * self.geometry.share[i][0];
        let law = |i: usize| &system.scene.wheels[system.normals[i].kind].normal;

        let total = weight.iter().fold(0.0_f64, |max, w| max.max(w.abs()));
        let mut active: Vec<usize> = (0..count).filter(|&i| share(i) > 0.0).collect();
        let mut p = vec![0.0; count];
        for (i, entry) in p.iter_mut().enumerate() {
            *entry = law(i).penetration(total / active.len().max(1) as f64);
        }
        let mut force = vec![0.0; count];
        let mut q = DVector::zeros(moving.len());
        let mut settled = false;
        for _ in 0..SWEEPS {
            let mut converged = false;
            for _ in 0..ITERATIONS {
                // Linearised: (G + 1/k) F = R q + held - p + f/k,  R^T F = weight.
                let size = active.len();
                let mut matrix = DMatrix::zeros(size, size);
                let mut free = DVector::zeros(size);
                for (r, &i) in active.iter().enumerate() {
                    let point = law(i).at(p[i], 0.0);
                    let stiffness = share(i) * point.by_penetration;
                    for (c, &j) in active.iter().enumerate() {
                        matrix[(r, c)] = compliance[(i, j)];
                    }
                    matrix[(r, r)] += 1.0 / stiffness;
                    free[r] = held[i] - p[i] + share(i) * point.force / stiffness;
                }
                let lever = DMatrix::from_fn(size, moving.len(), |r, j| rows[(active[r], j)]);
                let lu = matrix.lu();
                let (Some(by_lever), Some(by_free)) = (lu.solve(&lever), lu.solve(&free)) else {
                    return Err(none);
                };
                let stiffness = lever.transpose() * &by_lever;
                let balance = &weight - lever.transpose() * &by_free;
                let Some(next) = stiffness.clone().lu().solve(&balance) else { return Err(none) };
                if !next.iter().all(|x| x.is_finite())
                    || (&stiffness * &next - &balance).amax() > 1e-6 * total.max(1e-300)
                {
                    return Err(none);
                }
                let solved = &by_lever * &next + &by_free;
                let mut change = 0.0_f64;
                force.fill(0.0);
                for (r, &i) in active.iter().enumerate() {
                    let point = law(i).at(p[i], 0.0);
                    let step = (solved[r] - share(i) * point.force) / (share(i) * point.by_penetration);
                    let floor = 0.1 * p[i].abs();
                    let bounded =
                        if law(i).exponent == 1.0 || p[i] + step > floor { p[i] + step } else { floor };
                    change = change.max((bounded - p[i]).abs());
                    p[i] = bounded;
                    force[i] = solved[r];
                }
                q = next;
                let depth = p.iter().fold(0.0_f64, |max, x| max.max(x.abs()));
                if change <= 1e-14 * depth {
                    converged = true;
                    break;
                }
            }
            let stiffest = p.iter().fold(0.0_f64, |max, x| max.max(x.abs()));
            let gap = |i: usize, force: &[f64], q: &DVector<f64>| {
                let reach: f64 = (0..moving.len()).map(|j| rows[(i, j)] * q[j]).sum();
                held[i] + reach - (0..count).map(|j| compliance[(i, j)] * force[j]).sum::<f64>()
            };
            let before = active.clone();
            active.retain(|&i| force[i] >= 0.0 || law(i).bilateral);
            for i in (0..count).filter(|i| !before.contains(i) && share(*i) > 0.0) {
                p[i] = gap(i, &force, &q);
                if p[i] > 1e-13 * stiffest {
                    active.push(i);
                }
            }
            active.sort_unstable();
            if active == before {
                settled = converged;
                break;
            }
            if active.is_empty() {
                return Err(none);
            }
        }
        if !settled {
            return Err(none);
        }
        for (j, &number) in moving.iter().enumerate() {
            at.q[number] = q[j];
        }
        at.force[..count].copy_from_slice(&force);
        at.p.copy_from_slice(&p);
        at.p_rate.fill(0.0);
        for (i, flag) in self.active.iter_mut().enumerate() {
            *flag = active.contains(&i);
        }
        self.settle_structures(at)?;
        debug_assert!(m >= count, "vertical contacts are components");
        Ok(())
    }

    fn settle_all(&mut self, at: &mut State, none: Error) -> Result<(), Error> {
        if self.settle(at)? { Ok(()) } else { Err(none) }
    }

    /// G + Phi K^-1 Phi^T over the vertical contacts.
    fn static_compliance(&self) -> Result<DMatrix<f64>, Error> {
        let system = self.system;
        let (n, m, count) = (system.freedoms, system.components(), system.normals.len());
        let mut compliance = DMatrix::from_fn(count, count, |i, j| self.geometry.compliance[i * m + j]);
        for range in system.structure.iter().filter(|range| !range.is_empty()) {
            let size = range.len();
            let stiffness = system.stiffness.view((range.start, range.start), (size, size)).into_owned();
            let phi = DMatrix::from_fn(size, count, |k, i| self.geometry.rows[i * n + range.start + k]);
            let factor = stiffness.cholesky().ok_or(Error::Number {
                what: "stiffness of a structure",
                wanted: "positive definite",
                found: 0.0,
            })?;
            compliance += phi.transpose() * factor.solve(&phi);
        }
        Ok(compliance)
    }

    /// Structures' freedoms under the vertical forces of `at`.
    fn settle_structures(&mut self, at: &mut State) -> Result<(), Error> {
        let system = self.system;
        let n = system.freedoms;
        for range in system.structure.iter().filter(|range| !range.is_empty()) {
            let size = range.len();
            let stiffness = system.stiffness.view((range.start, range.start), (size, size)).into_owned();
            let load = DVector::from_fn(size, |k, _| {
                -(0..system.normals.len())
                    .map(|i| self.geometry.rows[i * n + range.start + k] * at.force[i])
                    .sum::<f64>()
            });
            if let Some(factor) = stiffness.cholesky() {
                at.q.rows_mut(range.start, size).copy_from(&factor.solve(&load));
            }
        }
        Ok(())
    }
}
