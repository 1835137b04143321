//! Our own elements for plotters: tags around groups, symbols, and polygons or lines joined in one path.
//!
//! An element returns its points in the coordinates of a chart, and draws itself at the pixels to which plotters maps
//! them.

use std::iter::{Empty, Flatten, Once, empty, once};
use std::slice::Iter;

use plotters::element::{Drawable, PointCollection};
use plotters::style::{Color, RGBColor, ShapeStyle, WHITE};
use plotters_backend::{BackendCoord, DrawingBackend, DrawingErrorKind};

use super::backend::SvgBackend;
use super::palette::{GREY, INK, colour};

type Drawn<B> = Result<(), DrawingErrorKind<<B as DrawingBackend>::ErrorType>>;

/// An opening or closing tag of a group.
pub(super) struct Tag(pub String);

impl<'a, C: 'a> PointCollection<'a, C> for &'a Tag {
    type Point = C;
    type IntoIter = Empty<C>;

    fn point_iter(self) -> Empty<C> {
        empty()
    }
}

impl<'s> Drawable<SvgBackend<'s>> for Tag {
    fn draw<I: Iterator<Item = BackendCoord>>(
        &self,
        _: I,
        backend: &mut SvgBackend<'s>,
        _: (u32, u32),
    ) -> Drawn<SvgBackend<'s>> {
        backend.tag(&self.0);
        Ok(())
    }
}

/// Adjacent polygons, or lines of one style, as one path. Adjacent polygons drawn separately have visible gaps.
pub(super) struct OnePath<C> {
    /// Corners of each polygon or line.
    pub pieces: Vec<Vec<C>>,
    /// Style of the path; a filled style closes the pieces.
    pub style: ShapeStyle,
}

impl<'a, C: 'a> PointCollection<'a, C> for &'a OnePath<C> {
    type Point = &'a C;
    type IntoIter = Flatten<Iter<'a, Vec<C>>>;

    fn point_iter(self) -> Self::IntoIter {
        self.pieces.iter().flatten()
    }
}

impl<'s, C> Drawable<SvgBackend<'s>> for OnePath<C> {
    fn draw<I: Iterator<Item = BackendCoord>>(
        &self,
        mut places: I,
        backend: &mut SvgBackend<'s>,
        _: (u32, u32),
    ) -> Drawn<SvgBackend<'s>> {
        let pieces: Vec<Vec<BackendCoord>> = self
            .pieces
            .iter()
            .map(|piece| places.by_ref().take(piece.len()).collect())
            .collect();
        if self.style.filled {
            backend.fill_polygons(&pieces, &self.style);
        } else {
            backend.draw_paths(&pieces, &self.style);
        }
        Ok(())
    }
}

/// A part of a [`Symbol`]: offsets from its place, in drawing units.
#[derive(Clone)]
enum Part {
    Disc(BackendCoord, u32, RGBColor),
    Square(i32, RGBColor),
    Polygon(Vec<BackendCoord>, RGBColor),
    Line([BackendCoord; 2], ShapeStyle),
}

/// A small drawing of fixed size at a point.
#[derive(Clone)]
pub(super) struct Symbol<C> {
    at: C,
    parts: Vec<Part>,
}

impl<C> Symbol<C> {
    /// Symbol of the series with that index, in its colour: disc, square, triangle, ring, diamond or open
    /// square.
    /// `size` is the radius of the disc in drawing units.
    pub fn of_series(series: usize, at: C, size: f64) -> Symbol<C> {
        let ink = colour(series);
        let whole = |v: f64| v.round() as i32;
        let disc = |radius: f64, colour| Part::Disc((0, 0), whole(radius).unsigned_abs(), colour);
        let parts = match series % 6 {
            0 => vec![disc(size, ink)],
            1 => vec![Part::Square(whole(0.9 * size), ink)],
            2 => {
                let (w, h) = (whole(1.15 * size), whole(size));
                vec![Part::Polygon(
                    vec![(-w, h), (w, h), (0, -whole(1.1 * size))],
                    ink,
                )]
            }
            3 => vec![disc(size, ink), disc(0.5 * size, WHITE)],
            4 => {
                let r = whole(1.35 * size);
                vec![Part::Polygon(vec![(-r, 0), (0, -r), (r, 0), (0, r)], ink)]
            }
            _ => vec![
                Part::Square(whole(size), ink),
                Part::Square(whole(0.5 * size), WHITE),
            ],
        };
        Symbol { at, parts }
    }

    /// Triangle under a supported point: on hatched ground where it is fixed, and on rollers otherwise.
    pub fn support(at: C, is_fixed: bool) -> Symbol<C> {
        let ground = if is_fixed { 160 } else { 220 };
        let mut parts = vec![Part::Polygon(vec![(0, 20), (-90, 160), (90, 160)], GREY)];
        if !is_fixed {
            parts.extend([-55, 55].map(|x| Part::Disc((x, 190), 26, GREY)));
        }
        parts.push(Part::Line(
            [(-140, ground), (140, ground)],
            GREY.stroke_width(12),
        ));
        parts.extend(
            [-100, -40, 20, 80, 140]
                .map(|x| Part::Line([(x, ground), (x - 50, ground + 50)], GREY.stroke_width(9))),
        );
        Symbol { at, parts }
    }

    /// Arrow of a load, which ends at the point from above.
    pub fn load(at: C) -> Symbol<C> {
        let shaft = Part::Line([(0, -440), (0, -100)], INK.stroke_width(18));
        Symbol {
            at,
            parts: vec![
                shaft,
                Part::Polygon(vec![(0, -40), (-45, -140), (45, -140)], INK),
            ],
        }
    }
}

impl<'a, C: 'a> PointCollection<'a, C> for &'a Symbol<C> {
    type Point = &'a C;
    type IntoIter = Once<&'a C>;

    fn point_iter(self) -> Once<&'a C> {
        once(&self.at)
    }
}

impl<C, B: DrawingBackend> Drawable<B> for Symbol<C> {
    fn draw<I: Iterator<Item = BackendCoord>>(
        &self,
        mut places: I,
        backend: &mut B,
        _: (u32, u32),
    ) -> Drawn<B> {
        let Some((x, y)) = places.next() else {
            return Ok(());
        };
        let at = |(dx, dy): BackendCoord| (x + dx, y + dy);
        self.parts.iter().try_for_each(|part| match part {
            Part::Disc(centre, radius, ink) => {
                backend.draw_circle(at(*centre), *radius, &ink.filled(), true)
            }
            Part::Square(half, ink) => {
                backend.draw_rect(at((-half, -half)), at((*half, *half)), &ink.filled(), true)
            }
            Part::Polygon(corners, ink) => {
                backend.fill_polygon(corners.iter().map(|corner| at(*corner)), &ink.filled())
            }
            Part::Line(ends, style) => backend.draw_path(ends.map(at), style),
        })
    }
}
