//! Tables of rolled sections.

use std::sync::LazyLock;

use crate::names::{nearest, plain};
use crate::properties::SectionDimensions;
use crate::table::{required, rows};

/// Millimetres in an inch.
const INCH: f64 = 25.4;

/// Series of rolled sections.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SectionSeries {
    /// Wide flange beams, light (HE A).
    Hea,
    /// Wide flange beams (HE B).
    Heb,
    /// Wide flange beams, heavy (HE M).
    Hem,
    /// I sections (IPE).
    Ipe,
    /// American wide flange shapes (W).
    W,
}

impl SectionSeries {
    /// Young's modulus of steel by the standard of the series, N/m2.
    #[must_use]
    pub const fn young(self) -> f64 {
        match self {
            SectionSeries::W => crate::AISC_YOUNG,
            _ => crate::STEEL_YOUNG,
        }
    }

    /// The standard or manual that the dimensions are from.
    #[must_use]
    pub const fn standard(self) -> &'static str {
        match self {
            SectionSeries::W => "AISC Manual, 16th ed. (ASTM A6)",
            SectionSeries::Ipe => "EN 10365 (Euronorm 19-57)",
            SectionSeries::Hea | SectionSeries::Heb | SectionSeries::Hem => {
                "EN 10365 (Euronorm 53-62)"
            }
        }
    }
}

/// A rolled section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RolledSection {
    /// Its name, such as `HEB 400` or `W24X94`.
    pub name: &'static str,
    /// Its series.
    pub series: SectionSeries,
    /// Its dimensions.
    pub dimensions: SectionDimensions,
}

static SECTIONS: LazyLock<Vec<RolledSection>> = LazyLock::new(|| {
    let european = rows(include_str!("../data/european.csv")).map(european);
    european
        .chain(rows(include_str!("../data/american.csv")).map(american))
        .collect()
});

/// A row of the European table: name, height, width, web, flange, root radius in mm.
fn european(row: Vec<&'static str>) -> RolledSection {
    let [height, width, web, flange, radius] = [1, 2, 3, 4, 5].map(|cell| required(&row, cell));
    let series = match row[0].get(..3) {
        Some("HEA") => SectionSeries::Hea,
        Some("HEB") => SectionSeries::Heb,
        Some("HEM") => SectionSeries::Hem,
        _ => SectionSeries::Ipe,
    };
    let dimensions = SectionDimensions {
        height,
        width,
        web,
        flange,
        radius,
    };
    RolledSection {
        name: row[0],
        series,
        dimensions,
    }
}

/// A row of the American table: name, depth, flange width, web, flange and distance k in inches; the root radius is k - flange.
fn american(row: Vec<&'static str>) -> RolledSection {
    let [height, width, web, flange, k] = [1, 2, 3, 4, 5].map(|cell| required(&row, cell) * INCH);
    let dimensions = SectionDimensions {
        height,
        width,
        web,
        flange,
        radius: k - flange,
    };
    RolledSection {
        name: row[0],
        series: SectionSeries::W,
        dimensions,
    }
}

/// All rolled sections, series by series.
#[must_use]
pub fn rolled_sections() -> &'static [RolledSection] {
    &SECTIONS
}

/// The section with this name; blanks and case do not count, and `HE 400 B` is `HEB 400`.
#[must_use]
pub fn rolled(name: &str) -> Option<&'static RolledSection> {
    let wanted = series_first(plain(name));
    SECTIONS
        .iter()
        .find(|section| plain(section.name) == wanted)
}

/// `HEB400` for `HE400B`, other names unchanged.
fn series_first(name: String) -> String {
    let split = name
        .strip_prefix("HE")
        .and_then(|rest| Some((rest, rest.strip_suffix(['A', 'B', 'M'])?)));
    match split {
        Some((rest, size))
            if !size.is_empty() && size.bytes().all(|digit| digit.is_ascii_digit()) =>
        {
            format!("HE{}{size}", &rest[size.len()..])
        }
        _ => name,
    }
}

/// The names that are nearest to one that is not in the table, nearest first; empty if all are far.
#[must_use]
pub fn nearest_rolled(name: &str) -> Vec<&'static str> {
    nearest(
        &series_first(plain(name)),
        SECTIONS.iter().map(|section| section.name),
    )
}
