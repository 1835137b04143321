//! Results of a run by name.

use formats::scene::Scene;
use formats::sweep::ResultKind;
use formats::units::Dimension;
use results::case_result::CaseResult;
use serde_json::Value;

use crate::outcome::{RunFailure, RunRow};

/// The results of a scene's run that are wanted.
///
/// # Errors
/// A result that the run does not have.
pub(crate) fn of_scene(
    kinds: &[ResultKind],
    scene: &Scene,
    outcome: &CaseResult,
) -> Result<RunRow, RunFailure> {
    let mut row = RunRow::default();
    for (index, kind) in kinds.iter().enumerate() {
        let before = row.names.len();
        match kind {
            ResultKind::Peaks => {
                let names: Vec<&str> = outcome
                    .columns
                    .columns
                    .iter()
                    .skip(1)
                    .map(|column| column.name.as_str())
                    .collect();
                names
                    .into_iter()
                    .for_each(|name| peaks(name, outcome, &mut row));
            }
            ResultKind::Column(name) => peaks(name, outcome, &mut row),
            ResultKind::Extremes => {
                if let Some(all) = outcome.girders().json(scene, 1) {
                    extremes(&all, false, &mut row);
                }
            }
            ResultKind::Fatigue => fatigue(outcome, &mut row),
            ResultKind::Ratios => ratios(scene, outcome, &mut row),
        }
        if row.names.len() == before {
            return Err(RunFailure::Missing(index, missing(kind, outcome)));
        }
    }
    Ok(row)
}

/// The results of a design that are wanted, from its summary.
///
/// # Errors
/// A result that the design does not have.
pub(crate) fn of_design(kinds: &[ResultKind], summary: &Value) -> Result<RunRow, RunFailure> {
    let mut row = RunRow::default();
    let has_several_cases = summary["cases"]
        .as_array()
        .is_some_and(|cases| cases.len() > 1);
    for (index, kind) in kinds.iter().enumerate() {
        let before = row.names.len();
        match kind {
            ResultKind::Extremes => extremes(&summary["extremes"], has_several_cases, &mut row),
            _ => design_ratios(summary, has_several_cases, &mut row),
        }
        if row.names.len() == before {
            let why = "the design has no limits of codes and no strengths, so there are no \"ratios\"; give \
                       `practice` or `fy`";
            return Err(RunFailure::Missing(index, why.to_owned()));
        }
    }
    Ok(row)
}

/// Largest and smallest value of a column.
fn peaks(name: &str, outcome: &CaseResult, row: &mut RunRow) {
    let Some(found) = outcome.peaks.iter().find(|peak| peak.column == name) else {
        return;
    };
    row.add(format!("{name}.max"), found.max.value, found.dimension);
    row.add(format!("{name}.min"), found.min.value, found.dimension);
}

/// Values of the entries of `extremes` in a summary, named by their members.
fn extremes(all: &Value, has_several_cases: bool, row: &mut RunRow) {
    for entry in all.as_array().into_iter().flatten() {
        let text = |key: &str| entry[key].as_str().map(str::to_owned);
        let case = has_several_cases.then(|| format!("case {}", entry["case"]));
        let span = entry["span"].as_u64().map(|span| format!("span {span}"));
        // torsion and normal forces have no plane of their own
        let plane = text("plane")
            .filter(|_| !matches!(entry["quantity"].as_str(), Some("normal" | "torsion")));
        let parts = [
            case,
            text("rail"),
            span,
            text("support"),
            text("direction"),
            text("section"),
            text("quantity"),
            plane,
            text("kind"),
        ];
        let dimension = match (entry["quantity"].as_str(), entry["direction"].as_str()) {
            (Some("deflection"), _) => Dimension::LENGTH,
            (Some("moment" | "torsion" | "Mx" | "My" | "Mz"), _)
            | (_, Some("rx" | "ry" | "rz")) => Dimension::MOMENT,
            _ => Dimension::FORCE,
        };
        if let Some(value) = entry["value"].as_f64() {
            row.add(
                parts.into_iter().flatten().collect::<Vec<_>>().join("."),
                value,
                dimension,
            );
        }
    }
}

/// Fatigue damage of one run at each stress point.
fn fatigue(outcome: &CaseResult, row: &mut RunRow) {
    for point in &outcome.fatigue {
        row.add(
            format!("{}.damage", point.column),
            point.damage.sum,
            Dimension::NUMBER,
        );
        if let Some(life) = point.life {
            row.add(
                format!("{}.life damage", point.column),
                life,
                Dimension::NUMBER,
            );
        }
    }
}

/// Fraction of the weight of all bodies that the rails on the ground carry at the start, below which something else carries
/// a part of it. Dampers between wheels and rails take some hundredths of it in the first row.
const CARRIED: f64 = 0.9;

/// Whether each rail on the ground carries at the start what it carries without motion anywhere: not where a trolley or a
/// hanging load moves from rail to rail, a load stands on the floor, or a body falls.
fn has_static_start(scene: &Scene, outcome: &CaseResult) -> bool {
    if scene
        .structures
        .iter()
        .any(|structure| structure.carrier.is_some())
        || scene.bodies.iter().any(|body| body.in_space)
    {
        return false;
    }
    let grounded = scene
        .rails
        .iter()
        .filter(|rail| scene.structures[rail.structure].carrier.is_none());
    let carried: f64 = grounded
        .filter_map(|rail| outcome.columns.part(&rail.name, "reaction").first())
        .sum();
    let weight: f64 = scene
        .bodies
        .iter()
        .map(|body| body.mass * scene.gravity)
        .sum();
    carried >= CARRIED * weight
}

/// The largest force of each rail over that of the equilibrium at the start, where that is its static force; measured
/// values of the run beside those of codes, and static deflections over their limits, where the scene asks for codes.
fn ratios(scene: &Scene, outcome: &CaseResult, row: &mut RunRow) {
    let rails = if has_static_start(scene, outcome) {
        &scene.rails[..]
    } else {
        &[]
    };
    for rail in rails {
        let forces = outcome.columns.part(&rail.name, "reaction");
        let most = forces.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if let Some(&first) = forces.first().filter(|first| **first > 0.0) {
            row.add(
                format!("{}.dynamic factor", rail.name),
                most / first,
                Dimension::NUMBER,
            );
        }
    }
    let Some(codes) = &outcome.codes else { return };
    for comparison in &codes.rows {
        row.add(
            comparison.name.to_owned(),
            comparison.measured.value,
            comparison.dimension,
        );
        let mut names: Vec<String> = Vec::new();
        for value in &comparison.values {
            let name = format!(
                "{}.{} {}",
                comparison.name, value.clause.standard, value.clause.clause
            );
            let twins = names.iter().filter(|known| **known == name).count();
            let unique = if twins > 0 {
                format!("{name} ({})", twins + 1)
            } else {
                name.clone()
            };
            names.push(name);
            row.add(unique, value.value, comparison.dimension);
        }
    }
    let limits = codes.json();
    for entry in limits["limits"].as_array().into_iter().flatten() {
        let place = format!(
            "{}.{} {} to {}",
            entry["name"].as_str().unwrap_or_default(),
            entry["rail"].as_str().unwrap_or_default(),
            entry["from"],
            entry["to"]
        );
        for code in entry["codes"].as_array().into_iter().flatten() {
            let (Some(value), Some(limit)) =
                (entry["static_deflection"].as_f64(), code["value"].as_f64())
            else {
                continue;
            };
            if limit > 0.0 {
                let named = |key: &str| code[key].as_str().unwrap_or_default().to_owned();
                row.add(
                    format!("{place}.{} {}", named("code"), named("clause")),
                    value / limit,
                    Dimension::NUMBER,
                );
            }
        }
    }
}

/// Limits and stresses of a design, each as the fraction that is used: the largest of the loads and spans that a name stands
/// for. Names contain neither sections nor the span that governs, so that they are the same for every run of a sweep.
fn design_ratios(summary: &Value, has_several_cases: bool, row: &mut RunRow) {
    let name = |entry: &Value, span: Option<u64>, last: &[&str]| {
        let text = |key: &str| entry[key].as_str().map(str::to_owned);
        let case = has_several_cases.then(|| format!("case {}", entry["case"]));
        let span = span.map(|span| format!("span {span}"));
        let ends = last.iter().map(|key| text(key));
        [case, text("rail"), span]
            .into_iter()
            .chain(ends)
            .flatten()
            .collect::<Vec<_>>()
            .join(".")
    };
    for limit in summary["limits"].as_array().into_iter().flatten() {
        if let (Some(value), Some(most)) = (limit["value"].as_f64(), limit["limit"].as_f64())
            && most > 0.0
        {
            row.add_largest(
                name(
                    limit,
                    limit["span"].as_u64(),
                    &["quantity", "code", "clause"],
                ),
                value.abs() / most,
            );
        }
    }
    for stress in summary["stresses"].as_array().into_iter().flatten() {
        if let Some(used) = stress["utilisation"].as_f64() {
            row.add_largest(name(stress, None, &["quantity"]), used);
        }
    }
}

/// Why a wanted result has no values.
fn missing(kind: &ResultKind, outcome: &CaseResult) -> String {
    match kind {
        ResultKind::Peaks => "the history has no columns".to_owned(),
        ResultKind::Extremes => "no rail of the scene has a girder, so there are no \"extremes\"".to_owned(),
        ResultKind::Fatigue => {
            "no stress point of the scene has a `detail` category, so there is no \"fatigue\"".to_owned()
        }
        ResultKind::Ratios => "the forces at the start are not the static forces of the rails, and the scene has no `practice`, so there are no \"ratios\"".to_owned(),
        ResultKind::Column(name) => {
            let known: Vec<&str> =
                outcome.columns.columns.iter().skip(1).map(|column| column.name.as_str()).collect();
            let near = formats::text::fault::nearest(name, &known);
            match near {
                Some(near) => format!("the history has no column \"{name}\"; did you mean \"{near}\"?"),
                None => format!("the history has no column \"{name}\"; it has {}", known.join(", ")),
            }
        }
    }
}
