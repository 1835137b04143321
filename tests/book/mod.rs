//! The documents speak of what is there: paths, names and commands on pages exist, and pages that can be run are run.

mod commands;
mod links;
mod names;
mod page;

use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

#[test]
fn every_path_in_the_architecture_exists() {
    let text =
        std::fs::read_to_string(root().join("docs/architecture.md")).expect("docs/architecture.md");
    let mut checked = 0;
    for quoted in text.split('`').skip(1).step_by(2) {
        let looks_like_a_path = quoted.contains('/') && !quoted.contains([' ', '<', '*', '{', ':']);
        if looks_like_a_path && !quoted.starts_with("girderway-") {
            assert!(
                root().join(quoted).exists(),
                "docs/architecture.md names {quoted}, which does not exist"
            );
            checked += 1;
        }
    }
    assert!(checked > 20, "the architecture names its files");
}

#[test]
fn documents_are_ascii() {
    let mut folders = vec![root().join("docs"), root().join("examples")];
    let mut pages = vec![
        root().join("README.md"),
        root().join("CONTRIBUTING.md"),
        root().join("CHANGELOG.md"),
    ];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "md") {
                pages.push(path);
            }
        }
    }
    assert!(pages.len() >= 7);
    for path in pages {
        let text = std::fs::read_to_string(&path).expect("text");
        assert!(text.is_ascii(), "{} is not ASCII", path.display());
    }
}
