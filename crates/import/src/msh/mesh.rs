//! Contents of a mesh file: physical names, entities, nodes and line elements.

use std::collections::BTreeMap;

use super::text::{MeshBlock, sections};
use crate::findings::{FilePlace, ImportFinding, ImportFindings};

/// Advice for a mesh of another version.
pub(super) const CONVERT: &str = "convert it with: gmsh MESH.msh -save -format msh41 -o NEW.msh";

/// Elements that are not lines: number of each type, with the position of the first.
pub(super) type OtherElements = BTreeMap<u64, (FilePlace, u64)>;

/// The parts of a mesh that define a frame.
#[derive(Debug)]
pub struct Mesh {
    /// What messages call the entities of dimension 1, and their groups.
    pub group_words: [&'static str; 2],
    /// Name of each physical group by dimension and number.
    pub names: BTreeMap<(u64, u64), String>,
    /// Physical groups of each entity by dimension and number.
    pub groups: BTreeMap<(u64, u64), Vec<u64>>,
    /// Coordinates of each node.
    pub nodes: BTreeMap<u64, [f64; 3]>,
    /// Nodes of each entity of dimension 0.
    pub points: BTreeMap<u64, Vec<u64>>,
    /// Line elements by number.
    pub lines: BTreeMap<u64, MeshLine>,
}

/// A line element.
#[derive(Clone, Copy, Debug)]
pub struct MeshLine {
    /// Its curve.
    pub curve: u64,
    /// Nodes at its ends.
    pub ends: [u64; 2],
    /// Node between its ends, if it has three.
    pub middle: Option<u64>,
    /// Its position.
    pub at: FilePlace,
}

impl Default for Mesh {
    fn default() -> Mesh {
        Mesh {
            group_words: ["curve", "physical group"],
            names: BTreeMap::new(),
            groups: BTreeMap::new(),
            nodes: BTreeMap::new(),
            points: BTreeMap::new(),
            lines: BTreeMap::new(),
        }
    }
}

impl Mesh {
    /// Reads a mesh in the text of format 4.1 and adds its errors to the findings.
    pub fn read_41(&mut self, text: &str, findings: &mut ImportFindings) {
        let mut seen = Vec::new();
        for mut section in once_each(text, &mut seen, findings) {
            // `None` means that the section could not be read to its end, with an error among the findings
            let _whole = match section.name {
                "PhysicalNames" => self.read_names(&mut section, findings),
                "Entities" => self.read_entities(&mut section, findings),
                "Nodes" => self.read_nodes(&mut section, findings),
                "Elements" => self.read_elements(&mut section, findings),
                "PartitionedEntities" => {
                    let finding =
                        ImportFinding::new(section.at, "$PartitionedEntities", "is not supported");
                    findings.error(finding.hint("save the mesh without partitions"));
                    None
                }
                _ => Some(()),
            };
        }
        require(&["Entities", "Nodes", "Elements"], &seen, findings);
    }

    /// Reads `$PhysicalNames`, which is text in binary meshes too.
    pub(super) fn read_names(
        &mut self,
        section: &mut MeshBlock<'_>,
        findings: &mut ImportFindings,
    ) -> Option<()> {
        let count = section
            .next(findings)?
            .whole(0, "number of names", findings)?;
        for _ in 0..count {
            let record = section.next(findings)?;
            let dimension = record.whole(0, "dimension", findings)?;
            let tag = record.tag(1, "physical group", findings)?;
            let name = record
                .line
                .split_once('"')
                .and_then(|(_, rest)| rest.strip_suffix('"'));
            let Some(name) = name.filter(|name| !name.is_empty()) else {
                findings.error(ImportFinding::new(
                    record.at,
                    "name",
                    "must be in quotation marks",
                ));
                return None;
            };
            if self
                .names
                .insert((dimension, tag), name.to_owned())
                .is_some()
            {
                findings.error(
                    ImportFinding::new(record.at, "physical group", "has two names")
                        .with_found(tag),
                );
            }
        }
        Some(())
    }

    fn read_entities(
        &mut self,
        section: &mut MeshBlock<'_>,
        findings: &mut ImportFindings,
    ) -> Option<()> {
        let head = section.next(findings)?;
        let names = ["points", "curves", "surfaces", "volumes"];
        let mut counts = [0; 4];
        for (index, name) in names.into_iter().enumerate() {
            counts[index] = head.whole(index, name, findings)?;
        }
        for (dimension, count) in (0..).zip(counts) {
            // words before the groups: tag and coordinates of a point, or tag and bounding box of another entity
            let before = if dimension == 0 { 4 } else { 7 };
            for _ in 0..count {
                let record = section.next(findings)?;
                let tag = record.tag(0, "entity", findings)?;
                let groups = record.whole(before, "number of physical groups", findings)?;
                let mut list = Vec::new();
                for index in (before + 1..).take(usize::try_from(groups).unwrap_or(usize::MAX)) {
                    list.push(record.tag(index, "physical group", findings)?);
                }
                if self.groups.insert((dimension, tag), list).is_some() {
                    findings.error(
                        ImportFinding::new(record.at, "entity", "is defined twice").with_found(tag),
                    );
                }
            }
        }
        Some(())
    }

    fn read_nodes(
        &mut self,
        section: &mut MeshBlock<'_>,
        findings: &mut ImportFindings,
    ) -> Option<()> {
        let blocks = section
            .next(findings)?
            .whole(0, "number of blocks", findings)?;
        for _ in 0..blocks {
            let head = section.next(findings)?;
            let dimension = head.whole(0, "dimension", findings)?;
            let entity = head.tag(1, "entity", findings)?;
            let count = head.whole(3, "number of nodes", findings)?;
            let mut tags = Vec::new();
            for _ in 0..count {
                let record = section.next(findings)?;
                tags.push((record.whole(0, "node", findings)?, record.at));
            }
            for (tag, at) in tags {
                let record = section.next(findings)?;
                let mut place = [0.0; 3];
                for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                    place[axis] = record.coordinate(axis, name, findings)?;
                }
                self.add_node(tag, place, at, findings);
                if dimension == 0 {
                    self.points.entry(entity).or_default().push(tag);
                }
            }
        }
        Some(())
    }

    fn read_elements(
        &mut self,
        section: &mut MeshBlock<'_>,
        findings: &mut ImportFindings,
    ) -> Option<()> {
        let blocks = section
            .next(findings)?
            .whole(0, "number of blocks", findings)?;
        let mut others = OtherElements::new();
        for _ in 0..blocks {
            let head = section.next(findings)?;
            let dimension = head.whole(0, "dimension", findings)?;
            let entity = head.tag(1, "entity", findings)?;
            let kind = head.whole(2, "type of element", findings)?;
            let count = head.whole(3, "number of elements", findings)?;
            for _ in 0..count {
                let record = section.next(findings)?;
                let tag = record.whole(0, "element", findings)?;
                match kind {
                    LINE | LINE_OF_THREE => {
                        let ends = [
                            record.whole(1, "node", findings)?,
                            record.whole(2, "node", findings)?,
                        ];
                        let middle = if kind == LINE {
                            None
                        } else {
                            Some(record.whole(3, "node", findings)?)
                        };
                        let line = MeshLine {
                            curve: entity,
                            ends,
                            middle,
                            at: record.at,
                        };
                        self.add_line(tag, line, findings);
                    }
                    POINT if dimension == 0 => {
                        let node = record.whole(1, "node", findings)?;
                        self.add_point(entity, node);
                    }
                    _ => others.entry(kind).or_insert((record.at, 0)).1 += 1,
                }
            }
        }
        report_others(others, findings);
        Some(())
    }

    /// Adds a node of an element of dimension 0.
    pub(super) fn add_point(&mut self, entity: u64, node: u64) {
        let points = self.points.entry(entity).or_default();
        if !points.contains(&node) {
            points.push(node);
        }
    }

    /// Adds a line element.
    pub(super) fn add_line(&mut self, tag: u64, line: MeshLine, findings: &mut ImportFindings) {
        let MeshLine { ends, at, .. } = line;
        if ends[0] == ends[1] {
            findings.error(ImportFinding::new(
                at,
                format!("element {tag}"),
                "must connect two different nodes",
            ));
        }
        if self.lines.insert(tag, line).is_some() {
            findings.error(ImportFinding::new(at, "element", "is defined twice").with_found(tag));
        }
    }

    /// Adds a node.
    pub(super) fn add_node(
        &mut self,
        tag: u64,
        place: [f64; 3],
        at: FilePlace,
        findings: &mut ImportFindings,
    ) {
        if self.nodes.insert(tag, place).is_some() {
            findings.error(ImportFinding::new(at, "node", "is defined twice").with_found(tag));
        }
    }
}

/// Adds a warning for each type of element that is left out, and an error for lines of more than three nodes.
pub(super) fn report_others(others: OtherElements, findings: &mut ImportFindings) {
    for (kind, (at, count)) in others {
        let name = kind_name(kind);
        let about = format!("elements of type {kind}");
        if matches!(kind, 26..=28) {
            let expected = format!("{name} are not supported");
            let hint = "mesh with Mesh.ElementOrder = 1 or 2";
            findings.error(ImportFinding::new(at, about, expected).hint(hint));
        } else {
            findings.warn(ImportFinding::new(
                at,
                about,
                format!("{name} are ignored ({count} in total)"),
            ));
        }
    }
}

/// Sections that define the mesh, of which each may occur once. Others, such as results, may occur again and again.
pub(super) const SECTIONS: [&str; 6] = [
    "MeshFormat",
    "PhysicalNames",
    "Entities",
    "PartitionedEntities",
    "Nodes",
    "Elements",
];

/// The sections of a text that define the mesh; their names are added to `seen`.
pub(super) fn once_each<'t>(
    text: &'t str,
    seen: &mut Vec<&'t str>,
    findings: &mut ImportFindings,
) -> Vec<MeshBlock<'t>> {
    let mut kept = Vec::new();
    let known = |section: &MeshBlock<'_>| SECTIONS.contains(&section.name);
    for section in sections(text, findings).into_iter().filter(known) {
        if seen.contains(&section.name) {
            let about = format!("${}", section.name);
            findings.error(ImportFinding::new(
                section.at,
                about,
                "must occur only once",
            ));
        } else {
            seen.push(section.name);
            kept.push(section);
        }
    }
    kept
}

/// Adds an error for each section that a mesh without errors does not have.
pub(super) fn require(needed: &[&str], seen: &[&str], findings: &mut ImportFindings) {
    for name in needed {
        if !seen.contains(name) && !findings.has_errors() {
            let at = FilePlace {
                file: 0,
                line: 1,
                column: 1,
            };
            findings.error(ImportFinding::new(at, format!("${name}"), "is missing").hint(CONVERT));
        }
    }
}

/// Type of lines of two nodes.
pub(super) const LINE: u64 = 1;
/// Type of lines of three nodes, of which the third is between the others.
pub(super) const LINE_OF_THREE: u64 = 8;
/// Type of points.
pub(super) const POINT: u64 = 15;

const fn kind_name(kind: u64) -> &'static str {
    match kind {
        2 | 9 | 20..=25 => "triangles",
        3 | 10 | 16 => "quadrangles",
        4 | 11 | 29..=31 => "tetrahedra",
        5 | 12 | 17 => "hexahedra",
        6 | 13 | 18 => "prisms",
        7 | 14 | 19 => "pyramids",
        26..=28 => "lines of more than three nodes",
        15 => "points",
        _ => "elements of other kinds",
    }
}
