//! Static equilibrium of a model, and the quasi-static path.
//!
//! `iterate` numbers the unknowns and holds their values. `balance` evaluates the equations, among them the
//! prescribed displacements of `motion`. `search` solves them by Newton's method, with pseudo-transient
//! continuation where it fails. `assemble` satisfies constraints and loops before. `near` starts from a state with
//! known VARIABLEs.

mod assemble;
mod balance;
mod equilibrium;
mod iterate;
mod motion;
mod near;
mod search;

use crate::{AdamsModel, Error, ModelState};
pub use equilibrium::{ConstraintReaction, Equilibrium};
pub use iterate::RotationMeasure;
pub use near::{EquationResidual, NewtonStep};
use search::search;

impl AdamsModel {
    /// The static equilibrium at a time, near a guess.
    ///
    /// The unknowns are the positions and finite rotations of all moving parts, the torn VARIABLEs of
    /// algebraic loops, the values DIF of all DIFFs without STATIC_HOLD, and one reaction for every scalar
    /// equation of a JOINT, JPRIM or MOTION. The equations are the balance of forces and torques of every
    /// part, the constraints, the loops, and DIF1 = 0. Parts are first moved by the smallest displacements
    /// that satisfy the constraints and motions. The equations are then solved together by Newton's method
    /// with exact derivatives, and those of loops and DIFFs once more after every step. Velocities are zero
    /// and MODE is 5. Where Newton's method does not converge, as for a wheel above its rail, the parts first
    /// approach equilibrium against a viscous resistance that is reduced step by step.
    ///
    /// Degrees of freedom that no equation determines take the step of least norm, with lengths measured in
    /// the size of the model; redundant constraints divide their reaction in the same sense. A MOTION in
    /// VELOCITY prescribes the integral of its expression of TIME, starting from ICDISP at time zero.
    ///
    /// # Errors
    /// [`Error::Equilibrium`] with the statement that has the largest residual; the errors of
    /// [`AdamsModel::solve`].
    ///
    /// # Source
    /// E. J. Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems (1989), chapter 10, with
    /// reactions along the axes of the constraints. Pseudo-transient continuation: C. T. Kelley, D. E. Keyes,
    /// SIAM Journal on Numerical Analysis 35(2), 1998.
    ///
    /// ```
    /// use adams::{DataSet, AdamsModel};
    ///
    /// let set = DataSet::read("pendulum
    /// PART/1, GROUND
    /// MARKER/1, PART=1
    /// PART/2, MASS=3, CM=3, IP=1,1,1
    /// MARKER/2, PART=2
    /// MARKER/3, PART=2, QP=1,0,0
    /// JOINT/1, SPHERICAL, I=2, J=1
    /// ACCGRAV/KGRAV=-9.81
    /// END")?;
    /// let model = AdamsModel::new(&set)?;
    /// let rest = model.equilibrium(0.0, &model.initial())?;
    /// assert!((rest.reactions[&("JOINT", 1)].force.z - 3.0 * 9.81).abs() < 1e-9);
    /// # Ok::<(), adams::Error>(())
    /// ```
    pub fn equilibrium(&self, time: f64, guess: &ModelState) -> Result<Equilibrium, Error> {
        search(
            self,
            &ModelState {
                time,
                ..guess.clone()
            },
            None,
        )
    }

    /// The static equilibria at several times, each found from the one before: the quasi-static path. The
    /// first starts from the initial state.
    ///
    /// # Errors
    /// The errors of [`AdamsModel::equilibrium`].
    pub fn quasi_static_path(&self, times: &[f64]) -> Result<Vec<Equilibrium>, Error> {
        let mut out: Vec<Equilibrium> = Vec::with_capacity(times.len());
        for time in times {
            let before = out.last();
            let guess = before.map_or_else(|| self.initial(), |one| one.state.clone());
            let next = search(
                self,
                &ModelState {
                    time: *time,
                    ..guess
                },
                before,
            )?;
            out.push(next);
        }
        Ok(out)
    }
}
