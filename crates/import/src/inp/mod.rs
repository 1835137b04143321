//! Abaqus input files: beams and trusses with their sections, supports, springs, rigid links and masses.
//!
//! A file is read in three stages: `keyword` divides it into keywords with data lines, `model` sorts them by type, and
//! `resolve` replaces numbers and names by indices into a structure. Files of parts are read in the flat form: one
//! part with one instance that is not moved.
//!
//! A file without sections, as gmsh and meshio write it, needs a sections file; its sets of elements and nodes then
//! have the meaning of physical groups of a mesh.
//!
//! # Source
//! Abaqus Keywords Reference Guide; Abaqus Analysis User's Guide, part VI (beam elements, their axes and sections).

mod assign;
mod constraint;
mod keyword;
mod model;
mod resolve;
mod roles;
mod scope;
mod section;
mod sets;
mod values;

use std::collections::BTreeMap;
use std::io;
use std::path::Path;

use super::bdf::Omissions;
use super::findings::{FilePlace, ImportFinding, ImportFindings};
use super::includes::OpenFile;
use super::msh::{Mesh, MeshLine, structure_of};
use super::structure::ImportedStructure;
use formats::spec::SectionFile;
use model::{InpKind, InpModel};

/// Reads a file into `empty`, a structure that has a name, units and the upward direction only. `omit` states what is
/// left out.
///
/// # Errors
/// The file cannot be read; all other errors are among the findings.
pub fn read(
    path: &Path,
    open: OpenFile<'_>,
    empty: ImportedStructure,
    omit: Omissions<'_>,
    findings: &mut ImportFindings,
) -> io::Result<ImportedStructure> {
    let model = model(path, open, omit, findings)?;
    // a reference to something that could not be read would cause a second, misleading error
    if findings.has_errors() {
        return Ok(empty);
    }
    Ok(resolve::resolve(&model, empty, findings))
}

/// The model of a file.
fn model(
    path: &Path,
    open: OpenFile<'_>,
    omit: Omissions<'_>,
    findings: &mut ImportFindings,
) -> io::Result<InpModel> {
    let mut blocks = keyword::read(path, open, findings)?;
    scope::with_instances(&mut blocks);
    Ok(InpModel::new(&blocks, omit, findings))
}

/// Reads a file without sections into `empty`. `factor` converts its coordinates to the unit of length of the structure,
/// and `groups` are the sections of its sets of elements.
///
/// # Errors
/// As [`read`].
pub fn read_mesh(
    path: &Path,
    open: OpenFile<'_>,
    factor: f64,
    groups: &SectionFile,
    empty: ImportedStructure,
    omit: Omissions<'_>,
    findings: &mut ImportFindings,
) -> io::Result<ImportedStructure> {
    let model = model(path, open, omit, findings)?;
    if let Some(section) = model.sections.first() {
        let finding = ImportFinding::new(
            section.set.at,
            &section.label,
            "must not occur in a file that is read with --sections",
        );
        findings.error(finding.hint("omit --sections: the file contains its own sections"));
    }
    refuse_beside_lines(&model, findings);
    if findings.has_errors() {
        return Ok(empty);
    }
    let mut mesh = Mesh {
        group_words: ["element", "set of elements"],
        nodes: model.nodes.clone(),
        ..Mesh::default()
    };
    // each element is an entity of its own, and each set a group
    for (&number, element) in &model.elements {
        if let (InpKind::Beam { .. } | InpKind::Truss, [a, b, ..]) =
            (element.kind, element.nodes.as_slice())
        {
            let line = MeshLine {
                curve: number,
                ends: [*a, *b],
                middle: element.middle,
                at: element.at,
            };
            mesh.lines.insert(number, line);
        }
    }
    for (group, set) in (1..).zip(model.element_sets.iter()) {
        mesh.names.insert((1, group), set.name.clone());
        for number in set.numbers(&mesh.lines) {
            mesh.groups.entry((1, number)).or_default().push(group);
        }
    }
    for (group, set) in (1..).zip(model.node_sets.iter()) {
        mesh.names.insert((0, group), set.name.clone());
        mesh.groups.insert((0, group), vec![group]);
        mesh.points.insert(group, set.numbers(&mesh.nodes));
    }
    Ok(structure_of(&mesh, factor, groups, empty, findings))
}

/// Adds an error for each type of content of a file without sections that would be lost, because only its lines, points and
/// sets are read.
fn refuse_beside_lines(model: &InpModel, findings: &mut ImportFindings) {
    let other = |kind: InpKind| match kind {
        InpKind::Spring => Some("SPRING1"),
        InpKind::AxialSpring => Some("SPRINGA"),
        InpKind::Mass => Some("MASS"),
        InpKind::Rotary => Some("ROTARYI"),
        InpKind::Beam { .. } | InpKind::Truss => None,
    };
    let elements = model.elements.values();
    let elements = elements.filter_map(|element| Some((other(element.kind)?, element.at)));
    let supports = model.boundaries.iter();
    let supports = supports.map(|support| ("*BOUNDARY", support.target.at));
    let joints = model.joints.iter();
    let joints = joints.map(|joint| ("*MPC or *RIGID BODY", joint.leader.at));
    let releases = model.releases.iter();
    let releases = releases.map(|release| ("*RELEASE", release.target.at));
    let all = elements.chain(supports).chain(joints).chain(releases);
    let first: BTreeMap<&str, FilePlace> = all.rev().collect();
    for (name, at) in first {
        let hint = match name {
            "*BOUNDARY" => "state supports with --fix, and add --skip BOUNDARY",
            "*RELEASE" => {
                "state releases in `members` of the sections file, and add --skip RELEASE"
            }
            "*MPC or *RIGID BODY" => {
                "assign sections in the file and omit --sections, or leave these out: --skip MPC,\"RIGID BODY\""
            }
            _ => {
                "assign sections in the file and omit --sections, or leave these elements out with --skip"
            }
        };
        let expected = "is not supported in a file that is read with --sections";
        findings.error(ImportFinding::new(at, name, expected).hint(hint));
    }
}
