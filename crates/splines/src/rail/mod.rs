//! Rails as chains of uniform elements: how the rail moves with the ends of its elements, and what each
//! element adds between them.
//!
//! Order: `element` (data), `load` (a rail force in the axes of the member), `beam_column` (a bending plane under an
//! axial force), `green` and `shape` (the two functions of one element), `functions` (both in any number type), `rounding` (sizes of their terms), `interior` (the
//! deflection of an element under uniform loads), `member_motion` (any other motion of its member between the ends), `row` and `planar` (their values at a place), `track` (which element
//! carries a place), `rails` (all together).

mod beam_column;
mod element;
mod functions;
mod green;
mod interior;
mod load;
mod member_motion;
mod planar;
mod rails;
mod rounding;
mod row;
mod shape;
mod track;

pub use beam_column::{BeamColumn, lowered};
pub use element::{ElementMember, Flexibility, RailElement};
pub(crate) use element::{IDENTITY, LocalPlace, MemberPlace};
pub use functions::ElementFunctions;
pub(crate) use green::SeparatedLoad;
pub(crate) use member_motion::EndForm;
pub use member_motion::MemberMotion;
pub(crate) use planar::{PlanarCubics, PlanarPlace};
pub use rails::Rails;
pub use rounding::RoundingSizes;
pub use row::ShapeRow;
