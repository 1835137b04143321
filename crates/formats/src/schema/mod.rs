//! JSON Schemas of the formats, generated from the types that the readers deserialize.
//!
//! The schemas describe keys, types, keywords and ranges of single numbers. Dependencies between keys are checked by the
//! readers only.

mod pointers;
mod restrictions;

use std::borrow::Cow;

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Value, json};

use crate::design::{RawCase, RawDead, RawDeadLoads, RawDesign, RawForces, RawNamedCase};
use crate::grid::file::RawGrid;
use crate::own_limits::{RawBound, RawLimit};
use crate::scene::{RawCodes, RawColumns, RawNode, RawPick, RawScene};
use crate::spec::{Block, RawDetail, RawSectionShape, RawShape, RawSpec, Reference};
use crate::sweep::{RawAxis, RawLaw, RawScalar, RawSweep};
use crate::text::entries::Entries;

/// The schema of beam specs.
#[must_use]
pub fn beam() -> Value {
    of::<RawSpec>("Spec", crate::spec::FORMAT, "Beam spec of girderway")
}

/// The schema of grids.
#[must_use]
pub fn grid() -> Value {
    of::<RawGrid>(
        "Grid",
        crate::grid::file::FORMAT,
        "Influence grid of girderway",
    )
}

/// The schema of scenes.
#[must_use]
pub fn scene() -> Value {
    let mut schema = of::<RawScene>("Scene", crate::scene::FORMAT, "Scene of girderway");
    schema["$defs"]["Changes"] = changes(&schema);
    schema["properties"]["compare"]["items"] = json!({ "$ref": "#/$defs/Changes" });
    schema
}

/// The schema of designs.
#[must_use]
pub fn design() -> Value {
    let mut schema = of::<RawDesign>("Design", crate::design::FORMAT, "Design of girderway");
    let class = |key: &str, classes: &[&str]| json!({ "properties": { key: { "enum": classes } }, "required": [key] });
    let conditions = [
        (
            "AISC Design Guide 7",
            class("class", &["A", "B", "C", "D", "E", "F"]),
        ),
        ("IS 800", class("class", &["manual", "electric", "heavy"])),
        ("AIST TR-13", class("building_class", &["A", "B", "C", "D"])),
    ];
    let conditions = conditions.map(|(code, then)| {
        let code = json!({ "type": "string", "pattern": format!(r"^\s*{code}\s*(:|$)") });
        json!({ "if": { "properties": { "code": code }, "required": ["code"] }, "then": then })
    });
    schema["$defs"]["DesignPractice"]["allOf"] = json!(conditions);
    let spans = &mut schema["properties"]["spans"]["additionalProperties"];
    spans["minItems"] = json!(2);
    restrictions::increasing(spans, None);
    // the wheels of each rail increase: where no wheel names its rail, all are on one
    let wheels = &mut schema["$defs"]["Train"]["properties"]["wheels"];
    restrictions::increasing(wheels, Some("x"));
    wheels["if"]["items"] = json!({ "not": { "required": ["rail"] } });
    wheels["if"]["prefixItems"][0]["not"] = json!({ "required": ["rail"] });
    schema
}

/// The schema of sweeps.
#[must_use]
pub fn sweep() -> Value {
    let mut schema = of::<RawSweep>("Sweep", crate::sweep::FORMAT, "Sweep of girderway");
    schema["required"] = json!(["format", "axes", "sampling", "results"]);
    let has = |key: &str| json!({ "properties": { key: { "type": "string" } }, "required": [key] });
    schema["oneOf"] = json!([has("scene"), has("design")]);
    schema["properties"]["axes"]["minProperties"] = json!(1);
    // into the scene or design, or, behind the name of a file, into the spec or grid that it names
    let of_file = [beam(), grid()]
        .map(|of| pointers::pattern(&of, &[]))
        .join("|");
    let names = |input: &Value, left_out: &[&str]| {
        let own = pointers::pattern(input, left_out);
        json!({ "properties": { "axes": { "propertyNames": { "pattern": format!("^(?:{own}|[^#]+#(?:{of_file}))$") } } } })
    };
    schema["allOf"] = json!([
        { "if": has("scene"), "then": names(&scene(), &["compare"]) },
        { "if": has("design"), "then": names(&design(), &[]) },
    ]);
    schema["properties"]["results"]["minItems"] = json!(1);
    schema["properties"]["results"]["uniqueItems"] = json!(true);
    let is_grid = json!({ "properties": { "sampling": { "const": "grid" } } });
    let without = json!({ "properties": { "count": { "type": "null" } } });
    schema["if"] = is_grid;
    schema["then"] = without;
    schema["else"] =
        json!({ "properties": { "count": { "type": "number" } }, "required": ["count"] });
    let whole = json!({ "type": "integer", "minimum": 1 });
    schema["$defs"]["Law"]["properties"]["range"]["prefixItems"] =
        json!([{ "type": "number" }, { "type": "number" }, whole]);
    schema["$defs"]["Law"]["minProperties"] = json!(1);
    schema
}

/// The schema of an item of `compare`: a label, and members of a scene that are merged into it. A null removes a named
/// member.
fn changes(scene: &Value) -> Value {
    let mut properties = scene["properties"].clone();
    if let Some(members) = properties.as_object_mut() {
        members.retain(|key, _| {
            !["$schema", "format", "name", "units", "compare"].contains(&key.as_str())
        });
        for member in members.values_mut() {
            if let Some(named) = member
                .get_mut("additionalProperties")
                .filter(|named| named.is_object())
            {
                *named = json!({ "anyOf": [named.clone(), { "type": "null" }] });
            }
        }
        members.insert(
            "label".to_owned(),
            json!({ "type": "string", "description": "Name of the variant, which is part of the names of its files." }),
        );
    }
    json!({
        "type": "object",
        "description": "A variant of the scene: its label, and the keys that change.",
        "additionalProperties": false,
        "properties": properties,
        "required": ["label"],
    })
}

/// The schema of the type `T`, whose definition is called `root`.
fn of<T: JsonSchema>(root: &str, format: &str, title: &str) -> Value {
    let schema = SchemaSettings::draft2020_12()
        .into_generator()
        .into_root_schema_for::<T>();
    // the prefix `Raw` of the types is an implementation detail and does not belong in a schema
    let text = schema
        .to_value()
        .to_string()
        .replace("\"Raw", "\"")
        .replace("$defs/Raw", "$defs/");
    let mut schema: Value = serde_json::from_str(&text).unwrap_or_default();
    schema["title"] = json!(title);
    schema["properties"]["format"] =
        json!({ "const": format, "description": "Name and version of the format." });
    schema["properties"]["$schema"] = json!({ "type": "string", "description": "Path of this schema, for editors; otherwise ignored." });
    schema["required"] = json!(["format", "units"]);
    if let Some(units) = schema.pointer_mut("/$defs/Units") {
        units["required"] = json!(["length", "force", "time"]);
    }
    restrictions::add(&mut schema, root);
    schema
}

/// Implements [`JsonSchema`] for a type with its own deserializer: its name, and its schema.
macro_rules! schemas {
    ($($type:ty, $name:literal, |$generator:ident| $schema:expr;)+) => {
        $(impl JsonSchema for $type {
            fn schema_name() -> Cow<'static, str> {
                $name.into()
            }

            fn json_schema($generator: &mut SchemaGenerator) -> Schema {
                $schema
            }
        })+
    };
}

schemas! {
    Reference, "Reference", |_generator| json_schema!({ "anyOf": [{ "type": "integer", "minimum": 0 }, { "type": "string" }] });
    RawSectionShape, "SectionShape", |generator| {
        let dimensions = generator.subschema_for::<RawShape>();
        json_schema!({ "anyOf": [{ "type": "string" }, dimensions] })
    };
    RawDetail, "Detail", |_generator| json_schema!({ "type": ["number", "string"] });
    RawColumns, "Columns", |_generator| json_schema!({ "anyOf": [{ "type": "boolean" }, { "type": "array", "items": { "type": "string" } }] });
    RawForces, "Forces", |_generator| json_schema!({ "anyOf": [{ "type": "number" }, { "type": "object", "additionalProperties": { "type": "number" } }] });
    RawCase, "Case", |generator| {
        let named = generator.subschema_for::<RawNamedCase>();
        json_schema!({ "anyOf": [{ "type": "array", "items": { "type": "string" }, "minItems": 1 }, named] })
    };
    RawDead, "Dead", |generator| {
        let parts = generator.subschema_for::<RawDeadLoads>();
        json_schema!({ "anyOf": [{ "type": "boolean" }, parts] })
    };
    RawCodes, "Codes", |_generator| json_schema!({ "anyOf": [{ "type": "string" }, { "type": "array", "items": { "type": "string" }, "minItems": 1 }] });
    RawBound, "Bound", |_generator| json_schema!({ "anyOf": [{ "type": "number", "exclusiveMinimum": 0 }, { "type": "string", "pattern": r"^\s*[Ll]\s*/" }] });
    RawLimit, "Limit", |generator| {
        let bound = generator.subschema_for::<RawBound>();
        json_schema!({ "anyOf": [bound, { "type": "array", "items": bound, "minItems": 1 }] })
    };
    RawScalar, "Scalar", |_generator| json_schema!({ "type": ["number", "string", "boolean"] });
    RawAxis, "Axis", |generator| {
        let value = generator.subschema_for::<RawScalar>();
        let law = generator.subschema_for::<RawLaw>();
        json_schema!({ "anyOf": [{ "type": "array", "items": value, "minItems": 1 }, law] })
    };
    RawPick, "Pick", |_generator| json_schema!({ "type": ["integer", "string"], "minimum": 0 });
    RawNode, "Node", |_generator| node();
}

/// A wheel, or an equaliser whose ends have the same number of wheels: with 2, 4 or 8 of them, or more.
fn node() -> Schema {
    let pair = |end: Value| json!({ "type": "array", "items": end, "minItems": 2, "maxItems": 2 });
    let nested = |innermost: Value, depth: usize| (0..depth).fold(innermost, |end, _| pair(end));
    let mut levels: Vec<Value> = (0..4)
        .map(|depth| nested(json!({ "type": "number" }), depth))
        .collect();
    levels.push(nested(json!({ "type": "array" }), 3));
    json_schema!({ "anyOf": levels })
}

impl<T: JsonSchema> JsonSchema for Entries<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("Entries_of_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let member = generator.subschema_for::<T>();
        json_schema!({ "type": "object", "additionalProperties": member })
    }
}

impl<T: JsonSchema> JsonSchema for Block<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("Block_of_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let item = generator.subschema_for::<T>();
        json_schema!({ "anyOf": [{ "type": "null" }, item, { "type": "array", "items": item }] })
    }
}
