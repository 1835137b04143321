//! How far rails sag between their supports, against the span.

use serde_json::{Value, json};
use sim::{Channel, Foundation, History};
use splines::{Axis, Error, Influence, Probe};

use super::spans::spans;
use super::wheel_load::{WheelLoad, WheelLoads};
use crate::link::{Laid, Solved};
use crate::scene::{Origin, Scene};

/// Places looked at within a span.
const PLACES: usize = 7;
/// Output times looked at for a span.
const TIMES: usize = 64;
/// Usual limits: span over deflection.
const LIMITS: [f64; 2] = [600.0, 400.0];

/// Largest deflection of a rail from the chord between the ends of a span.
#[derive(Clone, Debug, PartialEq)]
pub struct Deflection {
    /// Name of the rail.
    pub rail: String,
    /// `vertical`, downwards, or `lateral`, to either side.
    pub direction: &'static str,
    /// Ends of the span.
    pub span: [f64; 2],
    /// The deflection.
    pub value: f64,
    /// Where.
    pub x: f64,
    /// When.
    pub time: f64,
}

impl Deflection {
    /// Span over deflection; `None` without deflection.
    #[must_use]
    pub fn ratio(&self) -> Option<f64> {
        let ratio = (self.span[1] - self.span[0]) / self.value;
        (self.value > 0.0 && ratio.is_finite()).then_some(ratio)
    }

    /// Whether the span over the deflection is at least `limit`.
    #[must_use]
    pub fn keeps(&self, limit: f64) -> bool {
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
            "within": { "L/600": self.keeps(vertical), "L/400": self.keeps(lateral) },
        })
    }
}

/// Of every span of structure `s` that wheels stood on; none on rigid foundations, tables and parts with a force each,
/// nor where the freedoms of the structure were not recorded.
///
/// At seven places and up to 64 output times a span, evenly spread over those with a wheel in it.
///
/// # Errors
/// A place beyond a rail.
pub(super) fn of(
    scene: &Scene,
    s: usize,
    history: &History,
    loads: &WheelLoads,
    laid: &Laid,
    solved: Option<&Solved>,
) -> Result<Vec<Deflection>, Error> {
    let foundation = &laid.foundation;
    let gives = foundation.compliance.is_some() || foundation.structure.is_some();
    let (Origin::Spec { spec, .. }, Some(solved), true, None) =
        (&scene.structures[s].origin, solved, gives, &foundation.parts)
    else {
        return Ok(Vec::new());
    };
    let all: Vec<Vec<WheelLoad>> = (0..history.len())
        .map(|i| loads.at(history.sample(i)).into_iter().filter(|load| load.structure == s).collect())
        .collect();
    let lateral = all.iter().flatten().any(|load| load.force[2] != 0.0);
    let axes: &[(Axis, &'static str)] = match lateral {
        true => &[(Axis::Vertical, "vertical"), (Axis::Lateral, "lateral")],
        false => &[(Axis::Vertical, "vertical")],
    };
    let start = history.channels().iter().position(|c| *c == Channel::Coordinate(s, 0));
    if start.is_none() && foundation.structure.is_some() {
        return Ok(Vec::new());
    }
    let mut found = Vec::new();
    for (index, rail) in scene.rails.iter().enumerate().filter(|(_, rail)| rail.structure == s) {
        let own = scene.output.spans.iter().find(|(known, _)| *known == index);
        let ends = own
            .map_or_else(|| spans(spec, &solved.model, &solved.rails, rail.rail), |(_, ends)| ends.clone());
        for span in ends.windows(2).map(|pair| [pair[0].max(rail.range[0]), pair[1].min(rail.range[1])]) {
            let [from, to] = span;
            let inside = |load: &WheelLoad| {
                load.rail == rail.rail && load.x > from && load.x < to && load.force[1] != 0.0
            };
            let rows: Vec<usize> = (0..all.len()).filter(|&i| all[i].iter().any(inside)).collect();
            if from >= to || rows.is_empty() {
                continue;
            }
            let places: Vec<f64> =
                (0..=PLACES + 1).map(|k| from + (to - from) * k as f64 / (PLACES + 1) as f64).collect();
            for &(axis, direction) in axes {
                let probes: Vec<Probe> = places.iter().map(|&x| Probe { rail: rail.rail, x, axis }).collect();
                let mut worst =
                    Deflection { rail: rail.name.clone(), direction, span, value: 0.0, x: from, time: 0.0 };
                let count = rows.len().min(TIMES);
                for row in (0..count).map(|k| rows[k * (rows.len() - 1) / (count - 1).max(1)]) {
                    let sample = history.sample(row);
                    let q = start.map_or(&[][..], |at| &sample[at..at + foundation.freedoms()]);
                    let moved = match displacements(foundation, &probes, &all[row], q) {
                        Ok(moved) => moved,
                        // a direction that the structure does not resist has no sag
                        Err(Error::Unstiffened { .. }) => break,
                        Err(error) => return Err(error),
                    };
                    for (k, &x) in places.iter().enumerate().skip(1).take(PLACES) {
                        let share = k as f64 / (PLACES + 1) as f64;
                        let sag = (1.0 - share) * moved[0] + share * moved[PLACES + 1] - moved[k];
                        let value = if axis == Axis::Vertical { sag } else { sag.abs() };
                        if value > worst.value {
                            worst = Deflection { value, x, time: sample[0], ..worst };
                        }
                    }
                }
                found.push(worst);
            }
        }
    }
    Ok(found)
}

/// G F + Phi q at the probes.
pub(super) fn displacements(
    foundation: &Foundation,
    probes: &[Probe],
    loads: &[WheelLoad],
    q: &[f64],
) -> Result<Vec<f64>, Error> {
    let mut out = vec![0.0; probes.len()];
    if let Some(compliance) = &foundation.compliance {
        let mut at = probes.to_vec();
        let mut forces = Vec::new();
        for load in loads {
            for (axis, force) in
                [Axis::Longitudinal, Axis::Vertical, Axis::Lateral].into_iter().zip(load.force)
            {
                if force != 0.0 && (axis != Axis::Longitudinal || foundation.is_dragged) {
                    at.push(Probe { rail: load.rail, x: load.x, axis });
                    forces.push(force);
                }
            }
        }
        let mut influence = Influence::zeros(at.len());
        compliance.fill(&at, &mut influence)?;
        for (i, out) in out.iter_mut().enumerate() {
            *out += forces
                .iter()
                .enumerate()
                .map(|(j, force)| influence.value[(i, probes.len() + j)] * force)
                .sum::<f64>();
        }
    }
    if let (Some(structure), false) = (&foundation.structure, q.is_empty()) {
        let (mut value, mut slope) = (vec![0.0; q.len()], vec![0.0; q.len()]);
        for (out, probe) in out.iter_mut().zip(probes) {
            structure.shapes.row(*probe, &mut value, &mut slope)?;
            *out += value.iter().zip(q).map(|(phi, q)| phi * q).sum::<f64>();
        }
    }
    Ok(out)
}
