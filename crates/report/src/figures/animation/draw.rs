//! Drawing of a picture with moving elements; coordinates are in pixels.

use crate::chart::Svg;
use crate::document::animated::AnimationTrack;

/// Width of the picture.
pub(super) const WIDTH: f64 = 860.0;
/// Margin at both sides.
pub(super) const SIDE: f64 = 56.0;

pub(super) const INK: &str = "#22222a";
pub(super) const GREY: &str = "#62626a";
pub(super) const STEEL: &str = "#c9d3dc";
pub(super) const DARK: &str = "#7d8fa0";
pub(super) const ORANGE: &str = "#d65a0b";
pub(super) const BLUE: &str = "#0b55a4";

/// The picture.
pub(super) struct PlanDrawing {
    body: String,
    tracks: Vec<(usize, AnimationTrack)>,
    elements: usize,
}

impl PlanDrawing {
    pub fn new() -> PlanDrawing {
        PlanDrawing {
            body: String::new(),
            tracks: Vec::new(),
            elements: 0,
        }
    }

    fn add(&mut self, text: &str) {
        self.body.push_str(text);
        self.body.push('\n');
    }

    /// Adds tracks for a new element, and returns the attribute that identifies it.
    fn element(&mut self, tracks: impl IntoIterator<Item = AnimationTrack>) -> String {
        let element = self.elements;
        self.elements += 1;
        self.tracks
            .extend(tracks.into_iter().map(|track| (element, track)));
        format!("data-m=\"{element}\"")
    }

    /// Adds elements by `draw` that move along `places`; they are drawn at the frame `still`.
    pub fn moving(
        &mut self,
        places: Vec<[f64; 2]>,
        still: usize,
        draw: impl FnOnce(&mut PlanDrawing),
    ) {
        let [x, y] = places.get(still).copied().unwrap_or_default();
        let mark = self.element([AnimationTrack::Displacement(places)]);
        self.add(&format!(
            "<g {mark} transform=\"translate({x:.2} {y:.2})\">"
        ));
        draw(self);
        self.add("</g>");
    }

    pub fn line(&mut self, [from, to]: [[f64; 2]; 2], colour: &str, width: f64) {
        let [[x1, y1], [x2, y2]] = [from, to];
        self.add(&format!(
            "<line x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\" stroke=\"{colour}\" \
             stroke-width=\"{width}\"/>"
        ));
    }

    pub fn rectangle(&mut self, [left, top, width, height]: [f64; 4], fill: &str) {
        self.add(&format!(
            "<rect x=\"{left:.2}\" y=\"{top:.2}\" width=\"{width:.2}\" height=\"{height:.2}\" fill=\"{fill}\" \
             stroke=\"{INK}\" stroke-width=\"1\"/>"
        ));
    }

    pub fn shape(&mut self, points: &[[f64; 2]], fill: &str) {
        let all: Vec<String> = points
            .iter()
            .map(|[x, y]| format!("{x:.2},{y:.2}"))
            .collect();
        self.add(&format!(
            "<polygon points=\"{}\" fill=\"{fill}\" stroke=\"{INK}\" stroke-width=\"1\"/>",
            all.join(" ")
        ));
    }

    pub fn disc(&mut self, [x, y]: [f64; 2], radius: f64, fill: &str) {
        self.add(&format!(
            "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius:.2}\" fill=\"{fill}\" stroke=\"{INK}\" \
             stroke-width=\"1\"/>"
        ));
    }

    /// Adds a bar from a fixed point; `values` are the coordinates of its other end, `x2` or `y2` according to `end`.
    pub fn bar(
        &mut self,
        [x, y]: [f64; 2],
        end: &'static str,
        values: Vec<f64>,
        still: usize,
        style: (&str, f64),
    ) {
        let now = values.get(still).copied().unwrap_or_default();
        let [x2, y2] = if end == "x2" { [now, y] } else { [x, now] };
        let mark = self.element([AnimationTrack::Attribute(end, values)]);
        let (colour, width) = style;
        self.add(&format!(
            "<line {mark} x1=\"{x:.2}\" y1=\"{y:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\" stroke=\"{colour}\" \
             stroke-width=\"{width}\"/>"
        ));
    }

    /// Adds a polyline through fixed abscissas whose ordinates vary; `places[k]` are the ordinates of point k in each
    /// frame.
    pub fn curve(
        &mut self,
        x: Vec<f64>,
        places: Vec<Vec<f64>>,
        still: usize,
        (colour, width): (&str, f64),
    ) {
        let now = |values: &Vec<f64>| values.get(still).copied().unwrap_or_default();
        let points: Vec<String> = x
            .iter()
            .zip(&places)
            .map(|(x, values)| format!("{x:.1},{:.1}", now(values)))
            .collect();
        let mark = self.element([AnimationTrack::Curve(x, places)]);
        self.add(&format!(
            "<polyline {mark} points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"/>",
            points.join(" ")
        ));
    }

    /// Adds a bar of about a fifth of `room` pixels whose length is a round number, with its length in words; `scale`
    /// is the number of pixels of a unit of length.
    pub fn scale_bar(&mut self, [x, y]: [f64; 2], room: f64, scale: f64, unit: &str) {
        let length = round_length(0.2 * room / scale);
        let end = x + length * scale;
        for line in [
            [[x, y], [end, y]],
            [[x, y - 4.0], [x, y + 4.0]],
            [[end, y - 4.0], [end, y + 4.0]],
        ] {
            self.line(line, INK, 1.2);
        }
        self.text(
            [end + 6.0, y + 4.0],
            &format!("{length} {unit}"),
            (INK, 11.0),
            "start",
        );
    }

    /// Adds a line whose ends both move.
    pub fn rope(&mut self, ends: [Vec<[f64; 2]>; 2], still: usize) {
        let now = ends
            .each_ref()
            .map(|end| end.get(still).copied().unwrap_or_default());
        let part = |end: usize, k: usize| ends[end].iter().map(|place| place[k]).collect();
        let tracks = [
            AnimationTrack::Attribute("x1", part(0, 0)),
            AnimationTrack::Attribute("y1", part(0, 1)),
            AnimationTrack::Attribute("x2", part(1, 0)),
            AnimationTrack::Attribute("y2", part(1, 1)),
        ];
        let mark = self.element(tracks);
        let [[x1, y1], [x2, y2]] = now;
        self.add(&format!(
            "<line {mark} x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\" stroke=\"{INK}\" \
             stroke-width=\"1.2\"/>"
        ));
    }

    pub fn text(&mut self, [x, y]: [f64; 2], text: &str, style: (&str, f64), anchor: &str) {
        let (colour, size) = style;
        let text = escaped(text);
        self.add(&format!(
            "<text x=\"{x:.2}\" y=\"{y:.2}\" fill=\"{colour}\" font-size=\"{size}\" \
             text-anchor=\"{anchor}\">{text}</text>"
        ));
    }

    /// Adds a name with a number that varies, and its unit.
    pub fn reading(
        &mut self,
        [x, y]: [f64; 2],
        name: &str,
        unit: &str,
        digits: usize,
        values: Vec<f64>,
        still: usize,
    ) {
        let now = values.get(still).copied().unwrap_or_default();
        let power = 10f64.powi(i32::try_from(digits).unwrap_or_default());
        // adding 0.0 removes the sign of a rounded zero
        let now = (now * power).round() / power + 0.0;
        let mark = self.element([AnimationTrack::Number(digits, values)]);
        let (name, unit) = (escaped(name), escaped(unit));
        let end = x + 196.0;
        self.add(&format!(
            "<g class=\"reading\"><text x=\"{x:.2}\" y=\"{y:.2}\" fill=\"{GREY}\" font-size=\"12\">{name}</text>\
             <text x=\"{end:.2}\" y=\"{y:.2}\" fill=\"{INK}\" font-size=\"12\" text-anchor=\"end\"><tspan \
             {mark}>{now:.digits$}</tspan> {unit}</text></g>"
        ));
    }

    /// The finished picture with its tracks.
    pub fn finish(self, width: f64, height: f64) -> (Svg, Vec<(usize, AnimationTrack)>) {
        let svg = Svg::new(
            width,
            height.round(),
            format!("<g transform=\"scale(10)\">\n{}</g>\n", self.body),
        );
        (svg, self.tracks)
    }
}

/// The largest of 1, 2 and 5 times a power of ten that is not above `length`.
fn round_length(length: f64) -> f64 {
    let power = 10f64.powi(length.log10().floor() as i32);
    let factor = [5.0, 2.0]
        .into_iter()
        .find(|factor| factor * power <= length)
        .unwrap_or(1.0);
    // powers below one are inexact
    if power < 1.0 {
        factor / (1.0 / power).round()
    } else {
        factor * power
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
