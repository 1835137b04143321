//! Book-keeping of a run: energy exchanged step by step, and how far the balance is off.

use crate::contact::solver::Solver;
use crate::mechanics::state::State;
use crate::record::energy::{boundary, stored};
use crate::{Audit, Exchanged, Stored};

/// The audit of a run in progress.
pub(crate) struct Books {
    audit: Audit,
    /// Energy stored at the start.
    begun: f64,
    /// Boundary term of the dampers to ground where the next step starts.
    boundary: f64,
}

impl Books {
    /// Opens the books at `start`, to which the solver's geometry belongs.
    pub fn new(solver: &Solver, start: &State) -> Self {
        let energy = stored(solver.system(), solver.geometry(), start);
        Books {
            audit: Audit { start: energy, end: energy, ..Audit::default() },
            begun: energy.total(),
            boundary: boundary(solver.system(), solver.geometry(), start),
        }
    }

    /// The audit so far.
    pub fn audit(&self) -> Audit {
        self.audit
    }

    /// Books what a step has `exchanged` until it reached `to`, before a break or an event changes the forces there.
    pub fn book_step(&mut self, solver: &Solver, exchanged: &Exchanged, to: &State) {
        self.audit.exchanged.add(exchanged, 1.0);
        let end = boundary(solver.system(), solver.geometry(), to);
        self.audit.exchanged.dampers += end - self.boundary;
    }

    /// Books work of prescribed motions where their speed jumps.
    pub fn book_jump(&mut self, work: f64) {
        self.audit.exchanged.drives += work;
    }

    /// Books energy that steps of rails put in.
    pub fn book_rail(&mut self, energy: f64) {
        self.audit.exchanged.rail_steps += energy;
    }

    /// Books energy that is lost where elements begin or cease to act.
    pub fn book_switch(&mut self, loss: f64) {
        self.audit.exchanged.switches += loss;
    }

    /// Closes a step at `to` with the energy `after`: the peak, the imbalance, and the boundary of the next step.
    pub fn close_step(&mut self, solver: &Solver, to: &State, after: Stored) {
        self.turn_page(solver, to, after);
        let mut elastic = after.contact + after.structure + after.ropes;
        if !solver.system().springs().is_empty() {
            elastic = elastic.max(after.kinetic);
        }
        self.audit.peak_stored = self.audit.peak_stored.max(elastic);
        let imbalance = (after.total() + self.audit.exchanged.net_loss() - self.begun).abs();
        self.audit.imbalance = self.audit.imbalance.max(imbalance);
    }

    /// Takes the energy `after` at `to` for that of the start of the next step.
    pub fn turn_page(&mut self, solver: &Solver, to: &State, after: Stored) {
        self.audit.end = after;
        self.boundary = boundary(solver.system(), solver.geometry(), to);
    }
}
