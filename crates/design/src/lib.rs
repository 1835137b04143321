//! Static design of girders under wheel trains.
//!
//! [`solve`] computes a checked [`formats::design::Design`]: the envelopes of all cases, the extremes of every span with
//! the positions that govern them, and reactions by load. [`envelope_csv`], [`reactions_csv`] and [`summary`] write
//! the results as files.
//!
//! Wings, lowest first: words, solve_error, loads, outcome, combinations, chords, service, limits, rounding, placed, state_forces, fibres,
//! girder_sections, stresses, wheel_stresses, end_stops, rail_pairs, details, solve, verdict, tables, governing_lines, state_json, detail_rows, summary
//!
//! 1. `words`, `solve_error`: names of quantities, members for clauses; errors with their place in the design's files;
//! 2. `loads`, `outcome`: trains of a case with its factors; what a calculation gives;
//! 3. `combinations`, `limits`: cases and limits of codes; `chords`, `service`: the spans and the load cases of limits;
//! 4. `rounding`: what is only rounding;
//! 5. `placed`, `state_forces`: trains where they stand in a state, and all forces of a section in it;
//! 6. `fibres`, `girder_sections`: sections as stresses need them;
//! 7. `stresses`, `wheel_stresses`, `end_stops`, `rail_pairs`, `details`: what follows from the governing states;
//! 8. `solve`, `verdict` (the table of all checks), `tables`, `governing_lines` (influence lines of the values that govern), `state_json`, `detail_rows`, `summary`: the calculation and its files.

mod chords;
mod combinations;
mod detail_rows;
mod details;
mod end_stops;
mod fibres;
mod girder_sections;
mod governing_lines;
mod limits;
mod loads;
mod outcome;
mod placed;
mod rail_pairs;
mod rounding;
mod service;
mod solve;
mod solve_error;
mod state_forces;
mod state_json;
mod stresses;
mod summary;
mod tables;
mod verdict;
mod wheel_stresses;
mod words;

pub use chords::plane_ends;
pub use combinations::with_combinations;
pub use fibres::{FibreStress, Fibres};
pub use girder_sections::{GirderSections, by_reason};
pub use governing_lines::{
    GoverningLine, LineSubject, WheelOrdinate, governing_lines, governing_reaction, influence_csv,
};
pub use loads::LoadKind;
pub use outcome::{
    DesignResult, EndStopForce, FatigueLoads, LimitCheck, RailPairResponse, ReactionExtremes,
    ReactionName, SolvedCase, StressCheck, WheelCycle, WheelStress,
};
pub use solve::{DesignStructures, solve, solve_on};
pub use summary::{summary, summary_schema};
pub use tables::{envelope_csv, load_word, reactions_csv};
pub use verdict::verdict;
pub use words::{clause_json, plane_word, quantity_word, side_word};
