//! Rolled steel sections and crane rails by name.
//!
//! The tables hold dimensions alone: HEA, HEB, HEM and IPE of EN 10365, the W shapes of the AISC Manual, and crane rails
//! of DIN 536-1, ASTM A759 and ASCE with what is published about them. Area, second moments, torsion constant and elastic
//! shear areas of the sections are computed from the dimensions ([`SectionDimensions::properties`]). The files of the tables name
//! their sources.
//!
//! Lengths are in millimetres, masses in kilograms; areas in mm2, second moments in mm4. Blanks and case of names do not count.
//!
//! ```
//! let section = sections::rolled("heb400").expect("HEB 400 is in the table");
//! assert_eq!(section.name, "HEB 400");
//! let found = section.dimensions.properties();
//! assert!((found.j / 355.7e4 - 1.0).abs() < 2e-4);
//!
//! let rail = sections::crane_rail("A75").expect("A75 is in the table");
//! assert_eq!((rail.height, rail.mass), (85.0, 56.2));
//! assert_eq!(sections::nearest_rolled("HEB 410")[0], "HEB 400");
//! ```
//!
//! Wings, lowest first: names, table, properties, rolled, composite, rail.

mod composite;
mod names;
mod properties;
mod rail;
mod rolled;
mod table;

pub use composite::PlaneSection;
pub use names::matches;
pub use properties::{RolledProperties, SectionDimensions};
pub use rail::{RailProfile, crane_rail, crane_rails, nearest_crane_rails};
pub use rolled::{RolledSection, SectionSeries, nearest_rolled, rolled, rolled_sections};

/// Density of steel, kg/m3 (EN 1991-1-1, table A.4: 77 to 78.5 kN/m3).
pub const STEEL_DENSITY: f64 = 7850.0;
/// Young's modulus of structural steel, N/m2 (EN 1993-1-1, 3.2.6).
pub const STEEL_YOUNG: f64 = 210e9;
/// Young's modulus of the AISC Manual, N/m2: 29,000 ksi.
pub const AISC_YOUNG: f64 = 29_000.0 * 6.894_757_293_168_361e6;
/// Shear modulus of structural steel, N/m2 (EN 1993-1-1, 3.2.6: approximately).
pub const STEEL_SHEAR: f64 = 81e9;
