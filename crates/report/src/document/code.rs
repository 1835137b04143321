//! Compact JSON of long lists of numbers: values are rounded to multiples of a power of ten and stored as differences
//! of successive multiples.

use serde_json::{Value, json};

use formats::text::number::rounded;

/// Smallest number of steps into which the range of an axis is divided, about twenty for each pixel.
const FINE: f64 = 2e4;

/// Largest multiple that is stored as an integer; doubles represent larger ones inexactly.
const LARGEST: f64 = 9e15;

/// Exponent of the power of ten that divides a range into [`FINE`] to 10 [`FINE`] steps.
#[must_use]
pub fn exponent(range: [f64; 2]) -> i32 {
    let power = ((range[1] - range[0]).abs() / FINE).log10().floor();
    // JavaScript represents only these powers of ten exactly
    if power.is_finite() {
        power.clamp(-22.0, 22.0) as i32
    } else {
        0
    }
}

/// Encodes `values` as `{"s": exponent, "n": count, "v": [n0, n1 - n0, ...]}`, in which n are the nearest integer
/// multiples of 10^exponent. Repetitions of the last difference are omitted. If a multiple exceeds `LARGEST`, the
/// values are stored with seven digits instead.
///
/// All values must be finite. The error of each is at most half a step.
#[must_use]
pub(crate) fn coded(values: &[f64], exponent: i32) -> Value {
    let steps = |value: f64| {
        let power = 10f64.powi(exponent.abs());
        (if exponent < 0 {
            value * power
        } else {
            value / power
        })
        .round()
    };
    let counts: Vec<f64> = values.iter().map(|value| steps(*value)).collect();
    if counts.iter().any(|count| count.abs() > LARGEST) {
        return plain(values);
    }
    let mut last = 0;
    let mut differences: Vec<i64> = counts
        .into_iter()
        .map(|count| {
            let count = count as i64;
            count - std::mem::replace(&mut last, count)
        })
        .collect();
    while let [.., before, last] = differences[..]
        && before == last
        && differences.len() > 2
    {
        differences.pop();
    }
    json!({"s": exponent, "n": values.len(), "v": differences})
}

/// Encodes `values` with seven significant digits.
#[must_use]
pub fn plain(values: &[f64]) -> Value {
    json!(
        values
            .iter()
            .map(|value| rounded(*value, 7))
            .collect::<Vec<f64>>()
    )
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// The values as the script of the page decodes them.
    pub fn decoded(code: &Value) -> Vec<f64> {
        if let Some(plain) = code.as_array() {
            return plain
                .iter()
                .map(|value| value.as_f64().expect("a number"))
                .collect();
        }
        let exponent = code["s"].as_i64().expect("an exponent") as i32;
        let mut count = 0;
        let power = 10f64.powi(exponent.abs());
        let steps: Vec<i64> = serde_json::from_value(code["v"].clone()).expect("whole numbers");
        let length = code["n"].as_u64().expect("a count") as usize;
        (0..length)
            .map(|index| {
                count += steps[index.min(steps.len() - 1)];
                if exponent < 0 {
                    count as f64 / power
                } else {
                    count as f64 * power
                }
            })
            .collect()
    }

    #[test]
    fn numbers_come_back_to_half_a_step() {
        for (values, range) in [
            (vec![0.0, -0.05, 12.345_678, 45.0], [0.0, 45.0]),
            (vec![-2.1e5, 1.4e6, 1.4e6, -293.2253], [-2e5, 1.4e6]),
            (vec![1.5e-9, -3e-9], [-4e-9, 4e-9]),
            (vec![2e25, 3e25], [2e25, 3e25]),
            (vec![7.0], [7.0, 7.0]),
            (vec![], [0.0, 1.0]),
        ] {
            let exponent = exponent(range);
            let step = 10f64.powi(exponent);
            assert!(
                range[1] == range[0]
                    || step <= (range[1] - range[0]) / FINE * 1.000_001
                    || step == 1e22
            );
            let back = decoded(&coded(&values, exponent));
            assert_eq!(back.len(), values.len());
            for (back, value) in back.iter().zip(&values) {
                assert!(
                    (back - value).abs() <= 0.500_001 * step + 1e-6 * value.abs(),
                    "{back} {value}"
                );
            }
        }
    }

    #[test]
    fn decimal_numbers_come_back_as_they_were_written_and_even_steps_are_short() {
        let values: Vec<f64> = (0..900).map(|i| f64::from(i) * 0.05).collect();
        assert_eq!(
            coded(&values, -4),
            json!({"s": -4, "n": 900, "v": [0, 500]})
        );
        assert_eq!(coded(&[3.0; 7], 0), json!({"s": 0, "n": 7, "v": [3, 0]}));
        for (i, back) in decoded(&coded(&values, -4)).into_iter().enumerate() {
            assert_eq!(back, (i * 5) as f64 / 100.0);
        }
    }

    #[test]
    fn numbers_too_large_to_count_stay_as_they_are() {
        assert_eq!(coded(&[1e20, 0.5], -4), json!([1e20, 0.5]));
    }
}
