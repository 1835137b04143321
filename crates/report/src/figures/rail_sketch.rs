//! A rail drawn to scale: supports, spans, and wheels with their forces.

use std::fmt::Write;

use super::design::digits;
use crate::chart::{Svg, text_width};

/// Width of a sketch in pixels.
pub(super) const WIDTH: f64 = 860.0;
/// Space beside the girder, in pixels.
const MARGIN: f64 = 50.0;
/// Units of a picture in a pixel.
pub(super) const FINE: f64 = 10.0;
/// Size of letters, in pixels.
pub(super) const LETTERS: f64 = 12.0;
/// Distance of lines of text, in pixels.
const LINE: f64 = 15.0;
/// Largest number of lines over which labels of wheels are spread.
const LEVELS: usize = 6;
/// Colours of the girder, of wheels with their forces, and of the section that governs.
pub(super) const INK: &str = "#202020";
pub(super) const WHEEL: &str = "#00539C";
pub(super) const SECTION: &str = "#B00020";

/// A rail with what stands on it.
pub(crate) struct RailSketch<'a> {
    /// First and last coordinate.
    pub range: [f64; 2],
    /// Coordinates of supports, increasing.
    pub supports: &'a [f64],
    /// Unit of coordinates.
    pub length_unit: &'a str,
    /// Coordinates and vertical forces of the wheels.
    pub wheels: Vec<(f64, f64)>,
    /// The section that governs.
    pub section: Option<f64>,
}

/// A text centred at an abscissa, in pixels, on one of several lines.
pub(super) struct PlacedText {
    pub x: f64,
    pub text: String,
    pub level: usize,
}

/// Spreads texts over lines so that none overlap; those that fit on none of `levels` lines are left out.
pub(super) fn placed_texts(texts: Vec<(f64, String)>, levels: usize) -> Vec<PlacedText> {
    let mut free = vec![f64::NEG_INFINITY; levels];
    let mut out = Vec::new();
    for (x, text) in texts {
        let half = 0.5 * text_width(&text, LETTERS);
        let x = x.clamp(half.min(0.5 * WIDTH), (WIDTH - half).max(0.5 * WIDTH));
        if let Some(level) = free.iter().position(|end| x - half > *end) {
            free[level] = x + half + 6.0;
            out.push(PlacedText { x, text, level });
        }
    }
    out
}

/// A text of a picture; `x` and `y` in pixels.
pub(super) fn write_text(out: &mut String, text: &str, [x, y]: [f64; 2], colour: &str) {
    let _ = writeln!(
        out,
        "<text x=\"{:.0}\" y=\"{:.0}\" font-size=\"{:.0}\" fill=\"{colour}\" text-anchor=\"middle\" stroke=\"#FFFFFF\" \
         stroke-width=\"30\" paint-order=\"stroke\">{text}</text>",
        FINE * x,
        FINE * y,
        FINE * LETTERS
    );
}

impl RailSketch<'_> {
    /// Abscissa of a coordinate, in pixels.
    pub(super) fn at(&self, x: f64) -> f64 {
        let [low, high] = self.range;
        MARGIN + (x - low) * (WIDTH - 2.0 * MARGIN) / (high - low)
    }

    /// The sketch as a picture.
    pub(crate) fn svg(&self, title: &str) -> Svg {
        let mut out = format!("<title>{title}</title>\n");
        let bottom = self.draw(&mut out, 4.0);
        Svg::new(WIDTH, bottom, out)
    }

    /// Draws the sketch below an ordinate in pixels, and returns the ordinate of its lower end.
    pub(super) fn draw(&self, out: &mut String, top: f64) -> f64 {
        let mut wheels = self.wheels.clone();
        wheels.sort_by(|a, b| a.0.total_cmp(&b.0));
        let texts = wheels.iter().map(|(x, force)| {
            (
                self.at(*x),
                format!("{} at {}", digits(*force, 4), digits(*x, 4)),
            )
        });
        let labels = placed_texts(texts.collect(), LEVELS);
        let levels = labels
            .iter()
            .map(|label| label.level + 1)
            .max()
            .unwrap_or_default();
        let head = top + LINE * levels as f64;
        for label in &labels {
            write_text(
                out,
                &label.text,
                [label.x, head - 4.0 - LINE * label.level as f64],
                WHEEL,
            );
        }
        let axis = head + 46.0;
        self.draw_girder(out, axis);
        for (x, _) in &wheels {
            let _ = writeln!(
                out,
                "<circle cx=\"{0:.0}\" cy=\"{1:.0}\" r=\"60\" fill=\"#FFFFFF\" stroke=\"{WHEEL}\" \
                 stroke-width=\"15\"/>\n<path d=\"M {0:.0} {2:.0} V {3:.0} m -40 -90 l 40 90 l 40 -90\" \
                 fill=\"none\" stroke=\"{WHEEL}\" stroke-width=\"15\"/>",
                FINE * self.at(*x),
                FINE * (axis - 8.5),
                FINE * head,
                FINE * (axis - 15.0),
            );
        }
        if let Some(x) = self.section {
            let _ = writeln!(
                out,
                "<line x1=\"{0:.0}\" y1=\"{1:.0}\" x2=\"{0:.0}\" y2=\"{2:.0}\" stroke=\"{SECTION}\" \
                 stroke-width=\"15\" stroke-dasharray=\"50 30\"/>",
                FINE * self.at(x),
                FINE * (axis - 11.0),
                FINE * (axis + 15.0),
            );
            write_text(
                out,
                &format!("x = {}", digits(x, 4)),
                [self.at(x), axis + 44.0],
                SECTION,
            );
        }
        axis + 50.0
    }

    /// The girder with its supports, their coordinates and the lengths between them; `axis` is its ordinate in pixels.
    fn draw_girder(&self, out: &mut String, axis: f64) {
        let [low, high] = self.range;
        let y = FINE * axis;
        let _ = writeln!(
            out,
            "<line x1=\"{:.0}\" y1=\"{y:.0}\" x2=\"{:.0}\" y2=\"{y:.0}\" stroke=\"{INK}\" stroke-width=\"45\"/>",
            FINE * self.at(low),
            FINE * self.at(high)
        );
        let mut texts = Vec::new();
        for (index, &x) in self.supports.iter().enumerate() {
            let _ = writeln!(
                out,
                "<path d=\"M {:.0} {:.0} l -70 120 h 140 z\" fill=\"#FFFFFF\" stroke=\"{INK}\" stroke-width=\"12\"/>",
                FINE * self.at(x),
                y + 22.0
            );
            texts.push((self.at(x), digits(x, 4)));
            if let Some(next) = self.supports.get(index + 1) {
                let middle = self.at(0.5 * (x + next));
                texts.push((
                    middle,
                    format!("L = {} {}", digits(next - x, 4), self.length_unit),
                ));
            }
        }
        for label in placed_texts(texts, 1) {
            write_text(out, &label.text, [label.x, axis + 28.0], "#444444");
        }
    }
}
