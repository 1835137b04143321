//! Warnings about values of a spec that are probably wrong: implausible moduli and densities, rails with gaps.

use fea::{CrossSection, Model, Rail};

use formats::spec::{Form, Spec};
use formats::text::number::number;
use formats::text::number::rounded;
use formats::units::{Dimension, Scale, Units};

/// Plausible range of Young's moduli, N/m2. It includes rigid arms a hundred times as stiff as steel.
const MODULI: [f64; 2] = [2e9, 2e13];

/// Plausible range of densities of structures with their equipment, kg/m3.
const DENSITIES: [f64; 2] = [50.0, 4e4];

/// Largest gap between two segments of a rail that causes no warning, as a fraction of the shorter segment. Gaps over
/// column seats are shorter.
const GAP: f64 = 0.5;

/// Warnings about values of a spec that are probably wrong.
#[must_use]
pub fn spec_warnings(spec: &Spec) -> Vec<String> {
    let scale = Scale { from: spec.units, to: Units::SI };
    let mut all = Vec::new();
    match &spec.form {
        Form::Girder(girder) => all.extend(modulus("the girder's `E`", girder.e, spec.units, scale)),
        Form::Frame(frame) => {
            // where ties carry the rail, the sections of the model also include those of the ties
            let named = frame.sections.iter().zip(&frame.model.sections).filter(|_| spec.pads().is_empty());
            let mut seen: Vec<[u64; 2]> = Vec::new();
            for (name, section) in named {
                let key = [section.e, density(section)].map(f64::to_bits);
                if seen.contains(&key) {
                    continue;
                }
                seen.push(key);
                all.extend(modulus(&format!("`E` of section \"{name}\""), section.e, spec.units, scale));
                all.extend(heavy(name, section, spec.units, scale));
            }
            for (name, rail) in &frame.rails {
                all.extend(gaps(name, &frame.model, rail));
            }
        }
    }
    all
}

/// Mass of a section per volume; 0 without area.
fn density(section: &CrossSection) -> f64 {
    if section.area > 0.0 { section.mass / section.area } else { 0.0 }
}

/// Warning about a Young's modulus outside [`MODULI`].
fn modulus(what: &str, e: f64, units: Units, scale: Scale) -> Option<String> {
    let pascals = e * scale.factor(Dimension::STRESS);
    let unit = units.label(Dimension::STRESS);
    let steel = 2e11 / scale.factor(Dimension::STRESS);
    (!(MODULI[0]..=MODULI[1]).contains(&pascals)).then(|| {
        format!(
            "{what} is {} {unit}, {} GPa: steel has about {} {unit}",
            number(e),
            short(pascals * 1e-9),
            short(steel)
        )
    })
}

/// Warning about a section whose density is outside [`DENSITIES`].
fn heavy(name: &str, section: &CrossSection, units: Units, scale: Scale) -> Option<String> {
    let own = density(section);
    let si = own * scale.factor(Dimension::DENSITY);
    let unit = units.label(Dimension::DENSITY);
    let steel = 7850.0 / scale.factor(Dimension::DENSITY);
    (own > 0.0 && !(DENSITIES[0]..=DENSITIES[1]).contains(&si)).then(|| {
        format!(
            "`density` of section \"{name}\" is {} {unit}, {} kg/m3: it is mass by volume, steel has about {} {unit}",
            short(own),
            short(si),
            short(steel)
        )
    })
}

/// Warnings about intervals of a rail that no segment covers and that are too long to be column seats.
fn gaps(name: &str, model: &Model, rail: &Rail) -> Vec<String> {
    let size = rail.axis.iter().map(|part| part * part).sum::<f64>().sqrt();
    let along = |point: usize, offset: [f64; 3]| {
        let part = |k: usize| (model.points[point][k] + offset[k] - rail.origin[k]) * rail.axis[k];
        (part(0) + part(1) + part(2)) / size
    };
    let mut covered: Vec<[f64; 2]> = rail
        .segments
        .iter()
        .map(|segment| {
            let member = &model.members[segment.member];
            let ends = [0, 1].map(|end| along(member.points[end], member.offsets[end]));
            [ends[0].min(ends[1]), ends[0].max(ends[1])]
        })
        .collect();
    covered.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut all = Vec::new();
    for pair in covered.windows(2) {
        let [before, after] = [pair[0], pair[1]];
        let shorter = (before[1] - before[0]).min(after[1] - after[0]);
        if after[0] - before[1] > GAP * shorter {
            all.push(format!(
                "no segment of rail {name} covers it from {} to {}: there it moves rigidly with the nearer end",
                number(before[1]),
                number(after[0])
            ));
        }
    }
    all
}

/// A number with three significant digits.
fn short(value: f64) -> String {
    number(rounded(value, 3))
}

#[cfg(test)]
mod tests {
    use super::*;
    use formats::text::source::Source;

    fn found(text: &str) -> Vec<String> {
        let source = Source { name: "spec.json".to_owned(), text: text.to_owned() };
        spec_warnings(&Spec::read(&source, None).expect("a sound spec"))
    }

    const FRAME: &str = r#"{"format": "girderway-beam/1", "units": {"length": "ft", "force": "kip", "time": "s"},
        "points": [[0, 0, 0], [40, 0, 0], [80, 0, 0], [120, 0, 0]],
        "cells": [{"type": "line", "data": [[0, 1], [1, 2], [2, 3]]}],
        "materials": [{"name": "steel", "E": 4176000, "G": 1612800, "density": 0.01523}],
        "sections": [{"name": "girder", "material": "steel", "A": 0.5, "Iy": 0.1, "Iz": 1.5, "J": 0.1}],
        "supports": [{"point": 0, "fix": ["ux", "uy", "uz", "rx"]}, {"point": 3, "fix": ["uy", "uz"]}],
        "rails": {"top": {"axis": [1, 0, 0], "segments": [{"cell": [0, 0]}, {"cell": [0, 1]}, {"cell": [0, 2]}],
            "stations": [0, 40, 80, 120]}}}"#;

    #[test]
    fn a_sound_spec_is_passed_over() {
        assert_eq!(found(FRAME), Vec::<String>::new());
    }

    #[test]
    fn warns_of_ksi_in_a_file_of_feet() {
        let warnings = found(&FRAME.replace("4176000", "29000"));
        let expected =
            "`E` of section \"girder\" is 29000 kip/ft^2, 1.39 GPa: steel has about 4180000 kip/ft^2";
        assert_eq!(warnings, [expected]);
    }

    #[test]
    fn warns_of_a_weight_in_the_place_of_a_density() {
        let warnings = found(&FRAME.replace("0.01523", "0.49"));
        assert_eq!(warnings.len(), 1);
        assert!(warnings[0].contains("0.49 kip s^2/ft^4") && warnings[0].contains("0.0152"), "{warnings:?}");
    }

    #[test]
    fn warns_of_a_bay_without_a_segment() {
        let warnings = found(&FRAME.replace("{\"cell\": [0, 1]}, ", ""));
        assert_eq!(
            warnings,
            ["no segment of rail top covers it from 40 to 80: there it moves rigidly with the nearer end"]
        );
    }
}
