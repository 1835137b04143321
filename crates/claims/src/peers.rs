//! Tables of other codes side by side, from `docs/peers.json`.

use serde_json::Value;

use crate::number::number;

/// Scenes of `docs/peers.json`, and errors at which crossings are compared.
const LOADS: &str = "61 loads on the girder";
const ERRORS: [f64; 2] = [1e-3, 1e-4];
/// Codes beside ours in the table of crossings.
const OTHERS: [&str; 3] = ["numba", "Exudyn", "scipy"];

struct Run<'a> {
    scene: &'a str,
    code: &'a str,
    setting: &'a str,
    error: f64,
    median: f64,
}

/// All runs; an error that is no number is one without bound.
fn runs(data: &Value) -> Vec<Run<'_>> {
    let all = data.as_array().map(Vec::as_slice).unwrap_or_default().iter();
    all.filter_map(|own| {
        Some(Run {
            scene: own["scene"].as_str()?,
            code: own["code"].as_str()?,
            setting: own["setting"].as_str()?,
            error: own["error"].as_f64().unwrap_or(f64::INFINITY),
            median: own["median_ms"].as_f64()?,
        })
    })
    .collect()
}

/// Unit loads: a row a code and setting.
pub fn loads(data: &Value) -> String {
    let runs = runs(data);
    let ours = runs.iter().find(|own| own.scene == LOADS && own.code == "girderway");
    let mut out = "| code | setting | error | median, ms | by ours |\n|---|---|---|---|---|\n".to_owned();
    for own in runs.iter().filter(|own| own.scene == LOADS) {
        let by = ours.map_or(f64::NAN, |ours| own.median / ours.median);
        out += &format!(
            "| {} | {} | {:.0e} | {} | {} |\n",
            own.code,
            own.setting,
            own.error,
            number(own.median, 3),
            number(by, 2)
        );
    }
    out
}

/// Crossings: cheapest setting of each code that reaches an error, and its time by ours.
pub fn crossings(data: &Value) -> String {
    let runs = runs(data);
    let mut scenes: Vec<&str> = Vec::new();
    for own in runs.iter().filter(|own| own.scene != LOADS) {
        if !scenes.contains(&own.scene) {
            scenes.push(own.scene);
        }
    }
    let mut out = "| scene | error | girderway".to_owned();
    OTHERS.iter().for_each(|code| out += &format!(" | {code} | by ours"));
    out += " |\n|---|---|---";
    OTHERS.iter().for_each(|_| out += "|---|---");
    out += "|\n";
    for scene in scenes {
        for error in ERRORS {
            let least = |code: &str| {
                let own =
                    runs.iter().filter(|own| own.scene == scene && own.code == code && own.error <= error);
                own.map(|own| own.median).min_by(f64::total_cmp)
            };
            let ours = least("girderway");
            let text = |value: Option<f64>| value.map_or_else(String::new, |value| number(value, 3));
            out += &format!("| {scene} | {error:e} | {}", text(ours));
            for code in OTHERS {
                let other = least(code);
                let by = other.zip(ours).map(|(other, ours)| other / ours);
                out += &format!(" | {} | {}", text(other), by.map_or_else(String::new, |by| number(by, 2)));
            }
            out += " |\n";
        }
    }
    out
}
