//! A structure in words: form, theory, spans, material and sections.

use crate::figures::design::{digits, reading_unit};
use fea::BeamTheory;
use formats::spec::{Form, Spec};
use formats::units::{Dimension, Units};

/// Significant digits of properties.
const DIGITS: usize = 4;
/// Largest number of rails and of materials that are listed.
const MOST: usize = 4;

/// Names and values of the facts of a structure; `spans` has the ends of the spans of each rail.
pub(super) fn structure_facts(
    spec: &Spec,
    file: &str,
    units: Units,
    spans: &[Vec<f64>],
) -> Vec<(&'static str, String)> {
    let theory = match spec.theory {
        BeamTheory::EulerBernoulli => "Euler-Bernoulli beam theory, without shear deformation",
        BeamTheory::Timoshenko => "Timoshenko beam theory, with shear deformation",
    };
    let form = match &spec.form {
        Form::Girder(_) => "straight girder".to_owned(),
        Form::Frame(frame) => {
            let model = &frame.model;
            format!(
                "frame of {} members and {} supports",
                model.members.len(),
                model.supports.len()
            )
        }
    };
    let source = if file.is_empty() {
        String::new()
    } else {
        format!("{file}: ")
    };
    let mut out = vec![("structure", format!("{source}{form}, {theory}"))];
    let length = units.label(Dimension::LENGTH);
    let rails = spec.rails();
    let named = rails
        .iter()
        .zip(spans)
        .filter(|(_, ends)| ends.len() > 1)
        .take(MOST)
        .map(|(rail, ends)| format!("{}: {}", rail.name, span_words(ends)));
    let named: Vec<String> = named.collect();
    let material = materials(spec, units);
    out.push(if named.is_empty() {
        ("material", material)
    } else {
        (
            "spans, material",
            format!("{} {length}; {material}", named.join("; ")),
        )
    });
    if let Form::Girder(girder) = &spec.form {
        let (area, by_area) = reading_unit(units, Dimension::AREA);
        let (inertia, by_inertia) = reading_unit(units, Dimension::of(4, 0, 0));
        let mut text = format!(
            "I_vertical {} {inertia}",
            digits(by_inertia * girder.i_vertical, DIGITS)
        );
        let others = [("I_lateral", girder.i_lateral), ("J", girder.j)];
        for (name, value) in others
            .into_iter()
            .filter_map(|(name, value)| Some((name, value?)))
        {
            text.push_str(&format!(
                ", {name} {} {inertia}",
                digits(by_inertia * value, DIGITS)
            ));
        }
        if let Some(value) = girder.area {
            text.push_str(&format!(", A {} {area}", digits(by_area * value, DIGITS)));
        }
        out.push(("section", text));
    }
    out
}

/// Moduli of the materials of the structure.
fn materials(spec: &Spec, units: Units) -> String {
    let mut all: Vec<f64> = match &spec.form {
        Form::Girder(girder) => vec![girder.e],
        Form::Frame(frame) => frame
            .model
            .sections
            .iter()
            .map(|section| section.e)
            .collect(),
    };
    all.sort_by(f64::total_cmp);
    all.dedup();
    let (unit, factor) = reading_unit(units, Dimension::STRESS);
    let texts: Vec<String> = all
        .iter()
        .take(MOST)
        .map(|e| digits(factor * e, DIGITS))
        .collect();
    let more = if all.len() > MOST { " and others" } else { "" };
    format!("E = {}{more} {unit}, linear elastic", texts.join("; "))
}

/// Lengths of spans in their order, equal neighbours counted: `6 + 2 x 7.5 + 6`.
fn span_words(ends: &[f64]) -> String {
    let mut runs: Vec<(usize, String)> = Vec::new();
    for pair in ends.windows(2) {
        let length = digits(pair[1] - pair[0], DIGITS);
        match runs.last_mut() {
            Some((count, known)) if *known == length => *count += 1,
            _ => runs.push((1, length)),
        }
    }
    let words = runs.into_iter().map(|(count, length)| match count {
        1 => length,
        count => format!("{count} \u{d7} {length}"),
    });
    words.collect::<Vec<_>>().join(" + ")
}

#[cfg(test)]
mod tests {
    use super::span_words;

    #[test]
    fn equal_spans_are_counted() {
        assert_eq!(
            span_words(&[0.0, 6.0, 13.5, 21.0, 27.0]),
            "6 + 2 \u{d7} 7.5 + 6"
        );
        assert_eq!(span_words(&[0.0, 24.0, 48.0, 72.0]), "3 \u{d7} 24");
    }
}
