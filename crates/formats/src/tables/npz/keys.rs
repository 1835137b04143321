//! What tables and curves are called in an archive.

use crate::block::GridBlock;
use crate::tables::set::plain;

/// Names that say something else than a table.
pub(super) const META: [&str; 14] = [
    "name",
    "units",
    "stations",
    "x",
    "z",
    "tables",
    "ids",
    "names",
    "quantity",
    "rail",
    "load_rail",
    "curves",
    "products",
    "expressions",
];

/// Keys under way: each stands once.
#[derive(Default)]
pub(super) struct Keys(Vec<String>);

impl Keys {
    /// A key like `wish` that is free, and reserves it.
    pub fn take(&mut self, wish: &str) -> String {
        let mut key = plain(wish);
        let mut count = 1;
        while META.contains(&key.as_str()) || self.0.iter().any(|known| clash(known, &key)) {
            count += 1;
            key = format!("{}_{count}", plain(wish));
        }
        self.0.push(key.clone());
        key
    }
}

/// Whether the arrays that belong to one key would be called like the other, or like its arrays.
fn clash(a: &str, b: &str) -> bool {
    let belongs = |a: &str, b: &str| {
        b.strip_prefix(a).is_some_and(|end| ["", "_x", "_z", "_ids", "_names", "_terms"].contains(&end))
    };
    belongs(a, b) || belongs(b, a)
}

/// The quantity alone where there is one rail, with its rails where there are several; else the name.
pub(super) fn wish(
    name: &str,
    quantity: Option<GridBlock>,
    rails: &Option<[String; 2]>,
    one_rail: bool,
) -> String {
    match (quantity, rails) {
        (Some(quantity), Some(_)) if one_rail => quantity.to_string(),
        (Some(quantity), Some([rail, load])) if rail == load => format!("{rail}_{quantity}"),
        (Some(quantity), Some([rail, load])) => format!("{rail}_from_{load}_{quantity}"),
        _ => name.to_owned(),
    }
}
