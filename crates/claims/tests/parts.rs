//! Parts are made from data, and only from data that are there.

use std::fs;
use std::path::Path;

use claims::{Error, charts, pages};
use tempfile::TempDir;

const SHEET: &str = "n,steps,stages,events,us a step,residual\n8,22,110,0,20.96,2.7e-7\n";

/// A repository with one page, and the sheet of wheels.
fn book(page: &str, sheet: &str) -> TempDir {
    let root = tempfile::tempdir().expect("a folder");
    let docs = root.path().join("docs");
    fs::create_dir(&docs).expect("a folder");
    fs::write(docs.join("page.md"), page).expect("a page");
    fs::write(docs.join("wheels.csv"), sheet).expect("a sheet");
    fs::write(docs.join("plain.md"), "nothing generated").expect("a page");
    root
}

#[test]
fn a_part_is_made_from_its_data_and_the_rest_of_the_page_is_kept() {
    let page = "before\n\n<!-- generated: wheels -->\nold\n<!-- end -->\n\nafter\n";
    let made = |sheet: &str| {
        let root = book(page, sheet);
        let pages = pages(root.path()).expect("pages");
        assert_eq!(pages.len(), 1, "pages without parts are no matter");
        assert_eq!(pages[0].path, Path::new("docs/page.md"));
        pages[0].text.clone()
    };
    let text = made(SHEET);
    assert!(text.starts_with("before\n\n<!-- generated: wheels -->\n\n| wheels |"), "{text}");
    assert!(text.contains("\n| 8 | 22 | 5 | 21.0 us | 3e-7 |\n"), "{text}");
    assert!(text.ends_with("<!-- end -->\n\nafter\n") && !text.contains("old"), "{text}");
    // other data, another page
    assert_ne!(text, made(&SHEET.replace("20.96", "40")));
    // what was made is made again
    let root = book(&text, SHEET);
    assert_eq!(pages(root.path()).expect("pages")[0].text, text);
}

#[test]
fn parts_that_cannot_be_made_are_refused() {
    let error = |page: &str, sheet: &str| pages(book(page, sheet).path()).expect_err("refused");
    let part = "<!-- generated: wheels --><!-- end -->";
    assert!(
        matches!(error("<!-- generated: nothing --><!-- end -->", SHEET), Error::Part(_, name) if name == "nothing")
    );
    assert!(matches!(error("<!-- generated: wheels -->", SHEET), Error::Open(_, name) if name == "wheels"));
    assert!(matches!(error(part, "n,steps\n1,2\n"), Error::File(path, _) if path.ends_with("wheels.csv")));
    assert!(
        matches!(error("<!-- generated: frames --><!-- end -->", SHEET), Error::File(path, _) if path.ends_with("frames.csv"))
    );
    assert!(matches!(error("<!-- generated: studies-dearer none --><!-- end -->", SHEET), Error::File(..)));
}

#[test]
fn charts_of_a_study_are_taken_over_unless_they_are_too_large() {
    let folder = tempfile::tempdir().expect("a folder");
    let plots = folder.path().join("plots");
    fs::create_dir(&plots).expect("a folder");
    fs::write(plots.join("methods-time.svg"), "<svg/>").expect("a chart");
    let found = charts(folder.path(), "bogie").expect("charts");
    let wanted = [
        ("bogie-foundations.svg".to_owned(), None),
        ("bogie-methods.svg".to_owned(), Some("<svg/>".to_owned())),
    ];
    assert_eq!(found, wanted);
    fs::write(plots.join("foundations-time.svg"), " ".repeat(claims::LARGEST + 1)).expect("a chart");
    assert!(matches!(charts(folder.path(), "bogie"), Err(Error::File(..))));
}
