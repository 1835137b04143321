//! Quality of a table and of each way to read it: errors, asymmetry, indefiniteness, jumps of slope, and the
//! fewest stations for a tolerance.
//!
//! The functions take a [`CouplingBlock`], one coupling block of a compliance, whether an exact surface or a table
//! reading stands behind it. Extremes are searched on a set of places and refined from there by a compass
//! search: they are lower bounds of the true extremes, and no neighbouring place exceeds them.
//!
//! Order: `block` (what is examined), `search` (where, and how extremes are refined), then the measures
//! `reading_error`, `reciprocity`, `definiteness`, `slopes` and `table`, and `fewest_stations`, which places stations by
//! `reading_error`.

mod block;
mod definiteness;
mod deviation;
mod reciprocity;
mod search;
mod slopes;
mod stations;
mod table;

pub use block::{BlockExtreme, CouplingBlock, RailDirection};
pub use definiteness::{
    Spectrum, WheelLayout, indefinite_fraction, spectrum, station_spectrum, weakest_layouts,
};
pub use deviation::{ReadingError, reading_error};
pub use reciprocity::{LoopWork, asymmetry, loop_work, station_asymmetry};
pub use search::sample_places;
pub use slopes::{SlopeJump, diagonal_slope_jumps, pair_slope_jumps, slope_jumps};
pub use stations::{MakeReading, StationSearch, StationSet, fewest_stations, station_error};
pub use table::{
    ExtrapolatedRow, TablePrecision, extrapolated_rows, support_stations, table_precision,
};
