//! A study as JSON and CSV. Times are in separate files, because they differ between runs.

use serde_json::{Map, Value, json};

use crate::measure::deviation::study_measure;
use crate::measure::front::{cost_ratio, on_front};
use crate::measure::quantity::ErrorGroup;
use crate::runs::investigate::Study;
use crate::runs::point::{PointOutcome, StudyPoint};
use crate::runs::reference::{ConvergedReference, RESOLUTION_FACTOR, foundation};
use crate::settings::budget::StudyBudget;
use crate::settings::setting::SettingFamily;
use formats::scene::Scene;
use results::columns::bytes;

/// `study.json`: everything except times.
#[must_use]
pub fn json(study: &Study, scene: &Scene, budget: &StudyBudget) -> Value {
    let fronts = fronts(study, &stages);
    let points = study.points.iter().enumerate();
    let failed = study
        .failed_references
        .iter()
        .map(|(own, why)| (own.word().to_owned(), json!(why)));
    json!({
        "format": "girderway-study/1",
        "name": scene.name,
        "resolution": budget.resolution,
        "limit": budget.limit,
        "measure": match study_measure(scene) {
            sim::Measure::Extremes => "extremes",
            sim::Measure::History => "history",
        },
        "until": study.until,
        "references": study.references.iter().map(reference).collect::<Vec<_>>(),
        "lost": failed.collect::<Map<String, Value>>(),
        "auto": match &study.auto {
            Ok(auto) => {
                let all = auto.reasons.iter().map(|(name, why)| (name.clone(), json!(why)));
                Value::Object(all.collect())
            }
            Err(why) => json!({ "why": why }),
        },
        "cost_ratio_by_stages": cost_ratios_json(study, &stages),
        "settings": points.map(|(k, own)| setting(own, &on(&fronts, k))).collect::<Vec<_>>(),
    })
}

/// A reference with its resolution in each group.
fn reference(own: &ConvergedReference) -> Value {
    let each = |value: &dyn Fn(usize) -> Option<f64>| {
        let all = ErrorGroup::ALL.iter().enumerate();
        all.filter_map(|(k, q)| Some((q.word().to_owned(), json!(value(k)?))))
            .collect::<Map<String, Value>>()
    };
    json!({
        "against": own.kind.word(),
        "run": own.descriptions[0],
        "beside": own.descriptions[1],
        "difference": each(&|k| own.difference[k]),
        "resolution": each(&|k| own.difference[k].map(|difference| RESOLUTION_FACTOR * difference.max(f64::EPSILON))),
        "approach": own.approach.iter()
            .map(|(accuracy, difference)| json!({ "accuracy": accuracy, "difference": difference }))
            .collect::<Vec<_>>(),
    })
}

/// A setting with its outcome and the groups on whose front it is.
fn setting(point: &StudyPoint, fronts: &[&'static str]) -> Value {
    let StudyPoint { setting, outcome } = point;
    let structures = setting
        .scene
        .structures
        .iter()
        .map(|own| (own.name.clone(), json!(foundation(own))));
    let mut out = json!({
        "family": setting.family.name(),
        setting.parameter: setting.value,
        "accuracy": setting.scene.accuracy,
        "against": setting.family.reference_kind().word(),
        "foundation": structures.collect::<Map<String, Value>>(),
    });
    match outcome {
        PointOutcome::Done(measured) => {
            out["status"] = json!("done");
            let errors = ErrorGroup::ALL.iter().zip(&measured.errors);
            let errors = errors.filter_map(|(quantity, own)| {
                let own = (*own)?;
                Some((
                    quantity.word().to_owned(),
                    json!({ "largest": own.largest, "peak": own.peak }),
                ))
            });
            out["errors"] = Value::Object(errors.collect());
            out["steps"] = json!(measured.counts.steps);
            out["rejected"] = json!(measured.counts.rejected);
            out["stages"] = json!(measured.counts.stages);
            out["events"] = json!(measured.counts.events);
            out["dofs"] = json!(measured.dof_count);
            if let Some(memory) = measured.memory {
                out["memory"] = json!({ "foundations": memory.foundations, "run": memory.run });
            }
            out["front_by_stages"] = json!(fronts);
        }
        PointOutcome::Stopped => out["status"] = json!("stopped"),
        PointOutcome::Refused(why) => {
            out["status"] = json!("refused");
            out["why"] = json!(why);
        }
    }
    out
}

/// Ratio of the cost of the first point of `family` to that of the cheapest setting with no larger error, for each
/// group of columns: 1 on the Pareto front. Errors below the resolution of the reference count as equal to it.
#[must_use]
pub fn cost_ratios(
    study: &Study,
    family: SettingFamily,
    cost: &dyn Fn(&StudyPoint) -> Option<f64>,
) -> Vec<(ErrorGroup, f64)> {
    let Some(reference) = study.reference(family.reference_kind()) else {
        return Vec::new();
    };
    let of = |quantity: ErrorGroup| {
        let least = reference.usable_resolution(quantity)?;
        let place = |point: &StudyPoint| Some([cost(point)?, point.error(quantity)?.max(least)]);
        let all = study
            .points
            .iter()
            .filter(|point| point.setting.family.reference_kind() == reference.kind);
        let all: Vec<(SettingFamily, [f64; 2])> = all
            .filter_map(|point| Some((point.setting.family, place(point)?)))
            .collect();
        let own = all.iter().find(|(known, _)| *known == family)?.1;
        let others: Vec<[f64; 2]> = all.into_iter().map(|(_, place)| place).collect();
        Some((quantity, cost_ratio(own, &others)))
    };
    ErrorGroup::ALL.into_iter().filter_map(of).collect()
}

/// The cost ratios as JSON, of the scene as written (among foundations and among methods) and of the choice of
/// "auto".
fn cost_ratios_json(study: &Study, cost: &dyn Fn(&StudyPoint) -> Option<f64>) -> Value {
    let of = |family: SettingFamily| {
        let all = cost_ratios(study, family, cost).into_iter();
        Value::Object(
            all.map(|(quantity, own)| (quantity.word().to_owned(), json!(own)))
                .collect(),
        )
    };
    json!({
        "as written": of(SettingFamily::Written),
        "auto": of(SettingFamily::Auto),
        "stepping": of(SettingFamily::Stepping),
    })
}

/// Cost of a point as its number of contact solutions, where it ran to its end.
#[must_use]
pub fn stages(point: &StudyPoint) -> Option<f64> {
    Some(point.measured()?.counts.stages as f64)
}

/// Indices of the points on the Pareto front of each group by `cost`, among the points of one reference.
fn fronts(study: &Study, cost: &dyn Fn(&StudyPoint) -> Option<f64>) -> Vec<Vec<usize>> {
    let of = |quantity: ErrorGroup| {
        let mut kept = Vec::new();
        for reference in &study.references {
            let least = reference.resolution(quantity);
            let (at, pairs): (Vec<usize>, Vec<[f64; 2]>) = study
                .points
                .iter()
                .enumerate()
                .filter(|(_, point)| point.setting.family.reference_kind() == reference.kind)
                .filter_map(|(k, point)| {
                    Some((k, [cost(point)?, point.error(quantity)?.max(least)]))
                })
                .unzip();
            kept.extend(
                at.into_iter()
                    .zip(on_front(&pairs))
                    .filter(|(_, on)| *on)
                    .map(|(k, _)| k),
            );
        }
        kept
    };
    ErrorGroup::ALL.map(of).to_vec()
}

/// Words of the groups on whose front a point is.
fn on(fronts: &[Vec<usize>], point: usize) -> Vec<&'static str> {
    let all = ErrorGroup::ALL.iter().zip(fronts);
    all.filter(|(_, own)| own.contains(&point))
        .map(|(quantity, _)| quantity.word())
        .collect()
}

/// `timing.json`: thread times of runs, s.
#[must_use]
pub fn timing_json(study: &Study) -> Value {
    let fronts = fronts(study, &StudyPoint::seconds);
    let points = study.points.iter().enumerate().filter_map(|(k, point)| {
        let measured = point.measured()?;
        let time = measured.time?;
        Some(json!({
            "setting": point.setting.label(),
            "median": time.median,
            "least": time.min,
            "most": time.max,
            "repetitions": time.count,
            "setup": measured.setup,
            "front": on(&fronts, k),
        }))
    });
    let trials = study.auto.as_ref().ok().and_then(|auto| auto.trials);
    json!({
        "clock": if cfg!(unix) { "time that the thread worked, s" } else { "time, s" },
        "cost_ratio": cost_ratios_json(study, &StudyPoint::seconds),
        "settings": points.collect::<Vec<_>>(),
        "auto_with_its_trials": trials.map(|own| json!({
            "median": own.median, "least": own.min, "most": own.max, "repetitions": own.count,
        })),
    })
}

/// `study.csv`: one row for each setting, without times.
///
/// # Errors
/// None in practice: memory takes every byte.
pub fn csv(study: &Study) -> Result<Vec<u8>, csv::Error> {
    let mut head: Vec<String> = ["family", "knob", "value", "against", "status"]
        .map(str::to_owned)
        .to_vec();
    for quantity in ErrorGroup::ALL {
        head.extend(["largest", "peak"].map(|kind| format!("{}.{kind}", quantity.word())));
    }
    head.extend(["steps", "rejected", "stages", "events", "dofs"].map(str::to_owned));
    head.extend(["foundations [B]", "run [B]"].map(str::to_owned));
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&head)?;
    for point in &study.points {
        let StudyPoint { setting, outcome } = point;
        let (family, kind) = (setting.family, setting.family.reference_kind());
        let mut row = vec![
            family.name(),
            setting.parameter.to_owned(),
            format!("{:?}", setting.value),
        ];
        row.push(kind.word().to_owned());
        row.push(
            match outcome {
                PointOutcome::Done(_) => "done",
                PointOutcome::Stopped => "stopped",
                PointOutcome::Refused(_) => "refused",
            }
            .to_owned(),
        );
        match point.measured() {
            Some(measured) => {
                for own in &measured.errors {
                    let text = |value: f64| format!("{value:e}");
                    let pair = own
                        .map_or_else(Default::default, |own| [text(own.largest), text(own.peak)]);
                    row.extend(pair);
                }
                let sim::Counts {
                    steps,
                    rejected,
                    stages,
                    events,
                } = measured.counts;
                row.extend(
                    [steps, rejected, stages, events, measured.dof_count]
                        .map(|own| own.to_string()),
                );
                let bytes = measured
                    .memory
                    .map(|own| [own.foundations, own.run].map(|own| own.to_string()));
                row.extend(bytes.unwrap_or_default());
            }
            None => row.resize(head.len(), String::new()),
        }
        writer.write_record(&row)?;
    }
    bytes(writer)
}

/// `timing.csv`: one row for each setting that ran to its end; times in ms.
///
/// # Errors
/// None in practice: memory takes every byte.
pub fn timing_csv(study: &Study) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "family",
        "knob",
        "value",
        "median [ms]",
        "least [ms]",
        "most [ms]",
        "repetitions",
        "setup [ms]",
    ])?;
    for point in &study.points {
        let Some((measured, time)) = point.measured().and_then(|own| Some((own, own.time?))) else {
            continue;
        };
        let ms = |seconds: f64| format!("{:.6}", 1e3 * seconds);
        let setting = &point.setting;
        writer.write_record([
            setting.family.name(),
            setting.parameter.to_owned(),
            format!("{:?}", setting.value),
            ms(time.median),
            ms(time.min),
            ms(time.max),
            time.count.to_string(),
            ms(measured.setup),
        ])?;
    }
    bytes(writer)
}
