//! On what a design rests, in brief: structure, material, loads, codes.

use crate::ReportSection;
use crate::figures::design::{digits, reading_unit};
use crate::text::codes::code_with_edition;
use crate::text::structure_words::structure_facts;
use ::design::DesignResult;
use formats::design::{Design, DesignCase, DesignTrain, DesignWheel};
use formats::units::Dimension;

/// Largest number of trains and of cases that are listed.
const MOST: usize = 4;
/// Largest number of ends of spans that are listed one by one.
const MAX_ENDS: usize = 8;
/// Significant digits of inputs.
const DIGITS: usize = 4;

/// The inputs in brief; the section on inputs has all of them.
pub(super) fn basis(design: &Design, result: &DesignResult) -> ReportSection {
    let mut section = ReportSection::new("Basis");
    for (name, text) in
        structure_facts(&design.spec, &design.spec_file, design.units, &design.spans)
    {
        section = section.fact(name, text, "");
    }
    section = section.fact("dead load", dead_words(design), "");
    for train in design.trains.iter().take(MOST) {
        section = section.fact(
            format!("train {}", train.name),
            train_words(design, train),
            "",
        );
    }
    if design.trains.len() > MOST {
        section = section.fact("further trains", design.trains.len() - MOST, "");
    }
    for (index, case) in design.cases.iter().enumerate().take(MOST) {
        section = section.fact(format!("case {}", index + 1), case_words(design, case), "");
    }
    if design.cases.len() > MOST {
        section = section.fact("further cases", design.cases.len() - MOST, "");
    }
    for (plane, name) in ["vertical", "lateral"].into_iter().enumerate() {
        section = section.fact(
            format!("spans of {name} limits"),
            spans_words(design, result, plane),
            "",
        );
    }
    section
        .fact("codes", codes(design, result), "")
        .ending_page()
}

/// Coordinates of the ends of the spans of a plane, by rail, and the rule by which they are found.
fn spans_words(design: &Design, result: &DesignResult, plane: usize) -> String {
    let length = design.units.label(Dimension::LENGTH);
    let rails = design.spec.rails();
    let of_rail = |(rail, ends): (usize, &Vec<f64>)| {
        let places: Vec<String> = ends.iter().map(|x| digits(*x, DIGITS)).collect();
        let places = match places.len() {
            0 => "not defined".to_owned(),
            1..=MAX_ENDS => format!("{} {length}", places.join(", ")),
            count => format!(
                "{} to {} {length}, {} spans",
                places[0],
                places[count - 1],
                count - 1
            ),
        };
        if rails.len() == 1 {
            places
        } else {
            format!("{}: {places}", rails[rail].name)
        }
    };
    let all: Vec<String> = result.chords[plane]
        .iter()
        .enumerate()
        .map(of_rail)
        .collect();
    let rule = if design.are_spans_given.iter().all(|given| *given) {
        "given in the design"
    } else if matches!(design.spec.form, formats::spec::Form::Girder(_)) {
        "supports of the girder"
    } else {
        "points of the girder whose stiffness against the ground in this plane is at least a twentieth of that of the \
         girder between its neighbours"
    };
    format!("{} ({rule})", all.join("; "))
}

fn dead_words(design: &Design) -> String {
    let lines = design.dead.lines.iter().any(|line| *line != 0.0);
    match (design.dead.gravity > 0.0, lines) {
        (true, true) => "weight of the structure and line loads along rails",
        (true, false) => "weight of the structure",
        (false, true) => "line loads along rails",
        (false, false) => "none",
    }
    .to_owned()
}

/// Wheels, their forces and distances, and horizontal forces.
fn train_words(design: &Design, train: &DesignTrain) -> String {
    let (force, factor) = reading_unit(design.units, Dimension::FORCE);
    let length = design.units.label(Dimension::LENGTH);
    let vertical: Vec<f64> = train
        .wheels
        .iter()
        .map(DesignWheel::whole_vertical)
        .collect();
    let range = |values: &[f64], factor: f64| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let [low, high] = [low, high].map(|value| digits(factor * value, DIGITS));
        if low == high {
            high
        } else {
            format!("{low} to {high}")
        }
    };
    let places: Vec<f64> = train.wheels.iter().map(|wheel| wheel.x).collect();
    let mut text = match train.wheels.len() {
        1 => format!("1 wheel of {} {force}", range(&vertical, factor)),
        count => format!(
            "{count} wheels of {} {force} at x = {} {length}",
            range(&vertical, factor),
            range(&places, 1.0)
        ),
    };
    for (name, values) in [
        (
            "lateral",
            train
                .wheels
                .iter()
                .map(|wheel| wheel.lateral)
                .collect::<Vec<f64>>(),
        ),
        (
            "longitudinal",
            train
                .wheels
                .iter()
                .map(|wheel| wheel.longitudinal)
                .collect(),
        ),
    ] {
        if values.iter().any(|value| *value != 0.0) {
            text.push_str(&format!(", {name} {} {force} each", range(&values, factor)));
        }
    }
    if train.turned {
        text.push_str(", in both orientations");
    }
    text
}

/// Trains and factors of a case.
fn case_words(design: &Design, case: &DesignCase) -> String {
    let names: Vec<&str> = case
        .trains
        .iter()
        .map(|&train| design.trains[train].name.as_str())
        .collect();
    let mut text = format!("{}: {}", case.name, names.join(" + "));
    if names.len() > 1 {
        text.push_str(&format!(
            ", gap {} {}",
            digits(case.gap, DIGITS),
            design.units.label(Dimension::LENGTH)
        ));
    }
    let factors: Vec<String> = case
        .factors
        .iter()
        .map(|(name, factor)| format!("{name} {}", digits(*factor, DIGITS)))
        .collect();
    match factors.is_empty() {
        true => text.push_str(", no factors"),
        false => text.push_str(&format!(", factors {}", factors.join(", "))),
    }
    text
}

/// The code of the design, and the editions of the clauses that were checked.
fn codes(design: &Design, result: &DesignResult) -> String {
    let mut all: Vec<String> = design.practice.code.iter().cloned().collect();
    for check in &result.limits {
        let clause = &check.clause;
        let name = format!("{}, {}", code_with_edition(clause), clause.clause);
        if !all.contains(&name) {
            all.push(name);
        }
    }
    if all.is_empty() {
        "none named".to_owned()
    } else {
        all.join("; ")
    }
}
