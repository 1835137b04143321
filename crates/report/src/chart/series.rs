//! Data of a chart: series of points, and markers across the chart.

/// How a series is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Style {
    /// Straight lines from point to point.
    #[default]
    Line,
    /// The same, dashed.
    Dashed,
    /// The same, dashed and grey, for a limit or an axis of the other series.
    Limit,
    /// A symbol at each point.
    Points,
    /// A thin line from point to point, and a symbol at each.
    Marked,
    /// Each value continues to the next point.
    Step,
}

/// Points of one curve.
///
/// ```
/// use report::chart::{Series, Style};
///
/// let steps = Series::new("command", Style::Step, vec![[0.0, 2.0], [4.0, 3.0]]);
/// let errors = Series::new("largest error", Style::Marked, vec![[1e-3, 0.2]]).spread(vec![[8e-4, 2e-3]]);
/// assert_eq!((steps.points.len(), errors.spread[0]), (2, [8e-4, 2e-3]));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Name in the legend.
    pub label: String,
    /// How it is drawn.
    pub style: Style,
    /// Points (x, y) in the units of the axes, in the order in which they are connected.
    pub points: Vec<[f64; 2]>,
    /// Range along x of each point, lower end first, in the units of the axis; empty: no ranges are drawn.
    pub spread: Vec<[f64; 2]>,
}

impl Style {
    /// Full lines for even indices, dashed lines for odd ones.
    #[must_use]
    pub fn alternating(index: usize) -> Style {
        if index.is_multiple_of(2) {
            Style::Line
        } else {
            Style::Dashed
        }
    }
}

impl Series {
    /// A series of the given style.
    pub fn new(label: impl Into<String>, style: Style, points: Vec<[f64; 2]>) -> Self {
        Series {
            label: label.into(),
            style,
            points,
            spread: Vec::new(),
        }
    }

    /// The same series with the range of each point along x.
    pub fn spread(self, spread: Vec<[f64; 2]>) -> Self {
        Series { spread, ..self }
    }

    /// Whether every point has a symbol.
    pub(super) fn has_symbols(&self) -> bool {
        matches!(self.style, Style::Points | Style::Marked)
    }

    /// Whether symbols on its line may tell it from other lines: not where every point has one, and not on a grey limit.
    pub(super) fn may_have_symbols(&self) -> bool {
        !self.has_symbols() && self.style != Style::Limit
    }

    /// Corners of the curve: those of the stairs for [`Style::Step`], the points otherwise.
    pub(super) fn corners(&self) -> Vec<[f64; 2]> {
        if self.style != Style::Step {
            return self.points.clone();
        }
        let mut corners = Vec::with_capacity(2 * self.points.len());
        for pair in self.points.windows(2) {
            corners.push(pair[0]);
            corners.push([pair[1][0], pair[0][1]]);
        }
        corners.extend(self.points.last());
        corners
    }
}

/// A vertical line across the chart with a label above it, for example a support.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SeriesMarker {
    /// Place on the x axis.
    pub x: f64,
    /// Text above the line.
    pub label: String,
}

impl SeriesMarker {
    /// A marker at `x`.
    pub fn new(x: f64, label: impl Into<String>) -> Self {
        SeriesMarker {
            x,
            label: label.into(),
        }
    }
}
