//! The sheet of a picture: a drawing area of plotters over [`SvgBackend`], with positions in pixels.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::backend::SvgBackend;
use super::elements::Tag;
use super::error::Error;
use super::palette::{GREY, INK};
use super::svg::{FINE, Svg};

/// Width of a picture in pixels.
pub(super) const WIDTH: f64 = 860.0;
/// Largest magnitude of a coordinate in drawing units; larger ones are set to it.
pub(super) const LARGEST: f64 = 1e6;
/// Height of a line of a title in pixels.
pub(super) const TITLE_LINE: f64 = 22.0;
/// Height of a line of a note in pixels.
pub(super) const NOTE_LINE: f64 = 16.0;
/// Space above a title in pixels.
const ABOVE_TITLE: f64 = 8.5;

/// Size of the text of titles, in pixels.
pub(super) const TITLE: f64 = 16.0;
/// Size of the labels of axes, in pixels.
pub(super) const LABEL: f64 = 13.0;
/// Size of all other text, in pixels.
pub(super) const SMALL: f64 = 12.0;

/// A drawing area in drawing units from its upper left corner.
pub(super) type Area<'s> = DrawingArea<SvgBackend<'s>, Shift>;

/// A picture of `width` by `height` pixels, rounded up, with the content that `draw` adds.
pub(super) fn picture(
    width: f64,
    height: f64,
    draw: impl FnOnce(&Area<'_>) -> Result<(), Error>,
) -> Result<Svg, Error> {
    let (width, height) = (width.ceil(), height.ceil());
    let mut elements = String::new();
    {
        let size = ((width * FINE) as u32, (height * FINE) as u32);
        let area = SvgBackend::new(&mut elements, size).into_drawing_area();
        draw(&area)?;
        area.present()?;
    }
    Ok(Svg::new(width, height, elements))
}

/// Drawing units of a length in pixels.
pub(super) fn units(pixels: f64) -> i32 {
    (pixels * FINE).clamp(-LARGEST, LARGEST).round() as i32
}

/// A place in drawing units.
pub(super) fn place([x, y]: [f64; 2]) -> (i32, i32) {
    (units(x), units(y))
}

/// Style of a line of that width in pixels.
pub(super) fn stroke(colour: RGBColor, width: f64) -> ShapeStyle {
    colour.stroke_width(units(width).unsigned_abs())
}

/// Style of text of a size in pixels. `across` and `down` select the point of its box that is at its position.
pub(super) fn font(size: f64, colour: RGBColor, across: HPos, down: VPos) -> TextStyle<'static> {
    let font = FontDesc::new(FontFamily::SansSerif, size * FINE, FontStyle::Normal);
    TextStyle {
        color: colour.to_backend_color(),
        ..TextStyle::from(font)
    }
    .pos(Pos::new(across, down))
}

/// The same style in bold.
pub(super) fn bold(style: TextStyle<'static>) -> TextStyle<'static> {
    TextStyle {
        font: style.font.style(FontStyle::Bold),
        ..style
    }
}

/// Draws a group with attributes.
pub(super) fn group(
    area: &Area<'_>,
    attributes: &str,
    draw: impl FnOnce() -> Result<(), Error>,
) -> Result<(), Error> {
    area.draw(&Tag(format!("<g {attributes}>")))?;
    draw()?;
    Ok(area.draw(&Tag("</g>".to_owned()))?)
}

/// Draws a group that is clipped to a rectangle, as an inner viewport, which needs no identifier.
pub(super) fn clipped(
    area: &Area<'_>,
    attributes: &str,
    rectangle: [f64; 4],
    draw: impl FnOnce() -> Result<(), Error>,
) -> Result<(), Error> {
    let [x, y, w, h] = rectangle.map(units);
    area.draw(&Tag(format!(
        "<svg {attributes} x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" viewBox=\"{x} {y} {w} {h}\">"
    )))?;
    draw()?;
    Ok(area.draw(&Tag("</svg>".to_owned()))?)
}

/// Draws a line through places in pixels.
pub(super) fn line(area: &Area<'_>, points: &[[f64; 2]], style: ShapeStyle) -> Result<(), Error> {
    let points: Vec<(i32, i32)> = points.iter().copied().map(place).collect();
    Ok(area.draw(&PathElement::new(points, style))?)
}

/// Draws text at a place in pixels.
pub(super) fn text(
    area: &Area<'_>,
    text: &str,
    at: [f64; 2],
    style: &TextStyle<'_>,
) -> Result<(), Error> {
    Ok(area.draw_text(text, style, place(at))?)
}

/// Draws the lines of a title below each other; returns the area below them.
pub(super) fn title<'s>(area: &Area<'s>, lines: &[String]) -> Result<Area<'s>, Error> {
    let style = bold(font(TITLE, INK, HPos::Center, VPos::Top));
    let mut rest = area.margin(units(ABOVE_TITLE), 0, 0, 0);
    for line in lines {
        rest = rest.titled(line, style.clone())?;
    }
    Ok(rest)
}

/// Draws the lines of a note below each other, the middle of the first at `at`.
pub(super) fn note(area: &Area<'_>, lines: &[String], [x, y]: [f64; 2]) -> Result<(), Error> {
    let style = font(SMALL, GREY, HPos::Left, VPos::Center);
    lines
        .iter()
        .enumerate()
        .try_for_each(|(i, line)| text(area, line, [x, y + NOTE_LINE * i as f64], &style))
}
