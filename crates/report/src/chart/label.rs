//! Numbers and units as labels.

/// Unit preceded by a power of ten: `10^6 lbf` with a raised exponent, `lbf` where the exponent is 0.
pub(crate) fn with_power(exponent: i32, unit: &str) -> String {
    if exponent == 0 {
        return unit.to_owned();
    }
    const RAISED: [char; 10] = [
        '\u{2070}', '\u{b9}', '\u{b2}', '\u{b3}', '\u{2074}', '\u{2075}', '\u{2076}', '\u{2077}',
        '\u{2078}', '\u{2079}',
    ];
    let mut text = String::from("10");
    if exponent < 0 {
        text.push('\u{207b}');
    }
    for digit in exponent.unsigned_abs().to_string().bytes() {
        text.push(RAISED[usize::from(digit - b'0')]);
    }
    if !unit.is_empty() {
        text.push(' ');
        text.push_str(unit);
    }
    text
}

/// `text (10^exponent unit)`, and the text alone where there is neither.
pub(super) fn with_unit(text: &str, exponent: i32, unit: &str) -> String {
    let unit = with_power(exponent, unit);
    if unit.is_empty() {
        text.to_owned()
    } else {
        format!("{text} ({unit})")
    }
}

/// `value / 10^exponent` with that many decimals, a true minus sign and no negative zero.
pub(super) fn fixed(value: f64, exponent: i32, decimals: usize) -> String {
    let text = format!("{:.*}", decimals, value / 10f64.powi(exponent));
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|b| matches!(b, b'0' | b'.')) => rest.to_owned(),
        Some(rest) => format!("\u{2212}{rest}"),
        None => text,
    }
}

/// A coordinate with at most three decimals, trailing zeros dropped.
pub(super) fn short(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text.strip_prefix('-') {
        Some("0") => "0".to_owned(),
        Some(rest) => format!("\u{2212}{rest}"),
        None => text.to_owned(),
    }
}
