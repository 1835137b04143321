//! The crates of the workspace: their files, and what their Cargo.toml names.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use super::tokens::{Token, tokens};

/// A crate of the workspace.
pub struct Crate {
    /// Name of its folder; `girderway` for the folder `pipeline`.
    pub name: String,
    /// Its folder.
    pub folder: PathBuf,
    /// Its source files by module path; `[]` is `lib.rs` or `main.rs`. Files of unit tests are left out.
    pub modules: BTreeMap<Vec<String>, Module>,
}

/// A source file.
pub struct Module {
    /// Text as it is.
    pub text: String,
    /// Words and marks of its code.
    pub tokens: Vec<Token>,
}

/// Root of the workspace.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// All crates: folders of `crates/`, and `pipeline`. They are read once.
pub fn all() -> &'static [Crate] {
    static ALL: OnceLock<Vec<Crate>> = OnceLock::new();
    ALL.get_or_init(read_all)
}

fn read_all() -> Vec<Crate> {
    let mut folders: Vec<PathBuf> = entries(&root().join("crates"));
    folders.push(root().join("pipeline"));
    folders.retain(|folder| folder.join("src").is_dir() && folder.join("Cargo.toml").is_file());
    folders.into_iter().map(read).collect()
}

fn read(folder: PathBuf) -> Crate {
    let name = folder
        .file_name()
        .expect("a folder has a name")
        .to_string_lossy();
    let name = if name == "pipeline" {
        "girderway".to_owned()
    } else {
        name.into_owned()
    };
    let mut modules = BTreeMap::new();
    collect(&folder.join("src"), &mut Vec::new(), &mut modules);
    Crate {
        name,
        folder,
        modules,
    }
}

fn collect(folder: &Path, path: &mut Vec<String>, modules: &mut BTreeMap<Vec<String>, Module>) {
    for entry in entries(folder) {
        let stem = entry
            .file_stem()
            .expect("an entry has a name")
            .to_string_lossy()
            .into_owned();
        if stem == "tests" {
            continue;
        }
        path.push(stem.clone());
        if entry.is_dir() {
            collect(&entry, path, modules);
        } else if entry.extension().is_some_and(|ending| ending == "rs") {
            let is_root = matches!(stem.as_str(), "mod" | "lib" | "main");
            let key = path[..path.len() - usize::from(is_root)].to_vec();
            // a crate with a library and a program: the library is the root
            if !(stem == "main" && modules.contains_key(&key)) {
                let text = fs::read_to_string(&entry).expect("a readable source file");
                let tokens = tokens(&text);
                modules.insert(key, Module { text, tokens });
            }
        }
        path.pop();
    }
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let listed = fs::read_dir(folder).expect("a folder of the workspace");
    let mut paths: Vec<PathBuf> = listed
        .map(|entry| entry.expect("a readable folder").path())
        .collect();
    paths.sort();
    paths
}

impl Crate {
    /// Names under `[dependencies]` of its Cargo.toml.
    pub fn dependencies(&self) -> Vec<String> {
        let text =
            fs::read_to_string(self.folder.join("Cargo.toml")).expect("a readable Cargo.toml");
        let mut names = Vec::new();
        let mut inside = false;
        for line in text.lines().map(str::trim) {
            if let Some(section) = line.strip_prefix('[') {
                inside = section.starts_with("dependencies]");
                names.extend(
                    section
                        .strip_prefix("dependencies.")
                        .map(|name| name.trim_end_matches(']').to_owned()),
                );
            } else if inside && !line.starts_with('#') {
                names.extend(
                    line.split(['.', '=', ' '])
                        .next()
                        .filter(|name| !name.is_empty())
                        .map(str::to_owned),
                );
            }
        }
        names
    }
}
