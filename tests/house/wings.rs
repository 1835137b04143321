//! The wings of a crate, lowest first, as its `lib.rs` says them.

use std::collections::BTreeSet;

use super::crates::Crate;

const LINE: &str = "//! Wings, lowest first:";

/// Top-level modules of a crate in the order of what may import what.
pub struct Wings(Vec<String>);

impl Wings {
    /// The order in `lib.rs`: a line of its comment that begins with `Wings, lowest first:`, up to the end of the
    /// sentence or a line without a comma at its end.
    pub fn of(krate: &Crate) -> Option<Self> {
        Self::read(&krate.modules.get(&Vec::new())?.text)
    }

    fn read(text: &str) -> Option<Self> {
        let mut lines = text.lines().skip_while(|line| !line.starts_with(LINE));
        let mut list = lines.next()?.strip_prefix(LINE)?.trim().to_owned();
        while list.ends_with(',') {
            list.push_str(lines.next()?.trim_start_matches("//!").trim());
        }
        let names = list.split('.').next().unwrap_or_default().split(',');
        let names = names.map(|name| name.trim().trim_matches(['`', '[', ']']).to_owned());
        Some(Wings(names.filter(|name| !name.is_empty()).collect()))
    }

    /// Height of the wing a module belongs to; `error` is the lowest, the root the highest.
    pub fn height(&self, module: &[String]) -> usize {
        let Some(top) = module.first() else {
            return usize::MAX;
        };
        match self.0.iter().position(|wing| wing == top) {
            Some(place) => place + 1,
            None if top == "error" => 0,
            None => usize::MAX - 1,
        }
    }

    /// Top-level modules that the line does not name.
    pub fn missing(&self, krate: &Crate) -> Vec<String> {
        let listed = |name: &String| name == "error" || self.0.contains(name);
        top_level(krate)
            .into_iter()
            .filter(|name| !listed(name))
            .collect()
    }

    /// Wings that are no module.
    pub fn absent(&self, krate: &Crate) -> Vec<String> {
        let modules = top_level(krate);
        self.0
            .iter()
            .filter(|name| !modules.contains(*name))
            .cloned()
            .collect()
    }
}

fn top_level(krate: &Crate) -> BTreeSet<String> {
    krate
        .modules
        .keys()
        .filter_map(|module| module.first().cloned())
        .collect()
}

#[test]
fn the_line_of_wings_is_read() {
    let text = "//! A crate.\n//!\n//! Wings, lowest first: scene, mechanics,\n//! contact, run. More.\nmod scene;\n";
    let wings = Wings::read(text).expect("the line is there");
    assert_eq!(wings.0, ["scene", "mechanics", "contact", "run"]);
    let height =
        |path: &[&str]| wings.height(&path.iter().map(|&s| s.to_owned()).collect::<Vec<_>>());
    assert!(height(&["error"]) < height(&["scene", "body"]));
    assert!(height(&["scene", "body"]) < height(&["contact"]));
    assert!(height(&["run"]) < height(&[]));
    assert!(Wings::read("//! Without.").is_none());
}
