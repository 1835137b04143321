//! The equations of motion without the wheel-rail forces: numbering of the degrees of freedom, kinematics and
//! inertia.
//!
//! M q'' + C q' + K q = f(t) - R^T F. The degrees of freedom are numbered in this order: those of the bodies, body by
//! body, the spins of the wheels, and those of each structure. M, C and K are block diagonal except for the inertial
//! coupling between a body and the structure that it carries. The module `contact` adds the forces F and their rows
//! R.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::carried::CarriedBodies;
use super::coupling::InertialCoupling;
use super::inertia::Block;
use super::kinematics::{Kinematics, Terms};
use super::state::State;
use super::wheels::{RailCoordinate, WheelGroup, WheelPoint, Wheels};
use crate::scene::breaks::RailBreaks;
use crate::scene::check::check_carriers;
use crate::scene::dof::arm_rows;
use crate::{BodyDof, Dynamics, Error, Foundation, Irregularity, Load, Scene, Travel};

/// Cholesky pivot of the mass matrix, as a fraction of the diagonal entry, below which a degree of freedom is treated
/// as massless.
const MASSLESS: f64 = 1e-13;

/// A scene with numbered degrees of freedom and assembled inertia.
pub(crate) struct Mechanics<'a> {
    pub scene: &'a Scene,
    pub foundations: &'a [Foundation],
    /// Coordinates of the rails at which steps end.
    pub breaks: RailBreaks,
    /// Displacements of the bodies as a linear map of the degrees of freedom.
    pub kinematics: Kinematics<'a>,
    /// All physical wheels.
    pub wheels: Vec<WheelPoint<'a>>,
    /// Rail coordinate of each wheel.
    pub coordinates: Vec<RailCoordinate>,
    /// Groups of wheels that share one vertical force.
    pub groups: Vec<WheelGroup>,
    /// Range of wheel groups of each contact.
    of_contact: Vec<Range<usize>>,
    /// Bodies that are carried by other bodies.
    pub carried: CarriedBodies,
    /// Range of the degrees of freedom of each structure.
    pub structures: Vec<Range<usize>>,
    /// Frequency of each degree of freedom that is a natural mode, 0 of other ones of structures, and `None` of bodies
    /// and spins.
    pub omegas: Vec<Option<f64>>,
    /// Damping ratio of each degree of freedom that is a natural mode, 0 of the others.
    pub damping_ratios: Vec<f64>,
    /// Number of all degrees of freedom.
    pub dofs: usize,
    /// Whether the rail coordinate of any wheel depends on the degrees of freedom.
    pub moves_freely: bool,
    /// M, C and K: first the block of bodies and spins, then one block per structure. Bodies that are carried by
    /// other bodies are not included.
    pub blocks: Vec<Block>,
    /// Inertial couplings between the carriers and the structures on them.
    pub couplings: Vec<InertialCoupling>,
    /// Weights, without those of bodies that are carried by other bodies.
    pub gravity: DVector<f64>,
}

impl<'a> Mechanics<'a> {
    /// Numbers the degrees of freedom of a scene and assembles its inertia.
    ///
    /// # Errors
    /// A scene that fails its checks, an unsupported arrangement of carried bodies, or a degree of freedom without
    /// inertia.
    pub fn new(scene: &'a Scene, foundations: &'a [Foundation]) -> Result<Self, Error> {
        scene.check(foundations.len())?;
        check_carriers(scene, foundations)?;
        let mut dofs = 0;
        let mut next = || {
            dofs += 1;
            dofs - 1
        };
        let numbers: Vec<[Option<usize>; 6]> = scene
            .bodies
            .iter()
            .map(|body| {
                let mut numbers = [None; 6];
                for (i, number) in numbers.iter_mut().enumerate() {
                    if body.free[i] && !(i == 0 && body.motion.is_some()) {
                        *number = Some(next());
                    }
                }
                numbers
            })
            .collect();
        let Wheels {
            points: wheels,
            groups,
            of_contact,
        } = Wheels::new(scene, foundations, &mut next)?;
        let structures: Vec<Range<usize>> = foundations
            .iter()
            .map(|foundation| {
                let first = dofs;
                dofs += foundation.dofs();
                first..dofs
            })
            .collect();
        let mut kinematics = Kinematics::new(scene, numbers)?;
        let carried = CarriedBodies::new(foundations, &kinematics)?;
        kinematics.add_masses(foundations, &structures, |b| carried.has(b));
        let coordinates = wheels
            .iter()
            .map(|wheel| RailCoordinate::new(&kinematics, wheel))
            .collect();
        let mut mechanics = Mechanics {
            coordinates,
            scene,
            foundations,
            breaks: RailBreaks::new(foundations),
            kinematics,
            wheels,
            groups,
            of_contact,
            carried,
            omegas: frequencies(foundations, &structures, dofs),
            damping_ratios: damping_ratios(foundations, &structures, dofs),
            structures,
            dofs,
            moves_freely: false,
            blocks: Vec::new(),
            couplings: Vec::new(),
            gravity: DVector::zeros(dofs),
        };
        mechanics.assemble()?;
        mechanics.moves_freely = mechanics
            .coordinates
            .iter()
            .any(|coordinate| !coordinate.terms.is_empty());
        Ok(mechanics)
    }

    /// Number of degrees of freedom of bodies and spins, which are numbered first.
    pub fn body_dofs(&self) -> usize {
        self.structures
            .first()
            .map_or(self.dofs, |range| range.start)
    }

    /// Whether any structure has degrees of freedom of its own.
    pub fn has_structures(&self) -> bool {
        self.structures.iter().any(|range| !range.is_empty())
    }

    /// Whether any structure is loaded along its rails.
    pub fn has_sliding_rails(&self) -> bool {
        self.foundations
            .iter()
            .any(|foundation| foundation.is_loaded_along)
    }

    /// The wheel groups that `wheel` belongs to: a single one, or one for each rigid part of the rail.
    pub fn groups_of(&self, wheel: usize) -> Range<usize> {
        self.of_contact[self.wheels[wheel].contact].clone()
    }

    /// Whether wheel `w` belongs to the contact of the wheel before it: the wheels of one contact are of one kind and
    /// move together.
    #[inline]
    pub fn follows_in_contact(&self, w: usize) -> bool {
        w > 0 && self.wheels[w].contact == self.wheels[w - 1].contact
    }

    /// Index of the degree of freedom on which `load` acts.
    pub fn loaded(&self, load: &Load) -> Option<usize> {
        self.kinematics.numbers[load.body][load.dof as usize]
    }

    /// Irregularity of the rail under wheel `w`; `None` where the rail is straight.
    pub fn irregularity(&self, w: usize) -> Option<&'a Irregularity> {
        let contact = &self.scene.contacts[self.wheels[w].contact];
        let shapes = &self.foundations[contact.structure].irregularities;
        shapes
            .get(contact.rail)
            .filter(|shape| !shape.is_straight())
    }

    /// Displacements and velocities of body `b` in all six degrees of freedom at time `t`.
    pub fn body(
        &self,
        b: usize,
        t: f64,
        q: &DVector<f64>,
        v: &DVector<f64>,
    ) -> ([f64; 6], [f64; 6]) {
        self.kinematics.motion(b, t, q, v)
    }

    /// Rail coordinate of wheel `w` at time `t` and the degrees of freedom `q`.
    pub fn rail_coordinate(&self, w: usize, t: f64, q: &DVector<f64>) -> f64 {
        let coordinate = &self.coordinates[w];
        let travel = |root: usize| {
            self.scene.bodies[root]
                .motion
                .as_ref()
                .map_or(0.0, |motion| motion.at(t).x)
        };
        let moved: f64 = coordinate
            .terms
            .iter()
            .map(|&(number, share)| share * q[number])
            .sum();
        coordinate.constant + coordinate.driven.map_or(0.0, travel) + moved
    }

    /// Velocity of the hub of wheel `w` along its rail.
    pub fn speed_along(&self, w: usize, at: &State) -> f64 {
        let coordinate = &self.coordinates[w];
        let travel = |root: usize| {
            self.scene.bodies[root]
                .motion
                .as_ref()
                .map_or(0.0, |motion| motion.at(at.t).v)
        };
        let moved: f64 = coordinate
            .terms
            .iter()
            .map(|&(number, share)| share * at.v[number])
            .sum();
        coordinate.driven.map_or(0.0, travel) + moved
    }

    /// Roll of the body of wheel `w` at the degrees of freedom `q`.
    pub fn roll(&self, w: usize, q: &DVector<f64>) -> f64 {
        const ROLL: usize = BodyDof::Roll as usize;
        let body = self.wheels[w].body;
        let terms = self.kinematics.terms(body)[ROLL].iter();
        self.kinematics.constant(body)[ROLL]
            + terms.map(|&(number, share)| share * q[number]).sum::<f64>()
    }

    /// Angle, angular velocity and angular acceleration of wheel `w` at `t`; `None` where its spin is not prescribed.
    pub fn turn(&self, w: usize, t: f64) -> Option<Travel> {
        self.wheels[w].turn.map(|motion| motion.at(t))
    }

    /// Moment of inertia of wheel `w` about its axle.
    pub fn spin_inertia(&self, w: usize) -> f64 {
        self.scene.wheels[self.wheels[w].kind]
            .spin_inertia
            .unwrap_or_default()
    }

    /// Rotational kinetic energy of the wheels whose spin is prescribed. The kinetic energy of their bodies is not
    /// included.
    pub fn energy_of_turns(&self, t: f64) -> f64 {
        let all = (0..self.wheels.len()).filter_map(|w| Some((w, self.turn(w, t)?)));
        all.map(|(w, at)| 0.5 * self.spin_inertia(w) * at.v * at.v)
            .sum()
    }

    fn assemble(&mut self) -> Result<(), Error> {
        let bodies = self.body_dofs();
        let mut mass = DMatrix::zeros(bodies, bodies);
        for (b, body) in self
            .scene
            .bodies
            .iter()
            .enumerate()
            .filter(|(b, _)| !self.carried.has(*b))
        {
            self.kinematics.add_mass(b, &body.mass_matrix(), &mut mass);
            let line = arm_rows(body.cg)[1].map(|arm| body.mass * arm);
            add_weight(
                &mut self.gravity,
                self.scene,
                self.kinematics.terms(b),
                &line,
            );
        }
        for mount in self
            .foundations
            .iter()
            .filter_map(|foundation| foundation.carrier.as_ref())
        {
            self.kinematics.add_mass(mount.body, &mount.mass, &mut mass);
            let terms = self.kinematics.terms(mount.body);
            add_weight(&mut self.gravity, self.scene, terms, &mount.mass[1]);
        }
        let mut whole = mass.clone();
        if !self.carried.is_empty() {
            let rest = DVector::zeros(self.dofs);
            let sums = (&mut whole, &mut rest.clone());
            self.carried
                .add(&self.kinematics, (0.0, &rest, &rest), sums, &mut Vec::new());
        }
        let own = self.kinematics.numbers.iter().flatten().flatten().count();
        if let Some(massless) = first_massless(&whole, own) {
            for (body, numbers) in self.kinematics.numbers.iter().enumerate() {
                if let Some(k) = numbers.iter().position(|number| *number == Some(massless)) {
                    return Err(Error::NoInertia {
                        body,
                        dof: BodyDof::ALL[k],
                    });
                }
            }
        }
        for wheel in &self.wheels {
            if let (Some(number), Some(inertia)) =
                (wheel.spin, self.scene.wheels[wheel.kind].spin_inertia)
            {
                mass[(number, number)] = inertia;
            }
        }
        self.blocks.push(Block::bodies(mass));
        for (range, foundation) in self.structures.iter().zip(self.foundations) {
            if let Some(structure) = &foundation.structure {
                self.blocks.push(Block::structure(range.clone(), structure));
                let coupling = foundation.carrier.as_ref().and_then(|mount| {
                    InertialCoupling::new(&self.kinematics, mount, range.clone(), bodies)
                });
                self.couplings.extend(coupling);
            }
        }
        Ok(())
    }
}

/// Frequencies of the natural modes among `dofs` degrees of freedom.
fn frequencies(
    foundations: &[Foundation],
    structures: &[Range<usize>],
    dofs: usize,
) -> Vec<Option<f64>> {
    let mut omegas = vec![None; dofs];
    for (range, foundation) in structures.iter().zip(foundations) {
        omegas[range.clone()].fill(Some(0.0));
        let dynamics = foundation
            .structure
            .as_ref()
            .map(|structure| &structure.dynamics);
        if let Some(Dynamics::Modes { omega, .. }) = dynamics {
            for (own, omega) in omegas[range.clone()].iter_mut().zip(omega) {
                *own = Some(*omega);
            }
        }
    }
    omegas
}

/// Damping ratios of the natural modes among `dofs` degrees of freedom.
fn damping_ratios(
    foundations: &[Foundation],
    structures: &[Range<usize>],
    dofs: usize,
) -> Vec<f64> {
    let mut ratios = vec![0.0; dofs];
    for (range, foundation) in structures.iter().zip(foundations) {
        if let Some(Dynamics::Modes { ratio, .. }) =
            foundation.structure.as_ref().map(|own| &own.dynamics)
        {
            ratios[range.clone()]
                .iter_mut()
                .zip(ratio)
                .for_each(|(own, ratio)| *own = *ratio);
        }
    }
    ratios
}

/// The first of `count` degrees of freedom that moves no mass independently of those before it. The function factors
/// the mass matrix into L L^T row by row and returns the first row whose pivot is not greater than `MASSLESS` times
/// the diagonal entry; `None` where the matrix is positive definite.
fn first_massless(mass: &DMatrix<f64>, count: usize) -> Option<usize> {
    let mut factor = DMatrix::<f64>::zeros(count, count);
    for i in 0..count {
        for j in 0..=i {
            let taken: f64 = (0..j).map(|k| factor[(i, k)] * factor[(j, k)]).sum();
            let left = mass[(i, j)] - taken;
            if j < i {
                factor[(i, j)] = left / factor[(j, j)];
            } else if left > MASSLESS * mass[(i, i)] && left.is_finite() {
                factor[(i, i)] = left.sqrt();
            } else {
                return Some(i);
            }
        }
    }
    None
}

/// Adds the weight of a mass that moves with a body. `line` is the y row of its 6 x 6 mass matrix and `terms` are the
/// displacements of the body.
fn add_weight(gravity: &mut DVector<f64>, scene: &Scene, terms: &[Terms; 6], line: &[f64; 6]) {
    for (mass, terms) in line.iter().zip(terms) {
        for &(number, coefficient) in terms {
            gravity[number] -= scene.gravity * mass * coefficient;
        }
    }
}
