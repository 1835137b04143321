//! Line charts as plain data.

use super::axis::Axis;
use super::error::Error;
use super::frame::{BELOW, Frame, RIGHT, WIDTH};
use super::legend::{Legend, dashes, ink, symbol};
use super::path::{along, thin};
use super::scale::Scale;
use super::series::{Marker, Series, Style};
use super::svg::{Anchor, GREY, INK, SMALL, Sheet, TITLE, colour};
use super::text::{text_width, wrap};

/// Height of the frame of an ordinary chart, in pixels.
const HEIGHT: f64 = 370.0;
/// Least and greatest height of the frame where both axes have one scale.
const EQUAL: [f64; 2] = [150.0, 620.0];
/// Columns of curves are this wide, in pixels.
const COLUMN: f64 = 0.5;
/// Series with more points than this are thinned.
const LONG: usize = 2000;

/// A chart: curves over two axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// Heading.
    pub title: String,
    /// Horizontal axis.
    pub x_axis: Axis,
    /// Vertical axis.
    pub y_axis: Axis,
    /// Curves, in the order of the legend.
    pub series: Vec<Series>,
    /// Vertical lines with labels.
    pub markers: Vec<Marker>,
    /// Small print below the chart.
    pub note: String,
    /// Both axes have the same scale: a circle stays one. Linear axes only.
    pub equal_aspect: bool,
}

/// A drawn chart: the picture, and what a read-out over it needs.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// The picture.
    pub svg: String,
    /// Where its data are.
    pub frame: Frame,
    /// Points drawn for each series: all of them, or the thinned ones.
    pub series: Vec<Vec<[f64; 2]>>,
}

impl Chart {
    /// A chart without series.
    pub fn new(title: impl Into<String>, x_axis: Axis, y_axis: Axis) -> Self {
        Chart { title: title.into(), x_axis, y_axis, ..Chart::default() }
    }

    /// The same chart with one more series.
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// The same chart with one more marker.
    pub fn mark(mut self, x: f64, label: impl Into<String>) -> Self {
        self.markers.push(Marker::new(x, label));
        self
    }

    /// The chart as an SVG file.
    ///
    /// # Errors
    /// As [`Chart::draw`].
    pub fn svg(&self) -> Result<String, Error> {
        Ok(self.draw()?.svg)
    }

    /// Draws the chart.
    ///
    /// Series without points are named in the legend and not drawn. Long series are thinned to four points a
    /// half pixel with their extremes kept.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::NotPositive`] and [`Error::Marker`] for what cannot be placed,
    /// [`Error::NoData`] where no series has a point, [`Error::Range`] for an axis that cannot be drawn.
    pub fn draw(&self) -> Result<Drawing, Error> {
        self.check()?;
        let (x, y, height) = self.scales()?;
        let lines = wrap(&self.title, WIDTH - 40.0, TITLE);
        let mut top = 14.0 + 22.0 * lines.len() as f64;
        let (mut frame, across, up) = Frame::new((&self.x_axis, x), (&self.y_axis, y), top, height);
        let legend = Legend::new(&self.series, frame.left, WIDTH - RIGHT, top, self.crowded());
        top += legend.height;
        let labels = self.marker_labels(&frame);
        let rows = labels.iter().map(|l| l.1 + 1).max().unwrap_or(0);
        top += 16.0 * rows as f64;
        frame.top = top + 6.0;
        let note = wrap(&self.note, WIDTH - frame.left - RIGHT, SMALL);
        let end = frame.bottom() + BELOW + if note.is_empty() { 0.0 } else { 8.0 + 16.0 * note.len() as f64 };

        let mut sheet = Sheet::new(WIDTH, end);
        sheet.group("class=\"grid\"", |pen| frame.grid(pen, &across, &up))?;
        sheet.group("class=\"markers\" stroke-dasharray=\"30 30\"", |pen| {
            for marker in self.inside(&frame) {
                let at = frame.place([marker.x, frame.y.low])[0];
                pen.line(&[[at, frame.top], [at, frame.bottom()]], GREY, 1.0)?;
            }
            Ok(())
        })?;
        let mut drawn = Vec::new();
        for index in 0..self.series.len() {
            drawn.push(self.curve(&mut sheet, &frame, index)?);
        }
        sheet.group("class=\"scales\"", |pen| {
            frame.scales(pen, (&self.x_axis, &across), (&self.y_axis, &up))?;
            for (i, line) in lines.iter().enumerate() {
                let at = [0.5 * WIDTH, 17.0 + 22.0 * i as f64];
                pen.text(line, at, Anchor::Middle, TITLE, true, INK)?;
            }
            for (marker, (at, row)) in self.inside(&frame).zip(&labels) {
                let at = [*at, frame.top - 8.0 - 16.0 * *row as f64];
                pen.text(&marker.label, at, Anchor::Middle, SMALL, false, GREY)?;
            }
            for (i, line) in note.iter().enumerate() {
                let at = [frame.left, frame.bottom() + BELOW + 6.0 + 16.0 * i as f64];
                pen.text(line, at, Anchor::Left, SMALL, false, GREY)?;
            }
            Ok(())
        })?;
        legend.draw(&mut sheet, &self.series)?;
        Ok(Drawing { svg: sheet.finish(), frame, series: drawn })
    }

    fn check(&self) -> Result<(), Error> {
        for (series, one) in self.series.iter().enumerate() {
            for (point, [x, y]) in one.points.iter().enumerate() {
                if !(x.is_finite() && y.is_finite()) {
                    return Err(Error::NotFinite { series, point });
                }
                if (self.x_axis.log && *x <= 0.0) || (self.y_axis.log && *y <= 0.0) {
                    return Err(Error::NotPositive { series, point });
                }
            }
        }
        if self.series.iter().all(|s| s.points.is_empty()) {
            return Err(Error::NoData);
        }
        match self.markers.iter().position(|m| !m.x.is_finite()) {
            Some(index) => Err(Error::Marker(index)),
            None => Ok(()),
        }
    }

    /// Scales of both axes, and the height of the frame.
    fn scales(&self) -> Result<(Scale, Scale, f64), Error> {
        let points = || self.series.iter().flat_map(|s| &s.points);
        let loose = self.series.iter().any(Series::has_symbols) && !self.equal_aspect;
        let spread = self.series.iter().flat_map(|s| s.spread.iter().flatten().copied());
        let spread = spread.filter(|x| x.is_finite() && (*x > 0.0 || !self.x_axis.log));
        let x = Scale::new(&self.x_axis, points().map(|p| p[0]).chain(spread), loose)?;
        let y = Scale::new(&self.y_axis, points().map(|p| p[1]), true)?;
        let mut found = (x, y, HEIGHT);
        if self.equal_aspect && !x.log && !y.log {
            // The frame is as wide as the y axis' labels leave it, and those depend on the height.
            for _ in 0..8 {
                let width =
                    Frame::new((&self.x_axis, found.0), (&self.y_axis, found.1), 0.0, found.2).0.width;
                let wanted = width * (y.high - y.low) / (x.high - x.low);
                let height = wanted.clamp(EQUAL[0], EQUAL[1]);
                found = (x.widened(wanted / height), y.widened(height / wanted), height);
            }
        }
        Ok(found)
    }

    /// More than two curves: symbols tell them apart in grey.
    fn crowded(&self) -> bool {
        self.series.iter().filter(|s| !s.has_symbols()).count() > 2
    }

    fn inside<'a>(&'a self, frame: &'a Frame) -> impl Iterator<Item = &'a Marker> {
        self.markers.iter().filter(|m| (-1e-9..=1.0 + 1e-9).contains(&frame.x.unit(m.x)))
    }

    /// Middle and row of the label of each marker inside the frame; rows are counted upwards.
    fn marker_labels(&self, frame: &Frame) -> Vec<(f64, usize)> {
        let mut taken: Vec<Vec<[f64; 2]>> = Vec::new();
        let mut found = Vec::new();
        for marker in self.inside(frame) {
            let half = 0.5 * text_width(&marker.label, SMALL) + 3.0;
            let at = frame.place([marker.x, frame.y.low])[0].min(WIDTH - half).max(half);
            let free = |row: &Vec<[f64; 2]>| row.iter().all(|t| at + half <= t[0] || t[1] <= at - half);
            let row = taken.iter().position(free).unwrap_or(taken.len());
            if row == taken.len() {
                taken.push(Vec::new());
            }
            taken[row].push([at - half, at + half]);
            found.push((at, row));
        }
        found
    }

    /// Draws one series; returns the points drawn.
    fn curve(&self, sheet: &mut Sheet, frame: &Frame, index: usize) -> Result<Vec<[f64; 2]>, Error> {
        let series = &self.series[index];
        let corners = series.corners();
        let placed: Vec<_> = corners.iter().map(|p| frame.place(*p)).collect();
        let kept = thin(&placed, COLUMN, LONG);
        let path: Vec<_> = kept.iter().map(|i| placed[*i]).collect();
        let margin = if self.x_axis.range.or(self.y_axis.range).is_some() { 1.5 } else { 8.0 };
        let attributes = format!("class=\"series\" data-series=\"{index}\"{}", dashes(series.style));
        sheet.clipped(&attributes, frame.around(margin), |pen| {
            for ([low, high], [_, y]) in series.spread.iter().zip(&series.points) {
                let ends = [*low, *high].map(|x| frame.place([x, *y]));
                if ends.iter().flatten().all(|own| own.is_finite()) && ends[0] != ends[1] {
                    pen.line(&ends, colour(index), 1.0)?;
                }
            }
            if series.style == Style::Points {
                return path.iter().try_for_each(|p| symbol(pen, index, *p, 3.6));
            }
            match path.len() {
                0 => Ok(()),
                1 => symbol(pen, index, path[0], 3.6),
                _ if series.style == Style::Marked => {
                    pen.line(&path, colour(index), 1.0)?;
                    path.iter().try_for_each(|p| symbol(pen, index, *p, 3.6))
                }
                _ => pen.line(&path, ink(series.style, index), 2.0),
            }
        })?;
        if self.crowded() && !series.has_symbols() {
            let attributes = format!("class=\"series\" data-series=\"{index}\"");
            let first = 20.0 + 120.0 * (index as f64 + 0.5) / self.series.len() as f64;
            sheet.clipped(&attributes, frame.around(margin), |pen| {
                along(&path, 120.0, first).into_iter().try_for_each(|p| symbol(pen, index, p, 3.6))
            })?;
        }
        Ok(kept.iter().map(|i| corners[*i]).collect())
    }
}
