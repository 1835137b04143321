//! Errors of pictures.

use plotters::drawing::DrawingAreaErrorKind;

/// Why a picture was not drawn.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// There is no point to draw.
    #[error("there is no point to draw")]
    NoData,
    /// A coordinate is infinite or not a number.
    #[error("point {point} of series {series} is not finite")]
    NotFinite {
        /// Index of the series.
        series: usize,
        /// Index of the point in the series.
        point: usize,
    },
    /// A logarithmic axis met a value that is zero or negative.
    #[error("point {point} of series {series} is not positive, and the axis is logarithmic")]
    NotPositive {
        /// Index of the series.
        series: usize,
        /// Index of the point in the series.
        point: usize,
    },
    /// The range of an axis is empty, reversed, not finite or, on a logarithmic axis, not positive.
    #[error("cannot draw an axis from {low} to {high}")]
    Range {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// A marker's place is not finite.
    #[error("marker {0} is not finite")]
    Marker(usize),
    /// A grid's size differs from its stations'.
    #[error(
        "the grid's row {row} has {columns} columns; {rows} rows of {expected} columns were expected"
    )]
    Shape {
        /// First offending row, or the number of rows found where that is wrong.
        row: usize,
        /// Columns found in it.
        columns: usize,
        /// Rows expected.
        rows: usize,
        /// Columns expected.
        expected: usize,
    },
    /// Stations do not increase, or one is not finite.
    #[error("station {0} is not finite or not beyond the one before it")]
    Stations(usize),
    /// The drawing backend failed.
    #[error("the drawing backend failed")]
    Drawing,
}

impl<E: std::error::Error + Send + Sync> From<DrawingAreaErrorKind<E>> for Error {
    fn from(_: DrawingAreaErrorKind<E>) -> Self {
        Error::Drawing
    }
}
