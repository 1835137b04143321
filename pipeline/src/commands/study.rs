//! `girderway study`: accuracy and cost of the settings of a scene.

use super::run::solve_all;
use std::path::PathBuf;

use serde_json::json;

use crate::cli::{Global, StudyArgs as Arguments};
use crate::exit::{Exit, Failure};
use crate::output;
use crate::progress::Progress;
use formats::scene::{Case, Document};
use formats::text::diagnostic::Diagnostic;
use foundations::{SolvedStructure, distinct_specs};
use outputs::files::json as json_text;
use outputs::folder::{OutputFolder, PlannedFiles};
use outputs::manifest::Manifest;
use study::stability::{self, MapSubject, MapVerdict};
use study::{self, SettingFamily, Study, StudyBudget, StudyPoint};

/// Runs a scene with a series of settings, measures errors and times, and draws charts of them.
///
/// # Errors
/// The scene or one of its files is invalid, or a reference solution does not resolve the requested error. In the
/// latter case the results are written before the error is returned.
pub fn run(args: &Arguments, global: Global) -> Result<Exit, Failure> {
    let progress = Progress::new(global);
    let mut document = Document::open(&args.scene)?;
    let name = document.scene().name.clone();
    let label = args.case.clone();
    let chosen = Document {
        cases: document
            .cases
            .iter()
            .filter(|case| case.label == label)
            .cloned()
            .collect(),
        inputs: document.inputs.clone(),
        changes: None,
    };
    document.cases = vec![case(&document, args)?];
    results::preflight::check(&chosen)?;
    let document = foundations::with_wheels_at_rest(document);
    let scene = document.scene().clone();
    let folder = || PathBuf::from("girderway-out").join(format!("{name}-study"));
    let path = args.output.clone().unwrap_or_else(folder);
    let mut folder = OutputFolder::open(&path, "study", args.force, &planned(args.stability))?;
    let mut budget = if args.quick {
        StudyBudget::quick()
    } else {
        StudyBudget::full()
    };
    budget.limit = args.limit.unwrap_or(budget.limit);
    budget.repetition_limit = budget.repetition_limit.min(budget.limit);
    budget.resolution = args.resolution.unwrap_or(budget.resolution);

    let known = solve_all(&document, &distinct_specs(&document), &progress)?;
    if args.stability {
        return stability(args, &document, &known, folder, global);
    }
    let study = study::study(&scene, &known, &budget, &progress)?;

    let result = study::json(&study, &scene, &budget);
    folder.add("study.json", json_text(&result));
    folder.add("study.csv", study::csv(&study).map_err(Failure::untrusted)?);
    folder.add_varying("timing.json", json_text(&study::timing_json(&study)));
    folder.add_varying(
        "timing.csv",
        study::timing_csv(&study).map_err(Failure::untrusted)?,
    );
    for figure in study::figures(&study, &name).map_err(Failure::untrusted)? {
        let file = format!("plots/{}.svg", figure.name);
        if figure.varies {
            folder.add_varying(&file, figure.svg)
        } else {
            folder.add(&file, figure.svg)
        }
    }
    let settings = json!({
        "case": args.case, "quick": args.quick, "limit": budget.limit, "resolution": budget.resolution,
    });
    let written = folder.commit(Manifest::new("study", &document.inputs, settings))?;
    for (family, who) in [
        (SettingFamily::Written, "as written"),
        (SettingFamily::Auto, "choice of auto"),
        (
            SettingFamily::Stepping,
            "as written, compared with other methods on its foundations",
        ),
    ] {
        let ratios = |cost: &dyn Fn(&StudyPoint) -> Option<f64>| {
            let all = study::cost_ratios(&study, family, cost).into_iter();
            let ratios: Vec<String> = all
                .map(|(own, by)| format!("{by:.2} {}", own.name()))
                .collect();
            ratios.join(", ")
        };
        let [time, work] = [ratios(&StudyPoint::seconds), ratios(&study::stages)];
        if !work.is_empty() {
            progress.say(&format!(
                "{who}: cost relative to the cheapest setting with no larger error: time {time}; contact solutions \
                 {work}"
            ));
        }
    }
    progress.say(&format!("wrote {}", written.display()));
    if global.json {
        let all = json!({ "output": written.display().to_string(), "study": result });
        output::print(&json_text(&all))?;
    }
    judge(&study, &budget)
}

/// Files that the command writes. Names of charts are known only at the end.
fn planned(stability: bool) -> PlannedFiles {
    let names: &[&str] = if stability {
        &["stability.json", "stability.csv"]
    } else {
        &["study.json", "study.csv", "timing.json", "timing.csv"]
    };
    let plots = if stability {
        vec!["stability-".to_owned()]
    } else {
        Vec::new()
    };
    PlannedFiles {
        names: names.iter().map(|name| (*name).to_owned()).collect(),
        plots,
    }
}

/// Computes and writes maps of the parameters for which methods fail.
fn stability(
    args: &Arguments,
    document: &Document,
    known: &[SolvedStructure],
    mut folder: OutputFolder,
    global: Global,
) -> Result<Exit, Failure> {
    let progress = Progress::new(global);
    let subject = MapSubject::of(document.scene(), known).map_err(Failure::Differs)?;
    let (maps, absent) = stability::maps(&subject, args.quick, &progress);
    let result = stability::json(&maps, &absent);
    folder.add("stability.json", json_text(&result));
    folder.add(
        "stability.csv",
        stability::csv(&maps).map_err(Failure::untrusted)?,
    );
    for map in &maps {
        let figures = stability::figures(map).map_err(Failure::untrusted)?;
        let is_one = figures.len() == 1;
        for (index, svg) in figures.into_iter().enumerate() {
            let number = if is_one {
                String::new()
            } else {
                format!("-{}", index + 1)
            };
            folder.add(&format!("plots/stability-{}{number}.svg", map.name), svg);
        }
    }
    let settings = json!({ "case": args.case, "quick": args.quick, "stability": true });
    let written = folder.commit(Manifest::new("study", &document.inputs, settings))?;
    for map in &maps {
        for layer in map.layers.iter().filter(|layer| layer.is_ours) {
            let counts = MapVerdict::WORDS
                .iter()
                .zip(layer.counts())
                .filter(|(_, count)| *count > 0);
            let summary: Vec<String> = counts
                .map(|(word, count)| format!("{count} {word}"))
                .collect();
            progress.say(&format!(
                "{}: {}: {}",
                map.name,
                layer.method,
                summary.join(", ")
            ));
        }
    }
    progress.say(&format!("wrote {}", written.display()));
    if global.json {
        let all = json!({ "output": written.display().to_string(), "stability": result });
        output::print(&json_text(&all))?;
    }
    match maps.iter().find(|map| map.silent_count() > 0) {
        None => Ok(Exit::Done),
        Some(map) => Err(Failure::Untrusted(format!(
            "undetected errors of girderway at {} points of the map \"{}\": see stability.csv",
            map.silent_count(),
            map.name
        ))),
    }
}

/// Returns the scene itself, or the comparison with the requested label.
fn case(document: &Document, args: &Arguments) -> Result<Case, Failure> {
    let Some(label) = &args.case else {
        return Ok(Case {
            label: None,
            scene: document.scene().clone(),
        });
    };
    let labels: Vec<&str> = document
        .cases
        .iter()
        .filter_map(|case| case.label.as_deref())
        .collect();
    match document
        .cases
        .iter()
        .find(|case| case.label.as_ref() == Some(label))
    {
        Some(found) => Ok(Case {
            label: None,
            scene: found.scene.clone(),
        }),
        None => {
            let hint = match labels.as_slice() {
                [] => "the scene has no comparisons".to_owned(),
                labels => format!("known: {}", labels.join(", ")),
            };
            let wrong = Diagnostic::of_file(
                "--case",
                format!("must be the label of a comparison, got \"{label}\""),
            );
            Err(wrong.hint(hint).into())
        }
    }
}

/// Checks that the reference solutions resolve the error that the budget requires.
fn judge(study: &Study, budget: &StudyBudget) -> Result<Exit, Failure> {
    if let Some((kind, why)) = study.failed_references.first() {
        let hint = if why.contains("was stopped") {
            "  hint: raise --limit"
        } else {
            ""
        };
        return Err(Failure::Untrusted(format!(
            "no reference \"{}\": {why}{hint}",
            kind.word()
        )));
    }
    let worst = study
        .references
        .iter()
        .max_by(|a, b| a.worst_resolution().total_cmp(&b.worst_resolution()));
    match worst.filter(|worst| worst.worst_resolution() > budget.resolution) {
        None => Ok(Exit::Done),
        Some(worst) => Err(Failure::Untrusted(format!(
            "the reference \"{}\" is not converged: its two finest runs differ by {:.1e}, so that errors of \
             deflections and wheel forces below {:.1e} are not resolved; requested: {:.1e}  hint: raise --limit or \
             --resolution",
            worst.kind.word(),
            worst.worst_resolution() / study::RESOLUTION_FACTOR,
            worst.worst_resolution(),
            budget.resolution
        ))),
    }
}
