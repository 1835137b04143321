//! Conversion of elements to members: properties, orientations, offsets and releases.

use super::element::{BarOrientation, ElementCard, SectionOf as Given};
use super::lumped::MemberMass;
use super::property::Property;
use super::resolve::Resolver;
use super::section::{is_lumped, mass_per_length};
use crate::axes::{LocalAxes, combined};
use crate::findings::{FilePlace, ImportFinding, no_members};
use crate::structure::ImportedMember;
use fea::{Dof, MemberKind};
use formats::vector::{minus, parallel};

impl<'d> Resolver<'d, '_> {
    /// Adds the members, in the order of their numbers.
    pub(super) fn members(&mut self) {
        let deck = self.deck;
        if deck.elements.is_empty() {
            let finding = ImportFinding::new(
                FilePlace {
                    line: 1,
                    column: 1,
                    file: 0,
                },
                "",
                no_members(&deck.others),
            );
            self.findings
                .error(finding.hint("supported members are CBAR, CBEAM, CROD, CTUBE and CONROD"));
        }
        for (&id, element) in &deck.elements {
            self.member(id, element);
        }
    }

    /// Returns the property of an element and the number in the name of its section, or `None`, with an error, if the
    /// property does not exist or has the wrong type for the element.
    fn property(
        &mut self,
        id: u64,
        element: &'d ElementCard,
        about: &str,
    ) -> Option<(u64, &'d Property)> {
        let deck = self.deck;
        let (number, property) = match &element.section {
            Given::Own(property) => (id, property.as_ref()),
            Given::Number(number) => {
                let Some(property) = deck.properties.get(number) else {
                    let (at, about) = element.property_default.unwrap_or((element.card, about));
                    let finding =
                        ImportFinding::new(at, about, "refers to a property that does not exist");
                    self.findings.error(finding.with_found(number));
                    return None;
                };
                (*number, property)
            }
        };
        let fits = match element.kind.as_str() {
            "CBAR" => matches!(property.kind.as_str(), "PBAR" | "PBARL"),
            "CBEAM" => matches!(property.kind.as_str(), "PBEAM" | "PBEAML"),
            "CTUBE" => property.kind == "PTUBE",
            _ => matches!(property.kind.as_str(), "PROD" | "CONROD"),
        };
        if !fits {
            let (at, about) = element.property_default.unwrap_or((element.card, about));
            let expected = format!("cannot have the property {} {number}", property.kind);
            let hint = "CBAR needs PBAR or PBARL, CBEAM needs PBEAM or PBEAML, CROD needs PROD, CTUBE needs PTUBE";
            self.findings
                .error(ImportFinding::new(at, about, expected).hint(hint));
            return None;
        }
        Some((number, property))
    }

    /// BarOrientation vector of an element whose first grid is at `first`: `Some(None)` for rods, and `None` if the grid
    /// that defines the orientation does not exist (with an error) or could not be read.
    fn orientation(
        &mut self,
        element: &ElementCard,
        first: [f64; 3],
        about: &str,
    ) -> Option<Option<[f64; 3]>> {
        match element.orientation {
            Some(BarOrientation::Vector(vector)) if element.systems.basic => Some(Some(vector)),
            Some(BarOrientation::Vector(vector)) => {
                let axes = self.grids.get(&element.grids[0])?.axes;
                Some(Some(combined(&axes, vector)))
            }
            Some(BarOrientation::Grid(grid)) => {
                let Some(there) = self.grids.get(&grid) else {
                    if !self.deck.grids.contains_key(&grid) {
                        let (at, about) =
                            element.orientation_default.unwrap_or((element.card, about));
                        let finding = ImportFinding::new(
                            at,
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

    /// Converts an element to a member and adds it; returns `None`, with an error among the findings, if this is not
    /// possible.
    fn member(&mut self, id: u64, element: &'d ElementCard) -> Option<()> {
        let about = format!("{} {id}", element.kind);
        let [a, b] = element
            .grids
            .map(|grid| self.point(grid, element.card, &about));
        let (number, property) = self.property(id, element, &about)?;
        let section = self.section(number, property, "", &about)?;
        let section_b = match &property.end {
            Some(end) => Some(self.section(number, end, " at end B", &about)?),
            None => None,
        };
        let (a, b) = (a?, b?);
        let ends = [a, b].map(|point| self.structure.points[point].at);
        let orientation = self.orientation(element, ends[0], &about)?;
        let offsets = self.offsets(element, ends, orientation, &about)?;
        let tip = |end: usize| [0, 1, 2].map(|axis| ends[end][axis] + offsets[end][axis]);
        let along = minus(tip(1), tip(0));
        if along == [0.0; 3] {
            let finding = ImportFinding::new(element.card, about, "must have a positive length");
            self.findings
                .error(finding.hint("its ends, including offsets, coincide"));
            return None;
        }
        let bends = property.bends();
        if orientation.is_some_and(|vector| parallel(vector, along)) && bends {
            let hint = "X1, X2, X3 or G0 defines the local x-y plane of the element";
            let finding = match element.orientation_default {
                Some((at, name)) => {
                    let expected = "must not be zero or parallel to an element that uses this default orientation";
                    ImportFinding::new(at, format!("{name}: X1"), expected)
                }
                None => ImportFinding::new(
                    element.card,
                    about,
                    "its orientation vector must not be zero or parallel to it",
                ),
            };
            self.findings.error(finding.hint(hint));
            return None;
        }
        let mut member = ImportedMember {
            id,
            points: [a, b],
            kind: MemberKind::Beam,
            section,
            section_b,
            orientation,
            offsets,
            releases: element.pins,
        };
        use_kind_of(property, &mut member);
        release_what_is_missing(property, &mut member);
        let bar = self.adapt(property, element.card, &about, along, &mut member)?;
        self.structure.members.push(member);
        let is_lumped = is_lumped(self.asked.mass, property);
        let [per_length, twist] = if is_lumped {
            mass_per_length(self.deck, property)
        } else {
            [0.0; 2]
        };
        let twists = element.kind == "CBEAM" && property.j > 0.0;
        let mass = MemberMass {
            card: element.card,
            per_length,
            twist: if twists { twist } else { 0.0 },
        };
        self.member_masses.push(mass);
        if let Some(bar) = bar {
            self.structure.members.push(bar);
            self.member_masses.push(MemberMass {
                card: element.card,
                ..MemberMass::default()
            });
        }
        Some(())
    }

    /// Offsets of an element in global axes; `None`, with an error, if they are in element axes that do not exist.
    fn offsets(
        &mut self,
        element: &ElementCard,
        ends: [[f64; 3]; 2],
        orientation: Option<[f64; 3]>,
        about: &str,
    ) -> Option<[[f64; 3]; 2]> {
        let mut offsets = element.offsets;
        let own = if element.systems.own.contains(&true) && offsets != [[0.0; 3]; 2] {
            let axes =
                orientation.and_then(|vector| LocalAxes::new(minus(ends[1], ends[0]), vector));
            if axes.is_none() {
                let expected = "must have defined element axes, because its offsets refer to them";
                let finding = ImportFinding::new(element.card, about, expected);
                self.findings.error(
                    finding.hint(
                        "the orientation vector must not be parallel to the line from GA to GB",
                    ),
                );
            }
            Some(axes?)
        } else {
            None
        };
        for (end, offset) in offsets.iter_mut().enumerate() {
            *offset = match own {
                Some(axes) if element.systems.own[end] => axes.vector(*offset),
                _ => combined(&self.grids.get(&element.grids[end])?.axes, *offset),
            };
        }
        Some(offsets)
    }

    /// Adapts a member to a property whose principal axes are turned, or whose neutral axis is off the shear centre.
    ///
    /// With the neutral axis off the shear centre by the same offset at both ends, axial force and bending about the
    /// neutral axis are independent. The member then keeps bending, shear and torsion along the axis of shear centres,
    /// with its end b released along it, and a bar along the neutral axis, which is returned, has the axial force.
    ///
    /// Returns `None`, with an error, for releases that the replacement would not preserve.
    fn adapt(
        &mut self,
        property: &Property,
        card: FilePlace,
        about: &str,
        along: [f64; 3],
        member: &mut ImportedMember,
    ) -> Option<Option<ImportedMember>> {
        let is_neutral = property.neutral == [0.0; 2];
        if (property.turn == 0.0 && is_neutral) || member.kind != MemberKind::Beam {
            return Some(None);
        }
        let axes = member
            .orientation
            .and_then(|vector| LocalAxes::new(along, vector))?;
        let is_uneven = |pins: &[bool; 6]| pins[1] != pins[2] || pins[4] != pins[5];
        if property.turn != 0.0 {
            if member.releases.iter().any(is_uneven) {
                let expected = "must have pin flags in both planes or neither, because its principal axes are rotated";
                let hint = "specify principal second moments of area, and pin flags in the principal planes";
                self.findings
                    .error(ImportFinding::new(card, about, expected).hint(hint));
                return None;
            }
            member.orientation = Some(axes.vector([0.0, property.turn.cos(), property.turn.sin()]));
        }
        if is_neutral {
            return Some(None);
        }
        if member.releases != [[false; 6]; 2] {
            let expected =
                "must not have pin flags, because its neutral axis is offset from its shear centre";
            self.findings
                .error(ImportFinding::new(card, about, expected));
            return None;
        }
        let [y, z] = property.neutral;
        let apart = axes.vector([0.0, y, z]);
        member.releases[1][Dof::Ux as usize] = true;
        Some(Some(ImportedMember {
            // no element has this number
            id: 0,
            kind: MemberKind::Truss,
            section: self.sections.massless(&mut self.structure, member.section),
            section_b: None,
            orientation: None,
            offsets: member
                .offsets
                .map(|offset| [0, 1, 2].map(|axis| offset[axis] + apart[axis])),
            releases: [[false; 6]; 2],
            ..member.clone()
        }))
    }

    /// Index of the section of a property (see [`SectionTable::index_of`]).
    fn section(
        &mut self,
        number: u64,
        property: &Property,
        end: &str,
        about: &str,
    ) -> Option<usize> {
        self.sections.index_of(
            self.deck,
            &mut self.structure,
            self.findings,
            (number, property),
            end,
            about,
        )
    }
}

/// The kind of a member with the stiffnesses of its property: without bending stiffness it is a rod, and without
/// torsional stiffness as well a truss. A member with bending stiffness only is a beam whose section has the J 0.
fn use_kind_of(property: &Property, member: &mut ImportedMember) {
    if property.bends() {
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

/// Releases a member where its property has no stiffness: along its axis at one end, and in a plane in which it does not
/// bend by hinges at both ends, which transmit no shear force then.
fn release_what_is_missing(property: &Property, member: &mut ImportedMember) {
    if property.area == 0.0 {
        member.releases[0][Dof::Ux as usize] = false;
        member.releases[1][Dof::Ux as usize] = true;
    }
    let planes = [(Dof::Uy, Dof::Rz), (Dof::Uz, Dof::Ry)];
    for ((across, turn), second_moment) in planes.into_iter().zip(property.bending) {
        if property.bends() && second_moment == 0.0 {
            for pins in &mut member.releases {
                pins[across as usize] = false;
                pins[turn as usize] = true;
            }
        }
    }
}
