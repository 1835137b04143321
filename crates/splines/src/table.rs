//! A table of values: what an ADAMS SPLINE holds.

use nalgebra::DMatrix;

use crate::Error;
use crate::curve::increasing;

/// Values over x, one curve for every z; or one curve alone, without z.
///
/// In an influence table x is where the load stands and z where the deflection is taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    x: Vec<f64>,
    z: Vec<f64>,
    values: DMatrix<f64>,
}

impl Table {
    /// Fewest x values of a SPLINE.
    pub const LEAST: usize = 4;

    /// A family of curves: row i of `values` belongs to `z[i]`, column j to `x[j]`.
    ///
    /// # Errors
    /// Fewer than four x, no z, either not increasing, a number that is not finite, or a wrong shape.
    pub fn new(x: Vec<f64>, z: Vec<f64>, values: DMatrix<f64>) -> Result<Table, Error> {
        if z.is_empty() {
            return Err(Error::Points { found: 0, least: 1 });
        }
        increasing(&z)?;
        Table::checked(x, z, values)
    }

    /// One curve.
    ///
    /// # Errors
    /// As for [`Table::new`].
    pub fn curve(x: Vec<f64>, y: Vec<f64>) -> Result<Table, Error> {
        let values = DMatrix::from_row_slice(1, y.len(), &y);
        Table::checked(x, Vec::new(), values)
    }

    fn checked(x: Vec<f64>, z: Vec<f64>, values: DMatrix<f64>) -> Result<Table, Error> {
        if x.len() < Table::LEAST {
            return Err(Error::Points { found: x.len(), least: Table::LEAST });
        }
        increasing(&x)?;
        let expected = [z.len().max(1), x.len()];
        let (rows, columns) = values.shape();
        if [rows, columns] != expected {
            return Err(Error::TableShape { rows, columns, expected });
        }
        for row in 0..rows {
            for column in 0..columns {
                if !values[(row, column)].is_finite() {
                    return Err(Error::TableNumber { row, column });
                }
            }
        }
        Ok(Table { x, z, values })
    }

    /// Where the load stands.
    #[must_use]
    pub fn x(&self) -> &[f64] {
        &self.x
    }

    /// Where the deflection is taken; empty for one curve alone.
    #[must_use]
    pub fn z(&self) -> &[f64] {
        &self.z
    }

    /// One row a curve.
    #[must_use]
    pub fn values(&self) -> &DMatrix<f64> {
        &self.values
    }

    /// The family with x and z exchanged.
    ///
    /// # Errors
    /// Fewer than four z.
    pub fn transposed(&self) -> Result<Table, Error> {
        Table::new(self.z.clone(), self.x.clone(), self.values.transpose())
    }
}
