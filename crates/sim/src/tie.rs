//! Inertia between the bodies and the structures that ride on them: B of
//! M = [M_b, B^T; B, M_s], B the momentum of the structure's freedoms by the motion of its carrier.
//!
//! With Z_s = (M_s + g C_s + g^2 K_s)^-1, the bodies answer through the inverse of S = M_b - B^T Z_s B.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use crate::kinematics::Kinematics;
use crate::matter::{Block, Mobility};
use crate::system::System;
use crate::{Error, Mount};

/// B of one structure.
pub(crate) struct Tie {
    /// Freedoms of the structure.
    range: Range<usize>,
    /// Freedoms of the structure x freedoms of the bodies.
    between: DMatrix<f64>,
}

impl Tie {
    /// B of the structure of freedoms `range` on `mount`, of `bodies` freedoms; `None` where nothing couples them.
    pub fn new(kinematics: &Kinematics, mount: &Mount, range: Range<usize>, bodies: usize) -> Option<Tie> {
        let mut between = DMatrix::zeros(range.len(), bodies);
        for (k, shares) in mount.coupling.iter().enumerate() {
            for (number, inertia) in kinematics.combine(mount.body, shares) {
                between[(k, number)] += inertia;
            }
        }
        (between.amax() > 0.0).then_some(Tie { range, between })
    }

    /// v_s^T B v_b.
    pub fn kinetic(&self, v: &DVector<f64>) -> f64 {
        let (own, bodies) = (v.rows(self.range.start, self.range.len()), v.rows(0, self.between.ncols()));
        own.dot(&(&self.between * bodies))
    }
}

/// (M + g C + g^2 K)^-1 of the whole scene.
pub(crate) struct Whole<'a> {
    parts: Mobility,
    ties: &'a [Tie],
    /// Z_s B of each tie.
    answers: Vec<DMatrix<f64>>,
    /// Sum of B^T Z_s B.
    reduced: DMatrix<f64>,
    /// Mass of the bodies.
    mass: DMatrix<f64>,
    /// S^-1 B^T of each tie.
    pulls: Vec<DMatrix<f64>>,
    /// Scratch.
    row: DVector<f64>,
    step: f64,
}

impl<'a> Whole<'a> {
    /// M^-1; where bodies ride on others, what [`Whole::set_mass`] makes it later.
    ///
    /// # Errors
    /// A mass that is not positive definite.
    pub fn new(system: &'a System) -> Result<Whole<'a>, Error> {
        let later = !system.rides.is_empty() || !system.ties.is_empty();
        let bodies = system.body_freedoms();
        let mass = system.blocks[0].body_mass().cloned().unwrap_or_else(|| DMatrix::zeros(bodies, bodies));
        let mut whole = Whole {
            parts: Mobility::new(&system.blocks, later)?,
            ties: &system.ties,
            answers: system.ties.iter().map(|tie| tie.between.clone()).collect(),
            reduced: DMatrix::zeros(bodies, bodies),
            mass,
            pulls: system.ties.iter().map(|tie| tie.between.transpose()).collect(),
            row: DVector::zeros(bodies),
            step: 0.0,
        };
        whole.reduce(system.freedoms);
        if system.rides.is_empty() && !system.ties.is_empty() {
            whole.answer()?;
        }
        Ok(whole)
    }

    /// Changes the mass of the bodies.
    ///
    /// # Errors
    /// A mass that is not positive definite.
    pub fn set_mass(&mut self, mass: &DMatrix<f64>) -> Result<(), Error> {
        self.mass.copy_from(mass);
        self.answer()
    }

    /// Changes the coefficient g; where bodies ride on others, [`Whole::set_mass`] must follow.
    ///
    /// # Errors
    /// A structure that is not positive definite.
    pub fn set_step(&mut self, system: &System, g: f64) -> Result<(), Error> {
        self.parts.set_step(&system.blocks, g)?;
        if g != self.step && !self.ties.is_empty() {
            self.reduce(system.freedoms);
            if system.rides.is_empty() {
                self.answer()?;
            }
        }
        self.step = g;
        Ok(())
    }

    fn reduce(&mut self, freedoms: usize) {
        if self.ties.is_empty() {
            return;
        }
        let (mut load, mut out) = (vec![0.0; freedoms], vec![0.0; freedoms]);
        self.reduced.fill(0.0);
        for (tie, answer) in self.ties.iter().zip(&mut self.answers) {
            for j in 0..tie.between.ncols() {
                load.fill(0.0);
                load[tie.range.clone()].copy_from_slice(tie.between.column(j).as_slice());
                self.parts.apply(&load, &mut out);
                answer.column_mut(j).copy_from_slice(&out[tie.range.clone()]);
            }
            self.reduced += tie.between.transpose() * &*answer;
        }
    }

    fn answer(&mut self) -> Result<(), Error> {
        if self.ties.is_empty() {
            return self.parts.set_mass(&self.mass);
        }
        self.mass -= &self.reduced;
        let set = self.parts.set_mass(&self.mass);
        self.mass += &self.reduced;
        set?;
        for (tie, pull) in self.ties.iter().zip(&mut self.pulls) {
            for (k, mut column) in pull.column_iter_mut().enumerate() {
                self.row.copy_from(&tie.between.row(k).transpose());
                self.parts.apply_to_bodies(self.row.as_slice(), column.as_mut_slice());
            }
        }
        Ok(())
    }

    /// `out` = Z `load`.
    pub fn apply(&self, load: &[f64], out: &mut [f64]) {
        self.parts.apply(load, out);
        let (bodies, others) = out.split_at_mut(self.mass.nrows());
        for (tie, pull) in self.ties.iter().zip(&self.pulls) {
            for (y, column) in others[self.own(tie)].iter().zip(pull.column_iter()) {
                bodies.iter_mut().zip(column.iter()).for_each(|(out, p)| *out -= p * y);
            }
        }
        for (tie, answer) in self.ties.iter().zip(&self.answers) {
            let own = &mut others[self.own(tie)];
            for (column, a) in answer.column_iter().zip(bodies.iter()) {
                own.iter_mut().zip(column.iter()).for_each(|(out, y)| *out -= y * a);
            }
        }
    }

    /// Freedoms of a structure after those of the bodies.
    fn own(&self, tie: &Tie) -> Range<usize> {
        let bodies = self.mass.nrows();
        tie.range.start - bodies..tie.range.end - bodies
    }
}

/// 1/2 v^T M v of all freedoms.
pub(crate) fn kinetic(blocks: &[Block], ties: &[Tie], v: &DVector<f64>) -> f64 {
    let own: f64 = blocks.iter().map(|block| block.kinetic(v.as_slice())).sum();
    own + ties.iter().map(|tie| tie.kinetic(v)).sum::<f64>()
}
