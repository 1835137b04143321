//! `summary.json`: the results of a document's cases in numbers.

use serde_json::{Map, Value, json};
use sim::{Choice, Fidelity, FidelityTrial, GapCause, Measure};

use crate::case_result::CaseResult;
use crate::columns::NamedColumns;
use crate::fatigue;
use crate::run_error;
use crate::steps::{ColumnInstant, ColumnPeak};
use crate::undetermined::Undetermined;
use crate::verdict::verdict;
use crate::warning;
use formats::scene::{Analysis, Document, Event, Scene, Structure, stepper_word};
use formats::units::Dimension;
use formats::verdict::add_definitions;

/// The summary of the cases of a document as JSON, with the run of the scene itself first; `comparison` has the
/// statistics of its runs ([`crate::response::RunComparison::json`]).
#[must_use]
pub fn of_document(
    document: &Document,
    outcomes: &[CaseResult],
    comparison: Map<String, Value>,
) -> Value {
    let scene = document.scene();
    let mut result = run(scene, &outcomes[0], 1);
    result["format"] = json!("girderway-summary/1");
    result["name"] = json!(scene.name);
    result["units"] = units(scene, &outcomes[0].columns);
    let compare: Map<String, Value> = document
        .cases
        .iter()
        .zip(outcomes)
        .enumerate()
        .skip(1)
        .map(|(index, (case, outcome))| {
            (outcome.label.clone(), run(&case.scene, outcome, index + 1))
        })
        .collect();
    if !compare.is_empty() {
        result["compare"] = Value::Object(compare);
    }
    if !comparison.is_empty() {
        result["comparison"] = Value::Object(comparison);
    }
    result
}

/// The JSON Schema of the summary of a document.
///
/// ```
/// assert_eq!(results::summary::schema()["properties"]["format"]["const"], "girderway-summary/1");
/// ```
#[must_use]
pub fn schema() -> Value {
    let mut schema: Value = serde_json::from_str(include_str!("schema.json"))
        .expect("the schema is JSON, as the test of this function shows");
    add_definitions(&mut schema);
    schema
}

/// The summary of one run as JSON; `number` is that of its case in the document, from 1.
#[must_use]
pub fn run(scene: &Scene, outcome: &CaseResult, number: usize) -> Value {
    let CaseResult { run, choices, .. } = outcome;
    let (word, why) = run_error::status(&run.status);
    let structures = scene.structures.iter().enumerate();
    let structures: Map<String, Value> = structures
        .map(|(s, one)| (one.name.clone(), foundation(one, choices, s)))
        .collect();
    let mut result = json!({
        "status": word,
        "analysis": match scene.analysis { Analysis::Dynamic => "dynamic", Analysis::QuasiStatic => "quasi-static" },
        "foundation": structures,
        "peaks": peaks(&outcome.peaks),
        "steps": {
            "accepted": run.counts.steps,
            "rejected": run.counts.rejected,
            "stages": run.counts.stages,
            "events": run.counts.events,
        },
    });
    if let Some(method) = run.method {
        result["steps"]["method"] = json!(stepper_word(method));
    }
    if let Some(why) = why {
        result["why"] = json!(why);
    }
    if let Some(members) = result.as_object_mut() {
        members.extend(outcome.response.json());
        members.extend(
            outcome
                .girders()
                .json(scene, number)
                .map(|extremes| ("extremes".to_owned(), extremes)),
        );
        let stresses = outcome.girders().stresses.json(scene, number);
        members.extend(stresses.map(|stresses| ("stresses".to_owned(), stresses)));
        members
            .extend(fatigue::json(&outcome.fatigue).map(|fatigue| ("fatigue".to_owned(), fatigue)));
        members.extend(
            outcome
                .codes
                .as_ref()
                .map(|codes| ("practice".to_owned(), codes.json())),
        );
    }
    if !outcome.undetermined.is_empty() {
        result["undetermined"] = outcome
            .undetermined
            .iter()
            .map(Undetermined::json)
            .collect();
    }
    if run.status.is_complete() {
        result["verdict"] = json!(verdict(scene, outcome));
    }
    let warnings = warning::case_warnings(scene, outcome);
    if !warnings.is_empty() {
        result["warnings"] = json!(warnings);
    }
    let notes = warning::case_notes(scene, outcome);
    if !notes.is_empty() {
        result["notes"] = json!(notes);
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
            "put_in": lost.supplied(),
            "work": { "drives": lost.drives, "loads": lost.loads, "hoists": lost.hoists },
            "steps": lost.rail_steps,
            "gaps": gaps(outcome),
        });
    }
    if !run.fired.is_empty() {
        result["events"] = run
            .fired
            .iter()
            .map(|fired| event(&scene.events[fired.rule], fired.time))
            .collect();
    }
    result
}

/// Where the energy balance of a run does not close, relative to the peak stored energy: sums by cause, and the largest
/// gaps of single steps.
fn gaps(outcome: &CaseResult) -> Value {
    let audit = &outcome.run.audit;
    let relative = |energy: f64| {
        if audit.peak_stored > 0.0 {
            energy / audit.peak_stored
        } else {
            energy
        }
    };
    let sums = &audit.gaps;
    let wheel = |w: usize| outcome.input.wheels[w].name.clone();
    let largest: Vec<Value> = (sums.largest.iter().filter(|gap| gap.energy != 0.0))
        .map(|gap| {
            let mut entry = json!({ "time": gap.time, "share": relative(gap.energy) });
            let (cause, at) = match gap.cause {
                GapCause::Step => ("step", None),
                GapCause::Flange(w) => ("flange", Some(w)),
                GapCause::Contact(w) => ("contact", Some(w)),
                GapCause::Break => ("break", None),
            };
            entry["cause"] = json!(cause);
            if let Some(w) = at {
                entry["wheel"] = json!(wheel(w));
            }
            entry
        })
        .collect();
    json!({
        "steps": relative(sums.steps),
        "flanges": relative(sums.flanges),
        "contacts": relative(sums.contacts),
        "breaks": relative(sums.breaks),
        "largest": largest,
    })
}

/// The foundation of structure `s`, with the reason for its choice.
fn foundation(structure: &Structure, choices: &[Choice], s: usize) -> Value {
    let mut entry = json!({
        "foundation": structure.foundation.word(),
        "reading": structure.interpolation.word(),
        "reason": "specified in the scene",
    });
    if let Some(choice) = choices.iter().find(|choice| choice.structure == s) {
        entry["foundation"] = json!(fidelity_word(choice.fidelity));
        entry["reason"] = json!(foundations::selection_reason(choice));
        entry["tolerance"] = json!(structure.tolerance);
        entry["estimate"] = json!(choice.estimate);
        entry["tried"] = choice.tried.iter().map(tried).collect();
        entry["measure"] = json!(match structure.measure {
            Measure::Extremes => "extremes",
            Measure::History => "history",
        });
        if !choice.quantity.is_empty() {
            entry["quantity"] = json!(choice.quantity);
        }
        if !choice.failed.is_empty() {
            entry["failed"] = choice
                .failed
                .iter()
                .map(|one| foundations::fidelity_name(*one))
                .collect();
        }
    }
    entry
}

/// An event that occurred in the run.
fn event(event: &Event, time: f64) -> Value {
    json!({ "time": time, "name": event.name, "when": event.when, "what": event.description })
}

/// The word for a fidelity in scene files.
const fn fidelity_word(fidelity: Fidelity) -> &'static str {
    match fidelity {
        Fidelity::Rigid => "rigid",
        Fidelity::Influence => "influence",
        Fidelity::Modal(_) => "modal",
    }
}

/// A fidelity that was run, with its estimated error.
fn tried(tried: &FidelityTrial) -> Value {
    json!({
        "fidelity": foundations::fidelity_name(tried.fidelity),
        // infinite where the runs could not be compared
        "estimate": tried.estimate.is_finite().then_some(tried.estimate),
        "quantity": tried.quantity,
        "against": foundations::check_name(tried.against),
        "stages": tried.stages,
    })
}

/// Largest and smallest value of every column, with their times.
fn peaks(found: &[ColumnPeak]) -> Value {
    let instant = |at: &ColumnInstant| json!({ "value": at.value + 0.0, "time": at.time + 0.0 });
    let each = found.iter().map(|peak| {
        let members = json!({ "max": instant(&peak.max), "min": instant(&peak.min) });
        (peak.column.clone(), members)
    });
    Value::Object(each.collect())
}

/// Units of the columns, by name.
#[must_use]
pub fn units(scene: &Scene, record: &NamedColumns) -> Value {
    let label = |dimension: Dimension| {
        if dimension == Dimension::NUMBER {
            "rad".to_owned()
        } else {
            scene.units.label(dimension)
        }
    };
    Value::Object(
        record
            .columns
            .iter()
            .map(|column| (column.name.clone(), json!(label(column.dimension))))
            .collect(),
    )
}
