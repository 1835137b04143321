//! The legend, which distinguishes the series without colour as well.
//!
//! The legend of plotters is a box over the data with one entry below the other, in a single element. Here the
//! entries are in rows above the frame, each in groups of its own, so that a page can switch its series on and off.

use plotters::style::text_anchor::{HPos, VPos};

use super::elements::Symbol;
use super::error::Error;
use super::palette::{INK, line_colour};
use super::series::{Series, Style};
use super::sheet::{Area, SMALL, font, group, line, place, stroke, text};
use super::svg::FINE;
use super::text::text_width;

/// Height of a row of the legend.
const ROW: f64 = 20.0;
/// Length of the line shown before a name.
const SWATCH: f64 = 34.0;
/// Space between a line and its name.
const LABEL_SPACE: f64 = 6.0;
/// Space between entries.
const GAP: f64 = 22.0;
/// Radius of symbols, in pixels.
pub(super) const RADIUS: f64 = 3.6;

/// Entries in rows between the title and the frame.
pub(super) struct Legend {
    /// Left end of the line of each entry.
    places: Vec<[f64; 2]>,
    /// Whether the lines of all series have symbols.
    with_symbols: bool,
    /// Height of all rows.
    pub height: f64,
}

impl Legend {
    /// Entries between the abscissas `left` and `right` and below the ordinate `top`. A single series has none.
    pub fn new(series: &[Series], left: f64, right: f64, top: f64, with_symbols: bool) -> Self {
        if series.len() < 2 {
            return Legend {
                places: Vec::new(),
                with_symbols,
                height: 0.0,
            };
        }
        let (mut at, mut row) = (left, 0.0);
        let mut places = Vec::new();
        for one in series {
            let width = SWATCH + LABEL_SPACE + text_width(&one.label, SMALL);
            if at > left && at + width > right {
                at = left;
                row += 1.0;
            }
            places.push([at, top + (row + 0.5) * ROW]);
            at += width + GAP;
        }
        Legend {
            places,
            with_symbols,
            height: (row + 1.0) * ROW + 4.0,
        }
    }

    /// Draws the groups of each entry.
    pub fn draw(&self, area: &Area<'_>, series: &[Series]) -> Result<(), Error> {
        let style = font(SMALL, INK, HPos::Left, VPos::Center);
        for (index, ([x, y], one)) in self.places.iter().zip(series).enumerate() {
            let class = format!("class=\"key\" data-series=\"{index}\"");
            group(area, &class, || {
                text(area, &one.label, [x + SWATCH + LABEL_SPACE, *y], &style)
            })?;
            if one.style != Style::Points {
                let colour = line_colour(one.style, index);
                group(area, &format!("{class}{}", dashes(one.style)), || {
                    line(area, &[[*x, *y], [x + SWATCH, *y]], stroke(colour, 2.0))
                })?;
            }
            if self.with_symbols && one.may_have_symbols() || one.has_symbols() {
                let middle = place([x + 0.5 * SWATCH, *y]);
                group(area, &class, || {
                    Ok(area.draw(&Symbol::of_series(index, middle, RADIUS * FINE))?)
                })?;
            }
        }
        Ok(())
    }
}

/// Attribute of a group that draws its lines in this style.
pub(super) fn dashes(style: Style) -> &'static str {
    if matches!(style, Style::Dashed | Style::Limit) {
        " stroke-dasharray=\"80 50\""
    } else {
        ""
    }
}
