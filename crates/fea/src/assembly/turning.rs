//! Rotations of a body about axes that are not global and that nothing stiffens.

use nalgebra::{Matrix3, Vector3};

use crate::assembly::precision::Real;

/// Axes of rotation of a body, in place of the global ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TurnedAxes {
    /// The body.
    pub body: usize,
    /// Columns: the axes, in terms of the three rotational columns of the body.
    pub axes: Matrix3<f64>,
    /// Axes about which nothing stiffens the body.
    pub unstiffened: [bool; 3],
}

/// Axes about which nothing stiffens a body, for the stiffness `block` of its three rotational columns, which is
/// symmetric and positive semidefinite. Columns with a diagonal of exactly zero are not among them.
///
/// State: the block D scaled to a unit diagonal. It is eliminated with the largest remaining diagonal entry as
/// pivot (Cholesky). When that is at most `tolerance`, the eliminated rows R11, R12 determine the null space by
/// R11 x = -R12 y for each unit vector y of what remains. Empty if every pivot exceeds the tolerance.
pub(crate) fn unstiffened_axes<T: Real>(block: &[[T; 3]; 3], tolerance: f64) -> Vec<Vector3<f64>> {
    let mut rest: Vec<usize> = (0..3).filter(|&k| block[k][k] > T::zero()).collect();
    let mut scale = [T::one(); 3];
    for &k in &rest {
        scale[k] = T::one() / block[k][k].root();
    }
    let mut a: [[T; 3]; 3] =
        std::array::from_fn(|i| std::array::from_fn(|j| scale[i] * block[i][j] * scale[j]));
    let mut pivots: Vec<usize> = Vec::new();
    while let Some(&p) = rest
        .iter()
        .max_by(|&&i, &&j| a[i][i].double().total_cmp(&a[j][j].double()))
    {
        if a[p][p].double() <= tolerance {
            break;
        }
        rest.retain(|&k| k != p);
        pivots.push(p);
        for &i in &rest {
            let factor = a[i][p] / a[p][p];
            for &j in &rest {
                let product = factor * a[p][j];
                a[i][j] -= product;
            }
        }
    }
    let axis = |&remaining: &usize| {
        let mut v = [T::zero(); 3];
        v[remaining] = T::one();
        for (at, &p) in pivots.iter().enumerate().rev() {
            let later = pivots[at + 1..].iter().copied().chain([remaining]);
            let mut sum = T::zero();
            for k in later {
                sum += a[p][k] * v[k];
            }
            v[p] = -sum / a[p][p];
        }
        Vector3::from(std::array::from_fn::<f64, 3, _>(|k| {
            (scale[k] * v[k]).double()
        }))
        .normalize()
    };
    rest.iter().map(axis).collect()
}

impl TurnedAxes {
    /// Orthonormal axes with `unstiffened` among them; `free` are the rotational columns that may be combined.
    ///
    /// Each axis takes the place of the global one that it is nearest to.
    pub fn new(body: usize, unstiffened: &[Vector3<f64>], free: [bool; 3]) -> TurnedAxes {
        let columns: Vec<usize> = (0..3).filter(|&k| free[k]).collect();
        let unit = |k: usize| Matrix3::identity().column(k).into_owned();
        let mut found: Vec<Vector3<f64>> = Vec::new();
        for axis in unstiffened {
            found.push(normal_part(axis, &found).normalize());
        }
        let count = found.len();
        while found.len() < columns.len() {
            let parts = columns.iter().map(|&k| normal_part(&unit(k), &found));
            let largest = parts.fold(
                Vector3::zeros(),
                |a, b| if b.norm() > a.norm() { b } else { a },
            );
            found.push(largest.normalize());
        }
        let mut out = TurnedAxes {
            body,
            axes: Matrix3::identity(),
            unstiffened: [false; 3],
        };
        let mut places = columns;
        for (index, axis) in found.iter().enumerate() {
            let nearest = (0..places.len()).fold(0, |a, b| {
                if axis[places[b]].abs() > axis[places[a]].abs() {
                    b
                } else {
                    a
                }
            });
            let place = places.remove(nearest);
            out.axes.set_column(place, axis);
            out.unstiffened[place] = index < count;
        }
        out
    }
}

/// The part of a vector normal to orthonormal ones.
fn normal_part(v: &Vector3<f64>, others: &[Vector3<f64>]) -> Vector3<f64> {
    // Twice: the first pass may cancel.
    let once = others.iter().fold(*v, |v, other| v - other * other.dot(&v));
    others
        .iter()
        .fold(once, |v, other| v - other * other.dot(&v))
}
