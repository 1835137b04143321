//! Vectors and matrices of three dimensions over any [`Scalar`].

use crate::Scalar;

/// Three components.
pub(crate) type Vector<T> = [T; 3];

/// A matrix as three rows. Where it holds axes, its columns are unit vectors.
pub(crate) type Matrix<T> = [[T; 3]; 3];

/// The identity matrix.
pub(crate) const IDENTITY: Matrix<f64> = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A vector of constants.
pub(crate) fn vector<T: Scalar>(a: Vector<f64>) -> Vector<T> {
    a.map(T::constant)
}

/// A matrix of constants.
pub(crate) fn matrix<T: Scalar>(a: Matrix<f64>) -> Matrix<T> {
    a.map(|row| row.map(T::constant))
}

/// a + b
pub(crate) fn add<T: Scalar>(a: &Vector<T>, b: &Vector<T>) -> Vector<T> {
    std::array::from_fn(|k| a[k].plus(&b[k]))
}

/// a - b
pub(crate) fn subtract<T: Scalar>(a: &Vector<T>, b: &Vector<T>) -> Vector<T> {
    std::array::from_fn(|k| a[k].minus(&b[k]))
}

/// The product of a vector and a scalar.
pub(crate) fn scale<T: Scalar>(a: &Vector<T>, factor: &T) -> Vector<T> {
    std::array::from_fn(|k| a[k].times(factor))
}

/// a . b
pub(crate) fn dot<T: Scalar>(a: &Vector<T>, b: &Vector<T>) -> T {
    a[0].times(&b[0])
        .plus(&a[1].times(&b[1]))
        .plus(&a[2].times(&b[2]))
}

/// a x b
pub(crate) fn cross<T: Scalar>(a: &Vector<T>, b: &Vector<T>) -> Vector<T> {
    let part = |i: usize, j: usize| a[i].times(&b[j]).minus(&a[j].times(&b[i]));
    [part(1, 2), part(2, 0), part(0, 1)]
}

/// The magnitude of a vector. Its derivative at the zero vector is taken as zero.
pub(crate) fn norm<T: Scalar>(a: &Vector<T>) -> T {
    let length = a[0].value().hypot(a[1].value()).hypot(a[2].value());
    let slope = |k: usize| {
        if length > 0.0 {
            a[k].value() / length
        } else {
            0.0
        }
    };
    T::compose(
        length,
        &[(slope(0), &a[0]), (slope(1), &a[1]), (slope(2), &a[2])],
    )
}

/// Column k of a matrix.
pub(crate) fn column<T: Scalar>(a: &Matrix<T>, k: usize) -> Vector<T> {
    std::array::from_fn(|row| a[row][k].clone())
}

/// A b
pub(crate) fn apply<T: Scalar>(a: &Matrix<T>, b: &Vector<T>) -> Vector<T> {
    std::array::from_fn(|row| dot(&a[row], b))
}

/// A^T b: the components of b along the columns of A.
pub(crate) fn resolve<T: Scalar>(a: &Matrix<T>, b: &Vector<T>) -> Vector<T> {
    std::array::from_fn(|k| dot(&column(a, k), b))
}

/// A B
pub(crate) fn product<T: Scalar>(a: &Matrix<T>, b: &Matrix<T>) -> Matrix<T> {
    std::array::from_fn(|row| std::array::from_fn(|k| dot(&a[row], &column(b, k))))
}

/// w x A, column by column: the rate of axes A that rotate with the angular velocity w.
pub(crate) fn cross_columns<T: Scalar>(w: &Vector<T>, a: &Matrix<T>) -> Matrix<T> {
    let columns: [Vector<T>; 3] = std::array::from_fn(|k| cross(w, &column(a, k)));
    std::array::from_fn(|row| std::array::from_fn(|k| columns[k][row].clone()))
}
