//! Names that Adams View accepts, and parts of function expressions.

/// Largest length of a name, whose comment must fit on a line.
const MAX_LENGTH: usize = 56;

/// `name` reduced to letters, digits and underscores, and truncated to 56 characters.
#[must_use]
pub(crate) fn plain(name: &str) -> String {
    let clean = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    name.chars().map(clean).take(MAX_LENGTH).collect()
}

/// Makes the names of statements of one kind unique by appending a number to repeated names.
pub(crate) fn distinct(statements: &mut [adams::Statement]) {
    let mut seen: Vec<(String, String)> = Vec::new();
    for statement in statements {
        let Some(name) = &mut statement.name else {
            continue;
        };
        let mut own = name.clone();
        let mut number = 1;
        while seen
            .iter()
            .any(|(keyword, known)| *keyword == statement.keyword && *known == own)
        {
            number += 1;
            own = format!("{name}_{number}");
        }
        name.clone_from(&own);
        seen.push((statement.keyword.clone(), own));
    }
}

/// A number inside an expression; negative ones in brackets.
#[must_use]
pub(crate) fn number(value: f64) -> String {
    let text = adams::number::write(value);
    if value.is_sign_negative() {
        format!("({text})")
    } else {
        text
    }
}

/// `VARVAL(id)`.
#[must_use]
pub(crate) fn value(id: u32) -> String {
    format!("VARVAL({id})")
}

/// A sum of terms with their signs.
#[derive(Clone, Debug, Default)]
pub(crate) struct TermList(String);

impl TermList {
    /// Adds a term, or subtracts it.
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
        if self.0.is_empty() {
            "0.0".to_owned()
        } else {
            self.0
        }
    }
}

/// The mean of `count` terms whose sum is `sum`.
#[must_use]
pub(crate) fn mean(sum: String, count: usize) -> String {
    if count == 1 {
        sum
    } else {
        format!("({sum})/{count}")
    }
}
