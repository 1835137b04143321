//! Values of single fields: integers, real numbers in the notations of bulk data, sets of degrees of freedom.

/// A number in the notation of bulk data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Number {
    /// An integer, written with digits only.
    Integer(i64),
    /// A finite real number, written with a decimal point or with an exponent and its letter.
    Real(f64),
    /// A real number whose magnitude exceeds the largest double.
    Huge,
}

/// Reads a number such as `12`, `-3.5`, `1.+7`, `2.5-3`, `.5E4` or `1.D+7`; returns `None` for any other text. Blanks may
/// separate the mantissa of a real number from an exponent with a sign, as in `10.4 +6` or `1.2 E-3`. Fields in free
/// format have no blanks.
#[must_use]
pub fn number(text: &str) -> Option<Number> {
    let body = text.strip_prefix(['+', '-']).unwrap_or(text);
    let sign = if text.starts_with('-') { "-" } else { "" };
    let end = body
        .find(|c: char| !c.is_ascii_digit() && c != '.')
        .unwrap_or(body.len());
    let (mantissa, exponent) = body.split_at(end);
    let points = mantissa.matches('.').count();
    if points > 1 || mantissa.len() == points {
        return None;
    }
    let exponent = match exponent.trim_start_matches(' ') {
        apart if apart.len() < exponent.len() => {
            let signed = apart.strip_prefix(['E', 'e', 'D', 'd']).unwrap_or(apart);
            if points == 0 || !signed.starts_with(['+', '-']) {
                return None;
            }
            apart
        }
        adjacent => adjacent,
    };
    if exponent.is_empty() && points == 0 {
        return format!("{sign}{mantissa}")
            .parse()
            .ok()
            .map(Number::Integer);
    }
    let digits = match exponent.strip_prefix(['E', 'e', 'D', 'd']) {
        Some(digits) => digits,
        None if exponent.is_empty() => "0",
        // an exponent without a letter must have a sign, and the mantissa must then have a decimal point
        None if points == 1 && exponent.starts_with(['+', '-']) => exponent,
        None => return None,
    };
    let unsigned = digits.strip_prefix(['+', '-']).unwrap_or(digits);
    if unsigned.is_empty() || !unsigned.bytes().all(|digit| digit.is_ascii_digit()) {
        return None;
    }
    let value: f64 = format!("{sign}{mantissa}e{digits}").parse().ok()?;
    Some(if value.is_finite() {
        Number::Real(value)
    } else {
        Number::Huge
    })
}

/// Reads a set of degrees of freedom from the digits 1 to 6, each of which may occur once. Blanks between the digits
/// have no meaning.
#[must_use]
pub fn freedoms(text: &str) -> Option<[bool; 6]> {
    let mut set = [false; 6];
    for digit in text.bytes().filter(|digit| *digit != b' ') {
        let index = usize::from(digit.checked_sub(b'1')?);
        let slot = set.get_mut(index)?;
        if std::mem::replace(slot, true) {
            return None;
        }
    }
    Some(set)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_they_are_meant() {
        let reals = [
            ("1.", 1.0),
            (".5", 0.5),
            ("-3.25", -3.25),
            ("+1.5", 1.5),
            ("1.+7", 1e7),
            ("2.5-3", 2.5e-3),
            ("-2.5-3", -2.5e-3),
            (".1+1", 1.0),
            ("1.D+7", 1e7),
            ("1.d-2", 0.01),
            ("4.E+6", 4e6),
            ("7e3", 7e3),
            ("1.E7", 1e7),
            ("0.", 0.0),
            ("1.-400", 0.0),
            ("10.4 +6", 10.4e6),
            ("-4.  -6", -4e-6),
            ("1.2 E-3", 1.2e-3),
            ("4. D+6", 4e6),
        ];
        for (text, value) in reals {
            assert_eq!(number(text), Some(Number::Real(value)), "{text}");
        }
        for (text, value) in [("12", 12), ("-3", -3), ("+4", 4), ("0007", 7)] {
            assert_eq!(number(text), Some(Number::Integer(value)), "{text}");
        }
        assert_eq!(number("1.+400"), Some(Number::Huge));
    }

    #[test]
    fn reals_are_the_nearest_doubles() {
        for text in ["0.1", "2.997924", "6.0221408", "1.7976931348623157"] {
            let Some(Number::Real(value)) = number(&format!("{text}+5")) else {
                panic!("{text}")
            };
            assert_eq!(
                value.to_bits(),
                format!("{text}e5")
                    .parse::<f64>()
                    .expect("a number")
                    .to_bits()
            );
        }
    }

    #[test]
    fn other_texts_are_no_numbers() {
        for text in [
            "",
            "+",
            "-",
            ".",
            "+.",
            "1..2",
            "1.2.3",
            "abc",
            "1.E",
            "1.E+",
            "1.+",
            "1+7",
            "12-3",
            "1. 5",
            "1. E5",
            "10 +6",
            "1. + 6",
            "1. +",
            "1. +6.",
            "--1.",
            "1.5x",
            "nan",
            "inf",
            "0x1",
            "1.E+-3",
            "99999999999999999999",
            "1,5",
        ] {
            assert_eq!(number(text), None, "{text}");
        }
    }

    #[test]
    fn freedoms_are_digits_one_to_six_once_each() {
        assert_eq!(
            freedoms("2346"),
            Some([false, true, true, true, false, true])
        );
        assert_eq!(freedoms(""), Some([false; 6]));
        assert_eq!(
            freedoms("12 4 6"),
            Some([true, true, false, true, false, true])
        );
        for text in ["0", "7", "11", "12a", "1 1", "-1", "1."] {
            assert_eq!(freedoms(text), None, "{text}");
        }
    }
}
