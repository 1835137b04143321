//! Reactions and internal forces under rail loads.

use nalgebra::{DMatrix, Matrix6, RowSVector, SVector, Vector3};
use splines::{Component, Effects, Probe, Section};

use crate::assembly::reach;
use crate::element::{Element, Matrix12};
use crate::error::{Error, Fault, Item};
use crate::frame::Frame;
use crate::freedoms::Sum;
use crate::model::{Freedom, Model};
use crate::reaction::Hold;

/// Something that a load on a rail causes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Effect {
    /// Force or moment of the ground on the structure, global, positive along its freedom.
    Reaction(Hold),
    /// Internal force of a member, in its local axes; signs: [`Component`].
    Force {
        /// Index of the member.
        member: usize,
        /// Place along its flexible part from end 0 to end 1, 0..=1; the ends are just inside.
        place: f64,
        /// Which component.
        component: Component,
    },
}

/// An effect as a linear function of the motions of the bodies under a load and of the load itself:
/// strain u - direct p + what a loaded member adds between its held ends.
pub(crate) struct Functional {
    pub strain: Sum,
    pub direct: Sum,
    pub section: Option<Section>,
}

impl Frame {
    /// Where the ground can react: supports first, then springs. A support that others of the same rigid
    /// body make redundant is left out.
    ///
    /// `m`: the model that the frame was made of.
    #[must_use]
    pub fn holds(&self, m: &Model) -> Vec<Hold> {
        let supports = self.freedoms.bodies.iter().flat_map(|body| &body.holds);
        let supports = supports.map(|&(point, k)| Hold { point, freedom: Freedom::ALL[k], spring: None });
        let springs = m.springs.iter().enumerate().map(|(index, spring)| Hold {
            point: spring.point,
            freedom: spring.freedom,
            spring: Some(index),
        });
        supports.chain(springs).collect()
    }

    /// Influence lines: effects of unit loads anywhere on the rails, one solve an effect.
    ///
    /// By reciprocity: with the effect e^T u of displacements u = K^-1 p, the row of an effect over the
    /// states is (K^-1 e)^T by the states' motions. `m`: the model that the frame was made of.
    ///
    /// # Errors
    /// No rail; an effect of a member or hold that does not exist, or a place outside 0..=1.
    pub fn influence_lines(&self, m: &Model, effects: &[Effect]) -> Result<Effects, Error> {
        let functionals = self.functionals(m, effects)?;
        let line = self.line()?;
        let states = &self.states()[..line.states()];
        let loose: Vec<usize> =
            (0..6 * states.len()).filter(|&k| self.scaled(&states[k / 6][k % 6]).is_none()).collect();
        let mut rows = DMatrix::zeros(effects.len(), 6 * states.len());
        for (e, functional) in functionals.iter().enumerate() {
            let motions = self.motions(&self.stiffened(&functional.strain));
            for (k, sum) in states.iter().flatten().enumerate() {
                rows[(e, k)] = moved(sum, &motions) - product(&functional.direct, sum);
            }
        }
        for k in loose {
            rows.column_mut(k).fill(f64::INFINITY);
        }
        let sections = functionals.into_iter().map(|functional| functional.section).collect();
        Ok(Effects::new(line.clone(), rows, sections)?)
    }

    /// Effects (rows) of unit loads at the probes (columns): [`Frame::influence_lines`] read at them, or,
    /// where that is cheaper, one solve a load.
    ///
    /// # Errors
    /// As [`Frame::influence_lines`]; a probe beyond its rail, or in a direction that nothing resists.
    pub fn effects(&self, m: &Model, effects: &[Effect], at: &[Probe]) -> Result<DMatrix<f64>, Error> {
        let mut value = DMatrix::zeros(effects.len(), at.len());
        if effects.len() <= at.len() {
            let lines = self.influence_lines(m, effects)?;
            for (j, &probe) in at.iter().enumerate() {
                lines.fill(probe, value.column_mut(j).as_mut_slice())?;
            }
            return Ok(value);
        }
        let functionals = self.functionals(m, effects)?;
        // Reactions have no part of their own in the cell that is loaded: only sections are asked for it.
        let inner: Vec<usize> = (0..effects.len()).filter(|&i| functionals[i].section.is_some()).collect();
        let sections = inner.iter().map(|&i| functionals[i].section.clone()).collect();
        let line = self.line()?;
        let held = Effects::new(line.clone(), DMatrix::zeros(inner.len(), 6 * line.states()), sections)?;
        let mut own = vec![0.0; inner.len()];
        for (j, &probe) in at.iter().enumerate() {
            held.fill(probe, &mut own)?;
            inner.iter().zip(&own).for_each(|(&i, &part)| value[(i, j)] = part);
            let (load, _) = self.load(probe)?;
            let motions = self.motions(&load);
            let (row, _) = self.row(probe)?;
            for (i, functional) in functionals.iter().enumerate() {
                value[(i, j)] += moved(&functional.strain, &motions) - product(&functional.direct, &row);
            }
        }
        Ok(value)
    }

    pub(crate) fn functionals(&self, m: &Model, effects: &[Effect]) -> Result<Vec<Functional>, Error> {
        let one = |(index, effect): (usize, &Effect)| {
            let invalid = |fault| Error::Invalid { item: Item::Effect(index), fault };
            match *effect {
                Effect::Reaction(hold) => self
                    .reaction(m, hold)
                    .ok_or(invalid(Fault::NoHold { point: hold.point, freedom: hold.freedom })),
                Effect::Force { member, place, component } => {
                    let element = self.elements.get(member).ok_or(invalid(Fault::NoMember { member }))?;
                    if !(0.0..=1.0).contains(&place) {
                        return Err(invalid(Fault::NoPlace { place }));
                    }
                    Ok(self.internal(element, member, place, component))
                }
            }
        };
        effects.iter().enumerate().map(one).collect()
    }

    /// f = K' u - p_eq on the first end, carried to the section.
    fn internal(&self, element: &Element, member: usize, place: f64, component: Component) -> Functional {
        let balance = RowSVector::from(component.balance(place * element.length));
        let mut strain = Sum::default();
        let pair = element.points.map(|point| self.freedoms.body[point]);
        if pair[0] != pair[1] {
            let row = balance * element.stiffness.fixed_rows::<6>(0) * reach(element, &self.freedoms);
            (0..12).for_each(|k| strain.add(6 * pair[k / 6] + k % 6, row[k]));
        }
        let recovery = element.released.as_ref().map_or(Matrix12::identity(), |released| released.recovery);
        let ends: RowSVector<f64, 12> = -balance * recovery.fixed_columns::<6>(0).transpose();
        let section = Section { member, place, component, ends: ends.transpose().into() };
        Functional { strain, direct: Sum::default(), section: Some(section) }
    }

    /// What a body needs to be in equilibrium, less what loads it, shared among its supports.
    fn reaction(&self, m: &Model, hold: Hold) -> Option<Functional> {
        let mut strain = Sum::default();
        let mut direct = Sum::default();
        let body = *self.freedoms.body.get(hold.point)?;
        if let Some(index) = hold.spring {
            let spring = m.springs.get(index)?;
            let row = self.motion_row(spring.point, spring.freedom);
            (0..6).for_each(|k| strain.add(6 * body + k, -spring.stiffness * row[k]));
            return (spring.point == hold.point && spring.freedom == hold.freedom).then_some(Functional {
                strain,
                direct,
                section: None,
            });
        }
        let share = self.share(body, hold)?;
        for element in &self.elements {
            let pair = element.points.map(|point| self.freedoms.body[point]);
            if pair[0] == pair[1] || !pair.contains(&body) {
                continue;
            }
            let b = reach(element, &self.freedoms);
            let end = usize::from(pair[1] == body);
            let row = share * b.fixed_columns::<6>(6 * end).transpose() * element.stiffness * b;
            (0..12).for_each(|k| strain.add(6 * pair[k / 6] + k % 6, row[k]));
        }
        for spring in m.springs.iter().filter(|spring| self.freedoms.body[spring.point] == body) {
            let row = self.motion_row(spring.point, spring.freedom);
            let force = (share * row.transpose())[0] * spring.stiffness;
            (0..6).for_each(|k| strain.add(6 * body + k, force * row[k]));
        }
        (0..6).for_each(|k| direct.add(6 * body + k, share[k]));
        Some(Functional { strain, direct, section: None })
    }

    /// The reaction of a hold by the six resultants that all holds of its body must supply.
    fn share(&self, body: usize, hold: Hold) -> Option<RowSVector<f64, 6>> {
        let holds = &self.freedoms.bodies[body].holds;
        let index = holds.iter().position(|&own| own == (hold.point, hold.freedom as usize))?;
        let rows: Vec<RowSVector<f64, 6>> =
            holds.iter().map(|&(point, k)| self.motion_row(point, Freedom::ALL[k])).collect();
        let columns = DMatrix::from_fn(6, holds.len(), |i, j| rows[j][i]);
        let qr = columns.qr();
        let back = qr.r().solve_upper_triangular(&qr.q().transpose())?;
        Some(RowSVector::from_fn(|_, k| back[(index, k)]))
    }

    /// A freedom of a point by the motions of its body's reference.
    fn motion_row(&self, point: usize, freedom: Freedom) -> RowSVector<f64, 6> {
        let motion: Matrix6<f64> = self.freedoms.motion(point, &Vector3::zeros());
        motion.row(freedom as usize).into_owned()
    }
}

fn moved(sum: &Sum, motions: &[SVector<f64, 6>]) -> f64 {
    sum.terms.iter().map(|&(column, value)| value * motions[column / 6][column % 6]).sum()
}

fn product(a: &Sum, b: &Sum) -> f64 {
    let factor = |column: usize| b.terms.iter().find(|term| term.0 == column).map_or(0.0, |term| term.1);
    a.terms.iter().map(|&(column, value)| value * factor(column)).sum()
}
