//! One case of a scene, run: what came of it.

use formats::motion::Cast;
use sim::Run;

use crate::codes::CodeCheck;
use crate::fatigue::FatigueResult;
use crate::record::NamedColumns;
use crate::response::{ColumnInfluence, Response};

/// One case, run.
pub struct CaseResult {
    /// Its label; the scene's own run is named by its foundations.
    pub label: String,
    /// What was simulated.
    pub input: Cast,
    /// How it went.
    pub run: Run,
    /// Its named columns.
    pub columns: NamedColumns,
    /// Why foundations that were "auto" are what they are.
    pub choices: Vec<sim::Choice>,
    /// Influence lines of the columns that structures answer in, one a structure.
    pub lines: Vec<Option<ColumnInfluence>>,
    /// What the structures answered.
    pub response: Response,
    /// The run beside codes, where the scene asks for that.
    pub codes: Option<CodeCheck>,
    /// Damage at the points whose stresses it has.
    pub fatigue: Vec<FatigueResult>,
}
