//! Numbers of findings with few significant digits.

/// The value with three significant digits.
pub(super) fn short(value: f64) -> String {
    digits(value, 3)
}

/// The value with four significant digits.
pub(super) fn sharp(value: f64) -> String {
    digits(value, 4)
}

fn digits(value: f64, count: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let size = value.abs();
    if !(1e-3..1e5).contains(&size) {
        return format!("{value:.*e}", count - 1);
    }
    let decimals = (count as i32 - 1 - size.log10().floor() as i32).max(0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}
