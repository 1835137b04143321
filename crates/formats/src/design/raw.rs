//! A design file as written, unchecked.

use std::fmt;

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, Error, MapAccess, SeqAccess, Visitor};

use crate::own_limits::RawOwnLimits;
use crate::text::entries::Entries;
use crate::units::RawUnits;

crate::text::object::objects!(
    RawDesign,
    RawTrain,
    RawTrainWheel,
    RawNamedCase,
    RawDeadLoads,
    RawSectionCut,
    RawDesignPractice
);

/// A design: wheel trains on a structure, and load cases.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawDesign {
    /// Name and version of the format.
    pub format: Option<String>,
    /// Name of the design; by default that of the file.
    pub name: Option<String>,
    /// Units of all numbers of the file.
    pub units: Option<RawUnits>,
    /// File of the beam spec, relative to the folder of this file.
    pub spec: Option<String>,
    /// Whether the self-weight of the structure acts, or an object with `weight` and loads along rails; by default
    /// false.
    pub dead_load: Option<RawDead>,
    /// Acceleration of gravity, length / time^2, by default 9.80665 m/s2.
    pub gravity: Option<f64>,
    /// Wheel trains.
    pub trains: Option<Vec<RawTrain>>,
    /// Load cases: trains that are on the rails at the same time; by default each train alone.
    pub cases: Option<Vec<RawCase>>,
    /// Further sections of members at which internal forces are evaluated.
    #[serde(default)]
    pub sections: Vec<RawSectionCut>,
    /// Coordinates of the ends of the spans of each rail, by the name of the rail; by default, in the short form of a
    /// spec, its supports.
    pub spans: Option<Entries<Vec<f64>>>,
    /// Design code and the data that its checks require.
    pub practice: Option<RawDesignPractice>,
}

/// A train of wheels at fixed distances.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawTrain {
    /// Its name.
    pub name: Option<String>,
    /// Rail on which its wheels stand, unless a wheel names another one; may be left out where there is one rail.
    pub rail: Option<String>,
    /// Distances from the outermost wheels to the ends of the train, before and behind, length; by default 0.
    pub ends: Option<[f64; 2]>,
    /// The wheels; the coordinate of the first wheel is the position of the train.
    pub wheels: Option<Vec<RawTrainWheel>>,
    /// Lateral force on each wheel, along +z.
    pub lateral: Option<f64>,
    /// Longitudinal force of the whole train along +x, shared equally by its wheels.
    pub longitudinal: Option<f64>,
    /// Buffer force on the whole train along +x, shared equally by its wheels; acts only in cases with a factor
    /// for it.
    pub buffer: Option<f64>,
    /// Eccentricity of the forces of each wheel from the axis of the rail, along +z, length.
    pub eccentricity: Option<f64>,
    /// Whether the train is also placed in the reversed orientation; by default true.
    pub turned: Option<bool>,
    /// Whether wheels may be beyond the ends of the rail, where they exert no force; by default false.
    pub enters: Option<bool>,
    /// Signs of lateral and longitudinal forces and eccentricities: "both" (default) or "given".
    pub signs: Option<String>,
    /// Weight of the hoisted load, force; for checks of design codes.
    pub hoist_load: Option<f64>,
    /// Weight of the trolley with its lifting gear, force; for checks of design codes.
    pub trolley: Option<f64>,
    /// Weight of the bridge without trolley, force; for checks of design codes.
    pub bridge: Option<f64>,
}

/// A wheel of a train.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawTrainWheel {
    /// Distance ahead of the position of the train, length.
    pub x: Option<f64>,
    /// Vertical force, positive pressing on the rail: a number, or its parts by name.
    pub vertical: Option<RawForces>,
    /// Lateral force of this wheel along +z, in place of that of the train.
    pub lateral: Option<f64>,
    /// Longitudinal force of this wheel along +x, in place of its share in that of the train.
    pub longitudinal: Option<f64>,
    /// Lateral force of this wheel along +z from skewing of the crane; acts only in cases with a factor for it.
    pub skewing: Option<f64>,
    /// Lateral force of this wheel along +z while the crane tilts against an obstacle; like the part `tilting` of
    /// `vertical`, it acts only in cases with a factor for it.
    pub tilting: Option<f64>,
    /// Eccentricity of its forces from the axis of the rail, along +z, length, in place of that of the train.
    pub eccentricity: Option<f64>,
    /// Rail on which it stands, by default that of the train.
    pub rail: Option<String>,
}

/// A load case with a name.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawNamedCase {
    /// Its name; by default its trains.
    pub name: Option<String>,
    /// Names of the trains that are on the rails at the same time; a name may occur several times.
    pub trains: Option<Vec<String>>,
    /// Minimum clear distance between the ends of two trains on a rail, length; by default 0.
    pub gap: Option<f64>,
    /// Order of the trains along the rail: "any" (default) or "given".
    pub order: Option<String>,
    /// Factors of the loads: `dead`, `vertical`, parts of vertical forces by name, `lateral`, `longitudinal`, by default
    /// 1; `skewing`, `buffer`, `trolley drives` and `tilting`, by default 0.
    #[serde(default)]
    pub factors: Entries<f64>,
}

/// Dead load in parts.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawDeadLoads {
    /// Whether the self-weight of the structure acts; by default false.
    pub weight: Option<bool>,
    /// Load per length of each rail, force / length, downwards, by the name of the rail.
    #[serde(default)]
    pub line: Entries<f64>,
}

/// A further section of a member at which an internal force is evaluated.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawSectionCut {
    /// Its name.
    pub name: Option<String>,
    /// Block and index of the cell, in the general form of a spec.
    pub cell: Option<[usize; 2]>,
    /// Position along the flexible part of the cell, as a fraction of its length from end a.
    pub place: Option<f64>,
    /// Coordinate along the girder, length, in the short form of a spec.
    pub x: Option<f64>,
    /// Component of the internal force in the axes of the member: "N", "Vy", "Vz", "Mx", "My" or "Mz".
    pub component: Option<String>,
}

/// Design code and data of the crane.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawDesignPractice {
    /// Design code, such as "EN 1991-3", "ASCE 7" or "AIST TR-13".
    pub code: Option<String>,
    /// Limits of one's own on deflections.
    pub limits: Option<RawOwnLimits>,
    /// Service class of the crane in the code.
    pub class: Option<String>,
    /// Class of load effect history of EN 1991-3, "S0" to "S9".
    pub s_class: Option<String>,
    /// Class of the mill building in AIST TR-13, "A" to "D".
    pub building_class: Option<String>,
    /// Whether every case without `factors` is also calculated with the load groups of the code.
    pub combinations: Option<bool>,
    /// Operation of the crane, for the impact of ASCE 7: "cab" (default), "monorail", "pendant" or "hand-geared".
    pub operation: Option<String>,
    /// Kind of crane in AIST TR-13.
    pub kind: Option<String>,
    /// Hoisting class of EN 1991-3: "HC1" to "HC4".
    pub hoisting: Option<String>,
    /// Onset of the drive forces, for phi5.
    pub drives: Option<String>,
    /// Release of the load by grabs or magnets, for phi3: "slow" or "rapid".
    pub release: Option<String>,
    /// Part of the section that resists lateral moments in stresses: "whole section" (default) or "top flange".
    pub lateral_section: Option<String>,
    /// How crane rails are fastened to their flanges: "rigid", "loose" or "pad".
    pub rail_fastening: Option<String>,
    /// Guidance of the crane: "flanges" or "rollers".
    pub guide: Option<String>,
    /// Minimum distance between hook and rail, length.
    pub approach: Option<f64>,
    /// Width of the rail head, length.
    pub rail_head: Option<f64>,
    /// Rated speed of the bridge, length / time.
    pub bridge_speed: Option<f64>,
    /// Rated speed of the trolley, length / time.
    pub trolley_speed: Option<f64>,
    /// Rated hoisting speed, length / time.
    pub hoist_speed: Option<f64>,
}

/// A force as a number, or in parts by name.
#[derive(Debug)]
pub(crate) enum RawForces {
    Whole(f64),
    Parts(Entries<f64>),
}

/// A case as a list of trains, or with a name.
#[derive(Debug)]
pub(crate) enum RawCase {
    Trains(Vec<String>),
    Named(Box<RawNamedCase>),
}

/// Dead load: all weight or none, or in parts.
#[derive(Debug)]
pub(crate) enum RawDead {
    Weight(bool),
    Parts(Box<RawDeadLoads>),
}

impl<'de> Deserialize<'de> for RawForces {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = RawForces;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number or an object of named numbers")
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<RawForces, E> {
                Ok(RawForces::Whole(value))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<RawForces, E> {
                Ok(RawForces::Whole(value as f64))
            }

            fn visit_u64<E: Error>(self, value: u64) -> Result<RawForces, E> {
                Ok(RawForces::Whole(value as f64))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RawForces, A::Error> {
                Entries::deserialize(MapAccessDeserializer::new(map)).map(RawForces::Parts)
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

impl<'de> Deserialize<'de> for RawCase {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = RawCase;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of names of trains, or an object with `trains`")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<RawCase, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(RawCase::Trains)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RawCase, A::Error> {
                RawNamedCase::deserialize(MapAccessDeserializer::new(map))
                    .map(|case| RawCase::Named(Box::new(case)))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

impl<'de> Deserialize<'de> for RawDead {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = RawDead;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("true, false or an object with `weight` and `line`")
            }

            fn visit_bool<E: Error>(self, weight: bool) -> Result<RawDead, E> {
                Ok(RawDead::Weight(weight))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RawDead, A::Error> {
                RawDeadLoads::deserialize(MapAccessDeserializer::new(map))
                    .map(|dead| RawDead::Parts(Box::new(dead)))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}
