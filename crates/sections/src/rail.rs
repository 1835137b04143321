//! Table of crane rails.

use std::sync::LazyLock;

use crate::composite::PlaneSection;
use crate::names::{nearest, plain};
use crate::table::{number, required, rows};

/// A crane rail. Numbers without a source are absent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RailProfile {
    /// Its name, such as `A75`, `CR 135` or `ASCE 85`.
    pub name: &'static str,
    /// Standard of its dimensions.
    pub standard: &'static str,
    /// Width of the head, mm.
    pub head: f64,
    /// Width of the base, mm.
    pub base: f64,
    /// Height, mm.
    pub height: f64,
    /// Thickness of the web, mm.
    pub web: Option<f64>,
    /// Mass per length, kg/m.
    pub mass: f64,
    /// Area, mm2.
    pub area: Option<f64>,
    /// Second moment of area for vertical bending, mm4.
    pub i_vertical: Option<f64>,
    /// Second moment of area for lateral bending, mm4.
    pub i_lateral: Option<f64>,
    /// Height of the centroid above the base, mm.
    pub centroid: Option<f64>,
}

impl RailProfile {
    /// The rail as a part of a plane section, and the height of its centroid above its base, mm.
    ///
    /// # Errors
    /// What the table lacks, in words.
    pub fn plane_section(&self) -> Result<(PlaneSection, f64), String> {
        let needed = [
            ("area", self.area),
            ("second moment for vertical bending", self.i_vertical),
            ("second moment for lateral bending", self.i_lateral),
            ("height of the centroid", self.centroid),
        ];
        match needed.map(|(_, value)| value) {
            [
                Some(area),
                Some(i_vertical),
                Some(i_lateral),
                Some(centroid),
            ] => Ok((
                PlaneSection {
                    area,
                    i_vertical,
                    i_lateral,
                },
                centroid,
            )),
            _ => {
                let missing = needed
                    .iter()
                    .filter(|(_, value)| value.is_none())
                    .map(|(what, _)| *what);
                Err(missing.collect::<Vec<_>>().join(", "))
            }
        }
    }
}

static RAILS: LazyLock<Vec<RailProfile>> =
    LazyLock::new(|| rows(include_str!("../data/rails.csv")).map(rail).collect());

/// A row of the table: name, standard, head, base, height, web in mm, mass in kg/m, area in cm2, second moments for vertical and lateral
/// bending in cm4, height of the centroid in mm.
fn rail(row: Vec<&'static str>) -> RailProfile {
    let [head, base, height, mass] = [2, 3, 4, 6].map(|cell| required(&row, cell));
    let optional = |cell: usize, unit: f64| number(&row, cell).map(|value| (value * unit).round());
    RailProfile {
        name: row[0],
        standard: row[1],
        head,
        base,
        height,
        web: number(&row, 5),
        mass,
        area: optional(7, 1e2),
        i_vertical: optional(8, 1e4),
        i_lateral: optional(9, 1e4),
        centroid: number(&row, 10),
    }
}

/// All crane rails, standard by standard.
#[must_use]
pub fn crane_rails() -> &'static [RailProfile] {
    &RAILS
}

/// The rail with this name; blanks and case do not count. `DIN A75` is `A75`; `ASCE 135`, `135 CR` and `Bethlehem 135` are `CR 135`.
#[must_use]
pub fn crane_rail(name: &str) -> Option<&'static RailProfile> {
    let wanted = plain(name);
    let known = |name: &str| RAILS.iter().find(|rail| plain(rail.name) == name);
    let din = ["DIN536-1", "DIN536", "DIN"]
        .iter()
        .find_map(|prefix| wanted.strip_prefix(prefix));
    let american = ["ASCE", "BETHLEHEM", "ASTM"]
        .iter()
        .find_map(|prefix| wanted.strip_prefix(prefix));
    let size = american.or_else(|| wanted.strip_suffix("CR"));
    let size =
        size.filter(|size| !size.is_empty() && size.bytes().all(|digit| digit.is_ascii_digit()));
    known(&wanted)
        .or_else(|| known(din?).filter(|rail| rail.standard.starts_with("DIN")))
        .or_else(|| known(&format!("CR{}", size?)))
}

/// The names that are nearest to one that is not in the table, nearest first; empty if all are far.
#[must_use]
pub fn nearest_crane_rails(name: &str) -> Vec<&'static str> {
    nearest(name, RAILS.iter().map(|rail| rail.name))
}
