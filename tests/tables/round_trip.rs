//! What is written is read back, bit for bit, in every format and through all of them.

use formats::tables::{TableFormat, TableSet, expand, read, write};

use super::{
    Dice, ENDINGS, bits, bogie_grid, bytes, folder, girderway, random_factored, random_set, told,
};

fn back(set: &TableSet, ending: &str) -> TableSet {
    let name = format!("bridge.{ending}");
    let bytes = write(set, TableFormat::of(&name).expect("a format")).expect("writable");
    read(&name, &bytes, None).unwrap_or_else(|wrong| panic!("{ending}: {wrong:?}"))
}

#[test]
fn tables_of_any_doubles_read_back_equal_in_every_format() {
    let mut dice = Dice::new(11);
    for _ in 0..60 {
        for set in [random_set(&mut dice), random_factored(&mut dice)] {
            for ending in ENDINGS {
                let found = back(&set, ending);
                assert_eq!(bits(&found), bits(&set), "{ending}");
                assert_eq!(found, set, "{ending}");
            }
        }
    }
}

#[test]
fn a_walk_through_all_formats_changes_no_byte() {
    let mut dice = Dice::new(12);
    for set in [random_set(&mut dice), random_factored(&mut dice)] {
        let walked = ENDINGS
            .into_iter()
            .fold(set.clone(), |set, ending| back(&set, ending));
        for ending in ENDINGS {
            let format = TableFormat::of(ending)
                .or_else(|_| TableFormat::of(&format!("a.{ending}")))
                .expect("a format");
            let [walked, direct] = [&walked, &set].map(|set| write(set, format).expect("tables"));
            assert_eq!(walked, direct, "{ending}");
        }
    }
}

#[test]
fn text_files_are_ascii_in_short_lines() {
    let mut dice = Dice::new(13);
    for set in [random_set(&mut dice), random_factored(&mut dice)] {
        for name in ["a.adm", "a.cmd"] {
            let bytes = write(&set, TableFormat::of(name).expect("a format")).expect("writable");
            let text = String::from_utf8(bytes).expect("text");
            assert!(text.is_ascii());
            for line in text.lines() {
                assert!(line.len() <= 79, "{name}: {line}");
            }
        }
    }
}

/// All directions of a girder whose rail lies above its axis, with their couplings.
#[test]
fn the_program_converts_a_grid_through_all_formats_to_the_same_bytes() {
    let folder = folder();
    bogie_grid(folder.path());
    for form in ["table", "factored"] {
        let mut from = "grid.json".to_owned();
        let mut first = None;
        for ending in ["npz", "json", "npz", "csv", "cmd", "adm"] {
            let to = format!("bridge_flex.{ending}");
            let mut arguments = vec!["splines", &from, "-o", &to];
            if from == "grid.json" {
                arguments.extend(["--form", form]);
            }
            let run = girderway(folder.path(), &arguments);
            assert_eq!(run.status.code(), Some(0), "{}", told(&run));
            if ending == "npz" {
                let bytes = bytes(&folder.path().join(&to));
                assert_eq!(first.get_or_insert_with(|| bytes.clone()), &bytes);
            }
            from = to;
        }
        let run = girderway(
            folder.path(),
            &["splines", "grid.json", "--form", form, "-o", "direct.adm"],
        );
        assert_eq!(run.status.code(), Some(0), "{}", told(&run));
        let [direct, walked] =
            ["direct.adm", "bridge_flex.adm"].map(|name| bytes(&folder.path().join(name)));
        assert_eq!(direct, walked, "{form}");
    }
}

#[test]
fn rails_and_names_of_any_letters_are_kept_where_a_format_has_room() {
    let mut dice = Dice::new(14);
    let mut set = random_set(&mut dice);
    for (k, table) in set.tables.iter_mut().enumerate() {
        table.name = format!("\"gr\u{fc}n\", {k}; x");
        table.rails = Some([format!("rail {k}"), "north, \"south\"".to_owned()]);
    }
    set.name = "halle n\u{b0} 7, \"ost\"".to_owned();
    for ending in ["json", "npz"] {
        assert_eq!(back(&set, ending), set);
    }
    let names: Vec<String> = set.tables.iter().map(|table| table.name.clone()).collect();
    let found = back(&set, "csv");
    assert_eq!(
        found
            .tables
            .iter()
            .map(|table| table.name.clone())
            .collect::<Vec<_>>(),
        names
    );
    for ending in ["adm", "cmd"] {
        assert_eq!(bits(&back(&set, ending)), bits(&set));
    }
}

#[test]
fn a_plain_set_expands_to_itself() {
    let set = random_set(&mut Dice::new(15));
    assert_eq!(expand(&set), set);
}

/// `--check` tells the same of a grid's tables in every format.
#[test]
fn a_check_finds_the_same_in_every_format() {
    let folder = folder();
    bogie_grid(folder.path());
    let mut first: Option<String> = None;
    for ending in ENDINGS {
        let name = format!("bridge.{ending}");
        for arguments in [
            &["splines", "grid.json", "-o", &name][..],
            &["splines", &name, "--check", "--json"],
        ] {
            let run = girderway(folder.path(), arguments);
            assert_eq!(run.status.code(), Some(0), "{}", told(&run));
            if arguments.contains(&"--check") {
                let found: serde_json::Value = serde_json::from_slice(&run.stdout).expect("JSON");
                let tables = found["tables"].as_array().expect("a list");
                assert_eq!(tables.len(), 6);
                let symmetry: String = tables
                    .iter()
                    .map(|table| table["readings"].to_string())
                    .collect();
                assert_eq!(
                    first.get_or_insert_with(|| symmetry.clone()),
                    &symmetry,
                    "{ending}"
                );
            }
        }
    }
    assert!(first.is_some_and(|text| text.contains("akispl")));
}
