//! Beam specs: reading, checking, and conversion to the requested units.
//!
//! The modules from low to high are the content of the file (`raw`, with the items of `block`); its references and
//! arrays (`references`, `column`); its parts (`rolled` sections by name, `sections` with `shape` and [`cross_section`],
//! `tapers`, `members`, `rails`, `crane_rail`, `stress`, `outline`, `cuts`, `girder_section`, `girder`, `notes`, `incomplete`); the checked [`Spec`] (`structure`); the readers of the general form
//! (`frame`), of the `preload`, and of specs (`read`); files of sections alone (`section_file`); and results derived from a spec: names of supported points
//! (`grounds`), spans of rails (`spans`), the state of a preload (`loaded`), places of solver errors (`locate`), values that are probably wrong (`plausibility`) and rails on ties ([`ties`]).

mod block;
mod column;
mod crane_rail;
pub mod cross_section;
mod cuts;
mod frame;
mod girder;
mod girder_section;
mod grounds;
mod incomplete;
mod loaded;
mod locate;
mod members;
mod notes;
mod outline;
mod plausibility;
mod preload;
mod rails;
mod raw;
mod read;
mod references;
mod rolled;
mod section_file;
mod sections;
mod shape;
mod spans;
mod stress;
mod structure;
mod tapers;
#[cfg(test)]
mod tests;
pub mod ties;
mod words;

pub(crate) use block::{Block, Reference};
pub use cuts::{Cut, CutPlace};
pub use grounds::SupportedPoint;
pub use loaded::SMALL_FACTOR;
pub use locate::SolveError;
pub use outline::{
    DrawnSection, MemberOutline, OutlineShape, OutlinedMember, SectionOutline, SectionPlates,
    SpecCraneRail, TaperedSection,
};
pub use preload::SpecPreload;
pub(crate) use raw::{RawDetail, RawSectionShape, RawShape, RawSpec};
pub use read::{FORMAT, format, stem};
pub use section_file::{SECTIONS_FORMAT, SectionFile, SectionGroup};
pub use stress::{Detail, StressPoint};
pub use structure::{Form, FrameSpec, GIRDER_RAIL, RailOutline, Spec};
pub use words::{COMPONENTS, THEORIES, theory_word};
