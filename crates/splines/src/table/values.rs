//! A table of values: what an ADAMS SPLINE holds.

use nalgebra::DMatrix;

use crate::curve::check_increasing;
use crate::error::Error;

/// Values over x, with one curve for every z; or one curve alone, without z.
///
/// In a table of influence coefficients x is the place of the load and z that of the deflection.
///
/// ```
/// use nalgebra::DMatrix;
/// use splines::Table;
///
/// let x = vec![0.0, 20.0, 40.0, 60.0];
/// let values = DMatrix::from_fn(4, 4, |i, j| (i * j) as f64);
/// let table = Table::new(x.clone(), x, values)?;
/// assert_eq!(table.values()[(2, 3)], 6.0);
/// assert_eq!(table.transposed()?, table);
/// # Ok::<(), splines::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    x: Vec<f64>,
    z: Vec<f64>,
    values: DMatrix<f64>,
}

impl Table {
    /// Fewest x values that ADAMS accepts in a SPLINE.
    pub const LEAST: usize = 4;

    /// A family of curves. `values` is z.len() x x.len(): row i belongs to `z[i]`, column j to `x[j]`.
    ///
    /// # Errors
    /// Fewer than four x; no z; either not increasing; a number that is not finite; a wrong shape.
    pub fn new(x: Vec<f64>, z: Vec<f64>, values: DMatrix<f64>) -> Result<Table, Error> {
        if z.is_empty() {
            return Err(Error::Points { found: 0, least: 1 });
        }
        check_increasing(&z)?;
        Table::checked(x, z, values)
    }

    /// One curve, `y` over `x`, without z.
    ///
    /// # Errors
    /// As [`Table::new`].
    pub fn curve(x: Vec<f64>, y: Vec<f64>) -> Result<Table, Error> {
        let values = DMatrix::from_row_slice(1, y.len(), &y);
        Table::checked(x, Vec::new(), values)
    }

    fn checked(x: Vec<f64>, z: Vec<f64>, values: DMatrix<f64>) -> Result<Table, Error> {
        if x.len() < Table::LEAST {
            return Err(Error::Points { found: x.len(), least: Table::LEAST });
        }
        check_increasing(&x)?;
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

    /// Stations of the load, increasing, length.
    #[must_use]
    pub fn x(&self) -> &[f64] {
        &self.x
    }

    /// Stations of the deflection, increasing, length; empty for one curve alone.
    #[must_use]
    pub fn z(&self) -> &[f64] {
        &self.z
    }

    /// The values, one row a curve.
    #[must_use]
    pub fn values(&self) -> &DMatrix<f64> {
        &self.values
    }

    /// The family with x and z exchanged.
    ///
    /// # Errors
    /// Fewer than four z, which then are too few x.
    pub fn transposed(&self) -> Result<Table, Error> {
        Table::new(self.z.clone(), self.x.clone(), self.values.transpose())
    }
}
