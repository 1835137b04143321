//! Conversion of a bulk data deck to a structure: card numbers are replaced by indices, and defaults are applied.
//!
//! The steps must run in this order, since later steps use the results of earlier ones:
//! 1. grids: coordinate systems are resolved, and coordinates are transformed to the basic system;
//! 2. points: the grids to which an element, rigid link, mass or spring refers, in the order of their numbers (a grid
//!    that only orients an element does not become a point);
//! 3. members (see [`super::member`]), with the sections and materials that they use (see [`super::section`]);
//! 4. links of all degrees of freedom, and masses;
//! 5. supports: permanent constraints of grids and the selected SPC set;
//! 6. springs, whose other end must be ground or a restrained degree of freedom, so that supports must be known;
//! 7. links of some degrees of freedom (see [`crate::links`]), whose replacement depends on all of these;
//! 8. the mass of elements, where it is lumped at the ends that they have then (see [`super::lumped`]);
//! 9. sets of points and members.
//!
//! Errors do not stop the conversion: each is added to the findings with its position, and its card is omitted.

use std::collections::BTreeMap;

use super::coordinates::CoordinateSystems;
use super::deck::BulkDeck;
use super::lump::{MassCard, SpringCard, Stiffness};
use super::lumped::{self, MemberMass};
use super::place::{self, Resolved};
use super::section::SectionTable;
use super::support;
use crate::axes::{combined, turned_inertia};
use crate::findings::{FilePlace, ImportFinding, ImportFindings};
use crate::links::{self, PartialLink};
use crate::structure::{
    ImportedMass, ImportedPoint, ImportedSpring, ImportedStructure, MassDistribution,
};
use formats::vector::minus;

/// What the user asks of the conversion.
#[derive(Clone, Copy, Debug)]
pub struct Asked {
    /// The SPC set that supports the structure, if the user selected one.
    pub spc: Option<u64>,
    /// Where the mass of elements acts.
    pub mass: MassDistribution,
    /// Whether the mass of beams acts elsewhere than in the deck, although the user did not ask for it.
    pub moves_mass: bool,
    /// Whether what cannot change the stiffness is left out.
    pub unused: bool,
}

/// A deck and the structure to which it is converted.
pub(super) struct Resolver<'d, 'f> {
    pub(super) deck: &'d BulkDeck,
    pub(super) asked: Asked,
    pub(super) systems: CoordinateSystems<'d>,
    pub(super) grids: BTreeMap<u64, Resolved>,
    /// Index of the point of each grid that is used.
    pub(super) index: BTreeMap<u64, usize>,
    pub(super) sections: SectionTable,
    /// Mass of each member.
    pub(super) member_masses: Vec<MemberMass>,
    /// Links of some degrees of freedom, with the positions and names of their cards.
    pub(super) partial: Vec<(PartialLink, FilePlace, String)>,
    pub(super) structure: ImportedStructure,
    pub(super) findings: &'f mut ImportFindings,
}

/// Converts a deck to a structure. `empty` has a name and units only.
pub fn resolve(
    deck: &BulkDeck,
    empty: ImportedStructure,
    asked: Asked,
    findings: &mut ImportFindings,
) -> ImportedStructure {
    let mut systems = CoordinateSystems::new(&deck.systems, &deck.grids, deck.defaults);
    let grids = place::resolve(&deck.grids, deck.defaults, &mut systems, findings);
    let mut resolver = Resolver {
        deck,
        asked,
        systems,
        grids,
        index: BTreeMap::new(),
        sections: SectionTable::new(asked.mass),
        member_masses: Vec::new(),
        partial: Vec::new(),
        structure: empty,
        findings,
    };
    resolver.points();
    resolver.members();
    resolver.links();
    resolver.masses();
    resolver.supports(asked.spc);
    resolver.springs();
    resolver.partial_links();
    if asked.mass != MassDistribution::Distributed {
        lumped::add(
            &mut resolver.structure,
            &resolver.member_masses,
            asked.mass,
            resolver.findings,
        );
    }
    resolver.sets();
    let mut structure = resolver.structure;
    structure.moves_mass = asked.moves_mass && structure.has_beams_with_mass();
    structure
}

impl<'d> Resolver<'d, '_> {
    /// Adds the points in the order of their numbers. Grids to which only an orientation refers are omitted.
    fn points(&mut self) {
        let deck = self.deck;
        let members = deck.elements.values().flat_map(|element| element.grids);
        let links = deck
            .rigid
            .iter()
            .flat_map(|rigid| rigid.to.iter().chain([&rigid.from]).map(|(grid, _)| *grid));
        let masses = deck.masses.iter().map(|mass| mass.grid);
        let springs = deck
            .springs
            .iter()
            .flat_map(|spring| spring.ends.iter().flatten().map(|(grid, _)| *grid));
        let mut used: Vec<u64> = members.chain(links).chain(masses).chain(springs).collect();
        used.sort_unstable();
        used.dedup();
        for id in used {
            if let Some(grid) = self.grids.get(&id) {
                self.index.insert(id, self.structure.points.len());
                self.structure.points.push(ImportedPoint {
                    name: format!("GRID {id}"),
                    at: grid.at,
                });
            }
        }
    }

    /// Index of the point of a grid. Returns `None` if the grid does not exist, with an error, or could not be read.
    pub(super) fn point(&mut self, id: u64, at: FilePlace, about: &str) -> Option<usize> {
        let index = self.index.get(&id).copied();
        // an error has already been added for a grid that exists but could not be read
        if index.is_none() && !self.deck.grids.contains_key(&id) {
            self.findings.error(
                ImportFinding::new(at, about, "refers to a grid that does not exist")
                    .with_found(id),
            );
        }
        index
    }

    /// Adds the rigid links.
    fn links(&mut self) {
        let deck = self.deck;
        for rigid in &deck.rigid {
            let Some(from) = self.point(rigid.from.0, rigid.from.1, &rigid.label) else {
                continue;
            };
            for (grid, at) in &rigid.to {
                let Some(to) = self.point(*grid, *at, &rigid.label) else {
                    continue;
                };
                if from == to {
                    self.findings.error(ImportFinding::new(
                        *at,
                        &rigid.label,
                        "must not link a grid to itself",
                    ));
                } else if rigid.set == [true; 6] {
                    self.structure.links.push([from, to]);
                } else {
                    let set = self
                        .grids
                        .get(grid)
                        .and_then(|grid| grid.global(&rigid.set));
                    match set {
                        Some(set) => self.partial.push((
                            PartialLink { from, to, set },
                            *at,
                            rigid.label.clone(),
                        )),
                        None => self.refuse_skew(*at, &rigid.label),
                    }
                }
            }
        }
    }

    /// Adds the error of components that are along directions other than the global axes.
    fn refuse_skew(&mut self, at: FilePlace, about: &str) {
        let expected =
            "must act along the global axes, but the displacement system of the grid is rotated";
        let hint = "supports, springs and links of a beam spec act along the global axes";
        self.findings
            .error(ImportFinding::new(at, about, expected).hint(hint));
    }

    /// Adds the links of some degrees of freedom.
    fn partial_links(&mut self) {
        let all: Vec<PartialLink> = self.partial.iter().map(|(link, ..)| *link).collect();
        for (link, at, label) in std::mem::take(&mut self.partial) {
            if !links::add(&mut self.structure, link, &all) {
                let expected =
                    "must connect all degrees of freedom, or be equivalent to a hinge or a support";
                let hint = "a hinge has a single beam at the dependent grid; a support has a fixed independent grid";
                self.findings
                    .error(ImportFinding::new(at, label, expected).hint(hint));
            }
        }
    }

    /// Adds the masses, scaled by WTMASS.
    fn masses(&mut self) {
        let deck = self.deck;
        let wtmass = deck.wtmass.unwrap_or(1.0);
        for mass in &deck.masses {
            let Some(point) = self.point(mass.grid, mass.at, &mass.label) else {
                continue;
            };
            let Some((offset, inertia)) = self.mass_axes(mass, point) else {
                continue;
            };
            let entry = ImportedMass {
                point,
                mass: mass.mass * wtmass,
                inertia: inertia.map(|value| value * wtmass),
                offset,
            };
            let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
            if finite(&entry.inertia) && finite(&entry.offset) && entry.mass.is_finite() {
                self.structure.masses.push(entry);
            } else {
                self.findings.error(ImportFinding::new(
                    mass.at,
                    &mass.label,
                    "must have a mass within the range of double precision",
                ));
            }
        }
    }

    /// Vector to the centre of a mass and its moments of inertia, in global axes; `None`, with an error, if the system of
    /// the mass cannot be used or its inertia has products.
    fn mass_axes(&mut self, mass: &MassCard, point: usize) -> Option<([f64; 3], [f64; 3])> {
        if mass.absolute {
            let offset = minus(mass.offset, self.structure.points[point].at);
            return self
                .principal(mass, mass.inertia)
                .map(|inertia| (offset, inertia));
        }
        let frame = self.systems.frame(
            mass.system,
            mass.at,
            &format!("{}: CID", mass.label),
            self.findings,
        )?;
        let has_direction = mass.offset != [0.0; 3] || mass.inertia != [[0.0; 3]; 3];
        if !frame.is_rectangular() && has_direction {
            let expected = "must be specified in a rectangular coordinate system";
            self.findings
                .error(ImportFinding::new(mass.at, &mass.label, expected));
            return None;
        }
        let inertia = self.principal(mass, turned_inertia(&frame.axes(), &mass.inertia))?;
        Some((combined(&frame.axes(), mass.offset), inertia))
    }

    /// The moments of inertia about the global axes. Products of inertia are an error, or are left out with a warning if
    /// the user asked for this.
    fn principal(&mut self, mass: &MassCard, matrix: [[f64; 3]; 3]) -> Option<[f64; 3]> {
        let largest = matrix
            .iter()
            .flatten()
            .fold(0.0, |most: f64, part| most.max(part.abs()));
        let products = [matrix[0][1], matrix[0][2], matrix[1][2]];
        if products
            .iter()
            .any(|product| product.abs() > 1e-12 * largest)
        {
            let about = format!("{}: I21", mass.label);
            if self.asked.unused {
                let message = "is ignored, as are I31 and I32: products of inertia do not affect the stiffness";
                self.findings
                    .warn(ImportFinding::new(mass.at, about, message));
            } else {
                let expected = "must be 0 in the global axes, as must I31 and I32";
                let hint = "a beam spec has no products of inertia; --skip-unused ignores them";
                self.findings
                    .error(ImportFinding::new(mass.at, about, expected).hint(hint));
                return None;
            }
        }
        Some([0, 1, 2].map(|axis| matrix[axis][axis].max(0.0)))
    }

    /// Adds the permanent constraints of grids and the selected SPC sets, and a warning for each set not selected.
    fn supports(&mut self, asked: Option<u64>) {
        let deck = self.deck;
        let mut skew = Vec::new();
        for (id, grid) in &self.grids {
            if let Some(point) = self.index.get(id)
                && grid.fix.contains(&true)
            {
                match grid.global(&grid.fix) {
                    Some(fix) => {
                        self.structure.supports.insert(*point, fix);
                    }
                    None => skew.push(*id),
                }
            }
        }
        for id in skew {
            let at = deck
                .grids
                .get(&id)
                .map_or(FilePlace::default(), |grid| grid.card);
            self.refuse_skew(at, &format!("GRID {id}: PS"));
        }
        let sets = support::chosen(
            &deck.supports,
            &deck.adds,
            asked,
            deck.controlled,
            &deck.control,
            self.findings,
        );
        let mut unused: BTreeMap<u64, FilePlace> = BTreeMap::new();
        for support in &deck.supports {
            if !sets.contains(&support.set) {
                unused.entry(support.set).or_insert(support.card);
                continue;
            }
            let about = format!("SPC set {}", support.set);
            let mut restrained: Vec<(u64, usize, FilePlace)> = Vec::new();
            for [from, to] in &support.ranges {
                let inside = self.index.range(from..=to);
                restrained.extend(inside.map(|(grid, point)| (*grid, *point, support.card)));
            }
            for (grid, at) in &support.grids {
                if !deck.grids.contains_key(grid) {
                    self.findings.error(
                        ImportFinding::new(*at, &about, "refers to a grid that does not exist")
                            .with_found(grid),
                    );
                }
                restrained.extend(self.index.get(grid).map(|point| (*grid, *point, *at)));
            }
            for (grid, point, at) in restrained {
                let Some(set) = self
                    .grids
                    .get(&grid)
                    .and_then(|grid| grid.global(&support.fix))
                else {
                    self.refuse_skew(at, &about);
                    continue;
                };
                let fixed = self.structure.supports.entry(point).or_default();
                for (dof, fix) in set.iter().enumerate() {
                    fixed[dof] |= fix;
                }
            }
        }
        for (set, at) in unused {
            self.findings.warn(ImportFinding::new(
                at,
                format!("SPC set {set}"),
                "is not selected and is ignored",
            ));
        }
    }

    /// Adds the springs to ground. One end must be a free degree of freedom of a grid, the other one ground or
    /// restrained. A spring whose ends are all restrained is omitted with a warning.
    fn springs(&mut self) {
        let deck = self.deck;
        for spring in &deck.springs {
            let Some(k) = self.stiffness(spring) else {
                continue;
            };
            let mut free = Vec::new();
            let mut known = true;
            for (grid, component) in spring.ends.iter().flatten() {
                let point = self.point(*grid, spring.card, &spring.label);
                let global = self
                    .grids
                    .get(grid)
                    .map(|grid| grid.global_component(*component));
                match (point, global) {
                    (Some(point), Some(Some((dof, _)))) => {
                        let is_restrained = self
                            .structure
                            .supports
                            .get(&point)
                            .is_some_and(|fix| fix[dof]);
                        if !is_restrained {
                            free.push((point, dof));
                        }
                    }
                    (Some(_), Some(None)) => {
                        self.refuse_skew(spring.card, &spring.label);
                        known = false;
                    }
                    _ => known = false,
                }
            }
            match free.as_slice() {
                _ if !known => {}
                [(point, dof)] => {
                    self.structure.springs.push(ImportedSpring {
                        point: *point,
                        dof: *dof,
                        k,
                    });
                }
                [] => {
                    let finding = ImportFinding::new(
                        spring.card,
                        &spring.label,
                        "is ignored, because it has no free end",
                    );
                    self.findings.warn(finding);
                }
                _ => {
                    let finding = ImportFinding::new(
                        spring.card,
                        &spring.label,
                        "must have one end grounded or restrained",
                    );
                    self.findings
                        .error(finding.hint("springs between two free grids are not supported"));
                }
            }
        }
    }

    /// The stiffness of a spring; `None`, with an error, if its PELAS does not exist or the stiffness is not
    /// positive.
    fn stiffness(&mut self, spring: &SpringCard) -> Option<f64> {
        let finding = |expected: &str| ImportFinding::new(spring.card, &spring.label, expected);
        let k = match spring.stiffness {
            Stiffness::Own(k) => k,
            Stiffness::Number(number) => {
                let Some((_, k)) = self.deck.stiffness.get(&number) else {
                    let missing = finding("refers to a PELAS that does not exist");
                    self.findings.error(missing.with_found(number));
                    return None;
                };
                *k
            }
        };
        if k <= 0.0 {
            self.findings
                .error(finding("must have a positive stiffness").with_found(k));
            return None;
        }
        Some(k)
    }

    /// Adds a set for each point, so that messages can refer to its grid, and a set of the members of each section.
    fn sets(&mut self) {
        let structure = &mut self.structure;
        structure.point_sets = structure
            .points
            .iter()
            .enumerate()
            .map(|(index, point)| (point.name.clone(), vec![index]))
            .collect();
        let mut sets: Vec<(String, Vec<usize>)> = structure
            .sections
            .iter()
            .map(|section| (section.name.clone(), Vec::new()))
            .collect();
        for (index, member) in structure.members.iter().enumerate() {
            sets[member.section].1.push(index);
        }
        sets.retain(|(_, set)| !set.is_empty());
        structure.cell_sets = sets;
    }
}
