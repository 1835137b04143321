//! Colours of the pictures, which differ in a print without colour as well.

use plotters::style::RGBColor;

use super::series::Style;

/// Text, axes and borders.
pub(super) const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
/// Grid lines.
pub(super) const FAINT: RGBColor = RGBColor(0xdd, 0xdd, 0xdd);
/// Notes, markers and limits.
pub(super) const GREY: RGBColor = RGBColor(0x66, 0x66, 0x66);

/// Line colours in the order of use; without colour they alternate between dark and light grey.
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

/// Colour of the lines of a series of that style.
pub(super) fn line_colour(style: Style, series: usize) -> RGBColor {
    if style == Style::Limit {
        GREY
    } else {
        colour(series)
    }
}

/// Colour of a value between -1 (blue) and 1 (red); 0 is white, and the colour becomes darker with the absolute
/// value.
pub(super) fn shade(value: f64) -> RGBColor {
    let full = if value < 0.0 {
        [0x1b, 0x4f, 0x9c]
    } else {
        [0x9e, 0x1b, 0x2e]
    };
    let t = value.abs().min(1.0).powf(0.85);
    let [r, g, b] = full.map(|c: u8| (255.0 + t * (f64::from(c) - 255.0)).round() as u8);
    RGBColor(r, g, b)
}
