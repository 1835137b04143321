//! JSON Pointers into the files of a format, as a regular expression: what an editor can know of the axes of a sweep.
//!
//! A schema says which keys follow each other. The pattern of a schema is that of the rest of a pointer which has reached
//! it: nothing for a number, a string or a truth value; a slash and a key with the pattern of its member for an object; a
//! slash and an index with that of the items for a list; the union of the patterns of alternatives. Names of the user's
//! own, such as those of bodies, are any text without a slash. Definitions are followed once; within themselves, as in
//! lists of lists, any pointer is accepted.

use std::collections::BTreeMap;

use serde_json::Value;

/// Any rest of a pointer.
const ANY: &str = "(?:/[^/]+)*";

/// The regular expression, without anchors, of the pointers from the root of a file of `schema` to the values in it that
/// are neither lists nor objects. `left_out` are members of the root that no pointer may lead into.
pub(super) fn pattern(schema: &Value, left_out: &[&str]) -> String {
    let mut root = schema.clone();
    if let Some(members) = root["properties"].as_object_mut() {
        members.retain(|key, _| !left_out.contains(&key.as_str()));
    }
    union(rests(&root, schema, &mut Vec::new()))
}

/// Patterns of the rests of pointers which have reached a value of `schema`; `within` are the definitions on the way.
fn rests<'s>(schema: &'s Value, root: &'s Value, within: &mut Vec<&'s str>) -> Vec<String> {
    if let Some(definition) = schema["$ref"].as_str() {
        if within.contains(&definition) {
            return vec![ANY.to_owned()];
        }
        let Some(found) = definition
            .strip_prefix('#')
            .and_then(|path| root.pointer(path))
        else {
            return vec![ANY.to_owned()];
        };
        within.push(definition);
        let all = rests(found, root, within);
        within.pop();
        return all;
    }
    let mut all = Vec::new();
    for word in ["anyOf", "oneOf"] {
        for alternative in schema[word].as_array().into_iter().flatten() {
            all.extend(rests(alternative, root, within));
        }
    }
    if let Some(members) = schema["properties"].as_object() {
        // members with the same rest share it
        let mut keys: BTreeMap<String, Vec<&str>> = BTreeMap::new();
        for (key, member) in members.iter().filter(|(key, _)| *key != "$schema") {
            keys.entry(union(rests(member, root, within)))
                .or_default()
                .push(key);
        }
        all.extend(
            keys.into_iter()
                .map(|(rest, keys)| format!("/(?:{}){rest}", keys.join("|"))),
        );
    }
    if let Some(member) = schema
        .get("additionalProperties")
        .filter(|member| member.is_object())
    {
        all.push(format!("/[^/]+{}", union(rests(member, root, within))));
    }
    let items = schema
        .get("items")
        .filter(|items| items.is_object())
        .into_iter();
    for item in items.chain(schema["prefixItems"].as_array().into_iter().flatten()) {
        all.push(format!("/[0-9]+{}", union(rests(item, root, within))));
    }
    let types = match &schema["type"] {
        Value::Array(several) => several.iter().filter_map(Value::as_str).collect(),
        one => one.as_str().into_iter().collect::<Vec<_>>(),
    };
    let is_plain = |word: &&str| ["number", "integer", "string", "boolean"].contains(word);
    if types.iter().any(is_plain) || schema.get("const").is_some() || schema.get("enum").is_some() {
        all.push(String::new());
    }
    if types.contains(&"array")
        && schema.get("items").is_none()
        && schema.get("prefixItems").is_none()
    {
        all.push(ANY.to_owned());
    }
    all
}

/// The pattern of any of `patterns`, each once.
fn union(mut patterns: Vec<String>) -> String {
    patterns.sort();
    patterns.dedup();
    if patterns.iter().any(|one| one == ANY) {
        return ANY.to_owned();
    }
    match patterns.as_slice() {
        [] => ANY.to_owned(),
        [one] => one.clone(),
        several => format!("(?:{})", several.join("|")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_pattern_has_keys_indices_names_of_the_user_and_lists_of_lists() {
        let schema = json!({
            "properties": {
                "$schema": { "type": "string" },
                "end": { "anyOf": [{ "$ref": "#/$defs/End" }, { "type": "null" }] },
                "bodies": { "additionalProperties": { "$ref": "#/$defs/Body" } },
                "tree": { "$ref": "#/$defs/Tree" },
                "compare": { "type": "array", "items": { "type": "string" } },
            },
            "$defs": {
                "End": { "properties": { "time": { "type": ["number", "null"] } } },
                "Body": { "properties": {
                    "cg": { "type": ["array", "null"], "items": { "type": "number" } },
                    "mass": { "type": "number" }, "weight": { "type": "number" },
                } },
                "Tree": { "items": { "$ref": "#/$defs/Tree" } },
            },
        });
        assert_eq!(
            pattern(&schema, &["compare"]),
            "(?:/(?:bodies)/[^/]+(?:/(?:cg)/[0-9]+|/(?:mass|weight))|/(?:end)/(?:time)|/(?:tree)/[0-9]+(?:/[^/]+)*)"
        );
    }
}
