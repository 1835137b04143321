//! Names that Adams View accepts, and parts of function expressions.

use std::collections::BTreeSet;

use adams::ArgumentValue;

/// Largest length of a name, whose comment must fit on a line.
const MAX_LENGTH: usize = 56;

/// `name` reduced to letters, digits and underscores. Of a name of more than 56 characters the middle is left out: its
/// end says what it is.
#[must_use]
pub(crate) fn plain(name: &str) -> String {
    let clean = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let all: String = name.chars().map(clean).collect();
    if all.len() <= MAX_LENGTH {
        return all;
    }
    let end = MAX_LENGTH / 2;
    let head = MAX_LENGTH - end - 1;
    format!("{}_{}", &all[..head], &all[all.len() - end..])
}

/// Makes the names of statements of one kind unique, in any case of their letters, by appending a number to repeated
/// names. The results of a REQUEST have its name.
pub(crate) fn distinct(statements: &mut [adams::Statement]) {
    let mut seen: BTreeSet<(String, String)> = BTreeSet::new();
    for statement in statements {
        let Some(name) = &mut statement.name else {
            continue;
        };
        let mut own = name.clone();
        let mut number = 1;
        while !seen.insert((statement.keyword.clone(), own.to_ascii_lowercase())) {
            number += 1;
            let suffix = format!("_{number}");
            let length = name.len().min(MAX_LENGTH - suffix.len());
            own = format!("{}{suffix}", &name[..length]);
        }
        name.clone_from(&own);
        for argument in &mut statement.arguments {
            if argument.name == "RESULTS_NAME" {
                argument.value = ArgumentValue::Word(own.clone());
            }
        }
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

#[cfg(test)]
mod tests {
    use super::{MAX_LENGTH, distinct, plain};
    use adams::{ArgumentValue, Statement};

    /// Names of more letters than a line of a data set has keep what tells them apart: their ends, or a number.
    #[test]
    fn long_names_and_names_alike_become_distinct_names_that_fit() {
        let truck = "a".repeat(60);
        let name = |what: &str| plain(&format!("{truck}_wheel1_{what}"));
        assert_ne!(name("place"), name("rise"));
        assert!(name("place").ends_with("_wheel1_place"));
        let mut all: Vec<Statement> = (0..200)
            .map(|id| Statement::new("REQUEST", id).named(plain(&"b".repeat(60 + 1))))
            .chain([Statement::new("REQUEST", 300).named("A_1".to_owned())])
            .chain([Statement::new("REQUEST", 301).named("a_1".to_owned())])
            .map(|one| {
                let own = one.name.clone().expect("named");
                one.word("RESULTS_NAME", &own)
            })
            .collect();
        distinct(&mut all);
        let mut names: Vec<String> = all
            .iter()
            .map(|one| one.name.clone().expect("named").to_ascii_lowercase())
            .collect();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), all.len());
        assert!(names.iter().all(|name| name.len() <= MAX_LENGTH));
        for one in &all {
            let own = one.name.clone().expect("named");
            assert_eq!(one.get("RESULTS_NAME"), Some(&ArgumentValue::Word(own)));
        }
    }
}
