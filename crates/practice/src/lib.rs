//! Values that crane engineers compare with a simulation: code values, fatigue damage, characteristics of
//! signals.
//!
//! The crate works on plain numbers. It reads no files and does not depend on scenes or other crates of this
//! workspace. Formulas without dimensional constants take any consistent units; the others require the units that
//! they state, SI unless stated otherwise.
//!
//! Where a comment says *not confirmed*, the value is from memory: it could not be compared with the text of
//! its standard, or with a source that quotes or uses it. `docs/theory/practice.md` has the list.
//!
//! The wheel loads of a maintenance crane and the side thrust by AIST TR-13, in kN and m:
//!
//! ```
//! use practice::Crane;
//! use practice::aist::{CraneKind, side_thrust, with_impact};
//!
//! let crane = Crane {
//!     lifted: 200.0,
//!     trolley: 40.0,
//!     bridge: 190.0,
//!     span: 23.0,
//!     approach: 1.2,
//!     wheels: 2,
//! };
//! let wheel = crane.wheel_loads(1.0, 1.0)?;
//! assert!((wheel.near - 161.239).abs() < 5e-4);
//! assert!((with_impact(CraneKind::MotorRoom, wheel.near)? - 193.487).abs() < 5e-4);
//! assert!((side_thrust(CraneKind::MotorRoom, &crane)?.governing() - 60.0).abs() < 1e-12);
//! # Ok::<(), practice::Error>(())
//! ```
//!
//! # Order of the wings
//!
//! Wings, lowest first: error, codes, fatigue, signals
//!
//! A file imports from its own wing and from those before it. The last three wings do not import each other.
//!
//! 1. `error`: numbers that a formula does not accept.
//! 2. `codes`: values of EN 1991-3, EN 1993-6, CMAA 70, AIST TR-13, AISC, ASCE 7, IS 800, OSHA and FEM.
//! 3. `fatigue`: stress at a point, rainflow cycles, strength curves and damage.
//! 4. `signals`: means, filters, frequencies, damping, envelopes.

pub mod error;

mod codes;

pub mod fatigue;

mod signals;

pub use codes::{
    aist, asce, buffer, clause, cmaa, combination, crane, drive, duty, factor, limit_choice,
    limits, local_stress, mill_combination, osha, scope, skew,
};
pub use crane::{Crane, StaticWheelLoads};
pub use error::{Argument, Error};
pub use fatigue::{
    Cycle, Damage, Repetition, SectionPoint, SectionProperties, Strength, aisc, rainflow, stress,
};
pub use signals::{
    Decay, Excursions, ExtremeInstant, Extremes, HistorySpectrum, ResponseCharacteristics,
    ResponseSettings, RunHistories, SineComponent, TimedValue, decay, envelope, excursions,
    low_pass, mean, resample, response,
};
