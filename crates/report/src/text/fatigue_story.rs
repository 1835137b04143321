//! Report content on fatigue.

use crate::{ReportSection, ReportTable, TableCell, TableColumn};
use formats::scene::Scene;
use formats::spec::Detail;
use formats::text::number::rounded;
use formats::units::{Dimension, Force, Length, Scale, Units};
use results::fatigue::FatigueResult;

/// Digits of stresses and damages.
const DIGITS: usize = 4;

/// The section on fatigue, with all runs; `None` where there are no stress points.
#[must_use]
pub fn section(scene: &Scene, runs: &[(&str, &[FatigueResult])]) -> Option<ReportSection> {
    if runs.iter().all(|(_, verdicts)| verdicts.is_empty()) {
        return None;
    }
    let fatigue = &scene.output.fatigue;
    let mut section = ReportSection::new("Fatigue").paragraph(format!(
        "Direct stresses N/A + My z/Iy - Mz y/Iz of what moves, at points given with the sections, counted by rainflow (ASTM \
         E1049) and summed by Miner's rule over the run; gamma_Ff = {}, gamma_Mf = {}. Numbers are detail categories of EN \
         1993-1-9 (N/mm2), letters those of AISC 360 (ksi). A history whose ranges all lie within the limit does no damage.",
        fatigue.loads, fatigue.material
    ));
    let columns = ["point", "run", "detail", "cycles", "range", "limit", "unit"];
    let mut columns: Vec<TableColumn> = columns.map(|name| TableColumn::new(name, "")).into();
    columns.extend(["damage", "equivalent", "runs"].map(|name| TableColumn::new(name, "")));
    if fatigue.crossings.is_some() {
        columns.push(TableColumn::new("life", ""));
    }
    let mut rows = Vec::new();
    let names = runs.iter().map(|(_, verdicts)| verdicts.iter().map(|verdict| &verdict.column));
    let first: Vec<&String> = names.max_by_key(ExactSizeIterator::len).into_iter().flatten().collect();
    for name in first {
        let mut head = TableCell::from(name.clone());
        for (label, verdicts) in runs {
            let Some(verdict) = verdicts.iter().find(|verdict| verdict.column == *name) else { continue };
            let (unit, length, force) = match verdict.detail {
                Detail::Eurocode(_) => ("N/mm2", Length::Millimetre, Force::Newton),
                Detail::Aisc(_) => ("ksi", Length::Inch, Force::Kip),
            };
            let scale = Scale { from: scene.units, to: Units { length, force } }.factor(Dimension::STRESS);
            let stress = |value: f64| TableCell::from(rounded(value * scale, DIGITS));
            let count: f64 = verdict.cycles.iter().map(|cycle| cycle.count).sum();
            let mut row = vec![
                std::mem::take(&mut head),
                TableCell::from(*label),
                TableCell::from(verdict.detail.word()),
                TableCell::from(count),
                stress(verdict.damage.largest_range),
                stress(verdict.limit),
                TableCell::from(unit),
                TableCell::from(rounded(verdict.damage.sum, DIGITS)),
                stress(verdict.equivalent),
                verdict
                    .damage
                    .repeats()
                    .map_or(TableCell::from("never"), |runs| TableCell::from(rounded(runs, DIGITS))),
            ];
            if fatigue.crossings.is_some() {
                row.push(
                    verdict.life.map_or(TableCell::Empty, |life| TableCell::from(rounded(life, DIGITS))),
                );
            }
            rows.push(row);
        }
    }
    let caption = "Stress points: cycles, largest range and limit, damage of the run, range of one cycle that does it, runs to failure, damage of the crossings of a life. Every cycle is in cycles.csv.".to_owned();
    section = section.table(ReportTable { caption, columns, rows });
    Some(section)
}
