//! The frame of a chart: placement of its data on the picture, and the chart of plotters with its grid and axes.

use plotters::coord::cartesian::Cartesian2d;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::axis::ChartAxis;
use super::backend::SvgBackend;
use super::coordinate::Coordinate;
use super::elements::OnePath;
use super::error::Error;
use super::palette::{FAINT, GREY, INK};
use super::scale::AxisScale;
use super::sheet::{Area, LABEL, SMALL, WIDTH, font, stroke, units};
use super::text::text_width;
use super::ticks::Ticks;

/// Space to the left of the frame for the caption, in addition to the tick labels.
const CAPTION: f64 = 44.0;
/// Space to the right of the frame.
pub(super) const RIGHT: f64 = 30.0;
/// Space below the frame for tick labels and caption.
pub(super) const BELOW: f64 = 52.0;
/// Space to the left of the caption of the y axis.
const EDGE: f64 = 9.4;
/// Height of tick labels and caption below the frame.
const LABELS: f64 = 43.5;
/// Length of the marks at ticks. The distance of labels from the frame is twice this length.
const TICK: f64 = 5.0;

/// A chart of plotters with axes of ours.
pub(super) type Plot<'s> = ChartContext<'s, SvgBackend<'s>, Cartesian2d<Coordinate, Coordinate>>;

/// Placement of data on a picture, in pixels.
///
/// ```
/// use report::chart::{ChartAxis, Chart, Series, Style};
///
/// let line = Series::new("line", Style::Line, vec![[0.0, 0.0], [2.0, 1.0]]);
/// let frame = Chart::new("", ChartAxis::new("x", "m"), ChartAxis::new("y", "m")).with(line).draw()?.frame;
/// assert_eq!(frame.ranges(), [[0.0, 2.0], [0.0, 1.0]]);
/// assert_eq!(frame.place([2.0, 1.0]), [frame.left + frame.width, frame.top]);
/// # Ok::<(), report::chart::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlotArea {
    /// Left edge.
    pub left: f64,
    /// Upper edge.
    pub top: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
    pub(super) x: AxisScale,
    pub(super) y: AxisScale,
    /// Values of x grow to the left, those of y downwards.
    pub(super) is_reversed: [bool; 2],
}

impl PlotArea {
    /// The widest frame that leaves space for the labels of the y axis, with the ticks of both axes.
    pub(super) fn new(
        x: (&ChartAxis, AxisScale),
        y: (&ChartAxis, AxisScale),
        top: f64,
        height: f64,
    ) -> (Self, [Ticks; 2]) {
        let y_ticks = Ticks::new(&y.1, (height / 55.0).clamp(3.0, 10.0));
        let left = CAPTION + widest(&y_ticks);
        let width = WIDTH - left - RIGHT;
        let is_reversed = [x.0.downwards, y.0.downwards];
        let frame = PlotArea {
            left,
            top,
            width,
            height,
            x: x.1,
            y: y.1,
            is_reversed,
        };
        (frame, [frame.x_ticks(), y_ticks])
    }

    /// Ticks of the x axis, as many as their labels leave room for.
    pub(super) fn x_ticks(&self) -> Ticks {
        let mut ticks = Ticks::new(&self.x, 10.0);
        for target in [8.0, 6.0, 4.0, 3.0] {
            if (widest(&ticks) + 14.0) * ticks.labels.len() as f64 <= self.width {
                break;
            }
            ticks = Ticks::new(&self.x, target);
        }
        ticks
    }

    /// Place of a point on the picture.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (u, v) = (self.x.unit(x), self.y.unit(y));
        let u = if self.is_reversed[0] { 1.0 - u } else { u };
        let v = if self.is_reversed[1] { v } else { 1.0 - v };
        [self.left + u * self.width, self.top + v * self.height]
    }

    /// Ends of both axes: (low, high) of x, then of y.
    pub fn ranges(&self) -> [[f64; 2]; 2] {
        [[self.x.low, self.x.high], [self.y.low, self.y.high]]
    }

    /// Rectangle with a margin around it.
    pub(super) fn around(&self, margin: f64) -> [f64; 4] {
        [
            self.left - margin,
            self.top - margin,
            self.width + 2.0 * margin,
            self.height + 2.0 * margin,
        ]
    }

    pub(super) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// plotters' chart with this frame as plotting area, and room for labels left and below.
    pub(super) fn plot<'s>(&self, area: &Area<'s>, [x, y]: [Ticks; 2]) -> Result<Plot<'s>, Error> {
        let coordinates = [
            Coordinate {
                scale: self.x,
                ticks: x,
                is_reversed: self.is_reversed[0],
            },
            Coordinate {
                scale: self.y,
                ticks: y,
                is_reversed: self.is_reversed[1],
            },
        ];
        let labels = [0.0, LABELS, self.left - EDGE, 0.0];
        plot(area, self.around(0.0), labels, coordinates)
    }
}

/// plotters' chart whose plotting area is a rectangle (left, top, width, height in pixels), with room for labels
/// of the sizes given above, below, left and right of it.
pub(super) fn plot<'s>(
    area: &Area<'s>,
    [left, top, width, height]: [f64; 4],
    labels: [f64; 4],
    [x, y]: [Coordinate; 2],
) -> Result<Plot<'s>, Error> {
    let (all_width, all_height) = area.dim_in_pixel();
    let [above, below, before, behind] = labels.map(units);
    // in plotters, the last drawing unit of an area is one before its end
    let (right, bottom) = (units(left + width) + 1, units(top + height) + 1);
    let chart = ChartBuilder::on(area)
        .margin_left(units(left) - before)
        .margin_top(units(top) - above)
        .margin_right(all_width as i32 - right - behind)
        .margin_bottom(all_height as i32 - bottom - below)
        .set_label_area_size(LabelAreaPosition::Top, above)
        .set_label_area_size(LabelAreaPosition::Bottom, below)
        .set_label_area_size(LabelAreaPosition::Left, before)
        .set_label_area_size(LabelAreaPosition::Right, behind)
        .build_cartesian_2d(x, y)?;
    Ok(chart)
}

/// Draws grid lines at the ticks, the zero line of y darker.
pub(super) fn grid(plot: &mut Plot<'_>) -> Result<(), Error> {
    let (x, y, zero) = (plot.x_range(), plot.y_range(), 0.0);
    let both = plot.as_coord_spec();
    let upright = both
        .x_spec()
        .ticks
        .values
        .iter()
        .map(|at| vec![(*at, y.start), (*at, y.end)]);
    let level = both
        .y_spec()
        .ticks
        .values
        .iter()
        .map(|at| vec![(x.start, *at), (x.end, *at)]);
    let lines = OnePath {
        pieces: upright.chain(level).collect(),
        style: stroke(FAINT, 0.8),
    };
    plot.plotting_area().draw(&lines)?;
    if plot.as_coord_spec().y_spec().ticks.values.contains(&zero) {
        let line = PathElement::new([(x.start, zero), (x.end, zero)], stroke(GREY, 0.8));
        plot.plotting_area().draw(&line)?;
    }
    Ok(())
}

/// Draws the border, ticks with their labels, and captions.
pub(super) fn axes(plot: &mut Plot<'_>, [x, y]: [&ChartAxis; 2]) -> Result<(), Error> {
    let exponents = {
        let both = plot.as_coord_spec();
        [both.x_spec().ticks.exponent, both.y_spec().ticks.exponent]
    };
    border(plot)?;
    plot.configure_mesh()
        .disable_mesh()
        .axis_style(stroke(INK, 1.0))
        .set_all_tick_mark_size(units(TICK))
        .label_style(font(SMALL, INK, HPos::Center, VPos::Center))
        .axis_desc_style(font(LABEL, INK, HPos::Center, VPos::Center))
        .x_desc(x.caption(exponents[0]))
        .y_desc(y.caption(exponents[1]))
        .draw()?;
    Ok(())
}

/// Draws the border of the plotting area.
pub(super) fn border(plot: &Plot<'_>) -> Result<(), Error> {
    let (x, y) = (plot.x_range(), plot.y_range());
    let border = Rectangle::new([(x.start, y.start), (x.end, y.end)], stroke(INK, 1.0));
    Ok(plot.plotting_area().draw(&border)?)
}

/// Points as plotters takes them.
pub(super) fn pairs(points: &[[f64; 2]]) -> impl Iterator<Item = (f64, f64)> {
    points.iter().map(|[x, y]| (*x, *y))
}

/// Width of the widest label.
fn widest(ticks: &Ticks) -> f64 {
    ticks
        .labels
        .iter()
        .map(|label| text_width(label, SMALL))
        .fold(0.0, f64::max)
}
