//! Rigid bodies of linked points, and what the supports leave of their motion.

use nalgebra::Vector3;
use num_traits::{One, Zero};

use crate::assembly::combination::Combination;
use crate::assembly::element::{Matrix6, vector};
use crate::assembly::precision::{Extended, Real};
use crate::assembly::turning::TurnedAxes;
use crate::dof::DofSet;
use crate::model::Model;

/// Size of a constraint, relative to what it was, at which it is a combination of the others.
const DEPENDENT: f64 = 1e-12;

/// Points that move as one, and what the supports leave of their motion.
#[derive(Clone, Debug)]
pub(crate) struct Body<T: Real = f64> {
    /// The point whose motion describes that of the body.
    pub reference: usize,
    /// Motion of the reference by the six columns of the body; columns that the supports fix are zero.
    pub basis: Matrix6<T>,
    /// Whether nothing holds or turns it: its basis is the identity.
    pub is_free: bool,
    /// Columns that the supports leave free.
    pub free: DofSet,
    /// Columns that are rotations about axes about which nothing stiffens the body, see [`Bodies::turn`].
    pub unstiffened: DofSet,
    /// The independent constraints that act on the body, as (point, degree of freedom): each has a reaction.
    pub constraints: Vec<(usize, usize)>,
}

/// The bodies of a model, and the map from points to them.
#[derive(Clone, Debug)]
pub(crate) struct Bodies<T: Real = f64> {
    /// All bodies, in the order of their lowest points.
    pub list: Vec<Body<T>>,
    /// Body of each point.
    pub of_point: Vec<usize>,
    /// From the reference of its body to each point, global: exact, however far both are from the origin.
    pub arms: Vec<Vector3<Extended>>,
}

impl<T: Real> Bodies<T> {
    pub fn new(m: &Model) -> Bodies<T> {
        let n = m.points.len();
        let lowest = lowest_linked(m, n);
        let mut fixed = vec![[false; 6]; n];
        for support in &m.supports {
            for (fixed, &given) in fixed[support.point].iter_mut().zip(&support.fixed) {
                *fixed |= given;
            }
        }
        let mut of_point = vec![0; n];
        let mut lowest_points = Vec::with_capacity(n);
        let mut others: Vec<(usize, usize)> = Vec::new();
        for point in 0..n {
            if lowest[point] == point {
                of_point[point] = lowest_points.len();
                lowest_points.push(point);
            } else {
                of_point[point] = of_point[lowest[point]];
                others.push((of_point[point], point));
            }
        }
        others.sort_unstable();
        let mut others = others.into_iter().peekable();
        let mut arms = vec![Vector3::zeros(); n];
        let mut group = Vec::new();
        let of_lowest = |(body, point): (usize, usize)| {
            group.clear();
            group.push(point);
            group.extend(
                std::iter::from_fn(|| others.next_if(|other| other.0 == body)).map(|other| other.1),
            );
            if group.len() == 1 {
                Body::lone(point, &fixed[point])
            } else {
                Body::new(m, &group, &fixed, &mut arms)
            }
        };
        let list = lowest_points
            .into_iter()
            .enumerate()
            .map(of_lowest)
            .collect();
        Bodies {
            list,
            of_point,
            arms,
        }
    }

    /// Makes the rotational columns of some bodies those about other axes.
    pub fn turn(&mut self, turned: &[TurnedAxes]) {
        for own in turned {
            let body = &mut self.list[own.body];
            let old = body.basis;
            body.is_free = false;
            for k in 0..3 {
                let mut column = old.column(3).into_owned() * T::from(own.axes[(0, k)]);
                for other in 1..3 {
                    column += old.column(3 + other) * T::from(own.axes[(other, k)]);
                }
                body.basis.set_column(3 + k, &column);
                body.unstiffened[3 + k] = own.unstiffened[k];
            }
        }
    }

    /// Bodies of a pair of points.
    pub fn pair(&self, points: [usize; 2]) -> [usize; 2] {
        points.map(|point| self.of_point[point])
    }

    /// Motion of a place rigidly attached to `point` at `offset`, by that of the reference of its body.
    pub fn motion(&self, point: usize, offset: &Vector3<T>) -> Matrix6<T> {
        arm(&self.arm(point, offset))
    }

    /// From the reference of the body of `point` to a place at `offset` from it.
    pub fn arm(&self, point: usize, offset: &Vector3<T>) -> Vector3<T> {
        (self.arms[point] + offset.map(T::wide)).map(T::rounded)
    }

    /// The same in double-doubles.
    pub fn exact_motion(&self, point: usize, offset: &Vector3<T>) -> Matrix6<Extended> {
        arm(&(self.arms[point] + offset.map(T::wide)))
    }
}

impl<T: Real> Bodies<T> {
    /// Six displacements, given by the motion of the reference of the body of `point`, as combinations.
    pub fn combinations(&self, point: usize, motion: &Matrix6<T>) -> [Combination<T>; 6] {
        self.sized_combinations(point, motion, &motion.map(|x| x.double().abs()))
    }

    /// The same, with the sums of the magnitudes that the entries of the motion were added up from.
    pub fn sized_combinations<U: Real>(
        &self,
        point: usize,
        motion: &Matrix6<U>,
        sizes: &Matrix6,
    ) -> [Combination<U>; 6] {
        let columns = 6 * self.of_point[point];
        std::array::from_fn(|i| {
            Combination::of_columns((0..6).map(|k| (columns + k, motion[(i, k)], sizes[(i, k)])))
        })
    }

    /// What the supports leave of a combination of the motions of the references.
    pub fn supported(&self, row: &Combination<T>) -> Combination<T> {
        let mut out = Combination::with_capacity(row.terms().len());
        for (column, value) in row.terms() {
            let basis = &self.list[column / 6].basis;
            (0..6).for_each(|k| out.add(column - column % 6 + k, value * basis[(column % 6, k)]));
        }
        out
    }
}

/// Motion of the tip of a rigid arm by that of its root: displacement u + theta cross r, rotation theta.
pub(crate) fn arm<T: Real>(r: &Vector3<T>) -> Matrix6<T> {
    let mut a = Matrix6::identity();
    for (i, j, value) in [(0, 1, r.z), (1, 2, r.x), (2, 0, r.y)] {
        a[(i, 3 + j)] = value;
        a[(j, 3 + i)] = -value;
    }
    a
}

/// The lowest point that each point is linked to, directly or through others (union-find).
fn lowest_linked(m: &Model, n: usize) -> Vec<usize> {
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

impl<T: Real> Body<T> {
    /// A point that is not linked to others.
    fn lone(point: usize, fixed: &DofSet) -> Body<T> {
        let mut basis = Matrix6::identity();
        let mut constraints = Vec::new();
        for (k, _) in fixed.iter().enumerate().filter(|(_, fixed)| **fixed) {
            basis[(k, k)] = T::zero();
            constraints.push((point, k));
        }
        let is_free = constraints.is_empty();
        Body {
            reference: point,
            basis,
            is_free,
            free: fixed.map(|fixed| !fixed),
            unstiffened: [false; 6],
            constraints,
        }
    }

    /// The body of a group of linked points; writes their arms.
    ///
    /// The reference is the point with the most fixed degrees of freedom. Every fixed degree of freedom of
    /// any point is one linear constraint a . u = 0 on the six motions u of the reference. Gauss-Jordan
    /// elimination solves the constraints for as many of the motions; the others are free.
    ///
    /// All of it is computed in double-doubles, and rounded at the end.
    fn new(
        m: &Model,
        group: &[usize],
        fixed: &[DofSet],
        arms: &mut [Vector3<Extended>],
    ) -> Body<T> {
        let count = |point: usize| fixed[point].iter().filter(|&&fixed| fixed).count();
        let reference = group
            .iter()
            .copied()
            .fold(group[0], |a, b| if count(b) > count(a) { b } else { a });
        let at = |point: usize| vector::<Extended>(m.points[point]);
        let mut size = 0.0_f64;
        for &point in group {
            arms[point] = at(point) - at(reference);
            size = arms[point]
                .iter()
                .fold(size, |a, x| a.max(x.double().abs()));
        }
        // Rotations are measured by the displacement of the farthest point: then all motions have one unit.
        let scale = if size > 0.0 {
            Extended::from(size)
        } else {
            Extended::one()
        };
        let unit = |k: usize| if k < 3 { Extended::one() } else { scale };
        let mut rows: Vec<[Extended; 6]> = Vec::new();
        let mut names = Vec::new();
        let others = group.iter().copied().filter(|&point| point != reference);
        for point in std::iter::once(reference).chain(others) {
            let motion: Matrix6<Extended> = arm(&arms[point]);
            for (dof, _) in fixed[point].iter().enumerate().filter(|(_, fixed)| **fixed) {
                let zero = Extended::zero();
                let entry = |k: usize| {
                    if motion[(dof, k)] == zero {
                        zero
                    } else {
                        motion[(dof, k)] / unit(k)
                    }
                };
                rows.push(std::array::from_fn(entry));
                names.push((point, dof));
            }
        }
        let pivots = gauss_jordan(&mut rows);
        let mut basis = Matrix6::<T>::identity();
        let mut free = [true; 6];
        for &(row, pivot) in &pivots {
            free[pivot] = false;
            basis[(pivot, pivot)] = T::zero();
            for k in (0..6).filter(|&k| k != pivot && rows[row][k] != Extended::zero()) {
                basis[(pivot, k)] = T::rounded(-rows[row][k] * (unit(k) / unit(pivot)));
            }
        }
        for &(_, pivot) in &pivots {
            basis.column_mut(pivot).fill(T::zero());
        }
        let constraints = pivots.iter().map(|&(row, _)| names[row]).collect();
        Body {
            reference,
            basis,
            is_free: pivots.is_empty(),
            free,
            unstiffened: [false; 6],
            constraints,
        }
    }
}

/// Gauss-Jordan elimination with the largest pivot of each row: leaves the independent `rows` solved for
/// their pivots and returns these rows and pivots, in the order of the rows.
fn gauss_jordan(rows: &mut [[Extended; 6]]) -> Vec<(usize, usize)> {
    let mut pivots: Vec<(usize, usize)> = Vec::new();
    for row in 0..rows.len() {
        let own = rows[row];
        let before = own.iter().fold(0.0_f64, |a, x| a.max(x.double().abs()));
        let mut rest = own;
        for &(other, pivot) in &pivots {
            eliminate(&mut rest, &rows[other], pivot);
        }
        let pivot = (0..6).fold(0, |a, b| {
            if rest[b].magnitude() > rest[a].magnitude() {
                b
            } else {
                a
            }
        });
        if rest[pivot].double().abs() <= DEPENDENT * before {
            continue;
        }
        // Solve the row for its pivot; what is only rounding becomes an exact zero, so that the basis keeps zeros.
        let factor = rest[pivot];
        for value in &mut rest {
            let small = value.double().abs() <= DEPENDENT * before;
            *value = if small {
                Extended::zero()
            } else {
                quotient(*value, factor)
            };
        }
        // Jordan step: earlier rows no longer depend on the new pivot.
        for &(other, _) in &pivots {
            eliminate(&mut rows[other], &rest, pivot);
        }
        rows[row] = rest;
        pivots.push((row, pivot));
    }
    pivots
}

/// a / b; most divisors are 1, and quotients of double-doubles take long.
fn quotient(a: Extended, b: Extended) -> Extended {
    if b == Extended::one() { a } else { a / b }
}

/// Subtracts the multiple of `other`, which is 1 at `pivot`, that makes `row` zero there.
fn eliminate(row: &mut [Extended; 6], other: &[Extended; 6], pivot: usize) {
    let factor = row[pivot];
    for k in 0..6 {
        row[k] -= factor * other[k];
    }
    row[pivot] = Extended::zero();
}
