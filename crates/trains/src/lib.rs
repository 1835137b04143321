//! Wheel trains on a structure: envelopes, extremes and the positions that govern them, exactly.
//!
//! A [`Structure`] is a frame with rails, solved once. Its influence lines are piecewise cubic, so that every response to
//! a [`Train`] at a fixed section is piecewise cubic in the train's position, and its largest value a root of a
//! polynomial; nothing is sampled. [`envelopes`] gives for each [`TrainCase`] the envelopes of internal forces and
//! deflections along the members that carry rails, their extremes over spans, and the extremes of reactions and of forces
//! elsewhere. Limits from either side count: a wheel just before and just behind a section are two states, never their
//! mean.
//!
//! Everything is linear: of first order, or about the state of a preload whose axial forces are in the members of the
//! model. There influence lines, moments and deflections are taken as cubics in parts of members so short that they err by
//! less than 1e-9 ([`Structure::error_of_lines`]), and extremes are enclosed. Units are consistent; the crate knows none.
//!
//! Wings, lowest first: polynomial, error, open_section, train, line, bent, structure, supports, kernel, rail_deflection, joining, pieces, running, plan, promising, hints, dead, section, bounds, instant, overrun, follow, extremes, ordinates, collect, effect, search, blocked, bicubic, several, under_wheels, alone, deflection, analysis
//!
//! 1. `polynomial`: polynomials of low degree and their largest value;
//! 2. `error`, `open_section`, `train`: what can be wrong or too large, and what the caller gives: wheels, trains, cases;
//! 3. `line`, `bent`, `structure`: influence lines as cubics; moments under axial force; the structure that has them; `supports`: the ends of spans in a plane; `kernel`, `rail_deflection`: the
//!    deflection of a rail over a member as polynomials of the place and of the load's position; `joining`: far cells as one;
//! 4. `pieces`, `running`, `plan`, `promising`, `hints`: responses to a train as functions of its position, the best
//!    arrangement of trains, and where it can be;
//! 5. `dead`: dead load;
//! 6. `section`, `bounds`, `instant`, `overrun`, `follow`: responses of a fixed section, along members at one instant, and at
//!    sections beside wheels and at vertices;
//! 7. `extremes`, `ordinates`, `collect`, `effect`: the results, influence lines for reading, which of two states
//!    governs, effects elsewhere;
//! 8. `search`, `blocked`, `bicubic`, `several`, `under_wheels`, `alone`, `deflection`: extremes that are enclosed by
//!    bisection;
//! 9. `analysis`: the calculation.

mod alone;
mod analysis;
mod bent;
mod bicubic;
mod blocked;
mod bounds;
mod collect;
mod dead;
mod deflection;
mod effect;
mod error;
mod extremes;
mod follow;
mod hints;
mod instant;
mod joining;
mod kernel;
mod line;
mod open_section;
mod ordinates;
mod overrun;
mod pieces;
mod plan;
mod polynomial;
mod promising;
mod rail_deflection;
mod running;
mod search;
mod section;
mod several;
mod structure;
mod supports;
mod train;
mod under_wheels;

pub use analysis::envelopes;
pub use dead::DeadLoads;
pub use effect::effects;
pub use error::Error;
pub use extremes::{
    CaseEnvelopes, EnvelopeValue, Governing, Request, SpanDeflection, SpanExtreme, TrainPosition,
};
pub use follow::SectionSide;
pub use instant::{MemberForces, PassedLoads, RailLoad, RailMember};
pub use open_section::{WITHOUT_WARPING, twists_without_warping};
pub use ordinates::InfluenceLine;
pub use structure::{GirderResponse, Structure};
pub use supports::{FIRM_SUPPORT, MIN_SUPPORT, SupportedEnds, supported_ends};
pub use train::{Orientation, Train, TrainCase, TrainWheel};
