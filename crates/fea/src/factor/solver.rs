//! Factoring in the precision that the accuracy needs, and names for what cannot be factored.

use crate::assembly::{
    Bodies, Extended, Real, ScaledStiffness, inverse_iterations, irregular_vector,
};
use crate::dof::Dof;
use crate::error::{EntryAttribute, Error};
use crate::factor::certificate::Certificate;
use crate::factor::cholesky::{Factor, FactorError};
use crate::factor::forward::{Gram, SparseLoad};
use crate::factor::memory::allow;
use crate::model::Model;

/// Fraction of the accuracy that the factor may use up in doubles; the evaluation needs the rest.
const FACTOR_FRACTION: f64 = 0.9;
/// Operations beyond which a factor in double-doubles takes minutes.
const MOST_OPERATIONS: f64 = 1e10;
/// Unknowns up to which double-doubles cost next to nothing and are always used.
const FEW_UNKNOWNS: usize = 100;
/// Pivot of the scaled stiffness (diagonal about one) at which only rounding is left.
const LEAST_PIVOT: f64 = 1e-14;
/// The same in double-doubles.
const LEAST_PIVOT_EXTENDED: f64 = 1e-27;
/// Shifts that make a singular scaled stiffness positive definite; the first that does is used.
const SHIFTS: [f64; 3] = [1e-11, 1e-8, 1e-5];
/// Difference of two components of a motion at which they count as equal; the largest is 1.
const EQUAL: f64 = 1e-9;
/// Bytes of a double.
const DOUBLE: u64 = size_of::<f64>() as u64;

/// Cholesky factor of the scaled stiffness.
#[derive(Debug)]
pub(crate) enum Solver {
    /// In doubles.
    Double(Factor<f64>),
    /// In double-doubles, formed from the doubles of the model.
    Extended(Factor<Extended>),
}

/// A factor with what is known about its error.
#[derive(Debug)]
pub(crate) struct Factored {
    pub solver: Solver,
    pub certificate: Certificate,
    /// Bound of |(S K S)^-1| in the 1-norm.
    pub inverse_norm: f64,
}

impl Solver {
    /// Number of unknowns.
    pub fn len(&self) -> usize {
        match self {
            Solver::Double(factor) => factor.len(),
            Solver::Extended(factor) => factor.len(),
        }
    }

    /// Bytes of the factor.
    pub fn bytes(&self) -> u64 {
        match self {
            Solver::Double(factor) => factor.bytes(),
            Solver::Extended(factor) => factor.bytes(),
        }
    }

    /// Products w_i . w_j of the loads, w = L^-1 p rounded to doubles.
    pub fn gram(&self, loads: &[SparseLoad]) -> Gram {
        match self {
            Solver::Double(factor) => factor.gram(loads),
            Solver::Extended(factor) => factor.gram(loads),
        }
    }

    /// Solves K x = x in place.
    pub fn solve(&self, x: &mut [f64]) {
        match self {
            Solver::Double(factor) => factor.solve(x),
            Solver::Extended(factor) => {
                let mut wide: Vec<Extended> = x.iter().map(|&value| value.into()).collect();
                factor.solve(&mut wide);
                x.iter_mut()
                    .zip(wide)
                    .for_each(|(x, value)| *x = value.double());
            }
        }
    }
}

impl Factored {
    /// Factors in doubles and keeps the factor if its error bound leaves room for the evaluation; otherwise
    /// forms stiffness and factor again in double-doubles. Small frames go to double-doubles at once.
    ///
    /// # Errors
    /// A mechanism; an error bound above `accuracy`; a factor that is too large.
    pub fn new(
        m: &Model,
        stiffness: &ScaledStiffness,
        bodies: &Bodies,
        accuracy: f64,
    ) -> Result<Factored, Error> {
        let unknowns = stiffness.len();
        if !stiffness.norm().is_finite() {
            return Err(Error::NotFactorable { unknowns });
        }
        let expensive = stiffness.numbering.operations > MOST_OPERATIONS;
        if unknowns > FEW_UNKNOWNS {
            match Factor::new(&stiffness.upper) {
                Ok(factor) if factor.least_pivot() > LEAST_PIVOT => {
                    let (certificate, inverse_norm) = Certificate::new(stiffness, &factor);
                    if certificate.error_bound <= FACTOR_FRACTION * accuracy {
                        return Ok(Factored {
                            solver: Solver::Double(factor),
                            certificate,
                            inverse_norm,
                        });
                    }
                    // Double-doubles might meet the accuracy, but would take minutes.
                    if expensive {
                        return Err(ill_conditioned(certificate, accuracy, stiffness, bodies));
                    }
                }
                Ok(_) | Err(FactorError::Indefinite) if expensive => {
                    return Err(mechanism(stiffness, bodies));
                }
                Ok(_) | Err(FactorError::Indefinite) => {}
                Err(FactorError::TooLarge(entries)) => {
                    return Err(too_large(unknowns, entries, DOUBLE));
                }
            }
        }
        let factored = Factored::extended(m, stiffness).map_err(|fault| match fault {
            FactorError::Indefinite => mechanism(stiffness, bodies),
            FactorError::TooLarge(entries) => too_large(unknowns, entries, 2 * DOUBLE),
        })?;
        if factored.certificate.error_bound > accuracy {
            return Err(ill_conditioned(
                factored.certificate,
                accuracy,
                stiffness,
                bodies,
            ));
        }
        Ok(factored)
    }

    /// The factor in double-doubles of a stiffness that is formed again from the model: its doubles have lost the
    /// digits already.
    ///
    /// # Errors
    /// Pivots that are only rounding; a factor that is too large, also in operations.
    pub fn extended(m: &Model, stiffness: &ScaledStiffness) -> Result<Factored, FactorError> {
        if stiffness.numbering.operations > MOST_OPERATIONS {
            return Err(FactorError::TooLarge(0));
        }
        let extended = ScaledStiffness::<Extended>::in_precision(m, &stiffness.numbering)
            .map_err(|_| FactorError::Indefinite)?;
        let factor = Factor::new(&extended.upper)?;
        if factor.least_pivot() <= LEAST_PIVOT_EXTENDED {
            return Err(FactorError::Indefinite);
        }
        let (certificate, inverse_norm) = Certificate::new(&extended, &factor);
        Ok(Factored {
            solver: Solver::Extended(factor),
            certificate,
            inverse_norm,
        })
    }
}

/// The error of a factor with too many entries; `entries` is 0 if the indices do not suffice.
fn too_large(unknowns: usize, entries: u64, size: u64) -> Error {
    allow(EntryAttribute::Factor, entries, size)
        .err()
        .unwrap_or(Error::NotFactorable { unknowns })
}

/// The error of a stiffness without a factor.
fn mechanism(stiffness: &ScaledStiffness, bodies: &Bodies) -> Error {
    let (point, freedom) = weakest(stiffness, bodies);
    Error::Mechanism {
        point,
        dof: freedom,
    }
}

/// The error of a certificate that does not meet the accuracy asked for.
pub(crate) fn ill_conditioned(
    certificate: Certificate,
    asked: f64,
    stiffness: &ScaledStiffness,
    bodies: &Bodies,
) -> Error {
    let (point, freedom) = weakest(stiffness, bodies);
    let Certificate {
        condition,
        error_bound: bound,
        ..
    } = certificate;
    Error::IllConditioned {
        condition,
        bound,
        asked,
        point,
        dof: freedom,
    }
}

/// Point and degree of freedom with the largest component, weighted by stiffness, in the motion with the
/// least strain.
///
/// Three inverse iterations with the slightly shifted stiffness approximate this motion. Among equal
/// components the one of the lowest column is named.
fn weakest(stiffness: &ScaledStiffness, bodies: &Bodies) -> (usize, Dof) {
    let factor = SHIFTS
        .iter()
        .find_map(|&shift| Factor::new(&stiffness.shifted(shift)).ok());
    let mut x = irregular_vector(stiffness.len());
    if let Some(factor) = factor {
        inverse_iterations(&mut x, 3, |x| factor.solve(x));
    }
    let column = stiffness.numbering.largest_column(&x, EQUAL);
    (bodies.list[column / 6].reference, Dof::ALL[column % 6])
}
