//! Links of the pages lead to files and headings that exist, and the summary of the book has every page.

use std::fs;
use std::path::{Path, PathBuf};

use super::root;

/// All pages below a folder.
fn pages(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(pages(&path));
        } else if path.extension().is_some_and(|ending| ending == "md") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Lines outside of fenced blocks.
fn prose(text: &str) -> impl Iterator<Item = &str> {
    let mut is_inside = false;
    text.lines().filter(move |line| {
        let is_fence = line.trim_start().starts_with("```");
        is_inside ^= is_fence;
        !is_inside && !is_fence
    })
}

/// The anchors of a page: its headings in lower case, blanks as hyphens, without other marks than these and underscores.
fn anchors(text: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for line in prose(text).filter(|line| line.starts_with('#')) {
        let title = line.trim_start_matches('#').trim().to_lowercase();
        let kept = title
            .chars()
            .filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c));
        let anchor: String = kept.map(|c| if c == ' ' { '-' } else { c }).collect();
        let same = found.iter().filter(|known| **known == anchor).count();
        found.push(if same > 0 {
            format!("{anchor}-{same}")
        } else {
            anchor
        });
    }
    found
}

/// Targets of the links of a page, without those to other hosts.
fn targets(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for line in prose(text) {
        // code spans have no links
        let plain: String = line.split('`').step_by(2).collect();
        for part in plain.split("](").skip(1) {
            let target = part.split([')', ' ']).next().unwrap_or_default();
            if !target.contains("://") && !target.starts_with("mailto:") {
                found.push(target.to_owned());
            }
        }
    }
    found
}

#[test]
fn links_of_the_pages_lead_somewhere() {
    let mut all = pages(&root().join("docs"));
    all.extend(pages(&root().join("examples")));
    for name in [
        "README.md",
        "CONTRIBUTING.md",
        "CHANGELOG.md",
        "crates/python/README.md",
    ] {
        all.push(root().join(name));
    }
    let mut broken = Vec::new();
    let mut count = 0;
    for page in &all {
        let text = fs::read_to_string(page).expect("a page");
        for target in targets(&text) {
            let (file, anchor) = target.split_once('#').unwrap_or((&target, ""));
            let path = if file.is_empty() {
                page.clone()
            } else {
                page.with_file_name("").join(file)
            };
            let has_anchor = || {
                let other = fs::read_to_string(&path).unwrap_or_default();
                anchors(&other).iter().any(|known| known == anchor)
            };
            if !path.exists() || !(anchor.is_empty() || has_anchor()) {
                broken.push(format!("{}: {target}", page.display()));
            }
            count += 1;
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
    assert!(count > 100, "{count} links");
}

#[test]
fn the_summary_has_every_page() {
    let folder = root().join("docs");
    let summary = fs::read_to_string(folder.join("SUMMARY.md")).expect("the summary");
    let known = targets(&summary);
    for page in pages(&folder) {
        let name = page.strip_prefix(&folder).expect("a page of the folder");
        let name = name.to_string_lossy().replace('\\', "/");
        assert!(
            name == "SUMMARY.md" || known.contains(&name),
            "docs/SUMMARY.md lacks {name}"
        );
    }
}
