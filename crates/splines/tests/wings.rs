//! The order of the wings of this crate, as the top of `lib.rs` states it.

use std::path::Path;

/// Wings from the bottom up; the first four are single files.
const WINGS: [&str; 9] =
    ["vector", "probe", "error", "compliance", "curve", "rail", "surface", "table", "quality"];

fn texts(of: &Path, out: &mut Vec<String>) {
    if of.is_dir() {
        for entry in std::fs::read_dir(of).expect("a folder of the crate") {
            texts(&entry.expect("an entry").path(), out);
        }
    } else {
        out.push(std::fs::read_to_string(of).expect("a source file"));
    }
}

#[test]
fn no_wing_imports_a_later_one() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut imports = 0;
    for (place, wing) in WINGS.iter().enumerate() {
        let mut all = Vec::new();
        let folder = src.join(wing);
        texts(&if folder.is_dir() { folder } else { src.join(format!("{wing}.rs")) }, &mut all);
        let code =
            all.iter().flat_map(|text| text.lines()).filter(|line| !line.trim_start().starts_with("//"));
        for line in code {
            for path in line.split("crate::").skip(1) {
                let name: String = path.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                let other = WINGS.iter().position(|other| *other == name);
                assert!(
                    other.is_some_and(|other| other <= place),
                    "{wing} imports {name}, which is later or no wing: {line}"
                );
                imports += 1;
            }
        }
    }
    assert!(imports > 40, "the files import each other");
}
