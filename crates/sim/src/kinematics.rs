//! How bodies follow the freedoms: the six displacements of every body as a linear map of the freedoms.
//!
//! u_b = J_b q + held + e_x x(t): the freedoms of the body itself and of the bodies it is pinned to, starting values that
//! are held, and the prescribed travel of the body at the root of its tree. M = sum of J_b^T M_b J_b.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use crate::ride::Rides;
use crate::scene::arm_rows;
use crate::{Body, Error, Foundation, Freedom, Scene};

/// Freedoms and their coefficients in one displacement.
pub(crate) type Terms = Vec<(usize, f64)>;

/// The maps J_b, and what follows from them.
pub(crate) struct Kinematics {
    /// J_b, one line a displacement of each body.
    terms: Vec<[Terms; 6]>,
    /// Displacements of each body at q = 0, without the travel of its root.
    held: Vec<[f64; 6]>,
    /// Body at the root of each body's tree.
    root: Vec<usize>,
    /// Inertia of each root's tree between its x and the freedoms.
    drag: Vec<Terms>,
    /// Mass of each root's tree.
    mass: Vec<f64>,
}

impl Kinematics {
    /// Maps of the bodies of `scene`, whose own freedoms are numbered by `freedom`.
    ///
    /// # Errors
    /// [`Error::Pinned`] where the pins run in a circle.
    pub fn new(scene: &Scene, freedom: &[[Option<usize>; 6]]) -> Result<Self, Error> {
        let count = scene.bodies.len();
        let mut kinematics = Kinematics {
            terms: vec![Default::default(); count],
            held: vec![[0.0; 6]; count],
            root: (0..count).collect(),
            drag: vec![Vec::new(); count],
            mass: vec![0.0; count],
        };
        for b in parents_first(&scene.bodies)? {
            kinematics.follow(&scene.bodies[b], b, &freedom[b]);
        }
        Ok(kinematics)
    }

    /// Adds up the masses of the trees and of the structures on them, without bodies that ride on others.
    /// `structures` are the structures' freedoms.
    pub fn weigh(
        &mut self,
        scene: &Scene,
        foundations: &[Foundation],
        structures: &[Range<usize>],
        rides: &Rides,
    ) {
        for (b, body) in scene.bodies.iter().enumerate().filter(|(b, _)| !rides.has(*b)) {
            self.weigh_one(b, &body.mass_matrix()[0]);
        }
        for (foundation, freedoms) in foundations.iter().zip(structures) {
            let Some(mount) = &foundation.on else { continue };
            self.weigh_one(mount.body, &mount.mass[0]);
            let root = self.root[mount.body];
            for (number, shares) in freedoms.clone().zip(&mount.coupling) {
                add(&mut self.drag[root], number, shares[0]);
            }
        }
    }

    /// Adds a mass that moves with body `b`, given by its line of x.
    fn weigh_one(&mut self, b: usize, line: &[f64; 6]) {
        let root = self.root[b];
        self.mass[root] += line[0];
        for (inertia, terms) in line.iter().zip(&self.terms[b]).filter(|(inertia, _)| **inertia != 0.0) {
            for &(number, coefficient) in terms {
                add(&mut self.drag[root], number, inertia * coefficient);
            }
        }
    }

    fn follow(&mut self, body: &Body, b: usize, own: &[Option<usize>; 6]) {
        let arms = body.pinned.as_ref().map(|pin| arm_rows(pin.at));
        for i in 0..6 {
            if let Some(number) = own[i] {
                self.terms[b][i] = vec![(number, 1.0)];
                continue;
            }
            let Some((pin, arms)) = body.pinned.as_ref().zip(arms) else {
                let prescribed = i == 0 && body.motion.is_some();
                self.held[b][i] = if prescribed { 0.0 } else { body.start[i] };
                continue;
            };
            let mut line = [0.0; 6];
            match arms.get(i) {
                Some(arm) => line = *arm,
                None => line[i] = 1.0,
            }
            let terms = self.combine(pin.to, &line);
            self.terms[b][i] = terms;
            self.held[b][i] = line.iter().zip(&self.held[pin.to]).map(|(l, held)| l * held).sum();
            if i == 0 {
                self.held[b][0] += pin.at[0];
            }
        }
        if let Some(pin) = &body.pinned {
            self.root[b] = self.root[pin.to];
        }
    }

    /// Body at the root of `b`'s tree: `b` itself where it is pinned to none.
    pub fn root(&self, b: usize) -> usize {
        self.root[b]
    }

    /// The displacements of body `b` over the freedoms.
    pub fn terms(&self, b: usize) -> &[Terms; 6] {
        &self.terms[b]
    }

    /// The displacements of body `b` where all freedoms are zero, without the travel of its root.
    pub fn held(&self, b: usize) -> &[f64; 6] {
        &self.held[b]
    }

    /// A combination `line` of the displacements of body `b` over the freedoms.
    pub fn combine(&self, b: usize, line: &[f64; 6]) -> Terms {
        let mut sum = Vec::new();
        for (scale, terms) in line.iter().zip(&self.terms[b]).filter(|(scale, _)| **scale != 0.0) {
            for &(number, coefficient) in terms {
                add(&mut sum, number, scale * coefficient);
            }
        }
        sum.retain(|(_, coefficient)| *coefficient != 0.0);
        sum
    }

    /// Displacements or speeds of body `b` for the freedoms `q`, less what is held and prescribed.
    pub fn apply(&self, b: usize, q: &DVector<f64>) -> [f64; 6] {
        let value = |terms: &Terms| terms.iter().map(|&(number, c)| c * q[number]).sum::<f64>();
        std::array::from_fn(|i| value(&self.terms[b][i]))
    }

    /// Inertia between the x of root `b` with all that is pinned to it and the freedoms: force per acceleration.
    pub fn drag(&self, b: usize) -> &[(usize, f64)] {
        &self.drag[b]
    }

    /// Mass of root `b` with all that is pinned to it; 0 for a body that is pinned.
    pub fn mass(&self, b: usize) -> f64 {
        self.mass[b]
    }

    /// Adds J^T M J of body `b` to `total`.
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

/// Checks what bodies are pinned to.
///
/// # Errors
/// A body that does not exist, and [`Error::Pinned`]: a circle, or translations of its own.
pub(crate) fn check(bodies: &[Body]) -> Result<(), Error> {
    for (b, body) in bodies.iter().enumerate() {
        let Some(pin) = &body.pinned else { continue };
        if pin.to >= bodies.len() {
            return Err(Error::NoSuch { what: "body", index: pin.to });
        }
        if body.motion.is_some() || body.free[..=Freedom::Z as usize].contains(&true) {
            return Err(Error::Pinned { body: b });
        }
    }
    parents_first(bodies).map(|_| ())
}

/// Bodies in an order in which each stands after the one it is pinned to.
fn parents_first(bodies: &[Body]) -> Result<Vec<usize>, Error> {
    let mut depths = Vec::with_capacity(bodies.len());
    for b in 0..bodies.len() {
        let (mut depth, mut at) = (0, b);
        while let Some(pin) = &bodies[at].pinned {
            (depth, at) = (depth + 1, pin.to);
            if depth > bodies.len() {
                return Err(Error::Pinned { body: b });
            }
        }
        depths.push((depth, b));
    }
    depths.sort_unstable();
    Ok(depths.into_iter().map(|(_, b)| b).collect())
}
