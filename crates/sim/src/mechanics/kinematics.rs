//! Kinematics of the bodies: the six displacements of every body as a linear map of the degrees of freedom.
//!
//! u_b = J_b q + c_b + e_x x(t), where J_b contains the degrees of freedom of the body and of the bodies that it is
//! pinned to, c_b is the constant part due to fixed starting values, and x(t) is the prescribed travel of the body at
//! the root of the tree. M = sum of J_b^T M_b J_b.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use crate::scene::body::parents_first;
use crate::scene::dof::arm_rows;
use crate::{Body, Error, Foundation, Scene};

/// Indices of degrees of freedom and their coefficients in one displacement.
pub(crate) type Terms = Vec<(usize, f64)>;

/// The maps J_b and the quantities derived from them.
pub(crate) struct Kinematics<'a> {
    pub scene: &'a Scene,
    /// Indices of the degrees of freedom of each body; `None` where the displacement is fixed or prescribed.
    pub numbers: Vec<[Option<usize>; 6]>,
    /// J_b: six rows per body, one per displacement.
    terms: Vec<[Terms; 6]>,
    /// Displacements c_b of each body at q = 0, without the prescribed travel of its root.
    constant: Vec<[f64; 6]>,
    /// Root body of the tree of each body.
    root: Vec<usize>,
    /// Inertial coupling between the x of each root and the degrees of freedom.
    travel_inertia: Vec<Terms>,
    /// Total mass of the tree of each root.
    mass: Vec<f64>,
}

impl<'a> Kinematics<'a> {
    /// Builds the maps of the bodies of `scene`, whose degrees of freedom have the indices `numbers`.
    ///
    /// # Errors
    /// [`Error::Pinned`] where the pins form a cycle.
    pub fn new(scene: &'a Scene, numbers: Vec<[Option<usize>; 6]>) -> Result<Self, Error> {
        let count = scene.bodies.len();
        let mut kinematics = Kinematics {
            scene,
            numbers,
            terms: vec![Default::default(); count],
            constant: vec![[0.0; 6]; count],
            root: (0..count).collect(),
            travel_inertia: vec![Vec::new(); count],
            mass: vec![0.0; count],
        };
        for b in parents_first(&scene.bodies)? {
            kinematics.follow(&scene.bodies[b], b);
        }
        Ok(kinematics)
    }

    /// Sums the masses of the trees and of the structures on them, without bodies that are carried by other bodies.
    /// `structures` are the ranges of the degrees of freedom of the structures.
    pub fn add_masses(
        &mut self,
        foundations: &[Foundation],
        structures: &[Range<usize>],
        is_carried: impl Fn(usize) -> bool,
    ) {
        for (b, body) in self
            .scene
            .bodies
            .iter()
            .enumerate()
            .filter(|(b, _)| !is_carried(*b))
        {
            self.add_mass_of_tree(b, &body.mass_matrix()[0]);
        }
        for (foundation, range) in foundations.iter().zip(structures) {
            let Some(mount) = &foundation.carrier else {
                continue;
            };
            self.add_mass_of_tree(mount.body, &mount.mass[0]);
            let root = self.root[mount.body];
            for (number, row) in range.clone().zip(&mount.coupling) {
                add(&mut self.travel_inertia[root], number, row[0]);
            }
        }
    }

    /// Adds a mass that moves with body `b`; `line` is the x row of its 6 x 6 mass matrix.
    fn add_mass_of_tree(&mut self, b: usize, line: &[f64; 6]) {
        let root = self.root[b];
        self.mass[root] += line[0];
        for (inertia, terms) in line
            .iter()
            .zip(&self.terms[b])
            .filter(|(inertia, _)| **inertia != 0.0)
        {
            for &(number, coefficient) in terms {
                add(
                    &mut self.travel_inertia[root],
                    number,
                    inertia * coefficient,
                );
            }
        }
    }

    /// Builds J_b, c_b and the root of body `b`. The body that it is pinned to must have been processed before.
    fn follow(&mut self, body: &Body, b: usize) {
        let arms = body.pinned.as_ref().map(|pin| arm_rows(pin.at));
        for i in 0..6 {
            if let Some(number) = self.numbers[b][i] {
                self.terms[b][i] = vec![(number, 1.0)];
                continue;
            }
            let Some((pin, arms)) = body.pinned.as_ref().zip(arms) else {
                let prescribed = i == 0 && body.motion.is_some();
                self.constant[b][i] = if prescribed { 0.0 } else { body.start[i] };
                continue;
            };
            let mut line = [0.0; 6];
            match arms.get(i) {
                Some(arm) => line = *arm,
                None => line[i] = 1.0,
            }
            let terms = self.combine(pin.body, &line);
            self.terms[b][i] = terms;
            self.constant[b][i] = line
                .iter()
                .zip(&self.constant[pin.body])
                .map(|(l, constant)| l * constant)
                .sum();
            if i == 0 {
                self.constant[b][0] += pin.at[0];
            }
        }
        if let Some(pin) = &body.pinned {
            self.root[b] = self.root[pin.body];
        }
    }

    /// Root body of the tree of `b`: `b` itself where it is not pinned.
    pub fn root(&self, b: usize) -> usize {
        self.root[b]
    }

    /// Displacements of body `b` as terms in the degrees of freedom.
    pub fn terms(&self, b: usize) -> &[Terms; 6] {
        &self.terms[b]
    }

    /// Displacements of body `b` at q = 0, without the prescribed travel of its root.
    pub fn constant(&self, b: usize) -> &[f64; 6] {
        &self.constant[b]
    }

    /// Linear combination of the displacements of body `b` with the coefficients `line`, as terms in the degrees of
    /// freedom.
    pub fn combine(&self, b: usize, line: &[f64; 6]) -> Terms {
        let mut sum = Vec::new();
        for (scale, terms) in line
            .iter()
            .zip(&self.terms[b])
            .filter(|(scale, _)| **scale != 0.0)
        {
            for &(number, coefficient) in terms {
                add(&mut sum, number, scale * coefficient);
            }
        }
        sum.retain(|(_, coefficient)| *coefficient != 0.0);
        sum
    }

    /// Displacements or velocities of body `b` for the vector `q`, without the constant and prescribed parts.
    pub fn apply(&self, b: usize, q: &DVector<f64>) -> [f64; 6] {
        let value = |terms: &Terms| terms.iter().map(|&(number, c)| c * q[number]).sum::<f64>();
        std::array::from_fn(|i| value(&self.terms[b][i]))
    }

    /// Displacements and velocities of body `b` in all six degrees of freedom at time `t`.
    pub fn motion(
        &self,
        b: usize,
        t: f64,
        q: &DVector<f64>,
        v: &DVector<f64>,
    ) -> ([f64; 6], [f64; 6]) {
        let body = &self.scene.bodies[b];
        if body.pinned.is_some() {
            return self.pinned_motion(b, t, q, v);
        }
        let (mut displacement, mut speed) = (body.start, [0.0; 6]);
        for i in 0..6 {
            if let Some(number) = self.numbers[b][i] {
                displacement[i] = q[number];
                speed[i] = v[number];
            }
        }
        if let Some(profile) = &body.motion {
            let at = profile.at(t);
            displacement[0] = at.x;
            speed[0] = at.v;
        }
        (displacement, speed)
    }

    fn pinned_motion(
        &self,
        b: usize,
        t: f64,
        q: &DVector<f64>,
        v: &DVector<f64>,
    ) -> ([f64; 6], [f64; 6]) {
        let (mut displacement, mut speed) = (self.apply(b, q), self.apply(b, v));
        displacement
            .iter_mut()
            .zip(&self.constant[b])
            .for_each(|(sum, constant)| *sum += constant);
        if let Some(profile) = &self.scene.bodies[self.root[b]].motion {
            let at = profile.at(t);
            displacement[0] += at.x;
            speed[0] += at.v;
        }
        (displacement, speed)
    }

    /// Inertial coupling between the x of root `b`, with all bodies pinned to it, and the degrees of freedom: force
    /// per unit acceleration.
    pub fn travel_inertia(&self, b: usize) -> &[(usize, f64)] {
        &self.travel_inertia[b]
    }

    /// Mass of root `b` with all bodies pinned to it; 0 for a pinned body.
    pub fn mass(&self, b: usize) -> f64 {
        self.mass[b]
    }

    /// Adds J^T M J of body `b` with its mass matrix `matrix` to `total`.
    pub fn add_mass(&self, b: usize, matrix: &[[f64; 6]; 6], total: &mut DMatrix<f64>) {
        for (line, rows) in matrix.iter().zip(&self.terms[b]) {
            for (entry, columns) in line.iter().zip(&self.terms[b]) {
                for &(row, by_row) in rows {
                    for &(column, by_column) in columns {
                        total[(row, column)] += by_row * entry * by_column;
                    }
                }
            }
        }
    }
}

fn add(terms: &mut Terms, number: usize, value: f64) {
    match terms.iter_mut().find(|(known, _)| *known == number) {
        Some((_, sum)) => *sum += value,
        None => terms.push((number, value)),
    }
}
