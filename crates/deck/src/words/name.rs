//! Names as Adams View takes them.

/// Longest name: its comment must fit on a line.
const LONGEST: usize = 56;

/// Letters, digits and underscores, not too long.
#[must_use]
pub(crate) fn plain(name: &str) -> String {
    let clean = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    name.chars().map(clean).take(LONGEST).collect()
}

/// Makes the names of one kind of statement differ: later ones get a number.
pub(crate) fn distinct(statements: &mut [adams::Statement]) {
    let mut seen: Vec<(String, String)> = Vec::new();
    for statement in statements {
        let Some(name) = &mut statement.name else { continue };
        let mut own = name.clone();
        let mut number = 1;
        while seen.iter().any(|(keyword, known)| *keyword == statement.keyword && *known == own) {
            number += 1;
            own = format!("{name}_{number}");
        }
        name.clone_from(&own);
        seen.push((statement.keyword.clone(), own));
    }
}
