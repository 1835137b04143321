//! Files of sections for models that have none: materials and sections as in a beam spec, and the properties of members
//! by group.
//!
//! A section that no entry of `members` uses belongs to the group of the same name.

use std::collections::BTreeMap;

use fea::{BeamTheory, Member, MemberKind, Model};
use serde::Deserialize;

use super::raw::{RawMaterial, RawSection, SectionTables};
use super::references::dofs;
use super::{outline, sections, stress};
use crate::check::Check;
use crate::text::diagnostic::Diagnostic;
use crate::text::entries::Entries;
use crate::text::fault::Faults;
use crate::text::names::resolve;
use crate::text::place::Place;
use crate::text::source::Source;
use crate::units::{RawUnits, Scale, Units};

/// Value of the member `format`: name and version of the format.
pub const SECTIONS_FORMAT: &str = "girderway-sections/1";

crate::text::object::objects!(RawSectionFile, RawGroup);

#[derive(Debug, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
struct RawSectionFile {
    format: Option<String>,
    units: Option<RawUnits>,
    materials: Option<Vec<RawMaterial>>,
    sections: Option<Vec<RawSection>>,
    members: Option<Entries<RawGroup>>,
}

#[derive(Debug, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
struct RawGroup {
    section: Option<String>,
    kind: Option<String>,
    orientation: Option<[f64; 3]>,
    release_a: Option<Vec<String>>,
    release_b: Option<Vec<String>>,
}

/// Properties of the members of a group.
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

/// The contents of a file of sections.
#[derive(Clone, Debug, PartialEq)]
pub struct SectionFile {
    /// Units of all values.
    pub units: Units,
    /// Names of the sections in the order of the file.
    pub names: Vec<String>,
    /// `materials` as they stand in the file, for a beam spec in the same units.
    pub materials: serde_json::Value,
    /// `sections` as they stand in the file.
    pub sections: serde_json::Value,
    /// Groups by name: those of `members`, and one for each section that no entry of `members` uses.
    pub groups: BTreeMap<String, SectionGroup>,
}

/// What the reader of specs found of a file: units, names of sections, and groups.
type Found = (Units, Vec<String>, BTreeMap<String, SectionGroup>);

impl SectionFile {
    /// Reads a file of sections.
    ///
    /// ```
    /// use formats::spec::SectionFile;
    /// use formats::text::source::Source;
    ///
    /// let text = r#"{"format": "girderway-sections/1", "units": {"length": "m", "force": "kN", "time": "s"},
    ///   "materials": [{"name": "steel", "E": 2.1e8, "G": 8.1e7}],
    ///   "sections": [{"name": "girder", "material": "steel", "shape": "HEB 400"}]}"#;
    /// let source = Source { name: "sections.json".to_owned(), text: text.to_owned() };
    /// let file = SectionFile::read(&source).expect("a file without faults");
    /// assert_eq!(file.groups["girder"].section, 0);
    /// assert_eq!(file.sections[0]["shape"], "HEB 400");
    /// ```
    ///
    /// # Errors
    /// All faults of the file, with their places.
    pub fn read(source: &Source) -> Result<SectionFile, Vec<Diagnostic>> {
        let (units, names, groups) = source.read(SECTIONS_FORMAT, check)?;
        let mut written: serde_json::Value = serde_json::from_str(&source.text)
            .map_err(|error| vec![Diagnostic::of_file(&source.name, error.to_string())])?;
        Ok(SectionFile {
            units,
            names,
            materials: written["materials"].take(),
            sections: written["sections"].take(),
            groups,
        })
    }
}

fn check(raw: &RawSectionFile, faults: &mut Faults) -> Option<Found> {
    let root = Place::root();
    super::format(&raw.format, SECTIONS_FORMAT, &root, faults);
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
    let tables = SectionTables {
        materials: &raw.materials,
        sections: &raw.sections,
    };
    let mut model = Model {
        theory: BeamTheory::Timoshenko,
        ..Model::default()
    };
    let names = sections::read(tables, &root, &mut model, &mut check);
    let _stress_points = stress::of_sections(tables, &root, &mut check);
    let _outlines = outline::of_sections(tables, &root, &mut check);
    let mut groups = named_groups(raw, &names, &root, &mut check);
    for (section, name) in names.iter().enumerate() {
        let is_used = groups.values().any(|group| group.section == section);
        if !is_used && !groups.contains_key(name) {
            let group = SectionGroup {
                section,
                ..SectionGroup::default()
            };
            groups.insert(name.clone(), group);
        }
    }
    // a member of each group, so that its section is checked for what this kind of member requires
    model.members = groups
        .values()
        .map(|group| Member {
            points: [0, 1],
            kind: group.kind,
            section: group.section,
            orientation: [0.0; 3],
            offsets: [[0.0; 3]; 2],
            releases: group.releases,
            tension: 0.0,
        })
        .collect();
    let uniform = vec![None; model.members.len()];
    let advice = ", unless `kind` in `members` is \"truss\" or \"rod\"";
    sections::check_complete(tables, &root, &model, &uniform, advice, &mut check);
    own.map(|units| (units, names, groups))
}

/// Reads the groups of `members`. Those of a section that does not exist are left out, with a fault.
fn named_groups(
    raw: &RawSectionFile,
    names: &[String],
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> BTreeMap<String, SectionGroup> {
    let known: Vec<(&str, usize)> = names
        .iter()
        .enumerate()
        .map(|(index, name)| (name.as_str(), index))
        .collect();
    let kinds = [
        ("beam", MemberKind::Beam),
        ("truss", MemberKind::Truss),
        ("rod", MemberKind::Rod),
    ];
    let mut groups = BTreeMap::new();
    let place = root.key("members");
    for (name, raw) in raw.members.iter().flat_map(|members| &members.0) {
        let at = place.key(name);
        let word = raw.kind.as_ref();
        let kind = word.and_then(|word| check.faults.one_of(word, &at.key("kind"), &kinds));
        let ends = [("release_a", &raw.release_a), ("release_b", &raw.release_b)];
        let releases = ends.map(|(key, words)| match words {
            Some(words) => dofs(words, &at.key(key), check),
            None => [false; 6],
        });
        let place = at.key("section");
        let (wanted, place) = match &raw.section {
            Some(own) => (own, &place),
            None => (name, &at),
        };
        let section = resolve(wanted, &known, "section", place, check.faults);
        groups.extend(section.map(|section| {
            let group = SectionGroup {
                section,
                kind: kind.unwrap_or_default(),
                orientation: raw.orientation,
                releases,
            };
            (name.clone(), group)
        }));
    }
    groups
}
