//! A run in pieces of time in which everything that the loads on a structure cause is a polynomial, and what follows: the largest
//! and smallest values of quantities, and when they occur.
//!
//! Files, lowest first: bounds, cells, load_pieces, peak, functionals, this one.

mod bounds;
mod cells;
mod functionals;
mod load_pieces;
mod peak;

pub(crate) use bounds::Bounds;
pub(crate) use cells::{Cell, RailCells};
pub(crate) use functionals::{Functional, Functionals, LINE_DEGREE};
pub(crate) use load_pieces::{Instant, LoadPieces, LoadState, Piece, Stay};
pub(crate) use peak::{
    OwnLoad, Part, Peak, SIGNS, WHOLE, known, offer_part, offer_piece, offer_polynomial,
};
