//! Accuracy against cost: a scene on a ladder of settings, beside a converged reference.

mod budget;
pub mod cpu;
mod data;
mod deviation;
mod error;
mod front;
mod investigate;
mod ladder;
mod memory;
mod observer;
mod picture;
mod point;
mod quantity;
mod reference;
mod setting;
mod setup;
mod spread;
pub mod stability;
pub mod stations;
pub mod table_quality;

pub use budget::StudyBudget;
pub use data::{csv, excesses, json, stages, timing_csv, timing_json};
pub use deviation::{ComparedColumns, Deviation, deviations};
pub use error::Error;
pub use front::{excess, front, on_front};
pub use investigate::{Auto, Study, study};
pub use memory::Memory;
pub use observer::{Observer, Silent, Steps};
pub use picture::{StudyPicture, pictures};
pub use point::{MeasuredPoint, PointOutcome, StudyPoint};
pub use quantity::ErrorGroup;
pub use reference::{ConvergedReference, MARGIN};
pub use setting::{Against, Setting, SettingFamily};
pub use spread::Spread;
