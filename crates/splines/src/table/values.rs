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
/// use splines::SplineTable;
///
/// let x = vec![0.0, 20.0, 40.0, 60.0];
/// let values = DMatrix::from_fn(4, 4, |i, j| (i * j) as f64);
/// let table = SplineTable::new(x.clone(), x, values)?;
/// assert_eq!(table.values()[(2, 3)], 6.0);
/// assert_eq!(table.transposed()?, table);
/// # Ok::<(), splines::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SplineTable {
    x: Vec<f64>,
    z: Vec<f64>,
    values: DMatrix<f64>,
}

impl SplineTable {
    /// Fewest x values that ADAMS accepts in a SPLINE.
    pub const FEWEST_X: usize = 4;

    /// A family of curves. `values` is z.len() x x.len(): row i belongs to `z[i]`, column j to `x[j]`.
    ///
    /// # Errors
    /// Fewer than four x; no z; either not increasing; a number that is not finite; a wrong shape.
    pub fn new(x: Vec<f64>, z: Vec<f64>, values: DMatrix<f64>) -> Result<SplineTable, Error> {
        if z.is_empty() {
            return Err(Error::TooFewPoints { found: 0, least: 1 });
        }
        check_increasing(&z)?;
        SplineTable::checked(x, z, values)
    }

    /// One curve, `y` over `x`, without z.
    ///
    /// # Errors
    /// As [`SplineTable::new`].
    pub fn curve(x: Vec<f64>, y: Vec<f64>) -> Result<SplineTable, Error> {
        let values = DMatrix::from_row_slice(1, y.len(), &y);
        SplineTable::checked(x, Vec::new(), values)
    }

    fn checked(x: Vec<f64>, z: Vec<f64>, values: DMatrix<f64>) -> Result<SplineTable, Error> {
        if x.len() < SplineTable::FEWEST_X {
            return Err(Error::TooFewPoints {
                found: x.len(),
                least: SplineTable::FEWEST_X,
            });
        }
        check_increasing(&x)?;
        let expected = [z.len().max(1), x.len()];
        let (rows, columns) = values.shape();
        if [rows, columns] != expected {
            return Err(Error::TableShape {
                rows,
                columns,
                expected,
            });
        }
        for row in 0..rows {
            for column in 0..columns {
                if !values[(row, column)].is_finite() {
                    return Err(Error::TableNumber { row, column });
                }
            }
        }
        Ok(SplineTable { x, z, values })
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
    pub fn transposed(&self) -> Result<SplineTable, Error> {
        SplineTable::new(self.z.clone(), self.x.clone(), self.values.transpose())
    }
}
