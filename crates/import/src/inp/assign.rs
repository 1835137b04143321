//! Sections with their materials, and their assignment to elements.

use super::model::{InpElement, InpKind, InpModel};
use super::resolve::Resolver;
use super::section::{InpSection, MaterialOf};
use super::values::key_of;
use crate::findings::ImportFinding;
use crate::structure::{ImportedMaterial, ImportedSection};
use formats::limits::MAGNITUDES;
use formats::vector::length;

/// The name of the material of springs along the line between their nodes.
const SPRING_MATERIAL: &str = "springs, without mass";

impl Resolver<'_, '_> {
    /// Adds the sections with their materials, and assigns them to elements.
    pub(super) fn assign_sections(&mut self) {
        let model = self.model;
        for (place, section) in model.sections.iter().enumerate() {
            let Some(material) = self.material(section) else {
                continue;
            };
            let about = format!("{}: ELSET", section.label);
            let elements = InpModel::targets(
                &model.element_sets,
                &model.elements,
                &section.set,
                &about,
                self.findings,
            );
            // CalculiX has no circles in beams of two nodes
            let is_of_either = |number: &u64| {
                let element = model.elements.get(number);
                element.is_some_and(|element| element.middle.is_some())
            };
            if section.is_unclear_circle && elements.iter().any(is_of_either) {
                let about = format!("{}: SECTION", section.label);
                let expected = "must not be CIRC, because its dimension is the radius in Abaqus and the diameter in \
                                CalculiX, and the file is of either";
                let hint = "change the type of its elements to B32R in a file of CalculiX, B32H in one of Abaqus";
                let finding = ImportFinding::new(section.set.at, about, expected);
                self.findings.error(finding.hint(hint));
            }
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
            let positive = [
                Some(numbers.area),
                beam(iy),
                beam(iz),
                beam(numbers.j),
                shear_y,
                shear_z,
            ];
            if positive
                .iter()
                .flatten()
                .any(|value| !value.is_finite() || *value <= 0.0)
            {
                let expected = "must have properties within the range of double precision";
                self.findings
                    .error(ImportFinding::new(section.set.at, &section.label, expected));
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
                missing: Vec::new(),
            });
            for number in elements {
                if self.section_of.insert(number, [index, place]).is_some() {
                    let finding = ImportFinding::new(
                        section.set.at,
                        &about,
                        "must not assign a second section to an element",
                    );
                    self.findings
                        .error(finding.with_found(format!("element {number}")));
                }
            }
        }
    }

    /// The name of the material of a section, which is added to the structure.
    fn material(&mut self, section: &InpSection) -> Option<String> {
        let (name, e, g, density) = match &section.material {
            MaterialOf::Own([e, g, density]) => {
                let name = format!(
                    "material of {} {}",
                    section.set.text,
                    self.structure.sections.len() + 1
                );
                (name, *e, *g, (*density > 0.0).then_some(*density))
            }
            MaterialOf::Named(wanted) => {
                let known = self
                    .model
                    .materials
                    .iter()
                    .find(|known| key_of(&known.name) == key_of(&wanted.text));
                let about = format!("{}: MATERIAL", section.label);
                let Some(material) = known else {
                    let finding =
                        ImportFinding::new(wanted.at, about, "must be the name of a *MATERIAL");
                    self.findings.error(finding.with_found(&wanted.text));
                    return None;
                };
                let Some([e, nu]) = material.elastic else {
                    let expected = "requires *ELASTIC";
                    self.findings
                        .error(ImportFinding::new(material.at, "*MATERIAL", expected));
                    return None;
                };
                (
                    material.name.clone(),
                    e,
                    e / (2.0 * (1.0 + nu)),
                    material.density,
                )
            }
        };
        if !(g.is_finite() && g > 0.0) {
            let expected = "must give moduli within the range of double precision";
            self.findings
                .error(ImportFinding::new(section.set.at, &section.label, expected));
            return None;
        }
        if self
            .structure
            .materials
            .iter()
            .all(|known| known.name != name)
        {
            self.structure.materials.push(ImportedMaterial {
                name: name.clone(),
                e,
                g: Some(g),
                density,
            });
        }
        Some(name)
    }

    /// Assigns stiffnesses to the springs along the line between their nodes.
    pub(super) fn assign_springs(&mut self) {
        let model = self.model;
        for (place, spring) in model.springs.iter().enumerate() {
            let &[_, k] = spring.values.as_slice() else {
                continue;
            };
            let elements = InpModel::targets(
                &model.element_sets,
                &model.elements,
                &spring.set,
                "*SPRING",
                self.findings,
            );
            let is_axial = |number: &u64| {
                let element = model.elements.get(number);
                element.is_some_and(|element| element.kind == InpKind::AxialSpring)
            };
            for number in elements.into_iter().filter(is_axial) {
                if self.stiffness_of.insert(number, (k, place)).is_some() {
                    let expected = "must not assign a second stiffness to an element";
                    let finding = ImportFinding::new(spring.set.at, "*SPRING: ELSET", expected);
                    self.findings
                        .error(finding.with_found(format!("element {number}")));
                }
            }
        }
    }

    /// The section of a truss that replaces a spring along the line between its nodes: E A / L is the stiffness. E is that
    /// of another material of the file, so that A has the order of other sections.
    pub(super) fn spring_section(
        &mut self,
        number: u64,
        element: &InpElement,
        along: [f64; 3],
    ) -> Option<usize> {
        let Some(&(k, place)) = self.stiffness_of.get(&number) else {
            let finding = ImportFinding::new(element.at, "element", "must have a stiffness");
            let hint = "assign *SPRING to a set that contains the element";
            self.findings.error(finding.hint(hint));
            return None;
        };
        let known = self.structure.materials.iter();
        let own = known.clone().find(|known| known.name == SPRING_MATERIAL);
        let e = own.or(known.clone().next()).map_or(1.0, |known| known.e);
        let area = k / e * length(along);
        let set = &self.model.springs[place].set;
        if !(MAGNITUDES[0]..=MAGNITUDES[1]).contains(&area) {
            let expected = "must have a stiffness within the range of double precision";
            let about = format!("element {number}");
            self.findings
                .error(ImportFinding::new(set.at, about, expected).with_found(k));
            return None;
        }
        if own.is_none() {
            self.structure.materials.push(ImportedMaterial {
                name: SPRING_MATERIAL.to_owned(),
                e,
                g: None,
                density: None,
            });
        }
        let of_set = format!("spring {} ", set.text);
        let sections = &mut self.structure.sections;
        let is_same = |section: &ImportedSection| {
            section.material == SPRING_MATERIAL
                && section.name.starts_with(&of_set)
                && section.area == Some(area)
        };
        if let Some(known) = sections.iter().position(is_same) {
            return Some(known);
        }
        sections.push(ImportedSection {
            name: format!("{of_set}{}", sections.len() + 1),
            material: SPRING_MATERIAL.to_owned(),
            area: Some(area),
            ..ImportedSection::default()
        });
        Some(sections.len() - 1)
    }

    /// The section without shear areas, for beams of Euler and Bernoulli that share it with others.
    pub(super) fn rigid_in_shear(&mut self, section: usize) -> usize {
        let of = &self.structure.sections[section];
        if of.shear_y.is_none() {
            return section;
        }
        let name = format!("{}, rigid in shear", of.name);
        if let Some(known) = self
            .structure
            .sections
            .iter()
            .position(|known| known.name == name)
        {
            return known;
        }
        let copy = ImportedSection {
            name,
            shear_y: None,
            shear_z: None,
            ..of.clone()
        };
        self.structure.sections.push(copy);
        self.structure.sections.len() - 1
    }
}
