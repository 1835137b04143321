//! Summaries of designs have the form of their schema, which names nothing else.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use serde_json::{Value, json};

use super::details::runways;
use super::{root, run, summary};

static SCHEMA: LazyLock<Value> = LazyLock::new(design::summary_schema);
static VALIDATOR: LazyLock<jsonschema::Validator> =
    LazyLock::new(|| jsonschema::validator_for(&SCHEMA).expect("a valid schema"));

/// Checks the form of a summary.
pub(super) fn fits(summary: &Value) {
    let faults: Vec<String> = VALIDATOR
        .iter_errors(summary)
        .map(|fault| format!("{}: {fault}", fault.instance_path()))
        .collect();
    assert!(faults.is_empty(), "{faults:?}");
}

/// Names of members of objects anywhere in a value, apart from those that the design names.
fn members(value: &Value, found: &mut BTreeSet<String>) {
    for (key, member) in value.as_object().into_iter().flatten() {
        found.insert(key.clone());
        members(member, found);
    }
    value
        .as_array()
        .into_iter()
        .flatten()
        .for_each(|item| members(item, found));
}

/// Names of properties anywhere in a schema.
fn properties(schema: &Value, found: &mut BTreeSet<String>) {
    found.extend(
        schema["properties"]
            .as_object()
            .into_iter()
            .flatten()
            .map(|(key, _)| key.clone()),
    );
    schema
        .as_object()
        .into_iter()
        .flatten()
        .for_each(|(_, below)| properties(below, found));
    schema
        .as_array()
        .into_iter()
        .flatten()
        .for_each(|below| properties(below, found));
}

/// The example of a runway has stresses under wheels and fatigue; two rails have responses of pairs; a factor of buffer
/// forces gives those on end stops.
#[test]
fn every_property_of_the_schema_is_in_a_summary() {
    let read = |name: &str| -> Value {
        let text =
            std::fs::read_to_string(root().join("examples/runway").join(name)).expect("an example");
        serde_json::from_str(&text).expect("JSON")
    };
    let mut designs = vec![(read("spec.json"), read("design.json")), runways()];
    let (_, pair) = &mut designs[1];
    pair["trains"][0]["buffer"] = json!(50);
    pair["cases"] =
        json!([["crane"], {"name": "end stop", "trains": ["crane"], "factors": {"buffer": 1.1}}]);
    pair["sections"] =
        json!([{"name": "midspan", "cell": [0, 0], "place": 0.5, "component": "My"}]);
    let (mut found, mut known) = (BTreeSet::new(), BTreeSet::new());
    for (spec, design) in &designs {
        let (folder, output) = run(spec, design, &[]);
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        members(&summary(&folder), &mut found);
    }
    properties(&SCHEMA, &mut known);
    let unseen: Vec<&String> = known.difference(&found).collect();
    assert!(unseen.is_empty(), "{unseen:?}");
}

/// A summary without a member that it always has, or with another one, does not fit.
#[test]
fn summaries_of_another_form_do_not_fit() {
    let (spec, design) = runways();
    let (folder, _) = run(&spec, &design, &[]);
    let good = summary(&folder);
    for (pointer, key) in [
        ("", "within"),
        ("/extremes/0", "bound"),
        ("/pairs/0", "signs"),
        ("/units", "force"),
    ] {
        for to in [None, Some("another")] {
            let mut bad = good.clone();
            let object = bad
                .pointer_mut(pointer)
                .and_then(Value::as_object_mut)
                .expect("an object");
            let member = object.remove(key).expect("a member");
            if let Some(to) = to {
                object.insert(to.to_owned(), member);
            }
            assert!(!VALIDATOR.is_valid(&bad), "{pointer}/{key}: {to:?}");
        }
    }
}
