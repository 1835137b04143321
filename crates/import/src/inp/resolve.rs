//! Conversion of an Abaqus model to a structure: numbers and names are replaced by indices.
//!
//! Points are the nodes to which an element or a joint refers, in the order of their numbers. Members follow, then what
//! acts at points: supports, springs and masses; joints come last, because what replaces a pinned one depends on all
//! of these. Errors do not stop the conversion: each is added to the findings with its position.

use std::collections::{BTreeMap, BTreeSet};

use super::keyword::InpField;
use super::model::{InpElement, InpKind, InpModel, Joint};
use super::section::{InpSection, MaterialOf};
use super::values::key_of;
use crate::axes::LocalAxes;
use crate::findings::{FilePlace, ImportFinding, ImportFindings};
use crate::links::{self, PartialLink};
use crate::structure::{
    ImportedMass, ImportedMaterial, ImportedMember, ImportedPoint, ImportedSection, ImportedSpring,
    ImportedStructure,
};
use fea::MemberKind;
use formats::vector::{minus, parallel};

struct Resolver<'m, 'f> {
    model: &'m InpModel,
    /// Index of the point of each node that is used.
    index: BTreeMap<u64, usize>,
    /// Index of the section of each element, in the structure and in the file.
    section_of: BTreeMap<u64, [usize; 2]>,
    structure: ImportedStructure,
    findings: &'f mut ImportFindings,
}

/// Converts a model to a structure. `empty` has a name and units only.
pub fn resolve(
    model: &InpModel,
    empty: ImportedStructure,
    findings: &mut ImportFindings,
) -> ImportedStructure {
    let mut resolver =
        Resolver { model, index: BTreeMap::new(), section_of: BTreeMap::new(), structure: empty, findings };
    resolver.points();
    resolver.assign_sections();
    resolver.members();
    resolver.releases();
    resolver.supports();
    resolver.springs_and_masses();
    resolver.joints();
    resolver.sets();
    resolver.structure
}

impl Resolver<'_, '_> {
    fn points(&mut self) {
        let model = self.model;
        let mut used: BTreeSet<u64> = BTreeSet::new();
        for element in model.elements.values() {
            let count = if matches!(element.kind, InpKind::Beam { .. } | InpKind::Truss) { 2 } else { 1 };
            used.extend(element.nodes.iter().take(count));
        }
        for joint in &model.joints {
            for target in [&joint.followers, &joint.leader] {
                used.extend(InpModel::targets(
                    &model.node_sets,
                    &model.nodes,
                    target,
                    "joint",
                    self.findings,
                ));
            }
        }
        for number in used {
            if let Some(at) = model.nodes.get(&number) {
                self.index.insert(number, self.structure.points.len());
                self.structure.points.push(ImportedPoint { name: format!("node {number}"), at: *at });
            }
        }
    }

    fn point(&mut self, number: u64, at: FilePlace, about: &str) -> Option<usize> {
        let found = self.index.get(&number).copied();
        if found.is_none() {
            let finding = ImportFinding::new(at, about, "refers to a node that does not exist");
            self.findings.error(finding.with_found(number));
        }
        found
    }

    /// Adds the sections with their materials, and assigns them to elements.
    fn assign_sections(&mut self) {
        let model = self.model;
        for (place, section) in model.sections.iter().enumerate() {
            let Some(material) = self.material(section) else { continue };
            let about = format!("{}: ELSET", section.label);
            let elements =
                InpModel::targets(&model.element_sets, &model.elements, &section.set, &about, self.findings);
            let is_cubic = |number: &u64| {
                let kind = model.elements.get(number).map(|element| element.kind);
                kind == Some(InpKind::Beam { sheared: false })
            };
            let is_rigid_in_shear = !elements.is_empty() && elements.iter().all(is_cubic);
            let index = self.structure.sections.len();
            let numbers = section.numbers;
            // principal second moments of I12; the axes are turned in `members`
            let mean = 0.5 * (numbers.iz + numbers.iy);
            let radius = (0.5 * (numbers.iz - numbers.iy)).hypot(numbers.product);
            let [iz, iy] = if numbers.product == 0.0 {
                [numbers.iz, numbers.iy]
            } else {
                [mean + radius, mean - radius]
            };
            let beam = |value: f64| section.is_beam.then_some(value);
            let g = self
                .structure
                .materials
                .iter()
                .find(|known| known.name == material)
                .and_then(|known| known.g);
            let [shear_y, shear_z] = match (section.shear_stiffness, g) {
                _ if is_rigid_in_shear => [None; 2],
                (Some(stiffness), Some(g)) => stiffness.map(|value| Some(value / g)),
                _ => [beam(numbers.k * numbers.area); 2],
            };
            let positive = [Some(numbers.area), beam(iy), beam(iz), beam(numbers.j), shear_y, shear_z];
            if positive.iter().flatten().any(|value| !value.is_finite() || *value <= 0.0) {
                let expected = "must have properties within double precision";
                self.findings.error(ImportFinding::new(section.set.at, &section.label, expected));
                continue;
            }
            let name = format!("{} {}", section.set.text, index + 1);
            self.structure.sections.push(ImportedSection {
                name,
                material,
                area: Some(numbers.area),
                iy: beam(iy),
                iz: beam(iz),
                j: beam(numbers.j),
                shear_y: beam(1.0).and(shear_y),
                shear_z: beam(1.0).and(shear_z),
            });
            for number in elements {
                if self.section_of.insert(number, [index, place]).is_some() {
                    let finding =
                        ImportFinding::new(section.set.at, &about, "must not assign a second section");
                    self.findings.error(finding.with_found(format!("element {number}")));
                }
            }
        }
    }

    /// The name of the material of a section, which is added to the structure.
    fn material(&mut self, section: &InpSection) -> Option<String> {
        let (name, e, g, density) = match &section.material {
            MaterialOf::Own([e, g, density]) => {
                let name = format!("material of {} {}", section.set.text, self.structure.sections.len() + 1);
                (name, *e, *g, (*density > 0.0).then_some(*density))
            }
            MaterialOf::Named(wanted) => {
                let known =
                    self.model.materials.iter().find(|known| key_of(&known.name) == key_of(&wanted.text));
                let about = format!("{}: MATERIAL", section.label);
                let Some(material) = known else {
                    let finding = ImportFinding::new(wanted.at, about, "must be the name of a *MATERIAL");
                    self.findings.error(finding.with_found(&wanted.text));
                    return None;
                };
                let Some([e, nu]) = material.elastic else {
                    let expected = "needs *ELASTIC";
                    self.findings.error(ImportFinding::new(material.at, "*MATERIAL", expected));
                    return None;
                };
                (material.name.clone(), e, e / (2.0 * (1.0 + nu)), material.density)
            }
        };
        if !(g.is_finite() && g > 0.0) {
            let expected = "must lead to moduli within double precision";
            self.findings.error(ImportFinding::new(section.set.at, &section.label, expected));
            return None;
        }
        if self.structure.materials.iter().all(|known| known.name != name) {
            self.structure.materials.push(ImportedMaterial { name: name.clone(), e, g: Some(g), density });
        }
        Some(name)
    }

    fn members(&mut self) {
        let model = self.model;
        let mut count = 0;
        for (&number, element) in &model.elements {
            if matches!(element.kind, InpKind::Beam { .. } | InpKind::Truss) {
                count += 1;
                self.member(number, element);
            }
        }
        if count == 0 {
            let at = FilePlace { file: 0, line: 1, column: 1 };
            let finding = ImportFinding::new(at, "", "has no member");
            self.findings.error(finding.hint("supported members are B31, B33 and T3D2"));
        }
    }

    fn member(&mut self, number: u64, element: &InpElement) -> Option<()> {
        let about = format!("element {number}");
        let &[a, b, ..] = element.nodes.as_slice() else { return None };
        let (a, b) = (self.point(a, element.at, &about), self.point(b, element.at, &about));
        let (a, b) = (a?, b?);
        let along = minus(self.structure.points[b].at, self.structure.points[a].at);
        if along == [0.0; 3] {
            self.findings.error(ImportFinding::new(element.at, about, "must have a positive length"));
            return None;
        }
        let Some(&[section, place]) = self.section_of.get(&number) else {
            let finding = ImportFinding::new(element.at, "element", "must have a section");
            let hint = "assign *BEAM SECTION or *SOLID SECTION to a set with the element; a file without sections needs --sections";
            self.findings.error(finding.hint(hint));
            return None;
        };
        let given = &self.model.sections[place];
        let is_beam = matches!(element.kind, InpKind::Beam { .. });
        if given.is_beam != is_beam {
            let expected = "must have *BEAM SECTION for beams and *SOLID SECTION for trusses";
            self.findings.error(ImportFinding::new(element.at, about, expected));
            return None;
        }
        let (n1, product) = (given.n1, given.numbers);
        let orientation = if is_beam { Some(self.orientation(element, n1, along, &about)?) } else { None };
        let orientation = orientation.map(|n1| {
            let turn = 0.5 * (2.0 * product.product).atan2(product.iz - product.iy);
            match LocalAxes::new(along, n1) {
                Some(axes) if product.product != 0.0 => axes.vector([0.0, turn.cos(), turn.sin()]),
                _ => n1,
            }
        });
        let section = if matches!(element.kind, InpKind::Beam { sheared: false }) {
            self.rigid_in_shear(section)
        } else {
            section
        };
        self.structure.members.push(ImportedMember {
            id: number,
            points: [a, b],
            kind: if is_beam { MemberKind::Beam } else { MemberKind::Truss },
            section,
            section_b: None,
            orientation,
            offsets: [[0.0; 3]; 2],
            releases: [[false; 6]; 2],
        });
        Some(())
    }

    /// The section without shear areas, for beams of Euler and Bernoulli that share it with others.
    fn rigid_in_shear(&mut self, section: usize) -> usize {
        let of = &self.structure.sections[section];
        if of.shear_y.is_none() {
            return section;
        }
        let name = format!("{}, rigid in shear", of.name);
        if let Some(known) = self.structure.sections.iter().position(|known| known.name == name) {
            return known;
        }
        let copy = ImportedSection { name, shear_y: None, shear_z: None, ..of.clone() };
        self.structure.sections.push(copy);
        self.structure.sections.len() - 1
    }

    /// The direction of the 1-axis of a beam: to its third node, or that of its section.
    fn orientation(
        &mut self,
        element: &InpElement,
        n1: [f64; 3],
        along: [f64; 3],
        about: &str,
    ) -> Option<[f64; 3]> {
        let direction = match element.nodes.as_slice() {
            [first, _, third] => match (self.model.nodes.get(first), self.model.nodes.get(third)) {
                (Some(first), Some(third)) => minus(*third, *first),
                _ => {
                    let finding =
                        ImportFinding::new(element.at, about, "refers to a node that does not exist");
                    self.findings.error(finding.with_found(third));
                    return None;
                }
            },
            _ => n1,
        };
        if parallel(direction, along) {
            let finding =
                ImportFinding::new(element.at, about, "its n1 direction must not be zero or along it");
            let hint = "state n1 in the second data line of its section; the default is 0, 0, -1";
            self.findings.error(finding.hint(hint));
            return None;
        }
        Some(direction)
    }

    fn releases(&mut self) {
        let model = self.model;
        for release in &model.releases {
            let numbers = InpModel::targets(
                &model.element_sets,
                &model.elements,
                &release.target,
                "*RELEASE",
                self.findings,
            );
            let numbers: BTreeSet<u64> = numbers.into_iter().collect();
            let beams = self.structure.members.iter_mut().filter(|member| member.kind == MemberKind::Beam);
            for member in beams.filter(|member| numbers.contains(&member.id)) {
                for (dof, released) in release.release.iter().enumerate() {
                    member.releases[release.end][dof] |= released;
                }
            }
        }
        // the axes of a section with a product of inertia are turned, so that single rotations are not about them
        let turned: Vec<u64> = self
            .structure
            .members
            .iter()
            .filter(|member| {
                let place = self.section_of.get(&member.id).map(|[_, place]| *place);
                let is_turned = place.is_some_and(|place| model.sections[place].numbers.product != 0.0);
                is_turned && member.releases.iter().any(|release| release[4] != release[5])
            })
            .map(|member| member.id)
            .collect();
        for number in turned {
            let at = model.elements.get(&number).map_or(FilePlace::default(), |element| element.at);
            let expected = "must be released in both planes or none, because its section has I12";
            self.findings.error(ImportFinding::new(at, format!("element {number}"), expected));
        }
    }

    fn supports(&mut self) {
        let model = self.model;
        for boundary in &model.boundaries {
            let numbers = InpModel::targets(
                &model.node_sets,
                &model.nodes,
                &boundary.target,
                "*BOUNDARY",
                self.findings,
            );
            for point in numbers.iter().filter_map(|number| self.index.get(number)) {
                let support = self.structure.supports.entry(*point).or_default();
                for (dof, fix) in boundary.fix.iter().enumerate() {
                    support[dof] |= fix;
                }
            }
        }
    }

    /// Points of the elements of one kind in a set.
    fn points_of(&mut self, set: &InpField, kind: InpKind, about: &str) -> Vec<usize> {
        let model = self.model;
        let numbers = InpModel::targets(&model.element_sets, &model.elements, set, about, self.findings);
        let elements = numbers.iter().filter_map(|number| model.elements.get(number));
        let of_kind: Vec<&InpElement> = elements.filter(|element| element.kind == kind).collect();
        of_kind.iter().filter_map(|element| self.point(*element.nodes.first()?, element.at, about)).collect()
    }

    fn springs_and_masses(&mut self) {
        let model = self.model;
        for spring in &model.springs {
            let &[dof, k] = spring.values.as_slice() else { continue };
            for point in self.points_of(&spring.set, InpKind::Spring, "*SPRING") {
                self.structure.springs.push(ImportedSpring { point, dof: dof as usize - 1, k });
            }
        }
        let mut masses: BTreeMap<usize, ImportedMass> = BTreeMap::new();
        let empty = |point| ImportedMass { point, mass: 0.0, inertia: [0.0; 3], offset: [0.0; 3] };
        for mass in &model.masses {
            let own = mass.values.first().copied().unwrap_or_default();
            for point in self.points_of(&mass.set, InpKind::Mass, "*MASS") {
                masses.entry(point).or_insert(empty(point)).mass += own;
            }
        }
        for inertia in &model.inertias {
            for point in self.points_of(&inertia.set, InpKind::Rotary, "*ROTARY INERTIA") {
                let entry = masses.entry(point).or_insert(empty(point));
                entry.inertia.iter_mut().zip(&inertia.values).for_each(|(sum, own)| *sum += own);
            }
        }
        if masses
            .values()
            .any(|mass| !mass.mass.is_finite() || mass.inertia.iter().any(|part| !part.is_finite()))
        {
            let at = FilePlace { file: 0, line: 1, column: 1 };
            self.findings.error(ImportFinding::new(at, "*MASS", "must have sums within double precision"));
        }
        self.structure.masses.extend(masses.into_values());
    }

    fn joints(&mut self) {
        let model = self.model;
        for request in &model.joints {
            let leaders =
                InpModel::targets(&model.node_sets, &model.nodes, &request.leader, "joint", self.findings);
            let &[leader] = leaders.as_slice() else {
                let expected = "must be joined to one node";
                self.findings.error(ImportFinding::new(request.leader.at, "joint", expected));
                continue;
            };
            let followers =
                InpModel::targets(&model.node_sets, &model.nodes, &request.followers, "joint", self.findings);
            for follower in followers.into_iter().filter(|follower| *follower != leader) {
                let about = format!("joint of node {follower}");
                let from = self.point(leader, request.leader.at, &about);
                let to = self.point(follower, request.followers.at, &about);
                let (Some(from), Some(to)) = (from, to) else { continue };
                self.join(request.joint, [from, to], request.followers.at, &about);
            }
        }
    }

    fn join(&mut self, joint: Joint, [from, to]: [usize; 2], at: FilePlace, about: &str) {
        let coincide = self.structure.points[from].at == self.structure.points[to].at;
        match joint {
            Joint::Tied if !coincide => {
                let finding = ImportFinding::new(at, about, "must join nodes at one place");
                self.findings.error(finding.hint("*MPC BEAM joins nodes at a distance"));
            }
            Joint::Rigid | Joint::Tied => self.structure.links.push([from, to]),
            Joint::Pinned => {
                let set = [true, true, true, false, false, false];
                if !links::add(&mut self.structure, PartialLink { from, to, set }) {
                    let expected = "must be rigid, or be replaceable by a hinge or a support";
                    let hint = "a hinge has one beam at the node that follows; a support has a fixed node that leads";
                    self.findings.error(ImportFinding::new(at, about, expected).hint(hint));
                }
            }
        }
    }

    /// Adds the sets of the file as far as they contain points and members, and a set for each point.
    fn sets(&mut self) {
        let model = self.model;
        let structure = &mut self.structure;
        for (index, point) in structure.points.iter().enumerate() {
            structure.point_sets.push((point.name.clone(), vec![index]));
        }
        let members: BTreeMap<u64, usize> =
            structure.members.iter().enumerate().map(|(index, member)| (member.id, index)).collect();
        let indices = |numbers: Vec<u64>, of: &BTreeMap<u64, usize>| {
            numbers.iter().filter_map(|number| of.get(number).copied()).collect::<Vec<usize>>()
        };
        for set in model.node_sets.iter() {
            structure.point_sets.push((set.name.clone(), indices(set.numbers(&self.index), &self.index)));
        }
        for set in model.element_sets.iter() {
            structure.cell_sets.push((set.name.clone(), indices(set.numbers(&members), &members)));
        }
        structure.point_sets.retain(|(_, set)| !set.is_empty());
        structure.cell_sets.retain(|(_, set)| !set.is_empty());
    }
}
