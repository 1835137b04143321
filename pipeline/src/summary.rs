//! `summary.json`: what a run found, in numbers.

use serde_json::{Map, Value, json};
use sim::{Run, Rung, Status, Tried};

use crate::cases::Outcome;
use crate::link;
use crate::motion::Cast;
use crate::record::Record;
use crate::scene::{Analysis, Event, STEPPERS, Scene};
use crate::units::Dimension;

/// Word of a run's status, and what it means for the user where it is not "done".
#[must_use]
pub fn status(status: &Status) -> (&'static str, Option<String>) {
    match status {
        Status::Done => ("done", None),
        Status::Ended(_) => ("ended by event", None),
        Status::Stopped => ("stopped", Some("the run was stopped".to_owned())),
        Status::StepTooSmall(t) => (
            "step too small",
            Some(format!(
                "no step was small enough at t = {t} s, or contacts opened and closed without end: the motion cannot be \
                 followed"
            )),
        ),
        Status::Refused(t, error) => ("refused", Some(format!("at t = {t} s: {error}"))),
    }
}

/// Energy residual above which a run's forces are not to be trusted blindly.
const RESIDUAL: f64 = 1e-3;

/// Deflection of a rail by its length above which structures are hardly linear.
const BENT: f64 = 0.01;

/// What a user should know before believing a run.
#[must_use]
pub fn warnings(scene: &Scene, cast: &Cast, record: &Record, run: &Run) -> Vec<String> {
    let mut all = Vec::new();
    let residual = run.audit.residual();
    if residual > RESIDUAL {
        all.push(format!(
            "the energy audit leaves {residual:.1e} of the peak stored energy open; a smaller \"accuracy\" closes it, but \
             for a table that is not symmetric and a flange that takes hold at once"
        ));
    }
    for (r, rail) in scene.rails.iter().enumerate() {
        let gives = cast.wheels.iter().filter(|wheel| wheel.rail == r);
        let gives = gives.flat_map(|wheel| record.part(&wheel.name, "rail_deflection"));
        let share = gives.fold(0.0_f64, |most, give| most.max(give.abs())) / (rail.range[1] - rail.range[0]);
        if share > BENT {
            all.push(format!(
                "{} gives by {share:.3} of its length, more than {BENT}: small displacements are no longer small",
                rail.name
            ));
        }
    }
    for wheel in &cast.wheels {
        let forces = record.part(&wheel.name, "vertical");
        if let Some(first) = forces.iter().position(|force| *force == 0.0) {
            let off = forces.iter().filter(|force| **force == 0.0).count();
            all.push(format!(
                "{} is off its rail at {off} of {} output times, first at {} s",
                wheel.name,
                forces.len(),
                record.values("time").get(first).copied().unwrap_or_default()
            ));
        }
    }
    all
}

/// One run as JSON.
#[must_use]
pub fn run(scene: &Scene, outcome: &Outcome) -> Value {
    let Outcome { cast, run, record, choices, .. } = outcome;
    let (word, why) = status(&run.status);
    let structures: Map<String, Value> = scene
        .structures
        .iter()
        .enumerate()
        .map(|(s, structure)| {
            let mut entry = json!({
                "foundation": structure.foundation.word(),
                "reading": structure.reading.word(),
                "reason": "asked for",
            });
            if let Some(choice) = choices.iter().find(|choice| choice.structure == s) {
                entry["foundation"] = json!(rung(choice.rung));
                entry["reason"] = json!(link::reason(choice));
                entry["tolerance"] = json!(structure.tolerance);
                entry["estimate"] = json!(choice.estimate);
                entry["tried"] = choice.tried.iter().map(tried).collect();
            }
            (structure.name.clone(), entry)
        })
        .collect();
    let mut result = json!({
        "status": word,
        "analysis": match scene.analysis { Analysis::Dynamic => "dynamic", Analysis::QuasiStatic => "quasi-static" },
        "foundation": structures,
        "peaks": peaks(record),
        "steps": {
            "accepted": run.counts.steps,
            "rejected": run.counts.rejected,
            "stages": run.counts.stages,
            "events": run.counts.events,
        },
    });
    if let Some(method) = run.method {
        let name = STEPPERS.iter().find(|(_, known)| *known == method).map(|(word, _)| *word);
        result["steps"]["method"] = json!(name);
    }
    if let Some(why) = why {
        result["why"] = json!(why);
    }
    let warnings = warnings(scene, cast, record, run);
    if !warnings.is_empty() {
        result["warnings"] = json!(warnings);
    }
    if scene.analysis == Analysis::Dynamic {
        let lost = &run.audit.exchanged;
        result["energy"] = json!({
            "residual": run.audit.residual(),
            "peak_stored": run.audit.peak_stored,
            "lost": {
                "dampers": lost.dampers,
                "friction": lost.friction,
                "flanges": lost.flanges,
                "handover": lost.handover,
                "structure": lost.structure,
                "switches": lost.switches,
            },
            "put_in": lost.put_in(),
            "steps": lost.steps,
            "work": { "drives": lost.drives, "loads": lost.loads, "hoists": lost.hoists },
        });
    }
    if !run.fired.is_empty() {
        result["events"] =
            run.fired.iter().map(|fired| event(&scene.events[fired.rule], fired.time)).collect();
    }
    result
}

/// An event that happened.
fn event(event: &Event, time: f64) -> Value {
    json!({ "time": time, "name": event.name, "when": event.when, "what": event.what })
}

/// The word of a rung in scenes.
const fn rung(rung: Rung) -> &'static str {
    match rung {
        Rung::Rigid => "rigid",
        Rung::Influence => "influence",
        Rung::Modal(_) => "modal",
        Rung::Full => "full",
    }
}

fn tried(tried: &Tried) -> Value {
    json!({
        "rung": link::word(tried.rung),
        // infinite where the runs could not be compared
        "estimate": tried.estimate.is_finite().then_some(tried.estimate),
        "against": link::word(tried.against),
        "stages": tried.stages,
    })
}

/// Largest and smallest value of every column, and when.
fn peaks(record: &Record) -> Value {
    let time = record.values("time");
    let mut peaks = Map::new();
    for column in record.columns.iter().skip(1).filter(|column| !column.values.is_empty()) {
        let mut at = [0, 0];
        for (i, value) in column.values.iter().enumerate() {
            if *value > column.values[at[0]] {
                at[0] = i;
            }
            if *value < column.values[at[1]] {
                at[1] = i;
            }
        }
        let [most, least] = at.map(|i| json!({ "value": column.values[i] + 0.0, "time": time[i] }));
        peaks.insert(column.name.clone(), json!({ "max": most, "min": least }));
    }
    Value::Object(peaks)
}

/// Units of the columns.
#[must_use]
pub fn units(scene: &Scene, record: &Record) -> Value {
    let label = |dimension: Dimension| {
        if dimension == Dimension::NUMBER { "rad".to_owned() } else { scene.units.label(dimension) }
    };
    Value::Object(
        record.columns.iter().map(|column| (column.name.clone(), json!(label(column.dimension)))).collect(),
    )
}
