//! Limits of deflections and displacements of crane runways, by code and class.
//!
//! All limits apply to static wheel loads without dynamic factors, unless their `loads` say otherwise.

use super::aist::{self, BuildingClass};
use super::clause::{CodeClause, Evidence, aist_2020, aist_2021, cmaa_1983, cmaa_2010, en_1993_6};
use super::cmaa;
use crate::Error;
use crate::error::{Argument, positive};

/// What a limit bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LimitedDisplacement {
    /// Vertical deflection of a runway girder within its span.
    RunwayVertical,
    /// Lateral deflection of a runway girder within its span, at the top of the rail.
    RunwayLateral,
    /// Vertical deflection of the girder of a monorail hoist within its span, under the payload alone.
    MonorailVertical,
    /// Vertical deflection of a bridge girder within the span of the crane.
    BridgeGirder,
    /// Lateral displacement of the frame at the rail.
    FrameLateral,
    /// Difference of the lateral displacements of neighbouring frames.
    FrameDifference,
    /// Change of the distance of the two rails.
    GaugeChange,
    /// Difference of the vertical deflections of the two rails.
    HeightDifference,
    /// Vertical deflection of an overhang of a runway girder.
    Overhang,
}

impl LimitedDisplacement {
    /// Its name in summaries.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            LimitedDisplacement::RunwayVertical => "runway_vertical",
            LimitedDisplacement::RunwayLateral => "runway_lateral",
            LimitedDisplacement::MonorailVertical => "monorail_vertical",
            LimitedDisplacement::BridgeGirder => "bridge_girder",
            LimitedDisplacement::FrameLateral => "frame_lateral",
            LimitedDisplacement::FrameDifference => "frame_difference",
            LimitedDisplacement::GaugeChange => "gauge_change",
            LimitedDisplacement::HeightDifference => "height_difference",
            LimitedDisplacement::Overhang => "overhang",
        }
    }

    /// Its name in checks.
    #[must_use]
    pub fn phrase(self) -> &'static str {
        match self {
            LimitedDisplacement::RunwayVertical => "vertical deflection",
            LimitedDisplacement::RunwayLateral => "lateral deflection",
            LimitedDisplacement::MonorailVertical => "vertical deflection of a monorail girder",
            LimitedDisplacement::BridgeGirder => "vertical deflection of the bridge girder",
            LimitedDisplacement::FrameLateral => "lateral displacement of the frame at the rail",
            LimitedDisplacement::FrameDifference => {
                "difference of the displacements of neighbouring frames"
            }
            LimitedDisplacement::GaugeChange => "change of gauge",
            LimitedDisplacement::HeightDifference => "difference in height",
            LimitedDisplacement::Overhang => "deflection of the overhang",
        }
    }

    /// Symbol of the length that `ratio` divides, and its description.
    #[must_use]
    pub fn reference_length(self) -> [&'static str; 2] {
        match self {
            LimitedDisplacement::RunwayVertical
            | LimitedDisplacement::RunwayLateral
            | LimitedDisplacement::MonorailVertical => ["L", "span of the runway girder"],
            LimitedDisplacement::BridgeGirder => ["L", "span of the crane"],
            LimitedDisplacement::Overhang => ["L", "length of the overhang"],
            LimitedDisplacement::FrameLateral => ["h", "height of the rail above the base"],
            LimitedDisplacement::FrameDifference => ["L", "distance of the frames"],
            LimitedDisplacement::GaugeChange | LimitedDisplacement::HeightDifference => {
                ["s", "distance of the rails"]
            }
        }
    }
}

/// Loads to which a limit applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LimitLoads {
    /// Static vertical wheel loads of all cranes of a case.
    StaticWheels,
    /// Static vertical wheel loads of one crane.
    OneCrane,
    /// A tenth of the static wheel loads, acting laterally.
    Tenth,
    /// Characteristic horizontal crane loads: side thrust, skewing, drives of the trolley.
    Horizontal,
    /// Side thrust of one crane.
    OneSideThrust,
    /// Side thrust of one crane, or wind.
    OneSideThrustOrWind,
    /// Crane surge.
    Surge,
    /// Crane loads with temperature.
    WithTemperature,
    /// The payload of a hoist.
    Payload,
    /// The trolley with its rated load.
    TrolleyAndLoad,
}

impl LimitLoads {
    /// Description in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            LimitLoads::StaticWheels => "largest static wheel loads, without impact",
            LimitLoads::OneCrane => "one crane, static, without impact",
            LimitLoads::Tenth => "a tenth of the largest static wheel loads, lateral",
            LimitLoads::Horizontal => {
                "characteristic horizontal crane loads without dynamic factors"
            }
            LimitLoads::OneSideThrust => "side thrust of one crane",
            LimitLoads::OneSideThrustOrWind => "side thrust of one crane, or wind",
            LimitLoads::Surge => "crane surge, characteristic",
            LimitLoads::WithTemperature => "crane loads with temperature effects",
            LimitLoads::Payload => "payload alone",
            LimitLoads::TrolleyAndLoad => "trolley and rated load, without impact",
        }
    }
}

/// A limit of a deflection or displacement: a length over a ratio, an absolute value, or the smaller of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeflectionLimit {
    /// What it bounds.
    pub displacement: LimitedDisplacement,
    /// Smallest ratio of the reference length to the displacement.
    pub ratio: Option<f64>,
    /// Largest displacement, m.
    pub most: Option<f64>,
    /// The loads to which the limit applies.
    pub loads: LimitLoads,
    /// Code, edition, clause and check.
    pub clause: CodeClause,
}

impl DeflectionLimit {
    /// The largest displacement allowed, in m, for a reference length in m
    /// ([`LimitedDisplacement::reference_length`]): the smaller of `length / ratio` and `most`, and never more than
    /// the length itself.
    ///
    /// # Errors
    /// [`Error::Range`] for a length that is not positive.
    pub fn allowable(&self, length: f64) -> Result<f64, Error> {
        let length = positive(Argument::Length, length)?;
        let by_ratio = self.ratio.map_or(f64::INFINITY, |ratio| length / ratio);
        Ok(by_ratio.min(self.most.unwrap_or(f64::INFINITY)).min(length))
    }

    /// The limit in symbols, such as `L/600, at most 25 mm`.
    #[must_use]
    pub fn formula(&self) -> String {
        let [symbol, _] = self.displacement.reference_length();
        let ratio = self
            .ratio
            .map(|ratio| format!("{symbol}/{}", ratio.round()));
        let most = self.most.map(|most| format!("{:.0} mm", 1000.0 * most));
        match (ratio, most) {
            (Some(ratio), Some(most)) => format!("{ratio}, at most {most}"),
            (ratio, most) => ratio.or(most).unwrap_or_default(),
        }
    }
}

/// Service class of a crane by CMAA 70, from standby service (A) to continuous severe service (F).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ServiceClass {
    /// Standby or infrequent service.
    A,
    /// Light service.
    B,
    /// Moderate service.
    C,
    /// Heavy service.
    D,
    /// Severe service.
    E,
    /// Continuous severe service.
    F,
}

/// Drive and capacity of a crane, by which IS 800 limits the deflection of gantry girders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GantryCrane {
    /// Manually operated cranes.
    Manual,
    /// Electric cranes up to 50 t.
    ElectricTo50Tonnes,
    /// Electric cranes above 50 t.
    ElectricAbove50Tonnes,
}

/// A limit without its optional parts.
const fn limit(
    displacement: LimitedDisplacement,
    ratio: f64,
    loads: LimitLoads,
    clause: CodeClause,
) -> DeflectionLimit {
    DeflectionLimit {
        displacement,
        ratio: Some(ratio),
        most: None,
        loads,
        clause,
    }
}

/// Limits of EN 1993-6:2007, 7.3, Tables 7.1 and 7.2; national annexes may change them.
pub const EN_1993_6_LIMITS: [DeflectionLimit; 7] = [
    DeflectionLimit {
        displacement: LimitedDisplacement::RunwayVertical,
        ratio: Some(600.0),
        most: Some(0.025),
        loads: LimitLoads::StaticWheels,
        clause: en_1993_6("Table 7.2 a", Evidence::Used),
    },
    limit(
        LimitedDisplacement::RunwayLateral,
        600.0,
        LimitLoads::Horizontal,
        en_1993_6("Table 7.1 a", Evidence::Used),
    ),
    limit(
        LimitedDisplacement::FrameLateral,
        400.0,
        LimitLoads::Horizontal,
        en_1993_6("Table 7.1 b", Evidence::Used),
    ),
    limit(
        LimitedDisplacement::FrameDifference,
        600.0,
        LimitLoads::Horizontal,
        en_1993_6("Table 7.1 c", Evidence::Memory),
    ),
    DeflectionLimit {
        displacement: LimitedDisplacement::GaugeChange,
        ratio: None,
        most: Some(0.010),
        loads: LimitLoads::WithTemperature,
        clause: en_1993_6("Table 7.1 e", Evidence::Memory),
    },
    limit(
        LimitedDisplacement::HeightDifference,
        600.0,
        LimitLoads::StaticWheels,
        en_1993_6("Table 7.2 b", Evidence::Memory),
    ),
    limit(
        LimitedDisplacement::MonorailVertical,
        500.0,
        LimitLoads::Payload,
        en_1993_6("Table 7.2 c", Evidence::Memory),
    ),
];

/// Limits of CMAA 70: runway girders in 1.4.6 (2010), bridge girders in 3.5.5 (1983).
pub const CMAA_LIMITS: [DeflectionLimit; 3] = [
    limit(
        LimitedDisplacement::RunwayVertical,
        cmaa::RUNWAY_VERTICAL,
        LimitLoads::StaticWheels,
        cmaa_2010("1.4.6", Evidence::Quoted),
    ),
    limit(
        LimitedDisplacement::RunwayLateral,
        cmaa::RUNWAY_LATERAL,
        LimitLoads::Tenth,
        cmaa_2010("1.4.6", Evidence::Quoted),
    ),
    limit(
        LimitedDisplacement::BridgeGirder,
        1.0 / cmaa::BRIDGE_DEFLECTION,
        LimitLoads::TrolleyAndLoad,
        cmaa_1983("3.5.5", Evidence::Quoted),
    ),
];

/// A clause of AISC Design Guide 7, third edition.
const fn design_guide_7(clause: &'static str, evidence: Evidence) -> CodeClause {
    CodeClause {
        standard: "AISC Design Guide 7",
        edition: "3rd (2019)",
        clause,
        evidence,
    }
}

/// Limits of AISC Design Guide 7 for runway girders by the service class of the crane: vertically L/600 for A to
/// C, L/800 for D, L/1000 for E and F; laterally L/400. *Not confirmed.*
///
/// # Source
/// AISC Design Guide 7, third edition (2019), chapter on runway girders.
#[must_use]
pub fn design_guide_limits(class: ServiceClass) -> [DeflectionLimit; 2] {
    let ratio = match class {
        ServiceClass::A | ServiceClass::B | ServiceClass::C => 600.0,
        ServiceClass::D => 800.0,
        ServiceClass::E | ServiceClass::F => 1000.0,
    };
    let clause = design_guide_7("runway girders", Evidence::Memory);
    [
        limit(
            LimitedDisplacement::RunwayVertical,
            ratio,
            LimitLoads::StaticWheels,
            clause,
        ),
        limit(
            LimitedDisplacement::RunwayLateral,
            400.0,
            LimitLoads::Tenth,
            clause,
        ),
    ]
}

/// Limits of AIST Technical Report 13 by the class of the building: vertically L/1000 for A and B, L/600 for C
/// and D; laterally L/400; frames height/400 and at most 2 in.
///
/// # Source
/// AIST TR-13, 5.8.7 (draft of 2020) and 5.3 (2021).
#[must_use]
pub fn mill_limits(building: BuildingClass) -> [DeflectionLimit; 3] {
    let clause = aist_2020("5.8.7", Evidence::Used);
    [
        limit(
            LimitedDisplacement::RunwayVertical,
            aist::runway_vertical(building),
            LimitLoads::OneCrane,
            clause,
        ),
        limit(
            LimitedDisplacement::RunwayLateral,
            aist::RUNWAY_LATERAL,
            LimitLoads::OneSideThrust,
            clause,
        ),
        DeflectionLimit {
            displacement: LimitedDisplacement::FrameLateral,
            ratio: Some(400.0),
            most: Some(2.0 * cmaa::FOOT / 12.0),
            loads: LimitLoads::OneSideThrustOrWind,
            clause: aist_2021("5.3", Evidence::Quoted),
        },
    ]
}

/// Limits of IS 800:2007 for gantry girders: vertically L/500 for manual, L/750 for electric cranes up to 50 t and
/// L/1000 above; laterally L/400; change of gauge 10 mm; frames at the rail height/200 with pendant operation and
/// height/400 with a cab (`cab`).
///
/// # Source
/// IS 800:2007, Table 6.
#[must_use]
pub fn is_800_limits(crane: GantryCrane, cab: bool) -> [DeflectionLimit; 4] {
    let clause = CodeClause {
        standard: "IS 800",
        edition: "2007",
        clause: "Table 6",
        evidence: Evidence::Used,
    };
    let ratio = match crane {
        GantryCrane::Manual => 500.0,
        GantryCrane::ElectricTo50Tonnes => 750.0,
        GantryCrane::ElectricAbove50Tonnes => 1000.0,
    };
    let surge = LimitLoads::Surge;
    [
        limit(
            LimitedDisplacement::RunwayVertical,
            ratio,
            LimitLoads::StaticWheels,
            clause,
        ),
        limit(LimitedDisplacement::RunwayLateral, 400.0, surge, clause),
        DeflectionLimit {
            displacement: LimitedDisplacement::GaugeChange,
            ratio: None,
            most: Some(0.010),
            loads: surge,
            clause,
        },
        limit(
            LimitedDisplacement::FrameLateral,
            if cab { 400.0 } else { 200.0 },
            surge,
            clause,
        ),
    ]
}
