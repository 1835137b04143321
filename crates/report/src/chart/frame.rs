//! The frame of a chart: where data go on the picture, grid lines, ticks and captions.

use super::axis::Axis;
use super::error::Error;
use super::scale::{Scale, Ticks};
use super::svg::{Anchor, FAINT, GREY, INK, LABEL, Pen, SMALL};
use super::text::text_width;

/// Width of a picture in pixels.
pub(super) const WIDTH: f64 = 860.0;
/// Room left of the frame beside its tick labels, for the caption.
const CAPTION: f64 = 44.0;
/// Room right of the frame.
pub(super) const RIGHT: f64 = 30.0;
/// Room below the frame for tick labels and caption.
pub(super) const BELOW: f64 = 52.0;

/// Placement of data on a picture, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Left edge.
    pub left: f64,
    /// Upper edge.
    pub top: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
    pub(super) x: Scale,
    pub(super) y: Scale,
    pub(super) flip: [bool; 2],
}

impl Frame {
    /// A frame as wide as the picture allows beside the y axis' labels, with its ticks.
    pub(super) fn new(x: (&Axis, Scale), y: (&Axis, Scale), top: f64, height: f64) -> (Self, Ticks, Ticks) {
        let down = y.1.ticks((height / 55.0).clamp(3.0, 10.0));
        let widest = down.labels.iter().map(|l| text_width(l, SMALL)).fold(0.0, f64::max);
        let left = CAPTION + widest;
        let width = WIDTH - left - RIGHT;
        let frame = Frame { left, top, width, height, x: x.1, y: y.1, flip: [x.0.downwards, y.0.downwards] };
        (frame, frame.fitting(), down)
    }

    /// Ticks of the x axis, as many as their labels leave room for.
    pub(super) fn fitting(&self) -> Ticks {
        let mut ticks = self.x.ticks(10.0);
        for target in [8.0, 6.0, 4.0, 3.0] {
            let widest = ticks.labels.iter().map(|l| text_width(l, SMALL)).fold(0.0, f64::max);
            if (widest + 14.0) * ticks.labels.len() as f64 <= self.width {
                break;
            }
            ticks = self.x.ticks(target);
        }
        ticks
    }

    /// Place of a point on the picture.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (u, v) = (self.x.unit(x), self.y.unit(y));
        let u = if self.flip[0] { 1.0 - u } else { u };
        let v = if self.flip[1] { v } else { 1.0 - v };
        [self.left + u * self.width, self.top + v * self.height]
    }

    /// Ends of both axes: (low, high) of x, then of y.
    pub fn ranges(&self) -> [[f64; 2]; 2] {
        [[self.x.low, self.x.high], [self.y.low, self.y.high]]
    }

    /// Rectangle with a margin around it.
    pub(super) fn around(&self, margin: f64) -> [f64; 4] {
        [self.left - margin, self.top - margin, self.width + 2.0 * margin, self.height + 2.0 * margin]
    }

    pub(super) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// Grid lines at the ticks, the zero line darker.
    pub(super) fn grid(&self, pen: &Pen<'_>, x: &Ticks, y: &Ticks) -> Result<(), Error> {
        let (right, bottom) = (self.left + self.width, self.bottom());
        for value in &x.values {
            let at = self.place([*value, self.y.low])[0];
            pen.line(&[[at, self.top], [at, bottom]], FAINT, 0.8)?;
        }
        for value in &y.values {
            let at = self.place([self.x.low, *value])[1];
            let zero = *value == 0.0;
            pen.line(&[[self.left, at], [right, at]], if zero { GREY } else { FAINT }, 0.8)?;
        }
        Ok(())
    }

    /// Border, tick labels and captions.
    pub(super) fn scales(&self, pen: &Pen<'_>, x: (&Axis, &Ticks), y: (&Axis, &Ticks)) -> Result<(), Error> {
        let (right, bottom) = (self.left + self.width, self.bottom());
        let corners = [
            [self.left, self.top],
            [right, self.top],
            [right, bottom],
            [self.left, bottom],
            [self.left, self.top],
        ];
        pen.line(&corners, INK, 1.0)?;
        for (value, label) in x.1.values.iter().zip(&x.1.labels) {
            let at = self.place([*value, self.y.low])[0];
            pen.line(&[[at, bottom], [at, bottom + 5.0]], INK, 1.0)?;
            pen.text(label, [at, bottom + 15.0], Anchor::Middle, SMALL, false, INK)?;
        }
        for (value, label) in y.1.values.iter().zip(&y.1.labels) {
            let at = self.place([self.x.low, *value])[1];
            pen.line(&[[self.left - 5.0, at], [self.left, at]], INK, 1.0)?;
            pen.text(label, [self.left - 9.0, at], Anchor::Right, SMALL, false, INK)?;
        }
        let middle = [self.left + 0.5 * self.width, self.top + 0.5 * self.height];
        let caption = x.0.caption(x.1.exponent);
        pen.text(&caption, [middle[0], bottom + 37.0], Anchor::Middle, LABEL, false, INK)?;
        let caption = y.0.caption(y.1.exponent);
        pen.text(&caption, [16.0, middle[1]], Anchor::Upwards, LABEL, false, INK)
    }
}
