//! On what a run rests, in brief: structures, bodies, wheels, analysis, codes.

use crate::ReportSection;
use crate::figures::design::{digits, reading_unit};
use crate::figures::run_name::{foundation_words, run_name};
use crate::text::codes::code_with_edition;
use crate::text::structure_words::structure_facts;
use formats::scene::{Analysis, Document, Origin, Scene, stepper_word};
use formats::units::Dimension;
use results::case_result::CaseResult;
use sim::{Fidelity, Method};

/// Largest number of structures, and of codes, that are listed.
const MOST: [usize; 2] = [3, 8];
/// Significant digits of inputs.
const DIGITS: usize = 4;

/// The inputs in brief.
pub(super) fn basis(document: &Document, outcomes: &[CaseResult]) -> ReportSection {
    let scene = document.scene();
    let mut section = ReportSection::new("Basis");
    for (s, structure) in scene.structures.iter().enumerate().take(MOST[0]) {
        let chosen = outcomes[0]
            .choices
            .iter()
            .find(|choice| choice.structure == s);
        let foundation = match chosen.map(|choice| choice.fidelity) {
            None => foundation_words(structure.foundation.word()).to_owned(),
            Some(fidelity) => {
                let word = match fidelity {
                    Fidelity::Rigid => "rigid",
                    Fidelity::Influence => "influence",
                    Fidelity::Modal(_) => "modal",
                };
                format!("{}, chosen by the program", foundation_words(word))
            }
        };
        match &structure.origin {
            Origin::Spec { spec, file, .. } => {
                let spans: Vec<Vec<f64>> = spec.model().map_or_else(
                    |_| Vec::new(),
                    |(model, rails)| {
                        let of = |rail| spec.spans(&model, &rails, rail);
                        (0..rails.len()).map(of).collect()
                    },
                );
                for (name, text) in structure_facts(spec, file, scene.units, &spans) {
                    let text = if name == "structure" {
                        format!("{text}; {foundation}")
                    } else {
                        text
                    };
                    section = section.fact(format!("{}: {name}", structure.name), text, "");
                }
            }
            Origin::Tables { file, .. } => {
                let text = format!("tables of {file}; {foundation}");
                section = section.fact(format!("{}: structure", structure.name), text, "");
            }
        }
    }
    if scene.structures.len() > MOST[0] {
        section = section.fact("further structures", scene.structures.len() - MOST[0], "");
    }
    let labels: Vec<&str> = outcomes
        .iter()
        .map(|outcome| run_name(&outcome.label))
        .collect();
    section
        .fact(
            "moving loads",
            bodies(scene, outcomes[0].input.wheels.len()),
            "",
        )
        .fact("analysis", analysis(scene, outcomes[0].run.method), "")
        .fact("runs", labels.join(", "), "")
        .fact("codes", codes(&outcomes[0]), "")
        .ending_page()
}

/// Weights of the bodies, and the number of wheels.
fn bodies(scene: &Scene, wheels: usize) -> String {
    let (unit, factor) = reading_unit(scene.units, Dimension::FORCE);
    let weights: Vec<String> = scene
        .bodies
        .iter()
        .filter(|body| body.mass > 0.0)
        .map(|body| {
            format!(
                "{} {}",
                body.name,
                digits(factor * body.mass * scene.gravity, DIGITS)
            )
        })
        .collect();
    let count = if wheels == 1 {
        "1 wheel".to_owned()
    } else {
        format!("{wheels} wheels")
    };
    if weights.is_empty() {
        count
    } else {
        format!("{count}; weights {} {unit}", weights.join(", "))
    }
}

fn analysis(scene: &Scene, method: Option<Method>) -> String {
    let kind = match (scene.analysis, method) {
        (Analysis::QuasiStatic, _) => "quasi-static".to_owned(),
        (Analysis::Dynamic, None) => "dynamic".to_owned(),
        (Analysis::Dynamic, Some(method)) => format!("dynamic, stepper {}", stepper_word(method)),
    };
    format!(
        "{kind}, {} s, output every {} s, accuracy {}",
        digits(scene.end, DIGITS),
        digits(scene.dt, DIGITS),
        digits(scene.accuracy, 2)
    )
}

/// Codes and editions whose values the report compares.
fn codes(outcome: &CaseResult) -> String {
    let Some(codes) = &outcome.codes else {
        return "none named".to_owned();
    };
    let values = codes
        .rows
        .iter()
        .flat_map(|row| row.values.iter().map(|value| &value.clause));
    let limits = codes
        .limits
        .iter()
        .flat_map(|found| found.limits.iter().map(|limit| &limit.limit.clause));
    let mut all: Vec<String> = Vec::new();
    for clause in values.chain(limits) {
        let name = code_with_edition(clause);
        if !all.contains(&name) {
            all.push(name);
        }
    }
    let more = all.len().saturating_sub(MOST[1]);
    all.truncate(MOST[1]);
    let rest = if more > 0 {
        format!(" and {more} more")
    } else {
        String::new()
    };
    if all.is_empty() {
        "none named".to_owned()
    } else {
        format!("{}{rest}", all.join("; "))
    }
}
