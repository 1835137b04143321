//! An influence grid as a picture: a map with contours, or a table with shaded cells.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::axis::ChartAxis;
use super::contour::region;
use super::coordinate::Coordinate;
use super::elements::OnePath;
use super::error::Error;
use super::frame::{self, BELOW, Plot, PlotArea, pairs, plot};
use super::label::{fixed, short, with_unit};
use super::line_chart::Chart;
use super::palette::{GREY, INK, shade};
use super::scale::{AxisScale, extent, step};
use super::series::{Series, Style};
use super::sheet::{self, Area, LABEL, NOTE_LINE, SMALL, WIDTH, bold, font, group, stroke, units};
use super::svg::Svg;
use super::text::wrap;
use super::ticks::{Ticks, exponent};

/// Largest number of rows and of columns of a grid that is shown as a table.
const TABLE: usize = 12;
/// Side of the map in pixels.
const SIDE: f64 = 560.0;
/// Space to the left of the map and of notes, in pixels.
const LEFT: f64 = 92.0;
/// Space to the right of tables and notes, in pixels.
const RIGHT: f64 = 30.0;
/// Largest width of a cell of a table, and its height, in pixels.
const CELL: [f64; 2] = [104.0, 34.0];
/// White to the right of and below a cell of a table, in pixels.
const GAP: f64 = 1.5;
/// Absolute value of a cell, relative to the largest, above which its text is white.
const DARK: f64 = 0.62;
/// Upper edges of tables and maps, below their heading, in pixels.
const BELOW_HEADING: [f64; 2] = [92.0, 62.0];

/// Influence coefficients over rows (where the deflection is) and columns (where the load is).
///
/// ```
/// use report::chart::SurfacePlot;
///
/// let grid = SurfacePlot {
///     title: "Influence coefficients".into(),
///     label: "deflection per unit load".into(),
///     unit: "mm/kN".into(),
///     length_unit: "m".into(),
///     at: vec![2.0, 4.0],
///     loads: vec![2.0, 4.0],
///     values: vec![vec![0.3, 0.2], vec![0.2, 0.3]],
///     ..SurfacePlot::default()
/// };
/// assert!(grid.svg()?.file().contains("load at (m)"));
/// assert_eq!(grid.lines()?.series[1].points, [[2.0, 0.2], [4.0, 0.3]]);
/// # Ok::<(), report::chart::Error>(())
/// ```
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
    /// Note below the picture, in small letters.
    pub note: String,
}

impl SurfacePlot {
    /// The grid as a picture: a table with shaded cells up to 12 x 12, a map with contours beyond.
    ///
    /// Between the stations the map is linear along the edges of the grid's cells.
    ///
    /// # Errors
    /// [`Error::NoData`], [`Error::Shape`], [`Error::Stations`] or [`Error::NotFinite`] for an invalid grid; the
    /// indices of the last error are row and column.
    pub fn svg(&self) -> Result<Svg, Error> {
        self.check()?;
        if self.at.len() <= TABLE && self.loads.len() <= TABLE {
            self.table()
        } else {
            self.map()
        }
    }

    /// One influence line for each load station, as a chart with deflections positive upwards as in the grid.
    ///
    /// # Errors
    /// As [`SurfacePlot::svg`].
    pub fn lines(&self) -> Result<Chart, Error> {
        self.check()?;
        let x = ChartAxis::new("position of the deflection", &self.length_unit);
        let mut chart = Chart::new(&self.title, x, ChartAxis::new(&self.label, &self.unit));
        for (column, load) in self.loads.iter().enumerate() {
            let points = self
                .at
                .iter()
                .zip(&self.values)
                .map(|(x, row)| [*x, row[column]])
                .collect();
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
            return Err(Error::Shape {
                row,
                columns,
                rows,
                expected,
            });
        }
        for stations in [&self.at, &self.loads] {
            let finite = stations.iter().position(|x| !x.is_finite());
            let ordered = stations
                .windows(2)
                .position(|p| p[0] >= p[1])
                .map(|i| i + 1);
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

    /// Draws title and label; `power` is the power of ten taken out of the values.
    fn heading(&self, area: &Area<'_>, power: i32) -> Result<(), Error> {
        group(area, "class=\"title\"", || {
            let below = sheet::title(area, std::slice::from_ref(&self.title))?;
            below.titled(
                &with_unit(&self.label, power, &self.unit),
                font(LABEL, INK, HPos::Center, VPos::Top),
            )?;
            Ok(())
        })
    }

    /// Values as a table: a chart over the indices of columns and rows, the stations as labels of its ticks.
    fn table(&self) -> Result<Svg, Error> {
        let (rows, columns) = (self.at.len() as f64, self.loads.len() as f64);
        let (low, high) = self.extent();
        let limit = low.abs().max(high.abs());
        let power = exponent(limit);
        let [width, height] = [((WIDTH - LEFT - RIGHT) / columns).min(CELL[0]), CELL[1]];
        let (left, top) = (
            LEFT + 0.5 * (WIDTH - LEFT - RIGHT - width * columns),
            BELOW_HEADING[0],
        );
        let note = wrap(&self.note, WIDTH - LEFT - RIGHT, SMALL);
        let end = top + height * rows;
        sheet::picture(WIDTH, end + 24.0 + NOTE_LINE * note.len() as f64, |area| {
            self.heading(area, power)?;
            let rectangle = [left, top, width * columns, height * rows];
            let coordinates = [
                cell_indices(&self.loads, false),
                cell_indices(&self.at, true),
            ];
            let mut cells = plot(area, rectangle, [37.0, 0.0, 72.0, 0.0], coordinates)?;
            group(area, "class=\"cells\"", || {
                self.draw_cells(&mut cells, limit, power)?;
                self.label_cells(&mut cells)
            })?;
            group(area, "class=\"note\"", || {
                sheet::note(area, &note, [LEFT, end + 14.0])
            })
        })
    }

    /// Draws all cells of the table, shaded relative to the largest absolute value `limit`, and then their values.
    fn draw_cells(&self, cells: &mut Plot<'_>, limit: f64, power: i32) -> Result<(), Error> {
        let relative = |value: f64| if limit > 0.0 { value / limit } else { 0.0 };
        let all = || {
            let rows = self.values.iter().enumerate();
            rows.flat_map(|(i, row)| {
                row.iter()
                    .enumerate()
                    .map(move |(j, v)| (j as f64, i as f64, *v))
            })
        };
        cells.draw_series(all().map(|(x, y, value)| {
            let corners = [(x, y), (x + 1.0, y + 1.0)];
            let mut cell = Rectangle::new(corners, shade(relative(value)).filled());
            let gap = units(GAP).unsigned_abs();
            cell.set_margin(0, gap, 0, gap);
            cell
        }))?;
        cells.draw_series(all().map(|(x, y, value)| {
            let ink = if relative(value).abs() > DARK {
                WHITE
            } else {
                INK
            };
            let style = font(SMALL, ink, HPos::Center, VPos::Center);
            Text::new(fixed(value, power, 2), (x + 0.5, y + 0.5), style)
        }))?;
        Ok(())
    }

    /// Draws the stations above the columns and to the left of the rows of the table.
    fn label_cells(&self, cells: &mut Plot<'_>) -> Result<(), Error> {
        let head = font(SMALL, INK, HPos::Center, VPos::Center);
        let unit = &self.length_unit;
        cells
            .configure_mesh()
            .disable_mesh()
            .axis_style(TRANSPARENT)
            .set_tick_mark_size(LabelAreaPosition::Top, units(3.0))
            .set_tick_mark_size(LabelAreaPosition::Left, units(5.0))
            .label_style(bold(head.clone()))
            .axis_desc_style(head)
            .x_desc(format!("load at ({unit})"))
            .y_desc(format!("deflection at ({unit})"))
            .draw()?;
        Ok(())
    }

    /// Values as bands of colour between contours.
    fn map(&self) -> Result<Svg, Error> {
        let (low, high) = self.extent();
        let limit = low.abs().max(high.abs());
        let power = exponent(limit);
        let axes = [
            ChartAxis::new("load at", &self.length_unit),
            ChartAxis::new("deflection at", &self.length_unit),
        ];
        let x = AxisScale::new(&axes[0], self.loads.iter().copied(), false)?;
        let y = AxisScale::new(&axes[1], self.at.iter().copied(), false)?;
        let is_reversed = [false; 2];
        let frame = PlotArea {
            left: LEFT,
            top: BELOW_HEADING[1],
            width: SIDE,
            height: SIDE,
            x,
            y,
            is_reversed,
        };
        let levels = levels(low, high);
        let note = if levels.iter().any(|v| *v < -1e-9 * limit) {
            format!("{} Contours below zero are dashed.", self.note)
        } else {
            self.note.clone()
        };
        let note = wrap(&note, WIDTH - LEFT - RIGHT, SMALL);
        let end = frame.bottom() + BELOW;
        sheet::picture(WIDTH, end + 12.0 + NOTE_LINE * note.len() as f64, |area| {
            self.heading(area, power)?;
            let mut map = frame.plot(area, [frame.x_ticks(), Ticks::new(&y, 10.0)])?;
            let colours = band_colours(&levels, low, high, limit);
            group(area, "class=\"bands\" stroke-linecap=\"round\"", || {
                self.draw_bands(&mut map, &frame, &levels, &colours, limit)
            })?;
            group(area, "class=\"scales\"", || {
                self.draw_supports(&mut map, &frame)?;
                frame::axes(&mut map, [&axes[0], &axes[1]])?;
                bar(area, &frame, &levels, &colours, power)
            })?;
            group(area, "class=\"note\"", || {
                sheet::note(area, &note, [LEFT, end + 6.0])
            })
        })
    }

    /// Draws the bands from the lowest on: the whole frame in the first colour, then for each level the region at or
    /// above it in the next colour, with its contour line. `limit` is the largest absolute value.
    fn draw_bands(
        &self,
        map: &mut Plot<'_>,
        frame: &PlotArea,
        levels: &[f64],
        colours: &[RGBColor],
        limit: f64,
    ) -> Result<(), Error> {
        let (x, y) = (frame.x, frame.y);
        let whole = [(x.low, y.low), (x.high, y.high)];
        map.plotting_area()
            .draw(&Rectangle::new(whole, colours[0].filled()))?;
        // values at supports are zero except for rounding, whose sign must not affect the contours
        let snap = |v: &f64| if v.abs() < 1e-12 * limit { 0.0 } else { *v };
        let values: Vec<Vec<f64>> = self
            .values
            .iter()
            .map(|row| row.iter().map(snap).collect())
            .collect();
        for (level, colour) in levels.iter().zip(&colours[1..]) {
            let found = region(&self.loads, &self.at, &values, *level);
            let is_zero = level.abs() < 1e-9 * limit;
            let lines = if *level < 0.0 && !is_zero {
                found.dashes
            } else {
                found.chords
            };
            let style = if is_zero {
                stroke(INK, 1.6)
            } else {
                stroke(GREY, 0.7)
            };
            map.draw_series([
                OnePath {
                    pieces: found.polygons.iter().map(|p| pairs(p).collect()).collect(),
                    style: colour.filled(),
                },
                OnePath {
                    pieces: lines.iter().map(|line| pairs(line).collect()).collect(),
                    style,
                },
            ])?;
        }
        Ok(())
    }

    /// Draws a vertical and a horizontal line through each support inside the frame.
    fn draw_supports(&self, map: &mut Plot<'_>, frame: &PlotArea) -> Result<(), Error> {
        let (x, y) = (frame.x, frame.y);
        let inside = self
            .supports
            .iter()
            .filter(|s| (x.low..=x.high).contains(s));
        map.draw_series(inside.flat_map(|s| {
            let (across, up) = ([(*s, y.low), (*s, y.high)], [(x.low, *s), (x.high, *s)]);
            [across, up].map(|ends| PathElement::new(ends, stroke(GREY, 1.0)))
        }))?;
        Ok(())
    }
}

/// Coordinate over the indices of rows or columns of a table, with the stations as labels.
fn cell_indices(stations: &[f64], is_reversed: bool) -> Coordinate {
    let values = (0..stations.len()).map(|i| i as f64 + 0.5).collect();
    let labels = stations.iter().map(|station| short(*station)).collect();
    let scale = AxisScale {
        low: 0.0,
        high: stations.len() as f64,
        log: false,
    };
    Coordinate {
        scale,
        ticks: Ticks {
            values,
            labels,
            exponent: 0,
        },
        is_reversed,
    }
}

/// Colours of the bands below, between and above the levels.
fn band_colours(levels: &[f64], low: f64, high: f64, limit: f64) -> Vec<RGBColor> {
    let middle = |k: usize| {
        let from = if k == 0 { low } else { levels[k - 1] };
        let to = levels.get(k).copied().unwrap_or(high);
        if limit > 0.0 {
            0.5 * (from + to) / limit
        } else {
            0.0
        }
    };
    (0..=levels.len()).map(|k| shade(middle(k))).collect()
}

/// Colour bar right of the map: a chart over the indices of the bands, with the levels as ticks between them.
fn bar(
    area: &Area<'_>,
    frame: &PlotArea,
    levels: &[f64],
    colours: &[RGBColor],
    power: i32,
) -> Result<(), Error> {
    let apart = if levels.len() > 1 {
        levels[1] - levels[0]
    } else {
        1.0
    };
    let decimals = (-(apart / 10f64.powi(power)).log10().floor()).clamp(0.0, 12.0) as usize;
    let coordinate = |high: f64, ticks| Coordinate {
        scale: AxisScale {
            low: 0.0,
            high,
            log: false,
        },
        ticks,
        is_reversed: false,
    };
    let values = (1..=levels.len()).map(|k| k as f64).collect();
    let labels = levels
        .iter()
        .map(|level| fixed(*level, power, decimals))
        .collect();
    let ticks = Ticks {
        values,
        labels,
        exponent: power,
    };
    let rectangle = [
        frame.left + frame.width + 36.0,
        frame.top,
        26.0,
        frame.height,
    ];
    let axes = [
        coordinate(1.0, Ticks::none()),
        coordinate(colours.len() as f64, ticks),
    ];
    let mut bar = plot(area, rectangle, [0.0, 0.0, 0.0, 80.0], axes)?;
    bar.draw_series(colours.iter().enumerate().map(|(k, colour)| {
        Rectangle::new([(0.0, k as f64), (1.0, k as f64 + 1.0)], colour.filled())
    }))?;
    bar.configure_mesh()
        .bold_line_style(stroke(GREY, 0.8))
        .axis_style(stroke(GREY, 0.8))
        .set_all_tick_mark_size(units(5.0))
        .label_style(font(SMALL, INK, HPos::Left, VPos::Center))
        .draw()?;
    frame::border(&bar)
}

/// Contour levels strictly between the ends, about a dozen.
fn levels(low: f64, high: f64) -> Vec<f64> {
    if low >= high {
        return Vec::new();
    }
    let step = step(low, high, 12.0);
    let first = (low / step + 1e-9).floor() + 1.0;
    let value = |i: i32| {
        if first + f64::from(i) == 0.0 {
            0.0
        } else {
            (first + f64::from(i)) * step
        }
    };
    (0..40)
        .map(value)
        .take_while(|v| *v < high - 1e-9 * step)
        .collect()
}
