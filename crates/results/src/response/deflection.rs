//! How far rails sag between their supports, against the span.

use practice::cmaa;
use serde_json::{Value, json};
use splines::{Axis, Error, Probe};

use super::loaded::{LoadedStructure, spread};
use super::spans::spans;
use super::wheel_load::WheelLoadHistory;
use formats::scene::Origin;
use foundations::SolvedModel;

/// Places looked at within a span.
const PLACES: usize = 7;
/// Output times looked at for a span.
const TIMES: usize = 64;
/// Usual limits: span over deflection.
const LIMITS: [f64; 2] = [cmaa::RUNWAY_VERTICAL, cmaa::RUNWAY_LATERAL];

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
    loaded: &LoadedStructure<'_>,
    solved: Option<&SolvedModel>,
) -> Result<Vec<Deflection>, Error> {
    let LoadedStructure { scene, s, history, laid, .. } = *loaded;
    let (Origin::Spec { spec, .. }, Some(solved), true, None) =
        (&scene.structures[s].origin, solved, loaded.is_known(), &laid.foundation.parts)
    else {
        return Ok(Vec::new());
    };
    let all: Vec<Vec<WheelLoadHistory>> = (0..history.len()).map(|row| loaded.on(row)).collect();
    let lateral = all.iter().flatten().any(|load| load.force[2] != 0.0);
    let axes: &[(Axis, &'static str)] = match lateral {
        true => &[(Axis::Vertical, "vertical"), (Axis::Lateral, "lateral")],
        false => &[(Axis::Vertical, "vertical")],
    };
    let mut found = Vec::new();
    for (index, rail) in scene.rails.iter().enumerate().filter(|(_, rail)| rail.structure == s) {
        let own = scene.output.spans.iter().find(|(known, _)| *known == index);
        let ends = own
            .map_or_else(|| spans(spec, &solved.model, &solved.rails, rail.rail), |(_, ends)| ends.clone());
        for span in ends.windows(2).map(|pair| [pair[0].max(rail.range[0]), pair[1].min(rail.range[1])]) {
            let [from, to] = span;
            let inside = |load: &WheelLoadHistory| {
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
                for row in spread(rows.len(), TIMES).map(|k| rows[k]) {
                    // a direction that the structure does not resist has no sag
                    let Some(moved) = loaded.displacements(&probes, &all[row], row)? else { break };
                    let time = history.sample(row)[0];
                    for (k, &x) in places.iter().enumerate().skip(1).take(PLACES) {
                        let share = k as f64 / (PLACES + 1) as f64;
                        let sag = (1.0 - share) * moved[0] + share * moved[PLACES + 1] - moved[k];
                        let value = if axis == Axis::Vertical { sag } else { sag.abs() };
                        if value > worst.value {
                            worst = Deflection { value, x, time, ..worst };
                        }
                    }
                }
                found.push(worst);
            }
        }
    }
    Ok(found)
}
