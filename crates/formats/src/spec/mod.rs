//! Beam specs: read, checked, converted to the units asked for.
//!
//! From low to high: what the file says (`raw`, with the items of `block`); references and arrays of it
//! (`references`, `column`); its parts (`sections` with `shape` and [`cross_section`], `tapers`, `members`, `rails`,
//! `stress`, `cuts`, `girder`); the checked [`Spec`] (`structure`); the reader of the general form (`frame`) and of
//! specs (`read`); what follows from a spec: names of supported points (`grounds`), places of solver errors
//! (`locate`), rails on ties ([`ties`]).

mod block;
mod column;
pub mod cross_section;
mod cuts;
mod frame;
mod girder;
mod grounds;
mod header;
mod locate;
mod members;
mod rails;
mod raw;
mod read;
mod references;
mod sections;
mod shape;
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
pub use header::{format, stem};
pub use locate::SolveError;
pub(crate) use raw::{RawDetail, RawSpec};
pub use read::FORMAT;
pub use stress::{Detail, StressPoint};
pub use structure::{Form, FrameSpec, GIRDER_RAIL, RailOutline, Spec};
pub use words::{COMPONENTS, THEORIES, theory_word};
