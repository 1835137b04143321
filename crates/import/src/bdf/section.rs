//! Sections and materials of a deck, added to the structure when a member first uses them.
//!
//! A NASTRAN property is converted to one section (two if it is tapered), and its MAT1 to one material. A
//! non-structural mass per length NSM is distributed over the area A: a separate material with the density
//! rho + NSM / A is added for such a property. Materials have no density where mass is lumped. A section has the properties of its card alone: the second moments of a
//! rod are left out, and the J of a bar without torsional stiffness is 0.

use std::collections::BTreeMap;

use super::deck::BulkDeck;
use super::material::MaterialCard;
use super::property::Property;
use crate::PARTS;
use crate::findings::{ImportFinding, ImportFindings};
use crate::structure::{ImportedMaterial, ImportedSection, ImportedStructure, MassDistribution};

/// The sections and materials that have been added to a structure.
pub struct SectionTable {
    /// Where the mass of members acts: materials have it unless it is lumped.
    mass: MassDistribution,
    /// Index of the section by number of the property and end: true for end B.
    indices: BTreeMap<(u64, bool), usize>,
    /// Names of the materials.
    materials: Vec<String>,
}

impl SectionTable {
    /// A table without sections.
    #[must_use]
    pub fn new(mass: MassDistribution) -> SectionTable {
        SectionTable {
            mass,
            indices: BTreeMap::new(),
            materials: Vec::new(),
        }
    }

    /// Adds a section with the area of the section `index` alone and without mass, for the bar along the neutral axis of
    /// a PBEAM, and returns its index.
    pub fn massless(&mut self, structure: &mut ImportedStructure, index: usize) -> usize {
        let of = &structure.sections[index];
        let name = format!("{} at its neutral axis", of.name);
        if let Some(known) = structure
            .sections
            .iter()
            .position(|section| section.name == name)
        {
            return known;
        }
        let (area, material) = (of.area, format!("{} without mass", of.material));
        if !self.materials.contains(&material) {
            let own = structure
                .materials
                .iter()
                .find(|known| known.name == of.material);
            let copy = own.map(|own| ImportedMaterial {
                name: material.clone(),
                density: None,
                ..own.clone()
            });
            structure.materials.extend(copy);
            self.materials.push(material.clone());
        }
        structure.sections.push(ImportedSection {
            name,
            material,
            area,
            ..ImportedSection::default()
        });
        structure.sections.len() - 1
    }

    /// Returns the index of the section of a property, and adds the section to `structure` when it is first used.
    ///
    /// `end` is the suffix of the section name for end B, and empty otherwise; `about` is the element that uses the
    /// section. Returns `None`, with an error among the findings, if the property cannot be used.
    pub fn index_of(
        &mut self,
        deck: &BulkDeck,
        structure: &mut ImportedStructure,
        findings: &mut ImportFindings,
        (number, property): (u64, &Property),
        end: &str,
        about: &str,
    ) -> Option<usize> {
        // the number of a CONROD is an element number, which may coincide with a property number
        let key = if property.kind == "CONROD" {
            None
        } else {
            Some((number, !end.is_empty()))
        };
        if let Some(index) = key.and_then(|key| self.indices.get(&key)) {
            return Some(*index);
        }
        let name = format!("{} {number}", property.kind);
        let known = material_of(deck, property, &name, about, findings)?;
        warn_of_conversions(property, &name, findings);
        let wtmass = deck.wtmass.unwrap_or(1.0);
        let mut density = known.density * wtmass;
        let mut material = format!("MAT1 {}", property.material);
        let is_lumped = is_lumped(self.mass, property);
        if is_lumped || property.area == 0.0 {
            density = 0.0;
        }
        if !is_lumped && property.nsm > 0.0 {
            density += property.nsm * wtmass / property.area_or_placeholder();
            material = format!("{material} and NSM of {name}");
        } else if density == 0.0 && known.density > 0.0 && self.mass != MassDistribution::Lumped {
            material += " without mass";
        }
        if !density.is_finite() {
            let expected = "must have a mass within the range of double precision";
            findings.error(ImportFinding::new(property.card, &name, expected));
            return None;
        }
        if !self.materials.contains(&material) {
            self.materials.push(material.clone());
            let density = (density > 0.0).then_some(density);
            let (e, g) = (known.e, known.g);
            structure.materials.push(ImportedMaterial {
                name: material.clone(),
                e,
                g,
                density,
            });
        }
        let section = section_of(property, format!("{name}{end}"), material);
        let numbers = [section.iy, section.iz, section.shear_y, section.shear_z];
        let positive = numbers
            .iter()
            .flatten()
            .all(|value| value.is_finite() && *value > 0.0);
        if !positive || section.j.is_some_and(|j| !j.is_finite()) {
            let expected = "must have properties within the range of double precision";
            findings.error(ImportFinding::new(property.card, &name, expected));
            return None;
        }
        let index = structure.sections.len();
        structure.sections.push(section);
        if let Some(key) = key {
            self.indices.insert(key, index);
        }
        Some(index)
    }
}

/// Whether the mass of members with a property is lumped at their ends.
#[must_use]
pub fn is_lumped(mass: MassDistribution, property: &Property) -> bool {
    match mass {
        MassDistribution::Lumped => true,
        MassDistribution::LumpedRods => {
            matches!(property.kind.as_str(), "PROD" | "CONROD" | "PTUBE")
        }
        MassDistribution::Distributed => false,
    }
}

/// Mass per length of members with a property, and their inertia in twist per length; of a tapered one the mean of both
/// ends. Both are scaled by WTMASS.
#[must_use]
pub fn mass_per_length(deck: &BulkDeck, property: &Property) -> [f64; 2] {
    let wtmass = deck.wtmass.unwrap_or(1.0);
    let density = deck
        .materials
        .get(&property.material)
        .map_or(0.0, |material| material.density);
    let end = property.end.as_deref().unwrap_or(property);
    let area = 0.5 * (property.area + end.area);
    let polar = 0.5 * (property.bending.iter().sum::<f64>() + end.bending.iter().sum::<f64>());
    [
        (density * area + property.nsm) * wtmass,
        density * polar * wtmass,
    ]
}

/// Returns the material of a property, or `None`, with an error, if the material does not exist or has no G although
/// torsion or shear requires it.
fn material_of<'d>(
    deck: &'d BulkDeck,
    property: &Property,
    name: &str,
    about: &str,
    findings: &mut ImportFindings,
) -> Option<&'d MaterialCard> {
    let Some(material) = deck.materials.get(&property.material) else {
        let finding = ImportFinding::new(
            property.card,
            format!("{name}: MID"),
            "must be the number of a MAT1",
        );
        findings.error(finding.with_found(property.material));
        return None;
    };
    let is_shear_flexible = property.bends() && property.shear.iter().any(|k| *k > 0.0);
    if material.g.is_none() && (property.j > 0.0 || is_shear_flexible) {
        let expected = format!("is missing, but {name} of {about} requires it");
        let finding = ImportFinding::new(
            material.card,
            format!("MAT1 {}: G", property.material),
            expected,
        );
        findings.error(finding.hint("specify G or NU"));
        return None;
    }
    Some(material)
}

/// Adds warnings for missing stiffnesses and for a tapered property.
fn warn_of_conversions(property: &Property, name: &str, findings: &mut ImportFindings) {
    for field in property.missing() {
        let lost = match field {
            "A" => "axial stiffness",
            "I1" => "bending stiffness in plane 1",
            _ => "bending stiffness in plane 2",
        };
        let expected = format!("has no {field}: its members have no {lost}");
        let finding = ImportFinding::new(property.card, name, expected);
        findings.warn(finding.hint(
            "what they do not resist must be held by supports or other members at their points",
        ));
    }
    if property.bends() && property.j == 0.0 {
        let expected = "has no J: its members have no torsional stiffness";
        let finding = ImportFinding::new(property.card, name, expected);
        findings.warn(
            finding.hint(
                "specify J if these members are subjected to torsion, as under eccentric loads",
            ),
        );
    }
    if property.end.is_some() {
        let expected = format!("is tapered: each member is divided into {PARTS} uniform parts");
        findings.warn(
            ImportFinding::new(property.card, name, expected)
                .hint("`parts` of the spec can specify another number"),
        );
    }
}

/// Converts a property to a section. Rods have no second moments; the J of a bar without torsional stiffness is 0.
///
/// A section of a beam must have an area and both second moments. Where the property has none, there is a placeholder of
/// the same order, which has no effect because the members are released accordingly.
fn section_of(property: &Property, name: String, material: String) -> ImportedSection {
    let [i1, i2] = property.bending;
    let bends = property.bends();
    let bending = |own: f64, other: f64| bends.then_some(if own > 0.0 { own } else { other });
    let shear = |plane: usize| {
        let [own, k] = [property.bending[plane], property.shear[plane]];
        let area = k * property.area;
        (own > 0.0 && area > 0.0).then_some(area)
    };
    ImportedSection {
        name,
        material,
        area: Some(property.area_or_placeholder()),
        iy: bending(i2, i1),
        iz: bending(i1, i2),
        j: (bends || property.j > 0.0).then_some(property.j),
        shear_y: shear(0),
        shear_z: shear(1),
        missing: property.missing(),
    }
}
