//! The critical factor of a preload, by the count of Wittrick and Williams.
//!
//! With the axial forces held in proportion, J(alpha) is the number of critical factors below alpha:
//!
//! J = sum of J0 + number of negative pivots of K + K_g(alpha N) = L D L^T
//!
//! J0 of a member counts its own critical factors with both ends clamped, and its releases, condensed, count by their own
//! negative pivots. J does not decrease, so that bisection finds the first critical factor, whatever its mode: none is
//! missed.
//!
//! # Source
//! Wittrick and Williams, Q. J. Mech. Appl. Math. 24 (1971) 263-284; Int. J. Mech. Sci. 15 (1973) for buckling.

use std::f64::consts::PI;

use nalgebra::{DVector, SVector, Vector3};
use splines::BeamColumn;
use sprs::CsMat;

use crate::assembly::{
    Bodies, Element, Extended, Numbering, ScaledStiffness, bending_planes, end_displacements,
    inverse_iterations, irregular_vector, symmetric_product,
};
use crate::dof::Dof;
use crate::error::{Buckling, EntryAttribute, Error};
use crate::factor::{Factor, FactorError, IndefiniteFactor, allow_square};
use crate::model::{MemberKind, Model};

/// Largest critical factor that is looked for.
pub const MOST_CRITICAL: f64 = 1e6;
/// Least factor that is told from zero.
const LEAST: f64 = 1e-9;
/// Width at which bisection ends, relative.
const RESOLUTION: f64 = 1e-12;
/// Width, relative, from which the bracket is narrowed by the mode.
const COARSE: f64 = 0.02;
/// How far beside a guess the count is asked for, by the width of the bracket.
const BESIDE: f64 = 2e-3;
/// Operations of a factor up to which a count that rounding may have changed is taken again in double-doubles.
const MOST_EXTENDED: f64 = 1e7;
/// Steps of inverse iteration for the mode.
const MODE_STEPS: usize = 4;
/// Component of a motion, relative to the largest, that counts as equal to it.
const EQUAL: f64 = 1e-6;

/// The smallest factor on a preload at which the structure has no unique state any more.
///
/// It is that of axial forces alone: lateral-torsional buckling is not included.
#[derive(Clone, Debug, PartialEq)]
pub enum CriticalFactor {
    /// The factor, and the motion in which the structure buckles.
    At(f64, BucklingMode),
    /// None up to this factor.
    Above(f64),
}

impl CriticalFactor {
    /// The factor, or the one up to which there is none.
    #[must_use]
    pub fn value(&self) -> f64 {
        match self {
            CriticalFactor::At(value, _) | CriticalFactor::Above(value) => *value,
        }
    }
}

/// A motion in which a structure buckles.
#[derive(Clone, Debug, PartialEq)]
pub struct BucklingMode {
    /// For each point its three displacements and three rotations, global; the largest displacement is one, or the largest
    /// rotation where no point is displaced. All zero if a member buckles between its ends alone.
    pub points: Vec<[f64; 6]>,
    /// What moves most.
    pub most: Buckling,
}

/// A preloaded model ready for counting.
pub(super) struct Critical<'a> {
    m: &'a Model,
    bodies: Bodies,
    numbering: Numbering,
}

/// A factor at which was counted.
struct Trial {
    alpha: f64,
    /// Number of critical factors below it.
    count: usize,
    /// The scaled stiffness there and its factor, where there is one.
    stiffness: Option<(CsMat<f64>, IndefiniteFactor)>,
}

/// Where the stiffness in the motion that resists least vanishes between two factors: `x` approaches this motion by inverse
/// iteration at the upper one, and x^T (K + K_g) x is taken as a straight line. `None` where it does not change its sign.
fn interpolated(low: &Trial, high: &mut Trial, x: &mut [f64]) -> Option<f64> {
    let (below, _) = low.stiffness.as_ref()?;
    let (above, factor) = high.stiffness.as_mut()?;
    inverse_iterations(x, MODE_STEPS, |x| factor.solve(x));
    let at = DVector::from_column_slice(x);
    let [a, b] = [below, above].map(|k| symmetric_product(k, at.as_view()).dot(&at));
    (a > 0.0 && b < 0.0).then(|| low.alpha + (high.alpha - low.alpha) * a / (a - b))
}

impl<'a> Critical<'a> {
    /// Numbers the unknowns of the loaded model `m`.
    ///
    /// # Errors
    /// As [`crate::FactoredFrame::new`] for an entry that cannot be used.
    pub fn new(m: &'a Model) -> Result<Critical<'a>, Error> {
        let elements = Element::all(m)?;
        let mut bodies = Bodies::new(m);
        let stiffness = ScaledStiffness::new(m, &elements, &mut bodies)?;
        Ok(Critical {
            m,
            bodies,
            numbering: stiffness.numbering,
        })
    }

    /// The model with the preload times alpha.
    fn scaled(&self, alpha: f64) -> Model {
        let mut m = self.m.clone();
        m.members
            .iter_mut()
            .for_each(|member| member.tension *= alpha);
        m.arms.iter_mut().for_each(|arm| {
            arm.stiffness
                .as_flattened_mut()
                .iter_mut()
                .for_each(|k| *k *= alpha)
        });
        m
    }

    /// The count at a factor. A member whose shear stiffness is exceeded counts as buckled; so does a structure in which a
    /// pivot is exactly zero at the factor and beside it.
    fn trial(&self, alpha: f64) -> Result<Trial, Error> {
        for step in 0..4 {
            let beside = alpha * (1.0 + f64::from(step) * 3.0 * f64::EPSILON);
            if let Some(found) = self
                .trial_at(beside)
                .map_err(|fault| self.too_large(fault))?
            {
                return Ok(found);
            }
        }
        Ok(Trial {
            alpha,
            count: 1,
            stiffness: None,
        })
    }

    fn trial_at(&self, alpha: f64) -> Result<Option<Trial>, FactorError> {
        let m = self.scaled(alpha);
        let mut members = 0;
        for index in 0..m.members.len() {
            match self.buckled(&m, index) {
                Some(own) => members += own,
                None => return Ok(None),
            }
        }
        if m.check().is_err() {
            return Ok(Some(Trial {
                alpha,
                count: members.max(1),
                stiffness: None,
            }));
        }
        let Ok(stiffness) = ScaledStiffness::<f64>::in_precision(&m, &self.numbering) else {
            return Ok(None);
        };
        let Some(mut factor) = IndefiniteFactor::new(&stiffness.upper)? else {
            return Ok(None);
        };
        let Some((mut pivots, is_certain)) = factor.negative_pivots() else {
            return Ok(None);
        };
        if !is_certain && self.numbering.operations <= MOST_EXTENDED {
            pivots = self.extended_pivots(&m, pivots)?;
        }
        Ok(Some(Trial {
            alpha,
            count: members + pivots,
            stiffness: Some((stiffness.upper, factor)),
        }))
    }

    /// Number of negative pivots in double-doubles, where that in doubles is `pivots`: none where the stiffness has a factor of
    /// Cholesky, otherwise at least one.
    fn extended_pivots(&self, m: &Model, pivots: usize) -> Result<usize, FactorError> {
        let Ok(stiffness) = ScaledStiffness::<Extended>::in_precision(m, &self.numbering) else {
            return Ok(pivots);
        };
        match Factor::<Extended>::new(&stiffness.upper) {
            Ok(_) => Ok(0),
            Err(FactorError::Indefinite) => Ok(pivots.max(1)),
            Err(fault) => Err(fault),
        }
    }

    /// Number of critical factors of a member of the scaled model `m` between its clamped ends, and of its releases.
    fn buckled(&self, m: &Model, index: usize) -> Option<usize> {
        let tension = m.members[index].tension;
        if tension >= 0.0 {
            return Some(0);
        }
        let element: Element = Element::new(m, index).ok()?;
        let released = element
            .released
            .as_ref()
            .map_or(0, |released| released.negative);
        if m.members[index].kind != MemberKind::Beam {
            return Some(released);
        }
        let planes = bending_planes(&element.flexibility);
        let own = planes
            .iter()
            .filter(|plane| plane.bending.is_finite() && plane.shear.is_finite());
        let clamped = own.map(|plane| {
            clamped_count(&BeamColumn::new(
                plane.bending,
                plane.shear,
                tension,
                element.length,
            ))
        });
        Some(released + clamped.sum::<usize>())
    }

    /// The first critical factor: doubling until the count is not zero, bisection to a hundredth, then refinement.
    ///
    /// # Errors
    /// A factor that is too large.
    pub fn first(&self) -> Result<CriticalFactor, Error> {
        let mut low = self.trial(1.0)?;
        let mut high;
        if low.count == 0 {
            loop {
                high = self.trial((2.0 * low.alpha).min(MOST_CRITICAL))?;
                if high.count > 0 {
                    break;
                }
                if high.alpha >= MOST_CRITICAL {
                    return Ok(CriticalFactor::Above(MOST_CRITICAL));
                }
                low = high;
            }
        } else {
            high = low;
            loop {
                low = self.trial(0.5 * high.alpha)?;
                if low.count == 0 || low.alpha < LEAST {
                    break;
                }
                high = low;
            }
        }
        let mut x = irregular_vector(self.numbering.column.len());
        while high.alpha - low.alpha > RESOLUTION * high.alpha {
            let width = high.alpha - low.alpha;
            let guess = if width < COARSE * high.alpha {
                interpolated(&low, &mut high, &mut x)
            } else {
                None
            };
            if let Some(guess) = guess {
                self.narrow(&mut low, &mut high, guess)?;
                // The factor is beside the guess: on the other side of it, too, the bracket closes.
                let step = if low.alpha >= guess {
                    BESIDE * width
                } else {
                    -BESIDE * width
                };
                self.narrow(&mut low, &mut high, guess + step)?;
            }
            if high.alpha - low.alpha > 0.5 * width {
                let middle = 0.5 * (low.alpha + high.alpha);
                if !self.narrow(&mut low, &mut high, middle)? {
                    break;
                }
            }
        }
        let factor = 0.5 * (low.alpha + high.alpha);
        Ok(CriticalFactor::At(factor, self.mode(low.alpha, high)))
    }

    /// Counts at a factor inside the bracket, which becomes one of its ends; false where it is not inside.
    fn narrow(&self, low: &mut Trial, high: &mut Trial, alpha: f64) -> Result<bool, Error> {
        if !(alpha > low.alpha && alpha < high.alpha) {
            return Ok(false);
        }
        let found = self.trial(alpha)?;
        let end = if found.count == 0 { low } else { high };
        *end = found;
        Ok(true)
    }

    fn too_large(&self, fault: FactorError) -> Error {
        let unknowns = self.numbering.column.len();
        match fault {
            FactorError::TooLarge(_) => allow_square(EntryAttribute::Factor, unknowns)
                .err()
                .unwrap_or(Error::NotFactorable { unknowns }),
            FactorError::Indefinite => Error::NotFactorable { unknowns },
        }
    }

    /// The mode of the critical factor between `low` and that of a trial.
    fn mode(&self, low: f64, high: Trial) -> BucklingMode {
        let n = self.numbering.column.len();
        let (before, behind) = (
            self.scaled(low * (1.0 - 1e-9)),
            self.scaled(high.alpha * (1.0 + 1e-9)),
        );
        let rest = vec![[0.0; 6]; self.m.points.len()];
        let changed = (0..self.m.members.len()).find(|&index| {
            self.buckled(&before, index)
                .zip(self.buckled(&behind, index))
                .is_some_and(|(a, b)| b > a)
        });
        if let Some(member) = changed {
            let point = self.m.members[member].points[0];
            let dof = Dof::ALL[0];
            let most = Buckling {
                point,
                dof,
                member,
                between_ends: true,
            };
            return BucklingMode { points: rest, most };
        }
        let mut x = irregular_vector(n);
        if let Some((_, mut factor)) = high.stiffness {
            inverse_iterations(&mut x, MODE_STEPS, |x| factor.solve(x));
        }
        let column = self.numbering.largest_column(&x, EQUAL);
        let mut motions = vec![SVector::<f64, 6>::zeros(); self.bodies.list.len()];
        for (k, value) in x.iter().enumerate() {
            let column = self.numbering.column[k];
            motions[column / 6][column % 6] = value * self.numbering.scale[k];
        }
        let motions: Vec<SVector<f64, 6>> = motions
            .iter()
            .zip(&self.bodies.list)
            .map(|(motion, body)| body.basis * motion)
            .collect();
        let points = (0..self.m.points.len()).map(|point| {
            let motion = self.bodies.motion(point, &Vector3::zeros());
            <[f64; 6]>::from(motion * motions[self.bodies.of_point[point]])
        });
        BucklingMode {
            points: normalised(points.collect()),
            most: Buckling {
                point: self.bodies.list[column / 6].reference,
                dof: Dof::ALL[column % 6],
                member: self.most_work(&behind, &motions),
                between_ends: false,
            },
        }
    }

    /// The member whose axial force does most of the work in a motion.
    fn most_work(&self, m: &Model, motions: &[SVector<f64, 6>]) -> usize {
        let unloaded = m.unloaded();
        let work = |index: usize| -> f64 {
            let [Ok(loaded), Ok(own)] = [m, &unloaded].map(|m| Element::<f64>::new(m, index))
            else {
                return 0.0;
            };
            let Some(tips) = end_displacements(&loaded, &self.bodies, motions) else {
                return 0.0;
            };
            (tips.transpose() * (own.stiffness() - loaded.stiffness()) * tips)[0]
        };
        let all: Vec<f64> = (0..m.members.len()).map(work).collect();
        (0..all.len()).fold(0, |a, b| if all[b] > all[a] { b } else { a })
    }
}

/// Number of critical factors below the axial force of a compressed plane whose ends are clamped: with beta^2 = -(lambda l)^2
///
/// J0 = floor(beta/pi) - number of negative ones of the stiffness against opposite and equal rotations of the ends.
///
/// The first term counts the critical factors of the pinned member; releasing the ends of the clamped one condenses a
/// matrix with these two eigenvalues.
fn clamped_count(column: &BeamColumn<f64>) -> usize {
    let beta = (-column.square()).max(0.0).sqrt();
    let pinned = (beta / PI).floor() as usize;
    let negative = column
        .rotational_stiffness()
        .iter()
        .filter(|&&k| k < 0.0)
        .count();
    pinned.saturating_sub(negative)
}

/// Motions of points divided by the largest displacement, or rotation where there is none.
fn normalised(mut points: Vec<[f64; 6]>) -> Vec<[f64; 6]> {
    let largest = |of: std::ops::Range<usize>| {
        points
            .iter()
            .flat_map(|point| point[of.clone()].iter())
            .fold(0.0_f64, |a, b| if b.abs() > a.abs() { *b } else { a })
    };
    let (displaced, turned) = (largest(0..3), largest(3..6));
    let size = if displaced == 0.0 { turned } else { displaced };
    if size != 0.0 && size.is_finite() {
        points.iter_mut().flatten().for_each(|x| *x /= size);
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Analytic: the clamped member buckles at beta = 2 pi, 8.98682, 4 pi: the roots of sin(beta/2) = 0 and tan(beta/2) =
    /// beta/2. Timoshenko and Gere, Theory of Elastic Stability (1961), section 2.9.
    #[test]
    fn clamped_members_are_counted() {
        for (beta, known) in [
            (0.1, 0),
            (3.2, 0),
            (6.2, 0),
            (6.3, 1),
            (8.9, 1),
            (9.0, 2),
            (12.5, 2),
            (12.6, 3),
        ] {
            let column = BeamColumn::new(1.0, 0.0, -f64::powi(beta, 2), 1.0);
            assert_eq!(clamped_count(&column), known, "{beta}");
        }
    }
}
