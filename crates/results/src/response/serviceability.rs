//! Serviceability of rails: deflection of spans relative to their length, and drift of frames relative to their
//! height.
//!
//! Both are evaluated after a run, from the displacements of the rail by the wheel forces and the recorded degrees of freedom, u =
//! G F + Phi q ([`displacements`]), at all places of each span or at the columns of a frame, and at all times. The
//! largest value is stored with its position and time.

use design::clause_json;
use fea::{Model, Rail};
use nalgebra::Vector3;
use practice::clause::{CodeClause, Evidence, aist_2021, en_1993_6};
use practice::cmaa;
use serde_json::{Value, json};
use smallvec::SmallVec;
use splines::{Axis, Probe};
use trains::RailLoad;

use super::SolvedStructures;
use super::loaded::{LoadedStructure, PlaceMotions, displacements};
use super::over_time::{LargestInTime, crest, grid, largest_along};
use formats::scene::Origin;
use formats::spec::Form;
use formats::units::{Dimension, Scale, Units};
use foundations::SolvedModel;

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
/// With the displacement u(x) of the rail and the fraction l of the span at x, the deflection from the chord between the
/// ends a and b is (1 - l) u(a) + l u(b) - u(x), positive downwards. The largest one is that at any place, at any time with a
/// wheel on the span ([`super::over_time`]).
pub(super) fn deflections(
    loaded: &LoadedStructure<'_>,
    solved: SolvedStructures<'_>,
) -> Vec<Deflection> {
    let LoadedStructure {
        scene, s, built, ..
    } = *loaded;
    let (Origin::Spec { .. }, Some(_), true, None) = (
        &scene.structures[s].origin,
        solved.models[s],
        loaded.is_known(),
        &built.foundation.parts,
    ) else {
        return Vec::new();
    };
    let rows = &loaded.run.nodes.rows;
    let lateral = rows
        .samples()
        .any(|row| loaded.on(row).iter().any(|load| load.force[2] != 0.0));
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
                if span[0] >= span[1] {
                    continue;
                }
                let none = Deflection {
                    rail: rail.name.clone(),
                    direction,
                    span,
                    value: 0.0,
                    x: span[0],
                    time: 0.0,
                };
                found.extend(largest_deflection(loaded, none, (rail.rail, axis)));
            }
        }
    }
    found
}

/// The largest deflection of the span of `none` in one direction; `None` where no wheel comes onto the span.
fn largest_deflection(
    loaded: &LoadedStructure<'_>,
    none: Deflection,
    (rail, axis): (usize, Axis),
) -> Option<Deflection> {
    let [from, to] = none.span;
    let foundation = &loaded.built.foundation;
    let is_inside =
        |load: &RailLoad| load.rail == rail && load.x > from && load.x < to && load.force[1] != 0.0;
    let (mut is_loaded, is_either) = (false, axis == Axis::Lateral);
    let probe = |x: f64| Probe { rail, x, axis };
    let few = grid(none.span);
    let probes: Vec<Probe> = few.iter().chain(&none.span).map(|x| probe(*x)).collect();
    // no deflection is reported in a direction in which the structure is unrestrained
    let places = PlaceMotions::new(foundation, &probes).ok();
    let sag = |x: f64, moved: f64, [a, b]: [f64; 2]| {
        let fraction = (x - from) / (to - from);
        (1.0 - fraction) * a + fraction * b - moved
    };
    let near = loaded.run.near(&mut |row| {
        let mut on = loaded.loads.on(loaded.s);
        if !on.any(|source| is_inside(&source.load_in(row))) {
            return None;
        }
        is_loaded = true;
        let (places, on) = (places.as_ref()?, loaded.on(row));
        let under = on.iter().filter(|load| is_inside(load)).map(|load| load.x);
        let under: SmallVec<[f64; 8]> = under.collect();
        let also: SmallVec<[Probe; 8]> = under.iter().map(|x| probe(*x)).collect();
        let moved = places.under(&on, loaded.dofs(row), &also).ok()?;
        let (inside, rest) = moved.split_at(few.len());
        let (ends, wheels) = rest.split_at(2);
        let sized = |(x, moved): (&f64, &f64)| {
            let sag = sag(*x, *moved, [ends[0], ends[1]]);
            if is_either { sag.abs() } else { sag }
        };
        let under = under.iter().zip(wheels).map(sized);
        Some(crest(few.iter().zip(inside).map(sized), under))
    });
    if !is_loaded {
        return None;
    }
    let rails = foundation.rails.get(rail);
    let ends = none.span.map(probe);
    let mut exact = |row: &[f64]| {
        let mut breaks: Vec<f64> = rails.map_or(&[][..], |own| &own.breaks).to_vec();
        let (on, dofs) = (loaded.on(row), loaded.dofs(row));
        let own = on.iter().filter(|load| load.rail == rail);
        breaks.extend(own.map(|load| load.x));
        let chord = displacements(foundation, &ends, &on, dofs).ok()?;
        largest_along(none.span, &mut breaks, is_either, &mut |x| {
            let at: Vec<Probe> = x.iter().map(|x| probe(*x)).collect();
            let moved = displacements(foundation, &at, &on, dofs).ok()?;
            let sags = x.iter().zip(moved);
            let sags = sags.map(|(x, moved)| sag(*x, moved, [chord[0], chord[1]]));
            Some(sags.collect())
        })
    };
    let found = loaded.run.largest(&near, &mut exact);
    Some(match found {
        Some(LargestInTime { value, x, time }) => Deflection {
            value,
            x,
            time,
            ..none
        },
        None => none,
    })
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

/// The column with the largest drift of every rail of a frame on the ground, at any time; none for rigid foundations, without
/// lateral wheel forces, and where the degrees of freedom of the structure were not recorded.
pub(super) fn drifts(loaded: &LoadedStructure<'_>, solved: Option<&SolvedModel>) -> Vec<Drift> {
    let LoadedStructure {
        scene, s, built, ..
    } = *loaded;
    let structure = &scene.structures[s];
    let (Origin::Spec { spec, .. }, Some(solved), true, None, None) = (
        &structure.origin,
        solved,
        loaded.is_known(),
        &built.foundation.parts,
        structure.carrier,
    ) else {
        return Vec::new();
    };
    if matches!(spec.form, Form::Girder(_)) {
        return Vec::new();
    }
    let rows = &loaded.run.nodes.rows;
    let is_loaded = rows
        .samples()
        .any(|row| loaded.on(row).iter().any(|load| load.force[2] != 0.0));
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
        let none = Drift {
            rail: rail.name.clone(),
            x: columns[0],
            height,
            value: 0.0,
            time: 0.0,
            limits,
        };
        let Ok(places) = PlaceMotions::new(&built.foundation, &probes) else {
            continue;
        };
        let mut moved = |row: &[f64]| {
            let moved = places.under(&loaded.on(row), loaded.dofs(row), &[]).ok()?;
            let each = columns.iter().zip(moved);
            let each = each.map(|(x, moved)| [moved.abs(), *x]);
            each.reduce(|a, b| if b[0] > a[0] { b } else { a })
        };
        let near = loaded.run.near(&mut |row| Some(moved(row)?[0]));
        let largest = loaded.run.largest(&near, &mut moved);
        found.push(
            largest.map_or(none.clone(), |LargestInTime { value, x, time }| Drift {
                value,
                x,
                time,
                ..none
            }),
        );
    }
    found
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
