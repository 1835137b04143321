//! Axes: label, unit, range and direction.

/// One axis of a chart, as data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// What is measured, without the unit.
    pub label: String,
    /// Unit; empty for pure numbers.
    pub unit: String,
    /// Ends, lower first; taken from the data where absent.
    pub range: Option<[f64; 2]>,
    /// Logarithmic scale: every value must be positive.
    pub log: bool,
    /// The positive direction points down (y axis) or left (x axis): deflections are drawn so.
    pub downwards: bool,
}

impl Axis {
    /// A linear axis whose range is taken from the data.
    pub fn new(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Axis { label: label.into(), unit: unit.into(), ..Axis::default() }
    }

    /// The same axis with positive values downwards.
    pub fn downwards(self) -> Self {
        Axis { downwards: true, ..self }
    }

    /// The same axis on a logarithmic scale.
    pub fn log(self) -> Self {
        Axis { log: true, ..self }
    }

    /// The same axis from `low` to `high`.
    pub fn range(self, low: f64, high: f64) -> Self {
        Axis { range: Some([low, high]), ..self }
    }

    /// Label with unit and the power of ten taken out of the tick labels.
    pub(super) fn caption(&self, exponent: i32) -> String {
        let unit = with_power(exponent, &self.unit);
        if unit.is_empty() { self.label.clone() } else { format!("{} ({unit})", self.label) }
    }
}

/// Unit preceded by a power of ten: `10^6 lbf` with a raised exponent, `lbf` where the exponent is 0.
pub(crate) fn with_power(exponent: i32, unit: &str) -> String {
    if exponent == 0 {
        return unit.to_owned();
    }
    const RAISED: [char; 10] = [
        '\u{2070}', '\u{b9}', '\u{b2}', '\u{b3}', '\u{2074}', '\u{2075}', '\u{2076}', '\u{2077}', '\u{2078}',
        '\u{2079}',
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

/// `value / 10^exponent` with that many decimals, a true minus sign and no negative zero.
pub(super) fn fixed(value: f64, exponent: i32, decimals: usize) -> String {
    let text = format!("{:.*}", decimals, value / 10f64.powi(exponent));
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|b| matches!(b, b'0' | b'.')) => rest.to_owned(),
        Some(rest) => format!("\u{2212}{rest}"),
        None => text,
    }
}
