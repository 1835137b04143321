//! Quality of a table and of each way to read it: errors, asymmetry, indefiniteness, jumps of slope, and the
//! fewest stations for a tolerance.
//!
//! The functions take a [`Strip`], one coupling block of a compliance, whether an exact surface or a table
//! reading stands behind it. Extremes are searched on a set of places and refined from there by a compass
//! search: they are lower bounds of the true extremes, and no neighbouring place exceeds them.
//!
//! Order: `block` (what is examined), `search` (where, and how extremes are refined), then the measures
//! `deviation`, `reciprocity`, `definiteness`, `slopes` and `table`, and `stations`, which places stations by
//! `deviation`.

mod block;
mod definiteness;
mod deviation;
mod reciprocity;
mod search;
mod slopes;
mod stations;
mod table;

pub use block::{Extreme, Strip, Way};
pub use definiteness::{Layout, Spectrum, indefinite_share, spectrum, station_spectrum, weakest_layouts};
pub use deviation::{Deviation, deviation};
pub use reciprocity::{Work, asymmetry, station_asymmetry, work};
pub use search::places;
pub use slopes::{Kink, diagonal_kinks, kinks, pair_kinks};
pub use stations::{Read, Search, Stations, error_of, stations};
pub use table::{Beyond, Digits, beyond, digits, supports};
