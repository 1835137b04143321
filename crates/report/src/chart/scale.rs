//! Scales, which map data to the unit interval, over ranges that end at multiples of 1, 2 or 5 times a power of ten.

use super::axis::ChartAxis;
use super::error::Error;

/// Length of a range below which it is treated as a single value, because smaller powers of ten lose digits.
const TINY: f64 = 1e-280;

/// Scale of one axis: data to the unit interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AxisScale {
    pub low: f64,
    pub high: f64,
    pub log: bool,
}

/// Smallest and largest value; (infinity, -infinity) if there is none.
pub(super) fn extent(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
        (a.min(v), b.max(v))
    })
}

impl AxisScale {
    /// Scale of `axis` over `data`. `loose` widens a range taken from the data to the next ticks.
    ///
    /// # Errors
    /// [`Error::NoData`] where there is neither a range nor a value, [`Error::Range`] where the range cannot
    /// be drawn.
    pub fn new(
        axis: &ChartAxis,
        data: impl Iterator<Item = f64>,
        loose: bool,
    ) -> Result<Self, Error> {
        let (mut low, mut high) = match axis.range {
            Some([low, high]) => (low, high),
            None => extent(data),
        };
        if axis.range.is_none() && low > high {
            return Err(Error::NoData);
        }
        let fits = |low: f64, high: f64| {
            low < high && (high - low).is_finite() && (!axis.log || low > 0.0)
        };
        if axis.range.is_none() {
            if axis.log {
                if high / low < 1.001 {
                    (low, high) = (low / 2.0, high * 2.0);
                }
            } else if high - low <= (1e-12 * low.abs().max(high.abs())).max(TINY) {
                let half = if low.abs() <= TINY {
                    1.0
                } else {
                    0.1 * low.abs()
                };
                (low, high) = (low - half, high + half);
            }
            if loose && fits(low, high) {
                if axis.log {
                    let widen = (high / low).powf(0.04);
                    (low, high) = (low / widen, high * widen);
                } else {
                    let step = step(low, high, 6.0);
                    let slack = 1e-9 * step;
                    low = ((low + slack) / step).floor() * step;
                    high = ((high - slack) / step).ceil() * step;
                }
            }
        }
        if fits(low, high) {
            Ok(AxisScale {
                low,
                high,
                log: axis.log,
            })
        } else {
            Err(Error::Range { low, high })
        }
    }

    /// Position of a value: 0 at the lower end, 1 at the upper end.
    pub fn unit(&self, value: f64) -> f64 {
        if self.log {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// The scale with the same middle and a range longer by `factor`; unchanged for a factor below 1.
    pub fn widened(self, factor: f64) -> Self {
        let (middle, half) = (0.5 * (self.low + self.high), 0.5 * (self.high - self.low));
        if factor > 1.0 {
            AxisScale {
                low: middle - factor * half,
                high: middle + factor * half,
                ..self
            }
        } else {
            self
        }
    }
}

/// Largest of 1, 2, 5 times a power of ten that divides `low..high` into about `target` parts.
pub(super) fn step(low: f64, high: f64, target: f64) -> f64 {
    let raw = (high - low) / target.max(1.0);
    let power = 10f64.powf(raw.log10().floor());
    let power = if power > 0.0 && power.is_finite() {
        power
    } else {
        raw
    };
    let mantissa = raw / power;
    power
        * match mantissa {
            m if m < 1.5 => 1.0,
            m if m < 3.5 => 2.0,
            m if m < 7.5 => 5.0,
            _ => 10.0,
        }
}
