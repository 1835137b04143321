//! Tables of studies, from `docs/studies/*.json`.

use std::path::Path;

use serde_json::Value;

use crate::excerpt::CHARTS;

use crate::number::number;

/// An error above which a run is of no use.
const UNTOLD: f64 = 0.1;
/// Quantities that errors are measured in.
const QUANTITIES: [&str; 5] = ["deflection", "wheel_force", "lateral_force", "reaction", "moment"];

fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().unwrap_or_default()
}

fn list<'a>(value: &'a Value, key: &str) -> &'a [Value] {
    value[key].as_array().map(Vec::as_slice).unwrap_or_default()
}

/// Name of the scene, and until when it is told where that is not its end.
fn scene(study: &Value) -> String {
    let name = text(study, "name");
    study["until"]
        .as_f64()
        .map_or_else(|| name.to_owned(), |time| format!("{name}, until {} s", number(time, 3)))
}

/// An error as the tables write it.
fn error(value: f64) -> String {
    if value == 0.0 { "that of the reference".to_owned() } else { format!("{value:.1e}") }
}

/// A setting in words.
fn label(own: &Value) -> String {
    let value = own["value"].as_f64().unwrap_or(f64::NAN);
    let value = if value < 1.0 { format!("{value:e}") } else { format!("{value}") };
    format!("{}, {} {value}", text(own, "family"), text(own, "knob"))
}

/// How much dearer the scene as written and the choice of "auto" are than the cheapest setting that errs no more.
pub fn dearer(studies: &[Value]) -> String {
    let mut out = "| scene | setting | by | deflection | wheel force | lateral | reaction | moment |\n|---|---|---|---|---|---|---|---|\n".to_owned();
    for study in studies {
        // among methods alone where no reference tells what foundations err by
        let is_told = study["dearer_by_stages"]["as written"]["deflection"].is_number();
        let methods = (!is_told).then_some(("stepping", "as written, among methods"));
        for (own, word) in [("as written", "as written"), ("auto", "auto")].into_iter().chain(methods) {
            for (by, key) in [("contact solutions", "dearer_by_stages"), ("time", "dearer_by_time")] {
                let ratios = &study[key][own];
                let cells: Vec<String> = QUANTITIES
                    .iter()
                    .map(|name| ratios[*name].as_f64().map_or_else(String::new, |value| number(value, 3)))
                    .collect();
                if cells.iter().any(|cell| !cell.is_empty()) {
                    let name = scene(study);
                    out += &format!("| {name} | {word} | {by} | {} |\n", cells.join(" | "));
                }
            }
        }
    }
    out
}

/// Settings on the front of the deflection by time: nothing is both cheaper and closer.
pub fn fronts(studies: &[Value]) -> String {
    let mut out = "| scene | setting | error of deflection | wheel force | median, ms | least to most | contact solutions |\n|---|---|---|---|---|---|---|\n".to_owned();
    for study in studies {
        let of = |own: &Value, name: &str| own["errors"][name].as_f64();
        let (against, least) = reference(study);
        let compared = |own: &&Value| text(own, "against") == against;
        let mut own: Vec<(&Value, f64, f64)> = list(study, "settings")
            .iter()
            .filter(compared)
            .filter_map(|own| Some((own, of(own, "deflection")?, own["median"].as_f64()?)))
            .collect();
        own.sort_by(|a, b| a.2.total_cmp(&b.2));
        let mut best = f64::INFINITY;
        for (own, error_of, median) in own {
            if error_of.max(least) >= best {
                continue;
            }
            best = error_of.max(least);
            let ms = |key: &str| own[key].as_f64().map_or_else(String::new, |value| number(1e3 * value, 2));
            let told = |value: f64| {
                if value <= least { format!("below {least:.0e}") } else { format!("{value:.1e}") }
            };
            out += &format!(
                "| {} | {} | {} | {} | {} | {} to {} | {} |\n",
                scene(study),
                label(own),
                told(error_of),
                of(own, "wheel_force").map_or_else(String::new, error),
                number(1e3 * median, 3),
                ms("least"),
                ms("most"),
                own["stages"],
            );
        }
    }
    out
}

/// How the studies were run.
pub fn commands(studies: &[Value]) -> String {
    let mut out = "```sh\n".to_owned();
    for study in studies {
        out += &format!("{}\n", text(study, "command"));
    }
    out + "```\n"
}

/// The first reference that tells errors of deflections below [`UNTOLD`], and from where on; that of the scene's own
/// foundations, which comes last, where none does.
fn reference(study: &Value) -> (&str, f64) {
    let all = || {
        let references = list(study, "references").iter();
        references.map(|own| (text(own, "against"), own["tells_from"]["deflection"].as_f64().unwrap_or(0.0)))
    };
    let charted = |against: &str| against != "massless";
    let told = all().find(|(against, least)| charted(against) && *least < UNTOLD);
    told.or_else(|| all().next_back()).unwrap_or(("own", 0.0))
}

/// Memory of the scene as written, of the choice of "auto" and of the dearest setting.
pub fn memory(studies: &[Value]) -> String {
    let mut out =
        "| scene | setting | foundations, kB | run, kB | error of deflection |\n|---|---|---|---|---|\n"
            .to_owned();
    for study in studies {
        let held = |own: &Value| {
            Some(own["memory"]["run"].as_f64()? + own["memory"]["foundations"].as_f64().unwrap_or(0.0))
        };
        let most = list(study, "settings")
            .iter()
            .filter(|own| held(own).is_some())
            .max_by(|a, b| held(a).unwrap_or(0.0).total_cmp(&held(b).unwrap_or(0.0)));
        let named = |family: &str| list(study, "settings").iter().find(|own| text(own, "family") == family);
        let is_told = reference(study).0 == "whole";
        for own in [named("as written"), named("auto"), most].into_iter().flatten() {
            let Some(run) = own["memory"]["run"].as_f64() else { continue };
            let foundations = own["memory"]["foundations"].as_f64().unwrap_or(0.0);
            out += &format!(
                "| {} | {} | {} | {} | {} |\n",
                scene(study),
                label(own),
                number(1e-3 * foundations, 3),
                number(1e-3 * run, 3),
                own["errors"]["deflection"]
                    .as_f64()
                    .filter(|_| is_told || text(own, "against") != "whole")
                    .map_or_else(String::new, error),
            );
        }
    }
    out
}

/// Charts of the studies that `docs/studies` has, a heading a scene.
pub fn charts(root: &Path, names: &[&str]) -> String {
    let mut out = String::new();
    for name in names {
        for (_, ending) in CHARTS {
            let path = format!("studies/{name}-{ending}.svg");
            if root.join("docs").join(&path).is_file() {
                out += &format!("![{name}: error against time, {ending}]({path})\n\n");
            }
        }
    }
    out
}
