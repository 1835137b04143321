//! Scenes: reading, checking and resolution of names, in the units of the scene.
//!
//! The modules from low to high are `raw` (a scene as written), `values` (the content of a checked scene),
//! [`columns`], [`motion`] and [`quantity`] (results derived from the values), `read` (conversion of the raw scene to
//! the values) and `document` (a file with its comparisons).

pub mod columns;
mod document;
pub mod motion;
pub mod quantity;
mod raw;
mod read;
mod values;

pub(crate) use raw::{RawCodes, RawColumns, RawNode, RawPick, RawScene};

pub use document::{Case, Document, SceneSource};
pub use values::actuator::{Event, Load, Rope, Spin, Stop, StopPoint};
pub use values::body::{Body, BodyMotion, DOFS, Drive};
pub use values::output::{ColumnSelection, Fatigue, Output};
pub use values::practice::Practice;
pub use values::scene::{
    Analysis, FORMAT, Scene, SceneRail, end_stops, mean_lateral_position, root_body, stepper_word,
};
pub use values::structure::{
    CarriedBy, DEFAULT_PARTS, Foundation, Gauge, Handover, Origin, Structure, TOLERANCE,
    TableInterpolation, TablePair,
};
pub use values::truck::{Node, Truck};
pub use values::wheel::{
    DEFAULT_IMPACT_EXPONENT, DamperVelocity, FlangeContact, Friction, FrictionLaw, NormalForceLaw,
    TreadContact, WheelKind,
};

pub use crate::text::names::{names, resolve};
