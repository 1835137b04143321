//! Side view of a girder: members, rail, supports, stations, loads and the deflected shape.

use super::error::Error;
use super::frame::WIDTH;
use super::legend::Legend;
use super::scale::{extent, step};
use super::series::{Series, Style};
use super::surface_plot::short;
use super::svg::{Anchor, GREY, INK, Pen, SMALL, Sheet, TITLE, colour};
use super::text::{text_width, wrap};

const MARGIN: f64 = 46.0;
/// The largest deflection is drawn about this share of the girder's length where no factor is given.
const SAG: f64 = 0.07;

/// A support of the side view.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Support {
    /// (x, y) of the supported point.
    pub at: [f64; 2],
    /// The support holds the length too; otherwise it is drawn as a roller.
    pub holds_length: bool,
}

/// A deflected shape.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deflected {
    /// Name in the legend.
    pub label: String,
    /// Points at rest, (x, y).
    pub at: Vec<[f64; 2]>,
    /// Displacement of each point, in the same unit, y positive upwards.
    pub by: Vec<[f64; 2]>,
    /// Factor of exaggeration; chosen where absent.
    pub factor: Option<f64>,
}

/// Side view of a girder, drawn to one scale.
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
    pub supports: Vec<Support>,
    /// Stations on the rail.
    pub stations: Vec<[f64; 2]>,
    /// Loads, drawn as arrows that end at these points.
    pub loads: Vec<[f64; 2]>,
    /// Deflected shape.
    pub deflected: Option<Deflected>,
    /// Small print below the picture.
    pub note: String,
}

/// Placement of the structure on the sheet, with one scale for both directions.
struct View {
    scale: f64,
    left: f64,
    right: f64,
    /// Pixel row of y = 0.
    base: f64,
    origin: f64,
}

impl View {
    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [MARGIN + (x - self.origin) * self.scale, self.base - y * self.scale]
    }
}

impl GirderPlot {
    /// The side view as an SVG file; the factor of the deflected shape stands in the legend.
    ///
    /// # Errors
    /// [`Error::NoData`] without members, [`Error::NotFinite`] (series counts members, then rail, supports,
    /// stations, loads, deflected points) and [`Error::Range`] where all points lie at one x.
    pub fn svg(&self) -> Result<String, Error> {
        self.check()?;
        let shape = self.shape();
        let mut entries = vec![Series::new("elastic axis", Style::Line, Vec::new())];
        let mut add = |present: bool, label: String, style| {
            present.then(|| {
                entries.push(Series::new(label, style, Vec::new()));
                entries.len() - 1
            })
        };
        let rail = add(!self.rail.is_empty(), "rail".into(), Style::Line);
        let stations = add(!self.stations.is_empty(), "stations".into(), Style::Points);
        let deflected = shape.as_ref().and_then(|(label, _)| add(true, label.clone(), Style::Dashed));

        let title = wrap(&self.title, WIDTH - 40.0, TITLE);
        let top = 14.0 + 22.0 * title.len() as f64;
        let legend = Legend::new(&entries, MARGIN, WIDTH - MARGIN, top, false);
        let (view, end) = self.view(top + legend.height, shape.as_ref().map(|s| s.1.as_slice()))?;
        let note = wrap(&self.note, WIDTH - 2.0 * MARGIN, SMALL);
        let mut sheet = Sheet::new(WIDTH, end + 42.0 + 16.0 * note.len() as f64);
        sheet.group("class=\"structure\" stroke-linecap=\"round\"", |pen| {
            for member in &self.members {
                let path: Vec<_> = member.iter().map(|p| view.place(*p)).collect();
                pen.line(&path, colour(0), 4.0)?;
            }
            if let Some(index) = rail {
                let path: Vec<_> = self.rail.iter().map(|p| view.place(*p)).collect();
                pen.line(&path, colour(index), 2.4)?;
            }
            self.supports.iter().try_for_each(|s| support(pen, view.place(s.at), s.holds_length))
        })?;
        if let (Some(index), Some((_, path))) = (deflected, &shape) {
            let path: Vec<_> = path.iter().map(|p| view.place(*p)).collect();
            sheet.group("stroke-dasharray=\"80 50\"", |pen| pen.line(&path, colour(index), 2.0))?;
        }
        sheet.group("class=\"labels\"", |pen| {
            if let Some(index) = stations {
                self.mark_stations(pen, &view, index)?;
            }
            self.loads.iter().try_for_each(|at| arrow(pen, view.place(*at)))?;
            self.dimensions(pen, &view, end + 12.0)?;
            for (i, line) in title.iter().enumerate() {
                pen.text(line, [0.5 * WIDTH, 17.0 + 22.0 * i as f64], Anchor::Middle, TITLE, true, INK)?;
            }
            note.iter().enumerate().try_for_each(|(i, line)| {
                let at = [MARGIN, end + 42.0 + 16.0 * i as f64];
                pen.text(line, at, Anchor::Left, SMALL, false, GREY)
            })
        })?;
        legend.draw(&mut sheet, &entries)?;
        Ok(sheet.finish())
    }

    fn check(&self) -> Result<(), Error> {
        let empty = Vec::new();
        let (at, by) = self.deflected.as_ref().map_or((&empty, &empty), |d| (&d.at, &d.by));
        let supports: Vec<_> = self.supports.iter().map(|s| s.at).collect();
        let rest = [&self.rail, &supports, &self.stations, &self.loads, at, by];
        for (series, points) in self.members.iter().chain(rest).enumerate() {
            if let Some(point) = points.iter().position(|p| !(p[0].is_finite() && p[1].is_finite())) {
                return Err(Error::NotFinite { series, point });
            }
        }
        if at.len() != by.len() {
            return Err(Error::Shape { row: 1, columns: by.len(), rows: 2, expected: at.len() });
        }
        if self.members.iter().all(Vec::is_empty) { Err(Error::NoData) } else { Ok(()) }
    }

    fn ends(&self) -> (f64, f64) {
        extent(self.members.iter().chain([&self.rail]).flatten().map(|p| p[0]))
    }

    /// Legend text and exaggerated points of the deflected shape.
    fn shape(&self) -> Option<(String, Vec<[f64; 2]>)> {
        let shape = self.deflected.as_ref().filter(|d| !d.at.is_empty())?;
        let largest = shape.by.iter().map(|b| b[0].hypot(b[1])).fold(0.0, f64::max);
        let (left, right) = self.ends();
        let wanted = SAG * (right - left) / largest;
        let chosen = if wanted.is_finite() && wanted > 0.0 { step(0.0, wanted, 1.0) } else { 1.0 };
        let factor = shape.factor.unwrap_or(chosen);
        let points = shape.at.iter().zip(&shape.by);
        let points = points.map(|(a, b)| [a[0] + factor * b[0], a[1] + factor * b[1]]).collect();
        Some((format!("{}, displacements x {factor}", shape.label), points))
    }

    /// Scale of the picture, and the pixel row below all that is drawn to scale.
    fn view(&self, top: f64, shape: Option<&[[f64; 2]]>) -> Result<(View, f64), Error> {
        let (left, right) = self.ends();
        let scale = (WIDTH - 2.0 * MARGIN) / (right - left);
        if !(scale.is_finite() && scale > 0.0) {
            return Err(Error::Range { low: left, high: right });
        }
        let all = self.members.iter().chain([&self.rail, &self.stations, &self.loads]).flatten();
        let all = all.chain(shape.unwrap_or(&[])).chain(self.supports.iter().map(|s| &s.at));
        let (low, high) = extent(all.map(|p| p[1]));
        let above = if self.loads.is_empty() { 30.0 } else { 56.0 };
        let base = top + above + high * scale;
        let end = base - low * scale + 34.0;
        if !(end.is_finite() && end < 4000.0) {
            return Err(Error::Range { low, high });
        }
        Ok((View { scale, left, right, base, origin: left }, end))
    }

    /// Symbols on the rail, and coordinates above it as far as there is room.
    fn mark_stations(&self, pen: &Pen<'_>, view: &View, index: usize) -> Result<(), Error> {
        let mut free = f64::NEG_INFINITY;
        for station in &self.stations {
            let at = view.place(*station);
            super::legend::symbol(pen, index, at, 3.4)?;
            let text = short(station[0]);
            let half = 0.5 * text_width(&text, SMALL);
            if at[0] - half > free {
                pen.text(&text, [at[0], at[1] - 15.0], Anchor::Middle, SMALL, false, INK)?;
                free = at[0] + half + 6.0;
            }
        }
        Ok(())
    }

    /// Chain of dimensions from end to end over the supports.
    fn dimensions(&self, pen: &Pen<'_>, view: &View, row: f64) -> Result<(), Error> {
        let mut stops: Vec<f64> =
            self.supports.iter().map(|s| s.at[0]).chain([view.left, view.right]).collect();
        stops.sort_by(f64::total_cmp);
        let tiny = 1e-9 * (view.right - view.left);
        stops.dedup_by(|a, b| (*a - *b).abs() <= tiny);
        let places: Vec<f64> = stops.iter().map(|x| view.place([*x, 0.0])[0]).collect();
        for (pair, from) in places.windows(2).zip(stops.windows(2)) {
            pen.line(&[[pair[0], row], [pair[1], row]], GREY, 0.9)?;
            let text = format!("{} {}", short(from[1] - from[0]), self.length_unit);
            if text_width(&text, SMALL) < pair[1] - pair[0] {
                pen.text(&text, [0.5 * (pair[0] + pair[1]), row + 11.0], Anchor::Middle, SMALL, false, GREY)?;
            }
        }
        places.iter().try_for_each(|x| pen.line(&[[x - 4.0, row + 4.0], [x + 4.0, row - 4.0]], GREY, 1.2))
    }
}

/// Triangle under a supported point: on hatched ground, or on rollers.
fn support(pen: &Pen<'_>, at: [f64; 2], fixed: bool) -> Result<(), Error> {
    let foot = at[1] + 16.0;
    pen.polygon(&[[at[0], at[1] + 2.0], [at[0] - 9.0, foot], [at[0] + 9.0, foot]], GREY)?;
    let ground = if fixed { foot } else { foot + 6.0 };
    if !fixed {
        pen.disc([at[0] - 5.5, foot + 3.0], 2.6, GREY)?;
        pen.disc([at[0] + 5.5, foot + 3.0], 2.6, GREY)?;
    }
    pen.line(&[[at[0] - 14.0, ground], [at[0] + 14.0, ground]], GREY, 1.2)?;
    (0..5).try_for_each(|i| {
        let x = at[0] - 10.0 + 6.0 * f64::from(i);
        pen.line(&[[x, ground], [x - 5.0, ground + 5.0]], GREY, 0.9)
    })
}

/// Arrow that ends at the point from above.
fn arrow(pen: &Pen<'_>, at: [f64; 2]) -> Result<(), Error> {
    let tip = at[1] - 4.0;
    pen.line(&[[at[0], tip - 40.0], [at[0], tip - 6.0]], INK, 1.8)?;
    pen.polygon(&[[at[0], tip], [at[0] - 4.5, tip - 10.0], [at[0] + 4.5, tip - 10.0]], INK)
}
