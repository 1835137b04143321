//! A checked design, as plain values in the units of its file.

use std::sync::Arc;

use practice::aist::CraneKind;
use practice::asce::CraneOperation;
use practice::duty::FatigueClass;
use practice::factor::{DriveOnset, HoistingClass, Release, phi2};
use practice::limits::DeflectionLimit;
use practice::local_stress::RailFixing;

use crate::practice_words::LateralSection;
use crate::spec::Spec;
use crate::units::Units;

/// Name of the lateral force of the trolley's drives in factors.
pub const TROLLEY_DRIVES: &str = "trolley drives";

/// Name of the forces of a crane that tilts, in factors and as a part of vertical forces.
pub const TILTING: &str = "tilting";

/// Name of the part of a vertical force that is given as a number.
pub const WHOLE: &str = "vertical";

/// A design, read and checked together with its spec.
#[derive(Clone, Debug)]
pub struct Design {
    /// Its name.
    pub name: String,
    /// Units of all its numbers and of its spec.
    pub units: Units,
    /// File of the spec, as the design names it.
    pub spec_file: String,
    /// The structure.
    pub spec: Arc<Spec>,
    /// Dead load.
    pub dead: DesignDead,
    /// Wheel trains.
    pub trains: Vec<DesignTrain>,
    /// Load cases.
    pub cases: Vec<DesignCase>,
    /// Sections elsewhere.
    pub sections: Vec<DesignSection>,
    /// By rail: coordinates between which its spans lie.
    pub spans: Vec<Vec<f64>>,
    /// By rail: whether the file gives these coordinates.
    pub are_spans_given: Vec<bool>,
    /// Design code and data of the crane.
    pub practice: DesignPractice,
}

/// Design code, and what its rows need of the crane.
#[derive(Clone, Debug)]
pub struct DesignPractice {
    /// The code, as written.
    pub code: Option<String>,
    /// Limits of deflections by the code and its class, and those of one's own.
    pub limits: Vec<DeflectionLimit>,
    /// Class of load effect history of EN 1991-3.
    pub s_class: Option<FatigueClass>,
    /// Kind of crane in AIST TR-13.
    pub kind: CraneKind,
    /// Operation of the crane, for ASCE 7.
    pub operation: CraneOperation,
    /// Hoisting class of EN 1991-3.
    pub hoisting: Option<HoistingClass>,
    /// Onset of the drive forces.
    pub drives: DriveOnset,
    /// How rapidly a payload is released, by grabs and magnets; none where nothing is released.
    pub release: Option<Release>,
    /// Rated hoisting speed, m/s.
    pub hoist_speed: Option<f64>,
    /// What resists lateral moments in stresses.
    pub lateral_section: LateralSection,
    /// How crane rails are fastened to their flanges, where the design says it.
    pub rail_fastening: Option<RailFixing>,
    /// Whether cases without factors of their own are also calculated with the groups of loads of the code.
    pub combinations: bool,
}

impl DesignPractice {
    /// phi2 of the hoisting class at the rated speed; `None` where the design does not give both.
    #[must_use]
    pub fn phi2(&self) -> Option<f64> {
        phi2(self.hoisting?, self.hoist_speed?).ok()
    }
}

/// Dead load of a design.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DesignDead {
    /// Acceleration of gravity with which the structure weighs; 0 where its weight does not count.
    pub gravity: f64,
    /// By rail: load per length, downwards.
    pub lines: Vec<f64>,
}

/// A wheel train.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignTrain {
    /// Its name.
    pub name: String,
    /// Distances from the outermost wheels to its ends, before and behind.
    pub ends: [f64; 2],
    /// The wheels.
    pub wheels: Vec<DesignWheel>,
    /// Whether it is tried the other way round.
    pub turned: bool,
    /// Whether wheels may stand beyond the ends of the rails.
    pub enters: bool,
    /// Whether signs of horizontal forces and eccentricities are tried.
    pub reverses: bool,
    /// Weights of the hoisted load, the trolley and the bridge, where they are given.
    pub weights: [Option<f64>; 3],
}

/// A wheel of a train.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignWheel {
    /// Index of its rail.
    pub rail: usize,
    /// Distance ahead of the position of the train.
    pub x: f64,
    /// Parts of its vertical force by name; a force without parts has one named `vertical`.
    pub vertical: Vec<(String, f64)>,
    /// Lateral force along +z.
    pub lateral: f64,
    /// Longitudinal force along +x.
    pub longitudinal: f64,
    /// Lateral force along +z from skewing of the crane.
    pub skewing: f64,
    /// Its share in a buffer force along +x.
    pub buffer: f64,
    /// Its share in the lateral force of the trolley's drives, 0.1 (Q + T) of EN 1991-3, 2.7.5, along +z; 0 where the train
    /// does not give both weights.
    pub trolley_drives: f64,
    /// Lateral force along +z while the crane tilts against an obstacle; a change of the vertical force is its part `tilting`.
    pub tilting: f64,
    /// Distance of the forces from the line of the rail along +z.
    pub eccentricity: f64,
}

/// Parts of vertical forces that codes factor apart: the weight of the crane and the hoisted load. A third one, [`TILTING`], acts
/// only with a factor of its own.
pub const CODE_PARTS: [&str; 2] = ["crane", "hoist"];

impl DesignWheel {
    /// Whether its vertical force is given in the parts that codes factor apart.
    #[must_use]
    pub fn has_code_parts(&self) -> bool {
        self.vertical
            .iter()
            .all(|(name, _)| name == TILTING || CODE_PARTS.contains(&name.as_str()))
    }

    /// Whether it has a force from tilting of the crane.
    #[must_use]
    pub fn tilts(&self) -> bool {
        self.tilting != 0.0
            || self
                .vertical
                .iter()
                .any(|(name, force)| name == TILTING && *force != 0.0)
    }

    /// Its vertical force without factors.
    #[must_use]
    pub fn whole_vertical(&self) -> f64 {
        self.vertical
            .iter()
            .filter(|(name, _)| name != TILTING)
            .map(|(_, force)| force)
            .sum()
    }
}

impl DesignTrain {
    /// Whether any wheel has a lateral force.
    #[must_use]
    pub fn has_lateral_forces(&self) -> bool {
        self.wheels.iter().any(|wheel| wheel.lateral != 0.0)
    }
}

/// Trains that stand on the rails at once.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignCase {
    /// Its name.
    pub name: String,
    /// Indices of its trains.
    pub trains: Vec<usize>,
    /// Least clear distance between the ends of two trains.
    pub gap: f64,
    /// Whether the order of the trains is the given one.
    pub ordered: bool,
    /// Factors that are given, by the name of the load.
    pub factors: Vec<(String, f64)>,
}

/// Loads that act only where a case gives them a factor.
const ON_REQUEST: [&str; 4] = ["skewing", "buffer", TROLLEY_DRIVES, TILTING];

impl DesignCase {
    /// Factor of a load by name; by default 0 for `skewing`, `buffer`, `trolley drives` and `tilting`, and 1 for all others.
    #[must_use]
    pub fn factor(&self, name: &str) -> f64 {
        let default = if ON_REQUEST.contains(&name) { 0.0 } else { 1.0 };
        self.factors
            .iter()
            .find(|(known, _)| known == name)
            .map_or(default, |(_, factor)| *factor)
    }
}

/// A section of a member elsewhere.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignSection {
    /// Its name.
    pub name: String,
    /// Index of the member.
    pub member: usize,
    /// Place along its flexible part, as a fraction from its first end.
    pub place: f64,
    /// Component of the internal force.
    pub component: fea::ForceComponent,
}
