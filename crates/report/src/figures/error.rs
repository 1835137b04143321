//! What can go wrong with a figure.

use thiserror::Error;

use crate::chart;

/// Why a figure cannot be drawn.
#[derive(Debug, Error)]
pub enum FigureError {
    /// Places of rails on bodies are not known.
    #[error(transparent)]
    Positions(#[from] foundations::Error),
    /// A chart refuses its data.
    #[error(transparent)]
    Chart(#[from] chart::Error),
    /// A rail cannot be evaluated.
    #[error(transparent)]
    Rail(#[from] splines::Error),
}
