//! Numbers as data sets write them.

/// Shortest digits that read back to the same bits, always with a decimal point.
#[must_use]
pub fn write(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-4..1e7).contains(&size) {
        return format!("{value:?}");
    }
    let text = format!("{value:E}");
    match text.split_once('E') {
        Some((digits, exponent)) if !digits.contains('.') => format!("{digits}.0E{exponent}"),
        _ => text,
    }
}

/// A finite real number as Fortran writes it, with an E or D exponent.
#[must_use]
pub fn read(text: &str) -> Option<f64> {
    let plain = text.bytes().all(|c| c.is_ascii_digit() || b"+-.eEdD".contains(&c));
    let value: f64 = text.replace(['d', 'D'], "E").parse().ok().filter(|_| plain)?;
    value.is_finite().then_some(value)
}
