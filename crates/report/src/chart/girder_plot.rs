//! Side view of a girder: members, rail, supports, stations, loads and the deflected shape.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::coordinate::Coordinate;
use super::elements::Symbol;
use super::error::Error;
use super::frame::{Plot, PlotArea, pairs, plot};
use super::label::short;
use super::legend::{Legend, dashes};
use super::palette::{GREY, INK, colour};
use super::scale::{AxisScale, extent, step};
use super::series::{Series, Style};
use super::sheet::{self, Area, NOTE_LINE, SMALL, TITLE, TITLE_LINE, WIDTH, font, group, stroke};
use super::svg::{FINE, Svg};
use super::text::{text_width, wrap};
use super::ticks::Ticks;

/// Margin at both ends of the girder, in pixels.
const MARGIN: f64 = 46.0;
/// Size of the largest deflection in the picture as a fraction of the length of the girder, if no factor is given.
const DRAWN_DEFLECTION: f64 = 0.07;
/// Largest height of the frame, in pixels.
const TALLEST: f64 = 4000.0;
/// Distance of a label from the arrow of a load, in pixels.
const ARROW: f64 = 6.0;
/// Radius of the symbols of stations, in pixels.
const RADIUS: f64 = 3.4;

/// A support of the side view.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SupportMark {
    /// (x, y) of the supported point.
    pub at: [f64; 2],
    /// The support restrains the longitudinal direction too; otherwise it is drawn as a roller.
    pub is_fixed_lengthwise: bool,
}

/// A deflected shape.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deflected {
    /// Name in the legend.
    pub label: String,
    /// Points of the undeformed shape, (x, y).
    pub at: Vec<[f64; 2]>,
    /// Displacement of each point, in the same unit, y positive upwards.
    pub by: Vec<[f64; 2]>,
    /// Factor by which displacements are exaggerated; `None`: chosen from the length of the girder.
    pub factor: Option<f64>,
}

/// Side view of a girder, drawn to one scale.
///
/// ```
/// use report::chart::{GirderPlot, SupportMark};
///
/// let girder = GirderPlot {
///     title: "Girder".into(),
///     length_unit: "m".into(),
///     members: vec![vec![[0.0, 0.0], [12.0, 0.0]]],
///     supports: vec![
///         SupportMark { at: [0.0, 0.0], is_fixed_lengthwise: true },
///         SupportMark { at: [12.0, 0.0], is_fixed_lengthwise: false },
///     ],
///     ..GirderPlot::default()
/// };
/// assert!(girder.svg()?.file().contains("12 m"));
/// # Ok::<(), report::chart::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GirderPlot {
    /// Heading.
    pub title: String,
    /// Unit of all lengths.
    pub length_unit: String,
    /// Elastic axes of the members, as polylines (x, y), y upwards.
    pub members: Vec<Vec<[f64; 2]>>,
    /// Rail as a polyline.
    pub rail: Vec<[f64; 2]>,
    /// Supports.
    pub supports: Vec<SupportMark>,
    /// Stations on the rail.
    pub stations: Vec<[f64; 2]>,
    /// Loads, drawn as arrows that end at these points.
    pub loads: Vec<[f64; 2]>,
    /// Deflected shape.
    pub deflected: Option<Deflected>,
    /// Note below the picture, in small letters.
    pub note: String,
}

impl GirderPlot {
    /// The side view as a picture; the legend states the factor of the deflected shape.
    ///
    /// # Errors
    /// [`Error::NoData`] without members, [`Error::NotFinite`] (series counts members, then rail, supports,
    /// stations, loads, deflected points) and [`Error::Range`] where all points lie at one x.
    pub fn svg(&self) -> Result<Svg, Error> {
        self.check()?;
        let shape = self.shape();
        let mut entries = vec![Series::new("elastic axis", Style::Line, Vec::new())];
        let mut add = |is_present: bool, label: String, style| {
            is_present.then(|| {
                entries.push(Series::new(label, style, Vec::new()));
                entries.len() - 1
            })
        };
        let rail = add(!self.rail.is_empty(), "rail".into(), Style::Line);
        let stations = add(!self.stations.is_empty(), "stations".into(), Style::Points);
        let deflected = shape
            .as_ref()
            .and_then(|(label, _)| add(true, label.clone(), Style::Dashed));

        let title = wrap(&self.title, WIDTH - 40.0, TITLE);
        let top = 14.0 + TITLE_LINE * title.len() as f64;
        let legend = Legend::new(&entries, MARGIN, WIDTH - MARGIN, top, false);
        let frame = self.frame(top + legend.height, shape.as_ref().map(|s| s.1.as_slice()))?;
        let note = wrap(&self.note, WIDTH - 2.0 * MARGIN, SMALL);
        let end = frame.bottom();
        sheet::picture(WIDTH, end + 42.0 + NOTE_LINE * note.len() as f64, |area| {
            let plain = |scale| Coordinate {
                scale,
                ticks: Ticks::none(),
                is_reversed: false,
            };
            let mut view = plot(
                area,
                frame.around(0.0),
                [0.0; 4],
                [plain(frame.x), plain(frame.y)],
            )?;
            group(area, "class=\"structure\" stroke-linecap=\"round\"", || {
                for member in &self.members {
                    view.draw_series(LineSeries::new(pairs(member), stroke(colour(0), 4.0)))?;
                }
                if let Some(index) = rail {
                    view.draw_series(LineSeries::new(
                        pairs(&self.rail),
                        stroke(colour(index), 2.4),
                    ))?;
                }
                view.draw_series(
                    self.supports
                        .iter()
                        .map(|s| Symbol::support((s.at[0], s.at[1]), s.is_fixed_lengthwise)),
                )?;
                Ok(())
            })?;
            if let (Some(index), Some((_, path))) = (deflected, &shape) {
                group(area, dashes(Style::Dashed).trim_start(), || {
                    view.draw_series(LineSeries::new(pairs(path), stroke(colour(index), 2.0)))?;
                    Ok(())
                })?;
            }
            group(area, "class=\"labels\"", || {
                if let Some(index) = stations {
                    self.mark_stations(area, &mut view, &frame, index)?;
                }
                view.draw_series(pairs(&self.loads).map(Symbol::load))?;
                self.dimensions(area, &frame)?;
                sheet::title(area, &title)?;
                sheet::note(area, &note, [MARGIN, end + 42.0])
            })?;
            legend.draw(area, &entries)
        })
    }

    fn check(&self) -> Result<(), Error> {
        let empty = Vec::new();
        let (at, by) = self
            .deflected
            .as_ref()
            .map_or((&empty, &empty), |d| (&d.at, &d.by));
        let supports: Vec<_> = self.supports.iter().map(|s| s.at).collect();
        let rest = [&self.rail, &supports, &self.stations, &self.loads, at, by];
        for (series, points) in self.members.iter().chain(rest).enumerate() {
            if let Some(point) = points
                .iter()
                .position(|p| !(p[0].is_finite() && p[1].is_finite()))
            {
                return Err(Error::NotFinite { series, point });
            }
        }
        if at.len() != by.len() {
            return Err(Error::Shape {
                row: 1,
                columns: by.len(),
                rows: 2,
                expected: at.len(),
            });
        }
        if self.members.iter().all(Vec::is_empty) {
            Err(Error::NoData)
        } else {
            Ok(())
        }
    }

    fn ends(&self) -> (f64, f64) {
        extent(
            self.members
                .iter()
                .chain([&self.rail])
                .flatten()
                .map(|p| p[0]),
        )
    }

    /// Legend text and exaggerated points of the deflected shape.
    fn shape(&self) -> Option<(String, Vec<[f64; 2]>)> {
        let shape = self.deflected.as_ref().filter(|d| !d.at.is_empty())?;
        let largest = shape
            .by
            .iter()
            .map(|b| b[0].hypot(b[1]))
            .fold(0.0, f64::max);
        let (left, right) = self.ends();
        let wanted = DRAWN_DEFLECTION * (right - left) / largest;
        let chosen = if wanted.is_finite() && wanted > 0.0 {
            step(0.0, wanted, 1.0)
        } else {
            1.0
        };
        let factor = shape.factor.unwrap_or(chosen);
        let points = shape.at.iter().zip(&shape.by);
        let points = points
            .map(|(a, b)| [a[0] + factor * b[0], a[1] + factor * b[1]])
            .collect();
        Some((format!("{}, displacements x {factor}", shape.label), points))
    }

    /// Frame with one scale for both directions; `top` is the ordinate of its upper edge.
    fn frame(&self, top: f64, shape: Option<&[[f64; 2]]>) -> Result<PlotArea, Error> {
        let (left, right) = self.ends();
        let scale = (WIDTH - 2.0 * MARGIN) / (right - left);
        if !(scale.is_finite() && scale > 0.0) {
            return Err(Error::Range {
                low: left,
                high: right,
            });
        }
        let all = self
            .members
            .iter()
            .chain([&self.rail, &self.stations, &self.loads])
            .flatten();
        let all = all
            .chain(shape.unwrap_or(&[]))
            .chain(self.supports.iter().map(|s| &s.at));
        let (low, high) = extent(all.map(|p| p[1]));
        let above = if self.loads.is_empty() { 30.0 } else { 56.0 };
        let below = 34.0;
        let height = above + (high - low) * scale + below;
        if !(height.is_finite() && top + height < TALLEST) {
            return Err(Error::Range { low, high });
        }
        let x = AxisScale {
            low: left,
            high: right,
            log: false,
        };
        let y = AxisScale {
            low: low - below / scale,
            high: high + above / scale,
            log: false,
        };
        Ok(PlotArea {
            left: MARGIN,
            top,
            width: WIDTH - 2.0 * MARGIN,
            height,
            x,
            y,
            is_reversed: [false; 2],
        })
    }

    /// Draws symbols of the stations, and their coordinates above them where labels overlap neither each other nor loads.
    fn mark_stations(
        &self,
        area: &Area<'_>,
        view: &mut Plot<'_>,
        frame: &PlotArea,
        index: usize,
    ) -> Result<(), Error> {
        view.draw_series(
            pairs(&self.stations).map(|at| Symbol::of_series(index, at, RADIUS * FINE)),
        )?;
        let style = font(SMALL, INK, HPos::Center, VPos::Center);
        let mut free = f64::NEG_INFINITY;
        let arrows: Vec<f64> = self
            .loads
            .iter()
            .map(|load| frame.place(*load)[0])
            .collect();
        for station in &self.stations {
            let [x, y] = frame.place(*station);
            let text = short(station[0]);
            let half = 0.5 * text_width(&text, SMALL);
            let is_under_arrow = arrows.iter().any(|arrow| (arrow - x).abs() < half + ARROW);
            if x - half > free && !is_under_arrow {
                sheet::text(area, &text, [x, y - 15.0], &style)?;
                free = x + half + 6.0;
            }
        }
        Ok(())
    }

    /// Draws a chain of dimensions below the frame, between the ends of the girder and its supports.
    fn dimensions(&self, area: &Area<'_>, frame: &PlotArea) -> Result<(), Error> {
        let (left, right) = self.ends();
        let mut stops: Vec<f64> = self
            .supports
            .iter()
            .map(|s| s.at[0])
            .chain([left, right])
            .collect();
        stops.sort_by(f64::total_cmp);
        let tiny = 1e-9 * (right - left);
        stops.dedup_by(|a, b| (*a - *b).abs() <= tiny);
        let row = frame.bottom() + 12.0;
        let style = font(SMALL, GREY, HPos::Center, VPos::Center);
        let places: Vec<f64> = stops.iter().map(|x| frame.place([*x, 0.0])[0]).collect();
        for (pair, from) in places.windows(2).zip(stops.windows(2)) {
            sheet::line(area, &[[pair[0], row], [pair[1], row]], stroke(GREY, 0.9))?;
            let text = format!("{} {}", short(from[1] - from[0]), self.length_unit);
            if text_width(&text, SMALL) < pair[1] - pair[0] {
                sheet::text(area, &text, [0.5 * (pair[0] + pair[1]), row + 11.0], &style)?;
            }
        }
        places.iter().try_for_each(|x| {
            sheet::line(
                area,
                &[[x - 4.0, row + 4.0], [x + 4.0, row - 4.0]],
                stroke(GREY, 1.2),
            )
        })
    }
}
