//! Conversion of a bulk data deck to a structure: card numbers are replaced by indices, and defaults are applied.
//!
//! The steps must run in this order, since later steps use the results of earlier ones:
//! 1. grids: coordinate systems are resolved, and coordinates are transformed to the basic system;
//! 2. points: the grids to which an element, rigid link, mass or spring refers, in the order of their numbers (a grid
//!    that only orients an element does not become a point);
//! 3. members, with the sections and materials that they use (see [`super::section`]);
//! 4. links and masses;
//! 5. supports: permanent constraints of grids and the selected SPC set;
//! 6. springs, whose other end must be ground or a restrained degree of freedom, so that supports must be known;
//! 7. sets of points and members.
//!
//! Errors do not stop the conversion: each is added to the findings with its position, and its card is omitted.

use std::collections::BTreeMap;

use super::deck::BulkDeck;
use super::element::{ElementCard, Orientation, SectionOf as Given};
use super::grid::{self, Resolved};
use super::lump::{SpringCard, Stiffness};
use super::property::Property;
use super::section::SectionTable;
use super::support;
use crate::findings::{FilePlace, ImportFinding, ImportFindings};
use crate::structure::{ImportedMass, ImportedMember, ImportedPoint, ImportedSpring, ImportedStructure};
use fea::{Dof, MemberKind};
use formats::vector::{minus, parallel};

/// A deck and the structure to which it is converted.
struct Resolver<'d, 'f> {
    deck: &'d BulkDeck,
    grids: BTreeMap<u64, Resolved>,
    /// Index of the point of each grid that is used.
    index: BTreeMap<u64, usize>,
    sections: SectionTable,
    structure: ImportedStructure,
    findings: &'f mut ImportFindings,
}

/// Converts a deck to a structure. `empty` has a name and units only; `asked` is the SPC set that the user selected,
/// if any.
pub fn resolve(
    deck: &BulkDeck,
    empty: ImportedStructure,
    asked: Option<u64>,
    findings: &mut ImportFindings,
) -> ImportedStructure {
    let grids = grid::resolve(&deck.grids, deck.defaults, &deck.systems, findings);
    let mut resolver = Resolver {
        deck,
        grids,
        index: BTreeMap::new(),
        sections: SectionTable::default(),
        structure: empty,
        findings,
    };
    resolver.points();
    resolver.members();
    resolver.links();
    resolver.masses();
    resolver.supports(asked);
    resolver.springs();
    resolver.sets();
    resolver.structure
}

impl<'d> Resolver<'d, '_> {
    /// Adds the points in the order of their numbers. Grids to which only an orientation refers are omitted.
    fn points(&mut self) {
        let deck = self.deck;
        let members = deck.elements.values().flat_map(|element| element.grids);
        let links =
            deck.rigid.iter().flat_map(|rigid| rigid.to.iter().chain([&rigid.from]).map(|(grid, _)| *grid));
        let masses = deck.masses.iter().map(|mass| mass.grid);
        let springs =
            deck.springs.iter().flat_map(|spring| spring.ends.iter().flatten().map(|(grid, _)| *grid));
        let mut used: Vec<u64> = members.chain(links).chain(masses).chain(springs).collect();
        used.sort_unstable();
        used.dedup();
        for id in used {
            if let Some(grid) = self.grids.get(&id) {
                self.index.insert(id, self.structure.points.len());
                self.structure.points.push(ImportedPoint { name: format!("GRID {id}"), at: grid.at });
            }
        }
    }

    /// Index of the point of a grid. Returns `None` if the grid does not exist, with an error, or could not be read.
    fn point(&mut self, id: u64, at: FilePlace, about: &str) -> Option<usize> {
        let index = self.index.get(&id).copied();
        // an error has already been added for a grid that exists but could not be read
        if index.is_none() && !self.deck.grids.contains_key(&id) {
            self.findings
                .error(ImportFinding::new(at, about, "refers to a grid that does not exist").with_found(id));
        }
        index
    }

    /// Adds the members, in the order of their numbers.
    fn members(&mut self) {
        let deck = self.deck;
        if deck.elements.is_empty() {
            let finding = ImportFinding::new(FilePlace { line: 1, column: 1, file: 0 }, "", "has no member");
            self.findings.error(finding.hint("supported members are CBAR, CBEAM, CROD and CONROD"));
        }
        for (&id, element) in &deck.elements {
            if let Some(member) = self.member(id, element) {
                self.structure.members.push(member);
            }
        }
    }

    /// Returns the property of an element and the number in the name of its section, or `None`, with an error, if the
    /// property does not exist or has the wrong type for the element.
    fn property(&mut self, id: u64, element: &'d ElementCard, about: &str) -> Option<(u64, &'d Property)> {
        let deck = self.deck;
        let (number, property) = match &element.section {
            Given::Own(property) => (id, property.as_ref()),
            Given::Number(number) => {
                let Some(property) = deck.properties.get(number) else {
                    let finding =
                        ImportFinding::new(element.card, about, "refers to a property that does not exist");
                    self.findings.error(finding.with_found(number));
                    return None;
                };
                (*number, property)
            }
        };
        let fits = match element.kind.as_str() {
            "CBAR" => matches!(property.kind.as_str(), "PBAR" | "PBARL"),
            "CBEAM" => matches!(property.kind.as_str(), "PBEAM" | "PBEAML"),
            _ => matches!(property.kind.as_str(), "PROD" | "CONROD"),
        };
        if !fits {
            let expected = format!("cannot have the property {} {number}", property.kind);
            let hint = "CBAR needs PBAR or PBARL, CBEAM needs PBEAM or PBEAML, CROD needs PROD";
            self.findings.error(ImportFinding::new(element.card, about, expected).hint(hint));
            return None;
        }
        Some((number, property))
    }

    /// Orientation vector of an element whose first grid is at `first`: `Some(None)` for rods, and `None` if the grid
    /// that defines the orientation does not exist (with an error) or could not be read.
    fn orientation(
        &mut self,
        element: &ElementCard,
        first: [f64; 3],
        about: &str,
    ) -> Option<Option<[f64; 3]>> {
        match element.orientation {
            Some(Orientation::Vector(vector)) => Some(Some(vector)),
            Some(Orientation::Grid(grid)) => {
                let Some(there) = self.grids.get(&grid) else {
                    if !self.deck.grids.contains_key(&grid) {
                        let finding = ImportFinding::new(
                            element.card,
                            format!("{about}: G0"),
                            "refers to a grid that does not exist",
                        );
                        self.findings.error(finding.with_found(grid));
                    }
                    return None;
                };
                Some(Some(minus(there.at, first)))
            }
            None => Some(None),
        }
    }

    /// Converts an element to a member; returns `None`, with an error among the findings, if this is not possible.
    fn member(&mut self, id: u64, element: &'d ElementCard) -> Option<ImportedMember> {
        let about = format!("{} {id}", element.kind);
        let [a, b] = element.grids.map(|grid| self.point(grid, element.card, &about));
        let (number, property) = self.property(id, element, &about)?;
        let section = self.section(number, property, "", &about)?;
        let section_b = match &property.end {
            Some(end) => Some(self.section(number, end, " at end B", &about)?),
            None => None,
        };
        let (a, b) = (a?, b?);
        let ends = [a, b].map(|point| self.structure.points[point].at);
        let tip = |end: usize| [0, 1, 2].map(|axis| ends[end][axis] + element.offsets[end][axis]);
        let along = minus(tip(1), tip(0));
        if along == [0.0; 3] {
            let finding =
                ImportFinding::new(element.card, about, "must have a positive length between its ends");
            self.findings.error(finding.hint("its ends coincide after the offsets are added"));
            return None;
        }
        let orientation = self.orientation(element, ends[0], &about)?;
        let bends = property.bending[0] > 0.0;
        if orientation.is_some_and(|vector| parallel(vector, along)) && bends {
            let finding =
                ImportFinding::new(element.card, about, "its orientation must not be zero or along it");
            self.findings.error(finding.hint("X1, X2, X3 or G0 define the side of the local y axis"));
            return None;
        }
        let mut member = ImportedMember {
            id,
            points: [a, b],
            kind: MemberKind::Beam,
            section,
            section_b,
            orientation,
            offsets: element.offsets,
            releases: element.pins,
        };
        use_kind_of(property, &mut member);
        Some(member)
    }

    /// Index of the section of a property (see [`SectionTable::index_of`]).
    fn section(&mut self, number: u64, property: &Property, end: &str, about: &str) -> Option<usize> {
        self.sections.index_of(self.deck, &mut self.structure, self.findings, (number, property), end, about)
    }

    /// Adds the rigid links.
    fn links(&mut self) {
        let deck = self.deck;
        for rigid in &deck.rigid {
            let Some(from) = self.point(rigid.from.0, rigid.from.1, &rigid.label) else { continue };
            for (grid, at) in &rigid.to {
                let Some(to) = self.point(*grid, *at, &rigid.label) else { continue };
                if from == to {
                    self.findings.error(ImportFinding::new(
                        *at,
                        &rigid.label,
                        "must not link a grid to itself",
                    ));
                } else {
                    self.structure.links.push([from, to]);
                }
            }
        }
    }

    /// Adds the masses, scaled by WTMASS.
    fn masses(&mut self) {
        let deck = self.deck;
        let wtmass = deck.wtmass.unwrap_or(1.0);
        for mass in &deck.masses {
            let Some(point) = self.point(mass.grid, mass.at, &mass.label) else { continue };
            let mut offset = mass.offset;
            if mass.absolute {
                offset = minus(offset, self.structure.points[point].at);
            }
            let entry = ImportedMass {
                point,
                mass: mass.mass * wtmass,
                inertia: mass.inertia.map(|value| value * wtmass),
                offset,
            };
            let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
            if finite(&entry.inertia) && finite(&entry.offset) && entry.mass.is_finite() {
                self.structure.masses.push(entry);
            } else {
                self.findings.error(ImportFinding::new(
                    mass.at,
                    &mass.label,
                    "must be a mass within double precision",
                ));
            }
        }
    }

    /// Adds the permanent constraints of grids and the selected SPC sets, and a warning for each set not selected.
    fn supports(&mut self, asked: Option<u64>) {
        let deck = self.deck;
        for (id, grid) in &self.grids {
            if let Some(point) = self.index.get(id)
                && grid.fix.contains(&true)
            {
                self.structure.supports.insert(*point, grid.fix);
            }
        }
        let sets =
            support::chosen(&deck.supports, &deck.adds, asked, deck.controlled, &deck.control, self.findings);
        let mut unused: BTreeMap<u64, FilePlace> = BTreeMap::new();
        for support in &deck.supports {
            if !sets.contains(&support.set) {
                unused.entry(support.set).or_insert(support.card);
                continue;
            }
            let about = format!("SPC set {}", support.set);
            let mut restrained: Vec<usize> = Vec::new();
            for [from, to] in &support.ranges {
                restrained.extend(self.index.range(from..=to).map(|(_, point)| *point));
            }
            for (grid, at) in &support.grids {
                if !deck.grids.contains_key(grid) {
                    self.findings.error(
                        ImportFinding::new(*at, &about, "refers to a grid that does not exist")
                            .with_found(grid),
                    );
                }
                restrained.extend(self.index.get(grid));
            }
            for point in restrained {
                let fixed = self.structure.supports.entry(point).or_default();
                for (dof, fix) in support.fix.iter().enumerate() {
                    fixed[dof] |= fix;
                }
            }
        }
        for (set, at) in unused {
            self.findings.warn(ImportFinding::new(
                at,
                format!("SPC set {set}"),
                "is not the selected set and is left out",
            ));
        }
    }

    /// Adds the springs to ground. One end must be a free degree of freedom of a grid, the other one ground or
    /// restrained. A spring whose ends are all restrained is omitted with a warning.
    fn springs(&mut self) {
        let deck = self.deck;
        for spring in &deck.springs {
            let Some(k) = self.stiffness(spring) else { continue };
            let mut free = Vec::new();
            let mut known = true;
            for (grid, dof) in spring.ends.iter().flatten() {
                match self.point(*grid, spring.card, &spring.label) {
                    Some(point) => {
                        let is_restrained = self.structure.supports.get(&point).is_some_and(|fix| fix[*dof]);
                        if !is_restrained {
                            free.push((point, *dof));
                        }
                    }
                    None => known = false,
                }
            }
            match free.as_slice() {
                _ if !known => {}
                [(point, dof)] => {
                    self.structure.springs.push(ImportedSpring { point: *point, dof: *dof, k });
                }
                [] => {
                    let finding = ImportFinding::new(
                        spring.card,
                        &spring.label,
                        "is left out, because all its ends are restrained",
                    );
                    self.findings.warn(finding);
                }
                _ => {
                    let finding = ImportFinding::new(
                        spring.card,
                        &spring.label,
                        "must have one end at ground or restrained",
                    );
                    self.findings.error(finding.hint("springs between two moving grids are not supported"));
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
            self.findings.error(finding("must have a positive stiffness").with_found(k));
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
        let mut sets: Vec<(String, Vec<usize>)> =
            structure.sections.iter().map(|section| (section.name.clone(), Vec::new())).collect();
        for (index, member) in structure.members.iter().enumerate() {
            sets[member.section].1.push(index);
        }
        sets.retain(|(_, set)| !set.is_empty());
        structure.cell_sets = sets;
    }
}

/// The kind of a member with the stiffnesses of its property: without bending stiffness it is a rod, and without
/// torsional stiffness as well a truss. A member with bending stiffness only is a beam whose section has the J 0.
fn use_kind_of(property: &Property, member: &mut ImportedMember) {
    if property.bending[0] > 0.0 {
        return;
    }
    // releases of what the member does not resist have no effect
    let resisted = if property.j > 0.0 {
        member.kind = MemberKind::Rod;
        [Dof::Ux, Dof::Rx].as_slice()
    } else {
        member.kind = MemberKind::Truss;
        [Dof::Ux].as_slice()
    };
    for pins in &mut member.releases {
        for dof in Dof::ALL.into_iter().filter(|dof| !resisted.contains(dof)) {
            pins[dof as usize] = false;
        }
    }
    member.orientation = None;
}
