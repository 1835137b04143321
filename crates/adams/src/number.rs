//! Numbers as data sets write them.

/// Writes a number with the fewest digits that read back to the same bits.
///
/// The text always has a decimal point; outside 1e-4 to 1e7 it has an exponent.
///
/// ```
/// use adams::number;
///
/// assert_eq!(number::write(15.0), "15.0");
/// assert_eq!(number::write(1.09e-7), "1.09E-7");
/// ```
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

/// Reads a finite real number as Fortran writes it, with an E or D exponent; `None` for any other text.
///
/// ```
/// use adams::number;
///
/// assert_eq!(number::read("1.5D+01"), Some(15.0));
/// assert_eq!(number::read("inf"), None);
/// ```
#[must_use]
pub fn read(text: &str) -> Option<f64> {
    let plain = text
        .bytes()
        .all(|c| c.is_ascii_digit() || b"+-.eEdD".contains(&c));
    let value: f64 = text
        .replace(['d', 'D'], "E")
        .parse()
        .ok()
        .filter(|_| plain)?;
    value.is_finite().then_some(value)
}
