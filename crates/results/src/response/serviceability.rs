//! Serviceability of rails: deflection of spans relative to their length, and drift of frames relative to their
//! height.
//!
//! Both are evaluated after a run. At selected output times the displacements of the rail are computed from the wheel
//! forces and the recorded degrees of freedom, u = G F + Phi q ([`LoadedStructure::displacements`]), at several
//! positions within each span or at the columns of a frame. The largest value is stored with its position and time.

use design::clause_json;
use fea::{Model, Rail};
use nalgebra::Vector3;
use practice::clause::{CodeClause, Evidence, aist_2021, en_1993_6};
use practice::cmaa;
use serde_json::{Value, json};
use splines::{Axis, Error, Probe};

use super::SolvedStructures;
use super::loaded::{LoadedStructure, WheelLoad, spread};
use formats::scene::Origin;
use formats::spec::Form;
use formats::units::{Dimension, Scale, Units};
use foundations::SolvedModel;

/// Number of positions evaluated within a span.
const PLACES: usize = 7;
/// Largest number of output times at which a span is evaluated.
const SPAN_TIMES: usize = 64;
/// Largest number of output times at which a frame is evaluated.
const FRAME_TIMES: usize = 300;
/// Usual limits of the ratio of span to deflection.
const LIMITS: [f64; 2] = [cmaa::RUNWAY_VERTICAL, cmaa::RUNWAY_LATERAL];

/// What a comparison of a deflection of a run with limits of static deflections means.
pub const WITHIN_NOTE: &str = "deflection under the forces of this run; L/600 and L/400 are limits of static wheel \
                               loads, see practice.limits";

/// Largest deflection of a rail from the chord between the ends of a span.
#[derive(Clone, Debug, PartialEq)]
pub struct Deflection {
    /// Name of the rail.
    pub rail: String,
    /// `vertical` (downwards) or `lateral` (to either side).
    pub direction: &'static str,
    /// Ends of the span.
    pub span: [f64; 2],
    /// The deflection.
    pub value: f64,
    /// Rail coordinate of the largest deflection.
    pub x: f64,
    /// Time of the largest value.
    pub time: f64,
}

impl Deflection {
    /// Ratio of the length of the span to its deflection; `None` without deflection.
    #[must_use]
    pub fn ratio(&self) -> Option<f64> {
        let ratio = (self.span[1] - self.span[0]) / self.value;
        (self.value > 0.0 && ratio.is_finite()).then_some(ratio)
    }

    /// Whether the ratio of span to deflection is at least `limit`.
    #[must_use]
    pub fn is_within(&self, limit: f64) -> bool {
        self.ratio().is_none_or(|ratio| ratio >= limit)
    }

    /// As an item of `deflection_ratios`.
    #[must_use]
    pub fn json(&self) -> Value {
        let [vertical, lateral] = LIMITS;
        json!({
            "rail": self.rail,
            "direction": self.direction,
            "from": self.span[0],
            "to": self.span[1],
            "deflection": self.value,
            "x": self.x,
            "time": self.time,
            "span_over_deflection": self.ratio(),
            "within": { "L/600": self.is_within(vertical), "L/400": self.is_within(lateral) },
            "within_note": WITHIN_NOTE,
        })
    }
}

/// The largest deflections of every loaded span of the structure; none for rigid foundations, for tables, for rigid
/// parts with separate contacts, and where the degrees of freedom of the structure were not recorded.
///
/// Each span is evaluated at seven positions and at up to 64 output times, evenly distributed over those with a wheel
/// on the span. With the displacement u(x) of the rail and the fraction l of the span at x, the deflection from the
/// chord between the ends a and b is (1 - l) u(a) + l u(b) - u(x), positive downwards.
///
/// # Errors
/// [`Error::OffRail`] for a place beyond a rail.
pub(super) fn deflections(
    loaded: &LoadedStructure<'_>,
    solved: SolvedStructures<'_>,
) -> Result<Vec<Deflection>, Error> {
    let LoadedStructure {
        scene,
        s,
        history,
        built,
        ..
    } = *loaded;
    let (Origin::Spec { .. }, Some(_), true, None) = (
        &scene.structures[s].origin,
        solved.models[s],
        loaded.is_known(),
        &built.foundation.parts,
    ) else {
        return Ok(Vec::new());
    };
    let all: Vec<Vec<WheelLoad>> = (0..history.len()).map(|row| loaded.on(row)).collect();
    let lateral = all.iter().flatten().any(|load| load.force[2] != 0.0);
    let axes: &[(Axis, &'static str)] = match lateral {
        true => &[(Axis::Vertical, "vertical"), (Axis::Lateral, "lateral")],
        false => &[(Axis::Vertical, "vertical")],
    };
    let mut found = Vec::new();
    for (index, rail) in scene
        .rails
        .iter()
        .enumerate()
        .filter(|(_, rail)| rail.structure == s)
    {
        for (plane, &(axis, direction)) in axes.iter().enumerate() {
            for pair in solved.chords.get(index).map_or(&[][..], |own| &own[plane]) {
                let span = [pair[0].max(rail.range[0]), pair[1].min(rail.range[1])];
                let [from, to] = span;
                let inside = |load: &WheelLoad| {
                    load.rail == rail.rail && load.x > from && load.x < to && load.force[1] != 0.0
                };
                let rows: Vec<usize> = (0..all.len())
                    .filter(|&i| all[i].iter().any(inside))
                    .collect();
                if from >= to || rows.is_empty() {
                    continue;
                }
                let places: Vec<f64> = (0..=PLACES + 1)
                    .map(|k| from + (to - from) * k as f64 / (PLACES + 1) as f64)
                    .collect();
                let none = Deflection {
                    rail: rail.name.clone(),
                    direction,
                    span,
                    value: 0.0,
                    x: from,
                    time: 0.0,
                };
                found.push(largest_deflection(
                    loaded,
                    none,
                    (rail.rail, axis),
                    &places,
                    (&rows, &all),
                )?);
            }
        }
    }
    Ok(found)
}

/// The largest deflection of one span in one direction at `places`, or `none` where there is none; the first and the
/// last place are the ends of the span. `rows`: output times with a wheel on the span; `all`: the loads at every
/// output time.
fn largest_deflection(
    loaded: &LoadedStructure<'_>,
    none: Deflection,
    (rail, axis): (usize, Axis),
    places: &[f64],
    (rows, all): (&[usize], &[Vec<WheelLoad>]),
) -> Result<Deflection, Error> {
    let probes: Vec<Probe> = places.iter().map(|&x| Probe { rail, x, axis }).collect();
    let mut largest = none;
    for row in spread(rows.len(), SPAN_TIMES).map(|k| rows[k]) {
        // no deflection is reported in a direction in which the structure is unrestrained
        let Some(moved) = loaded.displacements(&probes, &all[row], row)? else {
            break;
        };
        let time = loaded.history.sample(row)[0];
        for (k, &x) in places.iter().enumerate().skip(1).take(PLACES) {
            let fraction = k as f64 / (PLACES + 1) as f64;
            let sag = (1.0 - fraction) * moved[0] + fraction * moved[PLACES + 1] - moved[k];
            let value = if axis == Axis::Vertical {
                sag
            } else {
                sag.abs()
            };
            if value > largest.value {
                largest = Deflection {
                    value,
                    x,
                    time,
                    ..largest
                };
            }
        }
    }
    Ok(largest)
}

/// Largest lateral displacement of a rail at the columns that carry it.
#[derive(Clone, Debug, PartialEq)]
pub struct Drift {
    /// Name of the rail.
    pub rail: String,
    /// Rail coordinate of the column.
    pub x: f64,
    /// Height of the rail over the lowest support.
    pub height: f64,
    /// Magnitude of the displacement.
    pub value: f64,
    /// Time of the largest value.
    pub time: f64,
    /// Clause, formula in words and allowable displacement.
    pub limits: Vec<(CodeClause, &'static str, f64)>,
}

impl Drift {
    /// Ratio of the height to the displacement; `None` without displacement.
    #[must_use]
    pub fn ratio(&self) -> Option<f64> {
        let ratio = self.height / self.value;
        (self.value > 0.0 && ratio.is_finite()).then_some(ratio)
    }

    /// As an item of `drift`.
    #[must_use]
    pub fn json(&self) -> Value {
        let limit = |(clause, formula, most): &(CodeClause, &str, f64)| {
            let mut members = clause_json(clause);
            members["formula"] = json!(formula);
            members["value"] = json!(most);
            members["within"] = json!(self.value <= *most);
            members
        };
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

/// The column with the largest drift of every rail of a frame on the ground, at up to 300 evenly distributed output
/// times; none for rigid foundations, without lateral wheel forces, and where the degrees of freedom of the structure
/// were not recorded.
///
/// # Errors
/// [`Error::OffRail`] for a place beyond a rail.
pub(super) fn drifts(
    loaded: &LoadedStructure<'_>,
    solved: Option<&SolvedModel>,
) -> Result<Vec<Drift>, Error> {
    let LoadedStructure {
        scene,
        s,
        history,
        built,
        ..
    } = *loaded;
    let structure = &scene.structures[s];
    let (Origin::Spec { spec, .. }, Some(solved), true, None, None) = (
        &structure.origin,
        solved,
        loaded.is_known(),
        &built.foundation.parts,
        structure.carrier,
    ) else {
        return Ok(Vec::new());
    };
    if matches!(spec.form, Form::Girder(_)) || history.is_empty() {
        return Ok(Vec::new());
    }
    let all: Vec<(usize, Vec<WheelLoad>)> = spread(history.len(), FRAME_TIMES)
        .map(|row| (row, loaded.on(row)))
        .collect();
    let is_loaded = all
        .iter()
        .flat_map(|(_, loads)| loads)
        .any(|load| load.force[2] != 0.0);
    let mut found = Vec::new();
    for rail in scene
        .rails
        .iter()
        .filter(|rail| rail.structure == s && is_loaded)
    {
        let columns = spec.spans(&solved.model, &solved.rails, rail.rail);
        let inside = |x: &f64| *x >= rail.range[0] && *x <= rail.range[1];
        let columns: Vec<f64> = columns.into_iter().filter(inside).collect();
        let height = height(&solved.model, &solved.rails, rail.rail).filter(|height| *height > 0.0);
        let (Some(height), false) = (height, columns.is_empty()) else {
            continue;
        };
        let probe = |x: &f64| Probe {
            rail: rail.rail,
            x: *x,
            axis: Axis::Lateral,
        };
        let probes: Vec<Probe> = columns.iter().map(probe).collect();
        let limits = drift_limits(scene.units, height);
        let mut largest = Drift {
            rail: rail.name.clone(),
            x: columns[0],
            height,
            value: 0.0,
            time: 0.0,
            limits,
        };
        for (row, on) in &all {
            let Some(moved) = loaded.displacements(&probes, on, *row)? else {
                break;
            };
            let time = history.sample(*row)[0];
            for (x, moved) in columns.iter().zip(moved) {
                if moved.abs() > largest.value {
                    largest = Drift {
                        x: *x,
                        value: moved.abs(),
                        time,
                        ..largest
                    };
                }
            }
        }
        found.push(largest);
    }
    Ok(found)
}

/// Limits of the drift of a rail at `height` over the lowest support: clause, formula, displacement.
///
/// # Source
/// AIST TR-13 (2021), 5.3; EN 1993-6:2007, 7.3, Table 7.1 (b), as implemented in a public program: loads without
/// dynamic factors.
fn drift_limits(units: Units, height: f64) -> Vec<(CodeClause, &'static str, f64)> {
    let metre = Scale {
        from: units,
        to: Units::SI,
    }
    .factor(Dimension::LENGTH);
    let mut limits = vec![(
        en_1993_6("Table 7.1 b", Evidence::Used),
        "height/400",
        height / 400.0,
    )];
    if let Ok(most) = practice::aist::drift(height * metre) {
        limits.push((
            aist_2021("5.3", Evidence::Quoted),
            "height/400, at most 2 in",
            most / metre,
        ));
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
    let base = model
        .supports
        .iter()
        .filter_map(|support| model.points.get(support.point));
    let base = base.map(|point| of(*point)).reduce(f64::min)?;
    Some(top - base)
}
