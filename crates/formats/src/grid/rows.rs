//! Matrices as they are written in JSON: a list of numbers for each row.

use nalgebra::DMatrix;
use serde::{Serialize, Serializer};

/// All rows of a matrix.
pub struct MatrixRows<'a>(pub &'a DMatrix<f64>);

/// One row of a matrix, with its index.
pub struct MatrixRow<'a>(pub &'a DMatrix<f64>, pub usize);

impl Serialize for MatrixRows<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq((0..self.0.nrows()).map(|row| MatrixRow(self.0, row)))
    }
}

impl Serialize for MatrixRow<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.row(self.1).iter())
    }
}
