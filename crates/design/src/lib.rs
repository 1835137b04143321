//! Static design of girders under wheel trains.
//!
//! [`solve`] computes a checked [`formats::design::Design`]: the envelopes of all cases, the extremes of every span with
//! the positions that govern them, and reactions by load. [`envelope_csv`], [`reactions_csv`] and [`summary`] write
//! the results as files.
//!
//! Files, lowest first: `words` (names of quantities, members for clauses), `error`, `loads` (trains of a case with its
//! factors), `outcome` (what a calculation gives), `combinations` (cases of codes), `limits` (limits of codes), `rounding`
//! (what is only rounding), `solve`, `tables`, `governing_lines` (influence lines of the values that govern), `summary`.

mod combinations;
mod error;
mod governing_lines;
mod limits;
mod loads;
mod outcome;
mod rounding;
mod solve;
mod summary;
mod tables;
mod words;

pub use combinations::with_combinations;
pub use error::DesignError;
pub use governing_lines::{
    GoverningLine, LineSubject, WheelOrdinate, governing_lines, governing_reaction, influence_csv,
};
pub use loads::LoadKind;
pub use outcome::{DesignResult, FatigueLoads, LimitCheck, ReactionExtremes, ReactionName, SolvedCase};
pub use solve::solve;
pub use summary::summary;
pub use tables::{envelope_csv, load_word, reactions_csv};
pub use words::{clause_json, plane_word, quantity_word, side_word};
