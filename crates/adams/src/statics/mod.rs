//! Static equilibrium of a whole data set.

mod balance;
mod drive;
mod place;
mod search;

use crate::{Error, Model, Solution, State};
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// A data set at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    /// Where the parts are; DIFs such that DIF1 is zero.
    pub state: State,
    /// VARIABLEs, forces and requests there.
    pub solution: Solution,
    /// What every JOINT, JPRIM and MOTION does to its I, by keyword and identifier.
    pub reactions: BTreeMap<(&'static str, u32), Reaction>,
    /// Newton iterations.
    pub iterations: usize,
    /// Freedoms that nothing determines, such as the spin of a wheel without torque, and constraints that say
    /// the same.
    pub undetermined: usize,
}

/// A force and torque on the marker I at I, along ground axes; J has the opposite at the same place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reaction {
    /// Force.
    pub force: Vector3<f64>,
    /// Torque about I.
    pub torque: Vector3<f64>,
}

impl Model {
    /// Static equilibrium at a time, near a guess.
    ///
    /// Unknown are the places and finite rotations of all moving parts, the VARIABLEs of loops, the DIFs (with
    /// every DIF1 zero; STATIC_HOLD keeps a DIF) and a reaction for every equation of a JOINT, JPRIM or
    /// MOTION. Equations are force and torque on every part, the constraints, the loops and the right-hand
    /// sides of the DIFFs, solved together by Newton's method with exact derivatives. Velocities are zero, MODE
    /// is 5. Where Newton's method fails, as for a wheel above its rail, parts are first let down as if in a
    /// viscous fluid that thins out.
    ///
    /// Freedoms that nothing determines stay as near to the guess as they can (least norm of the step, lengths
    /// by the size of the model), and of constraints that say the same each carries its share.
    ///
    /// A MOTION in VELOCITY holds the integral of its expression of TIME, from ICDISP at time zero.
    ///
    /// # Errors
    /// [`Error::Equilibrium`] with the statement farthest from it; those of [`Model::solve`].
    ///
    /// # Source
    /// E. J. Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems (1989), chapter 10, with
    /// reactions along the constraints' own axes; pseudo-transient continuation: C. T. Kelley, D. E. Keyes, SIAM
    /// Journal on Numerical Analysis 35(2), 1998.
    pub fn equilibrium(&self, time: f64, guess: &State) -> Result<Equilibrium, Error> {
        search::search(self, &State { time, ..guess.clone() }, None)
    }

    /// Static equilibria at several times, each from the one before: the quasi-static path.
    ///
    /// # Errors
    /// Those of [`Model::equilibrium`].
    pub fn path(&self, times: &[f64]) -> Result<Vec<Equilibrium>, Error> {
        let mut out: Vec<Equilibrium> = Vec::with_capacity(times.len());
        for time in times {
            let before = out.last();
            let guess = before.map_or_else(|| self.initial(), |one| one.state.clone());
            let next = search::search(self, &State { time: *time, ..guess }, before)?;
            out.push(next);
        }
        Ok(out)
    }
}
