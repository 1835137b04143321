//! Legend and symbols: every series can be told from the others without colour.

use super::error::Error;
use super::series::{Series, Style};
use super::svg::{Anchor, GREY, INK, Pen, SMALL, Sheet, colour};
use super::text::text_width;
use plotters::style::{RGBColor, WHITE};

/// Height of a row of the legend.
const ROW: f64 = 20.0;
/// Length of the line shown before a name.
const SWATCH: f64 = 34.0;
/// Space between entries.
const GAP: f64 = 22.0;

/// Entries flowed into rows between the title and the frame.
pub(super) struct Legend {
    places: Vec<[f64; 2]>,
    symbols: bool,
    /// Height of all rows.
    pub height: f64,
}

impl Legend {
    /// Flows the entries from `left` on, no further than `right`, below `top`. A single series has none.
    /// `symbols` puts the symbols of the series on their lines.
    pub fn new(series: &[Series], left: f64, right: f64, top: f64, symbols: bool) -> Self {
        if series.len() < 2 {
            return Legend { places: Vec::new(), symbols, height: 0.0 };
        }
        let (mut at, mut row) = (left, 0.0);
        let mut places = Vec::new();
        for one in series {
            let width = SWATCH + 6.0 + text_width(&one.label, SMALL);
            if at > left && at + width > right {
                at = left;
                row += 1.0;
            }
            places.push([at, top + (row + 0.5) * ROW]);
            at += width + GAP;
        }
        Legend { places, symbols, height: (row + 1.0) * ROW + 4.0 }
    }

    /// Draws one group a series.
    pub fn draw(&self, sheet: &mut Sheet, series: &[Series]) -> Result<(), Error> {
        for (index, (at, one)) in self.places.iter().zip(series).enumerate() {
            let line = [*at, [at[0] + SWATCH, at[1]]];
            sheet.group(&format!("class=\"key\" data-series=\"{index}\""), |pen| {
                let name = [at[0] + SWATCH + 6.0, at[1]];
                pen.text(&one.label, name, Anchor::Left, SMALL, false, INK)
            })?;
            let attributes = format!("class=\"key\" data-series=\"{index}\"{}", dashes(one.style));
            sheet.group(&attributes, |pen| match one.style {
                Style::Points => Ok(()),
                style => pen.line(&line, ink(style, index), 2.0),
            })?;
            if self.symbols || one.has_symbols() {
                sheet.group(&format!("class=\"key\" data-series=\"{index}\""), |pen| {
                    symbol(pen, index, [at[0] + 0.5 * SWATCH, at[1]], 3.6)
                })?;
            }
        }
        Ok(())
    }
}

/// Colour of the lines of a series.
pub(super) fn ink(style: Style, index: usize) -> RGBColor {
    if style == Style::Limit { GREY } else { colour(index) }
}

/// Attribute that draws the lines of a group in that style.
pub(super) fn dashes(style: Style) -> &'static str {
    if matches!(style, Style::Dashed | Style::Limit) { " stroke-dasharray=\"80 50\"" } else { "" }
}

/// Symbol of the series with that index, in its colour: disc, square, triangle, ring, diamond, open square.
pub(super) fn symbol(pen: &Pen<'_>, series: usize, at: [f64; 2], size: f64) -> Result<(), Error> {
    let ink: RGBColor = colour(series);
    let square = |r: f64| [at[0] - r, at[1] - r, 2.0 * r, 2.0 * r];
    match series % 6 {
        0 => pen.disc(at, size, ink),
        1 => pen.rectangle(square(0.9 * size), ink),
        2 => {
            let (w, h) = (1.15 * size, size);
            pen.polygon(&[[at[0] - w, at[1] + h], [at[0] + w, at[1] + h], [at[0], at[1] - 1.1 * h]], ink)
        }
        3 => {
            pen.disc(at, size, ink)?;
            pen.disc(at, 0.5 * size, WHITE)
        }
        4 => {
            let r = 1.35 * size;
            pen.polygon(
                &[[at[0] - r, at[1]], [at[0], at[1] - r], [at[0] + r, at[1]], [at[0], at[1] + r]],
                ink,
            )
        }
        _ => {
            pen.rectangle(square(size), ink)?;
            pen.rectangle(square(0.5 * size), WHITE)
        }
    }
}
