//! Findings as text: a table with one column for each reading.

use std::fmt::Write;

use splines::quality::{BlockExtreme, WheelLayout};

use super::digits::{sharp, short};
use super::findings::{ExactValues, TableQuality, TableVerdict};
use super::readings::{DirectFindings, ReadingFindings, WHEELS};
use super::subject::TableSource;
use formats::units::{Dimension, Units};

/// Width of the names of rows and of each column, characters.
const NAME: usize = 43;
const COLUMN: usize = 13;

/// Labels of units; empty where the file states none.
#[derive(Clone, Copy)]
struct Words(Option<Units>);

impl Words {
    fn of(self, dimension: Dimension) -> String {
        self.0
            .map(|units| units.label(dimension))
            .unwrap_or_default()
    }

    /// ` (unit)`, or nothing.
    fn bracket(self, dimension: Dimension) -> String {
        let unit = self.of(dimension);
        if unit.is_empty() {
            unit
        } else {
            format!(" ({unit})")
        }
    }
}

/// The findings of all tables.
#[must_use]
pub fn text(subject: &TableSource, all: &[TableQuality]) -> String {
    let units = Words(subject.units);
    let mut out = String::new();
    for note in &subject.notes {
        // writing to a string cannot fail
        let _ = writeln!(out, "note: {note}");
    }
    for (index, findings) in all.iter().enumerate() {
        if index > 0 || !subject.notes.is_empty() {
            out.push('\n');
        }
        one(&mut out, findings, units);
    }
    out
}

/// The findings of one table.
fn one(out: &mut String, found: &TableQuality, units: Words) {
    let table = &found.item.table;
    let (x, length) = (table.x(), units.of(Dimension::LENGTH));
    let name = if found.item.name.is_empty() {
        String::new()
    } else {
        format!(" {}", found.item.name)
    };
    let _ = writeln!(
        out,
        "SPLINE/{}{name}: {} x {} values, x from {} to {} {length}",
        found.item.id,
        table.z().len(),
        x.len(),
        short(x[0]),
        short(x[x.len() - 1])
    );
    if found.item.paths.is_none() {
        let _ = writeln!(
            out,
            "  a coupling, according to its name: it need not be symmetric and is not evaluated alone"
        );
    }
    if found.is_empty() {
        let _ = writeln!(
            out,
            "  no coupling: all values are rounding errors relative to the direct tables"
        );
        return;
    }
    stations(out, found, units);
    if !found.readings.is_empty() {
        let _ = writeln!(out, "  {}", exact_values(found, units));
        readings(out, found, units);
    }
    beyond(out, found, units);
    for risk in &found.risks {
        let _ = writeln!(out, "  note: {risk}");
    }
    for verdict in &found.verdicts {
        let _ = writeln!(out, "  FAILED: {}", sentence(verdict, units));
    }
}

/// Findings at the stations: digits, asymmetry, spectrum.
fn stations(out: &mut String, found: &TableQuality, units: Words) {
    let flexibility = units.of(Dimension::FLEXIBILITY);
    let _ = writeln!(out, "  at the stations: {} digits", found.digits.digits);
    if let Some(worst) = found.asymmetry {
        let word = if worst.value == 0.0 {
            "symmetric".to_owned()
        } else {
            format!(
                "largest |T - T'| {} {flexibility} at x = {}, z = {}",
                short(worst.value),
                short(worst.x),
                short(worst.z)
            )
        };
        let _ = writeln!(out, "    {word}");
    }
    if let Some(spectrum) = found.spectrum {
        let _ = writeln!(
            out,
            "    eigenvalues from {} to {} {flexibility}; uncertainty of the digits {}",
            if spectrum.smallest.abs() < 1e-13 * spectrum.largest {
                "0".to_owned()
            } else {
                short(spectrum.smallest)
            },
            short(spectrum.largest),
            short(found.digits.slack)
        );
    }
}

/// The exact values that errors are measured against, in words.
fn exact_values(found: &TableQuality, units: Words) -> String {
    match &found.exact_values {
        ExactValues::Surface => {
            "readings, with errors relative to the exact surface of the grid file".to_owned()
        }
        ExactValues::Beam(beam) => {
            let stiffness = units.of(Dimension::of(2, 1, 0));
            format!(
                "readings, with errors relative to the beam of the table: EI = {} {stiffness}, {} % from its values",
                short(1.0 / beam.bending),
                short(100.0 * beam.error)
            )
        }
        ExactValues::None => {
            "readings; the table is not that of a beam in bending, so errors are unknown: check the grid file"
                .to_owned()
        }
    }
}

/// Rows of a table with one cell for each reading.
struct Rows<'t> {
    out: &'t mut String,
    all: &'t [ReadingFindings],
}

impl Rows<'_> {
    /// Adds a row, unless all its cells are empty.
    fn add(&mut self, name: &str, cell: &dyn Fn(&ReadingFindings) -> Option<String>) {
        let cells: Vec<Option<String>> = self.all.iter().map(cell).collect();
        if cells.iter().any(Option::is_some) {
            let mut line = format!("    {name:NAME$}");
            for cell in cells {
                let _ = write!(line, " {:>COLUMN$}", cell.unwrap_or_else(|| "-".to_owned()));
            }
            let _ = writeln!(self.out, "{}", line.trim_end());
        }
    }
}

/// The table of all readings.
fn readings(out: &mut String, found: &TableQuality, units: Words) {
    let mut rows = Rows {
        out,
        all: &found.readings,
    };
    errors(&mut rows, found, units);
    loop_work(&mut rows, found, units);
    definiteness(&mut rows, units);
    slope_jumps(&mut rows, found, units);
}

/// Errors and asymmetry.
fn errors(rows: &mut Rows<'_>, found: &TableQuality, units: Words) {
    let length = units.bracket(Dimension::LENGTH);
    rows.add("", &|r| Some(r.method.word().to_owned()));
    rows.add("largest error (%)", &|r| {
        r.error.map(|e| short(100.0 * found.relative(&e)))
    });
    rows.add(&format!("  at x, z{length}"), &|r| {
        r.error.map(|e| place(&e.largest))
    });
    rows.add("largest error under the load itself (%)", &|r| {
        r.error.and_then(|e| {
            Some(short(
                100.0 * e.diagonal?.value.abs() / e.scale.max(f64::MIN_POSITIVE),
            ))
        })
    });
    rows.add(&format!("  at x{length}"), &|r| {
        r.error.and_then(|e| Some(short(e.diagonal?.x)))
    });
    rows.add("largest error between the supports (%)", &|r| {
        r.span.map(|e| short(100.0 * e.relative()))
    });
    rows.add(&format!("  at x, z{length}"), &|r| {
        r.span.map(|e| place(&e.largest))
    });
    rows.add("largest |G(x, z) - G(z, x)| (%)", &|r| {
        r.direct
            .as_ref()
            .map(|d| percent(d.asymmetry.value, d.scale))
    });
    rows.add(&format!("  at x, z{length}"), &|r| {
        r.direct
            .as_ref()
            .filter(|d| d.asymmetry.value > 0.0)
            .map(|d| place(&d.asymmetry))
    });
}

/// Work of a closed loop of wheel forces.
fn loop_work(rows: &mut Rows<'_>, found: &TableQuality, units: Words) {
    let length = units.bracket(Dimension::LENGTH);
    let (factor, work) = match found.load {
        Some(load) => (
            load * load,
            format!(
                "work of a loop of forces{}",
                units.bracket(Dimension::MOMENT)
            ),
        ),
        None => (
            1.0,
            format!(
                "work of a loop / P^2{}",
                units.bracket(Dimension::FLEXIBILITY)
            ),
        ),
    };
    rows.add(&work, &|r| {
        r.direct.as_ref().map(|d| short(factor * d.asymmetry.value))
    });
    rows.add(&format!("{work}, pair"), &|r| {
        pair(r).map(|p| short(factor * p.work.work))
    });
    rows.add("  relative to its stored energy (%)", &|r| {
        pair(r).map(|p| percent(p.work.work, p.work.stored))
    });
    rows.add(&format!("  first wheel at{length}"), &|r| {
        pair(r)
            .filter(|p| p.work.work > 0.0)
            .map(|p| short(p.work.at[0]))
    });
}

/// Eigenvalues and indefinite layouts of wheels.
fn definiteness(rows: &mut Rows<'_>, units: Words) {
    rows.add("smallest eigenvalue / largest", &|r| {
        r.direct
            .as_ref()
            .map(|d| rounded(d.spectrum.smallest / d.spectrum.largest.max(f64::MIN_POSITIVE)))
    });
    for (k, wheels) in WHEELS.into_iter().enumerate() {
        rows.add(
            &format!("indefinite layouts of {wheels} wheels (%)"),
            &|r| {
                r.direct
                    .as_ref()
                    .map(|d| short(100.0 * d.indefinite_fractions[k]))
            },
        );
    }
    for (k, wheels) in WHEELS.into_iter().enumerate() {
        let unit = units.bracket(Dimension::STIFFNESS);
        rows.add(
            &format!("{wheels} wheels indefinite from k ={unit}"),
            &|r| {
                r.direct
                    .as_ref()
                    .and_then(|d| d.layouts.get(k))
                    .map(stiffness)
            },
        );
    }
}

/// Jumps of slope under one wheel and under a pair.
fn slope_jumps(rows: &mut Rows<'_>, found: &TableQuality, units: Words) {
    let length = units.bracket(Dimension::LENGTH);
    let slope = match found.load {
        Some(_) => "jump of slope under a wheel (rad)".to_owned(),
        None => format!(
            "jump of slope under a wheel{}",
            units.bracket(Dimension::of(0, -1, 0))
        ),
    };
    let load = found.load.unwrap_or(1.0);
    let jump = |value: f64, d: &DirectFindings| {
        if noise(value, d) {
            "0".to_owned()
        } else {
            short(load * value)
        }
    };
    rows.add(&slope, &|r| {
        r.direct
            .as_ref()
            .and_then(|d| Some(jump(d.slope_jump?.jump(), d)))
    });
    rows.add(&format!("  at x{length}"), &|r| {
        r.direct
            .as_ref()
            .and_then(|d| d.slope_jump.filter(|k| !noise(k.jump(), d)))
            .map(|k| short(k.x))
    });
    rows.add(&format!("{slope}, pair"), &|r| {
        let d = r.direct.as_ref()?;
        Some(jump(
            d.pair?.slope_jump?.jump() * if found.load.is_some() { 2.0 } else { 1.0 },
            d,
        ))
    });
    rows.add(&format!("  first wheel at{length}"), &|r| {
        let d = r.direct.as_ref()?;
        d.pair?
            .slope_jump
            .filter(|k| !noise(k.jump(), d))
            .map(|k| short(k.x))
    });
}

/// Rules of extrapolation beyond the table.
fn beyond(out: &mut String, found: &TableQuality, units: Words) {
    let flexibility = units.of(Dimension::FLEXIBILITY);
    let scale = found.item.table.values().amax();
    for row in found
        .beyond
        .iter()
        .filter(|row| row.spread() > 1e-9 * scale)
    {
        let _ = writeln!(
            out,
            "  beyond the table, at x = {} on the row z = {}: parabola {}, cubic {}, tangent {}, line {} \
             {flexibility}; they differ by {} % of the largest entry",
            short(row.x),
            short(row.z),
            sharp(row.parabola),
            sharp(row.cubic),
            sharp(row.tangent),
            sharp(row.line),
            short(100.0 * row.spread() / scale)
        );
    }
}

/// A failed check in words.
fn sentence(verdict: &TableVerdict, Words(units): Words) -> String {
    let unit = units
        .map(|units| units.label(Dimension::FLEXIBILITY))
        .unwrap_or_default();
    match verdict {
        TableVerdict::Asymmetric(worst) => format!(
            "not symmetric: T(x = {}, z = {}) and the value with x and z exchanged differ by {} {unit}; use their \
             mean, or determine which one is wrong",
            short(worst.x),
            short(worst.z),
            short(worst.value)
        ),
        TableVerdict::Indefinite(spectrum) => format!(
            "not positive semi-definite: smallest eigenvalue {} {unit}, largest {}; no structure has such a table",
            short(spectrum.smallest),
            short(spectrum.largest)
        ),
        TableVerdict::Error(method, error, tolerance) => format!(
            "the error of {} is {} %, the tolerance is {} %: use more stations or another reading",
            method.word(),
            short(100.0 * error),
            short(100.0 * tolerance)
        ),
        TableVerdict::Unknown(method) => {
            format!(
                "the error of {} is unknown, because no exact values are available",
                method.word()
            )
        }
    }
}

fn pair(reading: &ReadingFindings) -> Option<super::readings::Pair> {
    reading.direct.as_ref()?.pair
}

fn place(at: &BlockExtreme) -> String {
    format!("{}, {}", short(at.x), short(at.z))
}

fn stiffness(layout: &WheelLayout) -> String {
    layout.stiffness.map_or_else(|| "never".to_owned(), short)
}

fn percent(part: f64, whole: f64) -> String {
    short(if whole > 0.0 {
        100.0 * part / whole
    } else {
        0.0
    })
}

/// Whether a jump is rounding.
fn noise(jump: f64, direct: &DirectFindings) -> bool {
    jump.abs() < 1e-10 * direct.scale
}

/// A ratio, 0 where it is rounding.
fn rounded(ratio: f64) -> String {
    if ratio.abs() < 1e-13 {
        "0".to_owned()
    } else {
        short(ratio)
    }
}
