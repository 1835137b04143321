//! A scene as written, unchecked.

use std::fmt;

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::{Deserializer, Error, IgnoredAny, SeqAccess, Unexpected, Visitor};
use serde_json::Value;

use crate::text::entries::Entries;
use crate::units::RawUnits;

crate::text::object::objects!(
    RawScene,
    RawStructure,
    RawTies,
    RawTieRail,
    RawTables,
    RawGauge,
    RawIrregularity,
    RawBody,
    RawPin,
    RawStart,
    RawWheel,
    RawVertical,
    RawLateral,
    RawFriction,
    RawTruck,
    RawMotion,
    RawLoad,
    RawRope,
    RawEnds,
    RawStop,
    RawEvent,
    RawDo,
    RawFollow,
    RawHoist,
    RawEnd,
    RawOutput,
    RawFatigue,
    RawPractice
);

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawScene {
    pub format: Option<String>,
    pub name: Option<String>,
    pub units: Option<RawUnits>,
    pub gravity: Option<f64>,
    pub analysis: Option<String>,
    #[serde(default)]
    pub structures: Entries<RawStructure>,
    #[serde(default)]
    pub bodies: Entries<RawBody>,
    #[serde(default)]
    pub wheels: Entries<RawWheel>,
    #[serde(default)]
    pub trucks: Vec<RawTruck>,
    #[serde(default)]
    pub ropes: Vec<RawRope>,
    #[serde(default)]
    pub motions: Vec<RawMotion>,
    #[serde(default)]
    pub events: Vec<RawEvent>,
    #[serde(default)]
    pub stops: Vec<RawStop>,
    #[serde(default)]
    pub loads: Vec<RawLoad>,
    pub end: Option<RawEnd>,
    pub output: Option<RawOutput>,
    pub practice: Option<RawPractice>,
    pub accuracy: Option<f64>,
    pub stepper: Option<String>,
    pub step: Option<f64>,
    #[serde(default, rename = "compare", deserialize_with = "leave_to_merge")]
    _compare: Vec<Value>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawStructure {
    pub spec: Option<String>,
    pub tables: Option<RawTables>,
    pub foundation: Option<String>,
    pub reading: Option<String>,
    pub couplings: Option<String>,
    pub tolerance: Option<f64>,
    pub count: Option<usize>,
    pub handover: Option<String>,
    pub blend: Option<f64>,
    pub modes: Option<usize>,
    pub elements: Option<usize>,
    pub damping: Option<f64>,
    pub ties: Option<RawTies>,
    pub range: Option<[f64; 2]>,
    #[serde(default)]
    pub gauges: Entries<RawGauge>,
    #[serde(default)]
    pub irregularities: Vec<RawIrregularity>,
    pub longitudinal: Option<bool>,
    pub on: Option<String>,
    pub at: Option<[f64; 3]>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawTies {
    pub spacing: Option<f64>,
    pub first: Option<f64>,
    pub k: Option<f64>,
    pub lateral_k: Option<f64>,
    pub c: Option<f64>,
    pub mass: Option<f64>,
    pub rail: Option<RawTieRail>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawTieRail {
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
    pub mass_per_length: Option<f64>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawTables {
    pub file: Option<String>,
    pub units: Option<RawUnits>,
    pub vertical: Option<RawPick>,
    pub lateral: Option<RawPick>,
}

/// Accepts any list, because the changes of comparisons are merged into the tree of a scene before conversion.
fn leave_to_merge<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Value>, D::Error> {
    Vec::<IgnoredAny>::deserialize(deserializer).map(|_| Vec::new())
}

/// Which table of a file is meant.
#[derive(Debug)]
pub(crate) enum RawPick {
    /// The number of a SPLINE.
    Id(u32),
    /// The name of a table, or a quantity.
    Name(String),
}

impl<'de> Deserialize<'de> for RawPick {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(PickVisitor)
    }
}

struct PickVisitor;

impl Visitor<'_> for PickVisitor {
    type Value = RawPick;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the number or the name of a table")
    }

    fn visit_u64<E: Error>(self, id: u64) -> Result<RawPick, E> {
        let refused = || E::invalid_value(Unexpected::Unsigned(id), &self);
        u32::try_from(id).map(RawPick::Id).map_err(|_| refused())
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<RawPick, E> {
        Ok(RawPick::Name(name.to_owned()))
    }
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawGauge {
    pub rail: Option<String>,
    pub x: Option<f64>,
    pub direction: Option<String>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawIrregularity {
    pub rail: Option<String>,
    pub direction: Option<String>,
    pub kind: Option<String>,
    pub x: Option<f64>,
    pub height: Option<f64>,
    pub depth: Option<f64>,
    pub amplitude: Option<f64>,
    pub length: Option<f64>,
    pub phase: Option<f64>,
    pub range: Option<[f64; 2]>,
    pub rows: Option<Vec<[f64; 2]>>,
    pub file: Option<String>,
    pub columns: Option<[String; 2]>,
    pub scale: Option<f64>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawBody {
    pub mass: Option<f64>,
    pub weight: Option<f64>,
    pub inertia: Option<[f64; 3]>,
    pub cg: Option<[f64; 3]>,
    pub dof: Option<Vec<String>>,
    pub track: Option<Vec<String>>,
    pub x0: Option<f64>,
    pub v0: Option<f64>,
    pub start: Option<RawStart>,
    pub pinned: Option<RawPin>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawPin {
    pub to: Option<String>,
    pub at: Option<[f64; 3]>,
}

#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawStart {
    pub y: Option<f64>,
    pub z: Option<f64>,
    pub roll: Option<f64>,
    pub yaw: Option<f64>,
    pub pitch: Option<f64>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawWheel {
    pub radius: Option<f64>,
    pub vertical: Option<RawVertical>,
    pub lateral: Option<RawLateral>,
    pub friction: Option<RawFriction>,
    pub spin_inertia: Option<f64>,
    #[serde(default)]
    pub driven: bool,
    #[serde(default)]
    pub braked: bool,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawVertical {
    pub law: Option<String>,
    pub k: Option<f64>,
    pub c: Option<f64>,
    pub exponent: Option<f64>,
    pub depth: Option<f64>,
    pub damper: Option<String>,
    pub bilateral: Option<bool>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawLateral {
    pub k: Option<f64>,
    pub clearance: Option<f64>,
    pub release: Option<[f64; 2]>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawFriction {
    pub law: Option<String>,
    pub mu: Option<f64>,
    pub slip: Option<f64>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawTruck {
    pub name: Option<String>,
    pub body: Option<String>,
    pub rail: Option<String>,
    pub at: Option<[f64; 3]>,
    pub tree: Option<Vec<RawNode>>,
    pub wheel: Option<String>,
}

/// A wheel's offset, or what an equaliser carries.
#[derive(Debug)]
pub(crate) enum RawNode {
    Wheel(f64),
    Equaliser(Vec<RawNode>),
}

impl<'de> Deserialize<'de> for RawNode {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NodeVisitor)
    }
}

struct NodeVisitor;

impl<'de> Visitor<'de> for NodeVisitor {
    type Value = RawNode;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a wheel's offset or a list of two (an equaliser)")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<RawNode, E> {
        Ok(RawNode::Wheel(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<RawNode, E> {
        Ok(RawNode::Wheel(value as f64))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<RawNode, E> {
        Ok(RawNode::Wheel(value as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<RawNode, A::Error> {
        let mut children = Vec::new();
        while let Some(child) = list.next_element()? {
            children.push(child);
        }
        Ok(RawNode::Equaliser(children))
    }
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawMotion {
    pub body: Option<String>,
    pub truck: Option<String>,
    pub wheel: Option<usize>,
    pub dof: Option<String>,
    pub kind: Option<String>,
    pub position: Option<Vec<[f64; 2]>>,
    pub speed: Option<Vec<[f64; 2]>>,
    pub acceleration: Option<Vec<[f64; 2]>>,
    pub gain: Option<f64>,
    pub max_force: Option<f64>,
    pub brake: Option<f64>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawLoad {
    pub body: Option<String>,
    pub dof: Option<String>,
    pub value: Option<Vec<[f64; 2]>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawRope {
    pub name: Option<String>,
    pub from: Option<RawEnds>,
    pub to: Option<RawEnds>,
    #[serde(rename = "EA")]
    pub stiffness: Option<f64>,
    pub c: Option<f64>,
    pub length: Option<f64>,
    pub speed: Option<Vec<[f64; 2]>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawStop {
    pub name: Option<String>,
    pub rail: Option<String>,
    pub x: Option<f64>,
    #[serde(rename = "Y")]
    pub height: Option<f64>,
    pub body: Option<String>,
    pub at: Option<[f64; 3]>,
    pub side: Option<String>,
    pub against: Option<String>,
    pub gap: Option<f64>,
    pub k: Option<f64>,
    pub c: Option<f64>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawEvent {
    pub name: Option<String>,
    pub when: Option<String>,
    #[serde(rename = "do")]
    pub actions: Option<RawDo>,
}

impl RawEvent {
    /// Whether it applies the brakes of body `name`.
    pub fn brakes(&self, name: &str) -> bool {
        self.actions.as_ref().is_some_and(|actions| actions.brake.as_deref() == Some(name))
    }
}

/// What an event does.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawDo {
    pub brake: Option<String>,
    pub release_brake: Option<String>,
    pub drive: Option<RawFollow>,
    pub drive_off: Option<String>,
    pub hoist: Option<RawHoist>,
    pub drop: Option<String>,
    pub end: Option<bool>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawFollow {
    pub body: Option<String>,
    pub speed: Option<f64>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawHoist {
    pub rope: Option<String>,
    pub speed: Option<f64>,
}

/// One end of a rope.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawEnds {
    pub body: Option<String>,
    pub at: Option<[f64; 3]>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawEnd {
    pub time: Option<f64>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawOutput {
    pub dt: Option<f64>,
    pub reactions: Option<RawColumns>,
    pub sections: Option<RawColumns>,
    pub stresses: Option<RawColumns>,
    pub fatigue: Option<RawFatigue>,
    #[serde(default)]
    pub dead_load: bool,
    #[serde(default)]
    pub spans: Entries<Vec<f64>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawFatigue {
    #[serde(rename = "gamma_Ff")]
    pub loads: Option<f64>,
    #[serde(rename = "gamma_Mf")]
    pub material: Option<f64>,
    pub history: Option<String>,
    pub crossings: Option<f64>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawPractice {
    pub crane: Option<String>,
    pub kind: Option<String>,
    pub hoisting: Option<String>,
    pub drives: Option<String>,
    pub release: Option<String>,
    pub guide: Option<String>,
    pub approach: Option<f64>,
    pub rail_head: Option<f64>,
    pub bridge_speed: Option<f64>,
    pub trolley_speed: Option<f64>,
    pub hoist_speed: Option<f64>,
}

/// All, none, or some by their names.
#[derive(Debug)]
pub(crate) enum RawColumns {
    All(bool),
    Names(Vec<String>),
}

impl<'de> Deserialize<'de> for RawColumns {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ColumnsVisitor)
    }
}

struct ColumnsVisitor;

impl<'de> Visitor<'de> for ColumnsVisitor {
    type Value = RawColumns;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("true, false or a list of names")
    }

    fn visit_bool<E: Error>(self, all: bool) -> Result<RawColumns, E> {
        Ok(RawColumns::All(all))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<RawColumns, A::Error> {
        let mut names = Vec::new();
        while let Some(name) = list.next_element()? {
            names.push(name);
        }
        Ok(RawColumns::Names(names))
    }
}
