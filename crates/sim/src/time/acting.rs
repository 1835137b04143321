//! What acts in a step and may be another in the next.

use crate::contact::link::Hold;
use crate::contact::solver::Solver;

/// Contacts, ropes and stops that act, and the stretches of uneven rail below the wheels.
#[derive(Clone)]
pub(crate) struct Acting {
    active: Vec<bool>,
    kept: Vec<Option<[f64; 2]>>,
    links: Vec<Hold>,
    piece: Vec<usize>,
}

impl Acting {
    /// As `solver` has them.
    pub fn of(solver: &Solver) -> Self {
        Acting {
            active: solver.active.clone(),
            kept: solver.kept.clone(),
            links: solver.geometry.links.clone(),
            piece: solver.geometry.piece.clone(),
        }
    }

    /// Takes them from `solver`.
    pub fn take(&mut self, solver: &Solver) {
        self.active.clone_from(&solver.active);
        self.kept.clone_from(&solver.kept);
        self.links.clone_from(&solver.geometry.links);
        self.piece.clone_from(&solver.geometry.piece);
    }

    /// Gives them back to `solver`.
    pub fn give(&self, solver: &mut Solver) {
        solver.active.clone_from(&self.active);
        solver.kept.clone_from(&self.kept);
        solver.geometry.links.clone_from(&self.links);
        solver.geometry.piece.clone_from(&self.piece);
    }
}
