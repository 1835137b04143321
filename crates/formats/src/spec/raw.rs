//! A beam spec as written: the members of both forms, unchecked.

use std::fmt;

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, MapAccess, Visitor};

use super::block::{Block, Reference};
use crate::text::entries::Entries;
use crate::units::RawUnits;

crate::text::object::objects!(
    RawSpec,
    RawGirder,
    RawBlock,
    RawCellData,
    RawMaterial,
    RawSection,
    RawShape,
    RawPoint,
    RawSupport,
    RawSpring,
    RawLink,
    RawMass,
    RawRail,
    RawSegment,
    RawCut,
    RawPreload,
    RawPreloadLoad
);

/// A beam spec: a structure and its rails, in the short form with `girder` or in the general form with `points`
/// and `cells`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawSpec {
    /// Name and version of the format.
    pub format: Option<String>,
    /// Name of the structure; by default that of the file.
    pub name: Option<String>,
    /// Units of all numbers of the file.
    pub units: Option<RawUnits>,
    /// Beam theory: "euler-bernoulli" or "timoshenko" (default).
    pub theory: Option<String>,
    /// Short form: a straight uniform girder, continuous over its supports.
    pub girder: Option<RawGirder>,
    /// Short form: coordinates along the girder at which grids and tables have values, length; by default its ends, the
    /// supports and tenths of the spans.
    pub stations: Option<Vec<f64>>,
    /// General form: vector that points vertically upwards; by default [0, 1, 0].
    pub up: Option<[f64; 3]>,
    /// General form: coordinates of the points, length.
    pub points: Option<Vec<[f64; 3]>>,
    /// General form: blocks of cells, which are the members.
    pub cells: Option<Vec<RawBlock>>,
    /// General form: data of the cells.
    pub cell_data: Option<RawCellData>,
    /// General form: lists of indices of points, by name.
    pub point_sets: Option<Entries<Vec<usize>>>,
    /// General form: lists of cells by name, with one list for each block; accepted, but not used.
    pub cell_sets: Option<Entries<Vec<Option<Vec<usize>>>>>,
    /// General form: materials of the sections.
    pub materials: Option<Vec<RawMaterial>>,
    /// General form: cross sections of the members.
    pub sections: Option<Vec<RawSection>>,
    /// General form: restraints of points.
    pub supports: Option<Vec<RawSupport>>,
    /// General form: springs between points and ground.
    pub springs: Option<Vec<RawSpring>>,
    /// General form: rigid links between points.
    pub links: Option<Vec<RawLink>>,
    /// General form: point masses.
    pub masses: Option<Vec<RawMass>>,
    /// General form: rails by name.
    pub rails: Option<Entries<RawRail>>,
    /// General form: number of uniform parts in which each tapered member is solved, 1 to 1000.
    pub parts: Option<usize>,
    /// Sections of members at which internal forces are evaluated.
    pub effects: Option<Vec<RawCut>>,
    /// Permanent loads under which the structure is at rest: all results are second-order results about this state.
    pub preload: Option<RawPreload>,
}

/// The materials and sections of a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct SectionTables<'r> {
    pub materials: &'r Option<Vec<RawMaterial>>,
    pub sections: &'r Option<Vec<RawSection>>,
}

impl RawSpec {
    /// Its materials and sections.
    pub(super) fn tables(&self) -> SectionTables<'_> {
        SectionTables {
            materials: &self.materials,
            sections: &self.sections,
        }
    }
}

/// Permanent loads under which the structure is at rest.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawPreload {
    /// Whether the self-weight of the structure acts; by default false.
    pub weight: Option<bool>,
    /// Acceleration of gravity, a magnitude, length / time^2; by default 9.80665 m/s2. In a scene, the gravity of
    /// the scene is used.
    pub gravity: Option<f64>,
    /// Forces on points.
    pub loads: Option<Vec<RawPreloadLoad>>,
}

/// A force on a point.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawPreloadLoad {
    /// General form: index of the point, or name of a set of one point.
    pub point: Option<Reference>,
    /// Short form: coordinate of a support or an end of the girder, length.
    pub x: Option<f64>,
    /// Force along the global axes.
    pub force: Option<[f64; 3]>,
}

/// A straight uniform girder, continuous over its supports. Its coordinate is 0 at the first support.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawGirder {
    /// Distances between the supports, from first to last, length.
    pub spans: Option<Vec<f64>>,
    /// Lengths beyond the first and the last support; by default [0, 0].
    pub overhangs: Option<[f64; 2]>,
    /// Young's modulus, force / length^2.
    #[serde(rename = "E")]
    pub e: Option<f64>,
    /// Shear modulus, force / length^2.
    #[serde(rename = "G")]
    pub g: Option<f64>,
    /// Area of the cross section, length^2.
    #[serde(rename = "A")]
    pub area: Option<f64>,
    /// Second moment of area for vertical bending, length^4.
    #[serde(rename = "I_vertical")]
    pub i_vertical: Option<f64>,
    /// Second moment of area for lateral bending, length^4.
    #[serde(rename = "I_lateral")]
    pub i_lateral: Option<f64>,
    /// Torsion constant, length^4.
    #[serde(rename = "J")]
    pub j: Option<f64>,
    /// Effective shear area for vertical forces, length^2; without it the girder is rigid in vertical shear.
    #[serde(rename = "kA_vertical")]
    pub ka_vertical: Option<f64>,
    /// Effective shear area for lateral forces, length^2; without it the girder is rigid in lateral shear.
    #[serde(rename = "kA_lateral")]
    pub ka_lateral: Option<f64>,
    /// Height of the rail above the elastic axis, length; by default 0.
    pub rail_height: Option<f64>,
    /// Mass per length, mass / length; by default 0, with `section`, or `shape` and `density`, the area times the density.
    pub mass_per_length: Option<f64>,
    /// Name of a rolled section, such as "HEB 400" or "W24x94", from whose dimensions properties that are left out are computed.
    pub section: Option<String>,
    /// Dimensions of a built-up section whose height is vertical, from which properties that are left out are computed; in place
    /// of `section`.
    pub shape: Option<RawShape>,
    /// With `section` or `shape`: mass density, mass / length^3; with `section` by default that of steel, as are `E` and `G`.
    pub density: Option<f64>,
    /// Yield strength, force / length^2; for stresses of a design.
    pub fy: Option<f64>,
    /// Name of a crane rail, such as "A75" or "ASCE 85": its height is added to `rail_height`, its mass to that of the girder.
    pub crane_rail: Option<String>,
    /// Whether girder and crane rail resist bending as one composite section; by default false.
    pub composite: Option<bool>,
    /// Points of the cross section at which stresses are evaluated.
    #[serde(default)]
    pub points: Vec<RawPoint>,
}

impl RawGirder {
    /// The girder without its points.
    pub fn numbers(&self) -> RawGirder {
        RawGirder {
            spans: self.spans.clone(),
            section: self.section.clone(),
            shape: self.shape.clone(),
            crane_rail: self.crane_rail.clone(),
            points: Vec::new(),
            ..*self
        }
    }
}

/// A block of cells of one type.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawBlock {
    /// Type of the cells: "line".
    #[serde(rename = "type")]
    pub kind: Option<String>,
    /// Indices of the two points of each cell, counted from 0.
    pub data: Option<Vec<[usize; 2]>>,
}

/// Data of the cells. Each array has an entry for each block of cells: a list with one item for each cell, one
/// item for all cells, or null for the default.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawCellData {
    /// Kind of the member: "beam" (default), "truss" (axial force only), "rod" (axial force and torsion) or "cable"
    /// (tension only, under a `preload`).
    pub kind: Option<Vec<Block<String>>>,
    /// Name or index of the section; may be left out if there is only one section.
    pub section: Option<Vec<Block<Reference>>>,
    /// Name or index of the section at end b of a tapered member; null for a uniform member.
    pub section_b: Option<Vec<Block<Option<Reference>>>>,
    /// Number of uniform parts in which a tapered member is solved, 1 to 1000; by default `parts` of the spec.
    pub parts: Option<Vec<Block<Option<usize>>>>,
    /// Vector whose component normal to the member is the local y axis; by default `up`.
    pub orientation: Option<Vec<Block<[f64; 3]>>>,
    /// Vector from the first point of the cell to the flexible end a, length; by default zero.
    pub offset_a: Option<Vec<Block<[f64; 3]>>>,
    /// Vector from the second point of the cell to the flexible end b, length; by default zero.
    pub offset_b: Option<Vec<Block<[f64; 3]>>>,
    /// Degrees of freedom that are released at end a, in local axes: "ux" to "rz".
    pub release_a: Option<Vec<Block<Vec<String>>>>,
    /// Degrees of freedom that are released at end b, in local axes: "ux" to "rz".
    pub release_b: Option<Vec<Block<Vec<String>>>>,
}

/// A linear elastic material.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub struct RawMaterial {
    /// Name of the material.
    pub name: Option<String>,
    /// Young's modulus, force / length^2.
    #[serde(rename = "E")]
    pub e: Option<f64>,
    /// Shear modulus, force / length^2; needed for beams.
    #[serde(rename = "G")]
    pub g: Option<f64>,
    /// Mass density, mass / length^3; by default 0.
    pub density: Option<f64>,
    /// Yield strength, force / length^2; for stresses of a design.
    pub fy: Option<f64>,
}

/// A cross section. Properties that are left out are computed from `shape`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub struct RawSection {
    /// Name of the section.
    pub name: Option<String>,
    /// Name of the material.
    pub material: Option<String>,
    /// Area, length^2.
    #[serde(rename = "A")]
    pub area: Option<f64>,
    /// Second moment of area about the local y axis, length^4; needed for beams.
    #[serde(rename = "Iy")]
    pub iy: Option<f64>,
    /// Second moment of area about the local z axis, length^4; needed for beams.
    #[serde(rename = "Iz")]
    pub iz: Option<f64>,
    /// Torsion constant, length^4; needed for beams.
    #[serde(rename = "J")]
    pub j: Option<f64>,
    /// Effective shear area for forces along local y, length^2; without it the section is rigid in this shear.
    #[serde(rename = "Asy")]
    pub asy: Option<f64>,
    /// Effective shear area for forces along local z, length^2; without it the section is rigid in this shear.
    #[serde(rename = "Asz")]
    pub asz: Option<f64>,
    /// Dimensions of the section, or the name of a rolled one, from which missing properties are computed.
    pub shape: Option<RawSectionShape>,
    /// Points of the section at which stresses are evaluated.
    #[serde(default)]
    pub points: Vec<RawPoint>,
}

impl RawSection {
    /// The section with its explicit properties only, without shape and points.
    pub fn numbers(&self) -> RawSection {
        RawSection {
            name: self.name.clone(),
            material: self.material.clone(),
            area: self.area,
            iy: self.iy,
            iz: self.iz,
            j: self.j,
            asy: self.asy,
            asz: self.asz,
            shape: None,
            points: Vec::new(),
        }
    }
}

/// Dimensions of a cross section. The local y axis is along its height.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawShape {
    /// Kind of the shape: "I", "box", "tube" or "bar".
    pub kind: Option<String>,
    /// Unit of the dimensions; by default that of the file.
    pub length: Option<String>,
    /// Height of an I, a box or a bar.
    pub height: Option<f64>,
    /// Width of an I (of its upper flange), a box or a bar.
    pub width: Option<f64>,
    /// Thickness of both flanges of a box, or of the upper flange of an I.
    pub flange: Option<f64>,
    /// Thickness of the web of an I, or of each web of a box.
    pub web: Option<f64>,
    /// Width of the lower flange of an I; by default `width`.
    pub lower_width: Option<f64>,
    /// Thickness of the lower flange of an I; by default `flange`.
    pub lower_flange: Option<f64>,
    /// Outer diameter of a tube.
    pub diameter: Option<f64>,
    /// Wall thickness of a tube.
    pub wall: Option<f64>,
}

/// The shape of a section: its dimensions, or the name of a rolled section.
#[derive(Debug)]
pub(crate) enum RawSectionShape {
    Dimensions(Box<RawShape>),
    Name(String),
}

impl<'de> Deserialize<'de> for RawSectionShape {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ShapeVisitor)
    }
}

struct ShapeVisitor;

impl<'de> Visitor<'de> for ShapeVisitor {
    type Value = RawSectionShape;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object with `kind`, or the name of a rolled section such as \"HEB 400\"")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<RawSectionShape, E> {
        Ok(RawSectionShape::Name(name.to_owned()))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RawSectionShape, A::Error> {
        RawShape::deserialize(MapAccessDeserializer::new(map))
            .map(|shape| RawSectionShape::Dimensions(Box::new(shape)))
    }
}

/// A point of a cross section at which the direct stress is evaluated.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawPoint {
    /// Name of the point.
    pub name: Option<String>,
    /// Coordinate from the centroid along local y, length; by default 0.
    pub y: Option<f64>,
    /// Coordinate from the centroid along local z, length; by default 0.
    pub z: Option<f64>,
    /// Detail category for direct stress: a number of EN 1993-1-9 in N/mm2, or a stress category "A" to "E'" of
    /// AISC 360.
    pub detail: Option<RawDetail>,
}

/// A detail category: a number of EN 1993-1-9 in N/mm2, or a letter of AISC 360.
#[derive(Debug)]
pub(crate) enum RawDetail {
    Number(f64),
    Word(String),
}

impl<'de> Deserialize<'de> for RawDetail {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(DetailVisitor)
    }
}

struct DetailVisitor;

impl Visitor<'_> for DetailVisitor {
    type Value = RawDetail;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number such as 112, or a letter such as \"C\"")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<RawDetail, E> {
        Ok(RawDetail::Number(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<RawDetail, E> {
        Ok(RawDetail::Number(value as f64))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<RawDetail, E> {
        Ok(RawDetail::Number(value as f64))
    }

    fn visit_str<E: Error>(self, word: &str) -> Result<RawDetail, E> {
        Ok(RawDetail::Word(word.to_owned()))
    }
}

/// A restraint of a point, or of every point of a set.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawSupport {
    /// Index of the point, or name of a point set.
    pub point: Option<Reference>,
    /// Restrained degrees of freedom: "ux", "uy", "uz", "rx", "ry", "rz".
    pub fix: Option<Vec<String>>,
}

/// A spring between a point and ground.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawSpring {
    /// Index of the point, or name of a set of one point.
    pub point: Option<Reference>,
    /// Degree of freedom: "ux", "uy", "uz", "rx", "ry" or "rz".
    pub dof: Option<String>,
    /// Stiffness, force / length, or force length / radian for a rotation.
    pub k: Option<f64>,
}

/// A rigid link between two points.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawLink {
    /// Index of the first point, or name of a set of one point.
    pub from: Option<Reference>,
    /// Index of the second point, or name of a set of one point.
    pub to: Option<Reference>,
}

/// A point mass.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawMass {
    /// Index of the point, or name of a set of one point.
    pub point: Option<Reference>,
    /// Mass, force time^2 / length.
    pub mass: Option<f64>,
    /// Moments of inertia about the global axes, mass length^2; by default zero.
    pub inertia: Option<[f64; 3]>,
    /// Vector from the point to the mass, length; by default zero.
    pub offset: Option<[f64; 3]>,
}

/// A rail on members. Its coordinate is the distance from `origin` along `axis`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawRail {
    /// Point at which the coordinate is 0, length; by default [0, 0, 0].
    pub origin: Option<[f64; 3]>,
    /// Vector along the rail.
    pub axis: Option<[f64; 3]>,
    /// Members that carry the rail.
    pub segments: Option<Vec<RawSegment>>,
    /// Coordinates at which grids and tables have values, length.
    pub stations: Option<Vec<f64>>,
    /// Name of a crane rail, such as "A75" or "ASCE 85": its height is added to the offsets of the segments, its mass to that of their
    /// members.
    pub crane_rail: Option<String>,
    /// Whether the members and the crane rail resist bending as one composite section; by default false.
    pub composite: Option<bool>,
}

/// A segment of a rail on one member.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawSegment {
    /// Member as [block, index], counted from 0.
    pub cell: Option<[usize; 2]>,
    /// Vector from the axis of the member to the rail, length; by default zero.
    pub offset: Option<[f64; 3]>,
}

/// A section of a member at which internal forces are evaluated.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawCut {
    /// Name of the section.
    pub name: Option<String>,
    /// Short form: coordinate from the first support, length.
    pub x: Option<f64>,
    /// General form: member as [block, index], counted from 0.
    pub cell: Option<[usize; 2]>,
    /// General form: position as a fraction of the flexible length of the member, from end a.
    pub at: Option<f64>,
}
