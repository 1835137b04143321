//! Meshes in the text of format 2: each element states its physical group and its entity.
//!
//! An element that belongs to several physical groups is in the file once for each of them, under different numbers.
//! Such elements become one, which belongs to all of the groups.

use std::collections::BTreeMap;

use super::mesh::{
    LINE, LINE_OF_THREE, Mesh, MeshLine, OtherElements, POINT, once_each, report_others, require,
};
use super::text::MeshBlock;
use crate::findings::{FilePlace, ImportFinding, ImportFindings};

/// An element of format 2.
#[derive(Clone, Copy, Debug)]
pub struct Element2<'n> {
    /// Its number.
    pub tag: u64,
    /// Its type.
    pub kind: u64,
    /// Its physical group, 0 if it has none.
    pub group: u64,
    /// Its entity.
    pub entity: u64,
    /// Its nodes; of a type that is left out there may be none.
    pub nodes: &'n [u64],
    /// Position of the element.
    pub at: FilePlace,
}

/// Adds elements of format 2 to a mesh.
#[derive(Debug, Default)]
pub struct ElementCollector {
    others: OtherElements,
    /// Number of the first line element with this entity and these nodes.
    lines: BTreeMap<(u64, [u64; 2]), u64>,
}

impl ElementCollector {
    /// Adds one element.
    pub fn add(&mut self, mesh: &mut Mesh, element: Element2<'_>, findings: &mut ImportFindings) {
        let dimension = match element.kind {
            LINE | LINE_OF_THREE => 1,
            POINT => 0,
            kind => {
                self.others.entry(kind).or_insert((element.at, 0)).1 += 1;
                return;
            }
        };
        let groups = mesh.groups.entry((dimension, element.entity)).or_default();
        if element.group > 0 && !groups.contains(&element.group) {
            groups.push(element.group);
        }
        match *element.nodes {
            [node] if dimension == 0 => mesh.add_point(element.entity, node),
            [a, b] | [a, b, _] if dimension == 1 => {
                let key = (element.entity, [a.min(b), a.max(b)]);
                if *self.lines.entry(key).or_insert(element.tag) == element.tag {
                    let line = MeshLine {
                        curve: element.entity,
                        ends: [a, b],
                        middle: element.nodes.get(2).copied(),
                        at: element.at,
                    };
                    mesh.add_line(element.tag, line, findings);
                }
            }
            _ => {
                let about = format!("element {}", element.tag);
                findings.error(ImportFinding::new(
                    element.at,
                    about,
                    "has the wrong number of nodes",
                ));
            }
        }
    }

    /// Reports the elements that were left out.
    pub fn finish(self, findings: &mut ImportFindings) {
        report_others(self.others, findings);
    }
}

/// Reads a mesh and adds its errors to the findings.
pub fn read(mesh: &mut Mesh, text: &str, findings: &mut ImportFindings) {
    let mut seen = Vec::new();
    for mut section in once_each(text, &mut seen, findings) {
        // `None` means that the section could not be read to its end, with an error among the findings
        let _whole = match section.name {
            "PhysicalNames" => mesh.read_names(&mut section, findings),
            "Nodes" => read_nodes(mesh, &mut section, findings),
            "Elements" => read_elements(mesh, &mut section, findings),
            _ => Some(()),
        };
    }
    require(&["Nodes", "Elements"], &seen, findings);
}

fn read_nodes(
    mesh: &mut Mesh,
    section: &mut MeshBlock<'_>,
    findings: &mut ImportFindings,
) -> Option<()> {
    let count = section
        .next(findings)?
        .whole(0, "number of nodes", findings)?;
    for _ in 0..count {
        let record = section.next(findings)?;
        let tag = record.whole(0, "node", findings)?;
        let mut place = [0.0; 3];
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            place[axis] = record.coordinate(axis + 1, name, findings)?;
        }
        mesh.add_node(tag, place, record.at, findings);
    }
    Some(())
}

fn read_elements(
    mesh: &mut Mesh,
    section: &mut MeshBlock<'_>,
    findings: &mut ImportFindings,
) -> Option<()> {
    let count = section
        .next(findings)?
        .whole(0, "number of elements", findings)?;
    let mut collector = ElementCollector::default();
    for _ in 0..count {
        let record = section.next(findings)?;
        let tag = record.whole(0, "element", findings)?;
        let kind = record.whole(1, "type of element", findings)?;
        let tags = record.whole(2, "number of tags", findings)?;
        let label = |index: u64, what: &str, findings: &mut ImportFindings| {
            if index < tags {
                record.tag(3 + index as usize, what, findings)
            } else {
                Some(0)
            }
        };
        let group = label(0, "physical group", findings)?;
        let entity = label(1, "entity", findings)?;
        let nodes = match kind {
            LINE => 2,
            LINE_OF_THREE => 3,
            POINT => 1,
            _ => 0,
        };
        let first = usize::try_from(tags)
            .unwrap_or(usize::MAX)
            .saturating_add(3);
        let mut list = Vec::new();
        for index in 0..nodes {
            list.push(record.whole(first.saturating_add(index), "node", findings)?);
        }
        let element = Element2 {
            tag,
            kind,
            group,
            entity,
            nodes: &list,
            at: record.at,
        };
        collector.add(mesh, element, findings);
    }
    collector.finish(findings);
    Some(())
}
