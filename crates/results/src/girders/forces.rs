//! The largest and smallest forces of sections over a run, and those beside the loads.
//!
//! At the nodes of a piece the forces of a member follow from the influence lines of its end, by equilibrium with the loads on it
//! ([`MemberForces`]). In the piece the force of a section is the polynomial through these values. Where a load passes the section
//! within the piece there are two polynomials, of which each extends one side of the passage to the other; the force is the one up
//! to the time of the passage, and the other behind it. Beside a load that moves the forces are a polynomial on either side of it.
//!
//! A bound of what the loads of a stay can cause in a member follows from bounds of its influence lines in their cells. Stays are
//! taken in the order of their bounds; one whose bound is below the largest and smallest values of all sections is left out.

use design::{FibreStress, Fibres};
use piecewise::{Lobatto, Polynomial};
use smallvec::SmallVec;
use trains::{PassedLoads, RailLoad, SectionSide};

use super::distributed::{FORCES, Quantities, SLOPES};
use super::fibres::DIRECT;
use super::girder::LoadedGirders;
use super::member_lines::{AlongMember, MemberLines, bounds_at, size_along};
use super::value::{GirderValue, floor, floors, offer, offer_values, side_of};
use crate::pieces::{Bounds, LoadState, Part, Peak, SIGNS, WHOLE, known, offer_part, offer_piece};

/// Factor by which the change of a distributed force inside of a range may exceed that to its ends.
const STEEPER: f64 = 1.5;

/// Distance from a section, relative to the length of the member, within which a load rests at it.
const AT_REST: f64 = 1e-9;

/// Relative distance from the ends of a part of a piece within which another passage is at them.
const AT_END: f64 = 1e-12;

/// The largest values of sections and beside loads.
pub(super) struct ForcePeaks {
    /// By section and quantity: the largest and the smallest value, without dead load.
    pub sections: Vec<[[Peak; 2]; FORCES]>,
    /// By span of all rails and quantity: the largest and smallest values beside loads, with dead load.
    pub beside: Vec<[[Option<GirderValue>; 2]; FORCES]>,
    /// By stressed section: the largest magnitude of its stress.
    pub stresses: Vec<Option<GirderValue>>,
    /// Index of the first span of each rail.
    pub first_span: Vec<usize>,
}

/// What is looked for in a stay.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Wanted {
    quantities: [bool; FORCES],
    stresses: bool,
}

/// Indices in the order of decreasing values.
pub(super) fn by_rank(values: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
    order
}

/// Largest stress under forces of these magnitudes, of any signs.
fn largest_stress(fibres: &Fibres, [n, v, l]: [f64; 3]) -> f64 {
    let signs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let of = |[a, b]: [f64; 2]| stress(fibres, [n, a * v, b * l]);
    signs.into_iter().map(of).fold(0.0, f64::max)
}

/// Magnitude of the largest stress under forces.
pub(super) fn stress(fibres: &Fibres, forces: [f64; 3]) -> f64 {
    fibres
        .worst(forces)
        .map_or(0.0, |worst| worst.value().abs())
}

/// One member, whose sections are searched.
struct MemberSearch<'a> {
    girders: &'a LoadedGirders<'a>,
    member: usize,
    length: f64,
    /// Index of its rail in the list of rails.
    rail: usize,
    acting: [bool; FORCES],
    has_loads: bool,
    fibres: Option<(usize, &'a Fibres)>,
    /// Forces of dead load at its sections.
    dead: Vec<Quantities>,
}

/// Values at the nodes of a piece, of one quantity and of all.
type Values = SmallVec<[f64; 17]>;
type AllValues = SmallVec<[Quantities; 17]>;

/// A load that stands on the member, with its distances from the first end at the nodes.
struct Standing {
    index: usize,
    places: Values,
    range: Bounds,
}

impl Standing {
    fn new(index: usize, places: Values) -> Standing {
        Standing {
            index,
            range: Bounds::through(places.iter().copied()),
            places,
        }
    }

    /// Whether it may pass a section.
    fn passes(&self, place: f64) -> bool {
        self.range.contains(place)
    }
}

/// The states at the nodes of a piece, and the member under their loads.
struct PieceStates<'a> {
    index: usize,
    nodes: &'static Lobatto,
    states: Vec<LoadState<'a>>,
    passed: &'a [PassedLoads],
}

impl ForcePeaks {
    /// Searches the sections of all members; the forces beside loads, and stresses, only if `has_loads`.
    pub fn new(girders: &LoadedGirders<'_>, has_loads: bool) -> ForcePeaks {
        let sections = girders.sections;
        let mut first_span = vec![0];
        for rail in &sections.rails {
            first_span.push(first_span[first_span.len() - 1] + rail.ends.len() + 1);
        }
        let mut out = ForcePeaks {
            sections: vec![[[Peak::NONE; 2]; FORCES]; sections.sections.len()],
            beside: vec![Default::default(); first_span[first_span.len() - 1]],
            stresses: vec![
                None;
                if has_loads {
                    sections.stressed.all.len()
                } else {
                    0
                }
            ],
            first_span,
        };
        let acting = girders.acting();
        for (member, own) in girders.members.members().enumerate() {
            let rail = sections.rails.iter().position(|rail| rail.rail == own.rail);
            let Some(rail) = rail else { continue };
            if !has_loads && sections.of_member[member].is_empty() {
                continue;
            }
            let dead = sections.places[member].iter();
            let search = MemberSearch {
                girders,
                member,
                length: own.length,
                rail,
                acting,
                has_loads,
                fibres: sections.stressed.of(member).filter(|_| has_loads),
                dead: dead
                    .map(|place| girders.distributed.dead(member, *place))
                    .collect(),
            };
            search.run(&MemberLines::new(girders, member), &mut out);
        }
        out
    }

    /// The largest of sign times a force with dead load at a section.
    pub fn section(
        &self,
        girders: &LoadedGirders<'_>,
        at: usize,
        quantity: usize,
        kind: usize,
    ) -> Option<GirderValue> {
        let peak = &self.sections[at][quantity][kind];
        let section = &girders.sections.sections[at];
        let dead = girders.distributed.dead(section.member, section.place)[quantity];
        (peak.signed > f64::NEG_INFINITY).then(|| GirderValue {
            signed: peak.signed + SIGNS[kind] * dead,
            at: peak.at,
            x: girders.sections.points[section.point].x,
            section: Some((section.member, section.place)),
            own: peak.own,
            side: side_of(section.side, quantity, peak.own),
        })
    }
}

impl MemberSearch<'_> {
    /// Searches all stays that may have larger values than those that are known.
    fn run(&self, lines: &MemberLines<'_>, peaks: &mut ForcePeaks) {
        let pieces = self.girders.pieces;
        let all: Vec<Option<AlongMember>> =
            pieces.stays.iter().map(|stay| lines.bounds(stay)).collect();
        let most: Quantities = std::array::from_fn(|k| {
            all.iter()
                .flatten()
                .map(|own| size_along(own, k))
                .fold(0.0, f64::max)
        });
        let rank = |own: &Option<AlongMember>| {
            let Some(own) = own else { return f64::INFINITY };
            let acting = (0..FORCES).filter(|k| self.acting[*k] && most[*k] > 0.0);
            acting
                .map(|k| size_along(own, k) / most[k])
                .fold(0.0, f64::max)
        };
        let of_dead = self.fibres.map_or(0.0, |(_, fibres)| {
            let each = self
                .dead
                .iter()
                .map(|own| stress(fibres, DIRECT.map(|k| own[k])));
            each.fold(0.0, f64::max)
        });
        let mut memory = Vec::new();
        for stay in by_rank(&all.iter().map(rank).collect::<Vec<f64>>()) {
            let wanted = self.wanted(all[stay].as_ref(), of_dead, peaks);
            if wanted == Wanted::default() {
                continue;
            }
            if (self.girders.is_stopped)() {
                return;
            }
            for piece in pieces.stays[stay].pieces() {
                if self.may_exceed(lines, piece, wanted, (&mut memory, peaks)) {
                    let states = self.states(piece, &mut memory);
                    self.search(&states, wanted, peaks);
                }
            }
        }
    }

    /// What may exceed the values that are known of all sections, by bounds along the member; all without bounds.
    fn wanted(&self, along: Option<&AlongMember>, of_dead: f64, peaks: &ForcePeaks) -> Wanted {
        let sections = self.girders.sections;
        let own = &sections.of_member[self.member];
        let Some(along) = along else {
            return Wanted {
                quantities: self.acting,
                stresses: self.fibres.is_some(),
            };
        };
        let exceeds = |k: usize| {
            let all = || own.iter().map(|at| known(&peaks.sections[*at][k]));
            let most = all().flatten().fold(0.0, f64::max);
            let mut each = all().zip(&sections.places[self.member]);
            each.any(|(known, place)| {
                !bounds_at(along, k, place / self.length).is_within(known, most)
            })
        };
        let of_stress = |(index, fibres): (usize, &Fibres)| {
            let known = peaks.stresses[index].map_or(0.0, |known| known.signed);
            of_dead + largest_stress(fibres, DIRECT.map(|k| size_along(along, k))) > known
        };
        Wanted {
            quantities: std::array::from_fn(|k| self.acting[k] && exceeds(k)),
            stresses: self.fibres.is_some_and(of_stress),
        }
    }

    /// Whether a piece may have larger or smaller values than those that are known, by the values in its middle.
    fn may_exceed(
        &self,
        lines: &MemberLines<'_>,
        index: usize,
        wanted: Wanted,
        (memory, peaks): (&mut Vec<PassedLoads>, &ForcePeaks),
    ) -> bool {
        let (girders, member) = (self.girders, self.member);
        if girders.members.is_bent(member) {
            return true;
        }
        let sections = girders.sections;
        let (own, places) = (&sections.of_member[member], &sections.places[member]);
        let middle = girders.pieces.at_middle(index);
        let standing = self.standing(index, &middle);
        if standing
            .iter()
            .any(|(_, range)| places.iter().any(|place| range.contains(*place)))
        {
            return true;
        }
        memory.resize(1.max(memory.len()), PassedLoads::default());
        let passed = &mut memory[0];
        girders.members.load(member, &middle.loads, passed);
        let changes = lines.changes(girders.pieces, index);
        let exceeds = |value: f64, change: f64, known: [f64; 2]| {
            !Bounds::at(value).widened(change).is_within(known, 0.0)
        };
        let is_stressed = |total: Quantities, changes: &Quantities| {
            let of = |(index, fibres): (usize, &Fibres)| {
                let known = peaks.stresses[index].map_or(0.0, |known| known.signed);
                stress(fibres, DIRECT.map(|k| total[k]))
                    + largest_stress(fibres, DIRECT.map(|k| changes[k]))
                    > known
            };
            wanted.stresses && self.fibres.is_some_and(of)
        };
        for (s, (section, place)) in own.iter().zip(places).enumerate() {
            let forces = self.with_inertia(*place, &middle, passed.quantities(*place, None));
            let mut quantities = (0..FORCES).filter(|k| wanted.quantities[*k]);
            if quantities
                .any(|k| exceeds(forces[k], changes[k], known(&peaks.sections[*section][k])))
                || is_stressed(
                    std::array::from_fn(|k| forces[k] + self.dead[s][k]),
                    &changes,
                )
            {
                return true;
            }
        }
        standing
            .iter()
            .filter(|_| self.has_loads)
            .any(|(load, range)| {
                let place = 0.5 * (range.low + range.high);
                let moved = 0.5 * (range.high - range.low);
                // what is distributed changes along the member
                let along = |place: f64| {
                    let dead = girders.distributed.dead(member, place);
                    self.with_inertia(place, &middle, dead)
                };
                let ends = [along(range.low), along(range.high)];
                let own = along(place);
                [false, true].into_iter().any(|is_behind| {
                    let concentrated = passed.quantities(place, Some((*load, is_behind)));
                    let total: Quantities = std::array::from_fn(|k| concentrated[k] + own[k]);
                    let mut changes = changes;
                    for (k, change) in changes.iter_mut().enumerate() {
                        let apart = ends.iter().map(|end| (end[k] - own[k]).abs());
                        *change += STEEPER * apart.fold(0.0, f64::max);
                    }
                    for (moment, shear) in SLOPES {
                        changes[moment as usize] += moved * concentrated[shear as usize].abs();
                    }
                    let span = self.span_at(place, peaks);
                    let known = |k: usize| known(&floors(&peaks.beside[span][k]));
                    let mut acting = (0..FORCES).filter(|k| self.acting[*k]);
                    acting.any(|k| exceeds(total[k], changes[k], known(k)))
                        || is_stressed(total, &changes)
                })
            })
    }

    /// The loads on the member during a piece, with the ranges of their distances from its first end.
    fn standing(&self, index: usize, middle: &LoadState<'_>) -> SmallVec<[(usize, Bounds); 4]> {
        let changes = self.girders.pieces.changes(index).iter();
        let all = middle.loads.iter().zip(changes).enumerate();
        let acting = all.filter(|(_, (_, change))| change.bounds.iter().any(|own| !own.is_zero()));
        let on = acting.filter_map(|(load, (own, change))| {
            let at = |x: f64| {
                self.girders
                    .members
                    .stands(self.member, &RailLoad { x, ..*own })
            };
            let middle = at(own.x)?;
            let ends = [own.x - change.place, own.x + change.place];
            let ends = ends.map(|x| at(x).unwrap_or(middle));
            Some((
                load,
                Bounds {
                    low: ends[0].min(ends[1]),
                    high: ends[0].max(ends[1]),
                },
            ))
        });
        on.collect()
    }

    /// Index of the span in which a place of the member lies, among those of all rails. Near an end of the member it is that of its
    /// side.
    fn span_at(&self, place: f64, peaks: &ForcePeaks) -> usize {
        let outline = &self.girders.sections.rails[self.rail];
        let x = self.girders.members.coordinate(self.member, place);
        let is_first = self
            .girders
            .members
            .members()
            .nth(self.member)
            .is_some_and(|member| x - member.x[0] < member.x[1] - x);
        let side = if is_first {
            SectionSide::Behind
        } else {
            SectionSide::Before
        };
        peaks.first_span[self.rail] + outline.span(x, side)
    }

    fn states<'s>(&'s self, index: usize, memory: &'s mut Vec<PassedLoads>) -> PieceStates<'s> {
        let pieces = self.girders.pieces;
        let piece = &pieces.pieces[index];
        let states: Vec<LoadState<'_>> = (0..=piece.degree)
            .map(|k| pieces.at_node(piece, k))
            .collect();
        memory.resize(states.len().max(memory.len()), PassedLoads::default());
        for (state, passed) in states.iter().zip(&mut *memory) {
            self.girders.members.load(self.member, &state.loads, passed);
        }
        let passed = &memory[..states.len()];
        PieceStates {
            index,
            nodes: piece.nodes(),
            states,
            passed,
        }
    }

    fn search(&self, at: &PieceStates<'_>, wanted: Wanted, peaks: &mut ForcePeaks) {
        // loads on the member, with their distances from its first end
        let mut standing: SmallVec<[Standing; 4]> = SmallVec::new();
        for load in 0..at.states[0].loads.len() {
            let places: Option<Values> = at
                .states
                .iter()
                .map(|state| self.girders.members.stands(self.member, &state.loads[load]))
                .collect();
            let acts = at
                .states
                .iter()
                .any(|state| state.loads[load].force != [0.0; 3]);
            standing.extend(
                places
                    .filter(|_| acts)
                    .map(|places| Standing::new(load, places)),
            );
        }
        self.search_sections(at, &standing, wanted, peaks);
        for own in standing.iter().filter(|_| self.has_loads) {
            for is_behind in [false, true] {
                self.search_beside(at, own, is_behind, peaks);
            }
        }
    }

    fn search_sections(
        &self,
        at: &PieceStates<'_>,
        standing: &[Standing],
        wanted: Wanted,
        peaks: &mut ForcePeaks,
    ) {
        let sections = self.girders.sections;
        let (own, places) = (
            &sections.of_member[self.member],
            &sections.places[self.member],
        );
        let (count, nodes) = (places.len(), at.states.len());
        let is_passed = |place: &f64| standing.iter().any(|load| load.passes(*place));
        let free: SmallVec<[bool; 32]> = places.iter().map(|place| !is_passed(place)).collect();
        // node by node
        let mut inertia: Vec<Quantities> = Vec::new();
        if self.girders.distributed.is_moved(self.member) {
            for state in &at.states {
                let accelerations = state.accelerations();
                let of = |place: &f64| {
                    self.girders
                        .distributed
                        .inertia(self.member, *place, accelerations)
                };
                inertia.extend(places.iter().map(of));
            }
        }
        let is_stressed = wanted.stresses;
        let mut all = vec![[0.0; FORCES]; if is_stressed { count * nodes } else { 0 }];
        let mut values = vec![0.0; count * nodes];
        let needed = |k: &usize| wanted.quantities[*k] || (is_stressed && DIRECT.contains(k));
        for k in (0..FORCES).filter(needed) {
            for (passed, values) in at.passed.iter().zip(values.chunks_mut(count.max(1))) {
                passed.fill(k, places, values);
            }
            let each = values.iter_mut().zip(&inertia);
            each.for_each(|(sum, inertia)| *sum += inertia[k]);
            let bounds = Bounds::of_columns(&values, count);
            for (s, section) in own.iter().enumerate().filter(|(s, _)| free[*s]) {
                let peaks = &mut peaks.sections[*section][k];
                if !bounds[s].is_within(known(peaks), 0.0) {
                    let values: Values = (0..nodes).map(|n| values[n * count + s]).collect();
                    offer_piece(peaks, (at.index, at.nodes), &values);
                }
            }
            all.iter_mut()
                .zip(&values)
                .for_each(|(all, value)| all[k] = *value);
        }
        for (s, section) in own.iter().enumerate() {
            if !free[s] {
                self.search_passed(at, (s, *section), standing, peaks);
            } else if is_stressed {
                let values = (0..nodes).map(|n| all[n * count + s]).collect();
                let found = self.at_section(s, *section);
                self.offer_stress(at, self.with_dead(s, values), WHOLE, &found, peaks);
            }
        }
    }

    /// A section that loads pass in a piece.
    fn search_passed(
        &self,
        at: &PieceStates<'_>,
        (s, section): (usize, usize),
        standing: &[Standing],
        peaks: &mut ForcePeaks,
    ) {
        let place = self.girders.sections.places[self.member][s];
        // the loads that pass it with their distances behind it, and when they do
        let mut passing: SmallVec<[(usize, Polynomial); 4]> = SmallVec::new();
        let mut times: SmallVec<[(f64, usize); 4]> = SmallVec::new();
        for load in standing.iter().filter(|load| load.passes(place)) {
            let distances: Values = load.places.iter().map(|own| own - place).collect();
            let distance = at.nodes.polynomial(&distances);
            times.extend(
                distance
                    .roots()
                    .into_iter()
                    .map(|share| (share, load.index)),
            );
            passing.push((load.index, distance));
        }
        let mut ends: SmallVec<[f64; 6]> = times.iter().map(|time| time.0).collect();
        ends.extend([0.0, 1.0]);
        ends.sort_by(f64::total_cmp);
        ends.dedup_by(|b, a| *b - *a <= AT_END);
        for ends in ends.windows(2).map(|pair| [pair[0], pair[1]]) {
            let middle = 0.5 * (ends[0] + ends[1]);
            // a load that rests at the section has it on either side
            let rests =
                |distance: &Polynomial| Bounds::of(distance).size() <= AT_REST * self.length;
            let is_at_rest = passing.iter().any(|(_, distance)| rests(distance));
            let sides: &[bool] = if is_at_rest { &[false, true] } else { &[false] };
            for resting in sides {
                let behind: SmallVec<[(usize, bool); 4]> = passing
                    .iter()
                    .map(|(load, distance)| match rests(distance) {
                        true => (*load, *resting),
                        false => (*load, distance.value(middle) < 0.0),
                    })
                    .collect();
                let side =
                    |load: usize| behind.iter().find(|(passing, _)| *passing == load).copied();
                let own = ends.map(|end| {
                    let is_here = |share: f64| (share - end).abs() <= AT_END;
                    let at_end = times.iter().find(|(share, _)| is_here(*share));
                    at_end.and_then(|(_, load)| side(*load))
                });
                let part = Part { ends, own };
                self.search_side(at, (s, section), &behind, part, peaks);
            }
        }
    }

    /// A section in a part of a piece in which the loads that pass it are behind it, or not.
    fn search_side(
        &self,
        at: &PieceStates<'_>,
        (s, section): (usize, usize),
        behind: &[(usize, bool)],
        part: Part,
        peaks: &mut ForcePeaks,
    ) {
        let place = self.girders.sections.places[self.member][s];
        let of_node = |(passed, state): (&PassedLoads, &LoadState<'_>)| {
            let forces = passed.quantities_behind(place, &|load, own| {
                let known = behind.iter().find(|(passing, _)| *passing == load);
                known.map_or(own < place, |(_, is_behind)| *is_behind)
            });
            self.with_inertia(place, state, forces)
        };
        let values: AllValues = at.passed.iter().zip(&at.states).map(of_node).collect();
        for k in (0..FORCES).filter(|k| self.acting[*k]) {
            let values: Values = values.iter().map(|own| own[k]).collect();
            let peaks = &mut peaks.sections[section][k];
            offer_part(peaks, (at.index, at.nodes), &values, part);
        }
        let found = self.at_section(s, section);
        self.offer_stress(at, self.with_dead(s, values), part, &found, peaks);
    }

    /// Just before or just behind a load on the member, with dead load.
    fn search_beside(
        &self,
        at: &PieceStates<'_>,
        load: &Standing,
        is_behind: bool,
        peaks: &mut ForcePeaks,
    ) {
        let (girders, own) = (self.girders, Some((load.index, is_behind)));
        let of_node = |(node, place): (usize, &f64)| {
            let forces = at.passed[node].quantities(*place, own);
            let dead = girders.distributed.dead(self.member, *place);
            let forces = self.with_inertia(*place, &at.states[node], forces);
            std::array::from_fn(|k| forces[k] + dead[k])
        };
        let values: AllValues = load.places.iter().enumerate().map(of_node).collect();
        let path = at.nodes.polynomial(&load.places);
        // a load on another rail of the same member stands opposite to a section of this one
        let found = |peak: &Peak, quantity: Option<usize>| {
            let place = path.value(peak.at.share);
            GirderValue {
                signed: peak.signed,
                at: peak.at,
                x: girders.members.coordinate(self.member, place),
                section: Some((self.member, place)),
                own,
                side: quantity.map_or(SectionSide::At, |k| side_of(SectionSide::At, k, own)),
            }
        };
        let span = self.span_at(path.value(0.5), peaks);
        for k in (0..FORCES).filter(|k| self.acting[*k]) {
            let values: Values = values.iter().map(|own| own[k]).collect();
            let known = &mut peaks.beside[span][k];
            let piece = (at.index, at.nodes);
            offer_values(known, piece, &values, &|best| found(best, Some(k)));
        }
        self.offer_stress(at, values, WHOLE, &|peak| found(peak, None), peaks);
    }

    fn with_inertia(&self, place: f64, state: &LoadState<'_>, forces: Quantities) -> Quantities {
        let more = self
            .girders
            .distributed
            .inertia(self.member, place, state.accelerations());
        std::array::from_fn(|k| forces[k] + more[k])
    }

    /// Values at a section with its dead load.
    fn with_dead(&self, s: usize, mut values: AllValues) -> AllValues {
        for own in &mut values {
            own.iter_mut()
                .zip(&self.dead[s])
                .for_each(|(sum, dead)| *sum += dead);
        }
        values
    }

    /// A value at a section of the member.
    fn at_section(&self, s: usize, section: usize) -> impl Fn(&Peak) -> GirderValue {
        let sections = self.girders.sections;
        let own = sections.sections[section];
        let (x, place) = (
            sections.points[own.point].x,
            sections.places[self.member][s],
        );
        let member = self.member;
        move |peak| GirderValue {
            signed: peak.signed,
            at: peak.at,
            x,
            section: Some((member, place)),
            own: peak.own,
            side: own.side,
        }
    }

    /// Offers the stresses under the forces at the nodes of a piece, fibre by fibre.
    fn offer_stress(
        &self,
        at: &PieceStates<'_>,
        values: AllValues,
        part: Part,
        found: &dyn Fn(&Peak) -> GirderValue,
        peaks: &mut ForcePeaks,
    ) {
        let Some((index, fibres)) = self.fibres else {
            return;
        };
        let known = &mut peaks.stresses[index];
        let forces = || values.iter().map(|own| DIRECT.map(|k| own[k]));
        let most = forces().map(|own| stress(fibres, own)).fold(0.0, f64::max);
        // a polynomial is below twice its largest value at the nodes
        if 2.0 * most <= known.map_or(0.0, |known| known.signed) {
            return;
        }
        let of_fibres = |own| fibres.all(own).iter().map(FibreStress::value).collect();
        let all: Vec<Vec<f64>> = forces().map(of_fibres).collect();
        for fibre in 0..all[0].len() {
            let values: Values = all.iter().map(|own| own[fibre]).collect();
            let mut best = [floor(known); 2];
            offer_part(&mut best, (at.index, at.nodes), &values, part);
            for best in best.iter().filter(|best| best.is_new) {
                offer(known, found(best));
            }
        }
    }
}
