//! Maps as JSON and CSV.

use serde_json::{Map as Object, Value, json};

use super::map::{MapLayer, MapVerdict, StabilityMap};
use results::columns::bytes;

/// `stability.json`: counts of verdicts, single numbers and messages of every map, and the reasons of absent ones.
#[must_use]
pub fn json(maps: &[StabilityMap], absent: &[(String, String)]) -> Value {
    let points = |ours: bool| {
        let layers = maps
            .iter()
            .flat_map(|map| &map.layers)
            .filter(|layer| layer.is_ours == ours);
        layers.map(|layer| layer.points.len()).sum::<usize>()
    };
    json!({
        "format": "girderway-stability/1",
        "points": { "girderway": points(true), "others": points(false) },
        "silently_wrong": maps.iter().map(StabilityMap::silent_count).sum::<usize>(),
        "maps": maps.iter().map(map).collect::<Vec<_>>(),
        "absent": absent.iter().map(|(name, why)| (name.clone(), json!(why))).collect::<Object<String, Value>>(),
    })
}

fn map(own: &StabilityMap) -> Value {
    let axis = |k: usize| json!({ "label": own.axes[k].label, "unit": own.axes[k].unit });
    let findings = own
        .findings
        .iter()
        .map(|finding| json!({ "what": finding.what, "value": finding.value }));
    json!({
        "name": own.name,
        "title": own.title,
        "note": own.note,
        "x": axis(0),
        "y": axis(1),
        "measured": findings.collect::<Vec<_>>(),
        "methods": own.layers.iter().map(layer).collect::<Vec<_>>(),
    })
}

fn layer(own: &MapLayer) -> Value {
    let counts = MapVerdict::WORDS.iter().zip(own.counts());
    let mut messages: Vec<(&str, usize)> = Vec::new();
    for point in &own.points {
        let MapVerdict::Refused(why) = &point.verdict else {
            continue;
        };
        match messages.iter_mut().find(|(known, _)| known == why) {
            Some((_, count)) => *count += 1,
            None => messages.push((why, 1)),
        }
    }
    let counts = counts.map(|(word, count)| ((*word).to_owned(), json!(count)));
    let messages = messages
        .iter()
        .map(|(why, count)| json!({ "message": why, "points": count }));
    json!({
        "method": own.method,
        "is_girderway": own.is_ours,
        "counts": counts.collect::<Object<String, Value>>(),
        "messages": messages.collect::<Vec<_>>(),
    })
}

/// `stability.csv`: one row for each point.
///
/// # Errors
/// None in practice: memory takes every byte.
pub fn csv(maps: &[StabilityMap]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["map", "method", "x", "y", "verdict", "value"])?;
    for map in maps {
        for layer in &map.layers {
            for point in &layer.points {
                let [x, y] = point.at.map(|own| format!("{own:e}"));
                let value = format!("{:e}", point.value);
                writer.write_record([
                    map.name,
                    &layer.method,
                    &x,
                    &y,
                    point.verdict.word(),
                    &value,
                ])?;
            }
        }
    }
    bytes(writer)
}
