//! Polynomials on intervals.
//!
//! A [`Polynomial`] on the unit interval is given by its Bernstein coefficients, which bound it. [`Lobatto`] makes one from
//! values at Chebyshev-Lobatto nodes. [`Piecewise`] is a function of time with several columns: in every interval each column is
//! a polynomial, and at the end of an interval it may jump, so that it has a value from either side.
//!
//! ```
//! use piecewise::{Piecewise, Side};
//!
//! // t (2 - t) until t = 1.5, then a constant
//! let mut function = Piecewise::new(1);
//! function.push([0.0, 1.5], 2, [&[0.0][..], &[0.9375], &[0.75]]);
//! function.push([1.5, 2.0], 1, [&[3.0][..], &[3.0]]);
//!
//! assert_eq!(function.value(1.5, Side::Before, 0), 0.75);
//! assert_eq!(function.value(1.5, Side::After, 0), 3.0);
//! let first = function.piece(0).column(0).largest();
//! assert!((1.5 * first.share - 1.0).abs() < 1e-12 && (first.value - 1.0).abs() < 1e-15);
//! ```
//!
//! Wings, lowest first: polynomial, lobatto, function, fit

mod fit;
mod function;
mod lobatto;
mod polynomial;

pub use fit::{Evaluate, fit};
pub use function::{Piece, Piecewise, Side, between};
pub use lobatto::Lobatto;
pub use polynomial::{Extreme, MAX_DEGREE, Polynomial};
