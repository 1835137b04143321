//! Accuracy against cost: a scene on a ladder of settings, beside a converged reference.
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
pub use measure::front::{excess, front, on_front};
pub use measure::memory::Memory;
pub use measure::quantity::ErrorGroup;
pub use measure::spread::Spread;
pub use observer::{Observer, Silent, Steps};
pub use runs::investigate::{Auto, Study, study};
pub use runs::point::{MeasuredPoint, PointOutcome, StudyPoint};
pub use runs::reference::{ConvergedReference, MARGIN};
pub use settings::budget::StudyBudget;
pub use settings::setting::{Against, Setting, SettingFamily};
pub use show::data::{csv, excesses, json, stages, timing_csv, timing_json};
pub use show::picture::{StudyPicture, pictures};
