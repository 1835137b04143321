//! Numbers in a form that is easy to read.

use std::io::Write;

/// Rounds `value` to `digits` significant digits (at least 1).
#[must_use]
pub fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1))
        .parse()
        .unwrap_or(value)
}

/// A number as text: without exponent from 1e-5 to 1e15, with an exponent otherwise; zero has no sign.
#[must_use]
pub fn number(value: f64) -> String {
    let value = value + 0.0;
    let plain = value == 0.0 || (1e-5..1e15).contains(&value.abs());
    if plain {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// Appends a number of a table with all its digits, the fewest from which it is read back, in the form that `{:?}` writes and
/// in half of its time; where two such numbers are equally near, the last digit is even. Zero has no sign.
pub fn push_number(out: &mut Vec<u8>, value: f64) {
    let value = value + 0.0;
    // The forms differ in numbers of one decade, and in the sign of positive exponents.
    if value.abs() < 1e16 && !(1e-5..1e-4).contains(&value.abs()) {
        out.extend_from_slice(zmij::Buffer::new().format_finite(value).as_bytes());
    } else {
        write!(out, "{value:?}").expect("memory takes all bytes");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_people_write_them() {
        for (value, text) in [
            (-60.0, "-60"),
            (0.0, "0"),
            (4.32e307, "4.32e307"),
            (2e-9, "2e-9"),
            (0.1, "0.1"),
            (-0.0, "0"),
        ] {
            assert_eq!(number(value), text);
        }
    }

    /// The formatter of the standard library, at every power of ten and at numbers of all sizes.
    #[test]
    fn numbers_of_tables_are_those_of_the_standard_library() {
        let mut bits = 1_u64;
        let drawn = (0..400_000).map(|_| {
            bits = bits
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            f64::from_bits(bits)
        });
        // Half of them have sizes that quantities of scenes have.
        let drawn = drawn.enumerate().map(|(k, value)| {
            let mantissa = f64::from_bits(value.to_bits() >> 12 | 1023 << 52);
            if k % 2 == 0 {
                value
            } else {
                mantissa * 10.0_f64.powi((k / 2 % 36) as i32 - 18)
            }
        });
        let powers = (-320..309)
            .flat_map(|power| [1.0, 1.5, -9.999, 2.0_f64.sqrt()].map(|c| c * 10.0_f64.powi(power)));
        let others = [
            0.0,
            -0.0,
            0.1,
            100.0,
            123_456.0,
            1e15,
            1e16,
            9.99e15,
            f64::MAX,
            f64::MIN_POSITIVE,
            5e-324,
        ];
        for value in drawn.chain(powers).chain(others) {
            let mut out = Vec::new();
            push_number(&mut out, value);
            let (found, known) = (String::from_utf8_lossy(&out), format!("{:?}", value + 0.0));
            // Of two numbers that are equally near, the standard library takes the larger one.
            let is_tie = || {
                found[..found.len() - 1] == known[..known.len() - 1] && found.parse() == Ok(value)
            };
            assert!(found == known || is_tie(), "{found} for {known}");
        }
    }
}
