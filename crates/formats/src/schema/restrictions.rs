//! Keywords and ranges that the readers ask for, by definition and property of the schemas.
//!
//! The types from which schemas are generated accept any string and any number, so that the readers can report a wrong
//! one with its place and a hint. An editor needs the same restrictions in the schema. A test compares the keywords with
//! the messages of the readers.

use serde_json::{Value, json};

use Restriction::{
    Alternatives, AtLeastOne, Blocks, Fraction, Increasing, ListOf, ListOfNotNegative,
    ListOfPositive, NotNegative, Pattern, Positive, Second, Words,
};

/// What a property, or each item of its list, may be.
#[derive(Clone, Copy)]
enum Restriction {
    Words(&'static [&'static str]),
    ListOf(&'static [&'static str]),
    /// A list of words of the first group, or all words of the second one in their order.
    Alternatives(&'static [&'static str], &'static [&'static str]),
    /// A word for each cell, block by block.
    Blocks(&'static [&'static str]),
    Fraction,
    Positive,
    NotNegative,
    AtLeastOne,
    ListOfPositive,
    ListOfNotNegative,
    /// A pair whose second number is positive.
    Second,
    /// Increasing numbers: where the first is not negative, the others are positive. More a schema cannot say.
    Increasing,
    /// A string, or a list of strings, with this regular expression.
    Pattern(&'static str),
}

const POINT_DOFS: &[&str] = &["ux", "uy", "uz", "rx", "ry", "rz"];
const BODY_DOFS: &[&str] = &["x", "y", "z", "roll", "yaw", "pitch"];
const LENGTHS: &[&str] = &["ft", "in", "m", "mm"];
const FORCES: &[&str] = &["lbf", "kip", "N", "kN"];
const THEORIES: &[&str] = &["euler-bernoulli", "timoshenko"];
const COMPONENTS: &[&str] = &["N", "Vy", "Vz", "Mx", "My", "Mz"];
const FATIGUE_CLASSES: &[&str] = &["S0", "S1", "S2", "S3", "S4", "S5", "S6", "S7", "S8", "S9"];
const CRANES: &[&str] = &[
    "mill",
    "ladle",
    "bucket",
    "soaking pit",
    "stripping",
    "motor room",
    "stacker",
    "pendant",
];
const HOISTING: &[&str] = &["HC1", "HC2", "HC3", "HC4"];
const DRIVES: &[&str] = &["steady", "smooth", "sudden", "backlash"];
/// Codes with limits of deflections and the one for impact, whose editions may follow behind a colon.
const CODES: &str =
    r"^\s*(EN 1991-3|EN 1993-6|CMAA 70|AISC Design Guide 7|AIST TR-13|IS 800|ASCE 7)\s*(:|$)";
const LATERAL_SECTIONS: &[&str] = &["whole section", "top flange"];

/// Definition, property, and what the reader asks of its value.
const RESTRICTIONS: &[(&str, &str, Restriction)] = &[
    ("Units", "length", Words(LENGTHS)),
    ("Units", "force", Words(FORCES)),
    ("Units", "time", Words(&["s"])),
    // beam specs
    ("Spec", "theory", Words(THEORIES)),
    ("Spec", "stations", Increasing),
    ("Rail", "stations", Increasing),
    ("Girder", "spans", ListOfPositive),
    ("Girder", "overhangs", ListOfNotNegative),
    ("Girder", "E", Positive),
    ("Girder", "G", Positive),
    ("Girder", "A", Positive),
    ("Girder", "I_vertical", Positive),
    ("Girder", "I_lateral", Positive),
    ("Girder", "J", Positive),
    ("Girder", "kA_vertical", Positive),
    ("Girder", "kA_lateral", Positive),
    ("Girder", "rail_height", NotNegative),
    ("Girder", "mass_per_length", NotNegative),
    ("Girder", "density", Positive),
    ("Girder", "fy", Positive),
    ("Block", "type", Words(&["line"])),
    (
        "CellData",
        "kind",
        Blocks(&["beam", "truss", "rod", "cable"]),
    ),
    ("Section", "A", Positive),
    ("Section", "Iy", Positive),
    ("Section", "Iz", Positive),
    ("Section", "J", NotNegative),
    ("Section", "Asy", Positive),
    ("Section", "Asz", Positive),
    ("Cut", "at", Fraction),
    ("Material", "E", Positive),
    ("Material", "G", Positive),
    ("Material", "density", NotNegative),
    ("Material", "fy", Positive),
    ("Shape", "kind", Words(&["I", "box", "tube", "bar"])),
    ("Shape", "length", Words(LENGTHS)),
    ("Shape", "height", Positive),
    ("Shape", "width", Positive),
    ("Shape", "flange", Positive),
    ("Shape", "web", Positive),
    ("Shape", "lower_width", Positive),
    ("Shape", "lower_flange", Positive),
    ("Shape", "diameter", Positive),
    ("Shape", "wall", Positive),
    ("Support", "fix", ListOf(POINT_DOFS)),
    ("Spring", "dof", Words(POINT_DOFS)),
    ("Spring", "k", Positive),
    ("Mass", "mass", NotNegative),
    ("Mass", "inertia", ListOfNotNegative),
    // scenes
    ("Scene", "gravity", NotNegative),
    ("Scene", "analysis", Words(&["dynamic", "quasi-static"])),
    ("Scene", "accuracy", Positive),
    (
        "Scene",
        "stepper",
        Words(&[
            "auto", "sdirk4", "esdirk5", "radau", "series", "gauss2", "gauss3",
        ]),
    ),
    ("Scene", "step", Positive),
    (
        "Structure",
        "foundation",
        Words(&[
            "rigid",
            "parts",
            "influence",
            "modal",
            "full",
            "ties",
            "auto",
        ]),
    ),
    (
        "Structure",
        "reading",
        Words(&["exact", "natural", "akispl", "cubspl"]),
    ),
    (
        "Structure",
        "couplings",
        Words(&["all", "within rails", "none"]),
    ),
    ("Structure", "tolerance", Positive),
    ("Structure", "measure", Words(&["extremes", "history"])),
    ("Structure", "handover", Words(&["blend", "per-part"])),
    ("Structure", "blend", Positive),
    ("Structure", "damping", NotNegative),
    ("Ties", "spacing", Positive),
    ("Ties", "k", Positive),
    ("Ties", "lateral_k", Positive),
    ("Ties", "c", NotNegative),
    ("Ties", "mass", NotNegative),
    ("TieRail", "E", Positive),
    ("TieRail", "I_vertical", Positive),
    ("TieRail", "mass_per_length", NotNegative),
    (
        "Gauge",
        "direction",
        Words(&["vertical", "lateral", "longitudinal"]),
    ),
    ("Irregularity", "direction", Words(&["vertical", "lateral"])),
    (
        "Irregularity",
        "kind",
        Words(&["step", "joint", "dip", "sinusoid", "profile"]),
    ),
    ("Irregularity", "length", Positive),
    ("Body", "mass", Positive),
    ("Body", "weight", Positive),
    ("Body", "inertia", ListOfNotNegative),
    ("Body", "dof", Alternatives(BODY_DOFS, &["X", "Y", "Z"])),
    ("Wheel", "radius", Positive),
    ("Wheel", "spin_inertia", Positive),
    ("Vertical", "law", Words(&["linear", "impact"])),
    ("Vertical", "k", Positive),
    ("Vertical", "c", NotNegative),
    ("Vertical", "exponent", AtLeastOne),
    ("Vertical", "depth", Positive),
    ("Vertical", "damper", Words(&["rail", "ground"])),
    ("Lateral", "k", Positive),
    ("Lateral", "clearance", NotNegative),
    ("Lateral", "release", ListOfPositive),
    ("Friction", "law", Words(&["step", "coulomb"])),
    ("Friction", "mu", Positive),
    ("Friction", "slip", Positive),
    ("Motion", "dof", Words(&["x", "spin"])),
    ("Motion", "kind", Words(&["prescribed", "drive", "free"])),
    ("Motion", "gain", Positive),
    ("Motion", "max_force", NotNegative),
    ("Motion", "brake", NotNegative),
    ("Load", "dof", Words(BODY_DOFS)),
    ("Rope", "EA", Positive),
    ("Rope", "length", Positive),
    ("Rope", "c", NotNegative),
    (
        "Stop",
        "side",
        Words(&["before", "beyond", "above", "below"]),
    ),
    ("Stop", "gap", NotNegative),
    ("Stop", "k", Positive),
    ("Stop", "c", NotNegative),
    ("End", "time", Positive),
    ("Output", "dt", Positive),
    ("Fatigue", "gamma_Ff", Positive),
    ("Fatigue", "gamma_Mf", Positive),
    ("Fatigue", "history", Words(&["once", "repeated"])),
    ("Fatigue", "crossings", Positive),
    ("Practice", "kind", Words(CRANES)),
    ("Practice", "class", Words(&["A", "B", "C", "D", "E", "F"])),
    ("Practice", "s_class", Words(FATIGUE_CLASSES)),
    ("Practice", "building_class", Words(&["A", "B", "C", "D"])),
    ("Practice", "hoisting", Words(HOISTING)),
    ("Practice", "drives", Words(DRIVES)),
    ("Practice", "release", Words(&["slow", "rapid"])),
    ("Practice", "guide", Words(&["flanges", "rollers"])),
    ("Practice", "lateral_section", Words(LATERAL_SECTIONS)),
    ("Practice", "rail_head", Positive),
    ("Practice", "bridge_speed", Positive),
    ("Practice", "trolley_speed", Positive),
    ("Practice", "hoist_speed", Positive),
    ("Practice", "bumper_stroke", Positive),
    // designs
    ("Design", "gravity", NotNegative),
    ("Train", "ends", ListOfNotNegative),
    ("Train", "signs", Words(&["both", "given"])),
    ("Train", "hoist_load", NotNegative),
    ("Train", "trolley", NotNegative),
    ("Train", "bridge", NotNegative),
    ("NamedCase", "gap", NotNegative),
    ("NamedCase", "order", Words(&["any", "given"])),
    ("SectionCut", "component", Words(COMPONENTS)),
    ("DesignPractice", "code", Pattern(CODES)),
    ("DesignPractice", "rail_head", Positive),
    ("DesignPractice", "bridge_speed", Positive),
    ("DesignPractice", "trolley_speed", Positive),
    ("DesignPractice", "hoist_speed", Positive),
    ("DesignPractice", "s_class", Words(FATIGUE_CLASSES)),
    (
        "DesignPractice",
        "building_class",
        Words(&["A", "B", "C", "D"]),
    ),
    (
        "DesignPractice",
        "operation",
        Words(&["cab", "monorail", "pendant", "hand-geared"]),
    ),
    ("DesignPractice", "kind", Words(CRANES)),
    ("DesignPractice", "hoisting", Words(HOISTING)),
    ("DesignPractice", "drives", Words(DRIVES)),
    ("DesignPractice", "release", Words(&["slow", "rapid"])),
    ("DesignPractice", "lateral_section", Words(LATERAL_SECTIONS)),
    (
        "DesignPractice",
        "rail_fastening",
        Words(&["rigid", "loose", "pad"]),
    ),
    ("DesignPractice", "guide", Words(&["flanges", "rollers"])),
    // sweeps
    ("Sweep", "sampling", Words(&["grid", "latin", "sobol"])),
    ("Sweep", "count", AtLeastOne),
    (
        "Sweep",
        "results",
        Pattern(r"^(peaks|extremes|fatigue|ratios)$|\."),
    ),
    ("Law", "uniform", Increasing),
    ("Law", "normal", Second),
    ("Law", "lognormal", ListOfPositive),
    // grids
    ("Grid", "theory", Words(THEORIES)),
];

/// Adds the restrictions to a schema whose root is the definition `root`.
pub(super) fn add(schema: &mut Value, root: &str) {
    for (definition, property, restriction) in RESTRICTIONS {
        let pointer = match *definition == root {
            true => format!("/properties/{property}"),
            false => format!("/$defs/{definition}/properties/{property}"),
        };
        if let Some(value) = schema.pointer_mut(&pointer) {
            restrict(value, *restriction);
        }
    }
}

/// Adds a restriction to the schema of a property, which may be null where the type says so.
fn restrict(property: &mut Value, restriction: Restriction) {
    let is_nullable = property["type"]
        .as_array()
        .is_some_and(|types| types.contains(&json!("null")));
    match restriction {
        Words(words) => {
            let null = is_nullable.then_some(Value::Null);
            property["enum"] = words.iter().map(|word| json!(word)).chain(null).collect();
        }
        ListOf(words) => property["items"]["enum"] = json!(words),
        Alternatives(some, all) => {
            let all: Vec<Value> = all.iter().map(|word| json!({ "enum": [word] })).collect();
            let whole = json!({ "prefixItems": all, "minItems": all.len(), "maxItems": all.len() });
            property["anyOf"] = json!([{ "items": { "enum": some } }, whole]);
        }
        Blocks(words) => {
            for block in property["items"]["anyOf"]
                .as_array_mut()
                .into_iter()
                .flatten()
            {
                match block["type"].as_str() {
                    Some("string") => block["enum"] = json!(words),
                    Some("array") => block["items"]["enum"] = json!(words),
                    _ => {}
                }
            }
        }
        Fraction => {
            property["minimum"] = json!(0);
            property["maximum"] = json!(1);
        }
        Positive => property["exclusiveMinimum"] = json!(0),
        NotNegative => property["minimum"] = json!(0),
        AtLeastOne => property["minimum"] = json!(1),
        Second => {
            property["prefixItems"] =
                json!([{ "type": "number" }, { "type": "number", "exclusiveMinimum": 0 }]);
        }
        Increasing => increasing(property, None),
        Pattern(text) => match property.get_mut("items") {
            Some(items) => items["pattern"] = json!(text),
            None => property["pattern"] = json!(text),
        },
        ListOfPositive => property["items"]["exclusiveMinimum"] = json!(0),
        ListOfNotNegative => property["items"]["minimum"] = json!(0),
    }
}

/// Adds to the schema of a list that the numbers, or the members `key` of the objects in it, increase: where the first is
/// not negative, the others are positive.
pub(super) fn increasing(list: &mut Value, key: Option<&str>) {
    let number = |range: Value| match key {
        Some(key) => json!({ "properties": { key: range }, "required": [key] }),
        None => range,
    };
    list["if"] = json!({ "prefixItems": [number(json!({ "minimum": 0 }))] });
    list["then"] =
        json!({ "prefixItems": [true], "items": number(json!({ "exclusiveMinimum": 0 })) });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema;

    #[test]
    fn every_restriction_belongs_to_a_property_of_a_schema() {
        let schemas = [
            ("Spec", schema::beam()),
            ("Grid", schema::grid()),
            ("Scene", schema::scene()),
            ("Design", schema::design()),
            ("Sweep", schema::sweep()),
        ];
        for (definition, property, _) in RESTRICTIONS {
            let has = |(root, schema): &(&str, Value)| {
                let of = if definition == root {
                    ""
                } else {
                    &format!("/$defs/{definition}")
                };
                schema
                    .pointer(&format!("{of}/properties/{property}"))
                    .is_some()
            };
            assert!(schemas.iter().any(has), "{definition}.{property}");
        }
    }
}
