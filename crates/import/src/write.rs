//! Writes a structure as the text of a beam spec.

use fea::MemberKind;
use serde_json::{Map, Value, json};

use super::structure::{ImportedRail, ImportedSection, ImportedStructure};
use formats::spec::{FORMAT, theory_word};

/// Names of the degrees of freedom in a beam spec.
const DOFS: [&str; 6] = ["ux", "uy", "uz", "rx", "ry", "rz"];

/// Number of uniform parts that approximate a tapered member.
pub const PARTS: usize = 32;

/// Writes a structure as a beam spec in the general form. Every number has the fewest digits that reproduce its value
/// exactly.
#[must_use]
pub fn write(structure: &ImportedStructure) -> String {
    let mut spec = Map::new();
    let mut put = |key: &str, value: Value| {
        spec.insert(key.to_owned(), value);
    };
    put("format", json!(FORMAT));
    put("name", json!(structure.name));
    put("units", structure.units.json());
    put("theory", json!(theory_word(fea::BeamTheory::Timoshenko)));
    if let Some(up) = structure.up {
        put("up", json!(up));
    }
    put(
        "points",
        structure
            .points
            .iter()
            .map(|point| json!(point.at))
            .collect(),
    );
    let data: Value = structure
        .members
        .iter()
        .map(|member| json!(member.points))
        .collect();
    if structure
        .members
        .iter()
        .any(|member| member.section_b.is_some())
    {
        put("parts", json!(PARTS));
    }
    put("cells", json!([{ "type": "line", "data": data }]));
    put("cell_data", cell_data(structure));
    put(
        "point_sets",
        structure
            .point_sets
            .iter()
            .map(|(name, set)| (name.clone(), json!(set)))
            .collect(),
    );
    put(
        "cell_sets",
        structure
            .cell_sets
            .iter()
            .map(|(name, set)| (name.clone(), json!([set])))
            .collect(),
    );
    let (materials, sections) = match &structure.written {
        Some(written) => (written.materials.clone(), written.sections.clone()),
        None => (
            structure.materials.iter().map(material).collect(),
            structure.sections.iter().map(section).collect(),
        ),
    };
    put("materials", materials);
    put("sections", sections);
    put(
        "supports",
        structure
            .supports
            .iter()
            .filter(|(_, fix)| fix.contains(&true))
            .map(|(point, fix)| json!({ "point": point, "fix": words(fix) }))
            .collect(),
    );
    let springs = structure.springs.iter();
    put(
        "springs",
        springs
            .map(|spring| json!({ "point": spring.point, "dof": DOFS[spring.dof], "k": spring.k }))
            .collect(),
    );
    put(
        "links",
        structure
            .links
            .iter()
            .map(|[from, to]| json!({ "from": from, "to": to }))
            .collect(),
    );
    put(
        "masses",
        structure
            .masses
            .iter()
            .map(|mass| {
                json!({ "point": mass.point, "mass": mass.mass, "inertia": mass.inertia, "offset": mass.offset })
            })
            .collect(),
    );
    put(
        "rails",
        structure
            .rails
            .iter()
            .map(|rail| (rail.name.clone(), json!(rail_json(rail))))
            .collect(),
    );
    spec.retain(|key, value| key == "rails" || !empty(value));
    lines(&spec)
}

fn empty(value: &Value) -> bool {
    value.as_array().is_some_and(Vec::is_empty) || value.as_object().is_some_and(Map::is_empty)
}

/// Columns of `cell_data`; columns that contain default values only are omitted.
fn cell_data(structure: &ImportedStructure) -> Value {
    let members = &structure.members;
    let mut data = Map::new();
    let mut put = |key: &str, needed: bool, column: Value| {
        if needed {
            data.insert(key.to_owned(), json!([column]));
        }
    };
    let kind = |kind: MemberKind| match kind {
        MemberKind::Beam => "beam",
        MemberKind::Truss => "truss",
        MemberKind::Rod => "rod",
        MemberKind::Cable => "cable",
    };
    put(
        "kind",
        members.iter().any(|member| member.kind != MemberKind::Beam),
        members
            .iter()
            .map(|member| json!(kind(member.kind)))
            .collect(),
    );
    put(
        "section",
        true,
        members.iter().map(|member| json!(member.section)).collect(),
    );
    put(
        "section_b",
        members.iter().any(|member| member.section_b.is_some()),
        members
            .iter()
            .map(|member| json!(member.section_b))
            .collect(),
    );
    let up = structure.up.unwrap_or([0.0, 1.0, 0.0]);
    put(
        "orientation",
        members.iter().any(|member| member.orientation.is_some()),
        members
            .iter()
            .map(|member| json!(member.orientation.unwrap_or(up)))
            .collect(),
    );
    for (end, key) in ["offset_a", "offset_b"].into_iter().enumerate() {
        put(
            key,
            members.iter().any(|member| member.offsets[end] != [0.0; 3]),
            members
                .iter()
                .map(|member| json!(member.offsets[end]))
                .collect(),
        );
    }
    for (end, key) in ["release_a", "release_b"].into_iter().enumerate() {
        put(
            key,
            members
                .iter()
                .any(|member| member.releases[end].contains(&true)),
            members
                .iter()
                .map(|member| words(&member.releases[end]))
                .collect(),
        );
    }
    Value::Object(data)
}

fn words(set: &[bool; 6]) -> Value {
    DOFS.iter()
        .zip(set)
        .filter(|(_, on)| **on)
        .map(|(word, _)| json!(word))
        .collect()
}

fn material(material: &super::structure::ImportedMaterial) -> Value {
    let mut object = Map::new();
    object.insert("name".to_owned(), json!(material.name));
    object.insert("E".to_owned(), json!(material.e));
    for (key, value) in [("G", material.g), ("density", material.density)] {
        object.extend(value.map(|value| (key.to_owned(), json!(value))));
    }
    Value::Object(object)
}

fn section(section: &ImportedSection) -> Value {
    let mut object = Map::new();
    object.insert("name".to_owned(), json!(section.name));
    object.insert("material".to_owned(), json!(section.material));
    let numbers = [
        ("A", section.area),
        ("Iy", section.iy),
        ("Iz", section.iz),
        ("J", section.j),
        ("Asy", section.shear_y),
        ("Asz", section.shear_z),
    ];
    for (key, value) in numbers {
        object.extend(value.map(|value| (key.to_owned(), json!(value))));
    }
    Value::Object(object)
}

fn rail_json(rail: &ImportedRail) -> Value {
    let segment = |member: &usize| {
        let mut object = Map::new();
        object.insert("cell".to_owned(), json!([0, member]));
        if rail.offset != [0.0; 3] {
            object.insert("offset".to_owned(), json!(rail.offset));
        }
        Value::Object(object)
    };
    json!({
        "origin": rail.origin,
        "axis": rail.axis,
        "segments": rail.members.iter().map(segment).collect::<Value>(),
        "stations": rail.stations,
    })
}

/// Formats an object with one line for each key, and one line for each item of long lists.
fn lines(spec: &Map<String, Value>) -> String {
    let long = [
        "points",
        "materials",
        "sections",
        "supports",
        "springs",
        "links",
        "masses",
    ];
    let mut parts = Vec::new();
    for (key, value) in spec {
        let text = match value {
            Value::Array(items) if long.contains(&key.as_str()) => {
                let items: Vec<String> = items.iter().map(|item| format!("  {item}")).collect();
                format!("[\n{}\n ]", items.join(",\n"))
            }
            Value::Object(members) if key == "cell_data" || key == "rails" => {
                let name = |name: &String| Value::String(name.clone());
                let members: Vec<String> = members
                    .iter()
                    .map(|(key, value)| format!("  {}: {value}", name(key)))
                    .collect();
                if members.is_empty() {
                    "{}".to_owned()
                } else {
                    format!("{{\n{}\n }}", members.join(",\n"))
                }
            }
            other => other.to_string(),
        };
        parts.push(format!(" \"{key}\": {text}"));
    }
    format!("{{\n{}\n}}\n", parts.join(",\n"))
}
