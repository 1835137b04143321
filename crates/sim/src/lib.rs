//! Scenes in motion: wheels, contact, bodies and what carries their rails.
//!
//! A [`Scene`] says which bodies move, on which wheels, along which rails. A [`Foundation`] carries the rails: rigid,
//! by a compliance, or with mass. [`run()`] brings the scene from its start to its end and returns a [`Run`] with the
//! [`History`] of every channel and an energy [`Audit`]. [`choose`] finds the simplest foundation that suffices.
//!
//! The crate knows no section, material, unit or file. All quantities are in one consistent system of units, for
//! example m, kg, s, N; x runs along the rail, y up, z to the right.
//!
//! # Example
//! A bogie of 20 t on two wheels crosses a girder of 20 m span at 2 m/s.
//! ```
//! use std::{ops::ControlFlow, sync::Arc};
//! use sim::{Body, Channel, Contact, Damper, Foundation, BodyDof, MotionKind, NormalLaw, Profile, Scene, Wheel};
//! use splines::{RailElement, Flexibility, Rails, ExactSurface};
//!
//! // The girder: one rail element on two supports, EI = 1e9 N m^2, loaded by moments at its ends for the nodal part.
//! let (span, bending) = (20.0, 1e9);
//! let cell = RailElement {
//!     rail: 0, x: [0.0, span], ends: [0, 1], length: span, offset: [0.0; 3], member: None,
//!     frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
//!     flexibility: Flexibility { bending_z: 1.0 / bending, ..Flexibility::default() },
//! };
//! let mut ends = nalgebra::DMatrix::zeros(12, 12);
//! for (i, j, share) in [(5, 5, 3.0), (11, 11, 3.0), (5, 11, -6.0), (11, 5, -6.0)] {
//!     ends[(i, j)] = span / (share * bending);
//! }
//! let girder = ExactSurface::new(Arc::new(Rails::new(vec![cell])?), ends)?;
//!
//! let motion = Some(Profile::new(MotionKind::Speed, &[[0.0, 2.0]], 2.0, 0.0)?);
//! let scene = Scene {
//!     bodies: vec![Body { motion, ..Body::new(20e3, [0.0, 0.0, 40e3]) }],
//!     wheels: vec![Wheel::new(0.4, NormalLaw::linear(1e9, 1e6, Damper::Rail))],
//!     contacts: [-1.0, 1.0].map(|x| Contact::new(0, [x, 0.0, 0.0])).to_vec(),
//!     end: 8.0,
//!     ..Scene::default()
//! };
//! let run = sim::run(&scene, &[Foundation::massless(Box::new(girder), 1)], &mut |_| ControlFlow::Continue(()))?;
//! assert!(run.status.is_complete());
//! let lowest = run.history.values(Channel::Displacement(0, BodyDof::Y)).fold(0.0, f64::min);
//! // About P L^3/(48 EI) where the bogie is at mid-span.
//! assert!((-lowest / 32.7e-3 - 1.0).abs() < 0.05);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Wings
//! Folders are wings; a file of a lower wing imports nothing of a higher one, and no files import each other in a
//! circle.
//!
//! Wings, lowest first: numerics, scene, mechanics, contact, record, instant, time, run, select
//!
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

pub use contact::energy::{Exchanged, Stored};
pub use instant::contact_forces::{ContactForces, Instant, contact_forces};
pub use instant::natural::{NaturalMode, natural_modes};
pub use numerics::step::step;
pub use piecewise::Side;
pub use record::energy::{Audit, EnergyGap, EnergyGaps, GapCause};
pub use record::history::History;
pub use record::solution::{NodeInterval, Solution, SolutionNodes, TimeExtreme};
pub use run::{Run, Status, check_equilibrium, equilibria, run, run_by};
pub use scene::actuators::{Actuators, Brake, Drive, Load, PrescribedSpin};
pub use scene::body::{Body, Contact, Pin};
pub use scene::carrier::{CarriedRail, Carrier};
pub use scene::channel::Channel;
pub use scene::dof::BodyDof;
pub use scene::error::{Error, Fall};
pub use scene::foundation::{Extent, Foundation};
pub use scene::irregularity::{Irregularity, Wave};
pub use scene::method::{Method, Stepping};
pub use scene::model::{Analysis, Gauge, Scene};
pub use scene::parts::{BlendedParts, PartChain, PartShapes};
pub use scene::profile::{MotionKind, Profile, Travel};
pub use scene::rope::{Rope, RopeEnd, Stop};
pub use scene::rule::{Action, Compare, Condition, Fired, Rule};
pub use scene::schedule::Schedule;
pub use scene::structure::{Dynamics, Shapes, Structure};
pub use scene::wheel::{Damper, Flange, Friction, FrictionLaw, LawValue, NormalLaw, Wheel};
pub use select::choose::choose;
pub use select::fidelity::Fidelity;
pub use select::measure::{Bounces, Difference, Measure, Record, RecordedQuantity, difference};
pub use select::replay::ModalBasis;
pub use select::selection::{
    Choice, FidelityTrial, FoundationProvider, Reason, Selection, Tolerance, TrialCheck,
};
pub use time::outcome::{Counts, FirstImpact, StruckBy};
