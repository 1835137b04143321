//! The sections file: materials, sections and the properties of members by physical group.
//!
//! A section that no entry of `members` uses applies to the physical group of the same name. A section of beams must
//! have A, Iy, Iz and J, and a material with G; one that only rods use A, J and G; one that only trusses use A.

use std::collections::BTreeMap;

use fea::MemberKind;
use serde::Deserialize;

use crate::structure::{ImportedMaterial, ImportedSection};
use formats::check::Check;
use formats::text::diagnostic::Diagnostic;
use formats::text::entries::Entries;
use formats::text::fault::{Fault, Faults, nearest};
use formats::text::place::Place;
use formats::text::source::Source;
use formats::units::{Dimension, RawUnits, Scale, Units};

/// Identifier of the format with its version.
pub const FORMAT: &str = "girderway-sections/1";

formats::text::object::objects!(Raw, RawMaterial, RawSection, RawMember);

#[derive(Debug, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
struct Raw {
    format: Option<String>,
    units: Option<RawUnits>,
    materials: Option<Vec<RawMaterial>>,
    sections: Option<Vec<RawSection>>,
    members: Option<Entries<RawMember>>,
}

#[derive(Debug, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
struct RawMaterial {
    name: Option<String>,
    #[serde(rename = "E")]
    e: Option<f64>,
    #[serde(rename = "G")]
    g: Option<f64>,
    density: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
struct RawSection {
    name: Option<String>,
    material: Option<String>,
    #[serde(rename = "A")]
    area: Option<f64>,
    #[serde(rename = "Iy")]
    iy: Option<f64>,
    #[serde(rename = "Iz")]
    iz: Option<f64>,
    #[serde(rename = "J")]
    j: Option<f64>,
    #[serde(rename = "Asy")]
    asy: Option<f64>,
    #[serde(rename = "Asz")]
    asz: Option<f64>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
struct RawMember {
    section: Option<String>,
    kind: Option<String>,
    orientation: Option<[f64; 3]>,
    release_a: Option<Vec<String>>,
    release_b: Option<Vec<String>>,
}

/// Properties of the members of a physical group.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SectionGroup {
    /// Index of the section.
    pub section: usize,
    /// Kind of the members.
    pub kind: MemberKind,
    /// Direction of the local y axis; `None` means upward.
    pub orientation: Option<[f64; 3]>,
    /// Released degrees of freedom at ends a and b.
    pub releases: [[bool; 6]; 2],
}

/// The contents of a sections file.
#[derive(Clone, Debug, PartialEq)]
pub struct Sections {
    /// Units of all values.
    pub units: Units,
    /// Materials in the order of the file.
    pub materials: Vec<ImportedMaterial>,
    /// Sections in the order of the file.
    pub sections: Vec<ImportedSection>,
    /// Physical groups by name: those of `members`, and one for each section that no entry of `members` uses.
    pub groups: BTreeMap<String, SectionGroup>,
}

const DOFS: [(&str, usize); 6] = [
    ("ux", 0),
    ("uy", 1),
    ("uz", 2),
    ("rx", 3),
    ("ry", 4),
    ("rz", 5),
];

impl Sections {
    /// Reads a sections file.
    ///
    /// # Errors
    /// All errors of the file, with their positions.
    pub fn read(source: &Source) -> Result<Sections, Vec<Diagnostic>> {
        source.read(FORMAT, Sections::check)
    }

    fn check(raw: &Raw, faults: &mut Faults) -> Option<Sections> {
        let root = Place::root();
        if let Some(word) = faults.require(&raw.format, &root, "format") {
            faults.one_of(word, &root.key("format"), &[(FORMAT, ())]);
        }
        let own = Units::read(&raw.units, &root, faults);
        // without units the numbers are checked in an arbitrary system of units
        let units = own.unwrap_or(Units::SI);
        let mut check = Check {
            faults,
            scale: Scale {
                from: units,
                to: units,
            },
        };
        let materials = materials(raw, &root, &mut check);
        let sections = sections(raw, &materials, &root, &mut check);
        let groups = groups(raw, &materials, &sections, &root, check.faults);
        own.map(|units| Sections {
            units,
            materials,
            sections,
            groups,
        })
    }
}

fn materials(raw: &Raw, root: &Place<'_>, check: &mut Check<'_>) -> Vec<ImportedMaterial> {
    let list = root.key("materials");
    let mut materials: Vec<ImportedMaterial> = Vec::new();
    for (index, raw) in check
        .faults
        .require(&raw.materials, root, "materials")
        .into_iter()
        .flatten()
        .enumerate()
    {
        let at = list.index(index);
        let name = check
            .faults
            .require(&raw.name, &at, "name")
            .cloned()
            .unwrap_or_default();
        if materials.iter().any(|other| other.name == name) {
            check.faults.add(
                Fault::new(&at.key("name"), "must differ from the other materials").got(&name),
            );
        }
        let e = check.required_positive(raw.e, &at, "E", Dimension::STRESS, "");
        let g = check.optional_positive(raw.g, &at.key("G"), Dimension::STRESS, "");
        let density = raw
            .density
            .map(|value| check.not_negative(value, &at.key("density"), Dimension::DENSITY, ""));
        materials.push(ImportedMaterial {
            name,
            e,
            g,
            density,
        });
    }
    materials
}

fn sections(
    raw: &Raw,
    materials: &[ImportedMaterial],
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> Vec<ImportedSection> {
    let list = root.key("sections");
    let mut sections: Vec<ImportedSection> = Vec::new();
    for (index, raw) in check
        .faults
        .require(&raw.sections, root, "sections")
        .into_iter()
        .flatten()
        .enumerate()
    {
        let at = list.index(index);
        let name = check
            .faults
            .require(&raw.name, &at, "name")
            .cloned()
            .unwrap_or_default();
        if sections.iter().any(|other| other.name == name) {
            check
                .faults
                .add(Fault::new(&at.key("name"), "must differ from the other sections").got(&name));
        }
        let material = check
            .faults
            .require(&raw.material, &at, "material")
            .cloned()
            .unwrap_or_default();
        if raw.material.is_some() && !materials.iter().any(|other| other.name == material) {
            let known: Vec<&str> = materials.iter().map(|other| other.name.as_str()).collect();
            unknown(
                check.faults,
                &at.key("material"),
                "a material",
                &material,
                &known,
            );
        }
        let mut number = |value, key: &str, dimension| {
            check.optional_positive(value, &at.key(key), dimension, "")
        };
        sections.push(ImportedSection {
            name,
            material,
            area: number(raw.area, "A", Dimension::AREA),
            iy: number(raw.iy, "Iy", Dimension::SECOND_MOMENT),
            iz: number(raw.iz, "Iz", Dimension::SECOND_MOMENT),
            j: number(raw.j, "J", Dimension::SECOND_MOMENT),
            shear_y: number(raw.asy, "Asy", Dimension::AREA),
            shear_z: number(raw.asz, "Asz", Dimension::AREA),
        });
    }
    sections
}

fn unknown(faults: &mut Faults, at: &Place<'_>, what: &str, name: &str, known: &[&str]) {
    let hint = match nearest(name, known) {
        Some(near) => format!("did you mean \"{near}\"?"),
        None => format!("known: {}", known.join(", ")),
    };
    faults.add(
        Fault::new(at, format!("must be the name of {what}"))
            .got(format!("\"{name}\""))
            .hint(hint),
    );
}

/// Reads the groups of `members`.
fn named_groups(
    raw: &Raw,
    sections: &[ImportedSection],
    root: &Place<'_>,
    faults: &mut Faults,
) -> BTreeMap<String, SectionGroup> {
    let mut groups = BTreeMap::new();
    let place = root.key("members");
    for (name, raw) in raw.members.iter().flat_map(|members| &members.0) {
        let at = place.key(name);
        let mut group = SectionGroup {
            orientation: raw.orientation,
            ..SectionGroup::default()
        };
        let wanted = raw.section.as_ref().unwrap_or(name);
        let position = sections.iter().position(|section| section.name == *wanted);
        let kinds = [
            ("beam", MemberKind::Beam),
            ("truss", MemberKind::Truss),
            ("rod", MemberKind::Rod),
        ];
        if let Some(word) = &raw.kind {
            group.kind = faults
                .one_of(word, &at.key("kind"), &kinds)
                .unwrap_or_default();
        }
        for (end, (key, words)) in [("release_a", &raw.release_a), ("release_b", &raw.release_b)]
            .into_iter()
            .enumerate()
        {
            let list = at.key(key);
            for (index, word) in words.iter().flatten().enumerate() {
                if let Some(dof) = faults.one_of(word, &list.index(index), &DOFS) {
                    group.releases[end][dof] = true;
                }
            }
        }
        match position {
            Some(section) => group.section = section,
            None => {
                let known: Vec<&str> = sections
                    .iter()
                    .map(|section| section.name.as_str())
                    .collect();
                let section = at.key("section");
                unknown(
                    faults,
                    if raw.section.is_some() { &section } else { &at },
                    "a section",
                    wanted,
                    &known,
                );
            }
        }
        groups.insert(name.clone(), group);
    }
    groups
}

/// Returns all groups: those of `members`, and one for each section that none of them uses. Adds an error for each
/// value that is missing in a section although its members require it.
fn groups(
    raw: &Raw,
    materials: &[ImportedMaterial],
    sections: &[ImportedSection],
    root: &Place<'_>,
    faults: &mut Faults,
) -> BTreeMap<String, SectionGroup> {
    let mut groups = named_groups(raw, sections, root, faults);
    let list = root.key("sections");
    for (index, section) in sections.iter().enumerate() {
        if !groups.contains_key(&section.name)
            && groups.values().all(|group| group.section != index)
        {
            groups.insert(
                section.name.clone(),
                SectionGroup {
                    section: index,
                    ..SectionGroup::default()
                },
            );
        }
        // trusses require the area only, rods the area and the torsion constant
        let used: Vec<&SectionGroup> = groups
            .values()
            .filter(|group| group.section == index)
            .collect();
        let beams = used.iter().any(|group| group.kind == MemberKind::Beam);
        let twists = used.iter().any(|group| group.kind != MemberKind::Truss);
        let at = list.index(index);
        for (key, value) in [
            ("A", section.area),
            ("Iy", section.iy),
            ("Iz", section.iz),
            ("J", section.j),
        ] {
            if value.is_none() && (beams || key == "A" || key == "J" && twists) {
                let hint =
                    "beams need A, Iy, Iz and J; rods and trusses need their `kind` in `members`";
                faults.add(Fault::new(&at, format!("missing key `{key}`")).hint(hint));
            }
        }
        let stiff = materials
            .iter()
            .any(|material| material.name == section.material && material.g.is_none());
        if twists && stiff {
            let hint = "torsion of beams and rods and shear of beams depend on it";
            faults.add(Fault::new(&at, "its material needs `G`").hint(hint));
        }
    }
    groups
}
