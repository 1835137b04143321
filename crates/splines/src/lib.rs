//! Functions along a rail: how far it deflects at one place under a force at another.
//!
//! The central object is a [`Compliance`]: influence coefficients G(p, q) between any [`Probe`]s, with their
//! slopes. A [`ExactSurface`] gives them exactly from rail elements and the compliance of their node states; a
//! [`TableReading`] or a [`FactoredTable`] table interpolates tables of values, as ADAMS does or better; [`quality`]
//! measures what a reading of a table costs. Displacements and forces are positive along +x, up and +z of the
//! rail; units are those of the caller.
//!
//! ```
//! use nalgebra::DMatrix;
//! use splines::{Axis, Compliance, Influence, ReadingMethod, Probe, TableReading, InfluenceBlock, SplineTable, fit_beam};
//!
//! // Deflections of a simply supported beam of length 4 with 1/EI = 1, tabulated at five stations.
//! let x: Vec<f64> = (0..5).map(f64::from).collect();
//! let exact = |z: f64, x: f64| {
//!     let (a, b) = (z.min(x), 4.0 - z.max(x));
//!     a * b * (16.0 - a * a - b * b) / 24.0
//! };
//! let table = SplineTable::new(x.clone(), x.clone(), DMatrix::from_fn(5, 5, |i, j| exact(x[i], x[j])))?;
//!
//! // Two wheels between the stations, read as ADAMS would, and exactly by fitting the beam behind the table.
//! let wheels = [1.3, 1.8].map(|x| Probe { rail: 0, x, axis: Axis::Vertical });
//! let vertical = (0, Axis::Vertical);
//! let block = InfluenceBlock { deflection: vertical, load: vertical, table: table.clone() };
//! let (mut adams, mut beam) = (Influence::zeros(2), Influence::zeros(2));
//! TableReading::new(ReadingMethod::Akispl, &[block])?.fill(&wheels, &mut adams)?;
//! fit_beam(0, &table)?.surface.fill(&wheels, &mut beam)?;
//! assert!((beam.value[(0, 1)] - exact(1.3, 1.8)).abs() < 1e-13);
//! assert!((adams.value[(0, 1)] - exact(1.3, 1.8)).abs() > 1e-2);
//! assert_eq!(beam.value[(0, 1)], beam.value[(1, 0)]);
//! # Ok::<(), splines::Error>(())
//! ```
//!
//! This is the bottom of the workspace: it reads no file, knows no unit, and depends on no other crate of
//! ours.
//!
//! # Wings
//! Wings, lowest first: vector, probe, error, compliance, curve, rail, surface, table, quality
//!
//! A file imports nothing of a later wing.
//! 1. `vector`, `probe`, `error`, `compliance`: products of small vectors, places, errors, and the interface
//!    of every compliance.
//! 2. `curve`: piecewise cubics in one variable.
//! 3. `rail`: rail elements, their shape functions and Green's function, rails.
//! 4. `surface`: exact compliance and what follows from it: influence lines, residual flexibility, uncoupled
//!    rails.
//! 5. `table`: tables of values, their readings, the beam behind a table.
//! 6. [`quality`]: errors of readings, their asymmetry and indefiniteness, the fewest stations.

mod compliance;
mod curve;
mod error;
mod probe;
pub mod quality;
mod rail;
mod surface;
mod table;
mod vector;

pub use compliance::{
    Compliance, Differentiable, GroupMember, Influence, KeptProducts, Partials, PlaceDisplacements,
    ProbeGroups,
};
pub use curve::{CurveValue, PiecewiseCubic, akima, natural_spline};
pub use error::Error;
pub use probe::{Axis, Probe};
pub use quality::{StationSearch, StationSet, fewest_stations};
pub use rail::{
    BeamColumn, ElementFunctions, ElementMember, Flexibility, MemberMotion, RailElement, Rails,
    RoundingSizes, ShapeRow, lowered,
};
pub use surface::{
    Couplings, DisplacementLines, ElementResidual, ExactSurface, ForceComponent, InfluenceLines,
    InternalForce, RailShapes, ResidualFlexibility, Uncoupled,
};
pub use table::{
    BeamFit, FactorCurves, FactoredTable, InfluenceBlock, Rank, ReadingMethod, SplineTable,
    TableFactor, TableReading, fit_beam,
};
pub use vector::RealNumber;
