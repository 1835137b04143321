//! What a SPLINE holds.

use crate::Fault;

/// Values over x: one curve for every z, or one curve alone, without z.
///
/// In an influence table x is where the load stands and z where the deflection is taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    x: Vec<f64>,
    z: Vec<f64>,
    y: Vec<Vec<f64>>,
}

impl Curves {
    /// Fewest x values of a SPLINE.
    pub const LEAST: usize = 4;

    /// A family of curves, `y[i]` over `x` at `z[i]`; or, with `z` empty, the one curve `y[0]`.
    ///
    /// # Errors
    /// Fewer than four x; x or z not increasing; a number that is not finite; a curve too many, too few, or of
    /// another length.
    pub fn new(x: Vec<f64>, z: Vec<f64>, y: Vec<Vec<f64>>) -> Result<Curves, Fault> {
        if x.len() < Curves::LEAST {
            return Err(Fault::Points { found: x.len(), least: Curves::LEAST });
        }
        increasing(&x)?;
        increasing(&z)?;
        if y.len() != z.len().max(1) {
            return Err(Fault::Curves { found: y.len(), expected: z.len().max(1) });
        }
        for (curve, values) in y.iter().enumerate() {
            if values.len() != x.len() {
                return Err(Fault::Values { curve, found: values.len(), expected: x.len() });
            }
            if let Some(index) = values.iter().position(|value| !value.is_finite()) {
                return Err(Fault::NotFinite { curve, index });
            }
        }
        Ok(Curves { x, z, y })
    }

    /// x, increasing.
    #[must_use]
    pub fn x(&self) -> &[f64] {
        &self.x
    }

    /// z, increasing; empty for one curve alone.
    #[must_use]
    pub fn z(&self) -> &[f64] {
        &self.z
    }

    /// One list of values a curve.
    #[must_use]
    pub fn y(&self) -> &[Vec<f64>] {
        &self.y
    }
}

fn increasing(list: &[f64]) -> Result<(), Fault> {
    if let Some(index) = list.iter().position(|value| !value.is_finite()) {
        return Err(Fault::Order { index });
    }
    match list.windows(2).position(|pair| pair[0] >= pair[1]) {
        Some(k) => Err(Fault::Order { index: k + 1 }),
        None => Ok(()),
    }
}
