//! Internal forces of the members that carry rails under concentrated loads at one instant.
//!
//! The six quantities Q(0) just inside the first end of a member follow from its influence lines. At a distance s they
//! follow by equilibrium of the part between: each load passed at s_k < s changes force and couple by its jump, and
//! moments by (s - s_k) times the jump of the shear; where the member has an axial force, `bent` has the functions. Loads may stand anywhere; nothing is sampled along the member.

use crate::bent::{BENT, BentPlane, FIRST, moved};
use crate::error::Error;
use crate::line::{LineCell, value_of_cubic};
use crate::rail_deflection::CarrierLines;
use crate::section::slope_index;
use crate::structure::{Carrier, OnMember, QUANTITIES, Structure};
use fea::{Effect, Model, Rail};
use smallvec::SmallVec;

/// Distance from the end of a member, relative to its length along the rail, within which a load counts as just inside.
const INSIDE: f64 = 1e-9;
/// Members whose influence lines are solved at once.
const BATCH: usize = 32;

/// A concentrated load on a rail.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RailLoad {
    /// Index of the rail.
    pub rail: usize,
    /// Rail coordinate.
    pub x: f64,
    /// Components along +x, up and along +z of the rail.
    pub force: [f64; 3],
}

/// The members that carry the rails of a structure, with the influence lines of their end forces.
///
/// # Example
/// ```
/// use fea::Girder;
/// use trains::{GirderResponse, MemberForces, PassedLoads, RailLoad};
///
/// let girder = Girder { spans: vec![8.0], e: 2.1e8, i_vertical: 5e-4, ..Girder::default() };
/// let (model, rail) = girder.model_and_rail()?;
/// let members = MemberForces::new(&model, &[rail])?;
/// // 10 kN at midspan: M = F L / 4
/// let mut at = PassedLoads::default();
/// members.load(0, &[RailLoad { rail: 0, x: 4.0, force: [0.0, -10.0, 0.0] }], &mut at);
/// let forces = at.quantities(4.0, None);
/// assert!((forces[GirderResponse::VerticalMoment as usize] - 20.0).abs() < 1e-9);
/// # Ok::<(), trains::Error>(())
/// ```
#[derive(Debug)]
pub struct MemberForces {
    structure: Structure,
    /// The members, whole.
    carriers: Vec<Carrier>,
    /// Influence lines of the six quantities just inside the first end of each carrier, by rail.
    lines: Vec<Vec<Vec<ForceCell>>>,
    /// Rail elements on the member of each carrier.
    elements: Vec<Vec<LoadedElement>>,
}

/// A rail element on a member: where loads on it stand on the member, and what changes where they have been passed.
#[derive(Debug)]
struct LoadedElement {
    rail: usize,
    x: [f64; 2],
    /// Place on the member at the first coordinate, and its change by the coordinate.
    start: f64,
    rate: f64,
    /// Jump of the quantities by a unit load in each direction.
    jumps: [[f64; QUANTITIES]; 3],
}

/// A stretch of rail with the cubics of six quantities for forces in each direction, by the distance from its first end:
/// coefficient by coefficient.
#[derive(Debug)]
struct ForceCell {
    x: [f64; 2],
    cubics: [[[f64; QUANTITIES]; 4]; 3],
}

/// A member that carries a rail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RailMember {
    /// Index of the rail.
    pub rail: usize,
    /// Rail coordinates of its ends.
    pub x: [f64; 2],
    /// Its length.
    pub length: f64,
}

/// The loads that stand on a member, and the quantities just inside its first end.
#[derive(Clone, Debug, Default)]
pub struct PassedLoads {
    base: [f64; QUANTITIES],
    passed: SmallVec<[PassedLoad; 4]>,
    /// The planes that an axial force bends.
    planes: Option<[BentPlane; 2]>,
}

#[derive(Clone, Copy, Debug)]
struct PassedLoad {
    /// Index in the list of loads.
    index: usize,
    place: f64,
    jump: [f64; QUANTITIES],
}

impl MemberForces {
    /// Solves a model with its rails.
    ///
    /// # Errors
    /// A model or a rail that cannot be used, or a structure that can move without strain.
    pub fn new(model: &Model, rails: &[Rail]) -> Result<MemberForces, Error> {
        let structure = Structure::new(model, rails, false)?;
        let all: Vec<Carrier> = structure
            .carriers
            .iter()
            .filter_map(Carrier::whole_from_first)
            .collect();
        let mut lines = Vec::with_capacity(all.len());
        let mut elements = Vec::with_capacity(all.len());
        for carriers in all.chunks(BATCH) {
            let cell = |cell: LineCell<QUANTITIES>| {
                let [along, up, across, ..] = cell.cubics;
                let by_power = |cubics: [[f64; 4]; QUANTITIES]| {
                    std::array::from_fn(|power| cubics.map(|cubic| cubic[power]))
                };
                ForceCell {
                    x: cell.x,
                    cubics: [along, up, across].map(by_power),
                }
            };
            let of_rail = |cells: Vec<LineCell<QUANTITIES>>| cells.into_iter().map(cell).collect();
            let solved = structure.end_lines(carriers, [true, true, true, false, false])?;
            for (carrier, forces) in carriers.iter().zip(solved) {
                let joined = CarrierLines {
                    forces,
                    deflections: [None, None],
                }
                .joined(&structure, carrier);
                lines.push(joined.forces.rails.into_iter().map(of_rail).collect());
                elements.push(loaded_elements(&structure, carrier)?);
            }
        }
        Ok(MemberForces {
            structure,
            carriers: all,
            lines,
            elements,
        })
    }

    /// The structure.
    #[must_use]
    pub fn structure(&self) -> &Structure {
        &self.structure
    }

    /// The members, rail by rail in the order of the model.
    pub fn members(&self) -> impl ExactSizeIterator<Item = RailMember> + '_ {
        self.carriers.iter().map(|c| RailMember {
            rail: c.rail,
            x: c.x,
            length: c.length,
        })
    }

    /// Distance of a section from the first end of a member, by its rail coordinate.
    #[must_use]
    pub fn place(&self, member: usize, x: f64) -> f64 {
        self.carriers[member].place(x)
    }

    /// Rail coordinate of the section at a distance from the first end of a member.
    #[must_use]
    pub fn coordinate(&self, member: usize, place: f64) -> f64 {
        self.carriers[member].coordinate(place)
    }

    /// The six components of the internal force of the section at a distance from the first end of a member, as effects
    /// of the frame.
    #[must_use]
    pub fn effects(&self, member: usize, place: f64) -> [Effect; QUANTITIES] {
        let carrier = &self.carriers[member];
        let place = carrier.fraction(place.clamp(0.0, carrier.length));
        fea::ForceComponent::ALL.map(|component| Effect::InternalForce {
            member: carrier.member,
            place,
            component,
        })
    }

    /// The quantities, in the order of [`crate::GirderResponse::ALL`] without the deflections, by the six components of
    /// [`MemberForces::effects`].
    #[must_use]
    pub fn quantities(&self, member: usize, components: [f64; QUANTITIES]) -> [f64; QUANTITIES] {
        self.carriers[member].quantities(components)
    }

    /// Whether each quantity, in the order of [`crate::GirderResponse::ALL`] without the deflections, may differ from zero
    /// in any member under loads in the `directions` along +x, up and along +z of the rails.
    #[must_use]
    pub fn acting(&self, directions: [bool; 3]) -> [bool; QUANTITIES] {
        let mut out = [false; QUANTITIES];
        for k in (0..3).filter(|k| directions[*k]) {
            for cell in self.lines.iter().flatten().flatten() {
                for coefficients in &cell.cubics[k] {
                    out.iter_mut()
                        .zip(coefficients)
                        .for_each(|(out, own)| *out |= *own != 0.0);
                }
            }
            for element in self.elements.iter().flatten() {
                out.iter_mut()
                    .zip(&element.jumps[k])
                    .for_each(|(out, jump)| *out |= *jump != 0.0);
            }
        }
        let own = out;
        let is_bent = self.carriers.iter().any(|carrier| carrier.bent.is_some());
        for (k, out) in out.iter_mut().enumerate() {
            *out |= slope_index(k).is_some_and(|shear| own[shear]);
            *out |= is_bent && k >= FIRST && own[FIRST..].contains(&true);
        }
        out
    }

    /// Writes the state of a member under loads into `out`. A load within 1e-9 of an end of the member, relative to its
    /// length, counts as just inside. Components in which the structure is unrestrained are neglected.
    pub fn load(&self, member: usize, loads: &[RailLoad], out: &mut PassedLoads) {
        out.passed.clear();
        let mut own = [0.0; QUANTITIES];
        for (index, load) in loads.iter().enumerate() {
            let felt = |k: &usize| load.force[*k] != 0.0 && self.structure.resists(load.rail, *k);
            let (x, element) = self.inside(member, load);
            let cells = &self.lines[member][load.rail];
            let at = cells
                .partition_point(|cell| cell.x[0] <= x)
                .saturating_sub(1);
            let Some(cell) = cells
                .get(at)
                .filter(|cell| cell.x[0] <= x && x <= cell.x[1])
            else {
                continue;
            };
            let t = x - cell.x[0];
            let mut jump = [0.0; QUANTITIES];
            let mut is_felt = false;
            for k in (0..3).filter(felt) {
                is_felt = true;
                let (force, [a, b, c, d]) = (load.force[k], &cell.cubics[k]);
                for (n, sum) in own.iter_mut().enumerate() {
                    *sum += force * value_of_cubic(&[a[n], b[n], c[n], d[n]], t);
                }
                if let Some(element) = element {
                    jump.iter_mut()
                        .zip(&element.jumps[k])
                        .for_each(|(sum, a)| *sum += force * a);
                }
            }
            if let (Some(element), true) = (element, is_felt) {
                let place = element.start + (x - element.x[0]) * element.rate;
                out.passed.push(PassedLoad { index, place, jump });
            }
        }
        out.base = own;
        out.planes = self.carriers[member]
            .bent
            .as_ref()
            .map(|bent| *bent.planes());
    }

    /// Whether an axial force bends a member, so that its moments are not linear between loads.
    #[must_use]
    pub fn is_bent(&self, member: usize) -> bool {
        self.carriers[member].bent.is_some()
    }

    /// Distance from the first end of a member at which a load stands on it; `None` where it stands elsewhere.
    #[must_use]
    pub fn stands(&self, member: usize, load: &RailLoad) -> Option<f64> {
        let (x, element) = self.inside(member, load);
        element.map(|element| element.start + (x - element.x[0]) * element.rate)
    }

    /// The coordinate at which a load counts, and the rail element of the member on which it stands.
    fn inside(&self, member: usize, load: &RailLoad) -> (f64, Option<&LoadedElement>) {
        for element in self.elements[member]
            .iter()
            .filter(|element| element.rail == load.rail)
        {
            let near = INSIDE * (element.x[1] - element.x[0]);
            if load.x >= element.x[0] - near && load.x <= element.x[1] + near {
                return (
                    load.x.clamp(element.x[0] + near, element.x[1] - near),
                    Some(element),
                );
            }
        }
        (load.x, None)
    }
}

/// The rail elements on the member of a carrier.
fn loaded_elements(structure: &Structure, carrier: &Carrier) -> Result<Vec<LoadedElement>, Error> {
    let mut out = Vec::new();
    for OnMember {
        other,
        stretch,
        start,
        rate,
    } in structure.on_member(carrier)
    {
        let mut jumps = [[0.0; QUANTITIES]; 3];
        for (component, jump) in jumps.iter_mut().enumerate() {
            let [force, couple] = structure.load(stretch, component)?;
            *jump = carrier.jump_of_load(&force, &couple);
        }
        out.push(LoadedElement {
            rail: other.rail,
            x: other.x,
            start,
            rate,
            jumps,
        });
    }
    Ok(out)
}

impl PassedLoads {
    /// Loads that stand on the member, by their index in the list, with their distances from its first end.
    pub fn places(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.passed.iter().map(|load| (load.index, load.place))
    }

    /// The six quantities of the section at a distance from the first end of the member. `own` is a load that stands at
    /// the section, and whether the section is just behind it.
    #[must_use]
    pub fn quantities(&self, place: f64, own: Option<(usize, bool)>) -> [f64; QUANTITIES] {
        self.quantities_behind(place, &|load, at| match own {
            Some((index, is_behind)) if index == load => is_behind,
            _ => at < place,
        })
    }

    /// The same, behind those loads for whose index and place on the member `is_passed` is true. Where a load moves across the
    /// section, this extends the quantities on one side of it to the other.
    #[must_use]
    pub fn quantities_behind(
        &self,
        place: f64,
        is_passed: &dyn Fn(usize, f64) -> bool,
    ) -> [f64; QUANTITIES] {
        let mut out = self.moved(&self.base, place);
        for load in &self.passed {
            if is_passed(load.index, load.place) {
                let behind = self.moved(&load.jump, place - load.place);
                out.iter_mut()
                    .zip(behind)
                    .for_each(|(value, more)| *value += more);
            }
        }
        out
    }

    /// Writes quantity `k` of sections at these distances from the first end of the member into `out`: the numbers of
    /// [`PassedLoads::quantities`] where no load stands at the sections.
    pub fn fill(&self, k: usize, places: &[f64], out: &mut [f64]) {
        if self.planes.is_some() {
            out.iter_mut()
                .zip(places)
                .for_each(|(out, place)| *out = self.quantities(*place, None)[k]);
            return;
        }
        let shear = slope_index(k);
        let slope = |of: &[f64; QUANTITIES]| shear.map_or(0.0, |shear| of[shear]);
        let of_lever = |slope: f64, lever: f64| if shear.is_some() { slope * lever } else { 0.0 };
        let (own, by_place) = (self.base[k], slope(&self.base));
        out.iter_mut()
            .zip(places)
            .for_each(|(out, place)| *out = own + of_lever(by_place, *place));
        for load in &self.passed {
            let (jump, by_place) = (load.jump[k], slope(&load.jump));
            for (out, place) in out.iter_mut().zip(places) {
                let behind = *out + (jump + of_lever(by_place, place - load.place));
                *out = if load.place < *place { behind } else { *out };
            }
        }
    }

    /// Quantities at a distance from where they are `from`, without loads between.
    fn moved(&self, from: &[f64; QUANTITIES], lever: f64) -> [f64; QUANTITIES] {
        let mut out = *from;
        if let Some(planes) = &self.planes {
            let ends: &[f64; BENT] = from[FIRST..]
                .first_chunk()
                .expect("all quantities but two are bent");
            out[FIRST..].copy_from_slice(&moved(planes, ends, lever));
            return out;
        }
        for (k, value) in out.iter_mut().enumerate() {
            *value += slope_index(k).map_or(0.0, |shear| from[shear] * lever);
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fea::Girder;

    /// Identity: one quantity of many sections is that of each section, without and with an axial force.
    #[test]
    fn a_quantity_of_many_sections_is_that_of_each() {
        let girder = Girder {
            spans: vec![6.0, 5.0],
            e: 7.0,
            i_vertical: 0.4,
            i_lateral: Some(0.3),
            area: Some(2.0),
            ..Girder::default()
        };
        let (mut model, rail) = girder.model_and_rail().expect("the girder is valid");
        let loads = [
            (1.3, [0.5, -3.0, 0.2]),
            (4.0, [0.0, -2.0, 0.0]),
            (7.5, [0.1, -1.0, -0.4]),
        ];
        let loads = loads.map(|(x, force)| RailLoad { rail: 0, x, force });
        for tension in [0.0, 0.05] {
            model
                .members
                .iter_mut()
                .for_each(|member| member.tension = tension);
            let members =
                MemberForces::new(&model, std::slice::from_ref(&rail)).expect("it is stable");
            let mut at = PassedLoads::default();
            for (index, member) in members.members().enumerate() {
                members.load(index, &loads, &mut at);
                let places: Vec<f64> = (0..=20)
                    .map(|k| f64::from(k) / 20.0 * member.length)
                    .collect();
                let mut found = vec![f64::NAN; places.len()];
                for k in 0..QUANTITIES {
                    at.fill(k, &places, &mut found);
                    let each = places.iter().map(|place| at.quantities(*place, None)[k]);
                    assert!(
                        found.iter().copied().eq(each),
                        "quantity {k} of member {index}"
                    );
                }
            }
        }
    }
}
