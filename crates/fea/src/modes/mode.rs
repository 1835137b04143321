//! Natural modes and what can be asked of them.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector, DVectorView, Vector3};
use splines::{Axis, ElementResidual, ExactSurface, MemberMotion, Probe, RailShapes, Rails};

use crate::assembly::{Combination, bending_planes, column_norm, symmetric_product};
use crate::error::Error;
use crate::influence::FactoredFrame;
use crate::modes::decoupled::Part;
use crate::modes::inertia_motions::{MOTIONS, uniform_load_motion};
use crate::modes::mass::{ScaledMass, rows};

/// Number of motions of a member between its ends in one plane.
pub(super) const BETWEEN: usize = 1 + MOTIONS;

/// A natural mode with modal mass 1: phi^T M phi = 1, K phi = omega^2 M phi.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Circular frequency, radian/time.
    pub omega: f64,
    /// For each state of the rails its three displacements and three rotations, in the axes of its rail.
    /// Along a rail element the shape is that of the member without load, with the motions `between`
    /// ([`Modes::at`]).
    pub states: Vec<[f64; 6]>,
    /// For each point its three displacements and three rotations, global.
    pub points: Vec<[f64; 6]>,
    /// For each member and each of its local x-y and x-z planes, the amplitudes of its motions between the ends: the
    /// intensity of a uniform load, force/length; then the inertia of the motion, by five amplitudes times the square of a
    /// frequency ([`crate::RefinedModes::iterate`]), or zeros. Empty if no member with mass is flexible in shear.
    pub between: Vec<[[f64; BETWEEN]; 2]>,
    /// phi^T M r for six rigid motions r of the whole structure with its supports: three translations along
    /// the global axes, three rotations about the global origin. Its squares are the effective modal masses.
    pub coupling: [f64; 6],
    /// |K phi - omega^2 M phi| / ((|K| + omega^2 |M|) |phi|), of the scaled matrices in the 1-norm.
    pub residual: f64,
}

/// Natural modes of a frame.
///
/// # Example
/// ```
/// use fea::{Girder, modes};
/// use splines::{Axis, Probe};
///
/// let girder = Girder {
///     spans: vec![15.0; 4],
///     e: 4.32e9,
///     i_vertical: 9.528,
///     mass_per_length: Some(26.4),
///     ..Girder::default()
/// };
/// let (mut model, rail) = girder.model_and_rail()?;
/// // Four members, one span of 60 ft.
/// model.supports.retain(|support| support.point % 4 == 0);
/// let found = modes(&model, &[rail], 1)?;
/// let exact = (std::f64::consts::PI / 60.0).powi(2) * (4.32e9 * 9.528 / 26.4_f64).sqrt();
/// assert!((found.modes[0].omega / exact - 1.0).abs() < 1e-3);
/// let [shape, slope] = found.at(Probe { rail: 0, x: 30.0, axis: Axis::Vertical })?[0];
/// assert!(shape.abs() > 0.0 && slope.abs() < 1e-9);
/// # Ok::<(), fea::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Modes {
    /// The modes, lowest first.
    pub modes: Vec<Mode>,
    /// Circular frequency sigma of the shift sigma^2 below which the modes were counted, radian/time.
    pub shift: f64,
    /// Number of eigenvalues below the shift, by the signs of the pivots of K - sigma^2 M; all of them were
    /// found. If it is less than the number of modes, the others lie within 1e-6 of each other.
    pub count_below_shift: usize,
    /// Circular frequency of the mode after these, radian/time; `None` if there is no other or it is unknown.
    pub next: Option<f64>,
    /// r^T M r of the whole structure with its supports, r as in [`Mode::coupling`]: masses, then moments and
    /// moments of inertia about the global origin.
    pub rigid_mass: [[f64; 6]; 6],
    line: Option<Arc<Rails>>,
    /// For each member the motions of which [`Mode::between`] has the amplitudes, by plane; of a plane without such motions
    /// none, and without inertia only the first.
    pub(super) motions: Arc<Vec<[Vec<MemberMotion>; 2]>>,
}

/// What shows that the modes are the lowest: a shift, the number of modes below it, and the next frequency.
pub(super) struct Count {
    pub shift: f64,
    pub below: usize,
    pub next: Option<f64>,
}

impl FactoredFrame {
    /// 1-norms of the scaled stiffness and mass.
    ///
    /// # Errors
    /// [`Error::NoMass`].
    pub(super) fn norms(&self, mass: &ScaledMass) -> Result<[f64; 2], Error> {
        let norms = [self.stiffness().norm(), column_norm(&mass.upper)];
        if norms[1] == 0.0 {
            Err(Error::NoMass)
        } else {
            Ok(norms)
        }
    }

    /// The modes of a frame with mass `mass`.
    pub(super) fn collect_modes(&self, modes: Vec<Mode>, count: Count, mass: &ScaledMass) -> Modes {
        let Count { shift, below, next } = count;
        Modes {
            modes,
            shift,
            count_below_shift: below,
            next,
            rigid_mass: rows(&mass.total),
            line: self.line().ok().cloned(),
            motions: Arc::new(self.uniform_loads(mass)),
        }
    }

    /// For each member and plane its deflection under a uniform load, if it is an interior motion.
    fn uniform_loads(&self, mass: &ScaledMass) -> Vec<[Vec<MemberMotion>; 2]> {
        let count = if mass.interior.is_empty() {
            0
        } else {
            self.elements.len()
        };
        let mut out = vec![<[Vec<MemberMotion>; 2]>::default(); count];
        for motion in &mass.interior {
            let element = &self.elements[motion.member];
            let plane = &bending_planes(&element.flexibility)[motion.plane];
            out[motion.member][motion.plane].push(uniform_load_motion(
                motion.plane,
                plane,
                element.length,
            ));
        }
        out
    }

    /// A mode from its eigenvalue and its scaled unknowns, those of `part`, with modal mass 1.
    pub(super) fn mode(
        &self,
        part: &Part,
        mass: &ScaledMass,
        norms: [f64; 2],
        lambda: f64,
        phi: &DVector<f64>,
    ) -> Mode {
        let force = symmetric_product(&part.stiffness, phi.as_view());
        let momentum = symmetric_product(&part.mass, phi.as_view());
        let size = (norms[0] + lambda * norms[1]) * phi.norm();
        let residual = (force - momentum * lambda).norm() / size;
        let phi = part.expand(phi.as_slice());
        let coupling = mass
            .rigid
            .each_ref()
            .map(|rigid| DVectorView::from_slice(rigid, rigid.len()).dot(&phi));
        let (amplitudes, unknowns) = phi.as_slice().split_at(mass.interior.len());
        let motions = self.body_motions(unknowns);
        let mut between = vec![
            [[0.0; BETWEEN]; 2];
            if amplitudes.is_empty() {
                0
            } else {
                self.elements.len()
            }
        ];
        for (motion, amplitude) in mass.interior.iter().zip(amplitudes) {
            between[motion.member][motion.plane][0] = amplitude * motion.unit_load();
        }
        let value = |row: &Combination| row.evaluate(&motions);
        let states = self
            .states()
            .iter()
            .map(|state| state.each_ref().map(value))
            .collect();
        let points = (0..self.bodies.of_point.len()).map(|point| {
            let motion = self.bodies.motion(point, &Vector3::zeros());
            (motion * motions[self.bodies.of_point[point]]).into()
        });
        Mode {
            omega: lambda.sqrt(),
            states,
            points: points.collect(),
            between,
            coupling,
            residual,
        }
    }
}

impl Modes {
    fn line(&self) -> Result<&Arc<Rails>, Error> {
        self.line.as_ref().ok_or(Error::NoRails)
    }

    /// Displacement of every mode at a probe, along its axis, and its derivative with respect to the rail
    /// coordinate.
    ///
    /// # Errors
    /// [`Error::NoRails`]; [`Error::Rail`] for a probe beyond its rail, or in a direction that nothing resists.
    pub fn at(&self, probe: Probe) -> Result<Vec<[f64; 2]>, Error> {
        let row = self.line()?.row(probe)?;
        let member = self.line()?.elements()[row.element]
            .member
            .map(|member| member.id);
        let mut between = Vec::new();
        for (plane, motions) in member
            .and_then(|id| self.motions.get(id))
            .into_iter()
            .flatten()
            .enumerate()
        {
            for (k, motion) in motions.iter().enumerate() {
                between.push(([plane, k], self.line()?.member_motion(probe, motion)?));
            }
        }
        let sum = |mode: &Mode, weights: &[f64], k: usize| -> f64 {
            let terms = row.indices().iter().zip(weights);
            let ends: f64 = terms
                .map(|(&index, weight)| weight * mode.states[index / 6][index % 6])
                .sum();
            let amplitudes = member.and_then(|member| mode.between.get(member));
            let own = |of: &[[f64; BETWEEN]; 2]| -> f64 {
                between
                    .iter()
                    .map(|([plane, motion], value)| of[*plane][*motion] * value[k])
                    .sum()
            };
            ends + amplitudes.map_or(0.0, own)
        };
        Ok(self
            .modes
            .iter()
            .map(|mode| [sum(mode, row.values(), 0), sum(mode, row.slopes(), 1)])
            .collect())
    }

    /// The modes along the rails, each divided by its `divisor`.
    ///
    /// # Errors
    /// [`Error::NoRails`].
    pub fn rail_shapes(&self, divisor: impl Fn(&Mode) -> f64) -> Result<RailShapes, Error> {
        let line = self.line()?;
        let modes = &self.modes;
        let factors: Vec<f64> = modes.iter().map(|mode| 1.0 / divisor(mode)).collect();
        let states = DMatrix::from_fn(6 * line.state_count(), modes.len(), |k, r| {
            modes[r].states[k / 6][k % 6] * factors[r]
        });
        let ends = RailShapes::new(Arc::clone(line), states)?;
        if modes.iter().all(|mode| mode.between.is_empty()) {
            return Ok(ends);
        }
        let (mut motions, mut places) = (Vec::new(), Vec::new());
        for element in line.elements() {
            let member = element
                .member
                .map(|member| member.id)
                .filter(|id| *id < self.motions.len());
            let planes = member.map_or(&[][..], |id| &self.motions[id]);
            motions.push(planes.iter().flatten().copied().collect());
            for (plane, own) in planes.iter().enumerate() {
                places.extend((0..own.len()).map(|k| (member, plane, k)));
            }
        }
        let amplitudes = DMatrix::from_fn(places.len(), modes.len(), |row, r| {
            let (member, plane, k) = places[row];
            member.map_or(0.0, |member| {
                modes[r].between[member][plane][k] * factors[r]
            })
        });
        Ok(ends.with_member_motions(motions, &amplitudes)?)
    }

    /// Rotation of every mode about the rail at x, linear along a rail element: exact if the element runs
    /// along the rail.
    ///
    /// # Errors
    /// [`Error::NoRails`]; [`Error::Rail`] for a place beyond the rail.
    pub fn twist(&self, rail: usize, x: f64) -> Result<Vec<f64>, Error> {
        let line = self.line()?;
        let row = |axis| line.row(Probe { rail, x, axis });
        // The directions may differ in what resists them; any of them names the rail element.
        let row = row(Axis::Vertical)
            .or_else(|_| row(Axis::Lateral))
            .or_else(|_| row(Axis::Longitudinal))?;
        let cell = &line.elements()[row.element];
        let r = ((x - cell.x[0]) / (cell.x[1] - cell.x[0])).clamp(0.0, 1.0);
        let [a, b] = cell.ends;
        Ok(self
            .modes
            .iter()
            .map(|mode| (1.0 - r) * mode.states[a][3] + r * mode.states[b][3])
            .collect())
    }

    /// Residual flexibility: an influence surface of the same frame without the part of these modes,
    ///
    /// G_res = G - sum phi_r phi_r^T / omega_r^2
    ///
    /// Products of deflections by uniform loads ([`Mode::between`]) with other motions are left out: their sum over all
    /// modes is zero. The part of inertia is not counted.
    ///
    /// Guarantee: positive semi-definite up to the rounding of G, for all modes as computed from the mesh, or for any number
    /// of modes of members that are rigid in shear.
    ///
    /// # Errors
    /// [`Error::NoRails`]; [`Error::Rail`] for a surface of another frame, by its number of states.
    pub fn residual(&self, surface: &ExactSurface) -> Result<ElementResidual, Error> {
        let line = self.line()?;
        let mut nodal = surface.nodal().clone();
        let expected = 6 * line.state_count();
        if nodal.nrows() != expected {
            let (rows, columns) = nodal.shape();
            return Err(splines::Error::NodalShape {
                rows,
                columns,
                expected,
            }
            .into());
        }
        for mode in &self.modes {
            let phi = DVector::from_fn(expected, |k, _| mode.states[k / 6][k % 6] / mode.omega);
            for j in (0..expected).filter(|&j| phi[j] != 0.0) {
                for i in 0..expected {
                    nodal[(i, j)] -= phi[i] * phi[j];
                }
            }
        }
        let squares = |member: usize| {
            let sum = |plane: usize| -> f64 {
                let all = self
                    .modes
                    .iter()
                    .filter_map(|mode| Some(mode.between.get(member)?[plane][0] / mode.omega));
                all.map(|load| load * load).sum()
            };
            [sum(0), sum(1)]
        };
        let elements = line.elements().iter();
        let loads =
            elements.map(|element| element.member.map_or([0.0; 2], |member| squares(member.id)));
        let rest = ExactSurface::new(Arc::clone(surface.rails()), nodal)?;
        Ok(ElementResidual::new(rest, loads.collect()))
    }
}
