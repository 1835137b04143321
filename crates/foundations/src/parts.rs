//! A straight girder as a chain of rigid parts, joined by elastic beams between their centres.
//!
//! Girders used to be modelled in this form by hand in multibody programs. The girder is divided into n parts of
//! equal length. Beams with the section of the girder connect the centres, and each support restrains the part above
//! it. The compliance C of the centres, 6n x 6n, is computed from this frame ([`nodal_compliance`]). A wheel stands
//! on the rigid extension of the part below it and passes to the next part within a window about their joint.
//!
//! Without mass the displacements of the rail follow directly from C. With mass, C is diagonalised, C = B diag(1/k)
//! B^T, and those columns of B whose compliance exceeds the fraction [`RIGID`] of the largest are the degrees of
//! freedom ([`PartsDynamics`]):
//!
//! ```text
//! M q'' + D q' + diag(k) q = Phi^T F,    M = B^T diag(masses, inertias) B,    motion of the centres = B q
//! ```

use std::sync::Arc;

use fea::{Girder, Member, Model, RigidLink, Support};
use nalgebra::{DMatrix, DVector};
use sim::{BlendedParts, Carrier, Dynamics, Extent, Foundation, PartChain, PartShapes, Structure};
use splines::{ExactSurface, Flexibility, RailElement, Rails};

use crate::built::{BuiltFoundation, MotionBasis, RigidParts};
use crate::error::Error;
use crate::mount::Excitation;
use formats::scene::{CarriedBy, Handover};

/// Compliance of an eigenvector of C, relative to the largest, below which the eigenvector is treated as rigid.
const RIGID: f64 = 1e-13;

/// The foundation of `count` rigid parts of equal length. Where the girder has mass, each part has an equal fraction
/// of it, and every natural mode of the chain has the fraction `damping` of critical damping. Where wheels exert no
/// lateral forces, parts with mass move in the vertical plane only.
///
/// # Errors
/// [`Error::Windows`] where the windows of neighbouring joints overlap; [`Error::Chain`] where the chain is a
/// mechanism; [`Error::ChainRail`] where its rail cannot be made.
pub fn foundation(
    girder: &Girder,
    count: usize,
    handover: Handover,
    damping: f64,
    excitation: Excitation,
) -> Result<BuiltFoundation, Error> {
    let ends = part_ends(girder, count);
    let chain = PartChain::new(ends.clone(), 0, window(handover)).ok_or(Error::Windows)?;
    let centres: Vec<f64> = ends
        .windows(2)
        .map(|pair| 0.5 * (pair[0] + pair[1]))
        .collect();
    let nodal = nodal_compliance(girder, &ends, &centres)?;
    let line = Arc::new(line(girder, &ends, &centres)?);
    let range = chain.range();
    let mut breaks = chain.breaks();
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    let mut foundation = Foundation {
        rails: vec![Extent {
            range: Some(range),
            breaks,
        }],
        ..Foundation::default()
    };
    let mut motion = None;
    let separate = matches!(handover, Handover::PerPart { .. });
    if separate {
        foundation.parts = Some(vec![chain.clone()]);
    }
    if let Some(mass) = girder.mass_per_length.filter(|mass| *mass > 0.0) {
        let dynamics = PartsDynamics::new(girder, mass, &ends, &nodal, excitation.lateral);
        foundation.carrier = excitation
            .carrier
            .map(|carrier| dynamics.carrier(&centres, carrier));
        let basis = dynamics.basis.clone();
        motion = Some(MotionBasis::Parts(RigidParts {
            ends: ends.clone(),
            basis: basis.clone(),
        }));
        let shapes = PartShapes {
            line,
            basis,
            chains: vec![chain],
            separate,
        };
        foundation.structure = Some(dynamics.structure(shapes, damping));
    } else {
        let surface = ExactSurface::new(line, nodal)?;
        foundation.compliance = Some(if separate {
            Box::new(surface)
        } else {
            Box::new(BlendedParts {
                surface,
                chains: vec![chain],
            })
        });
    }
    Ok(BuiltFoundation {
        foundation,
        basis: motion,
    })
}

/// The `count + 1` ends of parts of equal length along the girder with its overhangs.
fn part_ends(girder: &Girder, count: usize) -> Vec<f64> {
    let (from, to) = (
        -girder.overhangs[0],
        girder.spans.iter().sum::<f64>() + girder.overhangs[1],
    );
    (0..=count)
        .map(|j| from + (to - from) * j as f64 / count as f64)
        .collect()
}

/// Compliance of the centres of the parts, six degrees of freedom each: 6 n x 6 n, zero in unrestrained directions.
fn nodal_compliance(girder: &Girder, ends: &[f64], centres: &[f64]) -> Result<DMatrix<f64>, Error> {
    let (whole, _) = girder.model_and_rail()?;
    let mut model = Model {
        up: whole.up,
        theory: whole.theory,
        sections: whole.sections.clone(),
        ..Model::default()
    };
    model.points = centres.iter().map(|&x| [x, 0.0, 0.0]).collect();
    for j in 1..centres.len() {
        model.members.push(Member::beam([j - 1, j], 0, model.up));
    }
    for support in &whole.supports {
        let [x, ..] = whole.points[support.point];
        let part = ends[1..ends.len() - 1].partition_point(|&end| end < x);
        model.points.push([x, 0.0, 0.0]);
        let point = model.points.len() - 1;
        model.links.push(RigidLink {
            from: part,
            to: point,
        });
        model.supports.push(Support {
            point,
            fixed: support.fixed,
        });
    }
    let points: Vec<usize> = (0..centres.len()).collect();
    let (mut nodal, _) = fea::point_compliance(&model, &points)?;
    // the compliance of an unrestrained direction is infinite: parts are assumed not to move in it
    for i in 0..nodal.nrows() {
        if !nodal[(i, i)].is_finite() {
            nodal[(i, i)] = 0.0;
        }
    }
    Ok(nodal)
}

/// Rail elements of the chain: every part is a rigid extension over the whole length on a rail of its own. The chain
/// then selects or blends the rails of the parts below a wheel.
fn line(girder: &Girder, ends: &[f64], centres: &[f64]) -> Result<Rails, Error> {
    let [from, to] = [ends[0], ends[ends.len() - 1]];
    let elements = centres.iter().enumerate().map(|(j, centre)| RailElement {
        rail: j,
        x: [from, to],
        ends: [j, j],
        length: to - from,
        frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        offset: [from - centre, girder.rail_height, 0.0],
        flexibility: Flexibility::default(),
        member: None,
    });
    Ok(Rails::new(elements.collect())?)
}

/// Moment of inertia of a part of `length` about the axis of the girder, divided by its mass: the squared radius of
/// gyration (I_vertical + I_lateral)/A, at least 1e-6 length^2, so that every degree of freedom has inertia.
#[must_use]
pub fn roll_inertia(girder: &Girder, length: f64) -> f64 {
    let polar = girder.area.map_or(0.0, |area| {
        (girder.i_vertical + girder.i_lateral.unwrap_or(0.0)) / area
    });
    polar.max(1e-6 * length * length)
}

/// Equations of motion of parts with mass in the eigenvectors of their compliance. Motions that the supports prevent
/// have no compliance and are not degrees of freedom. K = diag(1/compliance), M = basis^T diag(lumped) basis.
struct PartsDynamics {
    /// Motion of the centres per unit of each degree of freedom: 6 n rows, one column per degree of freedom.
    basis: DMatrix<f64>,
    /// Mass or moment of inertia that belongs to each of the 6 n motions.
    lumped: DVector<f64>,
    mass: DMatrix<f64>,
    /// Diagonal of K.
    stiffness: DVector<f64>,
}

impl PartsDynamics {
    /// The equations of parts with `mass` per length between `ends`, whose centres have the compliance `nodal`. With
    /// `lateral`, the parts also move laterally, roll and yaw; otherwise they move in the vertical plane.
    fn new(
        girder: &Girder,
        mass: f64,
        ends: &[f64],
        nodal: &DMatrix<f64>,
        lateral: bool,
    ) -> PartsDynamics {
        // rotations are scaled by a part's length, so that displacements and rotations are comparable in one
        // eigenproblem
        let length = ends[1] - ends[0];
        let wanted: &[usize] = if lateral { &[1, 5, 2, 3, 4] } else { &[1, 5] };
        let used: Vec<usize> = (0..nodal.nrows())
            .filter(|i| wanted.contains(&(i % 6)))
            .collect();
        let scale = |i: usize| if i % 6 < 3 { 1.0 } else { length };
        let scaled = DMatrix::from_fn(used.len(), used.len(), |r, c| {
            scale(used[r]) * nodal[(used[r], used[c])] * scale(used[c])
        });
        let eigen = scaled.symmetric_eigen();
        let largest = eigen.eigenvalues.max();
        let kept: Vec<usize> = (0..used.len())
            .filter(|&k| eigen.eigenvalues[k] > RIGID * largest)
            .collect();
        let mut basis = DMatrix::zeros(nodal.nrows(), kept.len());
        for (r, &i) in used.iter().enumerate() {
            for (k, &mode) in kept.iter().enumerate() {
                basis[(i, k)] = eigen.eigenvectors[(r, mode)] / scale(i);
            }
        }
        let part = mass * length;
        let roll = roll_inertia(girder, length);
        let lumped = |i: usize| match i % 6 {
            0..=2 => part,
            3 => part * roll,
            _ => part * length * length / 12.0,
        };
        let lumped = DVector::from_fn(nodal.nrows(), |i, _| lumped(i));
        let weighted =
            DMatrix::from_fn(nodal.nrows(), kept.len(), |i, k| lumped[i] * basis[(i, k)]);
        let stiffness = DVector::from_fn(kept.len(), |k, _| 1.0 / eigen.eigenvalues[kept[k]]);
        PartsDynamics {
            mass: basis.transpose() * weighted,
            stiffness,
            basis,
            lumped,
        }
    }

    /// Inertia of the parts in the equations of the body that carries them: mass R^T m R, and coupling basis^T m R
    /// with the degrees of freedom. m: the lumped masses; R: motion of the parts per unit of each motion of the body,
    /// 6 n x 6.
    fn carrier(&self, centres: &[f64], on: CarriedBy) -> Carrier {
        let motion = DMatrix::from_fn(6 * centres.len(), 6, |i, k| {
            let (x, axis) = (centres[i / 6], i % 6);
            match (axis, k) {
                // yaw and pitch displace a part at x
                (1, 5) => x,
                (2, 4) => -x,
                _ => f64::from(u8::from(axis == k)),
            }
        });
        let weighted = DMatrix::from_fn(motion.nrows(), 6, |i, k| self.lumped[i] * motion[(i, k)]);
        let (total, own) = (
            motion.transpose() * &weighted,
            self.basis.transpose() * &weighted,
        );
        let total = std::array::from_fn(|i| std::array::from_fn(|j| total[(i, j)]));
        let coupling =
            |k: usize| Carrier::load_about_origin(&std::array::from_fn(|i| own[(k, i)]), on.at);
        Carrier {
            body: on.body,
            rails: Vec::new(),
            mass: Carrier::mass_about_origin(&total, on.at),
            coupling: (0..own.nrows()).map(coupling).collect(),
        }
    }

    /// Damping matrix D for which every natural mode has the fraction `zeta` of critical damping:
    /// D = 2 zeta K^1/2 (K^-1/2 M K^-1/2)^1/2 K^1/2. For the modes phi of M and K with phi^T M phi = 1,
    /// phi^T D phi = 2 zeta omega.
    fn damping(&self, zeta: f64) -> DMatrix<f64> {
        let size = self.mass.nrows();
        // parts that all stand on supports do not move
        if zeta == 0.0 || size == 0 {
            return DMatrix::zeros(size, size);
        }
        let root = self.stiffness.map(f64::sqrt);
        let scaled = DMatrix::from_fn(size, size, |r, c| self.mass[(r, c)] / (root[r] * root[c]));
        let eigen = scaled.symmetric_eigen();
        // eigenvalues are 1/omega^2
        let inverse = eigen.eigenvalues.map(|square| square.max(0.0).sqrt());
        let middle =
            &eigen.eigenvectors * DMatrix::from_diagonal(&inverse) * eigen.eigenvectors.transpose();
        DMatrix::from_fn(size, size, |r, c| {
            zeta * root[r] * (middle[(r, c)] + middle[(c, r)]) * root[c]
        })
    }

    /// The structure of the simulation; every natural mode has the fraction `damping` of critical damping.
    fn structure(&self, shapes: PartShapes, damping: f64) -> Structure {
        Structure {
            dynamics: Dynamics::Matrices {
                mass: self.mass.clone(),
                damping: self.damping(damping),
                stiffness: DMatrix::from_diagonal(&self.stiffness),
            },
            shapes: Box::new(shapes),
        }
    }
}

/// Length of the window in which a wheel passes from one part to the next.
fn window(handover: Handover) -> Option<f64> {
    match handover {
        Handover::Blend { length } | Handover::PerPart { length } => length,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A mass of zero, which the format allows, is none: the parts follow the forces without degrees of freedom.
    #[test]
    fn parts_of_zero_mass_are_parts_without_mass() {
        for mass_per_length in [None, Some(0.0)] {
            let girder = Girder {
                spans: vec![18.0],
                e: 2.1e8,
                i_vertical: 1e-3,
                mass_per_length,
                ..Girder::default()
            };
            let excitation = Excitation::VERTICAL;
            let built = foundation(
                &girder,
                20,
                Handover::PerPart { length: None },
                0.0,
                excitation,
            );
            let built = built.expect("it stands").foundation;
            assert!(built.structure.is_none() && built.compliance.is_some());
        }
    }

    /// Analytic: natural modes phi of M and K, scaled to phi^T M phi = 1, have phi^T C phi = 2 zeta omega.
    #[test]
    fn every_natural_mode_of_the_parts_has_the_damping_asked_for() {
        let girder = Girder {
            spans: vec![30.0, 50.0],
            e: 4.32e9,
            i_vertical: 10.0,
            mass_per_length: Some(20.0),
            ..Girder::default()
        };
        let ends = part_ends(&girder, 7);
        let centres: Vec<f64> = ends
            .windows(2)
            .map(|pair| 0.5 * (pair[0] + pair[1]))
            .collect();
        let nodal = nodal_compliance(&girder, &ends, &centres).expect("it stands");
        let motion = PartsDynamics::new(&girder, 20.0, &ends, &nodal, false);
        let zeta = 0.03;
        let damping = motion.damping(zeta);

        let lower = motion
            .mass
            .clone()
            .cholesky()
            .expect("masses are positive")
            .l();
        let inverse = lower.try_inverse().expect("masses are positive");
        let whitened = &inverse * DMatrix::from_diagonal(&motion.stiffness) * inverse.transpose();
        let eigen = whitened.symmetric_eigen();
        let modes = inverse.transpose() * &eigen.eigenvectors;
        let modal = modes.transpose() * damping * &modes;
        let highest = eigen.eigenvalues.max().sqrt();
        for r in 0..modal.nrows() {
            for c in 0..modal.ncols() {
                let wanted = if r == c {
                    2.0 * zeta * eigen.eigenvalues[r].sqrt()
                } else {
                    0.0
                };
                assert!(
                    (modal[(r, c)] - wanted).abs() < 1e-9 * zeta * highest,
                    "{r} {c}: {}",
                    modal[(r, c)]
                );
            }
        }
    }
}
