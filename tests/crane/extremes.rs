//! Extremes of girders after flanges have struck.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::{run, scene};

/// The scene of the foundations for 1.5 s, in which flanges strike, with an output interval: extremes by rail, span,
/// quantity, plane and kind, and the notes.
fn extremes(dt: f64) -> (BTreeMap<String, f64>, Vec<String>) {
    let mut scene = scene("foundations");
    scene["end"]["time"] = json!(1.5);
    scene["output"] = json!({"dt": dt, "reactions": false, "sections": false, "stresses": false});
    let (_, summary) = run(&scene);
    let of = |extreme: &Value| {
        let words = [
            "rail",
            "span",
            "quantity",
            "plane",
            "support",
            "direction",
            "kind",
        ]
        .map(|key| extreme[key].to_string());
        (words.join(" "), extreme["value"].as_f64().expect("a value"))
    };
    let notes = summary["notes"].as_array().into_iter().flatten();
    (
        summary["extremes"]
            .as_array()
            .expect("extremes")
            .iter()
            .map(of)
            .collect(),
        notes
            .map(|note| note.as_str().expect("a sentence").to_owned())
            .collect(),
    )
}

/// Physical identity: what a girder bears does not depend on how often it is written down. The accuracy of the scene is 1e-4;
/// from output rows 0.05 s apart alone, forces would be up to 1.5e-2 of the largest too small.
#[test]
fn extremes_do_not_depend_on_the_output_interval_after_a_strike() {
    let [(coarse, notes), (fine, _)] = [0.05, 0.005].map(extremes);
    assert!(
        notes
            .iter()
            .any(|note| note.contains("impact of the flange")),
        "no flange impact: {notes:?}"
    );
    assert_eq!(coarse.len(), fine.len());
    let word = |key: &str| {
        let is = |word: &&str| key.contains(*word);
        *[
            "normal",
            "shear",
            "torsion",
            "moment",
            "deflection",
            "reaction",
        ]
        .iter()
        .find(|word| is(word))
        .expect("a quantity")
    };
    // forces and moments are compared with the largest of their kind
    let kind = |key: &str| match word(key) {
        "normal" | "shear" => 0,
        "torsion" | "moment" => 1,
        "reaction" => usize::from(
            ["rx", "ry", "rz"]
                .iter()
                .any(|word| key.contains(&format!("\"{word}\""))),
        ),
        _ => 2,
    };
    let mut sizes = [0.0_f64; 3];
    fine.iter()
        .for_each(|(key, value)| sizes[kind(key)] = sizes[kind(key)].max(value.abs()));
    let mut worst = (0.0, "");
    for (key, value) in &coarse {
        let error = (value - fine[key]).abs() / sizes[kind(key)];
        if error > worst.0 {
            worst = (error, key);
        }
    }
    println!(
        "{} extremes, largest difference {:.1e}: {}",
        coarse.len(),
        worst.0,
        worst.1
    );
    assert!(worst.0 < 5e-4, "{worst:?}");
}
