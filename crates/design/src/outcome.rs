//! What the calculation of a design gives.

use practice::clause::CodeClause;
use trains::{CaseEnvelopes, Governing};

use crate::loads::LoadKind;

/// The results of a design.
#[derive(Clone, Debug)]
pub struct DesignResult {
    /// One for each case, in the order of the design.
    pub cases: Vec<SolvedCase>,
    /// Limits of codes against the results.
    pub limits: Vec<LimitCheck>,
    /// Damage-equivalent loads of the wheels of each train.
    pub fatigue: Vec<FatigueLoads>,
    /// What the code has and the design does not give, so that it is left out: name and reason.
    pub left_out: Vec<String>,
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
    /// Number of the span from 1.
    pub span: usize,
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

impl LimitCheck {
    /// Whether the limit is kept.
    #[must_use]
    pub fn within(&self) -> bool {
        self.value.abs() <= self.limit
    }
}
