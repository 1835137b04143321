//! Frames in space, and their influence functions along rails.
//!
//! A [`Model`] (or the short form [`Girder`]) and its [`Rail`]s become a [`Frame`], which answers with
//! a [`Grid`] of chosen places, the exact [`Exact::surface`] of whole rails, compliance of points and
//! reactions. Statics of small displacements; members are uniform and exact.

mod assembly;
pub mod certificate;
pub mod effect;
mod element;
pub mod error;
mod factor;
pub mod frame;
mod freedoms;
pub mod girder;
pub mod grid;
mod inertia;
mod inertial;
mod lanczos;
mod mass;
mod mechanism;
pub mod memory;
pub mod model;
pub mod modes;
mod order;
pub mod rail;
pub mod reaction;
mod real;
pub mod refine;
mod rounding;
pub mod section;
mod solver;
pub mod surface;
pub mod taper;
mod triplets;

pub use certificate::Certificate;
pub use effect::Effect;
pub use error::{Error, Fault, Item, Quantity};
pub use frame::{ACCURACY, Frame};
pub use girder::Girder;
pub use grid::{Grid, grid};
pub use inertial::Inertial;
pub use mass::rigid_mass;
pub use memory::MEMORY;
pub use model::{Freedom, Freedoms6, Kind, Link, Mass, Member, Model, Spring, Support};
pub use modes::{Mode, Modes, modes};
pub use rail::{Rail, Segment};
pub use reaction::{Hold, Reactions, reactions};
pub use refine::{Refined, full_modes, refined_modes};
pub use section::{Section, Theory};
pub use splines::Component;
pub use surface::{Exact, nodal, surface};
pub use taper::Taper;
