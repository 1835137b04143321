//! Format of numbers in reports, and which of them are zero but for rounding.

/// Fraction of the largest magnitude of its kind up to which a value is what rounding has left of zero. Tables have four
/// digits, so that such a value acts on nothing that they show.
const ROUNDING: f64 = 1e-9;

/// Whether `value` is zero but for rounding beside `largest`, the largest magnitude of the values of its kind.
///
/// ```
/// assert!(report::is_rounding(-1e-12, 200.0) && report::is_rounding(0.0, 0.0));
/// assert!(!report::is_rounding(0.001, 200.0));
/// ```
#[must_use]
pub fn is_rounding(value: f64, largest: f64) -> bool {
    value.abs() <= ROUNDING * largest
}

/// `value`, or zero where it [is zero but for rounding](is_rounding) beside `largest`.
#[must_use]
pub fn cleared(value: f64, largest: f64) -> f64 {
    if is_rounding(value, largest) {
        0.0
    } else {
        value
    }
}

/// `value` with at most `digits` significant digits (1 to 17), trailing zeros dropped.
///
/// From 0.0001 up to ten million in plain notation, five digits and more before the point grouped by narrow
/// spaces; as a mantissa and a power of ten beyond. Zero has no sign. `None` for infinities and NaN.
pub fn number(value: f64, digits: usize) -> Option<String> {
    if !value.is_finite() {
        return None;
    }
    if value == 0.0 {
        return Some("0".to_owned());
    }
    // rounded before the notation is chosen: 9999999.7 becomes 10^7
    let scientific = format!("{:.*e}", digits.clamp(1, 17) - 1, value.abs());
    let (mantissa, power) = scientific.split_once('e')?;
    let power: i32 = power.parse().ok()?;
    let sign = if value < 0.0 { "\u{2212}" } else { "" };
    if !(-4..7).contains(&power) {
        let raised = crate::chart::label::with_power(power, "");
        return Some(match trimmed(mantissa) {
            "1" => format!("{sign}{raised}"),
            mantissa => format!("{sign}{mantissa} \u{d7} {raised}"),
        });
    }
    let all: String = mantissa.chars().filter(char::is_ascii_digit).collect();
    let plain = match usize::try_from(power) {
        Ok(power) => {
            let whole = format!("{all:0<width$}", width = power + 1);
            format!("{}.{}", grouped(&whole[..=power]), &whole[power + 1..])
        }
        Err(_) => format!("0.{}{all}", "0".repeat(power.unsigned_abs() as usize - 1)),
    };
    Some(format!("{sign}{}", trimmed(&plain)))
}

/// `text` with its numbers in the notation of programs, such as 3.0e-7, in that of [`number`].
pub fn with_numbers(text: &str) -> String {
    let word = |word: &str| {
        let core = word.trim_matches(|c: char| "(),.;:".contains(c) || c.is_whitespace());
        let is_numeral = core.contains('e')
            && core
                .chars()
                .all(|c| c.is_ascii_digit() || "-+.e".contains(c));
        let value = core
            .parse()
            .ok()
            .filter(|_| is_numeral)
            .and_then(|value| number(value, 7));
        value.map_or_else(|| word.to_owned(), |value| word.replacen(core, &value, 1))
    };
    text.split_inclusive(' ').map(word).collect()
}

fn trimmed(text: &str) -> &str {
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        text
    }
}

fn grouped(digits: &str) -> String {
    if digits.len() < 5 {
        return digits.to_owned();
    }
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}
