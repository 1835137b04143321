//! Sections of beams and trusses: *BEAM SECTION, *BEAM GENERAL SECTION and *SOLID SECTION.
//!
//! The 1-axis n1 of a beam is the local y axis of a beam spec, and the 2-axis its z axis. I11 is the second moment for
//! bending about the 1-axis, the integral of the square of the 2-coordinate. Areas and second moments of shapes are exact;
//! torsion constants are those of `formats`. Shear areas are k A with the factors k of the Abaqus guide.
//!
//! CalculiX has the same shapes, but states the diameter of a circle where Abaqus states the radius, takes two different
//! diameters as those of an ellipse along n1 and the 2-axis, and one dimension of a rectangle as that of a square. A shape
//! whose word begins with RECT is a rectangle.
//!
//! # Source
//! Abaqus Analysis User's Guide, "Beam cross-section library" (dimensions) and "Choosing a beam element" (transverse
//! shear: k = 0.85 for rectangles, 0.89 for circles, 0.53 for pipes, 0.44 for boxes and I sections, 1 for general ones). CalculiX user's manual, *BEAM SECTION.

use super::keyword::{InpField, KeywordBlock};
use super::values::{positive, real, vector};
use crate::findings::{ImportFinding, ImportFindings};
use formats::spec::cross_section::{Properties, section_properties};
use std::f64::consts::PI;

/// The material of a section.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialOf {
    /// The name of a *MATERIAL.
    Named(InpField),
    /// E, G and the density, stated with the section.
    Own([f64; 3]),
}

/// Numbers of a cross section, in the axes of a beam spec.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SectionNumbers {
    /// Area.
    pub area: f64,
    /// Integral of z^2, with z along the 2-axis: I11.
    pub iy: f64,
    /// Integral of y^2, with y along the 1-axis: I22.
    pub iz: f64,
    /// Integral of y z: I12.
    pub product: f64,
    /// Torsion constant.
    pub j: f64,
    /// Shear factor.
    pub k: f64,
}

/// A section assigned to a set of elements.
#[derive(Clone, Debug)]
pub struct InpSection {
    /// Name of the set of elements.
    pub set: InpField,
    /// Its keyword, for messages.
    pub label: String,
    /// Its material.
    pub material: MaterialOf,
    /// Its numbers; trusses have the area only.
    pub numbers: SectionNumbers,
    /// Whether it belongs to beams.
    pub is_beam: bool,
    /// Whether its dimension is a radius in Abaqus and a diameter in CalculiX, and the file does not show for which it is.
    pub is_unclear_circle: bool,
    /// Direction of the 1-axis.
    pub n1: [f64; 3],
    /// Transverse shear stiffnesses along the 1-axis and the 2-axis, in place of k G A.
    pub shear_stiffness: Option<[f64; 2]>,
}

/// The program for which a file was written, as far as it shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InpOrigin {
    /// CalculiX: it has types of elements or dimensions that Abaqus does not have.
    Calculix,
    /// Abaqus: it has parts or types of elements that CalculiX does not have.
    Abaqus,
    /// Either of them.
    Unknown,
}

impl InpOrigin {
    /// The program for which keywords were written.
    #[must_use]
    pub fn of(blocks: &[KeywordBlock]) -> InpOrigin {
        let is_of_calculix = |block: &KeywordBlock| match block.name.as_str() {
            "ELEMENT" => block
                .parameter("TYPE")
                .is_some_and(|kind| ["B31R", "B32R"].contains(&kind.text.to_uppercase().as_str())),
            "BEAM SECTION" => {
                is_shape(block, "CIRC") && block.data.first().is_some_and(|line| line.len() > 1)
            }
            _ => false,
        };
        let is_of_abaqus = |block: &KeywordBlock| match block.name.as_str() {
            "PART" | "ASSEMBLY" | "PREPRINT" => true,
            "ELEMENT" => block.parameter("TYPE").is_some_and(|kind| {
                ["B31H", "B32H", "B33", "B33H"].contains(&kind.text.to_uppercase().as_str())
            }),
            _ => false,
        };
        let is_square = |block: &KeywordBlock| {
            block.name == "BEAM SECTION"
                && is_shape(block, "RECT")
                && block.data.first().is_some_and(|line| line.len() == 1)
        };
        if blocks.iter().any(is_of_calculix) {
            InpOrigin::Calculix
        } else if blocks.iter().any(is_of_abaqus) {
            InpOrigin::Abaqus
        } else if blocks.iter().any(is_square) {
            InpOrigin::Calculix
        } else {
            InpOrigin::Unknown
        }
    }
}

/// Whether a section has a shape.
fn is_shape(block: &KeywordBlock, wanted: &str) -> bool {
    block
        .parameter("SECTION")
        .is_some_and(|shape| shape_of(&shape.text) == wanted)
}

/// The shape that a word names, in capital letters. Words such as RECTANGULAR are RECT, as in CalculiX.
fn shape_of(word: &str) -> String {
    let word = word.to_uppercase();
    if word.starts_with("RECT") {
        "RECT".to_owned()
    } else {
        word
    }
}

/// Adds an error for each parameter that moves the section or its axes.
fn refuse_parameters(block: &KeywordBlock, findings: &mut ImportFindings) {
    for parameter in &block.parameters {
        let hint = match parameter.name.as_str() {
            "OFFSET1" | "OFFSET2" if parameter.value.text.parse() != Ok(0.0) => {
                "the nodes of beams must be on their centroidal axes"
            }
            "ORIENTATION" => "state the direction n1 on the second data line",
            "NODALTHICKNESS" => "state the dimensions with the section",
            _ => continue,
        };
        let about = format!("{}: {}", block.label(), parameter.name);
        let finding = ImportFinding::new(parameter.value.at, about, "is not supported");
        findings.error(finding.hint(hint));
    }
}

/// Reads *SOLID SECTION, whose data line has the area of trusses.
pub fn solid(block: &KeywordBlock, findings: &mut ImportFindings) -> Option<InpSection> {
    let set = block.required("ELSET", findings)?.clone();
    let material = block.required("MATERIAL", findings)?.clone();
    let none = Vec::new();
    let line = block.data.first().unwrap_or(&none);
    let area = if line.is_empty() {
        1.0
    } else {
        positive(block, line, 0, "area", findings)?
    };
    let numbers = SectionNumbers {
        area,
        ..SectionNumbers::default()
    };
    Some(InpSection {
        set,
        label: block.label(),
        material: MaterialOf::Named(material),
        numbers,
        is_beam: false,
        is_unclear_circle: false,
        n1: [0.0, 0.0, -1.0],
        shear_stiffness: None,
    })
}

/// Reads *BEAM SECTION, or *BEAM GENERAL SECTION if `general` is set, whose section and moduli are in its data lines.
pub fn beam(
    block: &KeywordBlock,
    general: bool,
    origin: InpOrigin,
    findings: &mut ImportFindings,
) -> Option<InpSection> {
    refuse_parameters(block, findings);
    let set = block.required("ELSET", findings)?.clone();
    let shape = match block.parameter("SECTION") {
        Some(shape) => shape_of(&shape.text),
        None if general => "GENERAL".to_owned(),
        None => {
            let _missing = block.required("SECTION", findings);
            return None;
        }
    };
    let none = Vec::new();
    let line = |index: usize| block.data.get(index).unwrap_or(&none);
    let numbers = if general && shape == "GENERAL" {
        general_numbers(block, line(0), findings)
    } else {
        shape_numbers(block, &shape, line(0), origin, findings)
    };
    let n1 = if line(1).iter().all(|field| field.text.is_empty()) {
        Some([0.0, 0.0, -1.0])
    } else {
        vector(block, line(1), 0, ["n1 x", "n1 y", "n1 z"], findings)
    };
    let material = if general {
        let e = positive(block, line(2), 0, "E", findings);
        let g = positive(block, line(2), 1, "G", findings);
        let density = match block.parameter("DENSITY") {
            None => Some(0.0),
            Some(field) => real(
                block,
                std::slice::from_ref(field),
                0,
                ("DENSITY", None),
                findings,
            ),
        };
        MaterialOf::Own([e?, g?, density.filter(|density| *density >= 0.0)?])
    } else {
        MaterialOf::Named(block.required("MATERIAL", findings)?.clone())
    };
    Some(InpSection {
        set,
        label: block.label(),
        material,
        numbers: numbers?,
        is_beam: true,
        is_unclear_circle: shape == "CIRC" && origin == InpOrigin::Unknown,
        n1: n1?,
        shear_stiffness: None,
    })
}

/// Reads A, I11, I12, I22 and J.
fn general_numbers(
    block: &KeywordBlock,
    line: &[InpField],
    findings: &mut ImportFindings,
) -> Option<SectionNumbers> {
    let area = positive(block, line, 0, "A", findings);
    let iy = positive(block, line, 1, "I11", findings);
    let product = real(block, line, 2, ("I12", Some(0.0)), findings);
    let iz = positive(block, line, 3, "I22", findings);
    let j = positive(block, line, 4, "J", findings);
    let (area, iy, iz, product, j) = (area?, iy?, iz?, product?, j?);
    if product * product >= iy * iz {
        let expected = "must be less than the square root of I11 I22 in magnitude";
        findings.error(ImportFinding::new(
            block.at,
            format!("{}: I12", block.label()),
            expected,
        ));
        return None;
    }
    Some(SectionNumbers {
        area,
        iy,
        iz,
        product,
        j,
        k: 1.0,
    })
}

/// Computes the numbers of a shape from its dimensions.
fn shape_numbers(
    block: &KeywordBlock,
    shape: &str,
    line: &[InpField],
    origin: InpOrigin,
    findings: &mut ImportFindings,
) -> Option<SectionNumbers> {
    let is_of_calculix = origin == InpOrigin::Calculix;
    let names: &[&str] = match shape {
        "RECT" if is_of_calculix && line.len() == 1 => &["a"],
        "RECT" => &["a", "b"],
        "CIRC" if is_of_calculix && line.len() > 1 => &["a", "b"],
        "CIRC" if is_of_calculix => &["d"],
        "CIRC" => &["r"],
        "PIPE" => &["r", "t"],
        "BOX" => &["a", "b", "t1", "t2", "t3", "t4"],
        "I" => &["l", "h", "b1", "b2", "t1", "t2", "t3"],
        _ => {
            let hint = match shape {
                "L" => {
                    "the node of an L section is at its corner, not at its centroid: use *BEAM GENERAL SECTION"
                }
                _ => "known: RECT, CIRC, PIPE, BOX, I, and GENERAL in *BEAM GENERAL SECTION",
            };
            let at = block
                .parameter("SECTION")
                .map_or(block.at, |field| field.at);
            let finding = ImportFinding::new(
                at,
                format!("{}: SECTION", block.label()),
                "is not supported",
            );
            findings.error(finding.with_found(shape).hint(hint));
            return None;
        }
    };
    let mut d = Vec::new();
    for (index, name) in names.iter().enumerate() {
        d.push(positive(block, line, index, name, findings)?);
    }
    let mut beyond = line.iter().skip(names.len());
    if let Some(field) = beyond.find(|field| !field.text.is_empty()) {
        let expected = format!("must have {} dimensions", names.len());
        let finding = ImportFinding::new(field.at, block.label(), expected);
        findings.error(finding.with_found(&field.text));
        return None;
    }
    match (shape, d.as_slice()) {
        ("RECT", &[a]) => d.push(a),
        ("CIRC", &[a, b]) if a == b => d = vec![0.5 * a],
        // CalculiX states the diameter, Abaqus the radius
        ("CIRC", &[a]) if is_of_calculix => d = vec![0.5 * a],
        _ => {}
    }
    let mut refuse = |what: &str, expected: &str, hint: &str| {
        let at = line.first().map_or(block.at, |field| field.at);
        let finding = ImportFinding::new(at, format!("{}: {what}", block.label()), expected);
        findings.error(finding.hint(hint));
    };
    let (found, k, is_turned) = match *d.as_slice() {
        [a, b] if shape == "RECT" => (section_properties("BAR", &[b, a]), 0.85, false),
        [a, b] if shape == "CIRC" => (Ok(ellipse(a, b)), 0.89, false),
        [r] => (section_properties("ROD", &[r]), 0.89, false),
        [r, t] => (section_properties("TUBE2", &[r, t]), 0.53, false),
        [a, b, t1, t2, t3, t4] => {
            if t1 != t3 || t2 != t4 {
                let hint =
                    "the node of a box is at the centre of its outline: use *BEAM GENERAL SECTION";
                refuse("t1", "must be equal to t3, and t2 to t4", hint);
                return None;
            }
            (section_properties("BOX", &[b, a, t1, t2]), 0.44, false)
        }
        [l, h, b1, b2, t1, t2, t3] => {
            let web = h - t1 - t2;
            let area = b1 * t1 + b2 * t2 + web * t3;
            let first = b1 * t1 * t1 / 2.0 + b2 * t2 * (h - t2 / 2.0) + web * t3 * (t1 + web / 2.0);
            if (l - first / area).abs() > 1e-6 * h {
                let expected = format!("must be the height of the centroid, {}", first / area);
                refuse(
                    "l",
                    &expected,
                    "the nodes of beams must be on their centroidal axes",
                );
                return None;
            }
            // the web of the other drawing is along y
            (
                section_properties("I", &[h, b1, b2, t3, t1, t2]),
                0.44,
                true,
            )
        }
        _ => return None,
    };
    let Ok(found) = found else {
        refuse(
            "dimensions",
            "must form a valid section",
            "the walls must not overlap",
        );
        return None;
    };
    let [iz, iy] = if is_turned {
        [found.i2, found.i1]
    } else {
        [found.i1, found.i2]
    };
    Some(SectionNumbers {
        area: found.area,
        iy,
        iz,
        product: 0.0,
        j: found.j,
        k,
    })
}

/// An ellipse with the diameter `a` along the 1-axis and `b` along the 2-axis.
fn ellipse(a: f64, b: f64) -> Properties {
    Properties {
        area: PI * a * b / 4.0,
        i1: PI * a.powi(3) * b / 64.0,
        i2: PI * a * b.powi(3) / 64.0,
        turn: 0.0,
        j: PI * a.powi(3) * b.powi(3) / (16.0 * (a * a + b * b)),
        k1: 0.9,
        k2: 0.9,
    }
}
