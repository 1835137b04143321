//! Foundations of a simulation, built from FE solutions: the transfer of data that the paper did by hand.
//!
//! A spec is solved once ([`solve`]). Each foundation of a scene is then built from that solution ([`build`]): rigid,
//! rigid parts, influence functions, natural modes with the residual flexibility of the omitted modes, or all modes
//! of a mesh. For structures whose foundation is "auto", [`select_and_run`] finds the lowest fidelity within the
//! tolerance.
//!
//! ```
//! use formats::text::source::Source;
//! use formats::spec::Spec;
//! use splines::{Axis, Compliance, Influence, Probe};
//!
//! let text = r#"{"format": "girderway-beam/1", "name": "girder",
//!     "units": {"length": "m", "force": "kN", "time": "s"}, "theory": "euler-bernoulli",
//!     "girder": {"spans": [10], "E": 210e6, "I_vertical": 5.768e-4}, "stations": [0, 5, 10]}"#;
//! let spec = Spec::read(&Source::from_bytes("girder.json", text.into()).expect("UTF-8"), None).expect("a spec");
//! let solution = foundations::solve(&spec).expect("a girder that stands");
//!
//! // Deflection at midspan under 1 kN there: L^3/(48 E I).
//! let midspan = Probe { rail: 0, x: 5.0, axis: Axis::Vertical };
//! let mut influence = Influence::zeros(1);
//! solution.surface.expect("a small girder").fill(&[midspan], &mut influence).expect("a place on the rail");
//! let expected = 1000.0 / (48.0 * 210e6 * 5.768e-4);
//! assert!((influence.value[(0, 0)] - expected).abs() < 1e-12 * expected);
//! ```
//!
//! Wings, lowest first: error, mount, mesh_modes, solved, influence, tables, built, modal, parts, build, wheels_at_rest, check, select

mod build;
mod built;
mod check;
mod error;
mod influence;
mod mesh_modes;
mod modal;
mod mount;
mod parts;
mod select;
mod solved;
mod tables;
mod wheels_at_rest;

pub use build::{build, full_mesh_foundation, rigid_parts_foundation};
pub use built::{BuiltFoundation, MotionBasis, RigidParts};
pub use check::check_scene;
pub use error::Error;
pub use mesh_modes::ComputedModes;
pub use modal::ModeCache;
pub use mount::mount;
pub use parts::roll_inertia;
pub use select::{
    AutoRun, TrialObserver, check_name, fidelity_name, select_and_run, selection_doubt,
    selection_reason,
};
pub use solved::{
    RailChords, SolvedModel, SolvedStructure, StructureCache, SystemSize, distinct_specs,
    solution_of, solve, solve_for_file, solve_specs,
};
pub use tables::influence_blocks;
pub use wheels_at_rest::with_wheels_at_rest;
