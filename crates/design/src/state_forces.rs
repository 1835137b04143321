//! Internal forces of a section in one state: all six at once, where an envelope gives one quantity with its plane.

use std::collections::BTreeMap;

use fea::{Effect, Model, Rail};
use trains::{
    DeadLoads, Error, GirderResponse, Governing, MemberForces, PassedLoads, RailLoad, SectionSide,
    Structure, TrainCase, TrainPosition,
};

use crate::placed::{RailLines, with_twins};

/// Distance from the end of a member and from a wheel, relative to the length of the member, that counts as rounding.
const NEAR: f64 = 2e-9;

/// The quantities of a section: normal force, torsion, shear and moment in both planes, in the order of
/// [`GirderResponse::ALL`].
pub(crate) type SectionForces = [f64; 6];

/// The forces of a section on one side of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CarriedForces {
    /// Index of the carrying member.
    pub carrier: usize,
    pub side: SectionSide,
    pub forces: SectionForces,
}

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
        let carrying = members
            .members()
            .enumerate()
            .map(|(index, member)| CarryingMember {
                rail: member.rail,
                member: match members.effects(index, 0.0)[0] {
                    Effect::InternalForce { member, .. } => member,
                    Effect::Reaction(_) => usize::MAX,
                },
                x: member.x,
            });
        let carrying = carrying.collect();
        let mut dead = dead.clone();
        dead.lines.resize(
            if eccentric {
                2 * lines.count()
            } else {
                lines.count()
            },
            0.0,
        );
        Ok(StateForces {
            members,
            carrying,
            dead,
            of_dead: BTreeMap::new(),
        })
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
        self.carrying
            .iter()
            .enumerate()
            .find(on)
            .map(|(index, _)| index)
    }

    /// The forces at the section of a governing state and of all states that differ from it in the signs of forces alone, on
    /// both sides of a wheel that stands there. Which of them governs one force may be a matter of rounding, and decides
    /// about the others.
    pub fn alike(
        &mut self,
        lines: &RailLines,
        case: &TrainCase,
        rail: usize,
        governing: &Governing,
    ) -> Result<Vec<(Governing, CarriedForces)>, Error> {
        let at = |side| self.carrier_at(rail, governing.x, side);
        let mut open = governing.clone();
        if at(governing.side) == at(SectionSide::At) {
            open.side = SectionSide::At;
        }
        let mut states = vec![Vec::new()];
        for (train, at) in case.trains.iter().zip(&governing.trains) {
            let own = train.stances().into_iter();
            let turned: Vec<TrainPosition> = own
                .filter(|stance| stance.turned == at.stance.turned)
                .map(|stance| TrainPosition { stance, ..*at })
                .collect();
            let with = |state: &Vec<TrainPosition>| {
                let each = turned
                    .iter()
                    .map(|own| [state.as_slice(), &[*own]].concat());
                each.collect::<Vec<_>>()
            };
            states = states.iter().flat_map(with).collect();
        }
        let mut out = Vec::new();
        for trains in states {
            open.trains = trains;
            for forces in self.at(lines, case, rail, &open)? {
                let state = Governing {
                    side: forces.side,
                    ..open.clone()
                };
                out.push((state, forces));
            }
        }
        Ok(out)
    }

    /// The forces at the section of a governing state, on both sides of a wheel that stands there unless the state says on which
    /// one.
    pub fn at(
        &mut self,
        lines: &RailLines,
        case: &TrainCase,
        rail: usize,
        governing: &Governing,
    ) -> Result<Vec<CarriedForces>, Error> {
        let Some(carrier) = self.carrier_at(rail, governing.x, governing.side) else {
            return Ok(Vec::new());
        };
        let loads = lines.loads(case, &governing.trains);
        let place = self.members.place(carrier, governing.x);
        let mut out = Vec::new();
        for (side, mut forces) in self.under(carrier, place, &loads, governing.side) {
            if case.dead != 0.0 && !self.dead.is_empty() {
                let dead = self.of_dead(carrier, place)?;
                forces
                    .iter_mut()
                    .zip(dead)
                    .for_each(|(sum, part)| *sum += case.dead * part);
            }
            out.push(CarriedForces {
                carrier,
                side,
                forces,
            });
        }
        Ok(out)
    }

    /// The forces under loads alone, each with the side of the section.
    fn under(
        &self,
        carrier: usize,
        place: f64,
        loads: &[RailLoad],
        side: SectionSide,
    ) -> Vec<(SectionSide, SectionForces)> {
        let mut passed = PassedLoads::default();
        self.members.load(carrier, loads, &mut passed);
        let [first, last] = self.carrying[carrier]
            .x
            .map(|x| self.members.place(carrier, x));
        let near = NEAR * (last - first).abs();
        if !passed.places().any(|(_, at)| (at - place).abs() <= near) {
            return vec![(side, passed.quantities(place, None))];
        }
        // At the end of a member the side of the state is that of the member, not that of the wheel.
        let is_inside = place > first + near && place < last - near;
        let both = [SectionSide::Before, SectionSide::Behind];
        let sides = both
            .into_iter()
            .filter(|one| !is_inside || side == SectionSide::At || side == *one);
        let beside = |one: SectionSide| {
            // Just beyond all loads at the section, and back along the slopes of the moments.
            let step = match one {
                SectionSide::Before => -2.0 * near,
                _ => 2.0 * near,
            };
            let mut forces = passed.quantities(place + step, None);
            for (moment, shear) in [
                (
                    GirderResponse::VerticalMoment,
                    GirderResponse::VerticalShear,
                ),
                (GirderResponse::LateralMoment, GirderResponse::LateralShear),
            ] {
                forces[index(moment)] -= step * forces[index(shear)];
            }
            (if is_inside { one } else { side }, forces)
        };
        sides.map(beside).collect()
    }

    /// The forces under dead load: along a member they are polynomials of at most the second degree, given by three places.
    fn of_dead(&mut self, carrier: usize, place: f64) -> Result<SectionForces, Error> {
        let length = self.members.place(carrier, self.carrying[carrier].x[1]);
        if !self.of_dead.contains_key(&carrier) {
            let mut three = [[0.0; 6]; 3];
            for (part, forces) in [0.0, 0.5, 1.0].iter().zip(&mut three) {
                let effects = self
                    .members
                    .effects(carrier, part * length)
                    .map(|effect| vec![effect]);
                let alone = TrainCase {
                    dead: 1.0,
                    ..TrainCase::default()
                };
                let found =
                    trains::effects(self.members.structure(), &self.dead, &[alone], &effects)?;
                let components = std::array::from_fn(|k| found[0][k][0].value);
                *forces = self.members.quantities(carrier, components);
            }
            self.of_dead.insert(carrier, three);
        }
        let [first, middle, last] = self.of_dead[&carrier];
        let t = place / length;
        let weights = [
            (1.0 - t) * (1.0 - 2.0 * t),
            4.0 * t * (1.0 - t),
            t * (2.0 * t - 1.0),
        ];
        Ok(std::array::from_fn(|k| {
            weights[0] * first[k] + weights[1] * middle[k] + weights[2] * last[k]
        }))
    }
}

/// Index of a quantity in [`SectionForces`].
pub(crate) const fn index(quantity: GirderResponse) -> usize {
    quantity as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use fea::Girder;
    use trains::{Request, Train, TrainWheel, envelopes};

    fn girder() -> Girder {
        Girder {
            spans: vec![6.0, 7.5],
            e: 2.1e8,
            g: Some(8.1e7),
            area: Some(0.02),
            i_vertical: 5.8e-4,
            i_lateral: Some(1.1e-4),
            j: Some(3.6e-6),
            rail_height: 0.3,
            mass_per_length: Some(0.2),
            ..Girder::default()
        }
    }

    fn train(first: f64, ends: [f64; 2]) -> Train {
        let wheel = |x: f64, vertical: f64| TrainWheel {
            rail: 0,
            x,
            vertical,
            lateral: 0.1 * vertical,
            longitudinal: 12.0,
            eccentricity: 0.02,
        };
        let wheels = vec![wheel(0.0, first), wheel(2.6, 80.0)];
        Train {
            wheels,
            ends,
            turned: true,
            reverses: true,
            enters: false,
        }
    }

    /// Analytic: in the state that governs a quantity the section has this quantity, with dead load, signs, eccentricity and
    /// trains that are turned. The six quantities of a state and the envelopes are calculated on different ways.
    #[test]
    fn the_forces_of_a_governing_state_hold_the_governing_force() {
        let (model, rail) = girder().model_and_rail().expect("a girder");
        let rails = [rail];
        let structure = Structure::new(&model, &rails, true).expect("a structure");
        let lines = RailLines::new(&rails, &[structure.range(0)], model.up);
        let dead = DeadLoads {
            gravity: 9.81,
            lines: vec![0.7],
        };
        let cases = [
            TrainCase {
                trains: vec![train(120.0, [0.3, 0.6])],
                dead: 1.35,
                ..TrainCase::default()
            },
            TrainCase {
                trains: vec![train(120.0, [0.3; 2]), train(60.0, [0.2; 2])],
                gap: 0.4,
                ..TrainCase::default()
            },
        ];
        let request = Request {
            spans: vec![vec![0.0, 6.0, 13.5]],
            places: vec![vec![0.0, 2.2, 6.0, 9.1]],
            ..Request::default()
        };
        let found = envelopes(&structure, &dead, &cases, &request).expect("envelopes");
        let mut forces =
            StateForces::new(&model, &rails, &lines, &dead, true).expect("a structure");
        let mut compared = 0;
        for (case, found) in cases.iter().zip(&found) {
            let spans = found.extremes.iter().map(|e| (e.quantity, &e.governing));
            for (quantity, governing) in
                spans.chain(found.envelopes.iter().map(|e| (e.quantity, &e.governing)))
            {
                if index(quantity) >= 6 {
                    continue;
                }
                let all = forces.at(&lines, case, 0, governing).expect("forces");
                let size = found.extremes.iter().filter(|e| e.quantity == quantity);
                let size = size.map(|e| e.governing.value.abs()).fold(1.0, f64::max);
                let error =
                    |own: &SectionForces| (own[index(quantity)] - governing.value).abs() / size;
                let nearest = all
                    .iter()
                    .map(|own| error(&own.forces))
                    .fold(f64::INFINITY, f64::min);
                assert!(
                    nearest < 1e-8,
                    "{quantity:?} at {}: {all:?} without {}",
                    governing.x,
                    governing.value
                );
                compared += 1;
            }
        }
        assert!(compared > 150, "{compared}");
    }
}
