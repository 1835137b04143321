//! Scales: data to the unit interval, and ticks at 1, 2, 5 times a power of ten.

use super::axis::{Axis, fixed, with_power};
use super::error::Error;

/// Ranges shorter than this count as a single value: powers of ten below it lose digits.
const TINY: f64 = 1e-280;

/// Labels that a logarithmic axis must have to be read.
const FEWEST: usize = 3;

/// Placed values with their labels.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ticks {
    /// Values in increasing order, all inside the range.
    pub values: Vec<f64>,
    /// One label a value, in units of 10^exponent; empty where a label would crowd.
    pub labels: Vec<String>,
    /// Power of ten taken out of the labels, a multiple of 3.
    pub exponent: i32,
}

/// Scale of one axis: data to the unit interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    pub low: f64,
    pub high: f64,
    pub log: bool,
}

/// Least and greatest value; infinities the wrong way round where there is none.
pub(super) fn extent(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)))
}

impl Scale {
    /// Scale of `axis` over `data`. `loose` widens a range taken from the data to the next ticks.
    ///
    /// # Errors
    /// [`Error::NoData`] where there is neither a range nor a value, [`Error::Range`] where the range cannot
    /// be drawn.
    pub fn new(axis: &Axis, data: impl Iterator<Item = f64>, loose: bool) -> Result<Self, Error> {
        let (mut low, mut high) = match axis.range {
            Some([low, high]) => (low, high),
            None => extent(data),
        };
        if axis.range.is_none() && low > high {
            return Err(Error::NoData);
        }
        let fits = |low: f64, high: f64| low < high && (high - low).is_finite() && (!axis.log || low > 0.0);
        if axis.range.is_none() {
            if axis.log {
                if high / low < 1.001 {
                    (low, high) = (low / 2.0, high * 2.0);
                }
            } else if high - low <= (1e-12 * low.abs().max(high.abs())).max(TINY) {
                let half = if low.abs() <= TINY { 1.0 } else { 0.1 * low.abs() };
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
        if fits(low, high) { Ok(Scale { low, high, log: axis.log }) } else { Err(Error::Range { low, high }) }
    }

    /// Place of a value: 0 at the lower end, 1 at the upper.
    pub fn unit(&self, value: f64) -> f64 {
        if self.log {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// The scale about the same middle, longer by a factor; a factor below 1 leaves it as it is.
    pub fn widened(self, factor: f64) -> Self {
        let (middle, half) = (0.5 * (self.low + self.high), 0.5 * (self.high - self.low));
        if factor > 1.0 {
            Scale { low: middle - factor * half, high: middle + factor * half, ..self }
        } else {
            self
        }
    }

    /// Ticks, about `target` of them.
    pub fn ticks(&self, target: f64) -> Ticks {
        if !self.log {
            return self.linear_ticks(target);
        }
        let ticks = self.log_ticks();
        // a part of a decade may hold one of them, or none
        if ticks.labels.iter().filter(|label| !label.is_empty()).count() < FEWEST {
            self.linear_ticks(target)
        } else {
            ticks
        }
    }

    fn linear_ticks(&self, target: f64) -> Ticks {
        let step = step(self.low, self.high, target);
        let exponent = exponent(self.low.abs().max(self.high.abs()));
        let slack = 1e-9 * (self.high - self.low);
        let first = ((self.low - slack) / step).ceil();
        let mut values = Vec::new();
        for i in 0..64 {
            let value = (first + f64::from(i)) * step;
            if value > self.high + slack {
                break;
            }
            values.push(if value.abs() < 0.5 * slack { 0.0 } else { value });
        }
        let decimals = decimals(step, exponent);
        let labels = values.iter().map(|v| fixed(*v, exponent, decimals)).collect();
        Ticks { values, labels, exponent }
    }

    fn log_ticks(&self) -> Ticks {
        let decades = (self.high / self.low).log10();
        let factors: &[f64] = if decades <= 3.0 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let skip = (decades / 8.0).ceil().max(1.0) as i32;
        let (from, to) = (self.low.log10().floor() as i32, self.high.log10().ceil() as i32);
        let plain = self.low >= 1e-3 && self.high <= 1e4;
        let (mut values, mut labels) = (Vec::new(), Vec::new());
        for power in from..=to {
            for factor in factors {
                let value = factor * 10f64.powi(power);
                if value < self.low * (1.0 - 1e-9) || value > self.high * (1.0 + 1e-9) {
                    continue;
                }
                values.push(value);
                labels.push(match (plain, *factor == 1.0) {
                    (true, _) => fixed(value, 0, usize::try_from(-power).unwrap_or(0)),
                    (false, true) if power.rem_euclid(skip) == 0 => {
                        if power == 0 {
                            "1".into()
                        } else {
                            with_power(power, "")
                        }
                    }
                    (false, true) => String::new(),
                    (false, false) => format!("{factor}\u{b7}{}", with_power(power, "")),
                });
            }
        }
        Ticks { values, labels, exponent: 0 }
    }
}

/// Largest of 1, 2, 5 times a power of ten that divides `low..high` into about `target` parts.
pub(super) fn step(low: f64, high: f64, target: f64) -> f64 {
    let raw = (high - low) / target.max(1.0);
    let power = 10f64.powf(raw.log10().floor());
    let power = if power > 0.0 && power.is_finite() { power } else { raw };
    let mantissa = raw / power;
    power
        * match mantissa {
            m if m < 1.5 => 1.0,
            m if m < 3.5 => 2.0,
            m if m < 7.5 => 5.0,
            _ => 10.0,
        }
}

/// Multiple of 3 to take out of labels whose largest size is `largest`; 0 from 0.01 up to 10,000.
pub(super) fn exponent(largest: f64) -> i32 {
    if largest == 0.0 || (0.01..1e4).contains(&largest) {
        return 0;
    }
    let power = (largest * (1.0 + 1e-12)).log10().floor() as i32;
    power.div_euclid(3) * 3
}

/// Decimals that tell ticks of the given step apart.
fn decimals(step: f64, exponent: i32) -> usize {
    let scaled = step / 10f64.powi(exponent);
    let power = (scaled * (1.0 + 1e-9)).log10().floor() as i32;
    usize::try_from(-power).unwrap_or(0).min(12)
}
