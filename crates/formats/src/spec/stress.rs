//! Points of sections whose stresses are requested, with their detail categories.

use practice::aisc::AiscCategory;
use practice::fatigue::CATEGORIES;

use super::raw::{RawDetail, RawPoint, SectionTables};
use super::words::COMPONENTS;
use crate::check::Check;
use crate::text::fault::{Fault, alternatives, number};
use crate::text::names::check_free_name;
use crate::text::place::Place;
use crate::units::Dimension;

/// A point of a section whose normal stress is requested.
#[derive(Clone, Debug, PartialEq)]
pub struct StressPoint {
    /// Its name.
    pub name: String,
    /// Coordinate along the section's local y axis from its centroid, in length.
    pub y: f64,
    /// Coordinate along its local z axis from the centroid, in length.
    pub z: f64,
    /// Detail category, if fatigue is to be assessed.
    pub detail: Option<Detail>,
}

/// Fatigue category of a detail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Detail {
    /// Detail category of EN 1993-1-9 for direct stress, N/mm2.
    Eurocode(f64),
    /// Stress category of AISC 360.
    Aisc(AiscCategory),
}

impl Detail {
    /// The category in the notation of specs.
    #[must_use]
    pub fn word(&self) -> String {
        match self {
            Detail::Eurocode(category) => category.to_string(),
            Detail::Aisc(category) => {
                let known = AiscCategory::ALL.iter().find(|(_, own)| own == category);
                known.map_or_else(String::new, |(word, _)| (*word).to_owned())
            }
        }
    }
}

/// Stress points of every section of the general form.
pub(super) fn of_sections(
    tables: SectionTables<'_>,
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> Vec<Vec<StressPoint>> {
    let list = root.key("sections");
    let all = tables.sections.iter().flatten().enumerate();
    all.map(|(index, section)| read(&section.points, &list.index(index), check))
        .collect()
}

/// Stress points of the section at `at`.
pub(super) fn read(raw: &[RawPoint], at: &Place<'_>, check: &mut Check<'_>) -> Vec<StressPoint> {
    let list = at.key("points");
    let mut points: Vec<StressPoint> = Vec::new();
    for (index, raw) in raw.iter().enumerate() {
        let at = list.index(index);
        let name = check
            .faults
            .require(&raw.name, &at, "name")
            .cloned()
            .unwrap_or_default();
        check_free_name(&name, &at.key("name"), check.faults);
        let is_taken = points.iter().any(|other| other.name == name);
        if raw.name.is_some() && (name.is_empty() || is_taken || name.contains('.')) {
            let fault = Fault::new(
                &at.key("name"),
                "must differ from the other names and contain no dots",
            );
            check.faults.add(fault.got(format!("\"{name}\"")));
        } else if COMPONENTS.iter().any(|(word, _)| *word == name) {
            let fault = Fault::new(&at.key("name"), "must not be the name of an internal force");
            check.faults.add(fault.got(format!("\"{name}\"")));
        }
        if raw.y.is_none() && raw.z.is_none() {
            let fault = Fault::new(&at, "must have `y`, `z` or both");
            check.faults.add(
                fault.hint("coordinates from the centroid along the local axes of the section"),
            );
        }
        let mut place = |value: Option<f64>, key: &str| {
            check.number(value.unwrap_or_default(), &at.key(key), Dimension::LENGTH)
        };
        let (y, z) = (place(raw.y, "y"), place(raw.z, "z"));
        let detail = raw
            .detail
            .as_ref()
            .and_then(|raw| read_detail(raw, &at.key("detail"), check));
        points.push(StressPoint { name, y, z, detail });
    }
    points
}

fn read_detail(raw: &RawDetail, at: &Place<'_>, check: &mut Check<'_>) -> Option<Detail> {
    match raw {
        RawDetail::Number(value) if CATEGORIES.contains(value) => Some(Detail::Eurocode(*value)),
        RawDetail::Number(value) => {
            let known: Vec<String> = CATEGORIES.iter().map(f64::to_string).collect();
            let fault =
                Fault::new(at, "must be a detail category of EN 1993-1-9").got(number(*value));
            check
                .faults
                .add(fault.hint(format!("in N/mm2: {}", known.join(", "))));
            None
        }
        RawDetail::Word(word) => {
            let found = AiscCategory::ALL.iter().find(|(known, _)| known == word);
            if found.is_none() {
                let words = AiscCategory::ALL.map(|(word, _)| word);
                let fault = Fault::new(at, format!("must be {}", alternatives(&words)));
                let fault = fault.got(format!("\"{word}\""));
                check
                    .faults
                    .add(fault.hint("categories of EN 1993-1-9 are numbers, such as 112"));
            }
            found.map(|(_, category)| Detail::Aisc(*category))
        }
    }
}
