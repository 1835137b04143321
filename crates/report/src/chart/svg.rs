//! The sheet a picture is drawn on: layers of plotters elements in tenths of a pixel.

use super::error::Error;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Drawing units a pixel.
const FINE: f64 = 10.0;
/// Coordinates beyond this many pixels are held at it.
const FAR: f64 = 1e5;
/// plotters divides the sizes of SVG text by this number.
const FONT_FACTOR: f64 = 1.24;
const FONT: &str = "Arial, Helvetica, sans-serif";

/// Sizes of text, in pixels.
pub(super) const TITLE: f64 = 16.0;
pub(super) const LABEL: f64 = 13.0;
pub(super) const SMALL: f64 = 12.0;

pub(super) const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
pub(super) const FAINT: RGBColor = RGBColor(0xdd, 0xdd, 0xdd);
pub(super) const GREY: RGBColor = RGBColor(0x66, 0x66, 0x66);

/// Line colours in the order of use; their greys alternate between dark and light.
const PALETTE: [RGBColor; 8] = [
    RGBColor(0x16, 0x16, 0x1d),
    RGBColor(0xd6, 0x5a, 0x0b),
    RGBColor(0x0b, 0x55, 0xa4),
    RGBColor(0x2f, 0xa8, 0x7a),
    RGBColor(0x8e, 0x1f, 0x4f),
    RGBColor(0xdb, 0xa5, 0x1a),
    RGBColor(0x5b, 0x3f, 0x9e),
    RGBColor(0x6f, 0xae, 0xd6),
];

/// Colour of the series with that index.
pub(super) fn colour(series: usize) -> RGBColor {
    PALETTE[series % PALETTE.len()]
}

/// Where a text's position lies in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Left,
    Middle,
    Right,
    /// Centred, reading upwards.
    Upwards,
}

/// A picture under construction; sizes and places in pixels.
pub(super) struct Sheet {
    width: f64,
    height: f64,
    body: String,
}

impl Sheet {
    pub fn new(width: f64, height: f64) -> Self {
        Sheet { width: width.ceil(), height: height.ceil(), body: String::new() }
    }

    /// Adds a layer: `draw` between `open` and `close`.
    pub fn layer(
        &mut self,
        open: &str,
        close: &str,
        draw: impl FnOnce(&Pen<'_>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let mut text = String::new();
        {
            let size = ((self.width * FINE) as u32, (self.height * FINE) as u32);
            let pen = Pen { area: SVGBackend::with_string(&mut text, size).into_drawing_area() };
            draw(&pen)?;
            pen.area.present().map_err(|_| Error::Drawing)?;
        }
        let inner = text.split_once(">\n").and_then(|(_, rest)| rest.trim_end().strip_suffix("</svg>"));
        self.body.push_str(open);
        self.body.push_str(&compact(inner.ok_or(Error::Drawing)?));
        self.body.push_str(close);
        Ok(())
    }

    /// Adds a group with attributes.
    pub fn group(
        &mut self,
        attributes: &str,
        draw: impl FnOnce(&Pen<'_>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        self.layer(&format!("<g {attributes}>\n"), "</g>\n", draw)
    }

    /// Adds a group clipped to a rectangle: an inner viewport, which needs no name.
    pub fn clipped(
        &mut self,
        attributes: &str,
        [left, top, width, height]: [f64; 4],
        draw: impl FnOnce(&Pen<'_>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let [x, y, w, h] = [left, top, width, height].map(|v| (v * FINE).round());
        let open = format!(
            "<svg {attributes} x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" viewBox=\"{x} {y} {w} {h}\">\n"
        );
        self.layer(&open, "</svg>\n", draw)
    }

    /// Fills an area made of polygons that touch: one path, since neighbours drawn apart show hairlines.
    pub fn area(&mut self, polygons: &[Vec<[f64; 2]>], colour: RGBColor) {
        let pieces = polygons.iter().map(|p| outline(p) + "Z").collect::<String>();
        let RGBColor(r, g, b) = colour;
        self.body.push_str(&format!("<path fill=\"#{r:02X}{g:02X}{b:02X}\" d=\"{pieces}\"/>\n"));
    }

    /// Draws many short lines of one kind as one path.
    pub fn strokes(&mut self, lines: &[[[f64; 2]; 2]], colour: RGBColor, width: f64) {
        let pieces = lines.iter().map(|l| outline(l)).collect::<String>();
        let RGBColor(r, g, b) = colour;
        self.body.push_str(&format!(
            "<path fill=\"none\" stroke-linecap=\"round\" stroke=\"#{r:02X}{g:02X}{b:02X}\" \
             stroke-width=\"{}\" d=\"{pieces}\"/>\n",
            width * FINE
        ));
    }

    /// The picture as an SVG file.
    pub fn finish(self) -> String {
        let (w, h) = (self.width, self.height);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {} {}\" \
             font-family=\"{FONT}\" stroke-linejoin=\"round\">\n<rect width=\"100%\" height=\"100%\" fill=\"#FFFFFF\"/>\n{}</svg>\n",
            w * FINE,
            h * FINE,
            self.body
        )
    }
}

/// Draws on one layer; places in pixels.
pub(super) struct Pen<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
}

impl Pen<'_> {
    pub fn line(&self, points: &[[f64; 2]], colour: RGBColor, width: f64) -> Result<(), Error> {
        let style = colour.stroke_width((width * FINE).round() as u32);
        let points: Vec<_> = points.iter().map(fine).collect();
        self.area.draw(&PathElement::new(points, style)).map_err(|_| Error::Drawing)
    }

    pub fn polygon(&self, points: &[[f64; 2]], colour: RGBColor) -> Result<(), Error> {
        let points: Vec<_> = points.iter().map(fine).collect();
        self.area.draw(&Polygon::new(points, colour.filled())).map_err(|_| Error::Drawing)
    }

    pub fn rectangle(&self, [left, top, width, height]: [f64; 4], colour: RGBColor) -> Result<(), Error> {
        let corners = [fine(&[left, top]), fine(&[left + width, top + height])];
        self.area.draw(&Rectangle::new(corners, colour.filled())).map_err(|_| Error::Drawing)
    }

    pub fn disc(&self, at: [f64; 2], radius: f64, colour: RGBColor) -> Result<(), Error> {
        let size = (radius * FINE).round() as i32;
        self.area.draw(&Circle::new(fine(&at), size, colour.filled())).map_err(|_| Error::Drawing)
    }

    /// Text centred vertically on `at`.
    pub fn text(
        &self,
        text: &str,
        at: [f64; 2],
        anchor: Anchor,
        size: f64,
        bold: bool,
        colour: RGBColor,
    ) -> Result<(), Error> {
        let font = FontDesc::new(
            FontFamily::Name(FONT),
            size * FINE * FONT_FACTOR,
            if bold { FontStyle::Bold } else { FontStyle::Normal },
        );
        let (font, across) = match anchor {
            Anchor::Left => (font, HPos::Left),
            Anchor::Middle => (font, HPos::Center),
            Anchor::Right => (font, HPos::Right),
            Anchor::Upwards => (font.transform(FontTransform::Rotate270), HPos::Center),
        };
        let style = TextStyle::from(font).color(&colour).pos(Pos::new(across, VPos::Center));
        self.area.draw(&Text::new(text, fine(&at), style)).map_err(|_| Error::Drawing)
    }
}

/// Path data of an open polyline, relative after the first point.
fn outline(points: &[[f64; 2]]) -> String {
    let mut corners = points.iter().map(fine);
    let Some(first) = corners.next() else { return String::new() };
    let mut text = format!("M{} {}", first.0, first.1);
    let (mut last, mut letter) = (first, ' ');
    for here in corners {
        let (own, steps) = match (here.0 - last.0, here.1 - last.1) {
            (x, 0) => ('h', [Some(x), None]),
            (0, y) => ('v', [Some(y), None]),
            (x, y) => ('l', [Some(x), Some(y)]),
        };
        if own != letter {
            text.push(own);
        }
        push_steps(&mut text, steps.into_iter().flatten());
        (last, letter) = (here, own);
    }
    text
}

/// Adds numbers to path data, parted by a sign, a letter or a blank.
fn push_steps(text: &mut String, steps: impl IntoIterator<Item = i32>) {
    for step in steps {
        if step >= 0 && text.ends_with(|last: char| last.is_ascii_digit()) {
            text.push(' ');
        }
        text.push_str(&step.to_string());
    }
}

const SIZE: &str = " font-size=\"";

/// The same elements in fewer characters: without attributes that say what holds anyway, curves as paths from corner to corner.
fn compact(elements: &str) -> String {
    let mut text = elements.to_owned();
    for idle in [" opacity=\"1\"", " stroke=\"none\" stroke-width=\"1\"", " stroke=\"none\""] {
        text = text.replace(idle, "");
    }
    text = text.replace(&format!(" font-family=\"{FONT}\""), "");
    let mut short = String::with_capacity(text.len());
    for line in text.lines() {
        let curve = line.strip_prefix("<polyline ").and_then(|rest| rest.split_once(" points=\""));
        match curve.and_then(|(style, points)| Some((style, path(points.strip_suffix("\"/>")?)?))) {
            Some((style, (path, corners))) => {
                // a straight line has nothing to fill
                let style =
                    if corners == 2 { style.strip_prefix("fill=\"none\" ").unwrap_or(style) } else { style };
                short.push_str(&format!("<path {style} d=\"{path}\"/>"));
            }
            None => match line.split_once(SIZE).and_then(|(a, rest)| Some((a, rest.split_once('"')?))) {
                Some((before, (size, after))) => {
                    let size = size
                        .parse()
                        .map_or_else(|_| size.to_owned(), |size: f64| format!("{}", size.round()));
                    short.push_str(&format!("{before}{SIZE}{size}\"{after}"));
                }
                None => short.push_str(line),
            },
        }
        short.push('\n');
    }
    short
}

/// Path data of `points` as SVG has them, whole numbers, and how many there are; `None`: no such list, or a point alone.
fn path(points: &str) -> Option<(String, usize)> {
    let corners: Option<Vec<(i32, i32)>> = points
        .split_whitespace()
        .map(|point| {
            let (x, y) = point.split_once(',')?;
            Some((x.parse().ok()?, y.parse().ok()?))
        })
        .collect();
    let corners = corners.filter(|corners| corners.len() > 1)?;
    let (x, y) = corners[0];
    let mut text = format!("M{x} {y}l");
    for pair in corners.windows(2) {
        push_steps(&mut text, [pair[1].0 - pair[0].0, pair[1].1 - pair[0].1]);
    }
    Some((text, corners.len()))
}

fn fine(point: &[f64; 2]) -> (i32, i32) {
    let whole = |v: f64| (v.clamp(-FAR, FAR) * FINE).round() as i32;
    (whole(point[0]), whole(point[1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_goes_through_the_corners_of_its_polyline() {
        let points = "10,20 12,20 12,5 0,5 0,-3 7,-3 8,-10 8,0 9,0 ";
        let (path, corners) = path(points).expect("a list");
        assert_eq!(corners, 9);
        assert_eq!(path, "M10 20l2 0 0-15-12 0 0-8 7 0 1-7 0 10 1 0");
        let line = format!("<polyline fill=\"none\" opacity=\"1\" stroke=\"#16161D\" points=\"{points}\"/>");
        assert_eq!(compact(&line), format!("<path fill=\"none\" stroke=\"#16161D\" d=\"{path}\"/>\n"));
    }

    #[test]
    fn an_outline_says_level_and_upright_steps_by_one_number() {
        let points = [[1.0, 2.0], [3.0, 2.0], [3.0, 1.5], [3.0, 1.0], [2.0, 0.5], [1.0, 0.7], [1.0, 0.7]];
        assert_eq!(outline(&points), "M10 20h20v-5-5l-10-5-10 2h0");
        assert_eq!(outline(&[]), "");
    }

    #[test]
    fn other_elements_lose_what_holds_anyway() {
        let line = "<polyline fill=\"none\" stroke=\"#222222\" points=\"1,2 3,4 \"/>";
        assert_eq!(compact(line), "<path stroke=\"#222222\" d=\"M1 2l2 2\"/>\n");
        let disc = "<circle cx=\"1\" cy=\"2\" r=\"36\" opacity=\"1\" fill=\"#FFFFFF\" stroke=\"none\" stroke-width=\"1\"/>";
        assert_eq!(compact(disc), "<circle cx=\"1\" cy=\"2\" r=\"36\" fill=\"#FFFFFF\"/>\n");
    }
}
