//! Errors of the forces at the end of a step that follow from the errors of its state.

use std::f64::consts::TAU;

use super::follow::delay_of;
use super::{RowKind, Solver};
use crate::mechanics::state::State;
use crate::numerics::dense::{along, dot};

/// Least number of periods of a natural mode over which the errors of a Runge-Kutta method in it add up.
const OWN: f64 = 4.0;

/// Number of periods of a natural mode up to which its errors add up one by one, by collocation and by Runge-Kutta stages;
/// those of N more periods add up as those of sqrt(PERIODS N).
const PERIODS: [f64; 2] = [400.0, 6400.0];

/// Part of the error of a period that collocation, with its exact propagators of the free modes, repeats in the next.
const REPEATED: f64 = 0.1;

/// Largest sum of the errors in a natural mode, relative to the amplitude of its free vibration.
const RINGING: f64 = 4.0;

/// Errors of the state `at` at the end of a step of length `h`.
pub(crate) struct StateErrors<'e> {
    pub at: &'e State,
    pub h: f64,
    /// Whether the problem of the forces is that of the last stage of the step.
    pub is_staged: bool,
    /// Of displacements and speeds.
    pub q: &'e [f64],
    pub v: &'e [f64],
    /// Of the penetration rates of vertical contacts.
    pub rate: &'e [f64],
    /// Frequency of each degree of freedom, or 0 for none.
    pub frequency: &'e [f64],
    /// Number of bounces of bodies over which errors add up.
    pub bounces: f64,
    /// Number of periods of each natural mode over which errors add up, and the amplitude of its free vibration.
    pub ringing: &'e [Ringing],
}

/// Free vibration of a natural mode.
#[derive(Clone, Copy, Default)]
pub(crate) struct Ringing {
    /// Number of periods, while it is under the wheels, over which errors add up.
    pub periods: f64,
    /// Larger of the amplitudes of the free vibration at both ends of the step.
    pub amplitude: f64,
}

impl Solver<'_> {
    /// Errors of the forces by the errors of a state, into `out`. Errors of displacements and speeds change the forces
    /// by J^-1 (law_p R dq + law_r R' dv) with J = I + law_p W + law_r Y over the elements that act, and an error of a
    /// speed by J^-1 law_p R dv / omega a quarter of a period later. The magnitudes are added. Those by bodies count
    /// `bounces` times, because they add up over the bounces of the wheels. Those of displacements in natural modes
    /// count once for each period in which wheels and structure leave the mode undamped, but their sum is at most
    /// [`RINGING`] times the free vibration of the mode.
    ///
    /// W and Y are those of the last stage, where it `is_staged`, so that errors that the method damps count as they
    /// are damped. For collocation W = G, and Y = G/h where the penetration is a state. Returns false if J is singular.
    /// The geometry must belong to the state.
    pub fn force_errors(&mut self, errors: &StateErrors, out: &mut [f64]) -> bool {
        let &StateErrors {
            at,
            h,
            is_staged,
            q,
            v,
            rate,
            frequency,
            bounces,
            ringing,
        } = errors;
        if !is_staged {
            self.fill_without_mobility(at, h);
        }
        let (system, rows, n) = (self.system, self.geometry.rows(), q.len());
        let (least, repeated) = if is_staged {
            (OWN, 1.0)
        } else {
            (1.0, REPEATED)
        };
        let add_up = |error: f64, k: usize, place: f64| {
            let Ringing { periods, amplitude } = ringing[k];
            (repeated * periods * error)
                .min(RINGING * (amplitude * place).abs())
                .max(least * error)
        };
        let [mut now, mut later, mut own] = std::mem::take(&mut self.state_errors);
        for errors in [&mut now, &mut later, &mut own] {
            errors.clear();
            errors.resize(out.len(), [0.0; 2]);
        }
        for &i in &self.problem.sought {
            let tilted = system.mechanics.moves_freely && !system.fixed[i].is_tangential;
            let place = &(if tilted { &rows.force } else { &rows.approach })[i * n..(i + 1) * n];
            let rates = &(if self.remembers(i) {
                &rows.approach
            } else {
                &rows.rate
            })[i * n..(i + 1) * n];
            own[i][1] = rate.get(i).copied().unwrap_or(0.0);
            for k in system.row_spans[i].clone() {
                let by = [place[k] * q[k], rates[k] * v[k]];
                let next = if frequency[k] > 0.0 {
                    place[k] * v[k] / frequency[k]
                } else {
                    0.0
                };
                if system.mechanics.omegas[k].is_some() {
                    let error = add_up(by[0].abs() + next.abs(), k, place[k]);
                    let rate_error = if is_staged {
                        add_up(by[1].abs(), k, rates[k] * frequency[k])
                    } else {
                        least * by[1]
                    };
                    own[i] = [own[i][0] + error, own[i][1] + rate_error];
                } else {
                    now[i] = [now[i][0] + by[0], now[i][1] + by[1]];
                    later[i][0] += next;
                }
            }
        }
        let (local, active) = (self.geometry.local(), self.active.flags());
        // The last stage ends with its laws evaluated, and with the factors of its problem, unless this was linear.
        let is_factored = self.factored_for.take().is_some() && self.problem.is_factored();
        let is_current = is_staged && is_factored;
        let is_solved = (is_current || self.problem.linearise(system, local, active, &at.force))
            && self
                .problem
                .add_responses([(&now, bounces), (&later, bounces), (&own, 1.0)], out);
        self.state_errors = [now, later, own];
        is_solved
    }

    /// Sets the `frequency` of each degree of freedom, or 0 where it has none, and returns the largest number of bounces
    /// in the time `end` over which errors add up, which damping limits to 1/(2 pi zeta). A wheel is a spring of the
    /// stiffness F/d, where d is the drop of the wheel below the unloaded rail and at least its penetration, so that
    /// omega_k^2 = sum of R_ik^2 F_i/d_i over the wheels, divided by M_kk. The geometry must belong to `at`.
    pub fn bounces(&self, at: &State, end: f64, frequency: &mut [f64]) -> f64 {
        let (system, n) = (self.system, frequency.len());
        let (bodies, mut most) = (system.mechanics.blocks[0].body_mass(), 1.0_f64);
        for (frequency, omega) in frequency.iter_mut().zip(&system.mechanics.omegas) {
            *frequency = omega.unwrap_or(0.0);
        }
        for i in (0..system.verticals()).filter(|&i| self.active.has(i) && at.force[i] > 0.0) {
            let row = &self.geometry.rows().approach[i * n..(i + 1) * n];
            let shapes = system.mechanics.structures.iter();
            let sunk: f64 = shapes
                .map(|own| dot(&row[own.clone()], &at.q.as_slice()[own.clone()]))
                .sum();
            let drop = (self.geometry.approach(i, &at.q) - sunk).max(at.p[i]);
            if drop <= 0.0 {
                continue;
            }
            let stiffness = at.force[i] / drop;
            if let Some(mass) = bodies {
                for k in 0..mass.nrows() {
                    frequency[k] += row[k] * row[k] * stiffness / mass[(k, k)];
                }
            }
            let omega = (system.scene.gravity / drop).sqrt();
            let [_, by_place, by_rate] = self.law_of(i, at.p[i], at.p_rate[i]);
            let share = if self.remembers(i) {
                (at.p[i] / drop).max(0.0)
            } else {
                1.0
            };
            let ratio = 0.5 * by_rate / by_place * omega * share;
            most = most.max((end * omega / TAU).min(1.0 + 1.0 / (TAU * ratio)));
        }
        if let Some(mass) = bodies {
            frequency[..mass.nrows()]
                .iter_mut()
                .for_each(|frequency| *frequency = frequency.sqrt());
        }
        most
    }

    /// Sets the [`Ringing`] of each natural mode in the step between the states of `ends`, for a run of length `end`. On
    /// the springs of the wheels the mode phi has the frequency omega_w^2 = omega^2 + sum k_i phi_i^2, and the damping
    /// 2 zeta_w omega_w = 2 zeta omega + sum c_i phi_i^2 by wheels with dampers to the rail, which limits the number of
    /// periods to 1 + 1/(2 pi zeta_w). Its free vibration is the part of its motion that inertia takes part in, of
    /// amplitude ((q''/omega^2)^2 + (q'/omega)^2)^(1/2). The geometry must belong to the end. `is_staged` says that the step
    /// has stages.
    pub fn ringing(&self, ends: [&State; 2], end: f64, is_staged: bool, out: &mut [Ringing]) {
        if self.system.mechanics.omegas.iter().all(Option::is_none) {
            return;
        }
        let most = PERIODS[usize::from(is_staged)];
        let (mechanics, n, at) = (&self.system.mechanics, out.len(), ends[1]);
        let wheels: Vec<(&[f64], f64, f64)> = (0..self.system.verticals())
            .filter(|&i| self.active.has(i))
            .map(|i| {
                let row = &self.geometry.rows().approach[i * n..(i + 1) * n];
                let [_, by_place, by_rate] = self.law_of(i, at.p[i], at.p_rate[i]);
                // a ramped damper makes the law of a wheel that rises fall with its penetration
                let by_place = by_place.max(0.0);
                let share = 1.0 / (1.0 + by_place * self.geometry.own_compliance(i));
                (
                    row,
                    by_place * share,
                    if self.remembers(i) {
                        by_rate * share * share
                    } else {
                        0.0
                    },
                )
            })
            .collect();
        for (k, out) in out.iter_mut().enumerate() {
            let Some(omega) = mechanics.omegas[k] else {
                continue;
            };
            let (mut stiffened, mut loss) =
                (omega * omega, 2.0 * mechanics.damping_ratios[k] * omega);
            for (row, stiffness, damping) in &wheels {
                stiffened += stiffness * row[k] * row[k];
                loss += damping * row[k] * row[k];
            }
            let together = stiffened.sqrt();
            let decay = 1.0 + 2.0 * together / (TAU * loss);
            let periods = (end * together / TAU).min(decay);
            let squared = |state: &State| {
                (state.a[k] / (omega * omega)).powi(2) + (state.v[k] / omega).powi(2)
            };
            *out = Ringing {
                periods: if periods > most {
                    (most * periods).sqrt()
                } else {
                    periods
                },
                amplitude: if omega > 0.0 {
                    squared(ends[0]).max(squared(at)).sqrt()
                } else {
                    f64::INFINITY
                },
            };
        }
    }

    /// Time in which the penetration of vertical contact `i` follows its force ([`delay_of`]).
    pub fn delay(&self, i: usize, at: &State) -> f64 {
        delay_of(
            self.law_of(i, at.p[i], at.p_rate[i]),
            self.geometry.own_compliance(i),
        )
    }

    /// Fills the problem with W = G, and Y = G/h in the rows of contacts whose penetration is a state.
    fn fill_without_mobility(&mut self, at: &State, h: f64) {
        let m = at.force.len();
        self.problem.seek_all();
        let effects = &mut self.problem.effects;
        effects.w.copy_from_slice(&self.geometry.rails().value);
        effects.y.fill(0.0);
        for i in 0..m {
            let remembers = self.active.has(i) && self.system.fixed[i].has_memory;
            effects.kind[i] = RowKind::Law;
            effects.approach[i] = self.geometry.approach(i, &at.q);
            effects.rate[i] = self.geometry.rate(i, &at.v);
            if remembers {
                let row = i * m..(i + 1) * m;
                for (y, w) in effects.y[row.clone()].iter_mut().zip(&effects.w[row]) {
                    *y = w / h;
                }
                effects.rate[i] = at.p_rate[i] + along(&effects.y, i, &at.force);
            }
        }
    }
}
