//! Which file of a crate imports which: `use` lines and paths from `crate::` and `super::`, with re-exports followed
//! to where a name is defined.

use std::collections::{BTreeMap, BTreeSet};

use super::crates::Crate;
use super::tokens::Token;

/// A module of a crate by its path from the root.
pub type Path = Vec<String>;

/// For each file the files it imports. The root of the crate is never one of them: it only collects names.
pub type Arrows = BTreeMap<Path, BTreeSet<Path>>;

/// One leaf of a `use` tree.
struct Use {
    /// Segments as written, the last without `as name`.
    path: Path,
    /// Name under which it is known here.
    name: String,
    /// Whether it is `pub use`, in any form.
    public: bool,
}

/// Imports between the files of a crate.
pub fn arrows(krate: &Crate) -> Arrows {
    let mut exports: BTreeMap<(Path, String), Path> = BTreeMap::new();
    let uses: BTreeMap<&Path, Vec<Use>> = krate
        .modules
        .iter()
        .map(|(module, file)| (module, uses(&file.tokens)))
        .collect();
    for (module, uses) in &uses {
        for leaf in uses.iter().filter(|leaf| leaf.public) {
            let path = absolute(module, &leaf.path)
                .unwrap_or_else(|| [module.as_slice(), &leaf.path].concat());
            exports.insert(((*module).clone(), leaf.name.clone()), path);
        }
    }
    let mut arrows = Arrows::new();
    for (module, file) in &krate.modules {
        let written = uses[module]
            .iter()
            .map(|leaf| leaf.path.clone())
            .chain(paths(&file.tokens));
        for path in written.filter_map(|path| absolute(module, &path)) {
            let target = file_of(krate, &defined(krate, &exports, path));
            if !target.is_empty() && target != *module {
                arrows.entry(module.clone()).or_default().insert(target);
            }
        }
    }
    arrows
}

/// The same between top-level modules.
pub fn top_level(arrows: &Arrows) -> Arrows {
    let mut between = Arrows::new();
    for (from, targets) in arrows.iter().filter(|(from, _)| !from.is_empty()) {
        for to in targets.iter().filter(|to| to[0] != from[0]) {
            between
                .entry(from[..1].to_vec())
                .or_default()
                .insert(to[..1].to_vec());
        }
    }
    between
}

/// A path from the root of the crate, of one that begins with `crate`, `self` or `super`.
fn absolute(module: &Path, path: &[String]) -> Option<Path> {
    match path.first()?.as_str() {
        "crate" => Some(path[1..].to_vec()),
        "self" => Some([module.as_slice(), &path[1..]].concat()),
        "super" => {
            let ups = path
                .iter()
                .take_while(|segment| *segment == "super")
                .count();
            let base = &module[..module.len().saturating_sub(ups)];
            Some([base, &path[ups..]].concat())
        }
        _ => None,
    }
}

/// The longest beginning of a path that is a file.
fn file_of(krate: &Crate, path: &[String]) -> Path {
    let mut length = path.len();
    while length > 0 && !krate.modules.contains_key(&path[..length]) {
        length -= 1;
    }
    path[..length].to_vec()
}

/// A path with re-exports followed; six are more than any name here passes through.
fn defined(krate: &Crate, exports: &BTreeMap<(Path, String), Path>, mut path: Path) -> Path {
    for _ in 0..6 {
        let module = file_of(krate, &path);
        let Some(name) = path.get(module.len()) else {
            break;
        };
        let Some(origin) = exports.get(&(module.clone(), name.clone())) else {
            break;
        };
        let next = [origin.as_slice(), &path[module.len() + 1..]].concat();
        if next == path {
            break;
        }
        path = next;
    }
    path
}

/// Leaves of all `use` lines.
fn uses(tokens: &[Token]) -> Vec<Use> {
    let mut leaves = Vec::new();
    for (i, token) in tokens.iter().enumerate() {
        let begins =
            i == 0 || matches!(tokens[i - 1].as_str(), ";" | "{" | "}" | "]" | "pub" | ")");
        if token != "use" || !begins {
            continue;
        }
        let public = i > 0 && matches!(tokens[i - 1].as_str(), "pub" | ")");
        let length = tokens[i..]
            .iter()
            .position(|token| token == ";")
            .unwrap_or(tokens.len() - i);
        expand(&tokens[i + 1..i + length], &[], public, &mut leaves);
    }
    leaves
}

/// `a::{b, c::{d as e}}` as leaves.
fn expand(tree: &[Token], before: &[String], public: bool, leaves: &mut Vec<Use>) {
    let group = tree.iter().position(|token| token == "{");
    let head = &tree[..group.unwrap_or(tree.len())];
    let mut words = head.iter().filter(|token| *token != "::").cloned();
    let path: Path = before
        .iter()
        .cloned()
        .chain(words.by_ref().take_while(|word| word != "as"))
        .collect();
    let Some(open) = group else {
        if let Some(last) = path.last().cloned() {
            let name = words.next().unwrap_or(last);
            leaves.push(Use { path, name, public });
        }
        return;
    };
    let close = tree
        .iter()
        .rposition(|token| token == "}")
        .unwrap_or(tree.len());
    let (mut start, mut depth) = (open + 1, 0);
    for i in open + 1..=close.min(tree.len() - 1) {
        match tree[i].as_str() {
            "{" => depth += 1,
            "}" if i < close => depth -= 1,
            "," if depth > 0 => {}
            "," | "}" => {
                if start < i {
                    expand(&tree[start..i], &path, public, leaves);
                }
                start = i + 1;
            }
            _ => {}
        }
    }
}

/// Paths in the code that begin with `crate::` or `super::`, those of `use` lines among them.
fn paths(tokens: &[Token]) -> Vec<Path> {
    let mut found = Vec::new();
    let mut i = 0;
    while i < tokens.len() {
        if !matches!(tokens[i].as_str(), "crate" | "super") {
            i += 1;
            continue;
        }
        let mut path = vec![tokens[i].clone()];
        while tokens.get(i + 1).is_some_and(|token| token == "::")
            && tokens.get(i + 2).is_some_and(|token| is_word(token))
        {
            path.push(tokens[i + 2].clone());
            i += 2;
        }
        i += 1;
        if path.len() > 1 {
            found.push(path);
        }
    }
    found
}

fn is_word(token: &str) -> bool {
    token.starts_with(|c: char| c == '_' || c.is_alphanumeric())
}

/// Sets of modules that import each other in a loop (Tarjan's strongly connected components of two and more).
pub fn circles(arrows: &Arrows) -> Vec<BTreeSet<Path>> {
    let mut search = Search {
        arrows,
        number: BTreeMap::new(),
        low: BTreeMap::new(),
        open: Vec::new(),
        found: Vec::new(),
    };
    for module in arrows.keys() {
        if !search.number.contains_key(module) {
            search.visit(module);
        }
    }
    search.found
}

/// Tarjan's depth-first search: modules are numbered as they are met; `low` is the lowest number that can be reached
/// from one, `open` those whose component is not complete.
struct Search<'a> {
    arrows: &'a Arrows,
    number: BTreeMap<&'a Path, usize>,
    low: BTreeMap<&'a Path, usize>,
    open: Vec<&'a Path>,
    found: Vec<BTreeSet<Path>>,
}

impl<'a> Search<'a> {
    fn visit(&mut self, module: &'a Path) {
        let number = self.number.len();
        self.number.insert(module, number);
        self.low.insert(module, number);
        self.open.push(module);
        for next in self.arrows.get(module).into_iter().flatten() {
            if !self.number.contains_key(next) {
                self.visit(next);
                self.low
                    .insert(module, self.low[module].min(self.low[next]));
            } else if self.open.contains(&next) {
                self.low
                    .insert(module, self.low[module].min(self.number[next]));
            }
        }
        if self.low[module] == number {
            let from = self
                .open
                .iter()
                .position(|open| *open == module)
                .expect("a module is open while it is visited");
            let circle: BTreeSet<Path> = self.open.drain(from..).cloned().collect();
            if circle.len() > 1 {
                self.found.push(circle);
            }
        }
    }
}

#[test]
fn a_tree_of_imports_is_taken_apart() {
    let text =
        "pub use crate::a::{self, b::{C, D as E}, f}; use super::g::H; fn x() { crate::y::z(); }";
    let tokens = super::tokens::tokens(text);
    let leaves: Vec<String> = uses(&tokens)
        .iter()
        .map(|l| format!("{}={}", l.path.join("::"), l.name))
        .collect();
    assert_eq!(
        leaves,
        [
            "crate::a::self=self",
            "crate::a::b::C=C",
            "crate::a::b::D=E",
            "crate::a::f=f",
            "super::g::H=H"
        ]
    );
    assert_eq!(
        paths(&tokens).last().expect("a path").join("::"),
        "crate::y::z"
    );
}

#[test]
fn a_circle_is_found_and_a_chain_is_none() {
    let path = |name: &str| vec![name.to_owned()];
    let arrow = |from: &str, to: &str| (path(from), BTreeSet::from([path(to)]));
    let chain = Arrows::from([arrow("a", "b"), arrow("b", "c")]);
    assert!(circles(&chain).is_empty());
    let circle = Arrows::from([arrow("a", "b"), arrow("b", "c"), arrow("c", "b")]);
    assert_eq!(circles(&circle), [BTreeSet::from([path("b"), path("c")])]);
}
