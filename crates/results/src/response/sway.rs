//! How far bodies in space swing.

use serde_json::{Map, Value, json};

use crate::record::NamedColumns;
use formats::scene::Scene;

/// Range of a body in space.
#[derive(Clone, Debug, PartialEq)]
pub struct Sway {
    /// Its name.
    pub body: String,
    /// Smallest and largest X, Y and Z.
    pub range: [[f64; 2]; 3],
}

impl Sway {
    /// As a member of `sway`.
    #[must_use]
    pub fn json(&self) -> Value {
        let axes = ["X", "Y", "Z"].into_iter().zip(&self.range);
        Value::Object(axes.map(|(axis, range)| (axis.to_owned(), json!(range))).collect::<Map<_, _>>())
    }
}

/// Of every body in space.
pub(super) fn all(scene: &Scene, record: &NamedColumns) -> Vec<Sway> {
    let bodies = scene.bodies.iter().filter(|body| body.in_space);
    let range = |values: &[f64]| {
        let least = values.iter().copied().reduce(f64::min)?;
        Some([least, values.iter().copied().reduce(f64::max)?])
    };
    bodies
        .filter_map(|body| {
            let [x, y, z] = ["X", "Y", "Z"].map(|axis| range(record.part(&body.name, axis)));
            Some(Sway { body: body.name.clone(), range: [x?, y?, z?] })
        })
        .collect()
}
