//! The report of a run: input, results and warnings, figures, structures, energy audit.

use crate::figures::pictures::RunFigure;
use crate::{Report, ReportSection, ReportTable, TableCell, TableColumn};
use formats::grid::coupling::Coupling;
use formats::scene::{Analysis, Document, Scene};
use formats::units::Dimension;
use foundations::SolvedModel;
use results::case_result::CaseResult;
use results::columns::peak;
use results::response::RunComparison;
use results::run_error;
use results::warning;

/// Assembles the report.
#[must_use]
pub fn report(
    document: &Document,
    outcomes: &[CaseResult],
    solved: &[Option<&SolvedModel>],
    comparison: &RunComparison,
    plates: Vec<RunFigure>,
) -> Report {
    let scene = document.scene();
    let mut sections = vec![results(document, outcomes), structures(scene, solved, &outcomes[0].choices)];
    let (mut motion, mut influence) =
        (ReportSection::new("Pictures of the motion"), ReportSection::new("Pictures of the structures"));
    for plate in plates {
        let of_structure =
            ["grid-", "influence-", "girder-"].iter().any(|start| plate.name.starts_with(start));
        let target = if of_structure { &mut influence } else { &mut motion };
        let section = std::mem::take(target);
        *target = section.figure(plate.picture, plate.caption);
    }
    // figures follow the results; tables of the structures follow the figures
    sections.insert(1, motion);
    sections.push(influence);
    sections.push(forces(scene, outcomes));
    sections.push(crate::text::response_story::section(scene, &outcomes[0].label, &outcomes[0].response));
    let labels: Vec<&str> = outcomes.iter().map(|outcome| outcome.label.as_str()).collect();
    sections.extend(crate::text::response_story::beside(scene, &labels, &outcomes[0].columns, comparison));
    let codes: Vec<_> =
        outcomes.iter().map(|outcome| (outcome.label.as_str(), outcome.codes.as_ref())).collect();
    sections.extend(crate::text::codes_story::section(scene, &codes));
    let fatigue: Vec<_> =
        outcomes.iter().map(|outcome| (outcome.label.as_str(), outcome.fatigue.as_slice())).collect();
    sections.extend(crate::text::fatigue_story::section(scene, &fatigue));
    sections.push(audit(document, outcomes));
    Report {
        title: scene.name.clone(),
        subtitle: format!("girderway {}: wheels on flexible rails", env!("CARGO_PKG_VERSION")),
        sections,
    }
}

/// Peaks of every body in every run.
fn results(document: &Document, outcomes: &[CaseResult]) -> ReportSection {
    let scene = document.scene();
    let length = scene.units.label(Dimension::LENGTH);
    let mut table = ReportTable {
        caption: "Largest deflection of every body, below the unloaded rail.".to_owned(),
        columns: vec![
            TableColumn::new("run", ""),
            TableColumn::new("body", ""),
            TableColumn::new("deflection", &length),
            TableColumn::new("at x", &length),
            TableColumn::new("at time", "s"),
            TableColumn::new("against the first run", "%"),
            TableColumn::new("status", ""),
        ],
        rows: Vec::new(),
    };
    for body in &scene.bodies {
        let mut first = None;
        for outcome in outcomes {
            let Some((i, deepest)) = peak(outcome.columns.part(&body.name, "deflection")) else {
                continue;
            };
            let base = *first.get_or_insert(deepest);
            let change = if base == 0.0 { 0.0 } else { 100.0 * (deepest / base - 1.0) };
            let (status, _) = run_error::status(&outcome.run.status);
            table.rows.push(vec![
                TableCell::from(outcome.label.clone()),
                TableCell::from(body.name.clone()),
                TableCell::from(deepest),
                TableCell::from(outcome.columns.part(&body.name, "x")[i]),
                TableCell::from(outcome.columns.values("time")[i]),
                TableCell::from(change),
                TableCell::from(status.to_owned()),
            ]);
        }
    }
    let how = match scene.analysis {
        Analysis::Dynamic => {
            "the equations of motion, integrated in contact-force form by a method of order four with adaptive steps; wheels that leave or meet the rail are located in time"
        }
        Analysis::QuasiStatic => "a sequence of static equilibria over the prescribed motion",
    };
    ReportSection::new("Results")
        .paragraph(format!("The scene was computed as {how}. Deflections are positive downwards; forces on the rail are positive pressing."))
        .table(table)
}

/// The foundation of every structure, with the reason of its choice and its properties.
fn structures(scene: &Scene, solved: &[Option<&SolvedModel>], choices: &[sim::Choice]) -> ReportSection {
    let mut section = ReportSection::new("Structures");
    for (s, (structure, solved)) in scene.structures.iter().zip(solved).enumerate() {
        let choice = choices.iter().find(|choice| choice.structure == s);
        let word = choice.map_or_else(
            || structure.foundation.word().to_owned(),
            |c| foundations::fidelity_name(c.fidelity),
        );
        let name = &structure.name;
        section = section.fact(format!("{name}: foundation"), word, "").fact(
            format!("{name}: reading"),
            structure.interpolation.word().to_owned(),
            "",
        );
        if let Some(choice) = choice {
            section = section.paragraph(format!("{name}: {}.", foundations::selection_reason(choice)));
        }
        let Some(solved) = solved else { continue };
        if let Some(certificate) = &solved.grid.certificate {
            section = section
                .fact(format!("{name}: condition of the stiffness"), certificate.condition, "")
                .fact(format!("{name}: guaranteed relative error of the grid"), certificate.error_bound, "");
        }
        if let Some(girder) = solved.girder.as_ref().filter(|girder| girder.spans.len() == 1) {
            let span = girder.spans[0];
            let weight: f64 = scene.bodies.iter().map(|body| body.mass * scene.gravity).sum();
            let classical = weight * span.powi(3) / (48.0 * girder.e * girder.i_vertical);
            section = section.fact(
                format!("{name}: all weight at midspan, W L^3/(48 E I)"),
                classical,
                scene.units.label(Dimension::LENGTH),
            );
        }
        if let Some(line) = Coupling::of(&solved.grid).and_then(|coupling| coupling.summary()) {
            section = section.paragraph(format!("{name}: {line}."));
        }
        for note in &solved.grid.notes {
            section = section.paragraph(format!("{name}: {note}."));
        }
    }
    section
}

/// Extremes of the forces of every wheel in the first run.
fn forces(scene: &Scene, outcomes: &[CaseResult]) -> ReportSection {
    let unit = scene.units.label(Dimension::FORCE);
    let mut table = ReportTable {
        caption: format!("Wheel forces of the run \"{}\".", outcomes[0].label),
        columns: vec![
            TableColumn::new("wheel", ""),
            TableColumn::new("largest vertical", &unit),
            TableColumn::new("smallest vertical", &unit),
            TableColumn::new("largest lateral", &unit),
            TableColumn::new("largest traction", &unit),
        ],
        rows: Vec::new(),
    };
    for wheel in &outcomes[0].input.wheels {
        let name = &wheel.name;
        let values = |part: &str| outcomes[0].columns.part(name, part);
        let largest = |part: &str| values(part).iter().fold(0.0_f64, |max, value| max.max(value.abs()));
        let least = values("vertical").iter().copied().fold(f64::INFINITY, f64::min);
        table.rows.push(vec![
            TableCell::from(name.clone()),
            TableCell::from(largest("vertical")),
            TableCell::from(least),
            TableCell::from(largest("lateral")),
            TableCell::from(largest("traction")),
        ]);
    }
    ReportSection::new("Wheel forces").table(table)
}

/// The energy audit of the dynamic runs.
fn audit(document: &Document, outcomes: &[CaseResult]) -> ReportSection {
    let energy = document.scene().units.label(Dimension::MOMENT);
    let mut table = ReportTable {
        caption: "Energy audit: what was lost and put in, and what does not add up, relative to the peak of the stored elastic energy.".to_owned(),
        columns: vec![
            TableColumn::new("run", ""),
            TableColumn::new("peak stored", &energy),
            TableColumn::new("lost", &energy),
            TableColumn::new("put in", &energy),
            TableColumn::new("residual", ""),
            TableColumn::new("steps", ""),
        ],
        rows: Vec::new(),
    };
    for (case, outcome) in document.cases.iter().zip(outcomes) {
        let run = &outcome.run;
        if case.scene.analysis == Analysis::Dynamic && run.status.is_complete() {
            let exchanged = &run.audit.exchanged;
            table.rows.push(vec![
                TableCell::from(outcome.label.clone()),
                TableCell::from(run.audit.peak_stored),
                TableCell::from(exchanged.net_loss() + exchanged.supplied()),
                TableCell::from(exchanged.supplied()),
                TableCell::from(run.audit.residual()),
                TableCell::from(run.counts.steps as f64),
            ]);
        }
    }
    let mut section = ReportSection::new("Energy");
    for (case, outcome) in document.cases.iter().zip(outcomes) {
        for warning in warning::case_warnings(&case.scene, outcome) {
            section = section.paragraph(format!("Warning, {}: {warning}.", outcome.label));
        }
    }
    if table.rows.is_empty() {
        section.paragraph("No run of this scene is dynamic: there is no energy to audit.")
    } else {
        section.table(table)
    }
}
