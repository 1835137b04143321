//! Accuracy against cost: a scene is run in many settings, and the errors of all are measured against converged
//! references.
//!
//! In addition to studies ([`study()`]), the crate evaluates the quality of influence tables ([`table_quality`]),
//! chooses the fewest stations of a table ([`stations`]), and maps where methods fail ([`stability`]).
//!
//! # Example
//! A Pareto front of measured points (cost, error):
//! ```
//! use study::{TimeSpread, StudyBudget, cost_ratio, front, on_front};
//!
//! let budget = StudyBudget::quick();
//! assert!(budget.accuracies.windows(2).all(|pair| pair[0] > pair[1]), "coarsest first");
//!
//! // median times of three settings, s, and their largest relative errors
//! let time = |runs: &[f64]| TimeSpread::of(runs).map_or(f64::NAN, |spread| spread.median);
//! let points = [[time(&[1.0, 1.1, 1.3]), 1e-1], [time(&[2.0, 2.0]), 1e-3], [time(&[4.0]), 1e-2]];
//! assert_eq!(on_front(&points), [true, true, false]);
//! assert_eq!(front(&points), [[1.1, 1e-1], [2.0, 1e-3]]);
//! assert_eq!(cost_ratio(points[2], &points), 2.0, "twice as expensive as a more accurate setting");
//! ```
//!
//! Wings, lowest first: error, observer, measure, table_quality, stations, stability, settings, runs, show

mod error;
pub mod measure;
mod observer;
mod runs;
mod settings;
mod show;
pub mod stability;
pub mod stations;
pub mod table_quality;

pub use error::Error;
pub use measure::deviation::{ComparedColumns, Deviation, deviations};
pub use measure::front::{cost_ratio, front, on_front};
pub use measure::memory::Memory;
pub use measure::quantity::ErrorGroup;
pub use measure::spread::TimeSpread;
pub use observer::{Observer, SilentObserver, Steps};
pub use runs::auto::Auto;
pub use runs::investigate::{Study, study};
pub use runs::point::{MeasuredPoint, PointOutcome, StudyPoint};
pub use runs::reference::{ConvergedReference, RESOLUTION_FACTOR};
pub use settings::budget::StudyBudget;
pub use settings::setting::{ReferenceKind, Setting, SettingFamily};
pub use show::data::{cost_ratios, csv, json, stages, timing_csv, timing_json};
pub use show::figure::{StudyFigure, figures};
