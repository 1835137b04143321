//! The generated parts of the book fit the data that they are made from, and the data fit each other.

use std::path::{Path, PathBuf};

use claims::{LARGEST, MAPS, Maps, Record, Sums, json, maps, pages, programs};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[test]
fn generated_parts_fit_their_data() {
    let pages = pages(&root()).expect("the data are there");
    assert!(!pages.is_empty());
    for page in pages {
        let text = claims::text(&root().join(&page.path)).expect("a page");
        assert!(
            text == page.text,
            "{} is not what its data say: cargo run -p claims writes it anew",
            page.path.display()
        );
    }
}

#[test]
fn figures_name_tests_that_are_there() {
    let records: Vec<Record> = json(&root().join("docs/claims.json")).expect("figures");
    for own in &records {
        let source = claims::text(&root().join(&own.file)).expect("a test file");
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
fn every_file_with_tests_says_what_it_tests() {
    let list = claims::text(&root().join("docs/tests.md")).expect("the page");
    let silent: Vec<&str> =
        list.lines().filter(|line| line.starts_with('`') && line.trim_end().ends_with(".rs`:")).collect();
    assert!(silent.is_empty(), "no `//!` in {silent:?}");
}

#[test]
fn files_that_the_page_of_verification_names_are_there() {
    let page = claims::text(&root().join("docs/verification.md")).expect("the page");
    let quoted = page.split('`').skip(1).step_by(2).filter(|own| own.contains('/') && !own.contains(' '));
    let mut checked = 0;
    for own in quoted.filter(|own| own.ends_with(".rs")) {
        assert!(root().join(own).is_file(), "docs/verification.md names {own}");
        checked += 1;
    }
    assert!(checked > 100, "{checked}");
}

/// Bytes that a file of data may have.
const MOST: usize = 100_000;

#[test]
fn data_and_charts_of_studies_are_small() {
    let mut folders = vec![root().join("docs")];
    while let Some(folder) = folders.pop() {
        for path in claims::folder(&folder).expect("a folder") {
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let ending = path.extension().unwrap_or_default().to_string_lossy().into_owned();
            let most = match ending.as_str() {
                "json" => MOST,
                "svg" if folder.ends_with("studies") => LARGEST,
                _ => continue,
            };
            let size = std::fs::metadata(&path).expect("a file").len();
            assert!(size < most as u64, "{} has {size} bytes", path.display());
        }
    }
}

#[test]
fn maps_have_no_point_that_is_silently_wrong_and_refuse_at_most_a_tenth() {
    let kept: Maps = json(&root().join(MAPS)).expect("maps");
    let ours = Sums::of(&kept.maps, true);
    assert!(ours.points >= 5000, "{ours:?}");
    assert_eq!(ours.silent + ours.diverging, 0, "{ours:?}");
    assert!(10 * ours.refused <= ours.points, "{ours:?}");
    assert_eq!(ours.right + ours.warned + ours.refused, ours.points, "{ours:?}");
    for own in kept.maps.iter().flat_map(|map| &map.methods) {
        let told: usize = own.messages.iter().map(|own| own.points).sum();
        assert_eq!(told, own.points("refused"), "{}: every refusal has its message", own.method);
    }
    // the methods beside ours do fail, or the maps would show nothing
    assert!(Sums::of(&kept.maps, false).silent > 100);
}

#[test]
fn what_is_kept_of_maps_is_what_the_study_wrote() {
    let folder = std::env::temp_dir().join(format!("girderway-maps-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let text = r#"{ "format": "girderway-stability/1", "maps": [{ "name": "m", "title": "t", "note": "n",
        "found": [{ "what": "w", "value": 10.932689616568709 }],
        "methods": [{ "method": "a", "is_girderway": true, "counts": { "right": 2, "refused": 1 },
                      "messages": [{ "message": "no", "points": 1 }] }] }] }"#;
    std::fs::write(folder.join("stability.json"), text).expect("a file");
    let kept: Maps = serde_json::from_str(&maps(&folder, "make it").expect("maps")).expect("maps");
    std::fs::remove_dir_all(&folder).expect("ours");
    assert_eq!((kept.command.as_str(), kept.maps[0].found[0].value), ("make it", 10.9327));
    let sums = Sums::of(&kept.maps, true);
    assert_eq!((sums.points, sums.right, sums.refused), (3, 2, 1));
}
