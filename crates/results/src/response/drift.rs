//! How far frames give sideways at the level of the crane, against their height.

use fea::{Model, Rail};
use nalgebra::Vector3;
use serde_json::{Value, json};
use splines::{Axis, Error, Probe};

use super::loaded::{LoadedStructure, spread};
use super::spans::spans;
use super::wheel_load::WheelLoadHistory;
use formats::scene::Origin;
use formats::spec::Form;
use formats::units::{Dimension, Scale, Units};
use foundations::SolvedModel;

/// Output times looked at.
const TIMES: usize = 300;

/// Largest sideways displacement of a rail over the columns that carry it.
#[derive(Clone, Debug, PartialEq)]
pub struct Drift {
    /// Name of the rail.
    pub rail: String,
    /// Where along it: a column.
    pub x: f64,
    /// Height of the rail over the lowest support.
    pub height: f64,
    /// The displacement, to either side.
    pub value: f64,
    /// When.
    pub time: f64,
    /// Code, clause, displacement that it accepts.
    pub limits: Vec<(&'static str, &'static str, f64)>,
}

impl Drift {
    /// Height over displacement; `None` without displacement.
    #[must_use]
    pub fn ratio(&self) -> Option<f64> {
        let ratio = self.height / self.value;
        (self.value > 0.0 && ratio.is_finite()).then_some(ratio)
    }

    /// As an item of `drift`.
    #[must_use]
    pub fn json(&self) -> Value {
        let limit = |(code, clause, most): &(&str, &str, f64)| json!({ "code": code, "clause": clause, "value": most, "within": self.value <= *most });
        json!({
            "rail": self.rail,
            "x": self.x,
            "height": self.height,
            "displacement": self.value,
            "time": self.time,
            "height_over_displacement": self.ratio(),
            "limits": self.limits.iter().map(limit).collect::<Vec<_>>(),
        })
    }
}

/// The worst column of every rail of a frame on the ground, at up to 300 evenly spread output times; none on rigid foundations, where no
/// wheel pushes sideways, and where the freedoms of the structure were not recorded.
///
/// # Errors
/// A place beyond a rail.
pub(super) fn of(loaded: &LoadedStructure<'_>, solved: Option<&SolvedModel>) -> Result<Vec<Drift>, Error> {
    let LoadedStructure { scene, s, history, laid, .. } = *loaded;
    let own = &scene.structures[s];
    let (Origin::Spec { spec, .. }, Some(solved), true, None, None) =
        (&own.origin, solved, loaded.is_known(), &laid.foundation.parts, own.on)
    else {
        return Ok(Vec::new());
    };
    if matches!(spec.form, Form::Girder(_)) || history.is_empty() {
        return Ok(Vec::new());
    }
    let all: Vec<(usize, Vec<WheelLoadHistory>)> =
        spread(history.len(), TIMES).map(|row| (row, loaded.on(row))).collect();
    let pushed = all.iter().flat_map(|(_, loads)| loads).any(|load| load.force[2] != 0.0);
    let mut found = Vec::new();
    for rail in scene.rails.iter().filter(|rail| rail.structure == s && pushed) {
        let columns = spans(spec, &solved.model, &solved.rails, rail.rail);
        let inside = |x: &f64| *x >= rail.range[0] && *x <= rail.range[1];
        let columns: Vec<f64> = columns.into_iter().filter(inside).collect();
        let height = height(&solved.model, &solved.rails, rail.rail).filter(|height| *height > 0.0);
        let (Some(height), false) = (height, columns.is_empty()) else { continue };
        let probe = |x: &f64| Probe { rail: rail.rail, x: *x, axis: Axis::Lateral };
        let probes: Vec<Probe> = columns.iter().map(probe).collect();
        let limits = limits(scene.units, height);
        let mut worst =
            Drift { rail: rail.name.clone(), x: columns[0], height, value: 0.0, time: 0.0, limits };
        for (row, on) in &all {
            let Some(moved) = loaded.displacements(&probes, on, *row)? else { break };
            let time = history.sample(*row)[0];
            for (x, moved) in columns.iter().zip(moved) {
                if moved.abs() > worst.value {
                    worst = Drift { x: *x, value: moved.abs(), time, ..worst };
                }
            }
        }
        found.push(worst);
    }
    Ok(found)
}

/// What is accepted at a height.
///
/// # Source
/// AIST TR-13 (2021), 5.3; EN 1993-6:2007, 7.3, Table 7.1 (b), as a public program has it: loads without dynamic factors.
fn limits(units: Units, height: f64) -> Vec<(&'static str, &'static str, f64)> {
    let metre = Scale { from: units, to: Units::SI }.factor(Dimension::LENGTH);
    let mut limits = vec![("EN 1993-6:2007", "Table 7.1 b: height/400", height / 400.0)];
    if let Ok(most) = practice::aist::drift(height * metre) {
        limits.push(("AIST TR-13", "5.3 (2021): height/400, at most 2 in", most / metre));
    }
    limits
}

/// Height of a rail over the lowest support.
fn height(model: &Model, rails: &[Rail], rail: usize) -> Option<f64> {
    let up = Vector3::from(model.up).try_normalize(0.0)?;
    let segment = rails.get(rail)?.segments.first()?;
    let member = model.members.get(segment.member)?;
    let of = |point: [f64; 3]| Vector3::from(point).dot(&up);
    let top = of(*model.points.get(member.points[0])?) + of(member.offsets[0]) + of(segment.offset);
    let base = model.supports.iter().filter_map(|support| model.points.get(support.point));
    let base = base.map(|point| of(*point)).reduce(f64::min)?;
    Some(top - base)
}
