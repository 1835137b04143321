//! `girderway sections`: rolled sections and crane rails by name.

use serde_json::{Value, json};

use crate::cli::{Global, SectionsArgs};
use crate::exit::{Exit, Failure};
use crate::output;
use formats::text::diagnostic::Diagnostic;
use formats::text::fault::alternatives;
use outputs::files::json as json_text;
use sections::{
    RailProfile, RolledSection, STEEL_DENSITY, SectionSeries, crane_rails, rolled_sections,
};

/// Millimetres in an inch.
const INCH: f64 = 25.4;
/// Pounds per foot in a kilogram per metre.
const POUND_PER_FOOT: f64 = 0.3048 / 0.453_592_37;

/// Prints the sections and rails whose names contain the pattern.
///
/// # Errors
/// No name contains it, or standard output cannot be written.
pub fn run(args: &SectionsArgs, global: Global) -> Result<Exit, Failure> {
    let pattern = args.pattern.join(" ");
    let found: Vec<&RolledSection> = rolled_sections()
        .iter()
        .filter(|section| sections::matches(section.name, &pattern))
        .collect();
    let rails: Vec<&RailProfile> = crane_rails()
        .iter()
        .filter(|rail| sections::matches(rail.name, &pattern))
        .collect();
    // a rail has names that the table does not show, such as ASCE 135 of CR 135
    let by_name = || sections::crane_rail(&pattern).into_iter().collect();
    let rails = if rails.is_empty() { by_name() } else { rails };
    let found = if found.is_empty() {
        sections::rolled(&pattern).into_iter().collect()
    } else {
        found
    };
    if found.is_empty() && rails.is_empty() {
        return Err(unknown(&pattern).into());
    }
    let text = if global.json {
        let sections: Vec<Value> = found.iter().map(|section| section_json(section)).collect();
        let rails: Vec<Value> = rails.iter().map(|rail| rail_json(rail)).collect();
        json_text(&json!({ "sections": sections, "crane_rails": rails }))
    } else {
        [metric(&found), american(&found), rail_table(&rails)]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
            .join("\n")
    };
    output::print(&text)?;
    Ok(Exit::Done)
}

/// The error of a pattern that no name contains.
fn unknown(pattern: &str) -> Diagnostic {
    let near = [
        sections::nearest_rolled(pattern),
        sections::nearest_crane_rails(pattern),
    ]
    .concat();
    let hint = if near.is_empty() {
        "omit the pattern to list all names".to_owned()
    } else {
        format!("did you mean {}?", alternatives(&near))
    };
    let fault = Diagnostic::of_file("sections", "no rolled section or crane rail matches");
    Diagnostic {
        found: Some(format!("\"{pattern}\"")),
        ..fault.hint(hint)
    }
}

/// Titles of the tables, with their units.
const METRIC: &str =
    "Rolled sections: dimensions in mm; areas in cm2; second moments and J in cm4; mass in kg/m";
const AMERICAN: &str =
    "W shapes: dimensions in in; areas in in2; second moments and J in in4; weight in lb/ft";
const RAILS: &str = "Crane rails: dimensions in mm; area in cm2; second moments (vertical, lateral) in cm4; mass in kg/m; -: no value available";

/// A title and rows of cells as text, the first column to the left and the others to the right.
fn table(title: &str, head: &[&str], rows: &[Vec<String>]) -> String {
    let head: Vec<String> = head.iter().map(|title| (*title).to_owned()).collect();
    let lines: Vec<&Vec<String>> = std::iter::once(&head).chain(rows).collect();
    let width = |column: usize| {
        lines
            .iter()
            .map(|line| line[column].len())
            .max()
            .unwrap_or_default()
    };
    let widths: Vec<usize> = (0..head.len()).map(width).collect();
    let line = |cells: &Vec<String>| {
        let mut text = format!("{:<1$}", cells[0], widths[0]);
        for (cell, width) in cells.iter().zip(&widths).skip(1) {
            text.push_str(&format!("  {cell:>width$}"));
        }
        text.trim_end().to_owned() + "\n"
    };
    let text: String = lines.into_iter().map(line).collect();
    format!("{title}\n{text}")
}

/// A number with up to four significant digits behind a point, and with all its digits before it.
fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let before = value.abs().log10().floor() as i32 + 1;
    let behind = usize::try_from(4 - before).unwrap_or_default();
    let text = format!("{value:.behind$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// The sections in mm, cm and kg/m; nothing if there are none.
fn metric(found: &[&RolledSection]) -> Option<String> {
    let head = [
        "name",
        "h",
        "b",
        "tw",
        "tf",
        "r",
        "A",
        "Iy",
        "Iz",
        "J",
        "As web",
        "As flange",
        "mass",
    ];
    let rows = found
        .iter()
        .map(|section| row(section, 1.0, 10.0, 1.0))
        .collect::<Vec<_>>();
    (!rows.is_empty()).then(|| table(METRIC, &head, &rows))
}

/// The W shapes in in and lb/ft; nothing if there are none.
fn american(found: &[&RolledSection]) -> Option<String> {
    let head = [
        "name",
        "d",
        "bf",
        "tw",
        "tf",
        "r",
        "A",
        "Ix",
        "Iy",
        "J",
        "As web",
        "As flange",
        "weight",
    ];
    let shapes = found
        .iter()
        .filter(|section| section.series == SectionSeries::W);
    let rows = shapes
        .map(|section| row(section, INCH, INCH, POUND_PER_FOOT))
        .collect::<Vec<_>>();
    (!rows.is_empty()).then(|| table(AMERICAN, &head, &rows))
}

/// A row of a section: dimensions in `length` mm, properties in powers of `unit` mm, mass in kg/m times `weight`.
fn row(section: &RolledSection, length: f64, unit: f64, weight: f64) -> Vec<String> {
    let size = section.dimensions;
    let found = section.dimensions.properties();
    let dimensions =
        [size.height, size.width, size.web, size.flange, size.radius].map(|side| side / length);
    let [two, four] = [unit.powi(2), unit.powi(4)];
    let properties = [
        found.area / two,
        found.i_strong / four,
        found.i_weak / four,
        found.j / four,
        found.shear_web / two,
        found.shear_flanges / two,
        mass(section) * weight,
    ];
    let numbers = dimensions.into_iter().chain(properties).map(short);
    std::iter::once(section.name.to_owned())
        .chain(numbers)
        .collect()
}

/// Mass per length of a section of steel, kg/m.
fn mass(section: &RolledSection) -> f64 {
    section.dimensions.properties().area * 1e-6 * STEEL_DENSITY
}

/// The rails in mm, cm and kg/m; nothing if there are none.
fn rail_table(rails: &[&RailProfile]) -> Option<String> {
    let head = [
        "name", "head", "base", "height", "web", "A", "Iv", "Il", "centroid", "mass", "standard",
    ];
    let cell = |value: Option<f64>, unit: f64| {
        value.map_or_else(|| "-".to_owned(), |value| short(value / unit))
    };
    let row = |rail: &&RailProfile| {
        vec![
            rail.name.to_owned(),
            short(rail.head),
            short(rail.base),
            short(rail.height),
            cell(rail.web, 1.0),
            cell(rail.area, 1e2),
            cell(rail.i_vertical, 1e4),
            cell(rail.i_lateral, 1e4),
            cell(rail.centroid, 1.0),
            short(rail.mass),
            rail.standard.to_owned(),
        ]
    };
    let rows: Vec<Vec<String>> = rails.iter().map(row).collect();
    (!rows.is_empty()).then(|| table(RAILS, &head, &rows))
}

fn section_json(section: &RolledSection) -> Value {
    let size = section.dimensions;
    let found = section.dimensions.properties();
    json!({
        "name": section.name,
        "standard": section.series.standard(),
        "height_mm": size.height,
        "width_mm": size.width,
        "web_mm": size.web,
        "flange_mm": size.flange,
        "radius_mm": size.radius,
        "A_mm2": found.area,
        "I_strong_mm4": found.i_strong,
        "I_weak_mm4": found.i_weak,
        "J_mm4": found.j,
        "shear_area_web_mm2": found.shear_web,
        "shear_area_flanges_mm2": found.shear_flanges,
        "mass_kg_per_m": mass(section),
    })
}

fn rail_json(rail: &RailProfile) -> Value {
    json!({
        "name": rail.name,
        "standard": rail.standard,
        "head_mm": rail.head,
        "base_mm": rail.base,
        "height_mm": rail.height,
        "web_mm": rail.web,
        "mass_kg_per_m": rail.mass,
        "A_mm2": rail.area,
        "I_vertical_mm4": rail.i_vertical,
        "I_lateral_mm4": rail.i_lateral,
        "centroid_mm": rail.centroid,
    })
}
