//! The contents of an Abaqus input file, sorted by type.

use std::collections::BTreeMap;

use super::keyword::{InpField, KeywordBlock};
use super::roles::{KeywordRole, advice, loss, role};
use super::section::{self, InpOrigin, InpSection};
use super::sets::InpSets;
use super::values::{key_of, positive, real, vector, whole};
use crate::bdf::Omissions;
use crate::findings::{FilePlace, ImportFinding, ImportFindings};

/// What an element is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InpKind {
    /// A beam; `sheared` if it deforms in shear.
    Beam {
        /// Whether it deforms in shear (B31), or not (B33).
        sheared: bool,
    },
    /// A bar.
    Truss,
    /// A spring to ground.
    Spring,
    /// A spring along the line between two nodes.
    AxialSpring,
    /// A point mass.
    Mass,
    /// Rotary inertia of a point.
    Rotary,
}

impl InpKind {
    /// Whether it becomes a member.
    #[must_use]
    pub fn is_member(self) -> bool {
        matches!(
            self,
            InpKind::Beam { .. } | InpKind::Truss | InpKind::AxialSpring
        )
    }
}

/// An element.
#[derive(Clone, Debug)]
pub struct InpElement {
    /// Position of its line.
    pub at: FilePlace,
    /// Its type.
    pub kind: InpKind,
    /// Its nodes without the middle one; a third one of a beam shows the direction of its 1-axis.
    pub nodes: Vec<u64>,
    /// The node between its ends, of a line of second order.
    pub middle: Option<u64>,
}

/// A material.
#[derive(Clone, Debug)]
pub struct InpMaterial {
    /// Its name.
    pub name: String,
    /// Position of its keyword.
    pub at: FilePlace,
    /// Young's modulus and Poisson's ratio.
    pub elastic: Option<[f64; 2]>,
    /// Mass per volume.
    pub density: Option<f64>,
}

/// Values of elements in a set: the stiffness and degree of freedom of springs, or masses.
#[derive(Clone, Debug)]
pub struct SetValues {
    /// The name of the set.
    pub set: InpField,
    /// The values: degree of freedom (0 if none is stated) and stiffness, mass, or moments of inertia.
    pub values: Vec<f64>,
}

/// How two nodes are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Joint {
    /// Rigidly.
    Rigid,
    /// Rigidly, but with free rotations.
    Pinned,
    /// Equal displacements and rotations, for which the nodes must coincide.
    Tied,
}

/// Nodes joined to another one.
#[derive(Clone, Debug)]
pub struct JointRequest {
    /// The kind of joint.
    pub joint: Joint,
    /// A node or the name of a set of nodes: those that follow.
    pub followers: InpField,
    /// The node that leads.
    pub leader: InpField,
}

/// Released rotations of an end of elements.
#[derive(Clone, Debug)]
pub struct ReleaseRequest {
    /// An element or the name of a set of elements.
    pub target: InpField,
    /// The end.
    pub end: usize,
    /// Released local degrees of freedom.
    pub release: [bool; 6],
}

/// A boundary condition at a node or a set of nodes.
#[derive(Clone, Debug)]
pub struct InpBoundary {
    /// A node or the name of a set of nodes.
    pub target: InpField,
    /// Restrained global degrees of freedom.
    pub fix: [bool; 6],
}

/// The contents of a file.
#[derive(Debug, Default)]
pub struct InpModel {
    /// Coordinates of nodes.
    pub nodes: BTreeMap<u64, [f64; 3]>,
    /// Elements.
    pub elements: BTreeMap<u64, InpElement>,
    /// Number of elements of each type that is not a member or is left out.
    pub others: BTreeMap<String, usize>,
    /// Sets of nodes.
    pub node_sets: InpSets,
    /// Sets of elements.
    pub element_sets: InpSets,
    /// Materials.
    pub materials: Vec<InpMaterial>,
    /// Sections.
    pub sections: Vec<InpSection>,
    /// Boundary conditions.
    pub boundaries: Vec<InpBoundary>,
    /// Joints of nodes.
    pub joints: Vec<JointRequest>,
    /// Releases of beams.
    pub releases: Vec<ReleaseRequest>,
    /// Springs: degree of freedom and stiffness.
    pub springs: Vec<SetValues>,
    /// Point masses.
    pub masses: Vec<SetValues>,
    /// Rotary inertias.
    pub inertias: Vec<SetValues>,
    /// Number of steps begun so far.
    pub(super) steps: usize,
    instances: usize,
}

type Counts = BTreeMap<String, (FilePlace, usize)>;

impl InpModel {
    /// Sorts the keywords of a file by type; `omit` names keywords and types of elements that are left out.
    pub fn new(
        blocks: &[KeywordBlock],
        omit: Omissions<'_>,
        findings: &mut ImportFindings,
    ) -> InpModel {
        let mut model = InpModel::default();
        let origin = InpOrigin::of(blocks);
        let [mut left_out, mut unused, mut unknown] = [Counts::new(), Counts::new(), Counts::new()];
        let count = |counts: &mut Counts, name: &str, at: FilePlace| {
            counts.entry(name.to_owned()).or_insert((at, 0)).1 += 1;
        };
        for block in blocks.iter().filter(|block| !omit.skips(&block.name)) {
            if block.name == "ELEMENT" {
                model.read_elements(block, omit, &mut unknown, findings);
            } else if !model.take(block, omit, origin, findings) {
                match role(&block.name) {
                    Some(KeywordRole::Frame) => model.steps += usize::from(block.name == "STEP"),
                    Some(KeywordRole::Request) => count(&mut left_out, &block.label(), block.at),
                    Some(KeywordRole::NoStiffness) if omit.unused => {
                        count(&mut unused, &block.label(), block.at);
                    }
                    _ => count(&mut unknown, &block.label(), block.at),
                }
            }
        }
        for (name, (at, number)) in left_out {
            findings.warn(ImportFinding::new(
                at,
                name,
                format!("is ignored ({})", times(number)),
            ));
        }
        for (name, (at, number)) in unused {
            let message = format!(
                "is ignored ({}): it does not affect the stiffness",
                times(number)
            );
            findings.warn(ImportFinding::new(at, name, message));
        }
        for (name, (at, number)) in unknown {
            let word = name.trim_start_matches('*');
            let hint = if role(word) == Some(KeywordRole::NoStiffness) {
                format!(
                    "it does not affect the stiffness: ignore it with --skip-unused or --skip \"{word}\""
                )
            } else if let Some(loss) = loss(word) {
                format!("{}; {loss}", advice(word))
            } else {
                format!(
                    "{}; if it can be ignored, add --skip \"{word}\"",
                    advice(word)
                )
            };
            let finding =
                ImportFinding::new(at, name, format!("is not supported ({})", times(number)));
            findings.error(finding.hint(hint));
        }
        model
    }

    /// Reads a keyword that defines part of the structure; returns false for any other.
    fn take(
        &mut self,
        block: &KeywordBlock,
        omit: Omissions<'_>,
        origin: InpOrigin,
        findings: &mut ImportFindings,
    ) -> bool {
        match block.name.as_str() {
            "NODE" => self.read_nodes(block, findings),
            "NSET" => self.node_sets.read(block, "NSET", findings),
            "ELSET" => self.element_sets.read(block, "ELSET", findings),
            "MATERIAL" => {
                if let Some(name) = block.required("NAME", findings) {
                    let (name, at) = (name.text.clone(), block.at);
                    self.materials.push(InpMaterial {
                        name,
                        at,
                        elastic: None,
                        density: None,
                    });
                }
            }
            "ELASTIC" | "DENSITY" => self.read_material(block, findings),
            "BEAM SECTION" => self
                .sections
                .extend(section::beam(block, false, origin, findings)),
            "BEAM GENERAL SECTION" => self
                .sections
                .extend(section::beam(block, true, origin, findings)),
            "SOLID SECTION" => self.sections.extend(section::solid(block, findings)),
            "TRANSVERSE SHEAR STIFFNESS" => self.read_shear(block, findings),
            "BOUNDARY" => self.read_boundary(block, omit, findings),
            "RIGID BODY" => self.read_rigid_body(block, findings),
            "MPC" => self.read_mpc(block, findings),
            "RELEASE" => self.read_release(block, findings),
            "SPRING" => self.read_spring(block, findings),
            "MASS" | "ROTARY INERTIA" => self.read_mass(block, findings),
            "PART" => {}
            "INSTANCE" => {
                self.instances += 1;
                if self.instances > 1 || !block.data.is_empty() {
                    let expected =
                        "must be the only instance, and must not be translated or rotated";
                    let hint = "write the model as a flat input file (without parts)";
                    findings
                        .error(ImportFinding::new(block.at, block.label(), expected).hint(hint));
                }
            }
            _ => return false,
        }
        true
    }

    /// Reads the degree of freedom and the stiffness of springs. The first line is blank, and is then left out of the data,
    /// for springs along the line between their nodes.
    fn read_spring(&mut self, block: &KeywordBlock, findings: &mut ImportFindings) {
        if let Some(parameter) = block.parameter("NONLINEAR") {
            let about = format!("{}: NONLINEAR", block.label());
            let finding = ImportFinding::new(parameter.at, about, "is not supported");
            findings.error(finding.hint("state the stiffness of a linear spring"));
            return;
        }
        let (dof, stiffness) = match block.data.as_slice() {
            [stiffness] => (Some(0), Some(stiffness)),
            [first, stiffness] if first.iter().all(|field| field.text.is_empty()) => {
                (Some(0), Some(stiffness))
            }
            [first, stiffness] => (
                whole(block, first, 0, "degree of freedom", findings),
                Some(stiffness),
            ),
            _ => (None, None),
        };
        let k = stiffness.and_then(|line| positive(block, line, 0, "stiffness", findings));
        match (block.required("ELSET", findings), dof, k) {
            (Some(set), Some(dof @ 0..=6), Some(k)) => self.springs.push(SetValues {
                set: set.clone(),
                values: vec![dof as f64, k],
            }),
            _ => {
                let expected = "must have a degree of freedom from 1 to 6 and, on the next line, one stiffness";
                let hint = "the degree of freedom is blank for SPRINGA; stiffnesses that depend on temperature are not \
                            supported";
                findings.error(ImportFinding::new(block.at, block.label(), expected).hint(hint));
            }
        }
    }

    fn read_nodes(&mut self, block: &KeywordBlock, findings: &mut ImportFindings) {
        if let Some(system) = block
            .parameter("SYSTEM")
            .filter(|system| !system.text.eq_ignore_ascii_case("R"))
        {
            let finding = ImportFinding::new(
                system.at,
                "*NODE: SYSTEM",
                "must be R (rectangular coordinates)",
            );
            findings.error(finding.with_found(&system.text));
        }
        let set = block.parameter("NSET").map(|name| name.text.clone());
        for line in &block.data {
            let number = whole(block, line, 0, "node", findings);
            let at = vector(block, line, 1, ["x", "y", "z"], findings);
            let (Some(number), Some(at)) = (number, at) else {
                continue;
            };
            if self.nodes.insert(number, at).is_some() {
                let finding = ImportFinding::new(line[0].at, "*NODE: node", "is defined twice");
                findings.error(
                    finding
                        .with_found(number)
                        .hint("node numbers must be unique in the whole model"),
                );
            }
            if let Some(set) = &set {
                self.node_sets.add(set, number);
            }
        }
    }

    fn read_elements(
        &mut self,
        block: &KeywordBlock,
        omit: Omissions<'_>,
        unknown: &mut Counts,
        findings: &mut ImportFindings,
    ) {
        let Some(word) = block.required("TYPE", findings) else {
            return;
        };
        let word = word.text.to_uppercase();
        let set = block.parameter("ELSET").map(|name| name.text.clone());
        if let Some(set) = &set {
            self.element_sets.define(set);
        }
        if omit.skips(&word) {
            *self.others.entry(word).or_insert(0) += block.data.len();
            return;
        }
        let sheared = InpKind::Beam { sheared: true };
        let (kind, least, most) = match word.as_str() {
            "B31" | "B31H" | "B31R" => (sheared, 2, 3),
            "B32" | "B32H" | "B32R" => (sheared, 3, 4),
            "B33" | "B33H" => (InpKind::Beam { sheared: false }, 2, 3),
            "T3D2" | "T3D2H" => (InpKind::Truss, 2, 2),
            "T3D3" | "T3D3H" => (InpKind::Truss, 3, 3),
            "SPRING1" => (InpKind::Spring, 1, 1),
            "SPRINGA" => (InpKind::AxialSpring, 2, 2),
            "MASS" => (InpKind::Mass, 1, 1),
            "ROTARYI" => (InpKind::Rotary, 1, 1),
            _ => {
                *self.others.entry(word.clone()).or_insert(0) += block.data.len();
                unknown.entry(word).or_insert((block.at, 0)).1 += block.data.len();
                return;
            }
        };
        if !kind.is_member() {
            *self.others.entry(word.clone()).or_insert(0) += block.data.len();
        }
        let has_middle = word.starts_with("B32") || word.starts_with("T3D3");
        for line in &block.data {
            let Some(number) = whole(block, line, 0, "element", findings) else {
                continue;
            };
            let mut nodes = Vec::new();
            for index in 1..line.len().max(least + 1) {
                nodes.extend(whole(block, line, index, "node", findings));
            }
            if nodes.len() > most {
                let expected = format!("must have at most {most} nodes");
                findings.error(ImportFinding::new(
                    line[0].at,
                    format!("element {number}"),
                    expected,
                ));
            }
            if nodes.len() < least {
                continue;
            }
            let middle = has_middle.then(|| nodes.remove(1));
            let element = InpElement {
                at: line[0].at,
                kind,
                nodes,
                middle,
            };
            if self.elements.insert(number, element).is_some() {
                let finding =
                    ImportFinding::new(line[0].at, "*ELEMENT: element", "is defined twice");
                findings.error(
                    finding
                        .with_found(number)
                        .hint("element numbers must be unique in the whole model"),
                );
            }
            if let Some(set) = &set {
                self.element_sets.add(set, number);
            }
        }
    }

    fn read_material(&mut self, block: &KeywordBlock, findings: &mut ImportFindings) {
        let refuse = |expected: &str| ImportFinding::new(block.at, block.label(), expected);
        let Some(material) = self.materials.last_mut() else {
            findings.error(refuse("must follow *MATERIAL"));
            return;
        };
        let [line] = block.data.as_slice() else {
            findings.error(
                refuse("must have one data line")
                    .hint("temperature-dependent properties are not supported"),
            );
            return;
        };
        if block.name == "DENSITY" {
            material.density = positive(block, line, 0, "density", findings);
            return;
        }
        if let Some(kind) = block
            .parameter("TYPE")
            .filter(|kind| !kind.text.to_uppercase().starts_with("ISO"))
        {
            findings.error(
                ImportFinding::new(kind.at, "*ELASTIC: TYPE", "must be ISOTROPIC")
                    .with_found(&kind.text),
            );
            return;
        }
        let e = positive(block, line, 0, "E", findings);
        let nu = real(block, line, 1, ("Poisson's ratio", Some(0.0)), findings);
        let (Some(e), Some(nu)) = (e, nu) else { return };
        if !(nu > -1.0 && nu <= 0.5) {
            findings.error(
                refuse("must have a Poisson's ratio greater than -1 and at most 0.5")
                    .with_found(nu),
            );
            return;
        }
        material.elastic = Some([e, nu]);
    }

    fn read_shear(&mut self, block: &KeywordBlock, findings: &mut ImportFindings) {
        let line = block.data.first().map(Vec::as_slice).unwrap_or_default();
        // K23 resists shear along the 2-axis, K13 along the 1-axis
        let along_2 = positive(block, line, 0, "K23", findings);
        let along_1 = positive(block, line, 1, "K13", findings);
        match (
            self.sections.last_mut().filter(|section| section.is_beam),
            along_1,
            along_2,
        ) {
            (Some(section), Some(along_1), Some(along_2)) => {
                section.shear_stiffness = Some([along_1, along_2])
            }
            (None, ..) => {
                findings.error(ImportFinding::new(
                    block.at,
                    block.label(),
                    "must follow a beam section",
                ));
            }
            _ => {}
        }
    }

    fn read_mass(&mut self, block: &KeywordBlock, findings: &mut ImportFindings) {
        let Some(set) = block.required("ELSET", findings).cloned() else {
            return;
        };
        let line = block.data.first().map(Vec::as_slice).unwrap_or_default();
        if block.name == "MASS" {
            let mass = positive(block, line, 0, "mass", findings);
            self.masses.extend(mass.map(|mass| SetValues {
                set,
                values: vec![mass],
            }));
            return;
        }
        let mut values = Vec::new();
        for (index, name) in ["I11", "I22", "I33", "I12", "I13", "I23"]
            .into_iter()
            .enumerate()
        {
            let Some(value) = real(block, line, index, (name, Some(0.0)), findings) else {
                return;
            };
            values.push(value);
        }
        if values[..3].iter().any(|moment| *moment < 0.0)
            || values[3..].iter().any(|product| *product != 0.0)
        {
            let expected = "must have non-negative moments of inertia and no products of inertia";
            findings.error(ImportFinding::new(block.at, block.label(), expected));
            return;
        }
        values.truncate(3);
        self.inertias.push(SetValues { set, values });
    }

    /// The numbers of a target among `known`: of a set, or the number itself. Adds an error if there is no such set or
    /// number.
    pub fn targets<T>(
        sets: &InpSets,
        known: &BTreeMap<u64, T>,
        target: &InpField,
        about: &str,
        findings: &mut ImportFindings,
    ) -> Vec<u64> {
        if let Some(set) = sets.get(&target.text) {
            return set.numbers(known);
        }
        if let Some(number) =
            super::values::number_of(&target.text).filter(|number| known.contains_key(number))
        {
            return vec![number];
        }
        let expected = "refers to a set or number that does not exist";
        findings
            .error(ImportFinding::new(target.at, about, expected).with_found(key_of(&target.text)));
        Vec::new()
    }
}

fn times(number: usize) -> String {
    if number == 1 {
        "occurs once".to_owned()
    } else {
        format!("occurs {number} times")
    }
}
