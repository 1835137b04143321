//! Energy accounting of a run: the energy exchanged in each step and the error of the balance.

use crate::contact::solver::Solver;
use crate::mechanics::state::State;
use crate::record::energy::{boundary, stored};
use crate::{Audit, EnergyGap, Exchanged, GapCause, Stored};

/// The audit of a run in progress.
pub(crate) struct Books {
    audit: Audit,
    /// Total energy stored at the start.
    begun: f64,
    /// Signed imbalance so far.
    imbalance: f64,
    /// Boundary term of the dampers to ground at the start of the next step.
    boundary: f64,
}

impl Books {
    /// Starts the audit at `start`, for which the geometry of the solver must be current.
    pub fn new(solver: &Solver, start: &State) -> Self {
        let energy = stored(solver.system(), solver.geometry(), start);
        Books {
            audit: Audit {
                start: energy,
                end: energy,
                ..Audit::default()
            },
            begun: energy.total(),
            imbalance: 0.0,
            boundary: boundary(solver.system(), solver.geometry(), start),
        }
    }

    /// The audit so far.
    pub fn audit(&self) -> Audit {
        self.audit
    }

    /// Adds the energy `exchanged` in a step that reached `to`, before a break or an event changes the forces there.
    pub fn book_step(&mut self, solver: &Solver, exchanged: &Exchanged, to: &State) {
        self.audit.exchanged.add(exchanged, 1.0);
        let end = boundary(solver.system(), solver.geometry(), to);
        self.audit.exchanged.dampers += end - self.boundary;
    }

    /// Energy gained in a step that exchanged the energy `exchanged` and reached `to`, where the energy `after` is stored.
    pub fn gap(&self, solver: &Solver, exchanged: &Exchanged, to: &State, after: Stored) -> f64 {
        let dampers = boundary(solver.system(), solver.geometry(), to) - self.boundary;
        after.total() - self.audit.end.total() + exchanged.net_loss() + dampers
    }

    /// Adds the work of prescribed motions at a jump of their speed.
    pub fn book_jump(&mut self, work: f64) {
        self.audit.exchanged.drives += work;
    }

    /// Adds the energy that steps in the rail profile supply.
    pub fn book_rail(&mut self, energy: f64) {
        self.audit.exchanged.rail_steps += energy;
    }

    /// Adds the energy that is lost where elements become active or inactive.
    pub fn book_switch(&mut self, loss: f64) {
        self.audit.exchanged.switches += loss;
    }

    /// Completes a step at `to` with the stored energy `after`: updates the peak, the imbalance, of which `cause` explains
    /// the change, and the boundary term for the next step.
    pub fn close_step(&mut self, solver: &Solver, to: &State, after: Stored, cause: GapCause) {
        self.turn_page(solver, to, after);
        let mut elastic = after.contact + after.structure + after.ropes;
        if !solver.system().springs().is_empty() {
            elastic = elastic.max(after.kinetic);
        }
        self.audit.peak_stored = self.audit.peak_stored.max(elastic);
        let imbalance = after.total() + self.audit.exchanged.net_loss() - self.begun;
        self.audit.imbalance = self.audit.imbalance.max(imbalance.abs());
        let energy = imbalance - std::mem::replace(&mut self.imbalance, imbalance);
        self.audit.gaps.add(EnergyGap {
            time: to.t,
            energy,
            cause,
        });
    }

    /// Uses the energy `after` at `to` as that of the start of the next step.
    pub fn turn_page(&mut self, solver: &Solver, to: &State, after: Stored) {
        self.audit.end = after;
        self.boundary = boundary(solver.system(), solver.geometry(), to);
    }
}
