//! An axis as plotters sees it: a scale with its ticks.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

use super::scale::AxisScale;
use super::sheet::LARGEST;
use super::ticks::Ticks;

/// One coordinate of a chart of plotters, whose grid lines and labels are at the ticks.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Coordinate {
    pub scale: AxisScale,
    pub ticks: Ticks,
    /// Values grow against the direction of the axis.
    pub is_reversed: bool,
}

impl Ranged for Coordinate {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        let along = self.scale.unit(*value);
        let along = if self.is_reversed { 1.0 - along } else { along };
        let place = f64::from(from) + along * f64::from(to - from);
        place.clamp(-LARGEST, LARGEST).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        // no finer lines between the ticks
        if hint.weight().allow_light_points() {
            Vec::new()
        } else {
            self.ticks.values.clone()
        }
    }

    fn range(&self) -> Range<f64> {
        self.scale.low..self.scale.high
    }
}

impl ValueFormatter<f64> for Coordinate {
    fn format_ext(&self, value: &f64) -> String {
        let tick = self.ticks.values.iter().position(|own| own == value);
        tick.map(|tick| self.ticks.labels[tick].clone())
            .unwrap_or_default()
    }
}
