//! Scenes in motion: wheels, contact, bodies and what carries their rails.
//!
//! Knows no section, material, unit or file: a structure is a [`splines::Compliance`] and, where its mass
//! counts, freedoms of its own ([`Foundation`]).

mod actuator;
mod collocation;
mod complementarity;
mod crossing;
mod dense;
mod energy;
mod equilibrium;
mod error;
mod events;
mod forces;
mod foundation;
mod geometry;
mod hang;
mod history;
mod instant;
mod irregularity;
mod kinematics;
mod link;
mod matter;
mod method;
mod mount;
mod nodes;
mod parts;
mod point;
mod profile;
mod propagator;
mod ride;
mod rope;
mod run;
mod scene;
mod schedule;
mod selector;
mod settle;
mod solver;
mod spot;
mod state;
mod step;
mod stepper;
mod system;
mod tableau;
mod tie;
mod wheel;

pub use actuator::{Actuators, Brake, Drive, Load};
pub use energy::{Audit, Exchanged, Stored};
pub use error::Error;
pub use foundation::{Dynamics, Extent, Foundation, Shapes, Structure};
pub use history::{Channel, History};
pub use instant::{ContactForces, Instant, contact_forces};
pub use irregularity::{Irregularity, Wave};
pub use method::{Method, Stepping};
pub use mount::{Axle, Mount};
pub use parts::{BlendedParts, PartChain, PartShapes};
pub use profile::{Given, Moving, Profile};
pub use rope::{Rope, RopeEnd, Stop};
pub use run::{Run, Status, run, run_by};
pub use scene::{Analysis, Body, Contact, Freedom, Gauge, Pin, Scene};
pub use schedule::Schedule;
pub use selector::{Choice, Ladder, Predicted, Reason, Rung, Selection, Tried, choose, distance};
pub use step::step;
pub use stepper::Counts;
pub use wheel::{Damper, Flange, Friction, FrictionLaw, NormalLaw, Wheel};
