//! The drawing backend of the pictures for plotters, which writes SVG elements in tenths of a pixel.
//!
//! The SVG backend of plotters repeats fonts, opacities and empty strokes in every element, has no groups, and writes
//! a header with every picture. This one writes only attributes that differ from those of the root element, joins
//! adjacent polygons in one path, and opens and closes groups, by which a page switches series on and off.

use std::convert::Infallible;
use std::fmt::Write;

use plotters::prelude::DrawingBackend;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{FontStyle, FontTransform};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingErrorKind,
};

use super::text::text_width;

/// Height of a line of text as a multiple of its size.
const LINE_HEIGHT: f64 = 1.3125;

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

/// Writes SVG elements to a string.
pub(super) struct SvgBackend<'s> {
    elements: &'s mut String,
    size: (u32, u32),
}

impl<'s> SvgBackend<'s> {
    /// A backend for a picture of that size, in drawing units, that writes to the end of `elements`.
    pub fn new(elements: &'s mut String, size: (u32, u32)) -> SvgBackend<'s> {
        SvgBackend { elements, size }
    }

    /// Writes an opening or closing tag.
    pub fn tag(&mut self, tag: &str) {
        self.elements.push_str(tag);
        self.elements.push('\n');
    }

    /// Writes polygons as one filled path.
    pub fn fill_polygons<S: BackendStyle>(&mut self, polygons: &[Vec<BackendCoord>], style: &S) {
        let mut data = String::new();
        for one in polygons {
            add_path(&mut data, one.iter().copied());
            data.push('Z');
        }
        self.tag(&format!(
            "<path fill=\"{}\" d=\"{data}\"/>",
            colour(style.color())
        ));
    }

    /// Writes polylines as one stroked path.
    pub fn draw_paths<S: BackendStyle>(&mut self, paths: &[Vec<BackendCoord>], style: &S) {
        let mut data = String::new();
        paths
            .iter()
            .for_each(|one| add_path(&mut data, one.iter().copied()));
        // a straight line has no area
        let fill = if matches!(paths, [line] if line.len() == 2) {
            ""
        } else {
            "fill=\"none\" "
        };
        self.tag(&format!("<path {fill}{} d=\"{data}\"/>", stroke(style)));
    }
}

impl DrawingBackend for SvgBackend<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.size
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, own: BackendColor) -> Drawn {
        self.tag(&format!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"1\" height=\"1\" fill=\"{}\"/>",
            colour(own)
        ));
        Ok(())
    }

    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> Drawn {
        self.draw_path([from, to], style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        (left, top): BackendCoord,
        (right, bottom): BackendCoord,
        style: &S,
        fill: bool,
    ) -> Drawn {
        if style.color().alpha > 0.0 {
            let paint = if fill {
                format!("fill=\"{}\"", colour(style.color()))
            } else {
                format!("fill=\"none\" {}", stroke(style))
            };
            let (width, height) = (right - left, bottom - top);
            self.tag(&format!(
                "<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" {paint}/>"
            ));
        }
        Ok(())
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn {
        let path: Vec<BackendCoord> = path.into_iter().collect();
        if style.color().alpha > 0.0 && path.len() > 1 {
            self.draw_paths(&[path], style);
        }
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        (x, y): BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Drawn {
        if style.color().alpha > 0.0 {
            let paint = if fill {
                format!("fill=\"{}\"", colour(style.color()))
            } else {
                format!("fill=\"none\" {}", stroke(style))
            };
            self.tag(&format!(
                "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" {paint}/>"
            ));
        }
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Drawn {
        if style.color().alpha > 0.0 {
            self.fill_polygons(&[corners.into_iter().collect()], style);
        }
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        (x, y): BackendCoord,
    ) -> Drawn {
        if style.color().alpha == 0.0 || text.is_empty() {
            return Ok(());
        }
        let anchor = match style.anchor().h_pos {
            HPos::Left => "",
            HPos::Center => " text-anchor=\"middle\"",
            HPos::Right => " text-anchor=\"end\"",
        };
        let lift = match style.anchor().v_pos {
            VPos::Top => "0.76em",
            VPos::Center => "0.5ex",
            VPos::Bottom => "-0.5ex",
        };
        let weight = if matches!(style.style(), FontStyle::Bold) {
            " font-weight=\"bold\""
        } else {
            ""
        };
        let turn = match style.transform() {
            FontTransform::None => String::new(),
            FontTransform::Rotate90 => format!(" transform=\"rotate(90 {x} {y})\""),
            FontTransform::Rotate180 => format!(" transform=\"rotate(180 {x} {y})\""),
            FontTransform::Rotate270 => format!(" transform=\"rotate(270 {x} {y})\""),
        };
        self.tag(&format!(
            "<text x=\"{x}\" y=\"{y}\" dy=\"{lift}\"{anchor} font-size=\"{}\" fill=\"{}\"{weight}{turn}>{}</text>",
            style.size().round(),
            colour(style.color()),
            escaped(text),
        ));
        Ok(())
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let size = style.size();
        Ok((
            text_width(text, size).ceil() as u32,
            (LINE_HEIGHT * size).round() as u32,
        ))
    }
}

fn colour(
    BackendColor {
        alpha,
        rgb: (r, g, b),
    }: BackendColor,
) -> String {
    if alpha < 1.0 {
        format!(
            "#{r:02X}{g:02X}{b:02X}{:02X}",
            (255.0 * alpha).round() as u8
        )
    } else {
        format!("#{r:02X}{g:02X}{b:02X}")
    }
}

fn stroke<S: BackendStyle>(style: &S) -> String {
    format!(
        "stroke=\"{}\" stroke-width=\"{}\"",
        colour(style.color()),
        style.stroke_width()
    )
}

/// Text between tags and in attributes.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// Adds the path data of an open polyline: absolute to the first corner, relative from there on, with one number for each
/// horizontal or vertical step.
fn add_path(data: &mut String, corners: impl IntoIterator<Item = BackendCoord>) {
    let mut corners = corners.into_iter();
    let Some(first) = corners.next() else { return };
    write!(data, "M{} {}", first.0, first.1).expect("a string takes all text");
    let (mut last, mut letter) = (first, ' ');
    for here in corners {
        let (own, steps) = match (here.0 - last.0, here.1 - last.1) {
            (x, 0) => ('h', [Some(x), None]),
            (0, y) => ('v', [Some(y), None]),
            (x, y) => ('l', [Some(x), Some(y)]),
        };
        if own != letter {
            data.push(own);
        }
        for step in steps.into_iter().flatten() {
            // numbers are separated by a letter, a minus sign or a blank
            if step >= 0 && data.ends_with(|last: char| last.is_ascii_digit()) {
                data.push(' ');
            }
            write!(data, "{step}").expect("a string takes all text");
        }
        (last, letter) = (here, own);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use plotters::style::{BLACK, RGBColor, ShapeStyle, TRANSPARENT, TextStyle};

    fn drawn(draw: impl FnOnce(&mut SvgBackend<'_>) -> Drawn) -> String {
        let mut elements = String::new();
        draw(&mut SvgBackend::new(&mut elements, (100, 100))).expect("a string takes all text");
        elements
    }

    #[test]
    fn a_path_goes_through_the_corners_of_its_polyline() {
        let points = [
            (10, 20),
            (12, 20),
            (12, 5),
            (0, 5),
            (0, -3),
            (7, -3),
            (8, -10),
            (8, 0),
            (9, 0),
        ];
        let style = ShapeStyle::from(RGBColor(0x16, 0x16, 0x1d)).stroke_width(20);
        assert_eq!(
            drawn(|backend| backend.draw_path(points, &style)),
            "<path fill=\"none\" stroke=\"#16161D\" stroke-width=\"20\" d=\"M10 20h2v-15h-12v-8h7l1-7v10h1\"/>\n"
        );
    }

    #[test]
    fn a_path_has_one_number_for_a_horizontal_or_vertical_step() {
        let points = [
            (10, 20),
            (30, 20),
            (30, 15),
            (30, 10),
            (20, 5),
            (10, 7),
            (10, 7),
        ];
        let mut data = String::new();
        add_path(&mut data, []);
        assert_eq!(data, "");
        add_path(&mut data, points);
        assert_eq!(data, "M10 20h20v-5-5l-10-5-10 2h0");
    }

    #[test]
    fn elements_have_only_attributes_that_differ_from_their_root() {
        let line = ShapeStyle::from(RGBColor(0x22, 0x22, 0x22)).stroke_width(8);
        assert_eq!(
            drawn(|backend| backend.draw_line((1, 2), (3, 4), &line)),
            "<path stroke=\"#222222\" stroke-width=\"8\" d=\"M1 2l2 2\"/>\n"
        );
        let white = RGBColor(255, 255, 255);
        assert_eq!(
            drawn(|backend| backend.draw_circle((1, 2), 36, &white, true)),
            "<circle cx=\"1\" cy=\"2\" r=\"36\" fill=\"#FFFFFF\"/>\n"
        );
        assert_eq!(
            drawn(|backend| backend.draw_rect((1, 2), (3, 4), &TRANSPARENT, true)),
            ""
        );
        let text = TextStyle::from(("sans-serif", 120)).color(&BLACK);
        assert_eq!(
            drawn(|backend| backend.draw_text("a < b", &text, (1, 2))),
            "<text x=\"1\" y=\"2\" dy=\"0.76em\" font-size=\"120\" fill=\"#000000\">a &lt; b</text>\n"
        );
    }
}
