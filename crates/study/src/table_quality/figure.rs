//! Findings as figures: errors under a moving wheel, and over all places of load and deflection.

use splines::Error;
use splines::quality::{CouplingBlock, sample_places};

use super::digits::short;
use super::findings::{ExactValues, TableQuality, UP, reading};
use super::reading_method::TableReadingMethod;
use super::readings::{coupling_block, map};
use super::subject::TableSource;
use formats::units::Dimension;
use report::chart::{self, Chart, ChartAxis, Series, Style, SurfacePlot, Svg};
use report::{self, Picture, Report, ReportSection};

/// Number of places along the rail of a chart.
const ACROSS: usize = 240;
/// Number of places along each axis of a map.
const MAP: usize = 90;

/// A figure with its caption.
pub struct TableFigure {
    /// The picture.
    pub picture: Picture,
    /// The caption.
    pub caption: String,
}

impl TableFigure {
    /// As SVG.
    ///
    /// # Errors
    /// Data that a chart cannot draw.
    pub fn svg(&self) -> Result<Svg, chart::Error> {
        self.picture.svg()
    }
}

/// Figures of one table; none where exact values are unknown.
///
/// # Errors
/// Data that a chart cannot draw, or a place at which a reading cannot be evaluated.
pub fn figures(
    subject: &TableSource,
    found: &TableQuality,
) -> Result<Vec<TableFigure>, Box<dyn std::error::Error>> {
    let mut out = Vec::new();
    let Some(paths) = found.item.paths else {
        return Ok(out);
    };
    let exact = match (&found.exact_values, &subject.surface) {
        (ExactValues::Surface, Some(surface)) => coupling_block(surface, paths),
        (ExactValues::Beam(beam), _) => coupling_block(&beam.surface, UP),
        _ => return Ok(out),
    };
    let table = &found.item.table;
    let title = if found.item.name.is_empty() {
        format!("SPLINE/{}", found.item.id)
    } else {
        format!("SPLINE/{} {}", found.item.id, found.item.name)
    };
    let length = subject
        .units
        .map(|units| units.label(Dimension::LENGTH))
        .unwrap_or_default();
    let own = |points: &[f64]| [points[0], points[points.len() - 1]];
    let (mut x, mut z) = (own(table.x()), own(table.z()));
    if let Some([a, b]) = exact.range() {
        x = [x[0].max(a[0]), x[1].min(a[1])];
        z = [z[0].max(b[0]), z[1].min(b[1])];
    }
    if found.item.is_direct() {
        x = [x[0].max(z[0]), x[1].min(z[1])];
        z = x;
    }
    if x[0] >= x[1] || z[0] >= z[1] {
        return Ok(out);
    }
    if found.item.is_direct() {
        out.extend(diagonal(subject, found, &exact, x, &title, &length)?);
    }
    out.extend(error_map(subject, found, &exact, [x, z], &title, &length)?);
    Ok(out)
}

/// Map of the error of the worst reading over `range` of loads and of deflections; `None` where no reading errs.
fn error_map(
    subject: &TableSource,
    found: &TableQuality,
    exact: &CouplingBlock<'_>,
    [x, z]: [[f64; 2]; 2],
    title: &str,
    length: &str,
) -> Result<Option<TableFigure>, Box<dyn std::error::Error>> {
    let Some(paths) = found.item.paths else {
        return Ok(None);
    };
    let table = &found.item.table;
    let worst = found
        .readings
        .iter()
        .filter_map(|r| Some((r.method, found.relative(&r.error?))))
        .max_by(|a, b| a.1.total_cmp(&b.1));
    let Some((method, error)) = worst.filter(|(_, error)| *error > 0.0) else {
        return Ok(None);
    };
    let Some(reading) = reading(subject, &found.item, method) else {
        return Ok(None);
    };
    let (x, z) = (
        sample_places(table.x(), x, MAP),
        sample_places(table.z(), z, MAP),
    );
    let scale = scale(found);
    let mut values = map(&coupling_block(reading.as_ref(), paths), exact, &z, &x)?;
    values
        .iter_mut()
        .flatten()
        .for_each(|value| *value *= 100.0 / scale);
    let plot = SurfacePlot {
        title: format!("{title}: {} minus exact", method.word()),
        label: "error relative to the largest coefficient".to_owned(),
        unit: "%".to_owned(),
        length_unit: length.to_owned(),
        at: z,
        loads: x,
        values,
        supports: found.supports.clone(),
        note: String::new(),
    };
    let caption = format!(
        "Error of {} over all positions of load and deflection, at most {} percent. Lines mark supports.",
        method.word(),
        short(100.0 * error)
    );
    Ok(Some(TableFigure {
        picture: plot.svg()?.into(),
        caption,
    }))
}

/// Scale of relative errors.
fn scale(found: &TableQuality) -> f64 {
    let own = found.readings.iter().find_map(|r| r.error.map(|e| e.scale));
    found
        .scale
        .or(own)
        .filter(|scale| *scale > 0.0)
        .unwrap_or(1.0)
}

/// Chart of the error of G(x, x) of every reading along the rail.
fn diagonal(
    subject: &TableSource,
    found: &TableQuality,
    exact: &CouplingBlock<'_>,
    range: [f64; 2],
    title: &str,
    length: &str,
) -> Result<Option<TableFigure>, Error> {
    let Some(paths) = found.item.paths else {
        return Ok(None);
    };
    let x = sample_places(found.item.table.x(), range, ACROSS);
    let scale = scale(found);
    let mut chart = Chart::new(
        format!("{title}: error under one moving wheel"),
        ChartAxis::new("position of the wheel", length),
        ChartAxis::new("error relative to the largest coefficient", "%"),
    );
    for (index, one) in found
        .readings
        .iter()
        .enumerate()
        .filter(|(_, r)| r.method != TableReadingMethod::Exact)
    {
        let Some(reading) = reading(subject, &found.item, one.method) else {
            continue;
        };
        let own = coupling_block(reading.as_ref(), paths);
        let mut points = Vec::with_capacity(x.len());
        for &x in &x {
            points.push([x, 100.0 * (own.at(x, x)? - exact.at(x, x)?) / scale]);
        }
        let style = Style::alternating(index);
        chart = chart.with(Series::new(one.method.word(), style, points));
    }
    if chart.series.is_empty() {
        return Ok(None);
    }
    for support in found
        .supports
        .iter()
        .filter(|s| (range[0]..=range[1]).contains(s))
    {
        chart = chart.mark(*support, "support");
    }
    let caption =
        "Error of G(x, x), the compliance under a wheel that moves along the rail: reading minus exact \
         value."
            .to_owned();
    Ok(Some(TableFigure {
        picture: chart.into(),
        caption,
    }))
}

/// All findings as one page of HTML.
///
/// # Errors
/// As [`figures`], and as [`Report::html`].
pub fn page(
    subject: &TableSource,
    all: &[TableQuality],
) -> Result<String, Box<dyn std::error::Error>> {
    let mut report = Report {
        title: "Quality of influence tables".to_owned(),
        subtitle: subject.file.clone(),
        sections: Vec::new(),
    };
    for found in all {
        let mut section =
            ReportSection::new(format!("SPLINE/{} {}", found.item.id, found.item.name).trim_end());
        for risk in &found.risks {
            section = section.paragraph(format!("Note: {risk}."));
        }
        if !found.readings.is_empty() {
            section = section.table(readings(subject, found));
        }
        for figure in figures(subject, found)? {
            section = section.figure(figure.picture, figure.caption);
        }
        report.sections.push(section);
    }
    Ok(report.html(None)?)
}

/// Table of the readings of one table.
fn readings(subject: &TableSource, found: &TableQuality) -> report::ReportTable {
    let unit = |dimension| {
        subject
            .units
            .map(|units| units.label(dimension))
            .unwrap_or_default()
    };
    let column = |name: &str, unit: &str| report::TableColumn::new(name, unit);
    let (length, stiffness) = (unit(Dimension::LENGTH), unit(Dimension::STIFFNESS));
    let mut table = report::ReportTable {
        caption: "Readings; errors and asymmetry relative to the largest coefficient.".to_owned(),
        columns: vec![
            column("reading", ""),
            column("largest error", "%"),
            column("load at", &length),
            column("deflection at", &length),
            column("asymmetry", "%"),
            column("8 wheels indefinite from k", &stiffness),
            column("jump of slope", &unit(Dimension::of(0, -1, 0))),
        ],
        rows: Vec::new(),
    };
    let number =
        |value: Option<f64>| value.map_or(report::TableCell::Empty, report::TableCell::Number);
    for one in &found.readings {
        let direct = one.direct.as_ref();
        table.rows.push(vec![
            one.method.word().into(),
            number(one.error.map(|e| 100.0 * found.relative(&e))),
            number(one.error.map(|e| e.largest.x)),
            number(one.error.map(|e| e.largest.z)),
            number(
                direct
                    .filter(|d| d.scale > 0.0)
                    .map(|d| 100.0 * d.asymmetry.value / d.scale),
            ),
            direct
                .and_then(|d| d.layouts.last())
                .map_or(report::TableCell::Empty, |layout| {
                    layout
                        .stiffness
                        .map_or_else(|| "never".into(), report::TableCell::Number)
                }),
            number(direct.and_then(|d| d.slope_jump).map(|k| k.jump())),
        ]);
    }
    table
}
