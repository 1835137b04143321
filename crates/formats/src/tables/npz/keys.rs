//! Names of the arrays of tables and curves in an archive.

use crate::grid::GridBlock;
use crate::tables::set::adams_name;

/// Reserved names of arrays that are not tables.
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

/// Keys that are already in use.
#[derive(Default)]
pub(super) struct Keys(Vec<String>);

impl Keys {
    /// Reserves and returns an unused key: `preferred`, or `preferred` with a number appended.
    pub fn take(&mut self, preferred: &str) -> String {
        let mut key = adams_name(preferred);
        let mut count = 1;
        while META.contains(&key.as_str()) || self.0.iter().any(|known| clash(known, &key)) {
            count += 1;
            key = format!("{}_{count}", adams_name(preferred));
        }
        self.0.push(key.clone());
        key
    }
}

/// Whether the name of an array of one key would equal the other key or the name of one of its arrays.
fn clash(a: &str, b: &str) -> bool {
    let belongs = |a: &str, b: &str| {
        b.strip_prefix(a)
            .is_some_and(|end| ["", "_x", "_z", "_ids", "_names", "_terms"].contains(&end))
    };
    belongs(a, b) || belongs(b, a)
}

/// The preferred key of a table: its quantity if there is one rail, quantity and rails if there are several, and its
/// name if these are unknown.
pub(super) fn preferred(
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
