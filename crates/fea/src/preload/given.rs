//! A preload as given, and the loads that it puts on the bodies.

use nalgebra::Vector3;
use splines::{Axis, Probe};

use crate::assembly::Real;
use crate::dof::Dof;
use crate::error::{EntryAttribute, EntryFault, Error, ModelEntry, finite};
use crate::factor::SparseLoad;
use crate::influence::FactoredFrame;
use crate::model::Model;

/// Forces under which a structure is at rest, and about whose state its motions are small.
///
/// # Example
/// ```
/// use fea::Preload;
///
/// // Own weight, y up, and 100 kN downwards on point 3; newtons and metres.
/// let preload = Preload {
///     acceleration: [0.0, -9.81, 0.0],
///     points: vec![(3, [0.0, -1e5, 0.0])],
///     rails: Vec::new(),
/// };
/// assert!(!preload.is_zero());
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Preload {
    /// Weight of all that has mass per mass, global: gravity along its direction; zero without weight.
    pub acceleration: [f64; 3],
    /// Forces on points, global.
    pub points: Vec<(usize, [f64; 3])>,
    /// Forces on rails.
    pub rails: Vec<RailForce>,
}

/// A force on a rail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RailForce {
    /// Index of the rail.
    pub rail: usize,
    /// Coordinate.
    pub x: f64,
    /// Components along x, up and z of the rail.
    pub force: [f64; 3],
}

/// A force at the tip of a rigid arm of a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ArmForce {
    pub body: usize,
    /// From the reference of the body, global.
    pub arm: Vector3<f64>,
    pub force: Vector3<f64>,
    /// Direction of the rail of a force that stays at its place along it, while the rail turns under it.
    pub rail: Option<Vector3<f64>>,
}

/// What a preload does to a frame.
#[derive(Debug)]
pub(crate) struct BodyLoads {
    /// Over the scaled unknowns.
    pub load: SparseLoad,
    /// Forces on bodies, with their arms; without those of members.
    pub on_arms: Vec<ArmForce>,
}

impl Preload {
    /// The weight of all that has mass, -`gravity` along `up`, which may have any length; without weight where `up` is zero.
    #[must_use]
    pub fn weight(up: [f64; 3], gravity: f64) -> Preload {
        let size = up.iter().map(|a| a * a).sum::<f64>().sqrt();
        let factor = if size > 0.0 { gravity / size } else { 0.0 };
        Preload {
            acceleration: up.map(|a| if factor == 0.0 { 0.0 } else { -factor * a }),
            ..Preload::default()
        }
    }

    /// Whether there is no force.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        let zero = |force: &[f64; 3]| *force == [0.0; 3];
        zero(&self.acceleration)
            && self.points.iter().all(|(_, force)| zero(force))
            && self.rails.iter().all(|given| zero(&given.force))
    }

    /// Checks numbers and indices of points.
    pub(crate) fn check(&self, m: &Model) -> Result<(), Error> {
        let at = |k: usize| {
            move |fault| Error::Invalid {
                entry: ModelEntry::PreloadForce(k),
                fault,
            }
        };
        finite(EntryAttribute::Force, &self.acceleration).map_err(|fault| Error::Invalid {
            entry: ModelEntry::Preload,
            fault,
        })?;
        for (k, (point, force)) in self.points.iter().enumerate() {
            if *point >= m.points.len() {
                return Err(at(k)(EntryFault::NoPoint { point: *point }));
            }
            finite(EntryAttribute::Force, force).map_err(at(k))?;
        }
        for (k, given) in self.rails.iter().enumerate() {
            finite(EntryAttribute::Force, &given.force).map_err(at(self.points.len() + k))?;
        }
        Ok(())
    }

    /// The loads on the bodies of `frame`, which was made of `m`.
    ///
    /// # Errors
    /// A force on a degree of freedom that nothing holds; a place beyond its rail.
    pub(crate) fn loads(&self, m: &Model, frame: &FactoredFrame) -> Result<BodyLoads, Error> {
        let bodies = &frame.bodies;
        let mut out = BodyLoads {
            load: SparseLoad::new(),
            on_arms: Vec::new(),
        };
        let arm_of = |point: usize| bodies.arms[point].map(Real::double);
        if self.acceleration != [0.0; 3] {
            let weight = frame.weight(m, self.acceleration);
            out.load.extend(frame.load_of_weight(&weight));
            let gravity = Vector3::from(self.acceleration);
            for mass in &m.masses {
                let (body, arm) = (bodies.of_point[mass.point], arm_of(mass.point));
                let arm = arm + Vector3::from(mass.offset);
                out.on_arms.push(ArmForce {
                    body,
                    arm,
                    force: gravity * mass.mass,
                    rail: None,
                });
            }
            for (element, member) in frame.elements.iter().zip(&m.members) {
                let half = 0.5 * m.sections[member.section].mass * element.length;
                for end in 0..2 {
                    let (body, arm) = (
                        bodies.of_point[element.points[end]],
                        arm_of(element.points[end]),
                    );
                    out.on_arms.push(ArmForce {
                        body,
                        arm: arm + element.offsets[end],
                        force: gravity * half,
                        rail: None,
                    });
                }
            }
        }
        for (k, &(point, force)) in self.points.iter().enumerate() {
            let rows = frame.point(point);
            for (dof, &component) in force.iter().enumerate().filter(|(_, force)| **force != 0.0) {
                let row = frame.scaled(&rows[dof]).ok_or(Error::Invalid {
                    entry: ModelEntry::PreloadForce(k),
                    fault: EntryFault::NotHeld { dof: Dof::ALL[dof] },
                })?;
                out.load.extend(
                    row.into_iter()
                        .map(|(unknown, value)| (unknown, component * value)),
                );
            }
            let body = bodies.of_point[point];
            out.on_arms.push(ArmForce {
                body,
                arm: arm_of(point),
                force: Vector3::from(force),
                rail: None,
            });
        }
        for given in &self.rails {
            self.add_rail_force(frame, given, &mut out)?;
        }
        Ok(out)
    }

    /// Adds a force on a rail. On its arm it acts at the bodies at both ends of its element, in proportion to the distance
    /// from the other end.
    fn add_rail_force(
        &self,
        frame: &FactoredFrame,
        given: &RailForce,
        out: &mut BodyLoads,
    ) -> Result<(), Error> {
        let RailForce { rail, x, force } = *given;
        let mut element = None;
        for axis in Axis::ALL {
            let component = force[axis.component()];
            if component == 0.0 {
                continue;
            }
            let (load, own) = frame.load(Probe { rail, x, axis })?;
            element = Some(own);
            out.load.extend(
                load.into_iter()
                    .map(|(unknown, value)| (unknown, component * value)),
            );
        }
        let Some(element) = element else {
            return Ok(());
        };
        let own = &frame.line()?.elements()[element];
        let share = ((x - own.x[0]) / (own.x[1] - own.x[0])).clamp(0.0, 1.0);
        let axes = frame.rail_axes(rail);
        let global = |v: [f64; 3]| axes.transpose() * Vector3::from(v);
        for (end, share) in [(0, 1.0 - share), (1, share)] {
            // A rigid arm has one state, and its offset is that of its first end.
            let along = if own.ends[0] == own.ends[1] {
                x - own.x[0]
            } else {
                0.0
            };
            let offset = [own.offset[0] + along, own.offset[1], own.offset[2]];
            let (body, tip) = frame.state_arm(own.ends[end]);
            out.on_arms.push(ArmForce {
                body,
                arm: tip + global(offset),
                force: global(force) * share,
                rail: Some(global([1.0, 0.0, 0.0])),
            });
        }
        Ok(())
    }
}
