//! Limits of deflections by codes, with the deflections under static wheel loads.
//!
//! The limits apply to static wheel loads, not to the transient forces of a run. The deflection of a span from the
//! chord between its ends is therefore computed once more: at the positions of the wheels in the run, with the static
//! load of each wheel by statics. Laterally, a tenth of the static loads of the wheels on the span's own rail acts.

use std::collections::HashMap;

use design::clause_json;
use foundations::{RailChords, SolvedModel};
use practice::aist::{BuildingClass, CraneKind};
use practice::cmaa::LATERAL_FRACTION;
use practice::limits::{
    CMAA_LIMITS, DeflectionLimit, EN_1993_6_LIMITS, GantryCrane, LimitedDisplacement,
    design_guide_limits, is_800_limits, mill_limits,
};
use serde_json::{Value, json};
use sim::SolutionNodes;
use splines::{Axis, Compliance, Probe};

use super::crane::{CraneData, to_si};
use crate::response::{
    LargestInTime, TimeSearch, WheelLoad, WheelLoadReader, crest, grid, largest_along,
};
use formats::scene::motion::SimulationInput;
use formats::scene::{Practice, Scene, root_body};
use formats::units::{Dimension, Units};

/// Positions of wheels that differ by less than one of so many parts of a span are the same until the largest deflection is looked
/// for.
const POSITIONS: f64 = 200.0;
/// Weight of 50 t, N, at which IS 800 changes the limit of gantry girders.
const FIFTY_TONNES: f64 = 50.0e3 * 9.806_65;

/// A limit by a code with its value for one length, in the units of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct AllowableDisplacement {
    /// The limit.
    pub limit: DeflectionLimit,
    /// The largest displacement allowed.
    pub value: f64,
}

/// The deflection of a span under static wheel loads, with the limits of codes.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticDeflection {
    /// What is limited.
    pub displacement: LimitedDisplacement,
    /// Name of the rail.
    pub rail: String,
    /// Ends of the span.
    pub span: [f64; 2],
    /// The deflection under static wheel loads.
    pub value: f64,
    /// Rail coordinate of the largest deflection.
    pub x: f64,
    /// Time at which the wheels stand at the positions of the largest deflection.
    pub time: f64,
    /// The limits.
    pub limits: Vec<AllowableDisplacement>,
}

impl StaticDeflection {
    /// Ratio of the length of the span to its deflection; `None` without deflection.
    #[must_use]
    pub fn ratio(&self) -> Option<f64> {
        let ratio = (self.span[1] - self.span[0]) / self.value;
        (self.value > 0.0 && ratio.is_finite()).then_some(ratio)
    }

    /// As an item of `limits`.
    pub(super) fn json(&self) -> Value {
        let limit = |allowable: &AllowableDisplacement| {
            let mut members = clause_json(&allowable.limit.clause);
            members["formula"] = json!(allowable.limit.formula());
            members["loads"] = json!(allowable.limit.loads.words());
            members["value"] = json!(allowable.value);
            members["within"] = json!(self.value <= allowable.value);
            members
        };
        json!({
            "name": self.displacement.word(),
            "rail": self.rail,
            "from": self.span[0],
            "to": self.span[1],
            "static_deflection": self.value + 0.0,
            "x": self.x,
            "time": self.time,
            "span_over_deflection": self.ratio(),
            "codes": self.limits.iter().map(limit).collect::<Vec<_>>(),
        })
    }
}

/// What the static deflections of a run are computed from.
pub struct SpanResponse<'r> {
    /// Chords of each rail of the scene by plane (vertical, lateral).
    pub spans: &'r [RailChords],
    /// The run.
    pub(crate) run: TimeSearch<'r>,
    /// Solution of each structure of the scene; `None` for a structure without spec.
    pub solved: &'r [Option<&'r SolvedModel>],
}

/// All limits of the codes for a crane.
fn all_limits(practice: &Practice, crane: &CraneData, units: Units) -> Vec<DeflectionLimit> {
    let mut limits: Vec<DeflectionLimit> =
        EN_1993_6_LIMITS.into_iter().chain(CMAA_LIMITS).collect();
    limits.extend(practice.class.into_iter().flat_map(design_guide_limits));
    match practice.building_class {
        Some(building) => limits.extend(mill_limits(building)),
        None => {
            // the limits of both pairs of classes, of which the lateral ones are the same
            limits.extend(mill_limits(BuildingClass::A));
            limits.push(mill_limits(BuildingClass::C)[0]);
        }
    }
    let newton = to_si(units).factor(Dimension::FORCE);
    let gantry = match crane.model.lifted * newton > FIFTY_TONNES {
        true => GantryCrane::ElectricAbove50Tonnes,
        false => GantryCrane::ElectricTo50Tonnes,
    };
    limits.extend(is_800_limits(gantry, practice.kind != CraneKind::Pendant));
    limits.extend(practice.limits.iter().copied());
    limits
}

/// The deflections under static wheel loads of the spans of the crane's runway and of its bridge girders that carry
/// wheels in the run.
pub(super) fn static_deflections(
    scene: &Scene,
    practice: &Practice,
    input: &SimulationInput,
    crane: &CraneData,
    run: &SpanResponse<'_>,
) -> Vec<StaticDeflection> {
    let limits = all_limits(practice, crane, scene.units);
    let loads = StaticLoads::new(scene, practice, input, crane);
    let reader = WheelLoadReader::new(scene, input, &run.run.nodes.rows);
    let places = WheelPlaces::new(&reader, run.run.nodes);
    let mut found = Vec::new();
    for (rail, outline) in scene.rails.iter().enumerate() {
        let carrier = scene.structures[outline.structure].carrier;
        let kinds: &[(usize, LimitedDisplacement)] = if practice.rails.contains(&rail) {
            &[
                (0, LimitedDisplacement::RunwayVertical),
                (1, LimitedDisplacement::RunwayLateral),
            ]
        } else if carrier.is_some_and(|carrier| carrier.body == practice.crane) {
            &[(0, LimitedDisplacement::BridgeGirder)]
        } else {
            &[]
        };
        for &(plane, displacement) in kinds {
            for &ends in &run.spans[rail][plane] {
                let span = Span {
                    rail,
                    ends,
                    displacement,
                };
                found.extend(span.largest(scene, &loads, (&reader, &places), run, &limits));
            }
        }
    }
    found
}

/// Static vertical load of every wheel of a scene, without those of other cranes.
struct StaticLoads {
    /// By rail of the crane (first, second) under which the trolley stands, and by wheel.
    near: [Vec<f64>; 2],
    /// Rails of the crane.
    rails: [usize; 2],
}

impl StaticLoads {
    fn new(
        scene: &Scene,
        practice: &Practice,
        input: &SimulationInput,
        crane: &CraneData,
    ) -> StaticLoads {
        let on_trolley: Vec<usize> = (0..input.wheels.len())
            .filter(|w| practice.trolley == Some(root_body(scene, input.wheels[*w].body).0))
            .collect();
        let moving = (crane.model.trolley + crane.model.lifted) / on_trolley.len().max(1) as f64;
        let near = [0, 1].map(|at: usize| {
            let mut loads = vec![0.0; input.wheels.len()];
            on_trolley.iter().for_each(|w| loads[*w] = moving);
            if let Ok(full) = crane.model.wheel_loads(1.0, 1.0) {
                crane.wheels[at].iter().for_each(|w| loads[*w] = full.near);
                crane.wheels[1 - at]
                    .iter()
                    .for_each(|w| loads[*w] = full.far);
            }
            loads
        });
        StaticLoads {
            near,
            rails: practice.rails,
        }
    }

    /// Loads of all wheels with the trolley at its nearest approach to `rail`.
    fn with_trolley_at(&self, rail: usize) -> &[f64] {
        &self.near[usize::from(rail == self.rails[1])]
    }
}

/// Positions of all wheels at the nodes of a solution.
struct WheelPlaces {
    /// Structure and rail of each wheel.
    rails: Vec<(usize, usize)>,
    /// Row by row.
    x: Vec<f64>,
}

impl WheelPlaces {
    fn new(reader: &WheelLoadReader, nodes: &SolutionNodes) -> WheelPlaces {
        let first = nodes.rows.samples().next().map(|row| reader.at(row));
        let rails = first.iter().flatten();
        let each = nodes.rows.samples().flat_map(|row| reader.places(row));
        WheelPlaces {
            rails: rails.map(|load| (load.structure, load.rail)).collect(),
            x: each.collect(),
        }
    }

    fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.x.chunks_exact(self.rails.len().max(1))
    }

    /// The wheels on a rail.
    fn on(&self, structure: usize, rail: usize) -> impl Iterator<Item = usize> {
        let is_own = move |w: &usize| self.rails[*w] == (structure, rail);
        (0..self.rails.len()).filter(is_own)
    }

    /// The wheels on a structure.
    fn of_structure(&self, structure: usize) -> impl Iterator<Item = usize> {
        (0..self.rails.len()).filter(move |w| self.rails[*w].0 == structure)
    }
}

/// A span of a rail, and what is evaluated there.
struct Span {
    /// Index of the rail in the scene.
    rail: usize,
    ends: [f64; 2],
    displacement: LimitedDisplacement,
}

impl Span {
    /// The largest deflection over the positions of the wheels in the run; `None` for a structure without solution,
    /// and where the structure is unrestrained.
    fn largest(
        &self,
        scene: &Scene,
        loads: &StaticLoads,
        (reader, places): (&WheelLoadReader, &WheelPlaces),
        run: &SpanResponse<'_>,
        limits: &[DeflectionLimit],
    ) -> Option<StaticDeflection> {
        let rail = &scene.rails[self.rail];
        let surface = run.solved[rail.structure]?.surface.as_ref()?;
        let forces = loads.with_trolley_at(self.rail);
        let [from, to] = self.ends;
        let metre = to_si(scene.units).factor(Dimension::LENGTH);
        let allowable = |limit: &DeflectionLimit| {
            let value = limit.allowable((to - from) * metre).ok()? / metre;
            (limit.displacement == self.displacement).then_some(AllowableDisplacement {
                limit: *limit,
                value,
            })
        };
        let none = StaticDeflection {
            displacement: self.displacement,
            rail: rail.name.clone(),
            span: self.ends,
            value: 0.0,
            x: from,
            time: 0.0,
            limits: limits.iter().filter_map(allowable).collect(),
        };
        let is_inside = |load: &WheelLoad| load.rail == rail.rail && load.x > from && load.x < to;
        let wheels = |row: &[f64]| -> Vec<(WheelLoad, f64)> {
            let all = reader.at(row).into_iter().zip(forces.iter().copied());
            all.filter(|(load, force)| load.structure == rail.structure && *force != 0.0)
                .collect()
        };
        let (mut is_loaded, mut is_resisted) = (false, true);
        // the same positions of the wheels come again and again
        let mut known: HashMap<Vec<i64>, f64> = HashMap::new();
        let few = grid(self.ends);
        let is_heavy = |w: &usize| forces.get(*w).is_some_and(|force| *force != 0.0);
        let own: Vec<usize> = places
            .on(rail.structure, rail.rail)
            .filter(is_heavy)
            .collect();
        let all: Vec<usize> = places
            .of_structure(rail.structure)
            .filter(is_heavy)
            .collect();
        let mut near = Vec::new();
        for (number, x) in places.rows().enumerate() {
            if !own.iter().any(|w| x[*w] > from && x[*w] < to) {
                continue;
            }
            is_loaded = true;
            let steps = all
                .iter()
                .map(|w| (x[*w] / (to - from) * POSITIONS).round() as i64);
            let sag = *known.entry(steps.collect()).or_insert_with(|| {
                let on = wheels(run.run.nodes.rows.sample(number));
                let under = on.iter().filter(|(load, _)| is_inside(load));
                let mut at = few.clone();
                at.extend(under.map(|(load, _)| load.x));
                let sags = self.sags(surface, rail.rail, &on, &at);
                is_resisted &= sags.is_some();
                let sags: Vec<f64> = sags
                    .into_iter()
                    .flatten()
                    .map(|sag| self.sized(sag))
                    .collect();
                let (grid, under) = sags.split_at(few.len().min(sags.len()));
                crest(grid.iter().copied(), under.iter().copied())
            });
            near.push((number, sag));
        }
        let mut exact = |row: &[f64]| {
            let on = wheels(row);
            let inside = on.iter().filter(|(load, _)| is_inside(load));
            let mut breaks: Vec<f64> = inside.map(|(load, _)| load.x).collect();
            largest_along(self.ends, &mut breaks, self.is_lateral(), &mut |x| {
                self.sags(surface, rail.rail, &on, x)
            })
        };
        let found = run.run.largest(&near, &mut exact);
        if !(is_loaded && is_resisted) {
            return None;
        }
        Some(
            found.map_or(none.clone(), |LargestInTime { value, x, time }| {
                StaticDeflection {
                    value,
                    x,
                    time,
                    ..none
                }
            }),
        )
    }

    fn is_lateral(&self) -> bool {
        self.displacement == LimitedDisplacement::RunwayLateral
    }

    /// A deflection downwards, or to either side.
    fn sized(&self, sag: f64) -> f64 {
        if self.is_lateral() { sag.abs() } else { sag }
    }

    /// The deflections from the chord at the places `x` under the static loads of `wheels` on the structure; `None` where the
    /// structure is unrestrained in this direction. `rail` is the rail within the structure.
    fn sags(
        &self,
        surface: &dyn Compliance,
        rail: usize,
        wheels: &[(WheelLoad, f64)],
        x: &[f64],
    ) -> Option<Vec<f64>> {
        let [from, to] = self.ends;
        let lateral = self.is_lateral();
        let axis = if lateral {
            Axis::Lateral
        } else {
            Axis::Vertical
        };
        let at: Vec<Probe> = x
            .iter()
            .chain(&self.ends)
            .map(|&x| Probe { rail, x, axis })
            .collect();
        let on = wheels
            .iter()
            .filter(|(load, _)| !lateral || load.rail == rail);
        let loads: Vec<(Probe, f64)> = on
            .map(|(load, force)| {
                let force = if lateral {
                    LATERAL_FRACTION * force
                } else {
                    0.0 - force
                };
                (
                    Probe {
                        rail: load.rail,
                        x: load.x,
                        axis,
                    },
                    force,
                )
            })
            .collect();
        let mut moved = vec![0.0; at.len()];
        surface.displacements(&at, &loads, &mut moved).ok()?;
        let (inside, ends) = moved.split_at(x.len());
        let sags = x.iter().zip(inside).map(|(&x, moved)| {
            let fraction = (x - from) / (to - from);
            (1.0 - fraction) * ends[0] + fraction * ends[1] - moved
        });
        Some(sags.collect())
    }
}
