//! The values of a SPLINE.

use crate::AdamsFault;

/// Values y over x: one curve for each z, or a single curve without z.
///
/// In an influence table x is the position of the load and z the position at which the deflection is
/// measured.
///
/// ```
/// use adams::{SplineValues, AdamsFault};
///
/// let x = vec![0.0, 20.0, 40.0, 60.0];
/// let single = SplineValues::new(x.clone(), vec![], vec![vec![0.0, 2.0, 2.0, 0.0]])?;
/// assert!(single.z().is_empty());
/// let short = SplineValues::new(x, vec![], vec![vec![0.0, 2.0]]);
/// assert_eq!(short, Err(AdamsFault::Values { curve: 0, found: 2, expected: 4 }));
/// # Ok::<(), AdamsFault>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SplineValues {
    x: Vec<f64>,
    z: Vec<f64>,
    y: Vec<Vec<f64>>,
}

impl SplineValues {
    /// The smallest number of x values of a SPLINE.
    pub const MIN_POINTS: usize = 4;

    /// A family of curves, where `y[i]` are the values over `x` at `z[i]`; with an empty `z` the single curve
    /// `y[0]`.
    ///
    /// Shapes: `y` has `max(1, z.len())` lists of `x.len()` values each.
    ///
    /// # Errors
    /// [`AdamsFault::Points`] for fewer than four x values; [`AdamsFault::Order`] for x or z values that are not
    /// finite or do not increase; [`AdamsFault::Curves`] and [`AdamsFault::Values`] for a wrong shape of `y`;
    /// [`AdamsFault::NotFinite`] for a y value that is not finite.
    pub fn new(x: Vec<f64>, z: Vec<f64>, y: Vec<Vec<f64>>) -> Result<SplineValues, AdamsFault> {
        if x.len() < SplineValues::MIN_POINTS {
            return Err(AdamsFault::Points {
                found: x.len(),
                least: SplineValues::MIN_POINTS,
            });
        }
        increasing(&x)?;
        increasing(&z)?;
        if y.len() != z.len().max(1) {
            return Err(AdamsFault::Curves {
                found: y.len(),
                expected: z.len().max(1),
            });
        }
        for (curve, values) in y.iter().enumerate() {
            if values.len() != x.len() {
                return Err(AdamsFault::Values {
                    curve,
                    found: values.len(),
                    expected: x.len(),
                });
            }
            if let Some(index) = values.iter().position(|value| !value.is_finite()) {
                return Err(AdamsFault::NotFinite { curve, index });
            }
        }
        Ok(SplineValues { x, z, y })
    }

    /// The x values, increasing.
    #[must_use]
    pub fn x(&self) -> &[f64] {
        &self.x
    }

    /// The z values, increasing; empty for a single curve.
    #[must_use]
    pub fn z(&self) -> &[f64] {
        &self.z
    }

    /// The values, one list for each curve.
    #[must_use]
    pub fn y(&self) -> &[Vec<f64>] {
        &self.y
    }
}

fn increasing(list: &[f64]) -> Result<(), AdamsFault> {
    if let Some(index) = list.iter().position(|value| !value.is_finite()) {
        return Err(AdamsFault::Order { index });
    }
    match list.windows(2).position(|pair| pair[0] >= pair[1]) {
        Some(k) => Err(AdamsFault::Order { index: k + 1 }),
        None => Ok(()),
    }
}
