//! The report of a run: input, results and warnings, figures, structures, energy audit.

use crate::figures::design::{deflection_unit, reading_unit};
use crate::figures::run_figure::RunFigure;
use crate::figures::run_name::{foundation_words, run_name};
use crate::text::run_basis::basis;
use crate::text::run_verdict::{governing_section, verdicts};
use crate::text::{codes, fatigue, girders, responses};
use crate::{Report, ReportSection, ReportTable, TableCell, TableColumn, cleared};
use formats::grid::coupling::Coupling;
use formats::scene::{Analysis, Document, Scene};
use formats::text::number::rounded;
use formats::units::Dimension;
use foundations::SolvedModel;
use results::case_result::CaseResult;
use results::response::RunComparison;
use results::run_error;
use results::steps::ColumnInstant;
use results::warning;
use sim::Method;

/// Assembles the report of a document: `outcomes` has one result for each of its cases, `solved` the solved model of
/// each structure, and `figures` those of the run.
#[must_use]
pub fn report(
    document: &Document,
    outcomes: &[CaseResult],
    solved: &[Option<&SolvedModel>],
    comparison: &RunComparison,
    figures: Vec<RunFigure>,
) -> Report {
    let scene = document.scene();
    let mut sections = vec![
        results(document, outcomes),
        structures(scene, solved, &outcomes[0].choices),
    ];
    let (mut motion, mut influence) = (
        ReportSection::new("Figures of the motion"),
        ReportSection::new("Figures of the structures"),
    );
    for figure in figures {
        let of_structure = ["grid-", "influence-", "girder-"]
            .iter()
            .any(|start| figure.name.starts_with(start));
        let target = if of_structure {
            &mut influence
        } else {
            &mut motion
        };
        let section = std::mem::take(target);
        *target = section.figure(figure.picture, figure.caption);
    }
    // figures follow the results; tables of the structures follow the figures
    sections.insert(1, motion);
    sections.push(influence);
    sections.push(forces(scene, outcomes));
    sections.push(responses::section(
        scene,
        run_name(&outcomes[0].label),
        &outcomes[0].response,
    ));
    let labels: Vec<&str> = outcomes
        .iter()
        .map(|outcome| run_name(&outcome.label))
        .collect();
    sections.extend(responses::comparison(
        scene,
        &labels,
        &outcomes[0].columns,
        comparison,
    ));
    let checks: Vec<_> = outcomes
        .iter()
        .map(|outcome| (run_name(&outcome.label), outcome.codes.as_ref()))
        .collect();
    sections.extend(codes::section(scene, &checks));
    let damages: Vec<_> = outcomes
        .iter()
        .map(|outcome| (run_name(&outcome.label), outcome.fatigue.as_slice()))
        .collect();
    sections.extend(fatigue::section(scene, &damages));
    sections.extend(warnings(document, outcomes));
    sections.push(audit(document, outcomes));
    let extremes = girders::section(document, outcomes);
    sections.splice(
        0..0,
        verdicts(document, outcomes)
            .into_iter()
            .chain([
                governing_section(document, outcomes),
                basis(document, outcomes),
            ])
            .chain(extremes),
    );
    Report {
        title: scene.name.clone(),
        subtitle: format!(
            "girderway {}: wheels on flexible rails",
            env!("CARGO_PKG_VERSION")
        ),
        sections,
    }
}

/// The largest deflection of every body in every run, and how the scene was computed.
fn results(document: &Document, outcomes: &[CaseResult]) -> ReportSection {
    let scene = document.scene();
    let length = scene.units.label(Dimension::LENGTH);
    let (unit, factor) = deflection_unit(scene.units);
    let mut table = ReportTable {
        caption: "Largest deflection of every body below the unloaded rail.".to_owned(),
        columns: vec![
            TableColumn::new("run", ""),
            TableColumn::new("body", ""),
            TableColumn::new("deflection", unit),
            TableColumn::new("at x", &length),
            TableColumn::new("at time", "s"),
            TableColumn::new("relative to the first run", "%"),
            TableColumn::new("status", ""),
        ],
        rows: Vec::new(),
    };
    for body in &scene.bodies {
        let mut first = None;
        for outcome in outcomes {
            let Some(peak) = outcome.peak(&body.name, "deflection") else {
                continue;
            };
            let ColumnInstant { value, time } = peak.max;
            let deepest = value;
            let base = *first.get_or_insert(deepest);
            let change = if base == 0.0 {
                0.0
            } else {
                100.0 * (deepest / base - 1.0)
            };
            let (status, _) = run_error::status(&outcome.run.status);
            table.rows.push(vec![
                TableCell::from(run_name(&outcome.label)),
                TableCell::from(body.name.clone()),
                TableCell::from(factor * deepest),
                outcome
                    .columns
                    .at_time(&body.name, "x", time)
                    .map_or(TableCell::Empty, TableCell::from),
                TableCell::from(time),
                TableCell::from(rounded(change, 3)),
                TableCell::from(status.to_owned()),
            ]);
        }
    }
    let mut section = ReportSection::new("Results");
    for text in analyses(document, outcomes) {
        section = section.paragraph(text);
    }
    section
        .paragraph(
            "Deflections are positive downwards; forces on the rail are positive in compression.",
        )
        .table(table)
}

/// How the runs were computed: one sentence for all runs that were computed alike.
fn analyses(document: &Document, outcomes: &[CaseResult]) -> Vec<String> {
    let cases = document.cases.iter().zip(outcomes);
    let all: Vec<String> = cases
        .map(|(case, outcome)| analysis(&case.scene, outcome.run.method))
        .collect();
    if all.windows(2).all(|pair| pair[0] == pair[1]) {
        return all
            .first()
            .map(|how| format!("The scene was computed {how}."))
            .into_iter()
            .collect();
    }
    let mut groups: Vec<(String, Vec<String>)> = Vec::new();
    for (outcome, how) in outcomes.iter().zip(all) {
        let label = format!("\"{}\"", run_name(&outcome.label));
        match groups.iter_mut().find(|(known, _)| *known == how) {
            Some((_, labels)) => labels.push(label),
            None => groups.push((how, vec![label])),
        }
    }
    let sentence = |(how, labels): (String, Vec<String>)| {
        let (runs, were) = if labels.len() == 1 {
            ("run", "was")
        } else {
            ("runs", "were")
        };
        format!("The {runs} {} {were} computed {how}.", labels.join(", "))
    };
    groups.into_iter().map(sentence).collect()
}

/// How a scene was computed; `method` is the method of integration that its run took.
fn analysis(scene: &Scene, method: Option<Method>) -> String {
    if scene.analysis == Analysis::QuasiStatic {
        return "as a sequence of static equilibria over the prescribed motion".to_owned();
    }
    let method = match method.unwrap_or(scene.stepping.method) {
        Method::Auto => "a method chosen by the program",
        Method::Sdirk4 => "SDIRK, a method of order 4,",
        Method::Esdirk5 => "ESDIRK, a method of order 5,",
        Method::Radau => {
            "Radau IIA collocation, a method of order 9 (5 with dampers between wheels and rails),"
        }
        Method::Gauss2 => "Gauss collocation, a method of order 4,",
        Method::Gauss3 => "Gauss collocation, a method of order 6,",
        Method::Series => "power series in time, whose order increases with the accuracy,",
    };
    let steps = if scene.stepping.step.is_some() {
        "equal steps"
    } else {
        "adaptive steps"
    };
    format!(
        "from the equations of motion in contact-force form, integrated by {method} with {steps}; the times at which \
         wheels lose or regain contact with the rail are located"
    )
}

/// The foundation of every structure, the reason of its choice, and properties of the structure.
fn structures(
    scene: &Scene,
    solved: &[Option<&SolvedModel>],
    choices: &[sim::Choice],
) -> ReportSection {
    let mut section = ReportSection::new("Structures");
    for (s, (structure, solved)) in scene.structures.iter().zip(solved).enumerate() {
        let choice = choices.iter().find(|choice| choice.structure == s);
        let word = choice.map_or_else(
            || foundation_words(structure.foundation.word()).to_owned(),
            |c| run_name(&foundations::fidelity_name(c.fidelity)).to_owned(),
        );
        let name = &structure.name;
        section = section.fact(format!("{name}: foundation"), word, "").fact(
            format!("{name}: reading"),
            structure.interpolation.word().to_owned(),
            "",
        );
        if let Some(choice) = choice {
            section = section.paragraph(format!(
                "{name}: {}.",
                foundations::selection_reason(choice)
            ));
        }
        let Some(solved) = solved else { continue };
        if let Some(certificate) = &solved.grid.certificate {
            section = section
                .fact(
                    format!("{name}: condition number of the stiffness matrix"),
                    rounded(certificate.condition, 2),
                    "",
                )
                .fact(
                    format!("{name}: bound of the relative error of the grid"),
                    rounded(certificate.error_bound, 2),
                    "",
                );
        }
        if let Some(girder) = solved
            .girder
            .as_ref()
            .filter(|girder| girder.spans.len() == 1)
        {
            let span = girder.spans[0];
            let weight: f64 = scene
                .bodies
                .iter()
                .map(|body| body.mass * scene.gravity)
                .sum();
            let classical = weight * span.powi(3) / (48.0 * girder.e * girder.i_vertical);
            let (unit, factor) = deflection_unit(scene.units);
            section = section.fact(
                format!("{name}: total weight at midspan, W L^3/(48 E I)"),
                factor * classical,
                unit,
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

/// Extreme forces of every wheel in the first run.
fn forces(scene: &Scene, outcomes: &[CaseResult]) -> ReportSection {
    let (unit, factor) = reading_unit(scene.units, Dimension::FORCE);
    let mut table = ReportTable {
        caption: format!(
            "Wheel forces of the run \"{}\".",
            run_name(&outcomes[0].label)
        ),
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
        let peak = |part: &str| outcomes[0].peak(name, part);
        let largest = |part: &str| peak(part).map_or(0.0, |peak| peak.largest().value.abs());
        let least = peak("vertical").map_or(0.0, |peak| peak.min.value);
        table.rows.push(vec![
            TableCell::from(name.clone()),
            TableCell::from(factor * largest("vertical")),
            TableCell::from(factor * least),
            TableCell::from(factor * largest("lateral")),
            TableCell::from(factor * largest("traction")),
        ]);
    }
    ReportSection::new("Wheel forces").table(table)
}

/// All warnings and notes of the runs; `None` where there are none.
fn warnings(document: &Document, outcomes: &[CaseResult]) -> Option<ReportSection> {
    let mut section = ReportSection::new("Warnings and notes");
    for message in warning::messages(outcomes, document) {
        let kind = if message.is_warning {
            "Warning"
        } else {
            "Note"
        };
        let runs = if message.runs.is_empty() {
            String::new()
        } else {
            format!(
                ", {}",
                message
                    .runs
                    .iter()
                    .map(|label| run_name(label))
                    .collect::<Vec<_>>()
                    .join(", ")
            )
        };
        section = section.paragraph(format!("{kind}{runs}: {}.", message.text));
    }
    (!section.paragraphs.is_empty()).then_some(section)
}

/// The energy audit of the dynamic runs.
fn audit(document: &Document, outcomes: &[CaseResult]) -> ReportSection {
    let (energy, factor) = reading_unit(document.scene().units, Dimension::MOMENT);
    let mut table = ReportTable {
        caption:
            "Energy audit: largest stored elastic energy, energy lost and supplied, and residual relative to \
                  the largest stored energy."
                .to_owned(),
        columns: vec![
            TableColumn::new("run", ""),
            TableColumn::new("largest stored", &energy),
            TableColumn::new("lost", &energy),
            TableColumn::new("supplied", &energy),
            TableColumn::new("residual", ""),
            TableColumn::new("steps", ""),
        ],
        rows: Vec::new(),
    };
    for (case, outcome) in document.cases.iter().zip(outcomes) {
        let run = &outcome.run;
        if case.scene.analysis == Analysis::Dynamic && run.status.is_complete() {
            let exchanged = &run.audit.exchanged;
            let lost = exchanged.net_loss() + exchanged.supplied();
            table.rows.push(vec![
                TableCell::from(run_name(&outcome.label)),
                TableCell::from(factor * run.audit.peak_stored),
                TableCell::from(factor * cleared(lost, run.audit.peak_stored)),
                TableCell::from(factor * exchanged.supplied()),
                TableCell::from(rounded(run.audit.residual(), 2)),
                TableCell::from(run.counts.steps as f64),
            ]);
        }
    }
    let section = ReportSection::new("Energy");
    if table.rows.is_empty() {
        section.paragraph("No dynamic run reached its end, so there is no energy audit.")
    } else {
        section.table(table)
    }
}
