//! Keywords of `practice` in scenes and designs: classes and kinds of cranes.

use practice::aist::{BuildingClass, CraneKind};
use practice::asce::CraneOperation;
use practice::duty::FatigueClass;
use practice::factor::{DriveOnset, HoistingClass, Release};
use practice::limit_choice::LIMIT_CODES;
use practice::limits::ServiceClass;
use practice::local_stress::RailFixing;
use practice::skew::Guide;

/// A code that has loads but no limits of deflections.
pub(crate) const ASCE_7: &str = "ASCE 7";

/// The codes that a design or a scene may name, numbered.
pub(crate) fn codes() -> Vec<(&'static str, usize)> {
    let all = LIMIT_CODES.into_iter().chain([ASCE_7]).enumerate();
    all.map(|(number, code)| (code, number)).collect()
}

/// What resists lateral moments in stresses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LateralSection {
    /// The whole section, with its second moment for lateral bending.
    #[default]
    Whole,
    /// The top flange alone, as in hand calculations.
    TopFlange,
}

impl LateralSection {
    /// Its word in files.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            LateralSection::Whole => "whole section",
            LateralSection::TopFlange => "top flange",
        }
    }

    /// What takes lateral moments, in words for a sentence.
    #[must_use]
    pub const fn phrase(self) -> &'static str {
        match self {
            LateralSection::Whole => "lateral moments on the whole section",
            LateralSection::TopFlange => "lateral moments on the top flange alone",
        }
    }
}

/// Keywords of what resists lateral moments.
pub(crate) const LATERAL_SECTIONS: [(&str, LateralSection); 2] = [
    (LateralSection::Whole.word(), LateralSection::Whole),
    (LateralSection::TopFlange.word(), LateralSection::TopFlange),
];

/// Keywords of the hoisting classes.
pub(crate) const HOISTING: [(&str, HoistingClass); 4] = [
    ("HC1", HoistingClass::Hc1),
    ("HC2", HoistingClass::Hc2),
    ("HC3", HoistingClass::Hc3),
    ("HC4", HoistingClass::Hc4),
];
/// Keywords of the onset of drive forces.
pub(crate) const DRIVES: [(&str, DriveOnset); 4] = [
    ("steady", DriveOnset::Steady),
    ("smooth", DriveOnset::Smooth),
    ("sudden", DriveOnset::Sudden),
    ("backlash", DriveOnset::Backlash),
];

/// Keywords of the rate at which a payload is released.
pub(crate) const RELEASE: [(&str, Release); 2] =
    [("slow", Release::Slow), ("rapid", Release::Rapid)];

/// Keywords of the fastening of crane rails to flanges.
pub(crate) const FASTENINGS: [(&str, RailFixing); 3] = [
    ("rigid", RailFixing::Rigid),
    ("loose", RailFixing::Loose),
    ("pad", RailFixing::ElasticPad),
];

/// Keywords of the guidance of a crane.
pub(crate) const GUIDE: [(&str, Guide); 2] =
    [("flanges", Guide::Flanges), ("rollers", Guide::Rollers)];

/// Keywords of the kinds of cranes.
pub(crate) const KINDS: [(&str, CraneKind); 8] = [
    ("mill", CraneKind::Mill),
    ("ladle", CraneKind::Ladle),
    ("bucket", CraneKind::Bucket),
    ("soaking pit", CraneKind::SoakingPit),
    ("stripping", CraneKind::Stripping),
    ("motor room", CraneKind::MotorRoom),
    ("stacker", CraneKind::Stacker),
    ("pendant", CraneKind::Pendant),
];

/// Keywords of the service classes of CMAA 70.
pub(crate) const CLASSES: [(&str, ServiceClass); 6] = [
    ("A", ServiceClass::A),
    ("B", ServiceClass::B),
    ("C", ServiceClass::C),
    ("D", ServiceClass::D),
    ("E", ServiceClass::E),
    ("F", ServiceClass::F),
];

/// Keywords of the classes of mill buildings.
pub(crate) const BUILDINGS: [(&str, BuildingClass); 4] = [
    ("A", BuildingClass::A),
    ("B", BuildingClass::B),
    ("C", BuildingClass::C),
    ("D", BuildingClass::D),
];

/// Keywords of the classes of load effect history, in their order.
const S_CLASSES: [&str; 10] = ["S0", "S1", "S2", "S3", "S4", "S5", "S6", "S7", "S8", "S9"];

/// Keywords of the operation of a crane, for the impact of ASCE 7.
pub(crate) const OPERATIONS: [(&str, CraneOperation); 4] = [
    ("cab", CraneOperation::Cab),
    ("monorail", CraneOperation::Monorail),
    ("pendant", CraneOperation::Pendant),
    ("hand-geared", CraneOperation::HandGeared),
];

/// Keywords of the classes of load effect history with their classes.
pub(crate) fn fatigue_classes() -> [(&'static str, Option<FatigueClass>); 10] {
    let mut index = 0..;
    S_CLASSES.map(|word| (word, index.next().and_then(FatigueClass::new)))
}
