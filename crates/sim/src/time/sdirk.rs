//! Steps of diagonally implicit Runge-Kutta methods. In every stage the contact forces are solved once.
//!
//! The first stage of ESDIRK5 is the start of the step, whose accelerations and rates of penetrations are those of the last
//! stage of the step before. Where they jump, or a transient follows that no step resolves, they would not be damped: Y_1 =
//! y_0 (1 + gamma z)/(1 - gamma z) tends to -y_0. The first step after a break or an event is therefore one of SDIRK4, whose
//! stages do not depend on them.

use nalgebra::DVector;

use super::guesses::Guesses;
use super::tableau::{ESDIRK5, SDIRK4, Tableau};
use crate::contact::solver::Solver;
use crate::contact::system::System;
use crate::mechanics::state::{Known, State};
use crate::record::energy::power;
use crate::{Error, Exchanged, Method};

/// The stages of one step.
pub(crate) struct Sdirk {
    /// The method of steps that go on smoothly.
    smooth: &'static Tableau,
    /// The method of the step just taken.
    tableau: &'static Tableau,
    /// Guesses of the stages of steps after breaks and events, and of other steps.
    guesses: [Guesses; 2],
    /// Powers at the start of the next step.
    power: Exchanged,
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
    pub fn new(system: &System, start: &State, method: Method) -> Self {
        let (n, count) = (system.mechanics.dofs, start.p.len());
        let smooth = if method == Method::Esdirk5 {
            &ESDIRK5
        } else {
            &SDIRK4
        };
        let done = || Done {
            accelerations: DVector::zeros(n),
            rates: DVector::zeros(n),
            p_rates: vec![0.0; count],
            forces: vec![0.0; system.elements.len()],
            power: Exchanged::default(),
            excess: f64::NEG_INFINITY,
        };
        Sdirk {
            smooth,
            tableau: smooth,
            guesses: [&SDIRK4, smooth].map(Guesses::new),
            power: Exchanged::default(),
            stage: start.clone(),
            known: Known {
                q: DVector::zeros(n),
                v: DVector::zeros(n),
                p: vec![0.0; count],
            },
            done: std::iter::repeat_with(done)
                .take(ESDIRK5.stages().max(SDIRK4.stages()))
                .collect(),
        }
    }

    /// The method of a step that `begins_smoothly`, or after a break or an event.
    fn tableau(&self, begins_smoothly: bool) -> &'static Tableau {
        if begins_smoothly {
            self.smooth
        } else {
            &SDIRK4
        }
    }

    /// Length of a step that `begins_smoothly`, or after a break or an event, relative to one that begins smoothly with the same
    /// error, and the power of the length with which its estimated error decreases.
    pub fn lengths(&self, begins_smoothly: bool) -> [f64; 2] {
        let own = self.tableau(begins_smoothly);
        [own.length / self.smooth.length, own.error_power]
    }

    /// Largest tolerance of steps for the errors of forces.
    pub fn loosest(&self) -> f64 {
        self.smooth.loosest
    }

    /// Notes the powers at the start of the next step, `from`, to which the geometry of the solver must belong.
    pub fn note_start(&mut self, solver: &Solver, from: &State) {
        if self.smooth.weight(0) != 0.0 {
            self.power = power(solver.system(), solver.geometry(), from);
        }
    }

    /// Takes a step of length `h` from `from` with the active elements; returns false if a stage does not converge.
    /// `begins_smoothly` is false after a break or an event, `stages` counts the stages. Afterwards the geometry of the solver is
    /// that of the last stage.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn attempt(
        &mut self,
        solver: &mut Solver,
        from: &State,
        h: f64,
        (limit, begins_smoothly): (f64, bool),
        (to, stages): (&mut State, &mut usize),
    ) -> Result<bool, Error> {
        self.tableau = self.tableau(begins_smoothly);
        // Where an element that was left out touches, the step is repeated with all of them.
        for takes_all in [false, true] {
            solver.begin_step(from, h, takes_all);
            if !self.take_stages(solver, from, [h, limit], stages)? {
                return Ok(false);
            }
            if solver.is_complete(&self.stage) {
                break;
            }
        }
        to.copy_from(&self.stage);
        Ok(to.q.iter().chain(to.v.iter()).all(|x| x.is_finite()))
    }

    /// Takes all stages of a step of length `h` from `from`, which ends at `limit` at the latest; returns false if one does not
    /// converge.
    fn take_stages(
        &mut self,
        solver: &mut Solver,
        from: &State,
        [h, limit]: [f64; 2],
        stages: &mut usize,
    ) -> Result<bool, Error> {
        let tableau = self.tableau;
        let gamma_h = tableau.gamma * h;
        self.stage.copy_from(from);
        self.start(solver, from);
        for i in 1..tableau.stages() {
            self.fill_known(solver, from, h, i);
            // The stage is evaluated just before the limit, because a prescribed motion may jump there.
            self.stage.t = (from.t + tableau.c[i] * h).min(limit.next_down());
            self.guess(solver, i);
            *stages += 1;
            let ends_step = i + 1 == tableau.stages();
            if !solver.stage(gamma_h, &mut self.known, &mut self.stage, ends_step)? {
                return Ok(false);
            }
            self.note_stage(solver, i);
        }
        Ok(true)
    }

    /// Stores the results of stage `i`, to which the geometry of the solver belongs.
    fn note_stage(&mut self, solver: &mut Solver, i: usize) {
        let done = &mut self.done[i];
        done.forces.copy_from_slice(&self.stage.force);
        done.accelerations
            .as_mut_slice()
            .copy_from_slice(self.stage.a.as_slice());
        done.rates
            .as_mut_slice()
            .copy_from_slice(self.stage.v.as_slice());
        solver.end_stage(&self.stage, [&mut done.rates, &mut done.accelerations]);
        done.p_rates.copy_from_slice(&self.stage.p_rate);
        if solver.system().traits.has_motions {
            solver.update_rail_slope(&self.stage);
        }
        done.power = power(solver.system(), solver.geometry(), &self.stage);
        if self.tableau.c[i] < 1.0 {
            let frame = solver.frame(&self.stage);
            // A penetration that is a state has only the first order inside a step.
            let exact = (0..solver.system().verticals()).filter(|&i| !solver.remembers(i));
            done.excess = exact
                .map(|i| solver.excess(i, &frame))
                .fold(f64::NEG_INFINITY, f64::max);
        }
    }

    /// Sets the first stage to the start of the step.
    fn start(&mut self, solver: &mut Solver, from: &State) {
        let done = &mut self.done[0];
        done.forces.copy_from_slice(&from.force);
        done.accelerations
            .as_mut_slice()
            .copy_from_slice(from.a.as_slice());
        if self.tableau.weight(0) == 0.0 {
            return;
        }
        done.rates.as_mut_slice().copy_from_slice(from.v.as_slice());
        solver.end_stage(from, [&mut done.rates, &mut done.accelerations]);
        done.p_rates.copy_from_slice(&from.p_rate);
        done.power = self.power;
    }

    /// Computes the known parts of stage `i` from the start of the step and the previous stages.
    fn fill_known(&mut self, solver: &Solver, from: &State, h: f64, i: usize) {
        let known = &mut self.known;
        known.q.as_mut_slice().copy_from_slice(from.q.as_slice());
        known.v.as_mut_slice().copy_from_slice(from.v.as_slice());
        solver.begin_stage(known);
        known.p.copy_from_slice(&from.p);
        let weights = self.tableau.a[i].iter().zip(&self.done);
        for (weight, done) in weights.filter(|(weight, _)| **weight != 0.0) {
            let share = h * weight;
            add(share, done.rates.as_slice(), known.q.as_mut_slice());
            add(share, done.accelerations.as_slice(), known.v.as_mut_slice());
            add(share, &done.p_rates, &mut known.p);
        }
    }

    /// Sets accelerations and forces of stage `i` to a guess from those of the stages before it.
    fn guess(&mut self, solver: &Solver, i: usize) {
        if !solver.system().mechanics.moves_freely {
            return;
        }
        let Sdirk {
            tableau,
            stage,
            done,
            ..
        } = self;
        let acts_alike = |later: &Done| {
            later
                .forces
                .iter()
                .zip(&done[0].forces)
                .all(|(a, b)| (*a == 0.0) == (*b == 0.0))
        };
        let is_smooth = done[1..i].iter().all(acts_alike);
        let guesses = &self.guesses[usize::from(std::ptr::eq(*tableau, self.smooth))];
        let weights = guesses.of_stage(i, is_smooth);
        if weights.is_empty() {
            return;
        }
        let is_guessed = |k: &usize| !solver.is_charted(*k);
        for k in (0..stage.a.len()).filter(is_guessed) {
            stage.a[k] = weights
                .iter()
                .map(|&(j, weight)| weight * done[j].accelerations[k])
                .sum();
        }
        stage.force.fill(0.0);
        for &(j, weight) in weights {
            add(weight, &done[j].forces, &mut stage.force);
        }
    }

    /// Stages of the step just taken, as fractions of it, with the largest force by which a vertical contact had exceeded its
    /// limit of opening or closing there.
    pub fn excesses(&self) -> impl Iterator<Item = (f64, f64)> {
        self.tableau
            .c
            .iter()
            .zip(&self.done)
            .skip(1)
            .map(|(share, done)| (*share, done.excess))
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
        let error: f64 = self
            .tableau
            .error
            .iter()
            .zip(&self.done)
            .map(|(weight, done)| weight * done.p_rates[i])
            .sum();
        error / self.tableau.gamma
    }

    /// Energy exchanged in the step of length `h`, by the quadrature of the Runge-Kutta weights.
    pub fn exchanged(&self, h: f64) -> Exchanged {
        let mut sum = Exchanged::default();
        for (i, done) in self.done.iter().take(self.tableau.stages()).enumerate() {
            sum.add(&done.power, h * self.tableau.weight(i));
        }
        sum
    }

    /// Time of the last stage.
    pub fn time(&self) -> f64 {
        self.stage.t
    }
}

/// Adds `share` times `from` to `to`.
fn add(share: f64, from: &[f64], to: &mut [f64]) {
    to.iter_mut()
        .zip(from)
        .for_each(|(to, from)| *to += share * from);
}
