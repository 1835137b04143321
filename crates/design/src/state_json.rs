//! Where the trains of a state stand, as members of a row of `summary.json`.

use formats::design::Design;
use serde_json::{Map, Value, json};
use trains::{Governing, TrainPosition};

/// Names of the trains of a case, numbered where a train occurs several times.
pub(crate) fn train_names(design: &Design, case: usize) -> Vec<String> {
    let trains = &design.cases[case].trains;
    trains
        .iter()
        .enumerate()
        .map(|(k, train)| {
            let name = &design.trains[*train].name;
            if trains.iter().filter(|other| *other == train).count() == 1 {
                return name.clone();
            }
            format!(
                "{name}{}",
                trains[..=k].iter().filter(|other| *other == train).count()
            )
        })
        .collect()
}

/// Adds where the trains stand: the first one, and all of them by name.
pub(crate) fn add_state(out: &mut Value, names: &[String], g: &Governing) {
    let one = |train: &TrainPosition| json!({ "position": train.position + 0.0, "turned": train.stance.turned });
    let positions: Map<String, Value> = names
        .iter()
        .cloned()
        .zip(g.trains.iter().map(one))
        .collect();
    let signs: Map<String, Value> = names
        .iter()
        .zip(&g.trains)
        .map(|(name, train)| {
            let [lateral, longitudinal, eccentricity] = train.stance.signs;
            let signs =
                json!({ "lateral": lateral, "longitudinal": longitudinal, "eccentricity": eccentricity });
            (name.clone(), signs)
        })
        .collect();
    out["train"] = json!(names.first());
    out["position"] = json!(g.trains.first().map(|train| train.position + 0.0));
    out["positions"] = Value::Object(positions);
    out["signs"] = Value::Object(signs);
}
