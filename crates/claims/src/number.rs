//! Numbers as the book writes them.

/// `value` with `digits` significant digits: as people write it between 1e-3 and 1e7, else with a power of ten.
#[must_use]
pub fn number(value: f64, digits: usize) -> String {
    let digits = digits.max(1);
    let text = format!("{value:.*e}", digits - 1);
    let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
    let power: i32 = power.parse().unwrap_or(0);
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    if !(-3..7).contains(&power) {
        return format!("{mantissa}e{power}");
    }
    let after = (digits as i32 - 1 - power).max(0) as usize;
    let rounded: f64 = text.parse().unwrap_or(value);
    thousands(&format!("{rounded:.after$}"))
}

/// A count.
#[must_use]
pub fn whole(count: usize) -> String {
    thousands(&count.to_string())
}

/// A comma before every three digits of what stands before the point, from five digits on.
fn thousands(text: &str) -> String {
    let (sign, rest) = text.strip_prefix('-').map_or(("", text), |rest| ("-", rest));
    let (whole, part) = rest.split_once('.').map_or((rest, None), |(whole, part)| (whole, Some(part)));
    let mut out = String::new();
    for (i, digit) in whole.chars().enumerate() {
        if i > 0 && (whole.len() - i) % 3 == 0 && whole.len() > 4 {
            out.push(',');
        }
        out.push(digit);
    }
    match part {
        Some(part) => format!("{sign}{out}.{part}"),
        None => format!("{sign}{out}"),
    }
}

/// Seconds with three digits, in the unit that suits them.
#[must_use]
pub fn time(seconds: f64) -> String {
    let (unit, by) = match seconds.abs() {
        own if own < 0.9995e-6 => ("ns", 1e9),
        own if own < 0.9995e-3 => ("us", 1e6),
        own if own < 0.9995 => ("ms", 1e3),
        _ => ("s", 1.0),
    };
    format!("{} {unit}", number(by * seconds, 3))
}

/// A share as a signed percentage, finer shares with a power of ten.
#[must_use]
pub fn percent(share: f64) -> String {
    if share == 0.0 {
        return "0".to_owned();
    }
    if share.abs() < 5e-4 {
        return format!("{share:+.0e}");
    }
    format!("{:+.*} %", if share.abs() < 0.0995 { 1 } else { 0 }, 100.0 * share)
}

/// Significant digits of `value`, up to ten: those that are not zeros at its end.
#[must_use]
pub fn digits(value: f64) -> usize {
    let text = format!("{value:.9e}");
    let mantissa = text.split('e').next().unwrap_or_default().trim_end_matches('0');
    mantissa.chars().filter(char::is_ascii_digit).count().max(1)
}

#[cfg(test)]
mod tests {
    use super::{digits, number, percent, time};

    #[test]
    fn numbers_are_written_as_people_write_them() {
        for (value, count, text) in [
            (30_785.4, 5, "30,785"),
            (64_635.2, 5, "64,635"),
            (1.31e6, 3, "1,310,000"),
            (0.066, 2, "0.066"),
            (5.2e-4, 2, "5.2e-4"),
            (-21_835.0, 5, "-21,835"),
            (0.0, 3, "0"),
            (9.99e-16, 2, "1.0e-15"),
            (4.8e8, 2, "4.8e8"),
            (12.68, 4, "12.68"),
            (100.0, 1, "100"),
            (99.96, 3, "100"),
        ] {
            assert_eq!(number(value, count), text, "{value:e}");
        }
    }

    #[test]
    fn times_have_the_unit_that_suits_them() {
        for (seconds, text) in [
            (9.6e-8, "96.0 ns"),
            (1.234e-6, "1.23 us"),
            (0.99951e-6, "1.00 us"),
            (0.0123, "12.3 ms"),
            (20.0, "20.0 s"),
        ] {
            assert_eq!(time(seconds), text, "{seconds:e}");
        }
    }

    #[test]
    fn shares_are_written_in_percent() {
        for (share, text) in
            [(0.012, "+1.2 %"), (-0.5, "-50 %"), (1e-6, "+1e-6"), (-2e-5, "-2e-5"), (0.0, "0")]
        {
            assert_eq!(percent(share), text);
        }
    }

    #[test]
    fn digits_are_those_written() {
        for (value, count) in [(5.2e-4, 2), (2.0, 1), (10.93, 4), (21_835.0, 5), (0.0, 1)] {
            assert_eq!(digits(value), count, "{value}");
        }
    }
}
