//! Effects of loads as linear functions of the motions of the bodies and of the loads.

use nalgebra::{DMatrix, Matrix3, Matrix6, RowSVector, Vector3};
use splines::{ForceComponent, InternalForce};

use crate::assembly::{Combination, Element, transformation};
use crate::dof::Dof;
use crate::error::{EntryFault, Error, ModelEntry};
use crate::influence::frame::FactoredFrame;
use crate::model::{GroundSpring, Model};

/// Where a reaction acts: a degree of freedom that a support or a spring restrains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Restraint {
    /// Index of the point.
    pub point: usize,
    /// The restrained degree of freedom, global.
    pub dof: Dof,
    /// Index of the spring that restrains it; `None` for a support.
    pub spring: Option<usize>,
}

/// A reaction or an internal force: something that loads on a rail cause and that is linear in them.
///
/// # Example
/// ```
/// use fea::{ForceComponent, Effect, FactoredFrame, Girder};
/// use splines::{Axis, Probe};
///
/// let girder = Girder { spans: vec![60.0], e: 4.32e9, i_vertical: 9.528, ..Girder::default() };
/// let (model, rail) = girder.model_and_rail()?;
/// let frame = FactoredFrame::new(&model, &[rail])?;
/// // Bending moment Mz at midspan of member 0; a unit load up at midspan gives -L/4.
/// let moment = Effect::InternalForce { member: 0, place: 0.5, component: ForceComponent::BendingZ };
/// let load = Probe { rail: 0, x: 30.0, axis: Axis::Vertical };
/// let value = frame.effects(&model, &[moment], &[load])?;
/// assert!((value[(0, 0)] + 15.0).abs() < 1e-9);
/// # Ok::<(), fea::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Effect {
    /// Force or moment of the ground on the structure, global, positive along its degree of freedom.
    Reaction(Restraint),
    /// Internal force of a member, in its local axes; for the signs see [`ForceComponent`].
    InternalForce {
        /// Index of the member.
        member: usize,
        /// Fraction of its flexible part from end 0 to end 1, 0 to 1; a section at an end is just inside.
        place: f64,
        /// Which component.
        component: ForceComponent,
    },
}

/// An effect E of a load p with the motions u of the bodies:
///
/// E = strain . u - direct . p + what the member of the section adds between its fixed ends.
pub(crate) struct Functional {
    pub strain: Combination,
    pub direct: Combination,
    pub section: Option<InternalForce>,
}

impl FactoredFrame {
    /// All restraints that have a reaction: supports first, then springs. A support that other supports of
    /// the same rigid body make redundant is left out.
    ///
    /// `m` is the model that the frame was made of.
    #[must_use]
    pub fn restraints(&self, m: &Model) -> Vec<Restraint> {
        let supports = self.bodies.list.iter().flat_map(|body| &body.constraints);
        let supports = supports.map(|&(point, k)| Restraint {
            point,
            dof: Dof::ALL[k],
            spring: None,
        });
        let springs = m
            .springs
            .iter()
            .enumerate()
            .map(|(index, spring)| Restraint {
                point: spring.point,
                dof: spring.dof,
                spring: Some(index),
            });
        supports.chain(springs).collect()
    }

    /// The functionals of a list of effects.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a member or restraint that does not exist, or a place outside 0 to 1.
    pub(crate) fn functionals(
        &self,
        m: &Model,
        effects: &[Effect],
    ) -> Result<Vec<Functional>, Error> {
        let one = |(index, effect): (usize, &Effect)| {
            let invalid = |fault| Error::Invalid {
                entry: ModelEntry::Effect(index),
                fault,
            };
            match *effect {
                Effect::Reaction(hold) => {
                    self.reaction(m, hold)
                        .ok_or(invalid(EntryFault::NoReaction {
                            point: hold.point,
                            dof: hold.dof,
                        }))
                }
                Effect::InternalForce {
                    member,
                    place,
                    component,
                } => {
                    let element = self
                        .elements
                        .get(member)
                        .ok_or(invalid(EntryFault::NoMember { member }))?;
                    if !(0.0..=1.0).contains(&place) {
                        return Err(invalid(EntryFault::NoPlace { place }));
                    }
                    Ok(self.internal_force(element, member, place, component))
                }
            }
        };
        effects.iter().enumerate().map(one).collect()
    }

    /// Internal force from the equilibrium of the part of the member before the section: the forces on end 0,
    /// f = K' u - p_eq, balanced at the section.
    fn internal_force(
        &self,
        element: &Element,
        member: usize,
        place: f64,
        component: ForceComponent,
    ) -> Functional {
        let balance = RowSVector::from(component.balance(place * element.length));
        let mut strain = Combination::default();
        let pair = self.bodies.pair(element.points);
        let under_tension = element.tension_row(place, component);
        if pair[0] != pair[1] {
            let mut row = balance
                * element.stiffness().fixed_rows::<6>(0)
                * transformation(element, &self.bodies);
            if let Some(deflected) = &under_tension {
                row += deflected * element.recovery() * transformation(element, &self.bodies);
            }
            (0..12).for_each(|k| strain.add(6 * pair[k / 6] + k % 6, row[k]));
        }
        let mut ends: RowSVector<f64, 12> =
            -balance * element.recovery().fixed_columns::<6>(0).transpose();
        if let (Some(deflected), Some(released)) = (&under_tension, &element.released) {
            ends += deflected * released.compliance;
        }
        let section = InternalForce {
            member,
            place,
            component,
            ends: ends.transpose().into(),
        };
        Functional {
            strain,
            direct: Combination::default(),
            section: Some(section),
        }
    }

    /// Reaction of a restraint; `None` if it does not exist.
    fn reaction(&self, m: &Model, hold: Restraint) -> Option<Functional> {
        let body = *self.bodies.of_point.get(hold.point)?;
        let Some(index) = hold.spring else {
            return self.support_reaction(m, body, hold);
        };
        let spring = m.springs.get(index)?;
        (spring.point == hold.point && spring.dof == hold.dof)
            .then(|| self.spring_reaction(body, spring))
    }

    /// The force of a spring on its body: -k u.
    fn spring_reaction(&self, body: usize, spring: &GroundSpring) -> Functional {
        let mut strain = Combination::default();
        let row = self.motion_row(spring.point, spring.dof);
        (0..6).for_each(|k| strain.add(6 * body + k, -spring.stiffness * row[k]));
        Functional {
            strain,
            direct: Combination::default(),
            section: None,
        }
    }

    /// The six resultants that the supports of a body must supply are those of its members and springs less
    /// those of its loads; one row of the distribution among the supports gives one reaction.
    fn support_reaction(&self, m: &Model, body: usize, hold: Restraint) -> Option<Functional> {
        let mut strain = Combination::default();
        let mut direct = Combination::default();
        let distribution = self.distribution(body, hold)?;
        for element in &self.elements {
            let pair = self.bodies.pair(element.points);
            if pair[0] == pair[1] || !pair.contains(&body) {
                continue;
            }
            let b = transformation(element, &self.bodies);
            let end = usize::from(pair[1] == body);
            let row =
                distribution * b.fixed_columns::<6>(6 * end).transpose() * element.stiffness() * b;
            (0..12).for_each(|k| strain.add(6 * pair[k / 6] + k % 6, row[k]));
        }
        for arm in m
            .arms
            .iter()
            .filter(|arm| self.bodies.of_point[arm.point] == body)
        {
            let stiffness = Matrix3::from_fn(|i, j| arm.stiffness[i][j]);
            let row = distribution.fixed_columns::<3>(3) * stiffness;
            (0..3).for_each(|k| strain.add(6 * body + 3 + k, row[k]));
        }
        for spring in m
            .springs
            .iter()
            .filter(|spring| self.bodies.of_point[spring.point] == body)
        {
            let row = self.motion_row(spring.point, spring.dof);
            let force = (distribution * row.transpose())[0] * spring.stiffness;
            (0..6).for_each(|k| strain.add(6 * body + k, force * row[k]));
        }
        (0..6).for_each(|k| direct.add(6 * body + k, distribution[k]));
        Some(Functional {
            strain,
            direct,
            section: None,
        })
    }

    /// The reaction of one support by the six resultants that all supports of its body must supply: a row of
    /// the pseudo-inverse of the matrix whose columns are the constraints, by QR.
    fn distribution(&self, body: usize, hold: Restraint) -> Option<RowSVector<f64, 6>> {
        let constraints = &self.bodies.list[body].constraints;
        let index = constraints
            .iter()
            .position(|&own| own == (hold.point, hold.dof as usize))?;
        let rows: Vec<RowSVector<f64, 6>> = constraints
            .iter()
            .map(|&(point, k)| self.motion_row(point, Dof::ALL[k]))
            .collect();
        let columns = DMatrix::from_fn(6, constraints.len(), |i, j| rows[j][i]);
        let qr = columns.qr();
        let inverse = qr.r().solve_upper_triangular(&qr.q().transpose())?;
        Some(RowSVector::from_fn(|_, k| inverse[(index, k)]))
    }

    /// One displacement or rotation of a point by the motion of the reference of its body.
    fn motion_row(&self, point: usize, freedom: Dof) -> RowSVector<f64, 6> {
        let motion: Matrix6<f64> = self.bodies.motion(point, &Vector3::zeros());
        motion.row(freedom as usize).into_owned()
    }
}
