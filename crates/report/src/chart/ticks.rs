//! Ticks of an axis at 1, 2 or 5 times a power of ten, and their labels.

use super::label::{fixed, with_power};
use super::scale::{AxisScale, step};

/// Smallest number of labels of a logarithmic axis.
const FEWEST: usize = 3;

/// Values on an axis with their labels.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ticks {
    /// Values in increasing order, all inside the range.
    pub values: Vec<f64>,
    /// One label for each value, in units of 10^exponent; empty where there is no room for a label.
    pub labels: Vec<String>,
    /// Common power of ten of the labels, a multiple of 3, which is stated with the unit of the axis.
    pub exponent: i32,
}

impl Ticks {
    /// No ticks.
    pub fn none() -> Ticks {
        Ticks {
            values: Vec::new(),
            labels: Vec::new(),
            exponent: 0,
        }
    }

    /// Ticks of a scale, about `target` of them.
    pub fn new(scale: &AxisScale, target: f64) -> Ticks {
        if !scale.log {
            return Ticks::linear(scale, target);
        }
        let ticks = Ticks::logarithmic(scale);
        // A range within one decade may contain one tick at 1, 2 or 5, or none.
        if ticks
            .labels
            .iter()
            .filter(|label| !label.is_empty())
            .count()
            < FEWEST
        {
            Ticks::linear(scale, target)
        } else {
            ticks
        }
    }

    fn linear(scale: &AxisScale, target: f64) -> Ticks {
        let step = step(scale.low, scale.high, target);
        let exponent = exponent(scale.low.abs().max(scale.high.abs()));
        let slack = 1e-9 * (scale.high - scale.low);
        let first = ((scale.low - slack) / step).ceil();
        let mut values = Vec::new();
        for i in 0..64 {
            let value = (first + f64::from(i)) * step;
            if value > scale.high + slack {
                break;
            }
            values.push(if value.abs() < 0.5 * slack {
                0.0
            } else {
                value
            });
        }
        let decimals = decimals(step, exponent);
        let labels = values
            .iter()
            .map(|v| fixed(*v, exponent, decimals))
            .collect();
        Ticks {
            values,
            labels,
            exponent,
        }
    }

    fn logarithmic(scale: &AxisScale) -> Ticks {
        let decades = (scale.high / scale.low).log10();
        let factors: &[f64] = if decades <= 3.0 {
            &[1.0, 2.0, 5.0]
        } else {
            &[1.0]
        };
        let skip = (decades / 8.0).ceil().max(1.0) as i32;
        let (from, to) = (
            scale.low.log10().floor() as i32,
            scale.high.log10().ceil() as i32,
        );
        let plain = scale.low >= 1e-3 && scale.high <= 1e4;
        let (mut values, mut labels) = (Vec::new(), Vec::new());
        for power in from..=to {
            for factor in factors {
                let value = factor * 10f64.powi(power);
                if value < scale.low * (1.0 - 1e-9) || value > scale.high * (1.0 + 1e-9) {
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
        Ticks {
            values,
            labels,
            exponent: 0,
        }
    }
}

/// Common power of ten, a multiple of 3, of labels whose largest absolute value is `largest`; 0 from 0.01 up to
/// 10,000.
pub(super) fn exponent(largest: f64) -> i32 {
    if largest == 0.0 || (0.01..1e4).contains(&largest) {
        return 0;
    }
    let power = (largest * (1.0 + 1e-12)).log10().floor() as i32;
    power.div_euclid(3) * 3
}

/// Number of decimals with which the labels of ticks of the given step differ.
fn decimals(step: f64, exponent: i32) -> usize {
    let scaled = step / 10f64.powi(exponent);
    let power = (scaled * (1.0 + 1e-9)).log10().floor() as i32;
    usize::try_from(-power).unwrap_or(0).min(12)
}
