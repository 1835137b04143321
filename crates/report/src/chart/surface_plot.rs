//! An influence grid as a picture: a map with contours, or a table with shaded cells.

use super::axis::{Axis, fixed, with_power};
use super::chart::Chart;
use super::contour::region;
use super::error::Error;
use super::frame::{BELOW, Frame, WIDTH};
use super::scale::{Scale, exponent, extent, step};
use super::series::{Series, Style};
use super::svg::{Anchor, GREY, INK, LABEL, Pen, SMALL, Sheet, TITLE};
use super::text::wrap;
use plotters::style::{RGBColor, WHITE};

/// Grids with at most this many rows and columns are shown as tables.
const TABLE: usize = 12;
/// Side of the map in pixels.
const SIDE: f64 = 560.0;
const LEFT: f64 = 92.0;

/// Influence coefficients over rows (where the deflection is) and columns (where the load is).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfacePlot {
    /// Heading.
    pub title: String,
    /// What is shown, for example `vertical deflection per unit load`.
    pub label: String,
    /// Unit of the values.
    pub unit: String,
    /// Unit of the stations.
    pub length_unit: String,
    /// Stations of the rows, increasing.
    pub at: Vec<f64>,
    /// Stations of the columns, increasing.
    pub loads: Vec<f64>,
    /// `values[row][column]`: deflection at `at[row]` per unit load at `loads[column]`.
    pub values: Vec<Vec<f64>>,
    /// Coordinates of supports, drawn as thin lines.
    pub supports: Vec<f64>,
    /// Small print below the picture.
    pub note: String,
}

impl SurfacePlot {
    /// The grid as an SVG file: a table with shaded cells up to 12 x 12, a map with contours beyond.
    ///
    /// Between the stations the map is linear along the edges of the grid's cells.
    ///
    /// # Errors
    /// [`Error::NoData`], [`Error::Shape`], [`Error::Stations`] or [`Error::NotFinite`] for a grid that is
    /// not one; the indices of the last are row and column.
    pub fn svg(&self) -> Result<String, Error> {
        self.check()?;
        if self.at.len() <= TABLE && self.loads.len() <= TABLE { self.table() } else { self.map() }
    }

    /// One influence line a load station, as a chart with deflections positive upwards as in the grid.
    ///
    /// # Errors
    /// As [`SurfacePlot::svg`].
    pub fn lines(&self) -> Result<Chart, Error> {
        self.check()?;
        let x = Axis::new("place of the deflection", &self.length_unit);
        let mut chart = Chart::new(&self.title, x, Axis::new(&self.label, &self.unit));
        for (column, load) in self.loads.iter().enumerate() {
            let points = self.at.iter().zip(&self.values).map(|(x, row)| [*x, row[column]]).collect();
            let label = format!("load at {} {}", short(*load), self.length_unit);
            chart.series.push(Series::new(label, Style::Line, points));
        }
        for support in &self.supports {
            chart = chart.mark(*support, "support");
        }
        chart.note.clone_from(&self.note);
        Ok(chart)
    }

    fn check(&self) -> Result<(), Error> {
        let (rows, expected) = (self.at.len(), self.loads.len());
        if rows == 0 || expected == 0 {
            return Err(Error::NoData);
        }
        let wrong = self.values.iter().position(|row| row.len() != expected);
        if self.values.len() != rows || wrong.is_some() {
            let row = wrong.unwrap_or(self.values.len());
            let columns = self.values.get(row).map_or(expected, Vec::len);
            return Err(Error::Shape { row, columns, rows, expected });
        }
        for stations in [&self.at, &self.loads] {
            let finite = stations.iter().position(|x| !x.is_finite());
            let ordered = stations.windows(2).position(|p| p[0] >= p[1]).map(|i| i + 1);
            if let Some(i) = finite.or(ordered) {
                return Err(Error::Stations(i));
            }
        }
        for (series, row) in self.values.iter().enumerate() {
            if let Some(point) = row.iter().position(|v| !v.is_finite()) {
                return Err(Error::NotFinite { series, point });
            }
        }
        Ok(())
    }

    /// Least and greatest value.
    fn extent(&self) -> (f64, f64) {
        extent(self.values.iter().flatten().copied())
    }

    fn heading(&self, sheet: &mut Sheet, power: i32) -> Result<(), Error> {
        let unit = with_power(power, &self.unit);
        sheet.group("class=\"title\"", |pen| {
            pen.text(&self.title, [0.5 * WIDTH, 17.0], Anchor::Middle, TITLE, true, INK)?;
            let text = if unit.is_empty() { self.label.clone() } else { format!("{} ({unit})", self.label) };
            pen.text(&text, [0.5 * WIDTH, 40.0], Anchor::Middle, LABEL, false, INK)
        })
    }

    fn footnote(&self, sheet: &mut Sheet, top: f64, lines: &[String]) -> Result<(), Error> {
        sheet.group("class=\"note\"", |pen| {
            lines.iter().enumerate().try_for_each(|(i, line)| {
                pen.text(line, [LEFT, top + 16.0 * i as f64], Anchor::Left, SMALL, false, GREY)
            })
        })
    }

    fn table(&self) -> Result<String, Error> {
        let (rows, columns) = (self.at.len() as f64, self.loads.len() as f64);
        let (low, high) = self.extent();
        let limit = low.abs().max(high.abs());
        let power = exponent(limit);
        let (cell, top) = ([((WIDTH - LEFT - 30.0) / columns).min(104.0), 34.0], 92.0);
        let left = LEFT + 0.5 * (WIDTH - LEFT - 30.0 - cell[0] * columns);
        let lines = wrap(&self.note, WIDTH - LEFT - 30.0, SMALL);
        let end = top + cell[1] * rows;
        let mut sheet = Sheet::new(WIDTH, end + 24.0 + 16.0 * lines.len() as f64);
        self.heading(&mut sheet, power)?;
        sheet.group("class=\"cells\"", |pen| {
            for (i, row) in self.values.iter().enumerate() {
                for (j, value) in row.iter().enumerate() {
                    let at = [left + cell[0] * j as f64, top + cell[1] * i as f64];
                    let share = if limit > 0.0 { value / limit } else { 0.0 };
                    pen.rectangle([at[0], at[1], cell[0] - 1.5, cell[1] - 1.5], shade(share))?;
                    let middle = [at[0] + 0.5 * cell[0], at[1] + 0.5 * cell[1]];
                    let ink = if share.abs() > 0.62 { WHITE } else { INK };
                    pen.text(&fixed(*value, power, 2), middle, Anchor::Middle, SMALL, false, ink)?;
                }
            }
            for (j, load) in self.loads.iter().enumerate() {
                let at = [left + cell[0] * (j as f64 + 0.5), top - 12.0];
                pen.text(&short(*load), at, Anchor::Middle, SMALL, true, INK)?;
            }
            for (i, station) in self.at.iter().enumerate() {
                let at = [left - 10.0, top + cell[1] * (i as f64 + 0.5)];
                pen.text(&short(*station), at, Anchor::Right, SMALL, true, INK)?;
            }
            let caption = format!("load at ({})", self.length_unit);
            let middle = [left + 0.5 * cell[0] * columns, top - 31.0];
            pen.text(&caption, middle, Anchor::Middle, SMALL, false, INK)?;
            let caption = format!("deflection at ({})", self.length_unit);
            pen.text(&caption, [left - 66.0, top + 0.5 * cell[1] * rows], Anchor::Upwards, SMALL, false, INK)
        })?;
        self.footnote(&mut sheet, end + 14.0, &lines)?;
        Ok(sheet.finish())
    }

    fn map(&self) -> Result<String, Error> {
        let (low, high) = self.extent();
        let limit = low.abs().max(high.abs());
        let power = exponent(limit);
        let axes = [Axis::new("load at", &self.length_unit), Axis::new("deflection at", &self.length_unit)];
        let x = Scale::new(&axes[0], self.loads.iter().copied(), false)?;
        let y = Scale::new(&axes[1], self.at.iter().copied(), false)?;
        let frame = Frame { left: LEFT, top: 62.0, width: SIDE, height: SIDE, x, y, flip: [false; 2] };
        let levels = levels(low, high);
        let dashed = levels.iter().any(|v| *v < -1e-9 * limit);
        let note =
            if dashed { format!("{} Contours below zero are dashed.", self.note) } else { self.note.clone() };
        let lines = wrap(&note, WIDTH - LEFT - 30.0, SMALL);
        let end = frame.bottom() + BELOW;
        let mut sheet = Sheet::new(WIDTH, end + 12.0 + 16.0 * lines.len() as f64);
        self.heading(&mut sheet, power)?;

        let columns: Vec<f64> = self.loads.iter().map(|v| frame.place([*v, y.low])[0]).collect();
        let rows: Vec<f64> = self.at.iter().map(|v| frame.place([x.low, *v])[1]).collect();
        let colours: Vec<RGBColor> = (0..=levels.len())
            .map(|k| {
                let from = if k == 0 { low } else { levels[k - 1] };
                let to = levels.get(k).copied().unwrap_or(high);
                shade(if limit > 0.0 { 0.5 * (from + to) / limit } else { 0.0 })
            })
            .collect();
        // Rounding must not decide on which side of zero a support lies.
        let snap = |v: &f64| if v.abs() < 1e-12 * limit { 0.0 } else { *v };
        let values: Vec<Vec<f64>> = self.values.iter().map(|row| row.iter().map(snap).collect()).collect();
        sheet.group("class=\"bands\"", |pen| pen.rectangle(frame.around(0.0), colours[0]))?;
        for (level, colour) in levels.iter().zip(&colours[1..]) {
            let found = region(&columns, &rows, &values, *level);
            sheet.area(&found.polygons, *colour);
            let zero = level.abs() < 1e-9 * limit;
            let line = if *level < 0.0 && !zero { &found.dashes } else { &found.chords };
            sheet.strokes(line, if zero { INK } else { GREY }, if zero { 1.6 } else { 0.7 });
        }
        sheet.group("class=\"scales\"", |pen| {
            for support in self.supports.iter().filter(|s| (x.low..=x.high).contains(s)) {
                let at = frame.place([*support, *support]);
                pen.line(&[[at[0], frame.top], [at[0], frame.bottom()]], GREY, 1.0)?;
                pen.line(&[[frame.left, at[1]], [frame.left + SIDE, at[1]]], GREY, 1.0)?;
            }
            let (across, up) = (frame.fitting(), y.ticks(10.0));
            frame.scales(pen, (&axes[0], &across), (&axes[1], &up))?;
            bar(pen, &frame, &levels, &colours, power)
        })?;
        self.footnote(&mut sheet, end + 6.0, &lines)?;
        Ok(sheet.finish())
    }
}

/// Colour bar right of the map: one box a band, the levels between them.
fn bar(pen: &Pen<'_>, frame: &Frame, levels: &[f64], colours: &[RGBColor], power: i32) -> Result<(), Error> {
    let left = frame.left + frame.width + 36.0;
    let height = frame.height / colours.len() as f64;
    let apart = if levels.len() > 1 { levels[1] - levels[0] } else { 1.0 };
    let decimals = (-(apart / 10f64.powi(power)).log10().floor()).clamp(0.0, 12.0) as usize;
    for (k, colour) in colours.iter().enumerate() {
        let top = frame.bottom() - height * (k as f64 + 1.0);
        pen.rectangle([left, top, 26.0, height], *colour)?;
        if let Some(level) = levels.get(k) {
            pen.line(&[[left, top], [left + 31.0, top]], GREY, 0.8)?;
            let text = fixed(*level, power, decimals);
            pen.text(&text, [left + 36.0, top], Anchor::Left, SMALL, false, INK)?;
        }
    }
    let (a, b, c, d) = (left, left + 26.0, frame.top, frame.bottom());
    pen.line(&[[a, c], [b, c], [b, d], [a, d], [a, c]], INK, 1.0)
}

/// Contour levels strictly between the ends, about a dozen.
fn levels(low: f64, high: f64) -> Vec<f64> {
    if low >= high {
        return Vec::new();
    }
    let step = step(low, high, 12.0);
    let first = (low / step + 1e-9).floor() + 1.0;
    let value = |i: i32| if first + f64::from(i) == 0.0 { 0.0 } else { (first + f64::from(i)) * step };
    (0..40).map(value).take_while(|v| *v < high - 1e-9 * step).collect()
}

/// Colour of a value between -1 (blue) and 1 (red); 0 is white, and the grey darkens with the size.
fn shade(share: f64) -> RGBColor {
    let full = if share < 0.0 { [0x1b, 0x4f, 0x9c] } else { [0x9e, 0x1b, 0x2e] };
    let t = share.abs().min(1.0).powf(0.85);
    let [r, g, b] = full.map(|c: u8| (255.0 + t * (f64::from(c) - 255.0)).round() as u8);
    RGBColor(r, g, b)
}

/// A station's coordinate in at most six digits.
pub(super) fn short(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text.strip_prefix('-') {
        Some("0") => "0".to_owned(),
        Some(rest) => format!("\u{2212}{rest}"),
        None => text.to_owned(),
    }
}
