//! Line charts as plain data.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::axis::ChartAxis;
use super::elements::Symbol;
use super::error::Error;
use super::frame::{self, BELOW, Plot, PlotArea, RIGHT};
use super::legend::{Legend, RADIUS, dashes};
use super::palette::{GREY, colour, line_colour};
use super::scale::AxisScale;
use super::series::{Series, SeriesMarker, Style};
use super::sheet::{
    self, Area, NOTE_LINE, SMALL, TITLE, TITLE_LINE, WIDTH, clipped, font, group, stroke, units,
};
use super::svg::{FINE, Svg};
use super::text::{text_width, wrap};
use super::thinning::{simplified, thin};
use super::ticks::Ticks;

/// Height of the frame of an ordinary chart, in pixels.
const HEIGHT: f64 = 370.0;
/// Smallest and largest height of the frame if both axes have the same scale, in pixels.
const EQUAL: [f64; 2] = [150.0, 620.0];
/// Width of a column within which curves are thinned, in pixels.
const COLUMN: f64 = 0.5;
/// Distance of the points that a drawn line leaves out from it, in pixels: half a unit of the drawing.
const INVISIBLE: f64 = 0.05;
/// Largest number of points of a series that is not thinned.
const LONG: usize = 2000;
/// Distance of symbols along a curve, in pixels.
const APART: f64 = 120.0;
/// Smallest distance of the first symbol from the start of a curve, in pixels.
const FIRST: f64 = 20.0;
/// Height of a row of labels of markers, in pixels.
const MARKER_ROW: f64 = 16.0;

/// A chart: curves over two axes.
///
/// ```
/// use report::chart::{ChartAxis, Chart, Series, Style};
///
/// let deflection = (0..=60).map(|x| [f64::from(x), 0.5 * (f64::from(x) / 60.0 * 3.14).sin()]).collect();
/// let axes = [ChartAxis::new("position", "ft"), ChartAxis::new("deflection", "ft").downwards()];
/// let [x, y] = axes;
/// let chart = Chart::new("Path of the trunnion", x, y)
///     .with(Series::new("influence", Style::Line, deflection))
///     .with(Series::new("rigid rail", Style::Dashed, vec![[0.0, 0.0], [60.0, 0.0]]))
///     .mark(30.0, "midspan");
/// let svg = chart.svg()?.file();
/// assert!(svg.contains("Path of the trunnion") && svg.contains("rigid rail"));
/// # Ok::<(), report::chart::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// Heading.
    pub title: String,
    /// Horizontal axis.
    pub x_axis: ChartAxis,
    /// Vertical axis.
    pub y_axis: ChartAxis,
    /// Curves, in the order of the legend.
    pub series: Vec<Series>,
    /// Vertical lines with labels.
    pub markers: Vec<SeriesMarker>,
    /// Note below the chart, in small letters.
    pub note: String,
    /// Whether both axes have the same scale, so that a circle is drawn as one. For linear axes only.
    pub equal_aspect: bool,
}

/// A drawn chart: the picture, and the data for the display of values under the pointer.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// The picture.
    pub svg: Svg,
    /// Placement of its data.
    pub frame: PlotArea,
    /// Points drawn for each series, after thinning.
    pub series: Vec<Vec<[f64; 2]>>,
}

impl Chart {
    /// A chart without series.
    pub fn new(title: impl Into<String>, x_axis: ChartAxis, y_axis: ChartAxis) -> Self {
        Chart {
            title: title.into(),
            x_axis,
            y_axis,
            ..Chart::default()
        }
    }

    /// The same chart with one more series.
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// The same chart with one more marker.
    pub fn mark(mut self, x: f64, label: impl Into<String>) -> Self {
        self.markers.push(SeriesMarker::new(x, label));
        self
    }

    /// The chart as a picture.
    ///
    /// # Errors
    /// As [`Chart::draw`].
    pub fn svg(&self) -> Result<Svg, Error> {
        Ok(self.draw()?.svg)
    }

    /// Draws the chart.
    ///
    /// Series without points appear only in the legend. Long series are thinned to at most four points in each half
    /// pixel, which preserves their extremes.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::NotPositive`] and [`Error::Marker`] for points and markers that cannot be
    /// placed, [`Error::NoData`] where no series has a point, [`Error::Range`] for an axis that cannot be drawn.
    pub fn draw(&self) -> Result<Drawing, Error> {
        self.check()?;
        let layout = self.layout()?;
        let mut drawn = Vec::new();
        let svg = sheet::picture(WIDTH, layout.end(), |area| {
            drawn = self.draw_on(area, &layout)?;
            Ok(())
        })?;
        Ok(Drawing {
            svg,
            frame: layout.frame,
            series: drawn,
        })
    }

    /// Arranges title, legend, labels of markers, frame and note one below the other.
    fn layout(&self) -> Result<Layout, Error> {
        let (x, y, height) = self.scales()?;
        let title = wrap(&self.title, WIDTH - 40.0, TITLE);
        let mut top = 14.0 + TITLE_LINE * title.len() as f64;
        let (mut frame, ticks) = PlotArea::new((&self.x_axis, x), (&self.y_axis, y), top, height);
        let legend = Legend::new(
            &self.series,
            frame.left,
            WIDTH - RIGHT,
            top,
            self.is_crowded(),
        );
        top += legend.height;
        let marker_labels = self.marker_labels(&frame);
        let rows = marker_labels
            .iter()
            .map(|label| label.1 + 1)
            .max()
            .unwrap_or(0);
        top += MARKER_ROW * rows as f64;
        frame.top = top + 6.0;
        let note = wrap(&self.note, WIDTH - frame.left - RIGHT, SMALL);
        Ok(Layout {
            title,
            legend,
            marker_labels,
            frame,
            ticks,
            note,
        })
    }

    /// Draws the chart on a sheet; returns the points drawn for each series.
    fn draw_on(&self, area: &Area<'_>, layout: &Layout) -> Result<Vec<Vec<[f64; 2]>>, Error> {
        let frame = &layout.frame;
        let mut plot = frame.plot(area, layout.ticks.clone())?;
        group(area, "class=\"grid\"", || frame::grid(&mut plot))?;
        group(area, "class=\"markers\" stroke-dasharray=\"30 30\"", || {
            let (low, high) = (frame.y.low, frame.y.high);
            let lines = self
                .inside(frame)
                .map(|m| PathElement::new([(m.x, low), (m.x, high)], stroke(GREY, 1.0)));
            plot.draw_series(lines)?;
            Ok(())
        })?;
        let drawn: Result<_, Error> = (0..self.series.len())
            .map(|index| self.curve(area, &mut plot, frame, index))
            .collect();
        group(area, "class=\"scales\"", || {
            frame::axes(&mut plot, [&self.x_axis, &self.y_axis])?;
            sheet::title(area, &layout.title)?;
            let style = font(SMALL, GREY, HPos::Center, VPos::Center);
            for (marker, (at, row)) in self.inside(frame).zip(&layout.marker_labels) {
                let at = [*at, frame.top - 8.0 - MARKER_ROW * *row as f64];
                sheet::text(area, &marker.label, at, &style)?;
            }
            sheet::note(
                area,
                &layout.note,
                [frame.left, frame.bottom() + BELOW + 6.0],
            )
        })?;
        layout.legend.draw(area, &self.series)?;
        drawn
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
    fn scales(&self) -> Result<(AxisScale, AxisScale, f64), Error> {
        let points = || self.series.iter().flat_map(|s| &s.points);
        let loose = self.series.iter().any(Series::has_symbols) && !self.equal_aspect;
        let spread = self
            .series
            .iter()
            .flat_map(|s| s.spread.iter().flatten().copied());
        let spread = spread.filter(|x| x.is_finite() && (*x > 0.0 || !self.x_axis.log));
        let x = AxisScale::new(&self.x_axis, points().map(|p| p[0]).chain(spread), loose)?;
        let y = AxisScale::new(&self.y_axis, points().map(|p| p[1]), true)?;
        let mut found = (x, y, HEIGHT);
        if self.equal_aspect && !x.log && !y.log {
            // The width of the frame depends on the labels of the y axis, and these depend on the height.
            for _ in 0..8 {
                let width = PlotArea::new(
                    (&self.x_axis, found.0),
                    (&self.y_axis, found.1),
                    0.0,
                    found.2,
                )
                .0
                .width;
                let wanted = width * (y.high - y.low) / (x.high - x.low);
                let height = wanted.clamp(EQUAL[0], EQUAL[1]);
                found = (
                    x.widened(wanted / height),
                    y.widened(height / wanted),
                    height,
                );
            }
        }
        Ok(found)
    }

    /// Whether there are more than two curves, so that symbols are needed to distinguish them without colour.
    fn is_crowded(&self) -> bool {
        self.series.iter().filter(|s| s.may_have_symbols()).count() > 2
    }

    fn inside<'a>(&'a self, frame: &'a PlotArea) -> impl Iterator<Item = &'a SeriesMarker> {
        self.markers
            .iter()
            .filter(|m| (-1e-9..=1.0 + 1e-9).contains(&frame.x.unit(m.x)))
    }

    /// Middle and row of the label of each marker inside the frame; rows are counted upwards.
    fn marker_labels(&self, frame: &PlotArea) -> Vec<(f64, usize)> {
        let mut taken: Vec<Vec<[f64; 2]>> = Vec::new();
        let mut found = Vec::new();
        for marker in self.inside(frame) {
            let half = 0.5 * text_width(&marker.label, SMALL) + 3.0;
            let at = frame.place([marker.x, frame.y.low])[0]
                .min(WIDTH - half)
                .max(frame.left + half);
            let free =
                |row: &Vec<[f64; 2]>| row.iter().all(|t| at + half <= t[0] || t[1] <= at - half);
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
    fn curve(
        &self,
        area: &Area<'_>,
        plot: &mut Plot<'_>,
        frame: &PlotArea,
        index: usize,
    ) -> Result<Vec<[f64; 2]>, Error> {
        let series = &self.series[index];
        let corners = series.corners();
        let placed: Vec<_> = corners.iter().map(|p| frame.place(*p)).collect();
        let drawn: Vec<[f64; 2]> = thin(&placed, COLUMN, LONG)
            .into_iter()
            .map(|i| corners[i])
            .collect();
        // symbols at points stand at all of them
        let path: Vec<(f64, f64)> = match series.has_symbols() {
            true => drawn.iter().map(|[x, y]| (*x, *y)).collect(),
            false => {
                let placed: Vec<_> = drawn.iter().map(|p| frame.place(*p)).collect();
                simplified(&placed, INVISIBLE)
                    .into_iter()
                    .map(|i| (drawn[i][0], drawn[i][1]))
                    .collect()
            }
        };
        let is_single = path.len() == 1;
        let margin = if self.x_axis.range.or(self.y_axis.range).is_some() {
            1.5
        } else {
            8.0
        };
        let class = format!("class=\"series\" data-series=\"{index}\"");
        clipped(
            area,
            &format!("{class}{}", dashes(series.style)),
            frame.around(margin),
            || {
                for ([low, high], [_, y]) in series.spread.iter().zip(&series.points) {
                    let ends = [*low, *high].map(|x| frame.place([x, *y]));
                    if ends.iter().flatten().all(|own| own.is_finite()) && ends[0] != ends[1] {
                        let range =
                            PathElement::new([(*low, *y), (*high, *y)], stroke(colour(index), 1.0));
                        plot.plotting_area().draw(&range)?;
                    }
                }
                if series.style != Style::Points && !is_single {
                    let width = if series.style == Style::Marked {
                        1.0
                    } else {
                        2.0
                    };
                    let style = stroke(line_colour(series.style, index), width);
                    plot.draw_series(LineSeries::new(path.iter().copied(), style))?;
                }
                if series.has_symbols() || is_single {
                    plot.draw_series(
                        path.iter()
                            .map(|at| Symbol::of_series(index, *at, RADIUS * FINE)),
                    )?;
                }
                Ok(())
            },
        )?;
        if self.is_crowded() && series.may_have_symbols() {
            let first = FIRST + APART * (index as f64 + 0.5) / self.series.len() as f64;
            clipped(area, &class, frame.around(margin), || {
                let symbol = move |at: (i32, i32)| Symbol::of_series(index, at, RADIUS * FINE);
                plot.draw_series(DottedLineSeries::new(
                    path,
                    units(first),
                    units(APART),
                    symbol,
                ))?;
                Ok(())
            })?;
        }
        Ok(drawn)
    }
}

/// Positions of the parts of a chart.
struct Layout {
    title: Vec<String>,
    legend: Legend,
    /// Middle and row of the label of each marker inside the frame.
    marker_labels: Vec<(f64, usize)>,
    frame: PlotArea,
    ticks: [Ticks; 2],
    note: Vec<String>,
}

impl Layout {
    /// Height of the picture.
    fn end(&self) -> f64 {
        let note = if self.note.is_empty() {
            0.0
        } else {
            8.0 + NOTE_LINE * self.note.len() as f64
        };
        self.frame.bottom() + BELOW + note
    }
}
