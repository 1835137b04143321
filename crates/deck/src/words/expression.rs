//! Pieces of function expressions.

/// A number inside an expression; negative ones in brackets.
#[must_use]
pub(crate) fn number(value: f64) -> String {
    let text = adams::number::write(value);
    if value.is_sign_negative() { format!("({text})") } else { text }
}

/// `VARVAL(id)`.
#[must_use]
pub(crate) fn value(id: u32) -> String {
    format!("VARVAL({id})")
}

/// Terms with their signs.
#[derive(Clone, Debug, Default)]
pub(crate) struct TermList(String);

impl TermList {
    /// Adds a term, or takes it away.
    pub fn add(&mut self, negative: bool, term: &str) {
        match (negative, self.0.is_empty()) {
            (true, _) => self.0.push('-'),
            (false, false) => self.0.push('+'),
            (false, true) => {}
        }
        self.0.push_str(term);
    }

    /// The expression; `0.0` without terms.
    #[must_use]
    pub fn text(self) -> String {
        if self.0.is_empty() { "0.0".to_owned() } else { self.0 }
    }
}

/// The mean of `count` terms whose sum is `sum`.
#[must_use]
pub(crate) fn mean(sum: String, count: usize) -> String {
    if count == 1 { sum } else { format!("({sum})/{count}") }
}
