//! What the calculation of a design gives.

use formats::LateralSection;
use formats::verdict::OmittedCheck;
use practice::clause::CodeClause;
use trains::{CaseEnvelopes, Governing};

use crate::loads::LoadKind;

/// The results of a design.
#[derive(Clone, Debug)]
pub struct DesignResult {
    /// One for each case, in the order of the design.
    pub cases: Vec<SolvedCase>,
    /// Limits of deflections against the results.
    pub limits: Vec<LimitCheck>,
    /// Coordinates of the ends of the spans of limits, by plane (vertical, lateral) and rail; empty where a rail has none.
    pub chords: [Vec<Vec<f64>>; 2],
    /// By rail: whether it stands on an arm on members of open section, whose lateral deflections are upper bounds because
    /// their torsion has no warping.
    pub is_lateral_bound: Vec<bool>,
    /// Largest direct stress and largest shear stress in the web of each rail and case.
    pub stresses: Vec<StressCheck>,
    /// Local stresses in webs under the largest wheel of each rail and case.
    pub wheel_stresses: Vec<WheelStress>,
    /// Forces of buffers on end stops.
    pub end_stops: Vec<EndStopForce>,
    /// Change of gauge and difference in height of pairs of rails.
    pub pairs: Vec<RailPairResponse>,
    /// Damage-equivalent loads of the wheels of each train.
    pub fatigue: Vec<FatigueLoads>,
    /// Checks and results that are left out, with the reasons.
    pub left_out: Vec<OmittedCheck>,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// Bound of the relative error of the influence coefficients.
    pub error_bound: f64,
}

/// The results of one case.
#[derive(Clone, Debug)]
pub struct SolvedCase {
    /// Its name.
    pub name: String,
    /// Envelopes and extremes along the rails.
    pub envelopes: CaseEnvelopes,
    /// Reactions under all loads.
    pub reactions: Vec<ReactionExtremes>,
    /// Reactions under each kind of load alone.
    pub by_load: Vec<(LoadKind, Vec<ReactionExtremes>)>,
    /// Internal forces of the named sections, in the order of the design.
    pub sections: Vec<[Governing; 2]>,
}

/// Largest and smallest value of a reaction.
#[derive(Clone, Debug)]
pub struct ReactionExtremes {
    /// Which reaction.
    pub name: ReactionName,
    /// Largest and smallest value.
    pub extremes: [Governing; 2],
}

/// Name of a reaction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReactionName {
    /// The supported point, named as in the columns of a history.
    pub support: String,
    /// Its global direction, `ux` to `rz`.
    pub direction: String,
}

/// A limit of a code against a result.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitCheck {
    /// Code, edition, clause, and how the value was checked.
    pub clause: CodeClause,
    /// What is limited, in words.
    pub quantity: &'static str,
    /// The limit in symbols, such as `L/600, at most 25 mm`.
    pub formula: String,
    /// The loads to which the limit applies.
    pub loads: &'static str,
    /// The result, in the units of the design.
    pub value: f64,
    /// Its limit.
    pub limit: f64,
    /// Number of the case from 1.
    pub case: usize,
    /// Name of the rail.
    pub rail: String,
    /// Number of the span of its plane from 1; 0 and one more than the last for overhangs.
    pub span: usize,
    /// Coordinates of the ends of the span; `None` for a pair of rails.
    pub ends: Option<[f64; 2]>,
    /// Coordinate of the largest value.
    pub x: f64,
    /// Position of the first train.
    pub position: Option<f64>,
    /// Whether the value is the largest of chosen states only; otherwise it is the largest of all states.
    pub is_sampled: bool,
}

/// Loads of wheels that cause the same fatigue damage as the passages of a life.
#[derive(Clone, Debug, PartialEq)]
pub struct FatigueLoads {
    /// Name of the train.
    pub train: String,
    /// Factors lambda of direct and shear stress by the class of load effect history.
    pub lambda: [f64; 2],
    /// Factors of the weight of the crane and of the hoisted load.
    pub dynamic: [f64; 2],
    /// By wheel: equivalent loads for direct and shear stress.
    pub wheels: Vec<[f64; 2]>,
}

/// A stress with the strength that it uses, in one state.
#[derive(Clone, Debug, PartialEq)]
pub struct StressCheck {
    /// Which stress: `direct stress` or `shear stress in the web`.
    pub quantity: &'static str,
    /// Number of the case from 1.
    pub case: usize,
    /// Name of the rail.
    pub rail: String,
    /// Number of the span; 0 and one more than the last for overhangs.
    pub span: usize,
    /// Name of the section.
    pub section: String,
    /// The stress, in force over the square of length; direct stress is positive in tension.
    pub value: f64,
    /// The strength: f_y for direct stress, f_y/sqrt(3) for shear stress.
    pub strength: f64,
    /// A utilisation that no state of the case exceeds; `None` for shear stress, whose extremes are exact, and where members are
    /// tapered.
    pub bound: Option<f64>,
    /// The fibre, by its edge: `top` or `bottom`, `+z` or `-z`.
    pub fibre: Option<&'static str>,
    /// Parts of the stress, by the force that causes them.
    pub parts: Vec<(&'static str, f64)>,
    /// Coincident forces of the section.
    pub forces: Vec<(&'static str, f64)>,
    /// What resists the lateral moment.
    pub lateral_section: Option<LateralSection>,
    /// The state in which the stress is evaluated.
    pub governing: Governing,
}

impl StressCheck {
    /// The stress over the strength.
    #[must_use]
    pub fn utilisation(&self) -> f64 {
        self.value.abs() / self.strength
    }
}

/// Local stresses in the web of a girder under a wheel.
#[derive(Clone, Debug, PartialEq)]
pub struct WheelStress {
    /// Number of the case from 1.
    pub case: usize,
    /// Name of the rail.
    pub rail: String,
    /// Name of the section.
    pub section: String,
    /// Name of the crane rail.
    pub crane_rail: &'static str,
    /// Code, edition, clause of the effective length, and how it was checked.
    pub clause: CodeClause,
    /// Word of its fastening, and whether it is assumed.
    pub fastening: (&'static str, bool),
    /// Name of the train and number of the wheel from 1 with the largest force.
    pub wheel: (String, usize),
    /// Its force, with the factors of the case.
    pub force: f64,
    /// Largest sum of the forces of wheels whose effective lengths overlap: that of one wheel where none do.
    pub overlapping: f64,
    /// Effective length at the lower face of the flange.
    pub length: f64,
    /// sigma_oz, compressive, of the overlapping wheels together.
    pub vertical: f64,
    /// tau_oxz beside the wheel, of either sign.
    pub shear: f64,
    /// Largest shear stress V/(h t_w) of the girder in the case, to which the local one is added.
    pub global_shear: f64,
    /// Yield strength of the web, where the spec gives it.
    pub yield_strength: Option<f64>,
    /// Cycles of one passage.
    pub cycles: Vec<WheelCycle>,
}

impl WheelStress {
    /// |tau| + tau_oxz, the largest shear stress of the girder with the local one.
    #[must_use]
    pub fn total_shear(&self) -> f64 {
        self.global_shear + self.shear
    }
}

/// The cycle of local stresses as a wheel passes a place.
#[derive(Clone, Debug, PartialEq)]
pub struct WheelCycle {
    /// Name of the train and number of the wheel from 1.
    pub wheel: (String, usize),
    /// Range of sigma_oz: from 0 to its value under the wheel.
    pub vertical: f64,
    /// Range of tau_oxz, which reverses: twice its value beside the wheel.
    pub shear: f64,
}

/// The force of a train's buffer on an end stop.
#[derive(Clone, Debug, PartialEq)]
pub struct EndStopForce {
    /// Number of the case from 1.
    pub case: usize,
    /// Name of the train.
    pub train: String,
    /// Name of the rail.
    pub rail: String,
    /// Whether the stop is at the last coordinate of the rail; otherwise at the first.
    pub is_last: bool,
    /// Coordinate of the end of the rail.
    pub x: f64,
    /// Factor of buffer forces in the case.
    pub factor: f64,
    /// Force on the stop along +x, with the factor.
    pub force: f64,
}

/// How two rails move against each other under a train that stands on both.
#[derive(Clone, Debug, PartialEq)]
pub struct RailPairResponse {
    /// Number of the case from 1.
    pub case: usize,
    /// Names of the rails.
    pub rails: [String; 2],
    /// Which response: `change of gauge` or `difference in height`.
    pub quantity: &'static str,
    /// Distance of the rails.
    pub distance: f64,
    /// The value of largest size: the rails apart, or the second one below the first.
    pub value: f64,
    /// Coordinate on the first rail.
    pub x: f64,
    /// Number of the span of the first rail.
    pub span: usize,
    /// The state.
    pub governing: Governing,
}

impl LimitCheck {
    /// Whether the limit is kept.
    #[must_use]
    pub fn within(&self) -> bool {
        self.value.abs() <= self.limit
    }
}
