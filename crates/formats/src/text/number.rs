//! Numbers rounded for display.

/// `value` to `digits` significant digits (1 at least).
#[must_use]
pub fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}
