//! A scene as written, unchecked.

use std::fmt;

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserializer, Error, IgnoredAny, SeqAccess, Unexpected, Visitor};
use serde_json::Value;

use crate::own_limits::RawOwnLimits;
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

/// A scene: structures, bodies, wheels and their motion.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawScene {
    /// Name and version of the format.
    pub format: Option<String>,
    /// Name of the scene; by default that of the file.
    pub name: Option<String>,
    /// Units of all numbers of the file.
    pub units: Option<RawUnits>,
    /// Acceleration of gravity, length / time^2; it acts downwards.
    pub gravity: Option<f64>,
    /// Kind of analysis: "dynamic" (default) or "quasi-static".
    pub analysis: Option<String>,
    /// Structures that carry the rails, by name.
    #[serde(default)]
    pub structures: Entries<RawStructure>,
    /// Rigid bodies, by name.
    #[serde(default)]
    pub bodies: Entries<RawBody>,
    /// Wheel types, by name.
    #[serde(default)]
    pub wheels: Entries<RawWheel>,
    /// Trucks: the wheels that carry bodies on rails.
    #[serde(default)]
    pub trucks: Vec<RawTruck>,
    /// Ropes between bodies.
    #[serde(default)]
    pub ropes: Vec<RawRope>,
    /// Motions, drives and brakes of bodies along their rails, and prescribed spins of wheels.
    #[serde(default)]
    pub motions: Vec<RawMotion>,
    /// Actions that happen when a condition is met.
    #[serde(default)]
    pub events: Vec<RawEvent>,
    /// One-sided stops: end stops of rails, floors, and buffers between bodies.
    #[serde(default)]
    pub stops: Vec<RawStop>,
    /// Forces and moments on bodies as functions of time.
    #[serde(default)]
    pub loads: Vec<RawLoad>,
    /// End of the run.
    pub end: Option<RawEnd>,
    /// Output times and columns of the results.
    pub output: Option<RawOutput>,
    /// Data for the comparison of the results with crane codes; without it they are not compared.
    pub practice: Option<RawPractice>,
    /// Relative error of displacements that is permitted over the run; by default 1e-4.
    pub accuracy: Option<f64>,
    /// Method of time integration: "auto" (default), "sdirk4", "esdirk5", "radau", "series", "gauss2" or "gauss3".
    pub stepper: Option<String>,
    /// Constant step size, time; needed with "gauss2" and "gauss3". By default the step size is adaptive.
    pub step: Option<f64>,
    /// Variants of the scene. Each has a `label` and the keys that change, which are merged into the scene as in
    /// RFC 7386.
    #[serde(default, rename = "compare", deserialize_with = "leave_to_merge")]
    _compare: Vec<Value>,
}

/// A structure that carries rails: its beam spec or its tables, and the model of its compliance.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawStructure {
    /// Path of the beam spec, relative to the folder of the scene.
    pub spec: Option<String>,
    /// Tables of influence coefficients, instead of `spec`.
    pub tables: Option<RawTables>,
    /// Model of the compliance: "rigid", "parts", "influence", "modal", "full", "ties" or "auto" (default).
    pub foundation: Option<String>,
    /// Interpolation of the tables: "exact" (default), "natural", "akispl" or "cubspl".
    pub reading: Option<String>,
    /// Couplings of the foundation "influence" that are taken into account: "all" (default), "within rails" or
    /// "none".
    pub couplings: Option<String>,
    /// Relative error that the foundation chosen by "auto" may have, at least 1e-7 and below 1; by default 1e-2.
    pub tolerance: Option<f64>,
    /// Measure of this error: "extremes" (default), the largest and smallest values and envelopes of every recorded
    /// quantity, or "history", its values at equal times.
    pub measure: Option<String>,
    /// Number of rigid parts of the foundation "parts"; by default 2.
    pub count: Option<usize>,
    /// Transition of a wheel between rigid parts: "blend" (default) or "per-part".
    pub handover: Option<String>,
    /// Length over which a wheel passes from one rigid part to the next; by default the distance of their
    /// centres.
    pub blend: Option<f64>,
    /// Number of natural modes of the foundation "modal" (default 5) or "ties" (default all).
    pub modes: Option<usize>,
    /// Number of elements of each member for "full" (default 8), or of each bay between ties (default 2).
    pub elements: Option<usize>,
    /// Damping ratio of each natural mode, at least 0 and below 1; by default 0.
    pub damping: Option<f64>,
    /// Rail on elastic ties, for the foundation "ties".
    pub ties: Option<RawTies>,
    /// First and last coordinate of a rail on ties without `spec`, length.
    pub range: Option<[f64; 2]>,
    /// Points whose displacement is recorded, by name.
    #[serde(default)]
    pub gauges: Entries<RawGauge>,
    /// Deviations of the unloaded rails from straight lines.
    #[serde(default)]
    pub irregularities: Vec<RawIrregularity>,
    /// Whether friction, drives and brakes load the structure along its rails; by default false.
    pub longitudinal: Option<bool>,
    /// Whether the preload of the spec includes the wheel forces of the initial equilibrium; by default false. This
    /// preloaded state is kept for the whole run.
    pub preload: Option<bool>,
    /// Name of the body that carries the structure; by default the ground carries it.
    pub on: Option<String>,
    /// Vector from the origin of that body to the origin of the spec, length; by default zero.
    pub at: Option<[f64; 3]>,
}

/// A rail on elastic ties.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawTies {
    /// Distance between neighbouring ties, length.
    pub spacing: Option<f64>,
    /// Coordinate of the first tie, length; by default the beginning of the rail.
    pub first: Option<f64>,
    /// Vertical stiffness of one tie, force / length.
    pub k: Option<f64>,
    /// Lateral stiffness of one tie, force / length; without it the rail is laterally fixed.
    pub lateral_k: Option<f64>,
    /// Vertical damping coefficient of one tie, force time / length; by default 0.
    pub c: Option<f64>,
    /// Mass of one tie, which moves with the rail, force time^2 / length; by default 0.
    pub mass: Option<f64>,
    /// Properties of the rail.
    pub rail: Option<RawTieRail>,
}

/// Properties of a rail on ties.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawTieRail {
    /// Young's modulus, force / length^2.
    #[serde(rename = "E")]
    pub e: Option<f64>,
    /// Shear modulus, force / length^2.
    #[serde(rename = "G")]
    pub g: Option<f64>,
    /// Area, length^2.
    #[serde(rename = "A")]
    pub area: Option<f64>,
    /// Second moment of area for vertical bending, length^4.
    #[serde(rename = "I_vertical")]
    pub i_vertical: Option<f64>,
    /// Second moment of area for lateral bending, length^4; needed with `lateral_k`.
    #[serde(rename = "I_lateral")]
    pub i_lateral: Option<f64>,
    /// Torsion constant, length^4.
    #[serde(rename = "J")]
    pub j: Option<f64>,
    /// Mass per length, mass / length; by default 0.
    pub mass_per_length: Option<f64>,
}

/// Influence coefficients from a file of tables.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawTables {
    /// Path of the file (.adm, .cmd, .csv, .json or .npz), relative to the folder of the scene.
    pub file: Option<String>,
    /// Units of the file; needed if the file does not state them.
    pub units: Option<RawUnits>,
    /// Number or name of the table of vertical deflections under vertical loads.
    pub vertical: Option<RawPick>,
    /// Number or name of the table of lateral deflections under lateral loads.
    pub lateral: Option<RawPick>,
}

/// Accepts any list, because the changes of comparisons are merged into the tree of a scene before conversion.
fn leave_to_merge<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Value>, D::Error> {
    Vec::<IgnoredAny>::deserialize(deserializer).map(|_| Vec::new())
}

/// A selection of one table of a file.
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

/// A point of a rail whose displacement is recorded.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawGauge {
    /// Name of the rail; may be left out if the structure has only one.
    pub rail: Option<String>,
    /// Coordinate along the rail, length.
    pub x: Option<f64>,
    /// Direction: "vertical" (default, positive downwards), "lateral" or "longitudinal".
    pub direction: Option<String>,
}

/// A deviation of an unloaded rail from a straight line.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawIrregularity {
    /// Name of the rail; may be left out if the structure has only one.
    pub rail: Option<String>,
    /// Direction: "vertical" (default, upwards) or "lateral" (to the right).
    pub direction: Option<String>,
    /// Kind: "step", "joint", "dip", "sinusoid" or "profile".
    pub kind: Option<String>,
    /// Coordinate of the step, joint or dip, length.
    pub x: Option<f64>,
    /// Height of the step, length.
    pub height: Option<f64>,
    /// Depth of the joint or dip, length.
    pub depth: Option<f64>,
    /// Amplitude of the sinusoid, length.
    pub amplitude: Option<f64>,
    /// Length of the joint or dip, or wavelength of the sinusoid.
    pub length: Option<f64>,
    /// Phase of the sinusoid at the beginning of `range` or, without it, at x = 0, radian; by default 0.
    pub phase: Option<f64>,
    /// First and last coordinate of the sinusoid, length; by default those of the rail.
    pub range: Option<[f64; 2]>,
    /// Rows [x, height] of the profile, length.
    pub rows: Option<Vec<[f64; 2]>>,
    /// Path of a file with the rows of the profile, relative to the folder of the scene.
    pub file: Option<String>,
    /// Names of the columns of x and height in the file; by default the first two columns.
    pub columns: Option<[String; 2]>,
    /// Factor of the heights of the profile; by default 1.
    pub scale: Option<f64>,
}

/// A rigid body.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawBody {
    /// Mass, force time^2 / length; either `mass` or `weight` is needed.
    pub mass: Option<f64>,
    /// Weight, force.
    pub weight: Option<f64>,
    /// Moments of inertia [roll, yaw, pitch] about the centre of mass, mass length^2; by default zero.
    pub inertia: Option<[f64; 3]>,
    /// Vector from the origin of the body to its centre of mass, length; by default zero.
    pub cg: Option<[f64; 3]>,
    /// Free degrees of freedom: some of "x", "y", "z", "roll", "yaw", "pitch", or "X", "Y", "Z" for a body in
    /// space.
    pub dof: Option<Vec<String>>,
    /// Names of the rails that restrain the other degrees of freedom; by default those of its trucks.
    pub track: Option<Vec<String>>,
    /// Coordinate along the rail at the start, length; by default 0 or that of its motion.
    pub x0: Option<f64>,
    /// Speed along the rail at the start, length / time; by default 0 or that of its motion.
    pub v0: Option<f64>,
    /// Displacements at the start; by default those of static equilibrium.
    pub start: Option<RawStart>,
    /// Pin by which another body carries this one.
    pub pinned: Option<RawPin>,
}

/// A pin on another body.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawPin {
    /// Name of the body that carries the pinned body.
    pub to: Option<String>,
    /// Vector from the origin of that body to the pin, length; by default zero.
    pub at: Option<[f64; 3]>,
}

/// Displacements of a body at the start, from the position in which its wheels just touch the unloaded rail.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawStart {
    /// Vertical displacement, positive upwards, length.
    pub y: Option<f64>,
    /// Lateral displacement, positive to the right, length.
    pub z: Option<f64>,
    /// Rotation about the longitudinal axis, radian.
    pub roll: Option<f64>,
    /// Rotation about the vertical axis, radian.
    pub yaw: Option<f64>,
    /// Rotation about the lateral axis, radian.
    pub pitch: Option<f64>,
}

/// A wheel type.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawWheel {
    /// Radius of the tread, length.
    pub radius: Option<f64>,
    /// Vertical contact of tread and rail.
    pub vertical: Option<RawVertical>,
    /// Lateral contact of flange and rail; by default none.
    pub lateral: Option<RawLateral>,
    /// Longitudinal friction; by default the wheel rolls without tangential force.
    pub friction: Option<RawFriction>,
    /// Moment of inertia about the axle, mass length^2; by default the rotational inertia of the wheel is neglected.
    pub spin_inertia: Option<f64>,
    /// Whether the drive of the body acts on wheels of this type; by default false.
    #[serde(default)]
    pub driven: bool,
    /// Whether the brake of the body acts on wheels of this type; by default false.
    #[serde(default)]
    pub braked: bool,
}

/// Vertical contact of tread and rail.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawVertical {
    /// Contact law: "linear" (default) or "impact".
    pub law: Option<String>,
    /// Stiffness, force / length^exponent (exponent 1 for the law "linear").
    pub k: Option<f64>,
    /// Damping coefficient, force time / length; by default 0.
    pub c: Option<f64>,
    /// Exponent of the penetration in the law "impact", at least 1; by default 1.1.
    pub exponent: Option<f64>,
    /// Penetration at which the damping coefficient of the law "impact" is c, length.
    pub depth: Option<f64>,
    /// Velocity on which the damper acts: "rail" (default, relative to the rail) or "ground" (absolute).
    pub damper: Option<String>,
    /// Whether the contact can transmit tension; by default false.
    pub bilateral: Option<bool>,
}

/// Lateral contact of flange and rail.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawLateral {
    /// Stiffness, force / length.
    pub k: Option<f64>,
    /// Clearance on either side, length; by default 0.
    pub clearance: Option<f64>,
    /// Two heights of the wheel centre above the rail between which the flange force decreases to zero, length.
    pub release: Option<[f64; 2]>,
}

/// Longitudinal friction between tread and rail.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawFriction {
    /// Friction law: "step" (default) or "coulomb".
    pub law: Option<String>,
    /// Coefficient of friction.
    pub mu: Option<f64>,
    /// Sliding speed at which friction reaches mu N ("step") or 76 % of mu N ("coulomb"), length / time.
    pub slip: Option<f64>,
}

/// Wheels that carry a body on one rail.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawTruck {
    /// Name of the truck; by default `<body>.truck<n>`.
    pub name: Option<String>,
    /// Name of the body; may be left out if there is only one.
    pub body: Option<String>,
    /// Name of the rail as `<structure>.<rail>`; may be left out if there is only one.
    pub rail: Option<String>,
    /// Position relative to the origin of the body: along the rail, upwards, to the right, length; by default
    /// zero.
    pub at: Option<[f64; 3]>,
    /// Offsets of the wheels along the rail, length; a nested list of two is an equaliser. By default [0].
    pub tree: Option<Vec<RawNode>>,
    /// Name of the wheel type; may be left out if there is only one.
    pub wheel: Option<String>,
}

/// A node of the tree of a truck: a wheel at an offset along the rail, or an equaliser with two nodes.
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
        f.write_str("the offset of a wheel, or a list of two nodes (an equaliser)")
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

/// Motion of a body along its rail, or prescribed spin of a wheel. Tables are linear between rows and constant
/// beyond them.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawMotion {
    /// Name of the body.
    pub body: Option<String>,
    /// Truck of the wheel whose spin is prescribed; may be left out if there is only one.
    pub truck: Option<String>,
    /// Number of the wheel in its truck, counted from 1; by default 1.
    pub wheel: Option<usize>,
    /// Degree of freedom: "x" for a body, "spin" for a wheel.
    pub dof: Option<String>,
    /// Kind of motion: "prescribed", "drive" or "free".
    pub kind: Option<String>,
    /// Prescribed position as rows [time, length], or [time, radian] for a spin.
    pub position: Option<Vec<[f64; 2]>>,
    /// Prescribed speed, or set speed of a drive, as rows [time, speed].
    pub speed: Option<Vec<[f64; 2]>>,
    /// Prescribed acceleration as rows [time, acceleration].
    pub acceleration: Option<Vec<[f64; 2]>>,
    /// Force of a drive per difference between its set speed and the speed of the body, force time / length.
    pub gain: Option<f64>,
    /// Largest force of a drive, force; by default unlimited.
    pub max_force: Option<f64>,
    /// Time from which the brakes are applied and the drive is off.
    pub brake: Option<f64>,
}

/// A force or moment on a body as a function of time.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawLoad {
    /// Name of the body.
    pub body: Option<String>,
    /// Degree of freedom on which the load acts: "x", "y", "z", "roll", "yaw" or "pitch".
    pub dof: Option<String>,
    /// Rows [time, force] or [time, moment], linear between rows and constant beyond them.
    pub value: Option<Vec<[f64; 2]>>,
}

/// An elastic rope between two bodies, or between a body and a fixed point.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawRope {
    /// Name of the rope; by default rope1, rope2, ...
    pub name: Option<String>,
    /// First end.
    pub from: Option<RawEnds>,
    /// Second end.
    pub to: Option<RawEnds>,
    /// Axial stiffness, modulus times area, force.
    #[serde(rename = "EA")]
    pub stiffness: Option<f64>,
    /// Damping coefficient, force time / length; by default 0.
    pub c: Option<f64>,
    /// Unstretched length at time 0.
    pub length: Option<f64>,
    /// Hoisting speed as rows [time, speed], positive where the rope becomes shorter; by default 0.
    pub speed: Option<Vec<[f64; 2]>>,
}

/// A one-sided elastic stop: an end stop of a rail (`rail` and `x`), a floor (`body` and `Y`) or a buffer (`body`
/// and `against`).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawStop {
    /// Name of the stop; by default stop1, stop2, ...
    pub name: Option<String>,
    /// Rail of an end stop, as `<structure>.<rail>`.
    pub rail: Option<String>,
    /// Coordinate of an end stop along its rail, length.
    pub x: Option<f64>,
    /// Height of a floor above the unloaded rail, length.
    #[serde(rename = "Y")]
    pub height: Option<f64>,
    /// Name of the body that meets the stop.
    pub body: Option<String>,
    /// Point of that body that meets the stop, relative to its origin, length.
    pub at: Option<[f64; 3]>,
    /// Side of the body: "before" or "beyond" an end stop, "above" (default) or "below" a floor.
    pub side: Option<String>,
    /// Name of the other body of a buffer.
    pub against: Option<String>,
    /// Initial clearance before the buffer is compressed, length; by default 0.
    pub gap: Option<f64>,
    /// Stiffness, force / length.
    pub k: Option<f64>,
    /// Damping coefficient, force time / length; by default 0.
    pub c: Option<f64>,
}

/// Actions that happen once, as soon as a condition is met.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawEvent {
    /// Name of the event; by default event1, event2, ...
    pub name: Option<String>,
    /// Condition: a column of the history, then >=, >, <= or <, then a number.
    pub when: Option<String>,
    /// Actions of the event.
    #[serde(rename = "do")]
    pub actions: Option<RawDo>,
}

impl RawEvent {
    /// Whether it applies the brakes of body `name`.
    pub fn brakes(&self, name: &str) -> bool {
        self.actions
            .as_ref()
            .is_some_and(|actions| actions.brake.as_deref() == Some(name))
    }
}

/// Actions of an event.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawDo {
    /// Name of the body whose brakes are applied and whose drive is turned off.
    pub brake: Option<String>,
    /// Name of the body whose brakes are released.
    pub release_brake: Option<String>,
    /// New set speed of the drive of a body.
    pub drive: Option<RawFollow>,
    /// Name of the body whose drive is turned off.
    pub drive_off: Option<String>,
    /// New hoisting speed of a rope.
    pub hoist: Option<RawHoist>,
    /// Name of the rope that is released, or of the body all of whose ropes are released.
    pub drop: Option<String>,
    /// Whether the run ends.
    pub end: Option<bool>,
}

/// New set speed of the drive of a body.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawFollow {
    /// Name of the body.
    pub body: Option<String>,
    /// Set speed along the rail, length / time.
    pub speed: Option<f64>,
}

/// New hoisting speed of a rope.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawHoist {
    /// Name of the rope.
    pub rope: Option<String>,
    /// Speed, length / time, positive where the rope becomes shorter.
    pub speed: Option<f64>,
}

/// One end of a rope.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawEnds {
    /// Name of the body; without it the end is a fixed point.
    pub body: Option<String>,
    /// Position relative to the origin of the body, or coordinates of the fixed point, length.
    pub at: Option<[f64; 3]>,
}

/// End of the run.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawEnd {
    /// Time at which the run ends.
    pub time: Option<f64>,
}

/// Output times and columns of the results.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawOutput {
    /// Time between two rows of the history; by default 1/1000 of the run.
    pub dt: Option<f64>,
    /// Columns of reactions: true, false, or a list of `<structure>`, `<structure>.<support>` or
    /// `<structure>.<support>.<dof>`.
    pub reactions: Option<RawColumns>,
    /// Columns of internal forces: true, false, or a list of `<structure>`, `<structure>.<section>` or
    /// `<structure>.<section>.<component>`.
    pub sections: Option<RawColumns>,
    /// Columns of stresses: true, false, or a list of `<structure>`, `<structure>.<section>` or
    /// `<structure>.<section>.<point>`.
    pub stresses: Option<RawColumns>,
    /// Settings of the fatigue assessment.
    pub fatigue: Option<RawFatigue>,
    /// Whether these columns include the self-weight of the structures; by default false.
    #[serde(default)]
    pub dead_load: bool,
    /// Coordinates of the ends of the spans whose deflection is evaluated, by rail, length.
    #[serde(default)]
    pub spans: Entries<Vec<f64>>,
}

/// Settings of the fatigue assessment.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawFatigue {
    /// Partial factor of the loads; by default 1.
    #[serde(rename = "gamma_Ff")]
    pub loads: Option<f64>,
    /// Partial factor of the fatigue strength; by default 1.
    #[serde(rename = "gamma_Mf")]
    pub material: Option<f64>,
    /// Stress history: "once" (default), or "repeated" if the run is repeated without pause.
    pub history: Option<String>,
    /// Number of runs in the design life.
    pub crossings: Option<f64>,
}

/// Data for the comparison of the results with crane codes, and for stresses of girders.
#[derive(Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawPractice {
    /// Name of the body that is the crane; it must run on two rails.
    pub crane: Option<String>,
    /// Kind of crane in AIST TR-13: "mill" (default), "ladle", "bucket", "soaking pit", "stripping", "motor room",
    /// "stacker" or "pendant" (pendant-operated).
    pub kind: Option<String>,
    /// Design code by whose limits the run is judged, or a list of codes.
    pub code: Option<RawCodes>,
    /// Limits of one's own on static deflections.
    pub limits: Option<RawOwnLimits>,
    /// Service class of the crane by CMAA 70, "A" to "F", for limits of deflections.
    pub class: Option<String>,
    /// Class of load effect history of EN 1991-3, "S0" to "S9", for damage-equivalent wheel loads.
    pub s_class: Option<String>,
    /// Class of the mill building in AIST TR-13, "A" to "D", for limits of deflections.
    pub building_class: Option<String>,
    /// Hoisting class of EN 1991-3: "HC1" to "HC4".
    pub hoisting: Option<String>,
    /// Onset of the drive forces, for phi5: "steady", "smooth" (default), "sudden" or "backlash".
    pub drives: Option<String>,
    /// Release of the load, for phi3: "slow" or "rapid" (default).
    pub release: Option<String>,
    /// Guidance of the crane: "flanges" (default) or "rollers".
    pub guide: Option<String>,
    /// Minimum distance between hook and rail, length; by default that of the run.
    pub approach: Option<f64>,
    /// Width of the rail head, length.
    pub rail_head: Option<f64>,
    /// Rated speed of the bridge, length / time; by default the largest speed that the scene commands.
    pub bridge_speed: Option<f64>,
    /// Rated speed of the trolley, length / time; by default the largest speed that the scene commands.
    pub trolley_speed: Option<f64>,
    /// Rated hoisting speed, length / time; by default the largest speed that the scene commands.
    pub hoist_speed: Option<f64>,
    /// Stroke of the bumpers within which they stop the crane, length; by default values that need it are left out.
    pub bumper_stroke: Option<f64>,
    /// Ratio of the mean force of the bumpers to their largest force, at most 1; by default 0.5, a spring.
    pub bumper_efficiency: Option<f64>,
    /// Part of the section that resists lateral moments in stresses of girders, "whole section" or "top flange"; if it
    /// is given, these stresses are evaluated.
    pub lateral_section: Option<String>,
}

/// A design code, or several.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum RawCodes {
    One(String),
    Several(Vec<String>),
}

impl<'de> Deserialize<'de> for RawCodes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = RawCodes;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the name of a design code, or a list of names")
            }

            fn visit_str<E: Error>(self, value: &str) -> Result<RawCodes, E> {
                Ok(RawCodes::One(value.to_owned()))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<RawCodes, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(RawCodes::Several)
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

/// A selection of columns: all, none, or those with certain names.
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
