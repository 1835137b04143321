//! Unknowns of a frame: rigid bodies of linked points, less what supports hold.

use nalgebra::Vector3;

use crate::element::{Matrix6, arm, vector};
use crate::model::Model;
use crate::real::Real;

/// Relative size below which a constraint says nothing new.
const DEPENDENT: f64 = 1e-12;

/// Points that move as one, and how much of their motion the supports leave.
#[derive(Clone, Debug)]
pub(crate) struct Body<T: Real = f64> {
    /// The point whose motion describes the body's.
    pub reference: usize,
    /// Motion of the reference by the body's six columns; columns that supports hold are zero.
    pub basis: Matrix6<T>,
    /// Columns that remain.
    pub free: [bool; 6],
    /// Constraints that hold it: reaction freedoms as (point, freedom), independent ones only.
    pub holds: Vec<(usize, usize)>,
}

/// Bodies of a model, and the map from points to them.
#[derive(Clone, Debug)]
pub(crate) struct Freedoms<T: Real = f64> {
    pub bodies: Vec<Body<T>>,
    /// Body of each point.
    pub body: Vec<usize>,
    /// From the body's reference to each point.
    pub arms: Vec<Vector3<T>>,
}

impl<T: Real> Freedoms<T> {
    pub fn new(m: &Model) -> Freedoms<T> {
        let n = m.points.len();
        let root = roots(m, n);
        let mut fix = vec![[false; 6]; n];
        for support in &m.supports {
            for (held, &given) in fix[support.point].iter_mut().zip(&support.fix) {
                *held |= given;
            }
        }
        let mut body = vec![0; n];
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for point in 0..n {
            if root[point] == point {
                body[point] = groups.len();
                groups.push(vec![point]);
            } else {
                body[point] = body[root[point]];
                groups[body[point]].push(point);
            }
        }
        let mut arms = vec![Vector3::zeros(); n];
        let bodies = groups.iter().map(|group| bind(m, group, &fix, &mut arms)).collect();
        Freedoms { bodies, body, arms }
    }

    /// Motion of a place rigidly attached to `point` at `offset` by that of its body's reference.
    pub fn motion(&self, point: usize, offset: &Vector3<T>) -> Matrix6<T> {
        arm(&(self.arms[point] + offset))
    }
}

impl Freedoms {
    /// What the supports leave of a sum over the motions of the references.
    pub fn supported(&self, sum: &Sum) -> Sum {
        let mut out = Sum::default();
        for &(column, value) in &sum.terms {
            let basis = &self.bodies[column / 6].basis;
            (0..6).for_each(|k| out.add(column - column % 6 + k, value * basis[(column % 6, k)]));
        }
        out
    }
}

/// The lowest point of each point's group.
fn roots(m: &Model, n: usize) -> Vec<usize> {
    fn find(parent: &mut [usize], mut k: usize) -> usize {
        while parent[k] != k {
            parent[k] = parent[parent[k]];
            k = parent[k];
        }
        k
    }
    let mut parent: Vec<usize> = (0..n).collect();
    for link in &m.links {
        let (a, b) = (find(&mut parent, link.from), find(&mut parent, link.to));
        parent[a.max(b)] = a.min(b);
    }
    (0..n).map(|k| find(&mut parent, k)).collect()
}

/// One body: its reference is the point that supports hold most.
fn bind<T: Real>(m: &Model, group: &[usize], fix: &[[bool; 6]], arms: &mut [Vector3<T>]) -> Body<T> {
    let count = |point: usize| fix[point].iter().filter(|&&held| held).count();
    let reference = group.iter().copied().fold(group[0], |a, b| if count(b) > count(a) { b } else { a });
    let at = |point: usize| vector::<T>(m.points[point]);
    let mut size = 0.0_f64;
    for &point in group {
        arms[point] = at(point) - at(reference);
        size = arms[point].iter().fold(size, |a, x| a.max(x.double().abs()));
    }
    // Rotations count by what they move the farthest point.
    let scale = if size > 0.0 { T::from(size) } else { T::one() };
    let mut rows: Vec<[T; 6]> = Vec::new();
    let mut names = Vec::new();
    let others = group.iter().copied().filter(|&point| point != reference);
    for point in std::iter::once(reference).chain(others) {
        let motion: Matrix6<T> = arm(&arms[point]);
        for (freedom, _) in fix[point].iter().enumerate().filter(|(_, held)| **held) {
            rows.push(std::array::from_fn(|k| motion[(freedom, k)] / if k < 3 { T::one() } else { scale }));
            names.push((point, freedom));
        }
    }
    let (pivots, holds) = reduce(&mut rows);
    let mut basis = Matrix6::identity();
    let mut free = [true; 6];
    for &(row, pivot) in &pivots {
        free[pivot] = false;
        for k in 0..6 {
            let units = if k < 3 { T::one() } else { scale } / if pivot < 3 { T::one() } else { scale };
            basis[(pivot, k)] = -rows[row][k] * units;
        }
    }
    for &(_, pivot) in &pivots {
        basis.column_mut(pivot).fill(T::zero());
    }
    Body { reference, basis, free, holds: holds.into_iter().map(|k| names[k]).collect() }
}

/// Gauss-Jordan: leaves `rows` solved for their pivots; returns (row, pivot) and the rows that count.
fn reduce<T: Real>(rows: &mut [[T; 6]]) -> (Vec<(usize, usize)>, Vec<usize>) {
    let mut pivots: Vec<(usize, usize)> = Vec::new();
    let mut holds = Vec::new();
    for row in 0..rows.len() {
        let own = rows[row];
        let before = own.iter().fold(0.0_f64, |a, x| a.max(x.double().abs()));
        let mut rest = own;
        for &(other, pivot) in &pivots {
            let share = rest[pivot];
            for k in 0..6 {
                rest[k] -= share * rows[other][k];
            }
            rest[pivot] = T::zero();
        }
        let pivot = (0..6).fold(0, |a, b| if rest[b].size() > rest[a].size() { b } else { a });
        if rest[pivot].double().abs() <= DEPENDENT * before {
            continue;
        }
        let factor = rest[pivot];
        for value in &mut rest {
            let small = value.double().abs() <= DEPENDENT * before;
            *value = if small { T::zero() } else { *value / factor };
        }
        for &(other, _) in &pivots {
            let share = rows[other][pivot];
            for k in 0..6 {
                rows[other][k] -= share * rest[k];
            }
            rows[other][pivot] = T::zero();
        }
        rows[row] = rest;
        pivots.push((row, pivot));
        holds.push(row);
    }
    (pivots, holds)
}

/// Sparse sum over columns (six a body).
#[derive(Clone, Debug, Default)]
pub(crate) struct Sum {
    pub terms: Vec<(usize, f64)>,
    /// Sum of magnitudes that went into each term.
    sizes: Vec<f64>,
}

impl Sum {
    pub fn add(&mut self, column: usize, value: f64) {
        if value == 0.0 {
            return;
        }
        if let Some(k) = self.terms.iter().position(|term| term.0 == column) {
            self.terms[k].1 += value;
            self.sizes[k] += value.abs();
        } else {
            self.terms.push((column, value));
            self.sizes.push(value.abs());
        }
    }

    pub fn add_scaled(&mut self, other: &Sum, factor: f64) {
        for &(column, value) in &other.terms {
            self.add(column, factor * value);
        }
    }

    /// Column of each term, and the magnitudes that went into it.
    pub fn magnitudes(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.terms.iter().zip(&self.sizes).map(|(term, &size)| (term.0, size))
    }

    /// Terms that are more than the rounding of what cancelled.
    pub fn significant(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let terms = self.terms.iter().zip(&self.sizes);
        terms.filter(|(term, size)| term.1.abs() > 16.0 * f64::EPSILON * **size).map(|(term, _)| *term)
    }
}
