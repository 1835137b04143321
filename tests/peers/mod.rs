//! The table of other codes on the page about performance is that of the stored measurements. Needs `python3`.

use std::path::Path;
use std::process::Command;

#[test]
fn the_table_of_other_codes_follows_its_data() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let run = Command::new("python3")
        .args(["fea/book_tables.py", "peers", "docs/peers.json"])
        .current_dir(&root)
        .output()
        .expect("python3 starts");
    assert!(
        run.status.success(),
        "{}",
        String::from_utf8_lossy(&run.stderr)
    );
    let page = std::fs::read_to_string(root.join("docs/performance.md")).expect("the page");
    let text = String::from_utf8(run.stdout).expect("UTF-8");
    let rows: Vec<&str> = text.lines().filter(|line| line.starts_with('|')).collect();
    // two heads, the grid of the girder, and six crossings by two errors
    assert_eq!(rows.len(), 15, "{text}");
    for row in rows {
        assert!(
            page.lines().any(|line| line == row),
            "docs/performance.md lacks {row}"
        );
    }
}
