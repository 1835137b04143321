//! Scenes in motion: wheels, contact, bodies and what carries their rails.
//!
//! Knows no section, material, unit or file: a structure is a [`splines::Compliance`] and, where its mass
//! counts, degrees of freedom of its own ([`Foundation`]).
//!
//! # Wings
//! Folders are wings; a file of a lower wing imports nothing of a higher one, and no files import each other in a
//! circle. From the bottom to the top:
//! 1. `numerics`: dense systems, complementarity, roots, the STEP function;
//! 2. `scene`: what the caller says;
//! 3. `mechanics`: the numbered degrees of freedom, kinematics, mass;
//! 4. `contact`: where contacts are, their compliance, their forces: one stage;
//! 5. `record`: channels, histories, energy;
//! 6. `instant`: one instant solved: equilibrium, active contacts, natural modes;
//! 7. `time`: from instant to instant: steppers, collocation, power series, events;
//! 8. `run`: one scene from start to end;
//! 9. `select`: the lowest fidelity that suffices.

mod contact;
mod instant;
mod mechanics;
mod numerics;
mod record;
mod run;
mod scene;
mod select;
mod time;

pub use instant::contact_forces::{ContactForces, Instant, contact_forces};
pub use instant::natural::{NaturalMode, natural_modes};
pub use numerics::step::step;
pub use record::energy::{Audit, Exchanged, Stored};
pub use record::history::History;
pub use run::{Run, Status, run, run_by};
pub use scene::actuators::{Actuators, Brake, Drive, Load, Turn};
pub use scene::body::{Body, Contact, Pin};
pub use scene::carrier::{Axle, Mount};
pub use scene::channel::Channel;
pub use scene::dof::Freedom;
pub use scene::error::Error;
pub use scene::foundation::{Extent, Foundation};
pub use scene::irregularity::{Irregularity, Wave};
pub use scene::method::{Method, Stepping};
pub use scene::model::{Analysis, Gauge, Scene};
pub use scene::parts::{BlendedParts, PartChain, PartShapes};
pub use scene::profile::{Given, Moving, Profile};
pub use scene::rope::{Rope, RopeEnd, Stop};
pub use scene::rule::{Action, Compare, Condition, Fired, Rule};
pub use scene::schedule::Schedule;
pub use scene::structure::{Dynamics, Shapes, Structure};
pub use scene::wheel::{Damper, Flange, Friction, FrictionLaw, NormalLaw, Wheel};
pub use select::choose::choose;
pub use select::distance::distance;
pub use select::fidelity::{Choice, Ladder, Reason, STEPPING, Selection, Tried};
pub use select::predict::Predicted;
pub use select::rung::Rung;
pub use time::counts::Counts;
