//! Grids as plain numbers, as other codes answer.

/// A square grid: row deflection, column load.
pub type PlainGrid = Vec<Vec<f64>>;

/// Rail and coordinate of a station.
pub type Station = (usize, f64);
