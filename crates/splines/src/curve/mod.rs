//! Curves in one variable: piecewise cubics through given points, by Akima's rule and as natural splines.

mod akima;
mod cubic;
mod natural;

pub use akima::akima;
pub use cubic::{CurveValue, PiecewiseCubic};
pub(crate) use cubic::{Interval, check_increasing};
pub use natural::natural_spline;
pub(crate) use natural::values_and_slopes;
