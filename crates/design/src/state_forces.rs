//! Internal forces of a section in one state: all six at once, where an envelope gives one quantity with its plane.

use std::collections::BTreeMap;

use fea::{Effect, Model, Rail};
use trains::{
    DeadLoads, Error, GirderResponse, Governing, MemberForces, PassedLoads, RailLoad, SectionSide, Structure,
    TrainCase,
};

use crate::placed::{RailLines, with_twins};

/// Distance from the end of a member and from a wheel, relative to the length of the member, that counts as rounding.
const NEAR: f64 = 2e-9;

/// The quantities of a section: normal force, torsion, shear and moment in both planes, in the order of
/// [`GirderResponse::ALL`].
pub(crate) type SectionForces = [f64; 6];

/// A member that carries a rail.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CarryingMember {
    /// Index of the rail.
    pub rail: usize,
    /// Index of the member in the model.
    pub member: usize,
    /// Rail coordinates of its ends.
    pub x: [f64; 2],
}

/// Forces of the members that carry rails, under trains in given states and under dead load.
pub(crate) struct StateForces {
    members: MemberForces,
    carrying: Vec<CarryingMember>,
    dead: DeadLoads,
    /// By member: the quantities under dead load at its first end, its middle and its last end.
    of_dead: BTreeMap<usize, [SectionForces; 3]>,
}

impl StateForces {
    /// Solves the model with its rails, and with twins of the rails where loads act beside them.
    pub fn new(
        model: &Model,
        rails: &[Rail],
        lines: &RailLines,
        dead: &DeadLoads,
        eccentric: bool,
    ) -> Result<StateForces, Error> {
        let members = MemberForces::new(model, &with_twins(rails, lines, eccentric))?;
        let carrying = members.members().enumerate().map(|(index, member)| CarryingMember {
            rail: member.rail,
            member: match members.effects(index, 0.0)[0] {
                Effect::InternalForce { member, .. } => member,
                Effect::Reaction(_) => usize::MAX,
            },
            x: member.x,
        });
        let carrying = carrying.collect();
        let mut dead = dead.clone();
        dead.lines.resize(if eccentric { 2 * lines.count() } else { lines.count() }, 0.0);
        Ok(StateForces { members, carrying, dead, of_dead: BTreeMap::new() })
    }

    /// The members under the rails.
    pub fn carrying(&self) -> &[CarryingMember] {
        &self.carrying
    }

    /// The structure that was solved, with the twins of the rails behind them.
    pub fn structure(&self) -> &Structure {
        self.members.structure()
    }

    /// Index of the carrying member on whose side of a coordinate a section is.
    pub fn carrier_at(&self, rail: usize, x: f64, side: SectionSide) -> Option<usize> {
        let on = |(_, member): &(usize, &CarryingMember)| {
            let near = NEAR * (member.x[1] - member.x[0]);
            let (low, high) = match side {
                SectionSide::Before => (member.x[0] + near, member.x[1] + near),
                SectionSide::Behind => (member.x[0] - near, member.x[1] - near),
                SectionSide::At => (member.x[0] - near, member.x[1] + near),
            };
            member.rail == rail && x >= low && x <= high
        };
        self.carrying.iter().enumerate().find(on).map(|(index, _)| index)
    }

    /// The forces at the section of a governing state, on both sides of a wheel that stands there unless the state names one;
    /// `factor` is that of the dead load.
    pub fn at(
        &mut self,
        lines: &RailLines,
        case: &TrainCase,
        rail: usize,
        governing: &Governing,
    ) -> Result<Vec<(usize, SectionForces)>, Error> {
        let Some(carrier) = self.carrier_at(rail, governing.x, governing.side) else { return Ok(Vec::new()) };
        let loads = lines.loads(case, &governing.trains);
        let place = self.members.place(carrier, governing.x);
        let mut out = Vec::new();
        for mut forces in self.under(carrier, place, &loads, governing.side) {
            if case.dead != 0.0 && !self.dead.is_empty() {
                let dead = self.of_dead(carrier, place)?;
                forces.iter_mut().zip(dead).for_each(|(sum, part)| *sum += case.dead * part);
            }
            out.push((carrier, forces));
        }
        Ok(out)
    }

    /// The forces under loads alone.
    fn under(&self, carrier: usize, place: f64, loads: &[RailLoad], side: SectionSide) -> Vec<SectionForces> {
        let mut passed = PassedLoads::default();
        self.members.load(carrier, loads, &mut passed);
        let [first, last] = self.carrying[carrier].x.map(|x| self.members.place(carrier, x));
        let near = NEAR * (last - first).abs();
        let own = passed.places().find(|(_, at)| (at - place).abs() <= near).map(|(index, _)| index);
        let Some(index) = own else { return vec![passed.quantities(place, None)] };
        let sides: &[bool] = match side {
            SectionSide::Before => &[false],
            SectionSide::Behind => &[true],
            SectionSide::At => &[false, true],
        };
        sides.iter().map(|behind| passed.quantities(place, Some((index, *behind)))).collect()
    }

    /// The forces under dead load: along a member they are polynomials of at most the second degree, given by three places.
    fn of_dead(&mut self, carrier: usize, place: f64) -> Result<SectionForces, Error> {
        let length = self.members.place(carrier, self.carrying[carrier].x[1]);
        if !self.of_dead.contains_key(&carrier) {
            let mut three = [[0.0; 6]; 3];
            for (part, forces) in [0.0, 0.5, 1.0].iter().zip(&mut three) {
                let effects = self.members.effects(carrier, part * length).map(|effect| vec![effect]);
                let alone = TrainCase { dead: 1.0, ..TrainCase::default() };
                let found = trains::effects(self.members.structure(), &self.dead, &[alone], &effects)?;
                let components = std::array::from_fn(|k| found[0][k][0].value);
                *forces = self.members.quantities(carrier, components);
            }
            self.of_dead.insert(carrier, three);
        }
        let [first, middle, last] = self.of_dead[&carrier];
        let t = place / length;
        let weights = [(1.0 - t) * (1.0 - 2.0 * t), 4.0 * t * (1.0 - t), t * (2.0 * t - 1.0)];
        Ok(std::array::from_fn(|k| weights[0] * first[k] + weights[1] * middle[k] + weights[2] * last[k]))
    }
}

/// Index of a quantity in [`SectionForces`].
pub(crate) const fn index(quantity: GirderResponse) -> usize {
    quantity as usize
}
