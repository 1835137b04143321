//! Static design of girders under wheel trains.
//!
//! [`solve`] computes a checked [`formats::design::Design`]: the envelopes of all cases, the extremes of every span with
//! the positions that govern them, and reactions by load. [`envelope_csv`], [`reactions_csv`] and [`summary`] write
//! the results as files.
//!
//! Files, lowest first: `words` (names of quantities, members for clauses), `error`, `loads` (trains of a case with its
//! factors), `outcome` (what a calculation gives), `combinations` (cases of codes), `limits` (limits of codes), `rounding`
//! (what is only rounding), `placed` (trains where they stand), `state_forces` (all forces of a section in a state), `fibres`
//! and `girder_sections` (sections as stresses need them), `stresses`, `wheel_stresses`, `end_stops`, `rail_pairs`, `details` (what
//! follows from the governing states), `solve`, `tables`, `state_json`, `detail_rows`,
//! `summary`.

mod combinations;
mod detail_rows;
mod details;
mod end_stops;
mod error;
mod fibres;
mod girder_sections;
mod limits;
mod loads;
mod outcome;
mod placed;
mod rail_pairs;
mod rounding;
mod solve;
mod state_forces;
mod state_json;
mod stresses;
mod summary;
mod tables;
mod wheel_stresses;
mod words;

pub use combinations::with_combinations;
pub use error::DesignError;
pub use loads::LoadKind;
pub use outcome::{
    DesignResult, EndStopForce, FatigueLoads, LimitCheck, RailPairResponse, ReactionExtremes, ReactionName,
    SolvedCase, StressCheck, WheelCycle, WheelStress,
};
pub use solve::solve;
pub use summary::summary;
pub use tables::{envelope_csv, load_word, reactions_csv};
pub use words::{clause_json, plane_word, quantity_word, side_word};
