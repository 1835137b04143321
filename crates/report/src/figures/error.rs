//! Errors of figures.

use thiserror::Error;

use crate::chart;

/// Why a figure cannot be drawn.
#[derive(Debug, Error)]
pub enum FigureError {
    /// The places of rails on bodies cannot be determined.
    #[error(transparent)]
    Positions(#[from] foundations::Error),
    /// A chart cannot draw its data.
    #[error(transparent)]
    Chart(#[from] chart::Error),
    /// A rail cannot be evaluated.
    #[error(transparent)]
    Rail(#[from] splines::Error),
}
