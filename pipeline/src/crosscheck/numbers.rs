//! A beam spec in numbers, as the other codes read it: without names of rolled sections, shapes and crane rails.

use fea::Girder;
use formats::spec::{Form, FrameSpec, Spec};
use serde_json::{Map, Value, json};

/// The JSON of a spec, as the user wrote it, with the numbers that follow from names of sections, shapes and crane rails
/// in their place, and with its stations.
///
/// # Errors
/// Why the numbers cannot stand in the spec.
pub fn in_numbers(mut raw: Value, spec: &Spec) -> Result<Value, String> {
    match &spec.form {
        Form::Girder(girder) => {
            raw["stations"] = json!(girder.stations);
            if let Some(own) = raw["girder"].as_object_mut() {
                write_girder(own, girder);
            }
        }
        Form::Frame(frame) => {
            write_sections(&mut raw, frame);
            write_rails(&mut raw, frame)?;
        }
    }
    Ok(raw)
}

fn write_girder(own: &mut Map<String, Value>, girder: &Girder) {
    for name in ["section", "shape", "crane_rail", "composite"] {
        own.remove(name);
    }
    let known = [
        ("E", Some(girder.e)),
        ("G", girder.g),
        ("A", girder.area),
        ("I_vertical", Some(girder.i_vertical)),
        ("I_lateral", girder.i_lateral),
        ("J", girder.j),
        ("kA_vertical", girder.ka_vertical),
        ("kA_lateral", girder.ka_lateral),
        ("rail_height", Some(girder.rail_height)),
        ("mass_per_length", girder.mass_per_length),
    ];
    for (key, value) in known {
        if let Some(value) = value {
            own.insert(key.to_owned(), json!(value));
        }
    }
}

/// The model begins with the sections of the file, in their order.
fn write_sections(raw: &mut Value, frame: &FrameSpec) {
    let sections = raw["sections"]
        .as_array_mut()
        .into_iter()
        .flatten()
        .zip(&frame.model.sections);
    for (own, section) in sections.filter(|(own, _)| own.get("shape").is_some()) {
        let known = [
            ("A", Some(section.area)),
            ("Iy", Some(section.iy)),
            ("Iz", Some(section.iz)),
            ("J", Some(section.j)),
            ("Asy", section.shear_y),
            ("Asz", section.shear_z),
        ];
        for (key, value) in known {
            own[key] = json!(value);
        }
        if let Some(own) = own.as_object_mut() {
            own.retain(|key, value| key != "shape" && !value.is_null());
        }
    }
}

fn write_rails(raw: &mut Value, frame: &FrameSpec) -> Result<(), String> {
    for (name, rail) in &frame.rails {
        let own = raw["rails"]
            .get_mut(name)
            .filter(|own| own.get("crane_rail").is_some());
        let Some(own) = own.and_then(Value::as_object_mut) else {
            continue;
        };
        own.remove("crane_rail");
        let is_composite = own
            .remove("composite")
            .is_some_and(|composite| composite == json!(true));
        let segments = own.get_mut("segments").and_then(Value::as_array_mut);
        match segments.filter(|own| !is_composite && own.len() == rail.segments.len()) {
            Some(own) => {
                own.iter_mut()
                    .zip(&rail.segments)
                    .for_each(|(own, of)| own["offset"] = json!(of.offset));
            }
            None => {
                return Err(format!(
                    "the crane rail of {name} changes the sections of its members"
                ));
            }
        }
    }
    Ok(())
}
