//! What a table, and each reading of it, will cost: numbers with the places where they were found.
//!
//! The functions take a [`Strip`], one block of a structure's give, whatever stands behind it: an exact
//! surface or a reading of a table. Extremes are searched on a set of places and refined from there by
//! [`climb()`]: they are lower bounds of the true ones that no neighbour exceeds.

mod beyond;
mod climb;
mod definite;
mod deviation;
mod digits;
mod kink;
mod layout;
mod places;
mod strip;
mod symmetry;
mod work;

pub use beyond::{Beyond, beyond};
pub use climb::climb;
pub use definite::{Spectrum, spectrum, station_spectrum};
pub use deviation::{Deviation, deviation};
pub use digits::{Digits, digits};
pub use kink::{Kink, diagonal_kinks, kinks, pair_kinks};
pub use layout::{Layout, indefinite_share, weakest_layouts};
pub use places::{places, restricted, supports};
pub use strip::{Strip, Way};
pub use symmetry::{asymmetry, station_asymmetry};
pub use work::{Work, work};

/// A number and the place of a surface where it was found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extreme {
    /// The number.
    pub value: f64,
    /// Where the load stands.
    pub x: f64,
    /// Where the deflection is taken.
    pub z: f64,
}
