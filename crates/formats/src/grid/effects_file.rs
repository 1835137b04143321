//! Reading and writing the member `effects` of a grid file: influence lines at the stations.

use std::fmt::Write;

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Map, Value, json};
use splines::Axis;

use super::effects::{EffectLines, Effects, Reaction, ReactionPoint, SectionForces};
use crate::spec::{COMPONENTS, CutPlace};
use crate::text::fault::{Fault, Faults};
use crate::text::place::Place;
use crate::units::Units;

crate::text::object::objects!(RawEffects, RawUnits, RawReaction, RawSection, RawLines);

const AXES: [(&str, Axis); 3] = [
    ("vertical", Axis::Vertical),
    ("lateral", Axis::Lateral),
    ("longitudinal", Axis::Longitudinal),
];

/// Reactions and internal forces under unit loads at the stations.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object", remote = "Self")]
pub(crate) struct RawEffects {
    /// Units of forces and moments per unit load, for information: they follow from the units of the file.
    #[serde(rename = "units")]
    _units: Option<RawUnits>,
    /// Reactions of the ground.
    reactions: Option<Vec<RawReaction>>,
    /// Internal forces at the sections.
    sections: Option<Vec<RawSection>>,
}

/// Units of forces and moments per unit load.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object", remote = "Self")]
struct RawUnits {
    /// Unit of a force per unit load.
    #[serde(rename = "force")]
    _force: Option<String>,
    /// Unit of a moment per unit load.
    #[serde(rename = "moment")]
    _moment: Option<String>,
}

/// Reaction of the ground, with one value for each station under a unit load there.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object", remote = "Self")]
struct RawReaction {
    /// Coordinate of the support of a girder, length.
    x: Option<f64>,
    /// Index of the supported point of a frame.
    point: Option<usize>,
    /// Degree of freedom: global direction of the force, or axis of the moment.
    dof: Option<String>,
    /// Index of the spring that supplies the reaction; absent for supports.
    spring: Option<usize>,
    /// Values under vertical loads.
    vertical: Option<Vec<f64>>,
    /// Values under lateral loads.
    lateral: Option<Vec<f64>>,
    /// Values under longitudinal loads.
    longitudinal: Option<Vec<f64>>,
}

/// Internal forces at one section, in the local axes of the member.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object", remote = "Self")]
struct RawSection {
    /// Name of the section.
    name: Option<String>,
    /// Coordinate on a girder from the first support, length.
    x: Option<f64>,
    /// Member of a frame as [block, index], counted from 0.
    cell: Option<[usize; 2]>,
    /// Position as a fraction of the flexible length of the member, from end a.
    at: Option<f64>,
    /// Axial force, positive in tension.
    #[serde(rename = "N")]
    n: Option<RawLines>,
    /// Shear force along local y.
    #[serde(rename = "Vy")]
    vy: Option<RawLines>,
    /// Shear force along local z.
    #[serde(rename = "Vz")]
    vz: Option<RawLines>,
    /// Torsional moment.
    #[serde(rename = "Mx")]
    mx: Option<RawLines>,
    /// Bending moment about local y.
    #[serde(rename = "My")]
    my: Option<RawLines>,
    /// Bending moment about local z.
    #[serde(rename = "Mz")]
    mz: Option<RawLines>,
}

/// Values of one component, with one value for each station under a unit load there.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object", remote = "Self")]
struct RawLines {
    /// Values under vertical loads.
    vertical: Option<Vec<f64>>,
    /// Values under lateral loads.
    lateral: Option<Vec<f64>>,
    /// Values under longitudinal loads.
    longitudinal: Option<Vec<f64>>,
}

/// The member as text, with one reaction or section per line, in the units `units` of the file.
pub fn write(effects: &Effects, units: Units) -> String {
    let (force, length) = (units.force.word(), units.length.word());
    let own = json!({ "force": format!("{force}/{force}"), "moment": format!("{force} {length}/{force}") });
    let mut text = format!("{{\n    \"units\": {own}");
    let mut list = |key: &str, items: &mut dyn ExactSizeIterator<Item = Value>| {
        let end = if items.len() == 0 { "" } else { "\n    " };
        // writing to a string cannot fail
        let _ = write!(text, ",\n    \"{key}\": [");
        for (index, item) in items.enumerate() {
            let _ = write!(text, "{}\n      {item}", if index > 0 { "," } else { "" });
        }
        let _ = write!(text, "{end}]");
    };
    list("reactions", &mut effects.reactions.iter().map(reaction));
    list("sections", &mut effects.sections.iter().map(section));
    text.push_str("\n  }");
    text
}

fn reaction(reaction: &Reaction) -> Value {
    let mut object = Map::new();
    match reaction.at {
        ReactionPoint::Along(x) => object.insert("x".into(), json!(x)),
        ReactionPoint::Point(point) => object.insert("point".into(), json!(point)),
    };
    object.insert("dof".into(), json!(reaction.dof));
    if let Some(spring) = reaction.spring {
        object.insert("spring".into(), json!(spring));
    }
    object.extend(lines(&reaction.lines));
    Value::Object(object)
}

fn section(section: &SectionForces) -> Value {
    let mut object = Map::new();
    object.insert("name".into(), json!(section.name));
    match section.at {
        CutPlace::Along(x) => {
            object.insert("x".into(), json!(x));
        }
        CutPlace::Cell(cell, at) => {
            object.insert("cell".into(), json!(cell));
            object.insert("at".into(), json!(at));
        }
    }
    for ((word, _), own) in COMPONENTS.iter().zip(&section.lines) {
        object.insert((*word).to_owned(), Value::Object(lines(own)));
    }
    Value::Object(object)
}

fn lines(lines: &EffectLines) -> Map<String, Value> {
    let named = AXES.iter().filter_map(|(word, axis)| {
        let (_, line) = lines.iter().find(|(known, _)| known == axis)?;
        Some(((*word).to_owned(), json!(line)))
    });
    named.collect()
}

impl RawEffects {
    /// Reads the influence lines of a file with `size` stations. Lines of a different length are faults.
    pub fn effects(&self, size: usize, place: &Place<'_>, faults: &mut Faults) -> Effects {
        let mut effects = Effects::default();
        let list = place.key("reactions");
        for (index, raw) in self.reactions.iter().flatten().enumerate() {
            let at = list.index(index);
            let ground = match (raw.x, raw.point) {
                (Some(x), None) => Some(ReactionPoint::Along(x)),
                (None, Some(point)) => Some(ReactionPoint::Point(point)),
                _ => {
                    faults.add(Fault::new(&at, "must have one of `x` and `point`"));
                    None
                }
            };
            let dof = faults.require(&raw.dof, &at, "dof").cloned();
            let lines = read(
                [&raw.vertical, &raw.lateral, &raw.longitudinal],
                size,
                &at,
                faults,
            );
            if let (Some(at), Some(dof)) = (ground, dof) {
                effects.reactions.push(Reaction {
                    at,
                    dof,
                    spring: raw.spring,
                    lines,
                });
            }
        }
        let list = place.key("sections");
        for (index, raw) in self.sections.iter().flatten().enumerate() {
            let at = list.index(index);
            let spot = match (raw.x, raw.cell.zip(raw.at)) {
                (Some(x), None) => Some(CutPlace::Along(x)),
                (None, Some((cell, fraction))) => Some(CutPlace::Cell(cell, fraction)),
                _ => {
                    faults.add(Fault::new(&at, "must have either `x`, or `cell` and `at`"));
                    None
                }
            };
            let name = faults.require(&raw.name, &at, "name").cloned();
            let all = [&raw.n, &raw.vy, &raw.vz, &raw.mx, &raw.my, &raw.mz];
            let lines = std::array::from_fn(|k| {
                let word = COMPONENTS[k].0;
                let own = faults.require(all[k], &at, word).map(|own| {
                    read(
                        [&own.vertical, &own.lateral, &own.longitudinal],
                        size,
                        &at.key(word),
                        faults,
                    )
                });
                own.unwrap_or_default()
            });
            if let (Some(at), Some(name)) = (spot, name) {
                effects.sections.push(SectionForces { name, at, lines });
            }
        }
        effects
    }
}

/// Reads the influence lines of the three load directions, each with `size` numbers.
fn read(
    all: [&Option<Vec<f64>>; 3],
    size: usize,
    place: &Place<'_>,
    faults: &mut Faults,
) -> EffectLines {
    let mut lines = EffectLines::new();
    for ((word, axis), line) in AXES.iter().zip(all) {
        let Some(line) = line else { continue };
        if line.len() != size {
            let expected = format!("must have {size} numbers, one for each station");
            faults.add(Fault::new(&place.key(word), expected).got(line.len()));
        }
        lines.push((*axis, line.clone()));
    }
    lines
}
