//! The structure as the caller describes it: plain values that own their data.
//!
//! A [`Model`] is points, cross sections, members, supports, springs, links and masses; a [`Rail`] is a
//! straight coordinate over some of its members; a [`Girder`] is the short form of a continuous beam with
//! one rail. [`Taper`]s replace members by uniform parts. Nothing here numbers an unknown or forms a
//! stiffness: what needs no geometry is checked by [`Model::check`], the rest when the frame is assembled.
//!
//! Order of the files: `section`, `structure`, `rail`, `cut`, then `taper` and `girder`.

mod cut;
mod girder;
mod rail;
mod section;
mod structure;
mod taper;

pub(crate) use cut::{cut_at, cut_members, equal_cuts, flexible_ends};
pub use girder::Girder;
pub use rail::{Rail, RailSegment};
pub use section::{BeamTheory, CrossSection};
pub use structure::{
    ArmStiffness, GroundSpring, Member, MemberKind, Model, PointMass, RigidLink, Support,
};
pub use taper::Taper;
