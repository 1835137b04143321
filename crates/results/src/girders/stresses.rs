//! The largest direct stress of each section under a rail in a run, from normal force and moments that act at once.
//!
//! The stress of each fibre is found like a force: at all sections and beside all loads, at all times, and between sections where
//! forces are distributed along members.

use design::{FibreStress, Fibres, by_reason, side_word};
use formats::LateralSection;
use formats::scene::{Origin, Scene};
use serde_json::{Map, Value, json};
use trains::SectionSide;

use super::fibres::DIRECT;
use super::forces::stress;
use super::spans::GirderPeaks;
use super::value::GirderValue;

/// Stresses on both sides of a wheel that count as equal, relative to their size.
const ROUNDING: f64 = 1e-12;
/// Stresses below this fraction of the largest one of a structure count as zero.
const ZERO: f64 = 1e-9;

/// The largest direct stress of a section under a rail over a run.
#[derive(Clone, Debug, PartialEq)]
pub struct GirderStress {
    /// Index of the rail in the scene.
    pub rail: usize,
    /// Number of the span; 0 and one more than the last for overhangs.
    pub span: usize,
    /// Name of the section.
    pub section: String,
    /// The fibre, by its edges, such as `top, +z`.
    pub fibre: &'static str,
    /// The stress, in force over the square of length, positive in tension:
    /// sigma = N/A - M_v v/I_v + M_l w/I_l, the last part M_l/(t b^2/6) where the top flange alone takes lateral moments.
    pub value: f64,
    /// Its parts of normal force, vertical and lateral moment.
    pub parts: [f64; 3],
    /// The normal force, the vertical and the lateral moment; with dead load where the output of the scene requests it.
    pub forces: [f64; 3],
    /// Yield strength, where the spec gives it.
    pub yield_strength: Option<f64>,
    /// Rail coordinate.
    pub x: f64,
    /// Side of the section.
    pub side: SectionSide,
    /// Time.
    pub time: f64,
}

impl GirderStress {
    /// The stress over the yield strength; `None` where that is not known.
    #[must_use]
    pub fn utilisation(&self) -> Option<f64> {
        Some(self.value.abs() / self.yield_strength?)
    }
}

/// Direct stresses of the girders of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GirderStresses {
    /// One for each section under each rail, unless it is zero throughout.
    pub rows: Vec<GirderStress>,
    /// Rails of the scene, and what keeps sections under them from having stresses.
    pub lacks: Vec<(usize, String)>,
}

impl GirderStresses {
    /// The largest stress by utilisation; by size where no yield strength is known.
    #[must_use]
    pub fn governing(&self) -> Option<&GirderStress> {
        let used = self.rows.iter().filter(|row| row.yield_strength.is_some());
        let most = used.reduce(|a, b| {
            if b.utilisation() > a.utilisation() {
                b
            } else {
                a
            }
        });
        most.or_else(|| {
            self.rows
                .iter()
                .reduce(|a, b| if b.value.abs() > a.value.abs() { b } else { a })
        })
    }

    /// Adds the stresses of another structure.
    pub(super) fn extend(&mut self, other: GirderStresses) {
        self.rows.extend(other.rows);
        self.lacks.extend(other.lacks);
    }

    /// The member `stresses` of the summary of case `number`, counted from 1; `None` without stresses.
    #[must_use]
    pub fn json(&self, scene: &Scene, number: usize) -> Option<Value> {
        let named = |names: [&str; 3], values: [f64; 3]| -> Map<String, Value> {
            names
                .into_iter()
                .zip(values)
                .map(|(name, value)| (name.to_owned(), json!(value + 0.0)))
                .collect()
        };
        let one = |found: &GirderStress| {
            let mut out = json!({
                "case": number,
                "rail": scene.rails[found.rail].name,
                "span": found.span,
                "section": found.section,
                "quantity": "direct stress",
                "value": found.value + 0.0,
                "fibre": found.fibre,
                "parts": named(["normal", "vertical", "lateral"], found.parts),
                "forces": named(["normal", "moment", "lateral moment"], found.forces),
                "lateral_section": scene.lateral_section.map(LateralSection::word),
                "x": found.x + 0.0,
                "side": side_word(found.side),
                "time": found.time,
            });
            if let (Some(strength), Some(utilisation)) = (found.yield_strength, found.utilisation())
            {
                out["strength"] = json!(strength);
                out["utilisation"] = json!(utilisation);
                out["within"] = json!(utilisation <= 1.0);
            }
            out
        };
        (!self.rows.is_empty()).then(|| self.rows.iter().map(one).collect())
    }

    /// What is left out where the scene asks for stresses.
    #[must_use]
    pub fn notes(&self, scene: &Scene) -> Vec<String> {
        if scene.lateral_section.is_none() {
            return Vec::new();
        }
        let tables = scene.rails.iter().enumerate().filter_map(|(index, rail)| {
            let structure = &scene.structures[rail.structure];
            let is_tables = matches!(structure.origin, Origin::Tables { .. });
            is_tables.then(|| {
                (
                    index,
                    format!("structure {} is given by tables", structure.name),
                )
            })
        });
        let lacks: Vec<(String, String)> = tables
            .chain(self.lacks.iter().cloned())
            .map(|(rail, why)| (scene.rails[rail].name.clone(), why))
            .collect();
        let lacking = by_reason("no direct stress", &lacks);
        let mut out: Vec<String> = lacking.iter().map(ToString::to_string).collect();
        if scene.practice.is_none() {
            out.push(
                "the run is not compared with codes, because `practice` has only `lateral_section` and the body that \
                 runs on two rails is not unique; specify it by `practice.crane`"
                    .to_owned(),
            );
        }
        out
    }
}

impl GirderPeaks<'_> {
    /// The largest stresses of the sections of a structure.
    pub fn stresses(&self) -> GirderStresses {
        let stressed = &self.girders.sections.stressed;
        let found: Vec<GirderStress> = (0..stressed.all.len())
            .filter_map(|section| self.stress_of(section))
            .collect();
        let most = found
            .iter()
            .fold(0.0_f64, |most, row| most.max(row.value.abs()));
        let rows = found
            .into_iter()
            .filter(|row| row.value.abs() > ZERO * most)
            .collect();
        GirderStresses {
            rows,
            lacks: stressed.lacks.clone(),
        }
    }

    fn stress_of(&self, section: usize) -> Option<GirderStress> {
        let girders = self.girders;
        let own = &girders.sections.stressed.all[section];
        let rail = &girders.sections.rails[own.rail];
        let mut found = self.forces.stresses[section].filter(|found| found.signed > 0.0)?;
        let (member, _) = found.section?;
        if girders.distributed.is_along() && found.own.is_none() {
            let beside = rail.neighbours(found.x);
            found = girders.climb_member(member, beside, found, &|place, state| {
                let forces = girders.forces(member, place, state, None);
                stress(&own.fibres, DIRECT.map(|k| forces[k]))
            });
            found.section = Some((member, girders.members.place(member, found.x)));
        }
        let (worst, forces) = self.stress_at(&own.fibres, &found)?;
        let side = match found.own {
            Some((load, is_behind)) if found.side == SectionSide::At => {
                let across = GirderValue {
                    own: Some((load, !is_behind)),
                    ..found
                };
                let other = self
                    .stress_at(&own.fibres, &across)
                    .map_or(0.0, |(worst, _)| worst.value().abs());
                match is_behind {
                    _ if other >= (1.0 - ROUNDING) * worst.value().abs() => SectionSide::At,
                    true => SectionSide::Behind,
                    false => SectionSide::Before,
                }
            }
            _ => found.side,
        };
        Some(GirderStress {
            rail: rail.scene_rail,
            span: rail.span(found.x, side),
            section: own.fibres.name.clone(),
            fibre: worst.fibre,
            value: worst.value(),
            parts: worst.parts,
            forces,
            yield_strength: own.fibres.yield_strength,
            x: found.x + 0.0,
            side,
            time: girders.pieces.time(found.at),
        })
    }

    /// The largest stress where one was found, and the forces that cause it, without what is only rounding.
    fn stress_at(&self, fibres: &Fibres, found: &GirderValue) -> Option<(FibreStress, [f64; 3])> {
        let (member, place) = found.section?;
        let state = self.girders.pieces.at(found.at);
        let values = self.girders.forces(member, place, &state, found.own);
        let forces = DIRECT.map(|k| self.without_rounding(k, values[k]));
        Some((fibres.worst(forces)?, forces))
    }
}
