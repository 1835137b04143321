//! Numbers in a form that is easy to read.

/// Rounds `value` to `digits` significant digits (at least 1).
#[must_use]
pub fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// A number as text: without exponent from 1e-5 to 1e15, with an exponent otherwise; zero has no sign.
#[must_use]
pub fn number(value: f64) -> String {
    let value = value + 0.0;
    let plain = value == 0.0 || (1e-5..1e15).contains(&value.abs());
    if plain { value.to_string() } else { format!("{value:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_people_write_them() {
        for (value, text) in
            [(-60.0, "-60"), (0.0, "0"), (4.32e307, "4.32e307"), (2e-9, "2e-9"), (0.1, "0.1"), (-0.0, "0")]
        {
            assert_eq!(number(value), text);
        }
    }
}
