//! The generated parts of the book fit the data that they are made from.

use std::path::{Path, PathBuf};

use claims::{Record, pages, programs};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[test]
fn generated_parts_fit_their_data() {
    let pages = pages(&root()).expect("the data are there");
    assert!(!pages.is_empty());
    for page in pages {
        let text = std::fs::read_to_string(root().join(&page.path)).expect("a page");
        assert!(
            text == page.text,
            "{} is not what its data say: cargo run -p claims writes it anew",
            page.path.display()
        );
    }
}

#[test]
fn figures_name_tests_that_are_there() {
    let text = std::fs::read_to_string(root().join("docs/claims.json")).expect("figures");
    let records: Vec<Record> = serde_json::from_str(&text).expect("figures");
    for own in &records {
        let source = std::fs::read_to_string(root().join(&own.file)).expect("a test file");
        let name = own.test.rsplit("::").next().unwrap_or_default();
        assert!(source.contains(&format!("fn {name}(")), "{} has no test {name}", own.file);
        assert!(own.ours.is_finite() && own.known.is_finite(), "{}", own.what);
    }
    let missing: Vec<(String, String)> = programs(&root())
        .expect("folders of tests")
        .into_iter()
        .filter(|(package, test)| {
            !records.iter().any(|own| {
                let at = Path::new(&own.file);
                let krate = format!("crates/{package}/tests/{test}.rs");
                own.file == krate || (package == "girderway" && at.starts_with(format!("tests/{test}")))
            })
        })
        .collect();
    assert!(missing.is_empty(), "cargo run -p claims -- figures was not run since {missing:?} got figures");
}

#[test]
fn data_are_small() {
    let mut folders = vec![root().join("docs")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|own| own == "json") {
                let size = std::fs::metadata(&path).expect("a file").len();
                assert!(size < 100_000, "{} has {size} bytes", path.display());
            }
        }
    }
}
