//! A beam spec as written: the members of both forms, unchecked.

use std::fmt;

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::{Deserializer, Error, Visitor};

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
    RawCut
);

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawSpec {
    pub format: Option<String>,
    pub name: Option<String>,
    pub units: Option<RawUnits>,
    pub theory: Option<String>,
    pub girder: Option<RawGirder>,
    pub stations: Option<Vec<f64>>,
    pub up: Option<[f64; 3]>,
    pub points: Option<Vec<[f64; 3]>>,
    pub cells: Option<Vec<RawBlock>>,
    pub cell_data: Option<RawCellData>,
    pub point_sets: Option<Entries<Vec<usize>>>,
    pub cell_sets: Option<Entries<Vec<Option<Vec<usize>>>>>,
    pub materials: Option<Vec<RawMaterial>>,
    pub sections: Option<Vec<RawSection>>,
    pub supports: Option<Vec<RawSupport>>,
    pub springs: Option<Vec<RawSpring>>,
    pub links: Option<Vec<RawLink>>,
    pub masses: Option<Vec<RawMass>>,
    pub rails: Option<Entries<RawRail>>,
    pub parts: Option<usize>,
    pub effects: Option<Vec<RawCut>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawGirder {
    pub spans: Option<Vec<f64>>,
    pub overhangs: Option<[f64; 2]>,
    #[serde(rename = "E")]
    pub e: Option<f64>,
    #[serde(rename = "G")]
    pub g: Option<f64>,
    #[serde(rename = "A")]
    pub area: Option<f64>,
    #[serde(rename = "I_vertical")]
    pub i_vertical: Option<f64>,
    #[serde(rename = "I_lateral")]
    pub i_lateral: Option<f64>,
    #[serde(rename = "J")]
    pub j: Option<f64>,
    #[serde(rename = "kA_vertical")]
    pub ka_vertical: Option<f64>,
    #[serde(rename = "kA_lateral")]
    pub ka_lateral: Option<f64>,
    pub rail_height: Option<f64>,
    pub mass_per_length: Option<f64>,
    #[serde(default)]
    pub points: Vec<RawPoint>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawBlock {
    #[serde(rename = "type")]
    pub kind: Option<String>,
    pub data: Option<Vec<[usize; 2]>>,
}

#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawCellData {
    pub kind: Option<Vec<Block<String>>>,
    pub section: Option<Vec<Block<Reference>>>,
    pub section_b: Option<Vec<Block<Option<Reference>>>>,
    pub parts: Option<Vec<Block<Option<usize>>>>,
    pub orientation: Option<Vec<Block<[f64; 3]>>>,
    pub offset_a: Option<Vec<Block<[f64; 3]>>>,
    pub offset_b: Option<Vec<Block<[f64; 3]>>>,
    pub release_a: Option<Vec<Block<Vec<String>>>>,
    pub release_b: Option<Vec<Block<Vec<String>>>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub struct RawMaterial {
    pub name: Option<String>,
    #[serde(rename = "E")]
    pub e: Option<f64>,
    #[serde(rename = "G")]
    pub g: Option<f64>,
    pub density: Option<f64>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub struct RawSection {
    pub name: Option<String>,
    pub material: Option<String>,
    #[serde(rename = "A")]
    pub area: Option<f64>,
    #[serde(rename = "Iy")]
    pub iy: Option<f64>,
    #[serde(rename = "Iz")]
    pub iz: Option<f64>,
    #[serde(rename = "J")]
    pub j: Option<f64>,
    #[serde(rename = "Asy")]
    pub asy: Option<f64>,
    #[serde(rename = "Asz")]
    pub asz: Option<f64>,
    pub shape: Option<RawShape>,
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

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawShape {
    pub kind: Option<String>,
    pub length: Option<String>,
    pub height: Option<f64>,
    pub width: Option<f64>,
    pub flange: Option<f64>,
    pub web: Option<f64>,
    pub lower_width: Option<f64>,
    pub lower_flange: Option<f64>,
    pub diameter: Option<f64>,
    pub wall: Option<f64>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawPoint {
    pub name: Option<String>,
    pub y: Option<f64>,
    pub z: Option<f64>,
    pub detail: Option<RawDetail>,
}

/// A detail category: a number of N/mm2, or a letter.
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

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawSupport {
    pub point: Option<Reference>,
    pub fix: Option<Vec<String>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawSpring {
    pub point: Option<Reference>,
    pub dof: Option<String>,
    pub k: Option<f64>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawLink {
    pub from: Option<Reference>,
    pub to: Option<Reference>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawMass {
    pub point: Option<Reference>,
    pub mass: Option<f64>,
    pub inertia: Option<[f64; 3]>,
    pub offset: Option<[f64; 3]>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawRail {
    pub origin: Option<[f64; 3]>,
    pub axis: Option<[f64; 3]>,
    pub segments: Option<Vec<RawSegment>>,
    pub stations: Option<Vec<f64>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawSegment {
    pub cell: Option<[usize; 2]>,
    pub offset: Option<[f64; 3]>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawCut {
    pub name: Option<String>,
    pub x: Option<f64>,
    pub cell: Option<[usize; 2]>,
    pub at: Option<f64>,
}
