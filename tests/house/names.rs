//! Public names of a file.

use std::collections::BTreeSet;

use super::tokens::Token;

/// Names of the types and traits that a file makes public to all: `pub struct`, `enum`, `trait`, `type`, `union`.
pub fn public_types(tokens: &[Token]) -> BTreeSet<String> {
    let kinds = ["struct", "enum", "trait", "type", "union"];
    let public = tokens
        .windows(3)
        .filter(|w| w[0] == "pub" && kinds.contains(&w[1].as_str()));
    public.map(|window| window[2].clone()).collect()
}

#[test]
fn types_public_to_all_are_found() {
    let text = "pub struct A; struct B; pub(crate) enum C {} pub enum D {} pub trait E { type F; } pub type G<T> = A;";
    let names: Vec<String> = public_types(&super::tokens::tokens(text))
        .into_iter()
        .collect();
    assert_eq!(names, ["A", "D", "E", "G"]);
}
