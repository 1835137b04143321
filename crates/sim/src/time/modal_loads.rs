//! Errors of the accelerations of natural modes, relative to their loads.

use crate::contact::solver::Solver;
use crate::contact::system::System;

/// Error of an acceleration that counts like the error 1 of a wheel force: reactions and internal forces are sums over many
/// modes, of which each has a part.
const ALLOWED: f64 = 30.0;

/// The largest loads of natural modes in a run of collocation.
///
/// A mode q'' + 2 zeta omega q' + omega^2 q = phi F follows its load exactly, but the load is a polynomial in each step, and
/// what it misses goes on as a free vibration of the amplitude dq. In the displacements of the rail the high modes are small.
/// Reactions and internal forces take part in the accelerations, omega^2 dq, which are as large as the loads.
pub(crate) struct ModalLoads {
    /// Largest displacement of each degree of freedom at a wheel so far.
    reach: Vec<f64>,
}

impl ModalLoads {
    pub fn new(system: &System) -> ModalLoads {
        ModalLoads {
            reach: vec![0.0; system.mechanics.dofs],
        }
    }

    /// Takes the displacements at the wheels for the geometry of the solver.
    pub fn grow(&mut self, solver: &Solver) {
        for i in 0..solver.system().verticals() {
            let row = solver.geometry().rows().approach_row(i);
            self.reach
                .iter_mut()
                .zip(row)
                .for_each(|(reach, own)| *reach = reach.max(own.abs()));
        }
    }

    /// Error of the acceleration of degree of freedom `k` by the error `dq` of its displacement in a step, relative to
    /// [`ALLOWED`] times its load under the force `largest`; 0 for a degree of freedom that is no natural mode.
    pub fn relative(&self, system: &System, k: usize, dq: f64, largest: f64) -> f64 {
        let (omega, load) = (
            system.mechanics.omegas[k].unwrap_or(0.0),
            self.reach[k] * largest,
        );
        if load > 0.0 {
            omega * omega * dq.abs() / (ALLOWED * load)
        } else {
            0.0
        }
    }
}
