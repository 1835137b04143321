//! Steps of a diagonally implicit Runge-Kutta method. In every stage the contact forces are solved once.

use nalgebra::DVector;

use super::tableau::{SDIRK4, Tableau};
use crate::contact::solver::Solver;
use crate::contact::system::System;
use crate::mechanics::state::{Known, State};
use crate::record::energy::power;
use crate::{Error, Exchanged};

/// The stages of one step.
pub(crate) struct Sdirk {
    tableau: &'static Tableau,
    stage: State,
    known: Known,
    done: Vec<Done>,
}

/// Results of a stage that later stages, the error and the audit use.
struct Done {
    accelerations: DVector<f64>,
    rates: DVector<f64>,
    p_rates: Vec<f64>,
    forces: Vec<f64>,
    power: Exchanged,
    /// Largest force by which a vertical contact had exceeded its limit of opening or closing, before the end of the step.
    excess: f64,
}

impl Sdirk {
    pub fn new(system: &System, start: &State) -> Self {
        let (n, count) = (system.mechanics.dofs, start.p.len());
        let tableau = &SDIRK4;
        let done = || Done {
            accelerations: DVector::zeros(n),
            rates: DVector::zeros(n),
            p_rates: vec![0.0; count],
            forces: vec![0.0; system.elements.len()],
            power: Exchanged::default(),
            excess: f64::NEG_INFINITY,
        };
        Sdirk {
            tableau,
            stage: start.clone(),
            known: Known { q: DVector::zeros(n), v: DVector::zeros(n), p: vec![0.0; count] },
            done: std::iter::repeat_with(done).take(tableau.stages()).collect(),
        }
    }

    /// Takes a step of length `h` from `from` with the active elements; returns false if a stage does not converge.
    /// `stages` counts the stages. Afterwards the geometry of the solver is that of the last stage.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn attempt(
        &mut self,
        solver: &mut Solver,
        from: &State,
        h: f64,
        limit: f64,
        (to, stages): (&mut State, &mut usize),
    ) -> Result<bool, Error> {
        let tableau = self.tableau;
        let gamma_h = tableau.gamma * h;
        self.stage.copy_from(from);
        solver.begin_step(from, h);
        for i in 0..tableau.stages() {
            self.fill_known(solver, from, h, i);
            // The stage is evaluated just before the limit, because a prescribed motion may jump there.
            self.stage.t = (from.t + tableau.c[i] * h).min(limit.next_down());
            self.guess(solver, from, i);
            *stages += 1;
            if !solver.stage(gamma_h, &mut self.known, &mut self.stage)? {
                return Ok(false);
            }
            let done = &mut self.done[i];
            done.forces.copy_from_slice(&self.stage.force);
            done.accelerations.copy_from(&self.stage.a);
            done.rates.copy_from(&self.stage.v);
            solver.end_stage(&self.stage, [&mut done.rates, &mut done.accelerations]);
            done.p_rates.copy_from_slice(&self.stage.p_rate);
            if solver.system().traits.has_motions {
                solver.update_rail_slope(&self.stage);
            }
            done.power = power(solver.system(), solver.geometry(), &self.stage);
            if tableau.c[i] < 1.0 {
                let frame = solver.frame(&self.stage);
                // A penetration that is a state has only the first order inside a step.
                let exact = (0..solver.system().verticals()).filter(|&i| !solver.remembers(i));
                done.excess = exact.map(|i| solver.excess(i, &frame)).fold(f64::NEG_INFINITY, f64::max);
            }
        }
        solver.end_step(&self.stage)?;
        to.copy_from(&self.stage);
        Ok(to.q.iter().chain(to.v.iter()).all(|x| x.is_finite()))
    }

    /// Computes the known parts of stage `i` from the start of the step and the previous stages.
    fn fill_known(&mut self, solver: &Solver, from: &State, h: f64, i: usize) {
        let known = &mut self.known;
        known.q.copy_from(&from.q);
        known.v.copy_from(&from.v);
        solver.begin_stage(known);
        known.p.copy_from_slice(&from.p);
        for (weight, done) in self.tableau.a[i].iter().zip(&self.done) {
            known.q.axpy(h * weight, &done.rates, 1.0);
            known.v.axpy(h * weight, &done.accelerations, 1.0);
            for (p, rate) in known.p.iter_mut().zip(&done.p_rates) {
                *p += h * weight * rate;
            }
        }
    }

    /// Extrapolates accelerations and forces of stage `i` by the polynomial through those at the start of the step
    /// and of the previous stages [`Tableau::guess`].
    fn guess(&mut self, solver: &Solver, from: &State, i: usize) {
        if i == 0 || !solver.system().mechanics.moves_freely {
            return;
        }
        let (c, stages) = (self.tableau.c, self.tableau.guess[i]);
        // Lagrange weights of 0 and the abscissae of these stages.
        let node = |j: usize| j.checked_sub(1).map_or(0.0, |j| c[stages[j]]);
        let weight = |j: usize| {
            let others = (0..=stages.len()).filter(|&k| k != j);
            others.map(|k| (c[i] - node(k)) / (node(j) - node(k))).product::<f64>()
        };
        let is_guessed = |k: &usize| !solver.is_charted(*k);
        let (first, stage) = (weight(0), &mut self.stage);
        for k in (0..stage.a.len()).filter(is_guessed) {
            stage.a[k] = first * from.a[k];
        }
        stage.force.iter_mut().zip(&from.force).for_each(|(to, from)| *to = first * from);
        for (j, &before) in stages.iter().enumerate() {
            let (share, done) = (weight(j + 1), &self.done[before]);
            for k in (0..stage.a.len()).filter(is_guessed) {
                stage.a[k] += share * done.accelerations[k];
            }
            stage.force.iter_mut().zip(&done.forces).for_each(|(to, from)| *to += share * from);
        }
    }

    /// Stages of the step just taken, as fractions of it, with the largest force by which a vertical contact had exceeded its
    /// limit of opening or closing there.
    pub fn excesses(&self) -> impl Iterator<Item = (f64, f64)> {
        self.tableau.c.iter().zip(&self.done).map(|(share, done)| (*share, done.excess))
    }

    /// Embedded error of q and v of degree of freedom `k`, per unit of step length.
    pub fn error(&self, k: usize) -> [f64; 2] {
        let mut error = [0.0; 2];
        for (weight, done) in self.tableau.error.iter().zip(&self.done) {
            error[0] += weight * done.rates[k];
            error[1] += weight * done.accelerations[k];
        }
        error
    }

    /// Error of the penetration rate in the last stage that follows from the embedded error of penetration `i`.
    pub fn rate_error(&self, i: usize) -> f64 {
        let error: f64 =
            self.tableau.error.iter().zip(&self.done).map(|(weight, done)| weight * done.p_rates[i]).sum();
        error / self.tableau.gamma
    }

    /// Energy exchanged in the step of length `h`, by the quadrature of the Runge-Kutta weights.
    pub fn exchanged(&self, h: f64) -> Exchanged {
        let mut sum = Exchanged::default();
        for (i, done) in self.done.iter().enumerate() {
            sum.add(&done.power, h * self.tableau.weight(i));
        }
        sum
    }

    /// Time of the last stage.
    pub fn time(&self) -> f64 {
        self.stage.t
    }
}
