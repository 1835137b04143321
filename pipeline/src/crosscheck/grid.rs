//! Influence grids as plain numbers, as the other codes return them.

/// Square matrix of influence coefficients; rows are deflections, columns are loads.
pub type PlainGrid = Vec<Vec<f64>>;

/// Index of the rail and coordinate of a station.
pub type Station = (usize, f64);
