//! `girderway schema`: what the program reads is in its schemas, what it refuses for its form is not.

use std::fs;

use serde_json::Value;

use super::{example, folder, girderway, json, text};

/// Whether `value` has the form that `schema` asks for.
fn fits(value: &Value, schema: &Value) -> bool {
    jsonschema::validator_for(schema)
        .expect("a valid schema")
        .is_valid(value)
}

pub fn schema(format: &str) -> Value {
    let run = girderway(&folder(), &["schema", format]);
    assert!(
        run.status.success() && run.stderr.is_empty(),
        "{}",
        text(&run.stderr)
    );
    json(&run.stdout)
}

/// The formats with a schema, as the help lists them.
fn formats() -> Vec<String> {
    let run = girderway(&folder(), &["schema", "--help"]);
    let lines = text(&run.stdout)
        .lines()
        .filter_map(|line| line.trim().strip_prefix("- "));
    lines
        .filter_map(|line| line.split_once(':'))
        .map(|(word, _)| word.to_owned())
        .collect()
}

#[test]
fn examples_have_the_form_of_their_schemas() {
    let [beam, scene, design, sweep] = ["beam", "scene", "design", "sweep"].map(schema);
    let (mut checked, mut sweeps) = (0, 0);
    for folder in fs::read_dir(example("")).expect("the examples") {
        for file in fs::read_dir(folder.expect("a folder").path()).expect("a folder") {
            let path = file.expect("a file").path();
            if path.extension().is_none_or(|ending| ending != "json") {
                continue;
            }
            let value: Value = json(&fs::read(&path).expect("a readable file"));
            let schema = match value["format"].as_str() {
                Some("girderway-beam/1") => &beam,
                Some("girderway-scene/1") => &scene,
                Some("girderway-design/1") => &design,
                Some("girderway-sweep/1") => &sweep,
                _ => continue,
            };
            assert!(fits(&value, schema), "{}", path.display());
            checked += 1;
            sweeps += usize::from(std::ptr::eq(schema, &raw const sweep));
        }
    }
    assert!(checked >= 20 && sweeps >= 3, "{checked}, {sweeps}");
}

#[test]
fn grids_have_the_form_of_their_schema() {
    let folder = folder();
    let grid = schema("grid");
    for spec in [
        "bogie/spec.json",
        "mill_girderway/spec.json",
        "bridge_crane/girders.json",
    ] {
        let spec = example(spec);
        let run = girderway(
            &folder,
            &["fea", spec.to_str().expect("UTF-8"), "--modes", "2"],
        );
        // the paper's girder has no mass
        let run = if run.status.success() {
            run
        } else {
            girderway(&folder, &["fea", spec.to_str().expect("UTF-8")])
        };
        assert!(run.status.success(), "{}", text(&run.stderr));
        let value = json(&run.stdout);
        assert!(fits(&value, &grid), "{}", spec.display());
    }
}

#[test]
fn what_is_mistyped_does_not_fit() {
    let scene = schema("scene");
    let good = fs::read_to_string(example("bogie/scene.json")).expect("an example");
    assert!(fits(&json(good.as_bytes()), &scene));
    for (old, new) in [
        ("\"gravity\"", "\"gravitation\""),
        ("girderway-scene/1", "girderway-beam/1"),
        ("\"radius\": 1.25", "\"radius\": \"1.25 ft\""),
        ("\"end\": {\"time\": 12}", "\"end\": 12"),
        ("[[0, 5]]", "[0, 5]"),
        ("\"units\"", "\"unit\""),
    ] {
        assert_eq!(good.matches(old).count(), 1, "{old}");
        let bad = json(good.replace(old, new).as_bytes());
        assert!(!fits(&bad, &scene), "{old} => {new}");
    }
}

/// Every keyword of the schema of scenes in a scene that uses them, and only these, are those that the reader accepts.
#[test]
fn keywords_are_those_of_the_readers() {
    let schemas = [("beam", "spec"), ("scene", "scene"), ("design", "design")];
    let mut compared = 0;
    for (format, name) in schemas {
        let schema = schema(format);
        for origin in [
            "bogie",
            "runway",
            "bridge_crane",
            "ties",
            "mill_girderway",
            "wheel",
        ] {
            let path = example(origin).join(format!("{name}.json"));
            let Ok(text) = fs::read(path) else { continue };
            let value = json(&text);
            let mut found = Vec::new();
            keywords(&value, &schema, &schema, String::new(), &mut found);
            for (pointer, words) in found {
                let folder = folder();
                for file in fs::read_dir(example(origin)).expect("a folder") {
                    let file = file.expect("a file").path();
                    fs::copy(&file, folder.path().join(file.file_name().expect("a name"))).ok();
                }
                let mut changed = value.clone();
                *changed.pointer_mut(&pointer).expect("a value") = Value::from("qzqzq");
                fs::write(folder.path().join("changed.json"), changed.to_string())
                    .expect("written");
                let command = if format == "beam" {
                    "fea"
                } else if format == "scene" {
                    "run"
                } else {
                    "design"
                };
                let run = girderway(&folder, &[command, "changed.json", "--json"]);
                assert_eq!(run.status.code(), Some(2), "{pointer}");
                let errors = json(&run.stderr);
                let asked = errors["errors"].as_array().expect("a list").iter();
                let asked: Vec<&str> = asked
                    .filter_map(|error| error["expected"].as_str())
                    .collect();
                // what may move depends on the body, which is a point, carried, or has a spin
                let depends_on_the_body = ["/motions/", "/bodies/"]
                    .iter()
                    .any(|part| pointer.starts_with(part));
                let all = |asked: &&str| {
                    let quoted: Vec<&str> = asked.split('"').skip(1).step_by(2).collect();
                    let is_part = || {
                        quoted
                            .iter()
                            .all(|word| words.iter().any(|known| known == word))
                    };
                    quoted == words || depends_on_the_body && !quoted.is_empty() && is_part()
                };
                assert!(
                    asked.iter().any(all),
                    "{origin} {pointer}: {asked:?} {words:?}"
                );
                compared += 1;
            }
        }
    }
    assert!(compared > 60, "{compared}");
}

/// Pointers to the values whose schema lists keywords, with these.
fn keywords(
    value: &Value,
    schema: &Value,
    root: &Value,
    at: String,
    found: &mut Vec<(String, Vec<String>)>,
) {
    let place = schema["$ref"]
        .as_str()
        .and_then(|path| path.strip_prefix('#'));
    let schema = place.map_or(schema, |path| root.pointer(path).expect("a definition"));
    // of lists of words of one of several groups, the group that the value is of
    let is_of = |one: &&Value| {
        let words = one["items"]["enum"].as_array();
        words.is_none_or(|words| {
            value
                .as_array()
                .is_none_or(|list| list.iter().all(|own| words.contains(own)))
        })
    };
    for one in schema["anyOf"]
        .as_array()
        .into_iter()
        .flatten()
        .filter(is_of)
    {
        keywords(value, one, root, at.clone(), found);
    }
    if let (Some(words), true) = (schema["enum"].as_array(), value.is_string()) {
        let words: Vec<String> = words
            .iter()
            .filter_map(|word| word.as_str().map(str::to_owned))
            .collect();
        // one keyword is that of a unit of time or a type of cell
        if words.len() > 1 && found.iter().all(|(_, known)| *known != words) {
            found.push((at.clone(), words));
        }
    }
    for (key, member) in value.as_object().into_iter().flatten() {
        let own = schema["properties"]
            .get(key)
            .or_else(|| schema.get("additionalProperties"));
        if let Some(own) = own.filter(|_| key != "compare") {
            keywords(member, own, root, format!("{at}/{key}"), found);
        }
    }
    for (index, item) in value.as_array().into_iter().flatten().enumerate() {
        keywords(item, &schema["items"], root, format!("{at}/{index}"), found);
    }
}

#[test]
fn variants_of_a_scene_are_typed() {
    let scene = schema("scene");
    let good = fs::read_to_string(example("bogie/scene.json")).expect("an example");
    let mut value = json(good.as_bytes());
    for (variant, is_valid) in [
        (serde_json::json!({ "label": "x", "accuracy": 1e-5 }), true),
        (
            serde_json::json!({ "label": "x", "structures": { "girder": { "foundation": "rigid" }, "other": null } }),
            true,
        ),
        (serde_json::json!({ "label": "x", "acuracy": 1e-5 }), false),
        (
            serde_json::json!({ "label": "x", "structures": { "girder": { "foundation": "rigit" } } }),
            false,
        ),
        (serde_json::json!({ "label": "x", "units": {} }), false),
        (serde_json::json!({ "accuracy": 1e-5 }), false),
    ] {
        value["compare"] = serde_json::json!([variant]);
        assert_eq!(fits(&value, &scene), is_valid, "{variant}");
    }
}

#[test]
fn summaries_have_the_form_of_their_schema() {
    let folder = folder();
    let summary = schema("summary");
    for scene in ["bogie/fast.json", "runway/scene.json", "ties/scene.json"] {
        let scene = example(scene);
        let run = girderway(
            &folder,
            &[
                "run",
                scene.to_str().expect("UTF-8"),
                "-o",
                "out",
                "--quiet",
            ],
        );
        assert!(run.status.success(), "{}", text(&run.stderr));
        let value = json(&fs::read(folder.path().join("out/summary.json")).expect("written"));
        assert!(fits(&value, &summary), "{}", scene.display());
    }
}

#[test]
fn every_property_is_described() {
    fn check(schema: &Value, what: &str) -> usize {
        let mut count = 0;
        for (key, property) in schema["properties"].as_object().into_iter().flatten() {
            assert!(property["description"].is_string(), "{what}: {key}");
            count += 1;
        }
        // conditions name properties that are declared elsewhere
        let conditions = ["allOf", "oneOf", "if", "then", "else"];
        let below = schema.as_object().into_iter().flatten();
        let below = below
            .filter(|(key, _)| !conditions.contains(&key.as_str()))
            .map(|(_, value)| value);
        let below = below.chain(schema.as_array().into_iter().flatten());
        count + below.map(|value| check(value, what)).sum::<usize>()
    }
    let formats = formats();
    assert!(formats.len() >= 7, "{formats:?}");
    for format in formats {
        // a sweep has ten keys, and a range or one of three distributions
        let least = if format == "sweep" { 14 } else { 40 };
        assert!(check(&schema(&format), &format) >= least, "{format}");
    }
}

#[test]
fn the_path_of_a_schema_is_ignored() {
    let folder = folder();
    let spec = fs::read_to_string(example("bogie/spec.json")).expect("an example");
    fs::write(
        folder.path().join("spec.json"),
        spec.replacen('{', "{\"$schema\": \"beam.json\",", 1),
    )
    .expect("written");
    let run = girderway(&folder, &["fea", "spec.json"]);
    assert!(run.status.success(), "{}", text(&run.stderr));
}

#[test]
fn a_schema_goes_to_the_file_named() {
    let folder = folder();
    let run = girderway(&folder, &["schema", "beam", "-o", "beam.schema.json"]);
    assert!(run.status.success() && run.stdout.is_empty());
    let written = json(&fs::read(folder.path().join("beam.schema.json")).expect("written"));
    assert_eq!(written, schema("beam"));
    assert_eq!(
        girderway(&folder, &["schema", "song"]).status.code(),
        Some(2)
    );
}
