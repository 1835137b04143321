//! Names that a file assigns to its items, and references to these names.

use super::fault::{Fault, Faults, nearest};
use super::place::Place;

/// The names of items with their indices, for [`resolve`].
pub fn names<T>(all: &[T], name: impl Fn(&T) -> &str) -> Vec<(&str, usize)> {
    all.iter()
        .enumerate()
        .map(|(index, item)| (name(item), index))
        .collect()
}

/// Index of the item with that name. An unknown name is a fault that lists the known names. `what` is the kind of
/// item, such as "body".
pub fn resolve(
    name: &str,
    known: &[(&str, usize)],
    what: &str,
    place: &Place<'_>,
    faults: &mut Faults,
) -> Option<usize> {
    let found = known
        .iter()
        .find(|(word, _)| *word == name)
        .map(|(_, index)| *index);
    if found.is_none() {
        let words: Vec<&str> = known.iter().map(|(word, _)| *word).collect();
        let mut hint = if words.is_empty() {
            "the file has none".to_owned()
        } else {
            format!("known: {}", words.join(", "))
        };
        if let Some(near) = nearest(name, &words) {
            hint = format!("did you mean \"{near}\"? {hint}");
        }
        faults.add(
            Fault::new(place, format!("must be the name of a {what}"))
                .got(format!("\"{name}\""))
                .hint(hint)
                .of_names(),
        );
    }
    found
}

/// Checks that a name consists of letters, digits, spaces, `_` and `-`, because names become parts of column and file
/// names.
pub fn check_name(name: &str, place: &Place<'_>, faults: &mut Faults) {
    let fits = name
        .chars()
        .all(|c| c.is_alphanumeric() || matches!(c, '_' | '-' | ' '));
    if name.trim() != name || name.is_empty() || !fits {
        let fault = Fault::new(
            place,
            "must be a name of letters, digits, spaces, `_` and `-`",
        )
        .got(format!("{name:?}"))
        .of_value();
        faults.add(fault.hint("names become parts of column and file names"));
    }
}

/// Checks that a name that may have any other characters has no control characters, which a terminal would obey, and does
/// not begin with a character by which a spreadsheet takes a cell of a table for a formula.
pub fn check_free_name(name: &str, place: &Place<'_>, faults: &mut Faults) {
    if let Some(fault) = fault_of_free_name(name, place) {
        faults.add(fault);
    }
}

/// [`check_free_name`] of the key of an object.
pub fn check_free_key(name: &str, place: &Place<'_>, faults: &mut Faults) {
    if let Some(fault) = fault_of_free_name(name, place) {
        faults.add(fault.at_key());
    }
}

fn fault_of_free_name(name: &str, place: &Place<'_>) -> Option<Fault> {
    if !name.contains(char::is_control) && !name.starts_with(['=', '+', '-', '@']) {
        return None;
    }
    let expected =
        "must be a name without control characters that does not begin with `=`, `+`, `-` or `@`";
    let fault = Fault::new(place, expected)
        .got(format!("{name:?}"))
        .of_value();
    Some(fault.hint("names become cells of tables, which a spreadsheet would take for formulas"))
}
