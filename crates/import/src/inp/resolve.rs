//! Conversion of an Abaqus model to a structure: numbers and names are replaced by indices.
//!
//! Points are the nodes to which an element or a joint refers, in the order of their numbers. Members follow, then what
//! acts at points: supports, springs and masses; joints come last, because what replaces a pinned one depends on all
//! of these. Errors do not stop the conversion: each is added to the findings with its position.

use std::collections::{BTreeMap, BTreeSet};

use super::keyword::InpField;
use super::model::{InpElement, InpKind, InpModel, Joint};
use super::values::number_of;
use crate::axes::LocalAxes;
use crate::findings::{FilePlace, ImportFinding, ImportFindings, no_members};
use crate::halves::{check_straight, push_halves};
use crate::links::{self, PartialLink};
use crate::structure::{
    ImportedMass, ImportedMember, ImportedPoint, ImportedSpring, ImportedStructure, MASS_RANGE,
};
use fea::MemberKind;
use formats::text::number::number;
use formats::vector::{minus, parallel};

pub(super) struct Resolver<'m, 'f> {
    pub(super) model: &'m InpModel,
    /// Index of the point of each node that is used.
    pub(super) index: BTreeMap<u64, usize>,
    /// Middle nodes of trusses that cannot be left out.
    held_middles: BTreeSet<u64>,
    /// Index of the section of each element, in the structure and in the file.
    pub(super) section_of: BTreeMap<u64, [usize; 2]>,
    /// Stiffness of each spring along the line between its nodes, and the index of its *SPRING.
    pub(super) stiffness_of: BTreeMap<u64, (f64, usize)>,
    pub(super) structure: ImportedStructure,
    pub(super) findings: &'f mut ImportFindings,
}

/// Converts a model to a structure. `empty` has a name and units only.
pub fn resolve(
    model: &InpModel,
    empty: ImportedStructure,
    findings: &mut ImportFindings,
) -> ImportedStructure {
    let mut resolver = Resolver {
        model,
        index: BTreeMap::new(),
        held_middles: BTreeSet::new(),
        section_of: BTreeMap::new(),
        stiffness_of: BTreeMap::new(),
        structure: empty,
        findings,
    };
    resolver.points();
    resolver.held_middles = resolver.held_middles();
    resolver.assign_sections();
    resolver.assign_springs();
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
            let count = if element.kind.is_member() { 2 } else { 1 };
            used.extend(element.nodes.iter().take(count));
            used.extend(
                element
                    .middle
                    .filter(|_| matches!(element.kind, InpKind::Beam { .. })),
            );
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
                self.structure.points.push(ImportedPoint {
                    name: format!("node {number}"),
                    at: *at,
                });
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

    fn members(&mut self) {
        let model = self.model;
        let mut count = 0;
        for (&number, element) in &model.elements {
            if element.kind.is_member() {
                count += 1;
                self.member(number, element);
            }
        }
        if count == 0 {
            let at = FilePlace {
                file: 0,
                line: 1,
                column: 1,
            };
            let finding = ImportFinding::new(at, "", no_members(&model.others));
            self.findings
                .error(finding.hint("supported members are B31, B32, B33, T3D2, T3D3 and SPRINGA"));
        }
    }

    fn member(&mut self, number: u64, element: &InpElement) -> Option<()> {
        let about = format!("element {number}");
        let &[a, b, ..] = element.nodes.as_slice() else {
            return None;
        };
        let (a, b) = (
            self.point(a, element.at, &about),
            self.point(b, element.at, &about),
        );
        let (a, b) = (a?, b?);
        let along = minus(self.structure.points[b].at, self.structure.points[a].at);
        if along == [0.0; 3] {
            self.findings.error(ImportFinding::new(
                element.at,
                about,
                "must have a positive length",
            ));
            return None;
        }
        let middle = match element.middle {
            Some(middle) => self.middle(middle, element, [a, b], &about)?,
            None => None,
        };
        if element.kind == InpKind::AxialSpring {
            let section = self.spring_section(number, element, along)?;
            self.structure.members.push(ImportedMember {
                id: number,
                points: [a, b],
                kind: MemberKind::Truss,
                section,
                section_b: None,
                orientation: None,
                offsets: [[0.0; 3]; 2],
                releases: [[false; 6]; 2],
            });
            return Some(());
        }
        let Some(&[section, place]) = self.section_of.get(&number) else {
            let finding = ImportFinding::new(element.at, "element", "must have a section");
            let hint = "assign *BEAM SECTION or *SOLID SECTION to a set that contains the element; a file without \
                        sections requires --sections";
            self.findings.error(finding.hint(hint));
            return None;
        };
        let given = &self.model.sections[place];
        let is_beam = matches!(element.kind, InpKind::Beam { .. });
        if given.is_beam != is_beam {
            let expected =
                "must have *BEAM SECTION if it is a beam, *SOLID SECTION if it is a truss";
            self.findings
                .error(ImportFinding::new(element.at, about, expected));
            return None;
        }
        let (n1, product) = (given.n1, given.numbers);
        let orientation = if is_beam {
            Some(self.orientation(element, n1, along, &about)?)
        } else {
            None
        };
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
        let member = ImportedMember {
            id: number,
            points: [a, b],
            kind: if is_beam {
                MemberKind::Beam
            } else {
                MemberKind::Truss
            },
            section,
            section_b: None,
            orientation,
            offsets: [[0.0; 3]; 2],
            releases: [[false; 6]; 2],
        };
        match middle {
            Some(middle) => push_halves(&mut self.structure, member, middle),
            None => self.structure.members.push(member),
        }
        Some(())
    }

    /// The point at the middle node of an element between the points `ends`: `Some(None)` if it is a truss, whose middle node
    /// is left out; `None`, with an error, if the element is not straight or something else holds the middle node of a truss.
    fn middle(
        &mut self,
        node: u64,
        element: &InpElement,
        ends: [usize; 2],
        about: &str,
    ) -> Option<Option<usize>> {
        let is_truss = element.kind == InpKind::Truss;
        let Some(&at) = self.model.nodes.get(&node) else {
            self.point(node, element.at, about);
            return None;
        };
        let ends = ends.map(|point| self.structure.points[point].at);
        let mut wrong = check_straight(ends, at).err();
        if wrong.is_none() && is_truss && self.held_middles.contains(&node) {
            let expected = "must have a middle node that nothing else uses, because it is a truss";
            let hint = "end the element at this node";
            wrong = Some([expected, hint].map(str::to_owned));
        }
        if let Some([expected, hint]) = wrong {
            self.findings
                .error(ImportFinding::new(element.at, about, expected).hint(hint));
            return None;
        }
        if is_truss {
            return Some(None);
        }
        self.point(node, element.at, about).map(Some)
    }

    /// Middle nodes of trusses at which something else acts: another element, a joint or a support.
    fn held_middles(&self) -> BTreeSet<u64> {
        let model = self.model;
        let trusses = model
            .elements
            .values()
            .filter(|element| element.kind == InpKind::Truss);
        let mut middles: BTreeMap<u64, bool> = BTreeMap::new();
        for node in trusses.filter_map(|element| element.middle) {
            let is_used = self.index.contains_key(&node);
            middles
                .entry(node)
                .and_modify(|held| *held = true)
                .or_insert(is_used);
        }
        for boundary in &model.boundaries {
            let target = &boundary.target.text;
            let nodes = match model.node_sets.get(target) {
                Some(set) => set.numbers(&middles),
                None => number_of(target).into_iter().collect(),
            };
            for node in nodes {
                middles.entry(node).and_modify(|held| *held = true);
            }
        }
        let held = middles.into_iter().filter(|(_, held)| *held);
        held.map(|(node, _)| node).collect()
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
                    let finding = ImportFinding::new(
                        element.at,
                        about,
                        "refers to a node that does not exist",
                    );
                    self.findings.error(finding.with_found(third));
                    return None;
                }
            },
            _ => n1,
        };
        if parallel(direction, along) {
            let finding = ImportFinding::new(
                element.at,
                about,
                "its n1 direction must not be zero or parallel to it",
            );
            let hint = "specify n1 on the second data line of its section; the default is 0, 0, -1";
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
            let beams = self
                .structure
                .members
                .iter_mut()
                .filter(|member| member.kind == MemberKind::Beam);
            for member in beams.filter(|member| numbers.contains(&member.id)) {
                // the halves of an element have one of its ends each
                let node = model
                    .elements
                    .get(&member.id)
                    .and_then(|element| element.nodes.get(release.end));
                let point = node.and_then(|node| self.index.get(node));
                if point != Some(&member.points[release.end]) {
                    continue;
                }
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
                let is_turned =
                    place.is_some_and(|place| model.sections[place].numbers.product != 0.0);
                is_turned
                    && member
                        .releases
                        .iter()
                        .any(|release| release[4] != release[5])
            })
            .map(|member| member.id)
            .collect();
        for number in turned {
            let at = model
                .elements
                .get(&number)
                .map_or(FilePlace::default(), |element| element.at);
            let expected =
                "must be released in both planes or neither, because its section has I12";
            self.findings.error(ImportFinding::new(
                at,
                format!("element {number}"),
                expected,
            ));
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
        let numbers = InpModel::targets(
            &model.element_sets,
            &model.elements,
            set,
            about,
            self.findings,
        );
        let elements = numbers
            .iter()
            .filter_map(|number| model.elements.get(number));
        let of_kind: Vec<&InpElement> = elements.filter(|element| element.kind == kind).collect();
        of_kind
            .iter()
            .filter_map(|element| self.point(*element.nodes.first()?, element.at, about))
            .collect()
    }

    fn springs_and_masses(&mut self) {
        let model = self.model;
        for spring in &model.springs {
            let &[dof, k] = spring.values.as_slice() else {
                continue;
            };
            let points = self.points_of(&spring.set, InpKind::Spring, "*SPRING");
            if dof == 0.0 && !points.is_empty() {
                let expected =
                    "must have a degree of freedom from 1 to 6 on its first line for SPRING1";
                self.findings
                    .error(ImportFinding::new(spring.set.at, "*SPRING", expected));
                continue;
            }
            for point in points {
                self.structure.springs.push(ImportedSpring {
                    point,
                    dof: dof as usize - 1,
                    k,
                });
            }
        }
        let mut masses: BTreeMap<usize, ImportedMass> = BTreeMap::new();
        let empty = |point| ImportedMass {
            point,
            mass: 0.0,
            inertia: [0.0; 3],
            offset: [0.0; 3],
        };
        for mass in &model.masses {
            let own = mass.values.first().copied().unwrap_or_default();
            for point in self.points_of(&mass.set, InpKind::Mass, "*MASS") {
                masses.entry(point).or_insert(empty(point)).mass += own;
            }
        }
        for inertia in &model.inertias {
            for point in self.points_of(&inertia.set, InpKind::Rotary, "*ROTARY INERTIA") {
                let entry = masses.entry(point).or_insert(empty(point));
                entry
                    .inertia
                    .iter_mut()
                    .zip(&inertia.values)
                    .for_each(|(sum, own)| *sum += own);
            }
        }
        if let Some(wrong) = masses.values().find_map(ImportedMass::beyond_magnitudes) {
            let at = FilePlace {
                file: 0,
                line: 1,
                column: 1,
            };
            let finding = ImportFinding::new(at, "*MASS", MASS_RANGE);
            self.findings.error(finding.with_found(number(wrong)));
        }
        self.structure.masses.extend(masses.into_values());
    }

    /// Adds the rigid joints, then the pinned ones.
    fn joints(&mut self) {
        let model = self.model;
        let mut pinned = Vec::new();
        for request in &model.joints {
            let leaders = InpModel::targets(
                &model.node_sets,
                &model.nodes,
                &request.leader,
                "joint",
                self.findings,
            );
            let &[leader] = leaders.as_slice() else {
                let expected = "must have exactly one independent node";
                self.findings
                    .error(ImportFinding::new(request.leader.at, "joint", expected));
                continue;
            };
            let followers = InpModel::targets(
                &model.node_sets,
                &model.nodes,
                &request.followers,
                "joint",
                self.findings,
            );
            for follower in followers.into_iter().filter(|follower| *follower != leader) {
                let about = format!("joint of node {follower}");
                let from = self.point(leader, request.leader.at, &about);
                let to = self.point(follower, request.followers.at, &about);
                let (Some(from), Some(to)) = (from, to) else {
                    continue;
                };
                let at = request.followers.at;
                let coincide = self.structure.points[from].at == self.structure.points[to].at;
                match request.joint {
                    Joint::Tied if !coincide => {
                        let finding =
                            ImportFinding::new(at, about, "must connect coincident nodes");
                        self.findings
                            .error(finding.hint("*MPC BEAM connects nodes at a distance"));
                    }
                    Joint::Rigid | Joint::Tied => self.structure.links.push([from, to]),
                    Joint::Pinned => {
                        let set = [true, true, true, false, false, false];
                        pinned.push((PartialLink { from, to, set }, at, about));
                    }
                }
            }
        }
        let all: Vec<PartialLink> = pinned.iter().map(|(link, ..)| *link).collect();
        for (link, at, about) in pinned {
            if !links::add(&mut self.structure, link, &all) {
                let expected = "must be rigid, or be equivalent to a hinge or a support";
                let hint = "a hinge has a single beam at the dependent node; a support has a fixed independent node";
                self.findings
                    .error(ImportFinding::new(at, about, expected).hint(hint));
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
        let mut members: BTreeMap<u64, Vec<usize>> = BTreeMap::new();
        for (index, member) in structure.members.iter().enumerate() {
            members.entry(member.id).or_default().push(index);
        }
        for set in model.node_sets.iter() {
            let numbers = set.numbers(&self.index);
            let points = numbers.iter().map(|number| self.index[number]).collect();
            structure.point_sets.push((set.name.clone(), points));
        }
        for set in model.element_sets.iter() {
            let numbers = set.numbers(&members);
            let own = numbers.iter().flat_map(|number| members[number].clone());
            structure.cell_sets.push((set.name.clone(), own.collect()));
        }
        structure.point_sets.retain(|(_, set)| !set.is_empty());
        structure.cell_sets.retain(|(_, set)| !set.is_empty());
    }
}
