//! Motion of the degrees of freedom without the forces of elements, and the mobility for these forces.

use nalgebra::{DMatrix, DVector, Vector3};

use super::system::System;
use crate::Error;
use crate::mechanics::assembly::Mechanics;
use crate::mechanics::inertia::columns_of;
use crate::mechanics::mobility::Mobility;
use crate::mechanics::state::{Known, State};
use crate::numerics::dense::add_lines;

/// Loads, mass and mobility at one state, and the resulting motion.
pub(crate) struct FreeMotion<'a> {
    /// Accelerations a_0 = Z (f - C v - K q); in a stage also the resulting displacements and speeds.
    pub a: DVector<f64>,
    pub q: DVector<f64>,
    pub v: DVector<f64>,
    /// Forces that are independent of the elements and of the motion, with the inertia forces of carried bodies, and
    /// scratch for these forces less those of the motion.
    given: DVector<f64>,
    load: DVector<f64>,
    /// Z = (M + g C + g^2 K)^-1 of a stage, and M^-1.
    stage: Mobility<'a>,
    inverse: Mobility<'a>,
    /// Mass matrix of the bodies, including carried bodies, and scratch for it.
    mass: DMatrix<f64>,
    columns: Vec<Vector3<f64>>,
}

impl<'a> FreeMotion<'a> {
    /// # Errors
    /// A mass that is not positive definite.
    pub fn new(system: &'a System<'a>) -> Result<Self, Error> {
        let (n, bodies) = (system.mechanics.dofs, system.mechanics.body_dofs());
        Ok(FreeMotion {
            a: DVector::zeros(n),
            q: DVector::zeros(n),
            v: DVector::zeros(n),
            given: DVector::zeros(n),
            load: DVector::zeros(n),
            stage: Mobility::new(&system.mechanics)?,
            inverse: Mobility::new(&system.mechanics)?,
            mass: DMatrix::zeros(bodies, bodies),
            columns: Vec::new(),
        })
    }

    /// Sets the coefficient g of the stage's mobility.
    ///
    /// # Errors
    /// Errors of a structure that is not positive definite.
    pub fn set_step(&mut self, system: &System, g: f64) -> Result<(), Error> {
        self.stage.set_step(&system.mechanics, g)
    }

    /// Z of the stage.
    pub fn mobility(&self) -> &Mobility<'a> {
        &self.stage
    }

    /// M^-1.
    pub fn inverse(&self) -> &Mobility<'a> {
        &self.inverse
    }

    /// Motion of a stage with coefficient `g` about `at`, without forces of elements: A = Z (f - C v* - K (q* + g
    /// v*)), V = v* + g A, Q = q* + g V.
    ///
    /// # Errors
    /// A mass that is not positive definite.
    pub fn move_in_stage(
        &mut self,
        system: &System,
        g: f64,
        known: &Known,
        at: &State,
    ) -> Result<(), Error> {
        self.fill_given(system, at);
        self.set_mass(system, true)?;
        self.load
            .as_mut_slice()
            .copy_from_slice(self.given.as_slice());
        if system.mechanics.has_structures() {
            self.q.copy_from(&known.q);
            self.q.axpy(g, &known.v, 1.0);
            for block in &system.mechanics.blocks {
                block.resist(
                    known.v.as_slice(),
                    self.q.as_slice(),
                    self.load.as_mut_slice(),
                );
            }
        }
        self.stage
            .apply(self.load.as_slice(), self.a.as_mut_slice());
        self.follow(g, known);
        Ok(())
    }

    /// Sets V = v* + g A and Q = q* + g V from the present accelerations A.
    fn follow(&mut self, g: f64, known: &Known) {
        let (a, v, q) = (
            self.a.as_slice(),
            self.v.as_mut_slice(),
            self.q.as_mut_slice(),
        );
        for (v, (known, a)) in v.iter_mut().zip(known.v.as_slice().iter().zip(a)) {
            *v = known + g * a;
        }
        for (q, (known, v)) in q.iter_mut().zip(known.q.as_slice().iter().zip(v)) {
            *q = known + g * *v;
        }
    }

    /// Sets the accelerations to those of `at` plus the correction Z (f - M a - C v - K q - B^T F) for its forces F, where
    /// v = v* + g a, q = q* + g v, `acting` lists the elements with forces and `force_row` returns their rows; then
    /// updates the motion of the stage. M and f are those of the last [`FreeMotion::fill_given`].
    pub fn improve<'r>(
        &mut self,
        system: &System,
        g: f64,
        known: &Known,
        at: &State,
        acting: &[usize],
        force_row: impl Fn(usize) -> &'r [f64],
    ) {
        self.load
            .as_mut_slice()
            .copy_from_slice(self.given.as_slice());
        if let Some(constant) = system.mechanics.blocks[0].body_mass() {
            let mass = if system.mechanics.carried.is_empty() {
                constant
            } else {
                &self.mass
            };
            let columns = at.a.iter().map(|a| -a).zip(columns_of(mass));
            add_lines(columns, &mut self.load.as_mut_slice()[..mass.nrows()]);
        }
        if system.mechanics.has_structures() {
            self.a.copy_from(&at.a);
            self.follow(g, known);
            for block in &system.mechanics.blocks {
                block.resist_acceleration(self.a.as_slice(), self.load.as_mut_slice());
                block.resist(
                    self.v.as_slice(),
                    self.q.as_slice(),
                    self.load.as_mut_slice(),
                );
            }
            for coupling in &system.mechanics.couplings {
                coupling.resist_acceleration(self.a.as_slice(), self.load.as_mut_slice());
            }
        }
        add_lines(
            acting.iter().map(|&j| (-at.force[j], force_row(j))),
            self.load.as_mut_slice(),
        );
        self.stage
            .apply(self.load.as_slice(), self.a.as_mut_slice());
        for (a, own) in self.a.as_mut_slice().iter_mut().zip(at.a.as_slice()) {
            *a += own;
        }
        self.follow(g, known);
    }

    /// Accelerations of `at` due to all forces: M^-1 (f - C v - K q - B^T F), with the rows B of all elements.
    ///
    /// # Errors
    /// A mass that is not positive definite.
    pub fn accelerate(
        &mut self,
        system: &System,
        at: &mut State,
        rows: &[f64],
    ) -> Result<(), Error> {
        self.fill_given(system, at);
        self.set_mass(system, false)?;
        self.load
            .as_mut_slice()
            .copy_from_slice(self.given.as_slice());
        for block in &system.mechanics.blocks {
            block.resist(at.v.as_slice(), at.q.as_slice(), self.load.as_mut_slice());
        }
        let rows = rows.chunks_exact(self.load.len().max(1));
        add_lines(
            at.force.iter().map(|force| -force).zip(rows),
            self.load.as_mut_slice(),
        );
        self.inverse
            .apply(self.load.as_slice(), at.a.as_mut_slice());
        Ok(())
    }

    /// M^-1 times the forces at `t` that are independent of the elements.
    pub fn accelerations(&mut self, system: &System, t: f64) -> &DVector<f64> {
        self.fill_loads(system, t);
        self.inverse
            .apply(self.given.as_slice(), self.a.as_mut_slice());
        &self.a
    }

    /// Weights, loads, and the inertia forces of a prescribed x on the other degrees of freedom.
    fn fill_loads(&mut self, system: &System, t: f64) {
        self.given
            .as_mut_slice()
            .copy_from_slice(system.mechanics.gravity.as_slice());
        for load in &system.scene.actuators.loads {
            if let Some(number) = system.mechanics.loaded(load) {
                self.given[number] += load.value.at(t);
            }
        }
        for (b, body) in system.scene.bodies.iter().enumerate() {
            let Some(profile) = &body.motion else {
                continue;
            };
            let acceleration = profile.at(t).a;
            if acceleration == 0.0 {
                continue;
            }
            for &(number, inertia) in system.mechanics.kinematics.travel_inertia(b) {
                self.given[number] -= inertia * acceleration;
            }
        }
    }

    /// Fills the forces that are independent of the elements, and the mass matrix of the bodies with the inertia of carried
    /// bodies, at the time, displacements and speeds of `at`.
    pub fn fill_given(&mut self, system: &System, at: &State) {
        self.fill_loads(system, at.t);
        let mechanics = &system.mechanics;
        let Some(constant) = changed_mass(mechanics) else {
            return;
        };
        self.mass
            .as_mut_slice()
            .copy_from_slice(constant.as_slice());
        let sums = (&mut self.mass, &mut self.given);
        mechanics.carried.add(
            &mechanics.kinematics,
            (at.t, &at.q, &at.v),
            sums,
            &mut self.columns,
        );
    }

    /// Updates the mobility of a stage, or M^-1, to the mass matrix, where carried bodies change it.
    fn set_mass(&mut self, system: &System, in_stage: bool) -> Result<(), Error> {
        if changed_mass(&system.mechanics).is_none() {
            return Ok(());
        }
        let mobility = if in_stage {
            &mut self.stage
        } else {
            &mut self.inverse
        };
        mobility.set_mass(&self.mass)
    }
}

/// The constant part of the mass matrix of the bodies, where carried bodies change the matrix.
fn changed_mass<'a>(mechanics: &'a Mechanics<'_>) -> Option<&'a DMatrix<f64>> {
    mechanics.blocks[0]
        .body_mass()
        .filter(|_| !mechanics.carried.is_empty())
}
