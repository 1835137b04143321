//! Vectors and matrices of scalars.

use crate::Scalar;

pub(crate) type Vector<T> = [T; 3];

/// Rows of three; the columns of axes are unit vectors.
pub(crate) type Matrix<T> = [[T; 3]; 3];

pub(crate) const IDENTITY: Matrix<f64> = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

pub(crate) fn vector<T: Scalar>(a: Vector<f64>) -> Vector<T> {
    a.map(T::constant)
}

pub(crate) fn matrix<T: Scalar>(a: Matrix<f64>) -> Matrix<T> {
    a.map(|row| row.map(T::constant))
}

pub(crate) fn add<T: Scalar>(a: &Vector<T>, b: &Vector<T>) -> Vector<T> {
    std::array::from_fn(|k| a[k].plus(&b[k]))
}

pub(crate) fn subtract<T: Scalar>(a: &Vector<T>, b: &Vector<T>) -> Vector<T> {
    std::array::from_fn(|k| a[k].minus(&b[k]))
}

pub(crate) fn scale<T: Scalar>(a: &Vector<T>, factor: &T) -> Vector<T> {
    std::array::from_fn(|k| a[k].times(factor))
}

pub(crate) fn dot<T: Scalar>(a: &Vector<T>, b: &Vector<T>) -> T {
    a[0].times(&b[0]).plus(&a[1].times(&b[1])).plus(&a[2].times(&b[2]))
}

pub(crate) fn cross<T: Scalar>(a: &Vector<T>, b: &Vector<T>) -> Vector<T> {
    let part = |i: usize, j: usize| a[i].times(&b[j]).minus(&a[j].times(&b[i]));
    [part(1, 2), part(2, 0), part(0, 1)]
}

/// Magnitude; at zero without slope.
pub(crate) fn norm<T: Scalar>(a: &Vector<T>) -> T {
    let length = a[0].value().hypot(a[1].value()).hypot(a[2].value());
    let slope = |k: usize| if length > 0.0 { a[k].value() / length } else { 0.0 };
    T::compose(length, &[(slope(0), &a[0]), (slope(1), &a[1]), (slope(2), &a[2])])
}

/// A column of a matrix.
pub(crate) fn column<T: Scalar>(a: &Matrix<T>, k: usize) -> Vector<T> {
    std::array::from_fn(|row| a[row][k].clone())
}

/// A b
pub(crate) fn apply<T: Scalar>(a: &Matrix<T>, b: &Vector<T>) -> Vector<T> {
    std::array::from_fn(|row| dot(&a[row], b))
}

/// A^T b: the components of b along the axes A.
pub(crate) fn resolve<T: Scalar>(a: &Matrix<T>, b: &Vector<T>) -> Vector<T> {
    std::array::from_fn(|k| dot(&column(a, k), b))
}

/// A B
pub(crate) fn product<T: Scalar>(a: &Matrix<T>, b: &Matrix<T>) -> Matrix<T> {
    std::array::from_fn(|row| std::array::from_fn(|k| dot(&a[row], &column(b, k))))
}

/// w x A, column by column.
pub(crate) fn turned<T: Scalar>(w: &Vector<T>, a: &Matrix<T>) -> Matrix<T> {
    let columns: [Vector<T>; 3] = std::array::from_fn(|k| cross(w, &column(a, k)));
    std::array::from_fn(|row| std::array::from_fn(|k| columns[k][row].clone()))
}
