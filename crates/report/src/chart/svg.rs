//! Finished pictures.

/// Drawing units in a pixel. plotters rounds all coordinates to whole units, which must be small for smooth curves.
pub(super) const FINE: f64 = 10.0;
/// Fonts in the order of preference.
const FONT: &str = "Arial, Helvetica, sans-serif";

/// A finished picture on white: its size, and SVG elements in tenths of a pixel.
///
/// ```
/// use report::chart::{Svg, stack};
///
/// let dot = Svg::new(20.0, 10.0, "<circle cx=\"100\" cy=\"50\" r=\"40\"/>");
/// assert!(dot.file().starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"20\" height=\"10\""));
/// assert_eq!(stack(&[dot.clone(), dot]).height(), 20.0);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Svg {
    width: f64,
    height: f64,
    elements: String,
}

impl Svg {
    /// A picture of `width` by `height` pixels. `elements` is trusted SVG text whose coordinates count tenths of
    /// a pixel from the upper left corner.
    #[must_use]
    pub fn new(width: f64, height: f64, elements: impl Into<String>) -> Svg {
        Svg {
            width,
            height,
            elements: elements.into(),
        }
    }

    /// Height in pixels.
    #[must_use]
    pub fn height(&self) -> f64 {
        self.height
    }

    /// The picture as an SVG file.
    #[must_use]
    pub fn file(&self) -> String {
        self.element("xmlns=\"http://www.w3.org/2000/svg\"", 1.0)
    }

    /// The picture as an element inside HTML, which needs no name space. A screen reader reads it as an image with the
    /// text of the element `label` of the page.
    #[must_use]
    pub fn inline(&self, label: &str) -> String {
        self.element(&format!("role=\"img\" aria-labelledby=\"{label}\""), 1.0)
    }

    /// The SVG element with further attributes; `unit` is the length of a pixel in the units of the parent element.
    fn element(&self, attributes: &str, unit: f64) -> String {
        let Svg {
            width,
            height,
            elements,
        } = self;
        format!(
            "<svg {attributes} width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\" \
             font-family=\"{FONT}\" stroke-linejoin=\"round\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#FFFFFF\"/>\n{elements}</svg>\n",
            width * unit,
            height * unit,
            width * FINE,
            height * FINE,
        )
    }
}

/// Several pictures in one, from top to bottom.
#[must_use]
pub fn stack(pictures: &[Svg]) -> Svg {
    let mut all = Svg::default();
    for picture in pictures {
        all.elements
            .push_str(&picture.element(&format!("y=\"{}\"", all.height * FINE), FINE));
        all.width = all.width.max(picture.width);
        all.height += picture.height;
    }
    all
}
