//! Report content on fatigue.

use crate::{ReportSection, ReportTable, TableCell, TableColumn};
use formats::scene::Scene;
use formats::spec::Detail;
use formats::text::number::rounded;
use formats::units::{Dimension, Force, Length, Scale, Units};
use results::fatigue::FatigueResult;

/// Significant digits of stresses and damages.
const DIGITS: usize = 4;

/// The section on fatigue, with all runs; `None` where there are no stress points.
#[must_use]
pub fn section(scene: &Scene, runs: &[(&str, &[FatigueResult])]) -> Option<ReportSection> {
    if runs.iter().all(|(_, verdicts)| verdicts.is_empty()) {
        return None;
    }
    let fatigue = &scene.output.fatigue;
    let section = ReportSection::new("Fatigue").paragraph(format!(
        "Direct stresses N/A + My z/Iy - Mz y/Iz of the moving loads at the stress points of the sections, counted by \
         rainflow (ASTM E1049) and summed by Miner's rule over the run; gamma_Ff = {}, gamma_Mf = {}. Numbers are \
         detail categories of EN 1993-1-9 (N/mm\u{b2}), letters are those of AISC 360 (ksi). A history whose ranges \
         are all within the limit causes no damage.",
        fatigue.loads, fatigue.material
    ));
    Some(section.table(points(scene, runs)))
}

/// The stress points, each with one row for each run.
fn points(scene: &Scene, runs: &[(&str, &[FatigueResult])]) -> ReportTable {
    let with_life = scene.output.fatigue.crossings.is_some();
    let columns = [
        "point",
        "run",
        "detail",
        "cycles",
        "range",
        "limit",
        "unit",
        "damage",
        "equivalent",
        "runs",
    ];
    let mut columns: Vec<TableColumn> = columns.map(|name| TableColumn::new(name, "")).into();
    if with_life {
        columns.push(TableColumn::new("life", ""));
    }
    let names = runs
        .iter()
        .map(|(_, verdicts)| verdicts.iter().map(|verdict| &verdict.column));
    let names: Vec<&String> = names
        .max_by_key(ExactSizeIterator::len)
        .into_iter()
        .flatten()
        .collect();
    let mut rows = Vec::new();
    for name in names {
        let mut head = TableCell::from(name.clone());
        for (label, verdicts) in runs {
            let Some(verdict) = verdicts.iter().find(|verdict| verdict.column == *name) else {
                continue;
            };
            let mut row = vec![std::mem::take(&mut head), TableCell::from(*label)];
            row.extend(result(scene, verdict));
            if with_life {
                row.push(verdict.life.map_or(TableCell::Empty, |life| {
                    TableCell::from(rounded(life, DIGITS))
                }));
            }
            rows.push(row);
        }
    }
    let caption = "Stress points: detail category, number of cycles, largest range and fatigue limit, damage of the \
                   run, range of one cycle of equal damage, runs to failure, and damage of the service life where its \
                   number of crossings is specified. All cycles are in cycles.csv.";
    ReportTable {
        caption: caption.to_owned(),
        columns,
        rows,
    }
}

/// Cells of one stress point in one run, from its detail category to the number of runs to failure.
fn result(scene: &Scene, verdict: &FatigueResult) -> [TableCell; 8] {
    let (unit, length, force) = match verdict.detail {
        Detail::Eurocode(_) => ("N/mm\u{b2}", Length::Millimetre, Force::Newton),
        Detail::Aisc(_) => ("ksi", Length::Inch, Force::Kip),
    };
    let scale = Scale {
        from: scene.units,
        to: Units { length, force },
    }
    .factor(Dimension::STRESS);
    let stress = |value: f64| TableCell::from(rounded(value * scale, DIGITS));
    let count = verdict.count();
    let runs = verdict.damage.repeats();
    [
        TableCell::from(verdict.detail.word()),
        TableCell::from(count),
        stress(verdict.damage.largest_range),
        stress(verdict.limit),
        TableCell::from(unit),
        TableCell::from(rounded(verdict.damage.sum, DIGITS)),
        stress(verdict.equivalent),
        runs.map_or(TableCell::from("never"), |runs| {
            TableCell::from(rounded(runs, DIGITS))
        }),
    ]
}
