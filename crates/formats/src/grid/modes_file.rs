//! Member `modes` of a grid file: natural frequencies, and mode shapes at the stations.

use std::f64::consts::TAU;
use std::fmt::Write;

use fea::{Modes, RefinedModes};
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Map, Value, json};
use splines::{Axis, Probe};

use crate::text::fault::{Fault, Faults};
use crate::text::place::Place;

crate::text::object::objects!(RawModes, RawMode, RawShape);

/// Largest accepted relative discretisation error of the natural frequencies.
pub const MESH_TOLERANCE: f64 = 1e-3;

const AXES: [(&str, Axis); 3] = [
    ("vertical", Axis::Vertical),
    ("lateral", Axis::Lateral),
    ("longitudinal", Axis::Longitudinal),
];

/// The member as text, one mode per line.
///
/// `stations` contains the index of the rail and the coordinate of each station, in the order of the blocks. A
/// direction is omitted if the mode shapes have no value at some station because the rail is not restrained there.
/// Frequencies are written in Hz and rad/s.
#[must_use]
pub fn write(refined: &RefinedModes, stations: &[(usize, f64)]) -> String {
    let modes = &refined.modes;
    let shapes: Vec<(&str, Vec<Vec<[f64; 2]>>)> = AXES
        .into_iter()
        .filter_map(|(word, axis)| {
            let at = stations
                .iter()
                .map(|&(rail, x)| modes.at(Probe { rail, x, axis }));
            Some((word, at.collect::<Result<_, _>>().ok()?))
        })
        .collect();
    let twist: Result<Vec<Vec<f64>>, _> = stations
        .iter()
        .map(|&(rail, x)| modes.twist(rail, x))
        .collect();
    let mut head = Map::new();
    head.insert(
        "complete_below".into(),
        json!({ "hz": modes.shift / TAU, "count": modes.count_below_shift }),
    );
    head.insert("next_hz".into(), json!(modes.next.map(|omega| omega / TAU)));
    head.insert("mesh_error".into(), json!(refined.error));
    head.insert("mass".into(), json!(modes.rigid_mass));
    let mut text = String::from("{\n");
    for (key, value) in &head {
        // writing to a string cannot fail
        let _ = writeln!(text, "    \"{key}\": {value},");
    }
    text.push_str("    \"modes\": [");
    for (k, mode) in modes.modes.iter().enumerate() {
        let mut entry = Map::new();
        entry.insert("hz".into(), json!(mode.omega / TAU));
        entry.insert("omega".into(), json!(mode.omega));
        entry.insert("residual".into(), json!(mode.residual));
        entry.insert("coupling".into(), json!(mode.coupling));
        for (word, at) in &shapes {
            let part = |which: usize| at.iter().map(|modes| modes[k][which]).collect::<Vec<f64>>();
            entry.insert(
                (*word).into(),
                json!({ "value": part(0), "slope": part(1) }),
            );
        }
        if let Ok(twist) = &twist {
            let values: Vec<f64> = twist.iter().map(|modes| modes[k]).collect();
            entry.insert("twist".into(), json!(values));
        }
        let comma = if k > 0 { "," } else { "" };
        let _ = write!(text, "{comma}\n      {}", Value::Object(entry));
    }
    text.push_str("\n    ]\n  }");
    text
}

/// Adds `member` at the end of the text of a grid file written by [`write`](super::file::write).
#[must_use]
pub fn append(grid: &str, member: &str) -> String {
    let body = grid.strip_suffix("\n}\n").unwrap_or(grid);
    format!("{body},\n  \"modes\": {member}\n}}\n")
}

/// One line for the terminal: the first frequencies, and the number of modes below the shift, which equals the number
/// of negative pivots.
#[must_use]
pub fn summary(modes: &Modes) -> String {
    let mut list: Vec<String> = modes
        .modes
        .iter()
        .take(6)
        .map(|mode| hertz(mode.omega))
        .collect();
    if modes.modes.len() > list.len() {
        list.push("...".to_owned());
    }
    format!(
        "modes: {} Hz; {} modes are below {} Hz, and all of them are listed",
        list.join(", "),
        modes.count_below_shift,
        hertz(modes.shift)
    )
}

/// An angular frequency in rad/s as Hz.
fn hertz(omega: f64) -> String {
    format!("{:.4}", omega / TAU)
}

/// Natural modes.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object", remote = "Self")]
pub(crate) struct RawModes {
    /// Frequency below which all modes are listed, with their number.
    #[serde(rename = "complete_below")]
    _complete_below: Option<Value>,
    /// Frequency of the first mode that is not listed, Hz; null if there is none.
    #[serde(rename = "next_hz")]
    _next_hz: Option<f64>,
    /// Estimated relative error of the frequencies due to the mesh.
    #[serde(rename = "mesh_error")]
    _mesh_error: Option<f64>,
    /// Mass matrix of the rigid-body motions, 6 x 6.
    #[serde(rename = "mass")]
    _mass: Option<[[f64; 6]; 6]>,
    /// Modes in ascending order of frequency.
    modes: Option<Vec<RawMode>>,
}

/// A natural mode of modal mass 1.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object", remote = "Self")]
struct RawMode {
    /// Natural frequency, Hz.
    hz: Option<f64>,
    /// Natural angular frequency, radian / time.
    #[serde(rename = "omega")]
    _omega: Option<f64>,
    /// Scaled residual of the eigenvalue equation.
    #[serde(rename = "residual")]
    _residual: Option<f64>,
    /// Participation factors of three translations and three rotations.
    #[serde(rename = "coupling")]
    _coupling: Option<[f64; 6]>,
    /// Vertical displacement at the stations.
    vertical: Option<RawShape>,
    /// Lateral displacement at the stations.
    lateral: Option<RawShape>,
    /// Longitudinal displacement at the stations.
    longitudinal: Option<RawShape>,
    /// Rotation about the rail at the stations.
    twist: Option<Vec<f64>>,
}

/// Displacement of a mode in one direction at the stations.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object", remote = "Self")]
struct RawShape {
    /// Displacements.
    value: Vec<f64>,
    /// Derivatives with respect to the rail coordinate.
    slope: Vec<f64>,
}

impl RawModes {
    /// Checks that the frequencies are in ascending order and that every shape has `size` values, one for each
    /// station.
    pub fn check(&self, size: usize, place: &Place<'_>, faults: &mut Faults) {
        let list = place.key("modes");
        let mut last = 0.0;
        for (k, mode) in faults
            .require(&self.modes, place, "modes")
            .into_iter()
            .flatten()
            .enumerate()
        {
            let at = list.index(k);
            if let Some(&hz) = faults.require(&mode.hz, &at, "hz") {
                if hz < last {
                    let fault = Fault::new(&at.key("hz"), "must not be below the one before it");
                    faults.add(fault.got(hz));
                }
                last = hz;
            }
            let shapes = [
                ("vertical", &mode.vertical),
                ("lateral", &mode.lateral),
                ("longitudinal", &mode.longitudinal),
            ];
            let mut check_length = |numbers: &[f64], place: &Place<'_>| {
                if numbers.len() != size {
                    let fault = Fault::new(
                        place,
                        format!("must have {size} numbers, one for each station"),
                    );
                    faults.add(fault.got(numbers.len()));
                }
            };
            for (word, shape) in shapes {
                let Some(shape) = shape else { continue };
                let shape_at = at.key(word);
                check_length(&shape.value, &shape_at.key("value"));
                check_length(&shape.slope, &shape_at.key("slope"));
            }
            if let Some(twist) = &mode.twist {
                check_length(twist, &at.key("twist"));
            }
        }
    }
}
