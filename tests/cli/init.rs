//! `girderway init`: what it writes runs, and nothing is overwritten.

use std::fs;

use super::{example, folder, girderway, json, text};

const STARTERS: [(&str, &str); 4] = [
    ("bogie", "bogie"),
    ("crane", "bridge_crane"),
    ("girderway", "mill_girderway"),
    ("runway", "runway"),
];

#[test]
fn starter_files_are_those_of_the_examples() {
    for (word, origin) in STARTERS {
        let folder = folder();
        let run = girderway(&folder, &["init", word, "deep/mine", "--json"]);
        assert!(run.status.success(), "{}", text(&run.stderr));
        let told = json(&run.stdout);
        assert_eq!(told["scene"], "deep/mine/scene.json");
        let files = told["files"].as_array().expect("a list of files");
        let count = |path: &str| {
            fs::read_dir(folder.path().join(path))
                .expect("a folder")
                .count()
        };
        // the schemas stand in a folder of their own
        assert_eq!(
            count("deep/mine") - 1 + count("deep/mine/schema"),
            files.len(),
            "{word}"
        );
        for file in files {
            let file = file.as_str().expect("a name");
            let name = file.strip_prefix("deep/mine/").expect("in the folder");
            let own = fs::read(folder.path().join(file)).expect("written");
            if let Some(schema) = name.strip_prefix("schema/") {
                let format = schema.strip_suffix(".json").expect("a JSON file");
                assert_eq!(
                    own,
                    girderway(&folder, &["schema", format]).stdout,
                    "{file}"
                );
                continue;
            }
            let example = fs::read(example(origin).join(name)).expect("an example");
            if !name.ends_with(".json") {
                assert_eq!(own, example, "{file}");
                continue;
            }
            let mut own = json(&own);
            let schema = own
                .as_object_mut()
                .and_then(|own| own.remove("$schema"))
                .expect("its schema");
            let schema = schema.as_str().expect("a path");
            assert!(
                folder.path().join("deep/mine").join(schema).exists(),
                "{schema}"
            );
            assert_eq!(own, json(&example), "{file}");
        }
        // with the static design and the sweep of the example, where it has one
        for other in ["design.json", "sweep.json"] {
            let has_one = files
                .iter()
                .any(|file| *file == format!("deep/mine/{other}"));
            assert_eq!(
                has_one,
                example(origin).join(other).exists(),
                "{word}: {other}"
            );
        }
    }
}

#[test]
fn starter_files_run_where_they_are() {
    let folder = folder();
    for word in ["bogie", "girderway"] {
        let run = girderway(&folder, &["init", word, word]);
        assert!(run.status.success(), "{}", text(&run.stderr));
        let scene = format!("{word}/scene.json");
        let others = ["design", "sweep"].into_iter().filter(|other| {
            let name = format!("{other}.json");
            STARTERS
                .iter()
                .any(|(own, origin)| *own == word && example(origin).join(&name).exists())
        });
        let others: String = others
            .map(|other| format!("      girderway {other} {word}/{other}.json\n"))
            .collect();
        assert!(
            text(&run.stderr).ends_with(&format!("next: girderway run {scene}\n{others}")),
            "{}",
            text(&run.stderr)
        );
        let run = girderway(&folder, &["run", &scene, "-o", "out", "--quiet"]);
        assert!(run.status.success(), "{}", text(&run.stderr));
    }
    let run = girderway(
        &folder,
        &[
            "design",
            "girderway/design.json",
            "-o",
            "designed",
            "--quiet",
        ],
    );
    assert!(run.status.success(), "{}", text(&run.stderr));
    // that of the crane runs for seconds elsewhere: here its building stands
    assert!(girderway(&folder, &["init", "crane"]).status.success());
    let solved = girderway(&folder, &["fea", "aisle.json", "-o", "grid.json"]);
    assert!(solved.status.success(), "{}", text(&solved.stderr));
}

#[test]
fn nothing_is_overwritten() {
    let folder = folder();
    fs::write(folder.path().join("spec.json"), "mine").expect("a file");
    let run = girderway(&folder, &["init", "bogie"]);
    assert_eq!(run.status.code(), Some(2));
    let told = "spec.json: exists already  hint: nothing is overwritten: name another folder, or move the file\n";
    assert_eq!(text(&run.stderr), told);
    assert_eq!(
        fs::read(folder.path().join("spec.json")).expect("still there"),
        b"mine"
    );
    assert!(
        !folder.path().join("scene.json").exists(),
        "nothing else is written either"
    );
    let run = girderway(&folder, &["init", "bogie", "spec.json"]);
    assert_eq!(run.status.code(), Some(2));
    assert!(
        text(&run.stderr).contains("spec.json is a file"),
        "{}",
        text(&run.stderr)
    );
}

#[test]
fn an_unknown_starter_is_told_with_those_that_are() {
    let folder = folder();
    let run = girderway(&folder, &["init", "train"]);
    assert_eq!(run.status.code(), Some(2));
    assert!(
        text(&run.stderr).contains("bogie, crane, girderway"),
        "{}",
        text(&run.stderr)
    );
}
