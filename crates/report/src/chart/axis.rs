//! Axes: label, unit, range and direction.

use super::label::with_unit;

/// One axis of a chart, as data.
///
/// ```
/// use report::chart::ChartAxis;
///
/// let axis = ChartAxis::new("error", "ft").log().range(1e-6, 1e-2);
/// assert_eq!((axis.log, axis.range), (true, Some([1e-6, 1e-2])));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChartAxis {
    /// What is measured, without the unit.
    pub label: String,
    /// Unit; empty for pure numbers.
    pub unit: String,
    /// Ends of the axis, lower first; `None`: taken from the data.
    pub range: Option<[f64; 2]>,
    /// Logarithmic scale: every value must be positive.
    pub log: bool,
    /// Whether the positive direction points down (y axis) or left (x axis), as usual for deflections.
    pub downwards: bool,
}

impl ChartAxis {
    /// A linear axis whose range is taken from the data.
    pub fn new(label: impl Into<String>, unit: impl Into<String>) -> Self {
        ChartAxis {
            label: label.into(),
            unit: unit.into(),
            ..ChartAxis::default()
        }
    }

    /// The same axis with positive values downwards.
    pub fn downwards(self) -> Self {
        ChartAxis {
            downwards: true,
            ..self
        }
    }

    /// The same axis on a logarithmic scale.
    pub fn log(self) -> Self {
        ChartAxis { log: true, ..self }
    }

    /// The same axis from `low` to `high`.
    pub fn range(self, low: f64, high: f64) -> Self {
        ChartAxis {
            range: Some([low, high]),
            ..self
        }
    }

    /// Label with unit and the common power of ten of the tick labels.
    pub(super) fn caption(&self, exponent: i32) -> String {
        with_unit(&self.label, exponent, &self.unit)
    }
}
