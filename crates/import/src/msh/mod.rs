//! Meshes of gmsh in formats 2.2 and 4.1, text or binary, whose line elements become members.
//!
//! Each curve must belong to exactly one physical group that the sections file defines, either as the name of a
//! section or as an entry of `members`. This group determines section, orientation and releases of the members.
//! Physical groups of points become sets of points, for supports. Other elements are ignored with a warning.
//!
//! # Source
//! Gmsh reference manual, section "MSH file format".

mod binary;
mod header;
mod mesh;
mod text;
mod version2;

use std::collections::{BTreeMap, BTreeSet};

use fea::MemberKind;
pub use mesh::{Mesh, MeshLine};

use super::findings::{FilePlace, ImportFinding, ImportFindings};
use super::halves::{check_straight, push_halves};
use super::structure::{ImportedMember, ImportedPoint, ImportedStructure, WrittenTables};
use formats::spec::{SectionFile, SectionGroup};
use formats::vector::{minus, parallel};
use header::MeshVersion;

/// Reads a mesh into `empty`, a structure that has a name, units and the upward direction only. `factor` converts
/// coordinates of the mesh to the unit of length of the structure. Errors are added to the findings.
#[must_use]
pub fn read(
    bytes: &[u8],
    factor: f64,
    groups: &SectionFile,
    empty: ImportedStructure,
    findings: &mut ImportFindings,
) -> ImportedStructure {
    let mesh = read_mesh(bytes, findings);
    if findings.has_errors() {
        return empty;
    }
    structure_of(&mesh, factor, groups, empty, findings)
}

/// Converts a mesh to a structure in `empty` (see [`read`]).
#[must_use]
pub fn structure_of(
    mesh: &Mesh,
    factor: f64,
    groups: &SectionFile,
    empty: ImportedStructure,
    findings: &mut ImportFindings,
) -> ImportedStructure {
    let mut structure = empty;
    structure.written = Some(WrittenTables {
        materials: groups.materials.clone(),
        sections: groups.sections.clone(),
    });
    // curves for which an error was added, so that each causes one error instead of one for each of its elements
    let mut reported = BTreeSet::new();
    let mut lines = Vec::new();
    for (&id, line) in &mesh.lines {
        let names = names(mesh, 1, line.curve);
        if let Some(name) = group_of(mesh, line, &names, groups, &mut reported, findings) {
            lines.push(GroupedLine {
                id,
                line,
                names,
                name,
                group: &groups.groups[name],
            });
        }
    }
    let index = points(mesh, &lines, factor, &mut structure);
    let mut sets: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for GroupedLine {
        id,
        line,
        names,
        name,
        group,
    } in lines
    {
        let MeshLine { curve, at, .. } = *line;
        let about = format!("element {id}");
        let nodes = [Some(line.ends[0]), Some(line.ends[1]), line.middle];
        if let Some(missing) = nodes
            .into_iter()
            .flatten()
            .find(|node| !mesh.nodes.contains_key(node))
        {
            findings.error(
                ImportFinding::new(at, about, "refers to a node that does not exist")
                    .with_found(missing),
            );
            continue;
        }
        let place = |node: u64| mesh.nodes[&node].map(|part| part * factor);
        let ends = line.ends.map(place);
        let along = minus(ends[1], ends[0]);
        let orientation = group.orientation.or(structure.up);
        if along == [0.0; 3] {
            findings.error(ImportFinding::new(at, about, "must have a positive length"));
            continue;
        }
        if let Some(middle) = line.middle {
            let bends = group.kind == MemberKind::Beam;
            let wrong = check_straight(ends, place(middle)).err();
            let wrong = wrong.or_else(|| {
                let is_joined = !bends && index.contains_key(&middle);
                is_joined.then(|| axial_middle(group.kind))
            });
            if let Some([expected, hint]) = wrong {
                findings.error(ImportFinding::new(at, about, expected).hint(hint));
                continue;
            }
        }
        if group.kind == MemberKind::Beam
            && orientation.is_none_or(|vector| parallel(vector, along))
        {
            if reported.insert(curve) {
                let hint = format!(
                    "specify the `orientation` of \"{name}\" in `members` of the sections file"
                );
                let expected = "must have an orientation vector that is not parallel to it";
                findings.error(ImportFinding::new(at, about, expected).hint(hint));
            }
            continue;
        }
        let first = structure.members.len();
        let member = ImportedMember {
            id,
            points: line.ends.map(|node| index[&node]),
            kind: group.kind,
            section: group.section,
            section_b: None,
            orientation: group.orientation.filter(|_| group.kind == MemberKind::Beam),
            offsets: [[0.0; 3]; 2],
            releases: group.releases,
        };
        match line.middle.filter(|_| group.kind == MemberKind::Beam) {
            Some(middle) => push_halves(&mut structure, member, index[&middle]),
            None => structure.members.push(member),
        }
        for name in names {
            sets.entry(name)
                .or_default()
                .extend(first..structure.members.len());
        }
    }
    if structure.members.is_empty() && !findings.has_errors() {
        let at = FilePlace {
            file: 0,
            line: 1,
            column: 1,
        };
        let hint = "mesh the curves (gmsh -1), and assign them to physical groups";
        findings.error(ImportFinding::new(at, "", "contains no line elements").hint(hint));
    }
    structure.cell_sets = sets
        .into_iter()
        .map(|(name, set)| (name.to_owned(), set))
        .collect();
    structure
}

/// A line element with the physical groups of its curve, and the one that the sections file defines.
struct GroupedLine<'m> {
    id: u64,
    line: &'m MeshLine,
    names: Vec<&'m str>,
    name: &'m str,
    group: &'m SectionGroup,
}

/// The message and hint for the middle node of a truss or rod to which something else is joined. Nothing but the end
/// nodes could hold it aside.
fn axial_middle(kind: MemberKind) -> [String; 2] {
    let name = if kind == MemberKind::Rod {
        "rod"
    } else {
        "truss"
    };
    [
        format!("must have a middle node that no other element uses, because it is a {name}"),
        "end the element at this node, or mesh with Mesh.ElementOrder = 1".to_owned(),
    ]
}

/// Reads the contents of a mesh of any format; its errors are among the findings.
fn read_mesh(bytes: &[u8], findings: &mut ImportFindings) -> Mesh {
    let mut mesh = Mesh::default();
    // the header is text in binary meshes too
    let text = String::from_utf8_lossy(bytes);
    if let Some(format) = header::format(&text, findings) {
        match format.version {
            _ if format.binary => binary::read(&mut mesh, bytes, format.version, findings),
            MeshVersion::FourOne => mesh.read_41(&text, findings),
            MeshVersion::Two => version2::read(&mut mesh, &text, findings),
        }
    }
    mesh
}

/// The only one of the physical groups `names` of a curve that the sections file defines. If there is no such group
/// or there are several, an error is added unless the curve is among `reported`.
fn group_of<'m>(
    mesh: &Mesh,
    line: &MeshLine,
    names: &[&'m str],
    groups: &SectionFile,
    reported: &mut BTreeSet<u64>,
    findings: &mut ImportFindings,
) -> Option<&'m str> {
    let mut known = names
        .iter()
        .filter(|name| groups.groups.contains_key(**name));
    if let (Some(&only), None) = (known.next(), known.next()) {
        return Some(only);
    }
    let MeshLine { curve, at, .. } = *line;
    if reported.insert(curve) {
        let known: Vec<&str> = groups.groups.keys().map(String::as_str).collect();
        let [entity, set] = mesh.group_words;
        let expected = format!(
            "must be in exactly one {set} that the sections file defines, {}",
            list(names)
        );
        let hint = format!("the sections file defines {}", known.join(", "));
        findings.error(ImportFinding::new(at, format!("{entity} {curve}"), expected).hint(hint));
    }
    None
}

/// Part of a message that lists the physical groups of a curve.
fn list(names: &[&str]) -> String {
    if names.is_empty() {
        "but is in none that has a name".to_owned()
    } else {
        format!("but is in {}", names.join(", "))
    }
}

/// Names of the physical groups to which an entity belongs.
fn names(mesh: &Mesh, dimension: u64, entity: u64) -> Vec<&str> {
    let groups = mesh.groups.get(&(dimension, entity)).into_iter().flatten();
    groups
        .filter_map(|group| mesh.names.get(&(dimension, *group)).map(String::as_str))
        .collect()
}

/// Adds the nodes of line elements and of physical points in the order of their numbers, and a set for each physical
/// group of points. Middle nodes of trusses and rods are left out. Returns the index of the point of each node.
fn points(
    mesh: &Mesh,
    lines: &[GroupedLine<'_>],
    factor: f64,
    structure: &mut ImportedStructure,
) -> BTreeMap<u64, usize> {
    let mut named: BTreeMap<&str, Vec<u64>> = BTreeMap::new();
    for (entity, nodes) in &mesh.points {
        for name in names(mesh, 0, *entity) {
            named.entry(name).or_default().extend(nodes);
        }
    }
    let mut used: Vec<u64> = lines.iter().flat_map(|own| own.line.ends).collect();
    let mut middles = BTreeSet::new();
    for own in lines {
        // a middle node of two trusses joins them
        let is_new = own.line.middle.is_none_or(|middle| middles.insert(middle));
        if own.group.kind == MemberKind::Beam || !is_new {
            used.extend(own.line.middle);
        }
    }
    used.extend(named.values().flatten());
    used.sort_unstable();
    used.dedup();
    let mut index = BTreeMap::new();
    for node in used {
        if let Some(at) = mesh.nodes.get(&node) {
            index.insert(node, structure.points.len());
            structure.points.push(ImportedPoint {
                name: String::new(),
                at: at.map(|part| part * factor),
            });
        }
    }
    for (name, mut nodes) in named {
        nodes.sort_unstable();
        nodes.dedup();
        let set: Vec<usize> = nodes
            .iter()
            .filter_map(|node| index.get(node).copied())
            .collect();
        structure.point_sets.push((name.to_owned(), set));
    }
    index
}
