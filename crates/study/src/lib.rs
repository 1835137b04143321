//! Accuracy against cost: a scene on a ladder of settings, beside a converged reference.

pub mod appraisal;
pub mod cpu;
mod data;
mod depth;
mod error;
mod front;
mod investigate;
mod ladder;
mod memory;
mod misfit;
mod observer;
mod picture;
mod point;
mod quantity;
mod reference;
mod rig;
mod setting;
mod spread;
pub mod stability;
pub mod stations;

pub use data::{csv, excesses, json, stages, timing_csv, timing_json};
pub use depth::Depth;
pub use error::Error;
pub use front::{excess, front, on_front};
pub use investigate::{Auto, Study, study};
pub use memory::Memory;
pub use misfit::{Misfit, Trace, misfits};
pub use observer::{Observer, Silent, Steps};
pub use picture::{Picture, pictures};
pub use point::{Measured, Outcome, Point};
pub use quantity::Quantity;
pub use reference::{MARGIN, Reference};
pub use setting::{Against, Family, Setting};
pub use spread::Spread;
