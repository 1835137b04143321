//! Warnings about values of a spec that are probably wrong: numbers in other units than those of the file, rails with gaps.

use fea::{CrossSection, Girder, Model, Rail};
use sections::rolled;

use super::structure::{Form, Spec};
use crate::plausible::{
    BESIDE_ROLLED, DENSITIES, GAP, MODULI, RAIL_HEIGHT, SHAPES, SHEAR_AREA, SHEAR_TO_YOUNG,
    STIFFNESSES, STRENGTHS, is_within,
};
use crate::text::number::{number, rounded};
use crate::units::{Dimension, Length, Scale, Units};

impl Spec {
    /// Warnings about values that are probably wrong, each with what is known of the unit that was meant.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let scale = Scale {
            from: self.units,
            to: Units::SI,
        };
        let mut all = Vec::new();
        match &self.form {
            Form::Girder(girder) => {
                all.extend(modulus("the girder's `E`", girder.e, self.units, scale));
                all.extend(shear_modulus(
                    "the girder's `G`",
                    girder.e,
                    girder.g,
                    self.units,
                ));
                for (key, area) in [
                    ("kA_vertical", girder.ka_vertical),
                    ("kA_lateral", girder.ka_lateral),
                ] {
                    all.extend(shear_area(
                        "the girder's",
                        key,
                        area,
                        girder.area,
                        self.units,
                    ));
                }
                all.extend(self.girder_properties(girder, scale));
                all.extend(self.rail_height(girder));
            }
            Form::Frame(frame) => {
                // where ties carry the rail, the sections of the model also include those of the ties
                let named = frame
                    .sections
                    .iter()
                    .zip(&frame.model.sections)
                    .filter(|_| self.pads().is_empty());
                let mut seen: Vec<[u64; 2]> = Vec::new();
                for (name, section) in named {
                    all.extend(shape(name, section, self.units));
                    let own = format!("section \"{name}\":");
                    for (key, area) in [("Asy", section.shear_y), ("Asz", section.shear_z)] {
                        all.extend(shear_area(&own, key, area, Some(section.area), self.units));
                    }
                    let key = [section.e, density(section)].map(f64::to_bits);
                    if seen.contains(&key) {
                        continue;
                    }
                    seen.push(key);
                    all.extend(modulus(
                        &format!("`E` of section \"{name}\""),
                        section.e,
                        self.units,
                        scale,
                    ));
                    all.extend(shear_modulus(
                        &format!("`G` of section \"{name}\""),
                        section.e,
                        Some(section.g),
                        self.units,
                    ));
                    all.extend(heavy(name, section, self.units, scale));
                }
                for (name, rail) in &frame.rails {
                    all.extend(gaps(name, &frame.model, rail));
                }
            }
        }
        let mut strengths: Vec<f64> = self
            .outlines
            .iter()
            .filter_map(|one| one.yield_strength)
            .collect();
        strengths.dedup();
        all.extend(
            strengths
                .into_iter()
                .filter_map(|fy| strength(fy, self.units, scale)),
        );
        all.extend(self.preload_warnings());
        all
    }

    /// A rail that lies too high above the axis of its girder, in comparison with the spans.
    fn rail_height(&self, girder: &Girder) -> Option<String> {
        let most = RAIL_HEIGHT
            * girder
                .spans
                .iter()
                .fold(0.0, |most: f64, span| most.max(*span));
        let height = girder.rail_height;
        let unit = self.units.label(Dimension::LENGTH);
        let meant = height * Length::Millimetre.in_units_of(self.units.length);
        let hint = if meant < height && meant <= most {
            format!("; if it is meant in mm, write {}", short(meant))
        } else {
            String::new()
        };
        (height > most).then(|| {
            format!(
                "the girder's `rail_height` is {} {unit}, more than half of its longest span: check its unit{hint}",
                short(height)
            )
        })
    }

    /// Warnings about the section of a girder: beside the rolled section that it names, or beside its spans.
    fn girder_properties(&self, girder: &Girder, scale: Scale) -> Vec<String> {
        let named = self
            .outlines
            .first()
            .and_then(|outline| rolled(&outline.name));
        let mut all = Vec::new();
        if let Some(section) = named {
            let found = section.dimensions.properties();
            let mm = Length::Millimetre.in_units_of(self.units.length);
            let pairs = [
                ("A", girder.area, found.area * mm.powi(2), Dimension::AREA),
                (
                    "I_vertical",
                    Some(girder.i_vertical),
                    found.i_strong * mm.powi(4),
                    Dimension::SECOND_MOMENT,
                ),
                (
                    "I_lateral",
                    girder.i_lateral,
                    found.i_weak * mm.powi(4),
                    Dimension::SECOND_MOMENT,
                ),
                (
                    "J",
                    girder.j,
                    found.j * mm.powi(4),
                    Dimension::SECOND_MOMENT,
                ),
            ];
            for (key, given, rolled, dimension) in pairs {
                let ratio = given.map_or(1.0, |given| given / rolled);
                if !(1.0 / BESIDE_ROLLED..=BESIDE_ROLLED).contains(&ratio) {
                    all.push(format!(
                        "the girder's `{key}` is {} {unit}, but {} has {} {unit}",
                        short(given.unwrap_or_default()),
                        section.name,
                        short(rolled),
                        unit = self.units.label(dimension)
                    ));
                }
            }
        } else {
            let span = girder
                .spans
                .iter()
                .fold(0.0, |most: f64, span| most.max(*span));
            let ratio = girder.i_vertical.powf(0.25) / span;
            let area = girder
                .area
                .map_or(1.0, |area| girder.i_vertical / (area * area));
            let is_plausible = |i: f64| {
                let factor = i / girder.i_vertical;
                is_within(STIFFNESSES, ratio * factor.powf(0.25))
                    && is_within(SHAPES, area * factor)
            };
            if !is_within(STIFFNESSES, ratio) || !is_within(SHAPES, area) {
                all.push(self.second_moment(girder.i_vertical, span, is_plausible));
            }
        }
        let mass = girder.mass_per_length.filter(|mass| *mass > 0.0);
        if let (Some(mass), Some(area)) = (mass, girder.area) {
            let own = mass / area * scale.factor(Dimension::DENSITY);
            if !is_within(DENSITIES, own) {
                all.push(format!(
                    "the girder's `mass_per_length` is {} {} on {} {}, a density of {} kg/m3: it is mass (force time^2 / \
                     length) per length; steel has 7850 kg/m3",
                    short(mass),
                    self.units.label(Dimension::LINE_MASS),
                    short(area),
                    self.units.label(Dimension::AREA),
                    short(own)
                ));
            }
        }
        all
    }

    /// Warning about the second moment of area of a girder, with the unit in which it would be plausible.
    fn second_moment(&self, given: f64, span: f64, is_plausible: impl Fn(f64) -> bool) -> String {
        let unit = self.units.label(Dimension::SECOND_MOMENT);
        let metre = Length::Metre.in_units_of(self.units.length);
        let others = [
            ("cm^4", 0.01 * metre),
            ("mm^4", 0.001 * metre),
            ("in^4", 0.0254 * metre),
            ("m^4", metre),
        ];
        let meant = others
            .into_iter()
            .map(|(name, size)| (name, given * size.powi(4)));
        let meant = meant
            .filter(|(name, _)| **name != unit)
            .find(|(_, value)| is_plausible(*value));
        let meant = meant.map_or_else(
            || "check its unit and those of `A` and the spans".to_owned(),
            |(name, value)| {
                format!(
                    "if it is meant in {name}, write {}",
                    number(rounded(value, 6))
                )
            },
        );
        format!(
            "the girder's `I_vertical` is {} {unit}, which is not plausible for its area and its span of {} {}: \
             {meant}",
            short(given),
            short(span),
            self.units.label(Dimension::LENGTH)
        )
    }
}

/// Warning about the second moments and the area of a section of the general form.
fn shape(name: &str, section: &CrossSection, units: Units) -> Option<String> {
    let largest = section.iy.max(section.iz);
    let ratio = largest / (section.area * section.area);
    (largest > 0.0 && section.area > 0.0 && !is_within(SHAPES, ratio)).then(|| {
        format!(
            "section \"{name}\" has A = {} {} and a second moment of area of {} {}: these values are \
             inconsistent, check their units",
            short(section.area),
            units.label(Dimension::AREA),
            short(largest),
            units.label(Dimension::SECOND_MOMENT)
        )
    })
}

/// Warning about a yield strength outside [`STRENGTHS`].
fn strength(fy: f64, units: Units, scale: Scale) -> Option<String> {
    let pascals = fy * scale.factor(Dimension::STRESS);
    let unit = units.label(Dimension::STRESS);
    (!is_within(STRENGTHS, pascals)).then(|| {
        format!(
            "`fy` is {} {unit}, {} N/mm2: S235 has {} {unit}",
            number(fy),
            short(pascals * 1e-6),
            short(235e6 / scale.factor(Dimension::STRESS))
        )
    })
}

/// Mass of a section per volume; 0 without area.
fn density(section: &CrossSection) -> f64 {
    if section.area > 0.0 {
        section.mass / section.area
    } else {
        0.0
    }
}

/// Warning about a Young's modulus outside [`MODULI`].
fn modulus(what: &str, e: f64, units: Units, scale: Scale) -> Option<String> {
    let pascals = e * scale.factor(Dimension::STRESS);
    let unit = units.label(Dimension::STRESS);
    let steel = 2e11 / scale.factor(Dimension::STRESS);
    (!is_within(MODULI, pascals)).then(|| {
        format!(
            "{what} is {} {unit}, {} GPa: steel has about {} {unit}",
            number(e),
            short(pascals * 1e-9),
            short(steel)
        )
    })
}

/// Warning about a shear modulus that does not fit Young's modulus, where the latter is plausible.
fn shear_modulus(what: &str, e: f64, g: Option<f64>, units: Units) -> Option<String> {
    let scale = Scale {
        from: units,
        to: Units::SI,
    };
    let is_sound = is_within(MODULI, e * scale.factor(Dimension::STRESS));
    let g = g.filter(|g| is_sound && *g > 0.0 && !is_within(SHEAR_TO_YOUNG, g / e))?;
    let unit = units.label(Dimension::STRESS);
    Some(format!(
        "{what} is {} {unit} beside `E` {} {unit}: steel has G/E = 0.385",
        number(g),
        number(e)
    ))
}

/// Warning about an effective shear area above the area of its section.
fn shear_area(
    what: &str,
    key: &str,
    effective: Option<f64>,
    area: Option<f64>,
    units: Units,
) -> Option<String> {
    let (effective, area) = (effective?, area?);
    let unit = units.label(Dimension::AREA);
    (area > 0.0 && effective > SHEAR_AREA * area).then(|| {
        format!(
            "{what} `{key}` is {} {unit}, more than the area {} {unit}",
            short(effective),
            short(area)
        )
    })
}

/// Warning about a section whose density is outside [`DENSITIES`].
fn heavy(name: &str, section: &CrossSection, units: Units, scale: Scale) -> Option<String> {
    let own = density(section);
    let si = own * scale.factor(Dimension::DENSITY);
    let unit = units.label(Dimension::DENSITY);
    let steel = 7850.0 / scale.factor(Dimension::DENSITY);
    (own > 0.0 && !is_within(DENSITIES, si)).then(|| {
        format!(
            "`density` of section \"{name}\" is {} {unit}, {} kg/m3: it is mass per volume, steel has about {} {unit}",
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
    use crate::text::source::Source;

    fn found(text: &str) -> Vec<String> {
        let source = Source {
            name: "spec.json".to_owned(),
            text: text.to_owned(),
        };
        Spec::read(&source, None).expect("a sound spec").warnings()
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

    /// HEB 400 over two spans, by its published properties.
    const GIRDER: &str = r#"{"format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
        "girder": {"spans": [6, 7.5], "E": 2.1e8, "A": 0.01978, "I_vertical": 5.768e-4, "mass_per_length": 0.1555,
                   "fy": 2.35e5}, "stations": [0, 3, 6, 13.5]}"#;

    #[test]
    fn warns_of_a_number_in_another_unit_and_says_what_is_meant() {
        assert_eq!(found(GIRDER), Vec::<String>::new());
        let slips = [
            (
                "5.768e-4",
                "57680",
                "if it is meant in cm^4, write 0.0005768",
            ),
            (
                "5.768e-4",
                "5.768e8",
                "if it is meant in mm^4, write 0.0005768",
            ),
            (
                "0.01978",
                "197.8",
                "check its unit and those of `A` and the spans",
            ),
            ("0.1555", "155.5", "a density of 7860000 kg/m3"),
            (
                "\"fy\"",
                "\"rail_height\": 200, \"fy\"",
                "check its unit; if it is meant in mm, write 0.2",
            ),
            (
                "2.35e5",
                "235",
                "`fy` is 235 kN/m^2, 0.235 N/mm2: S235 has 235000 kN/m^2",
            ),
        ];
        for (old, new, told) in slips {
            let warnings = found(&GIRDER.replace(old, new));
            assert!(
                warnings
                    .iter()
                    .any(|warning| warning.ends_with(told) || warning.contains(told)),
                "{warnings:?}"
            );
        }
        let named = GIRDER
            .replace("0.01978", "197.8")
            .replace("\"fy\"", "\"section\": \"HEB 400\", \"fy\"");
        let expected = "the girder's `A` is 198 m^2, but HEB 400 has 0.0198 m^2";
        assert!(
            found(&named).iter().any(|warning| warning == expected),
            "{:?}",
            found(&named)
        );
    }

    #[test]
    fn warns_of_ksi_in_a_file_of_feet() {
        let warnings = found(&FRAME.replace("4176000", "29000"));
        let expected = "`E` of section \"girder\" is 29000 kip/ft^2, 1.39 GPa: steel has about 4180000 kip/ft^2";
        assert_eq!(warnings, [expected]);
    }

    #[test]
    fn warns_of_a_weight_in_the_place_of_a_density() {
        let warnings = found(&FRAME.replace("0.01523", "0.49"));
        assert_eq!(warnings.len(), 1);
        assert!(
            warnings[0].contains("0.49 kip s^2/ft^4") && warnings[0].contains("0.0152"),
            "{warnings:?}"
        );
    }

    #[test]
    fn warns_of_a_bay_without_a_segment() {
        let warnings = found(&FRAME.replace("{\"cell\": [0, 1]}, ", ""));
        assert_eq!(
            warnings,
            [
                "no segment of rail top covers it from 40 to 80: there it moves rigidly with the nearer end"
            ]
        );
    }
}
