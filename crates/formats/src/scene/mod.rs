//! Scenes: read, checked, names resolved, in the scene's units.
//!
//! Wings, lowest first: `raw` (a scene as written), `values` (what a checked scene holds), [`columns`], [`motion`] and
//! [`quantity`] (what follows from the values), `read` (from what is written to the values), `document` (a file with
//! its comparisons).

pub mod columns;
mod document;
pub mod motion;
pub mod quantity;
mod raw;
mod read;
mod values;

pub(crate) use raw::{RawColumns, RawNode, RawPick, RawScene};

pub use document::{Case, Document};
pub use values::actuator::{Event, Load, Meeting, Rope, Spin, Stop};
pub use values::body::{Along, Body, Drive, FREEDOMS};
pub use values::output::{Fatigue, Output, Pick};
pub use values::practice::Practice;
pub use values::scene::{Analysis, FORMAT, Scene, SceneRail, across, end_stops, seat, stepper_word};
pub use values::structure::{
    Foundation, Gauge, Handover, On, Origin, PARTS, Reading, Structure, TOLERANCE, TablePair,
};
pub use values::truck::{Node, Truck};
pub use values::wheel::{Damper, Friction, FrictionLaw, IMPACT_EXPONENT, Lateral, Law, Vertical, Wheel};

pub use crate::text::names::{names, resolve};
