//! Finite displacements: the equilibrium of a frame whose members turn with it, by which the linear theories are judged.
//!
//! Every member is a beam of small strain in axes that turn with the line between its ends (co-rotational). The potential energy
//! of the whole frame, members, springs and dead loads, is a function of the motions of its bodies; its derivatives are exact,
//! and Newton's method follows its minimum while the load grows. [`LinearState`] compares the answer with that of the linear
//! theory, of first order or about a preload.
//!
//! Order of the files: `turn` (finite rotations), `member` (strain energy of a member), `frame` (potential energy, equilibrium),
//! `compare`.

mod compare;
mod frame;
mod member;
mod turn;

pub use compare::{LargeDisplacements, LargestDifference, LinearState, Omitted};
