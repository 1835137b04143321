//! A deck as a structure: numbers become indices, defaults become values.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use super::deck::BulkDeck;
use super::element::{ElementCard, Orientation, SectionOf as Given};
use super::grid::{self, Resolved};
use super::lump::Stiffness;
use super::property::Property;
use super::support;
use crate::PARTS;
use crate::findings::{FilePlace, ImportFinding, ImportFindings};
use crate::structure::{
    ImportedMass, ImportedMaterial, ImportedMember, ImportedPoint, ImportedSection, ImportedSpring,
    ImportedStructure,
};
use formats::vector::{minus, parallel};

/// What a deck becomes, step by step.
struct Resolver<'d, 'f> {
    deck: &'d BulkDeck,
    grids: BTreeMap<u64, Resolved>,
    index: BTreeMap<u64, usize>,
    /// Index of the section of each property in use; true for that at end B.
    sections: BTreeMap<(u64, bool), usize>,
    /// Names of the materials written.
    materials: Vec<String>,
    structure: ImportedStructure,
    findings: &'f mut ImportFindings,
}

/// Makes a structure of a deck; `empty` has its name and units, `asked` is the set of supports that the user chose.
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
        sections: BTreeMap::new(),
        materials: Vec::new(),
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

impl Resolver<'_, '_> {
    /// Points in the order of their numbers: grids that something but an orientation needs.
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

    /// The index of a grid that exists.
    fn point(&mut self, id: u64, at: FilePlace, about: &str) -> Option<usize> {
        let index = self.index.get(&id).copied();
        // a grid that could not be read has its own error
        if index.is_none() && !self.deck.grids.contains_key(&id) {
            self.findings.error(ImportFinding::new(at, about, "names a grid that is not there").got(id));
        }
        index
    }

    fn members(&mut self) {
        let deck = self.deck;
        if deck.elements.is_empty() {
            let finding = ImportFinding::new(FilePlace { line: 1, column: 1, file: 0 }, "", "has no member");
            self.findings.error(finding.hint("members are CBAR, CBEAM, CROD and CONROD"));
        }
        for (&id, element) in &deck.elements {
            if let Some(member) = self.member(id, element) {
                self.structure.members.push(member);
            }
        }
    }

    fn member(&mut self, id: u64, element: &ElementCard) -> Option<ImportedMember> {
        let about = format!("{} {id}", element.kind);
        let [a, b] = element.grids.map(|grid| self.point(grid, element.card, &about));
        let deck = self.deck;
        let (number, property) = match &element.section {
            Given::Own(property) => (id, property.as_ref()),
            Given::Number(number) => {
                let Some(property) = deck.properties.get(number) else {
                    let finding =
                        ImportFinding::new(element.card, about, "names a property that is not there");
                    self.findings.error(finding.got(number));
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
            let hint = "CBAR takes PBAR and PBARL, CBEAM takes PBEAM and PBEAML, CROD takes PROD";
            self.findings.error(ImportFinding::new(element.card, about, expected).hint(hint));
            return None;
        }
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
            let finding = ImportFinding::new(element.card, about, "must have a length between its ends");
            self.findings.error(finding.hint("its ends coincide, offsets included"));
            return None;
        }
        let orientation = match element.orientation {
            Some(Orientation::Vector(vector)) => Some(vector),
            Some(Orientation::Grid(grid)) => {
                let Some(there) = self.grids.get(&grid) else {
                    if !deck.grids.contains_key(&grid) {
                        let finding = ImportFinding::new(
                            element.card,
                            format!("{about}: G0"),
                            "names a grid that is not there",
                        );
                        self.findings.error(finding.got(grid));
                    }
                    return None;
                };
                Some(minus(there.at, ends[0]))
            }
            None => None,
        };
        let bends = property.bending[0] > 0.0;
        if orientation.is_some_and(|vector| parallel(vector, along)) && bends {
            let finding =
                ImportFinding::new(element.card, about, "its orientation must not be zero or along it");
            self.findings.error(finding.hint("X1, X2, X3 or G0 give the side of the local y axis"));
            return None;
        }
        let mut member = ImportedMember {
            id,
            points: [a, b],
            truss: false,
            section,
            section_b,
            orientation,
            offsets: element.offsets,
            releases: element.pins,
        };
        self.kind(&mut member, property, along);
        Some(member)
    }

    /// What a member without some stiffness becomes: releases that take the same out of a beam, or a truss.
    fn kind(&mut self, member: &mut ImportedMember, property: &Property, along: [f64; 3]) {
        let bends = property.bending[0] > 0.0;
        let twists = property.j > 0.0;
        if !bends && !twists {
            member.truss = true;
            // a bar of no bending has no use for pins, but for those that take its force away
            member.releases.iter_mut().for_each(|pins| pins[1..].fill(false));
            member.orientation = None;
        } else if !bends {
            for pins in &mut member.releases {
                pins[4] = true;
                pins[5] = true;
            }
            let least = (0..3).min_by(|a, b| along[*a].abs().total_cmp(&along[*b].abs())).unwrap_or(0);
            let mut across = [0.0; 3];
            across[least] = 1.0;
            member.orientation = Some(across);
        } else if !twists && !member.releases.iter().any(|pins| pins[3]) {
            member.releases[0][3] = true;
        }
    }

    /// The section of a property, written when it is first used.
    /// `end`: what its name says of the end that it is for.
    fn section(&mut self, number: u64, property: &Property, end: &str, about: &str) -> Option<usize> {
        // CONROD has its element's number, which may be that of a property too
        let key = if property.kind == "CONROD" { None } else { Some((number, !end.is_empty())) };
        if let Some(index) = key.and_then(|key| self.sections.get(&key)) {
            return Some(*index);
        }
        let name = format!("{} {number}", property.kind);
        let Some(found) = self.deck.materials.get(&property.material) else {
            let finding =
                ImportFinding::new(property.card, format!("{name}: MID"), "must be the number of a MAT1");
            self.findings.error(finding.got(property.material));
            return None;
        };
        let [i1, i2] = property.bending;
        let bends = i1 > 0.0;
        let sheared = bends && property.shear.iter().any(|k| *k > 0.0);
        if found.g.is_none() && (property.j > 0.0 || sheared) {
            let expected = format!("is missing, and {name} of {about} needs it");
            let finding = ImportFinding::new(found.card, format!("MAT1 {}: G", property.material), expected);
            self.findings.error(finding.hint("give G, or NU"));
            return None;
        }
        if bends && property.j == 0.0 {
            let finding = ImportFinding::new(
                property.card,
                &name,
                "has no J: its members turn freely about their axes",
            );
            self.findings.warn(finding.hint("taken as a release of rx; the J written is a placeholder"));
        }
        if !bends && property.j > 0.0 {
            let finding = ImportFinding::new(
                property.card,
                &name,
                "has J: its rods are taken as beams hinged at both ends",
            );
            self.findings.warn(finding.hint("the Iy and Iz written are placeholders"));
        }
        if property.end.is_some() {
            let expected = format!("is tapered, and solved in {PARTS} uniform parts a member");
            self.findings.warn(
                ImportFinding::new(property.card, &name, expected)
                    .hint("`parts` of the spec may say another number"),
            );
        }
        let wtmass = self.deck.wtmass.unwrap_or(1.0);
        let mut density = found.density * wtmass;
        let mut material = format!("MAT1 {}", property.material);
        if property.nsm > 0.0 {
            density += property.nsm * wtmass / property.area;
            material = format!("{material} and NSM of {name}");
        }
        if !density.is_finite() {
            self.findings.error(ImportFinding::new(
                property.card,
                &name,
                "must have a mass that a double can hold",
            ));
            return None;
        }
        if !self.materials.contains(&material) {
            self.materials.push(material.clone());
            let density = (density > 0.0).then_some(density);
            let (e, g) = (found.e, found.g);
            self.structure.materials.push(ImportedMaterial { name: material.clone(), e, g, density });
        }
        let round = property.area * property.area / (4.0 * PI);
        let bending = |i: f64| if bends { Some(i) } else { (property.j > 0.0).then_some(round) };
        let torsion = if property.j > 0.0 { Some(property.j) } else { bends.then_some(i1 + i2) };
        let shear = |k: f64| (bends && k > 0.0).then_some(k * property.area);
        let section = ImportedSection {
            name: format!("{name}{end}"),
            material,
            area: Some(property.area),
            iy: bending(i2),
            iz: bending(i1),
            j: torsion,
            shear_y: shear(property.shear[0]),
            shear_z: shear(property.shear[1]),
        };
        let numbers = [section.iy, section.iz, section.j, section.shear_y, section.shear_z];
        if numbers.iter().flatten().any(|value| !value.is_finite() || *value <= 0.0) {
            self.findings.error(ImportFinding::new(
                property.card,
                &name,
                "must have properties that a double can hold",
            ));
            return None;
        }
        let index = self.structure.sections.len();
        self.structure.sections.push(section);
        if let Some(key) = key {
            self.sections.insert(key, index);
        }
        Some(index)
    }

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
                    "must be a mass that a double can hold",
                ));
            }
        }
    }

    /// Own supports of the grids, and the sets that are chosen.
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
            support::chosen(&deck.holds, &deck.adds, asked, deck.controlled, &deck.control, self.findings);
        let mut idle: BTreeMap<u64, FilePlace> = BTreeMap::new();
        for hold in &deck.holds {
            if !sets.contains(&hold.set) {
                idle.entry(hold.set).or_insert(hold.card);
                continue;
            }
            let about = format!("SPC set {}", hold.set);
            let mut held: Vec<usize> = Vec::new();
            for [from, to] in &hold.ranges {
                held.extend(self.index.range(from..=to).map(|(_, point)| *point));
            }
            for (grid, at) in &hold.grids {
                if !deck.grids.contains_key(grid) {
                    self.findings
                        .error(ImportFinding::new(*at, &about, "names a grid that is not there").got(grid));
                }
                held.extend(self.index.get(grid));
            }
            for point in held {
                let support = self.structure.supports.entry(point).or_default();
                for (freedom, fix) in hold.fix.iter().enumerate() {
                    support[freedom] |= fix;
                }
            }
        }
        for (set, at) in idle {
            self.findings.warn(ImportFinding::new(
                at,
                format!("SPC set {set}"),
                "is not the one chosen, and left out",
            ));
        }
    }

    /// Springs whose other end is ground, or a freedom that is held.
    fn springs(&mut self) {
        let deck = self.deck;
        for spring in &deck.springs {
            let k = match spring.stiffness {
                Stiffness::Own(k) => k,
                Stiffness::Number(number) => match deck.stiffness.get(&number) {
                    Some((_, k)) => *k,
                    None => {
                        let finding =
                            ImportFinding::new(spring.card, &spring.label, "names a PELAS that is not there");
                        self.findings.error(finding.got(number));
                        continue;
                    }
                },
            };
            if k <= 0.0 {
                let finding =
                    ImportFinding::new(spring.card, &spring.label, "must have a positive stiffness");
                self.findings.error(finding.got(k));
                continue;
            }
            let mut free = Vec::new();
            let mut known = true;
            for (grid, freedom) in spring.ends.iter().flatten() {
                match self.point(*grid, spring.card, &spring.label) {
                    Some(point) => {
                        let held = self.structure.supports.get(&point).is_some_and(|fix| fix[*freedom]);
                        if !held {
                            free.push((point, *freedom));
                        }
                    }
                    None => known = false,
                }
            }
            match free.as_slice() {
                _ if !known => {}
                [(point, freedom)] => {
                    self.structure.springs.push(ImportedSpring { point: *point, freedom: *freedom, k });
                }
                [] => {
                    let finding =
                        ImportFinding::new(spring.card, &spring.label, "left out: all its ends are held");
                    self.findings.warn(finding);
                }
                _ => {
                    let finding = ImportFinding::new(
                        spring.card,
                        &spring.label,
                        "must have one end at ground, or held",
                    );
                    self.findings.error(finding.hint("springs between two moving grids cannot be taken"));
                }
            }
        }
    }

    /// A set for each point, so that messages can name it, and one for each section.
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
