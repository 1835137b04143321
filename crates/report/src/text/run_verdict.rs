//! The first page of a run: its verdict, what governs, and where the wheels stand then.

use crate::figures::design::{digits, reading_unit, unit_of, with_unit};
use crate::figures::rail_sketch::RailSketch;
use crate::figures::responses::supports;
use crate::figures::run_name::run_name;
use crate::text::checks::verdict_section;
use crate::text::girder_stresses;
use crate::text::girders::largest;
use crate::text::run_governing::governing;
use crate::{ReportSection, ReportTable, TableCell, TableColumn};
use formats::scene::{Analysis, Document, Scene};
use formats::units::Dimension;
use results::case_result::CaseResult;
use results::girders::GirderExtreme;
use results::run_error;
use results::verdict::verdict;
use results::warning;
use trains::GirderResponse;

/// Significant digits of values.
const DIGITS: usize = 4;
/// Largest number of warnings on the first page.
const WARNINGS: usize = 4;

/// The verdict on the first run, and one line for each other; `None` where the first run did not reach its end.
pub(super) fn verdicts(document: &Document, outcomes: &[CaseResult]) -> Option<ReportSection> {
    let first = &outcomes[0];
    if !first.run.status.is_complete() {
        return None;
    }
    let scene = document.scene();
    let mut section = verdict_section("Verdict", &verdict(scene, first), scene.units);
    if outcomes.len() > 1 {
        let others = document.cases.iter().zip(outcomes).skip(1);
        let rows = others.map(|(case, outcome)| {
            let line = match outcome.run.status.is_complete() {
                true => verdict(&case.scene, outcome).banner(),
                false => "the run did not reach its end".to_owned(),
            };
            vec![
                TableCell::from(run_name(&outcome.label)),
                TableCell::from(line),
            ]
        });
        section = section.table(ReportTable {
            caption: format!(
                "Verdicts on the other runs; the checks above are those of \"{}\"",
                run_name(&first.label)
            ),
            columns: ["run", "verdict"]
                .iter()
                .map(|name| TableColumn::new(*name, ""))
                .collect(),
            rows: rows.collect(),
        });
    }
    Some(section)
}

/// Status, governing values, and the wheels at the instant of the largest sagging moment.
pub(super) fn governing_section(document: &Document, outcomes: &[CaseResult]) -> ReportSection {
    let mut section = ReportSection::new("Governing values");
    section.paragraphs.extend(statuses(document, outcomes));
    section
        .paragraphs
        .extend(checks(document.scene(), &outcomes[0]));
    section
        .paragraphs
        .extend(girder_stresses::verdict_line(document, outcomes));
    let mut all: Vec<String> = Vec::new();
    for (case, outcome) in document.cases.iter().zip(outcomes) {
        let own = warning::case_warnings(&case.scene, outcome).into_iter();
        all.extend(own.map(|text| format!("Warning, {}: {text}.", run_name(&outcome.label))));
    }
    let more = all.len().saturating_sub(WARNINGS);
    section.paragraphs.extend(all.into_iter().take(WARNINGS));
    if more > 0 {
        section = section.paragraph(format!(
            "{more} more warnings are in the section on warnings and notes."
        ));
    }
    let table = governing(document, outcomes);
    if !table.rows.is_empty() {
        section = section.table(table);
    }
    let sagging = largest(&outcomes[0], GirderResponse::VerticalMoment, true);
    match sagging.and_then(|found| sketch(document.scene(), &outcomes[0], found)) {
        Some((svg, caption)) => section.figure(svg, caption),
        None => section,
    }
}

/// Whether the runs reached their ends, and how well their energy balances.
fn statuses(document: &Document, outcomes: &[CaseResult]) -> Vec<String> {
    let mut out = Vec::new();
    for (case, outcome) in document.cases.iter().zip(outcomes) {
        if let Some(why) = run_error::reason_incomplete(&outcome.run.status, &case.scene) {
            out.push(format!(
                "The run \"{}\" is incomplete: {why}.",
                run_name(&outcome.label)
            ));
        }
    }
    if out.is_empty() {
        out.push(match outcomes.len() {
            1 => "The run was completed.".to_owned(),
            2 => "Both runs were completed.".to_owned(),
            count => format!("All {count} runs were completed."),
        });
    }
    let dynamic = document
        .cases
        .iter()
        .zip(outcomes)
        .filter(|(case, outcome)| {
            case.scene.analysis == Analysis::Dynamic && outcome.run.status.is_complete()
        });
    let residual = dynamic
        .map(|(_, outcome)| outcome.run.audit.residual().abs())
        .reduce(f64::max);
    if let Some((residual, first)) = residual.zip(out.first_mut()) {
        first.push_str(&format!(
            " The energy balance closes to {} of the largest stored energy.",
            digits(residual, 2)
        ));
    }
    out
}

/// What the first run does not determine, uplift and fatigue in it.
fn checks(scene: &Scene, outcome: &CaseResult) -> Vec<String> {
    let mut out = Vec::new();
    if let Some(worst) = outcome.undetermined.first() {
        out.push(format!(
            "Largest values are not determined: {}. That of {} is between {} and {}{}; the forces and deflections that follow \
             from such bounces are as uncertain.",
            worst.reason,
            worst.quantity,
            digits(worst.low, 4),
            digits(worst.high, 4),
            match outcome.undetermined.len() - 1 {
                0 => String::new(),
                more => format!(", and {more} others vary as well"),
            },
        ));
    }
    if let Some(first) = outcome.response.first_uplift() {
        out.push(format!(
            "Wheels are without contact {} times, first {} at {} s.",
            outcome.response.uplifts.len(),
            first.wheel,
            digits(first.time, DIGITS)
        ));
    }
    if let Some(worst) = outcome
        .fatigue
        .iter()
        .max_by(|a, b| a.damage.sum.total_cmp(&b.damage.sum))
    {
        let life = worst.life.map_or_else(String::new, |life| {
            format!(", {} of a life", digits(life, 3))
        });
        out.push(format!(
            "Fatigue: the largest damage of the run is {}{life} at {} (detail {}), gamma_Mf = {}.",
            digits(worst.damage.sum, 3),
            worst.column,
            worst.detail.word(),
            scene.output.fatigue.material
        ));
    }
    out
}

/// The rail of an extreme with the wheels at its instant, and the caption.
fn sketch(
    scene: &Scene,
    outcome: &CaseResult,
    found: &GirderExtreme,
) -> Option<(crate::chart::Svg, String)> {
    let rail = scene.rails.get(found.rail)?;
    let supports = supports(scene, found.rail);
    let times = outcome.columns.values("time");
    let distance = |row: &usize| (times[*row] - found.time).abs();
    let row = (0..times.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let (force, factor) = reading_unit(scene.units, Dimension::FORCE);
    let on_rail = outcome
        .input
        .wheels
        .iter()
        .filter(|wheel| wheel.rail == found.rail);
    let at = |name: &str, part: &str| outcome.columns.part(name, part).get(row).copied();
    let wheels = on_rail
        .filter_map(|wheel| Some((at(&wheel.name, "x")?, factor * at(&wheel.name, "vertical")?)));
    let [from, to] = rail.range;
    let length = scene.units.label(Dimension::LENGTH);
    let sketch = RailSketch {
        range: rail.range,
        supports: &supports,
        length_unit: &length,
        wheels: wheels.filter(|(x, _)| (from..=to).contains(x)).collect(),
        section: Some(found.x),
    };
    let (unit, by) = unit_of(scene.units, found.quantity);
    let caption = format!(
        "The wheels on {} at t = {} s, when its largest sagging moment is {} at x = {}, drawn to scale along the \
         rail; at each wheel its vertical force in {force} and its position in {length} ({}).",
        rail.name,
        digits(found.time, DIGITS),
        with_unit(&digits(by * found.value, DIGITS), &unit),
        digits(found.x, DIGITS),
        run_name(&outcome.label),
    );
    Some((sketch.svg("Wheels at the largest sagging moment"), caption))
}
